#include "study/sweep/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "query/tree_session.hpp"
#include "study/samplers/answer_path.hpp"
#include "study/samplers/placeholders.hpp"
#include "study/sweep/left_out.hpp"
#include "study/sweep/samples.hpp"

namespace sinew::inline v0 {
namespace {

constexpr std::size_t trials = 24;
constexpr std::size_t most_paths = 400;
constexpr std::size_t most_left_out = 20'000;  ///< passed over in search of one sample to try

/// Places of all numbers of a tree.
void collect(const Json& node, const std::string& path, std::vector<std::string>& paths) {
  if (paths.size() >= most_paths) return;
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) collect(value, joined(path, key), paths);
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) collect(node[i], joined(path, i), paths);
  } else if (node.is_number() || node.is_boolean()) {
    paths.push_back(path);
  }
}

bool is_solved(const Json& answer) {
  const auto status = answer.find("status");
  return status == answer.end() || *status == "converged" || *status == "unstable";
}

/// `pose.position[2]` as the name of a column: `z`; `legs[0].curvature`: `legs_0_curvature`.
std::string column_of(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> known{{
      {"pose.position[0]", "x"},
      {"pose.position[1]", "y"},
      {"pose.position[2]", "z"},
      {"pose.quaternion[0]", "e0"},
      {"pose.quaternion[1]", "e1"},
      {"pose.quaternion[2]", "e2"},
      {"pose.quaternion[3]", "e3"},
      {"pose.x", "x"},
      {"pose.y", "y"},
      {"pose.phi", "phi"},
  }};
  for (const auto& [place, name] : known)
    if (place == path) return std::string(name);
  std::string name;
  for (const char c : path)
    if (c == '.' || c == '[')
      name += '_';
    else if (c != ']')
      name += c;
  return name;
}

/// What people ask a query for.
bool is_usual(std::string_view path, std::string_view query) {
  const auto of = [&](std::string_view field) { return path.starts_with(field); };
  if (query == "inverse") return of("inputs[") || of("changes[");
  if (query == "velocity") return of("indices.") || path == "determinant";
  if (query == "forward") return of("pose.") || of("tip.") || of("changes[");
  return of("pose.") || of("tip.") || of("tensions[") || path == "margin" || path == "area";
}

class Trial {
 public:
  explicit Trial(Study& study) : study_(study) {}

  Expected<std::string> run() {
    auto session = TreeSession::open(study_.robot_document);
    if (!session) return tl::unexpected(session.error());
    ask(*session);
    if (answers_.empty() && errors_.empty())
      return failure("all_left_out", study_.source + ": derived",
                     "every sample tried is outside the limits of a derived value; widen its from and to");
    if (answers_.empty()) return tl::unexpected(errors_);
    if (study_.outputs.empty()) choose_outputs();
    if (study_.outputs.empty())
      return failure(
          "no_outputs", study_.source,
          "which numbers of the answers are to be kept? Name them under outputs: {z: pose.position[2]}");
    Errors errors = check_outputs();
    if (!errors.empty()) return tl::unexpected(std::move(errors));
    set_units(*session);
    if (solved_ > 0) return std::string();
    return fmt::format("none of {} samples tried has a solution", answers_.size());
  }

 private:
  void ask(TreeSession& session) {
    Document query = study_.query;
    const auto places = placeholders(query.root, study_);
    const std::size_t count = std::min(trials, study_.samples);
    std::vector<double> values(study_.variable_count());
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t t = 0; t < count; ++t) {
      const bool takes_long = std::chrono::steady_clock::now() - begin > std::chrono::seconds(2);
      if (takes_long && solved_ > 0) break;  // some queries take seconds
      if (!sample(t, count, values)) continue;
      for (const Placeholder& place : places)
        put(*place.node, values[*place.axis], study_.column_unit(*place.axis));
      Json answer = session.answer(query);
      if (const auto error = answer.find("error"); error != answer.end()) {
        if (errors_.empty())
          errors_ = {
              {error->value("code", ""), place_of(error->value("where", "")), error->value("message", "")}};
        continue;
      }
      solved_ += is_solved(answer);
      answers_.push_back(std::move(answer));
    }
  }

  /// The sample of a trial: the first and the last, and between them places that no axis repeats; of those
  /// left out the next that is not. Whether there is one.
  bool sample(std::size_t trial, std::size_t count, std::span<double> values) const {
    const std::size_t n = study_.samples;
    const std::size_t first = trial + 1 == count
                                  ? n - 1
                                  : static_cast<std::size_t>(static_cast<double>(n) * 0.6180339887498949 *
                                                             static_cast<double>(trial)) %
                                        n;
    for (std::size_t k = 0; k < std::min(n, most_left_out); ++k) {
      axis_values(study_, {(first + k) % n, 1}, false, values);
      if (!is_left_out(study_, values)) return true;
    }
    return false;
  }

  /// Where a query is wrong: a place of the file, or a path in the query or the robot.
  std::string place_of(const std::string& where) const {
    if (where.empty() || where.starts_with(study_.source)) return where.empty() ? study_.source : where;
    return fmt::format("{}: query: {}", study_.source, where);
  }

  void choose_outputs() {
    const auto solved = std::ranges::find_if(answers_, is_solved);
    if (solved == answers_.end()) return;
    std::vector<std::string> paths;
    collect(*solved, "", paths);
    const std::string query = solved->value("query", "");
    for (const std::string& path : paths) {
      const std::string name = column_of(path);
      if (is_usual(path, query) && !study_.find_variable(name))
        study_.outputs.push_back({.name = name, .path = path, .unit = {}});
    }
  }

  Errors check_outputs() {
    Errors errors;
    if (solved_ == 0) return errors;
    std::vector<std::string> known;
    for (const Json& answer : answers_)
      if (is_solved(answer) && known.empty()) collect(answer, "", known);
    for (const StudyOutput& output : study_.outputs) {
      const AnswerPath path(output.path);
      if (output.is_sometimes ||
          std::ranges::any_of(answers_, [&](const Json& a) { return path.number(a).has_value(); }))
        continue;
      const std::vector<std::string_view> names(known.begin(), known.end());
      const std::string_view hint = closest(output.path, names);
      errors.push_back(
          {"unknown_output", fmt::format("{}: outputs.{}", study_.source, output.name),
           fmt::format("no answer has a number at {}{} Numbers there are: {}{}.", in_quotes(output.path),
                       hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                       fmt::join(std::span(names).first(std::min<std::size_t>(names.size(), 12)), ", "),
                       names.size() > 12 ? ", ..." : "")});
    }
    return errors;
  }

  void set_units(TreeSession& session) {
    Document describe{"query", {}};
    describe.root.kind = Node::Kind::map;
    describe.root.members.push_back({.key = "query", .value = make_node("describe")});
    const Json description = session.answer(describe);
    for (StudyOutput& output : study_.outputs) {
      if (!output.unit.empty()) continue;
      output.unit = unit_of_answer(output.path);
      if (!output.path.starts_with("inputs[") || !description.contains("inputs")) continue;
      const Json& inputs = description["inputs"];
      const auto index = static_cast<std::size_t>(std::atoi(output.path.c_str() + 7));
      if (index < inputs.size()) output.unit = inputs[index].value("unit", "");
    }
  }

  Study& study_;
  Errors errors_;
  std::vector<Json> answers_;
  int solved_ = 0;
};

}  // namespace

Expected<std::string> prepare(Study& study) { return Trial(study).run(); }

}  // namespace sinew::inline v0
