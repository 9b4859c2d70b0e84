#include "study/sweep/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "query/batch/answer_path.hpp"
#include "query/batch/placeholders.hpp"
#include "query/fields/answer_places.hpp"
#include "query/tree_session.hpp"
#include "study/sweep/left_out.hpp"
#include "study/sweep/samples.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::size_t trials = 24;
constexpr std::size_t max_paths = 400;
constexpr std::size_t max_left_out = 20'000;        ///< passed over in search of a sample to try
constexpr std::size_t max_looked_at = 100'000'000;  ///< where few are kept: some seconds

/// Places of all numbers of a tree.
void collect(const Node& node, const std::string& path, std::vector<std::string>& paths) {
  if (paths.size() >= max_paths) return;
  if (node.kind == Node::Kind::number || node.kind == Node::Kind::boolean) paths.push_back(path);
  for (const Member& member : node.members) collect(member.value, joined(path, member.key), paths);
  for (std::size_t i = 0; i < node.items.size(); ++i) collect(node.items[i], joined(path, i), paths);
}

bool is_solved(const Value& answer) {
  const std::string_view status = answer.text_at("status");
  return status.empty() || status == "converged" || status == "unstable";
}

/// `pose.position[2]` as the name of a column: `z`; `legs[0].curvature`: `legs_0_curvature`.
std::string column_of(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 13> known{{
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
      {"pose.tilt", "tilt"},
      {"pose.azimuth", "azimuth"},
      {"pose.torsion", "torsion"},
  }};
  for (const auto& [place, name] : known)
    if (place == path) return std::string(name);
  return name_of_place(path);
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
  explicit Trial(Study& study) : study_(study), values_(study.variable_count()) {}

  Expected<std::string> run() {
    auto session = TreeSession::open(study_.robot_document);
    if (!session) return tl::unexpected(session.error());
    ask(*session);
    if (answers_.empty() && errors_.empty())
      return failure("all_left_out", study_.source + ": derived", all_out());
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
    return answers_.size() == 1 ? std::string("the one sample tried has no solution")
                                : fmt::format("none of {} samples tried has a solution", answers_.size());
  }

 private:
  void ask(TreeSession& session) {
    Document query = study_.query;
    const auto places = placeholders(query.root, study_.variable_names());
    const auto begin = std::chrono::steady_clock::now();
    for (const std::size_t sample : chosen()) {
      const bool takes_long = std::chrono::steady_clock::now() - begin > std::chrono::seconds(2);
      if (takes_long && solved_ > 0) break;  // some queries take seconds
      axis_values(study_, {sample, 1}, false, values_);
      for (const Placeholder& place : places)
        if (const auto words = words_of(*place.input); words.empty())
          put(*place.node, values_[*place.input], study_.column_unit(*place.input));
        else
          put(*place.node, values_[*place.input], words);
      Value answer = session.answer(query);
      if (answer.text_at("status") == to_string(Status::unsupported)) {
        if (errors_.empty())
          errors_ = {{"not_available", fmt::format("{}: query", study_.source),
                      std::string(answer.text_at("message"))}};
        continue;
      }
      if (const Value* error = answer.find("error")) {
        if (errors_.empty())
          errors_ = {{std::string(error->text_at("code")), place_of(std::string(error->text_at("where"))),
                      std::string(error->text_at("message"))}};
        continue;
      }
      solved_ += is_solved(answer);
      answers_.push_back(std::move(answer));
    }
  }

  std::span<const std::string> words_of(std::size_t variable) const {
    return variable < study_.axes.size() ? study_.axes[variable].words : std::span<const std::string>();
  }

  std::string all_out() const {
    std::string names;
    for (const StudyDerived& derived : study_.derived)
      if (std::isfinite(derived.low) || std::isfinite(derived.high))
        names += (names.empty() ? "" : ", ") + derived.name;
    return fmt::format("{} samples are outside the limits of {}; widen from and to, or the axes",
                       study_.samples <= max_looked_at ? "all" : "the first 1e8", names);
  }

  /// The first and the last sample, and between them places that no axis repeats; of those left out the next
  /// that is not, and where so few are kept that there is none nearby, some of all.
  std::vector<std::size_t> chosen() const {
    const std::size_t n = study_.samples, count = std::min(trials, n);
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < count; ++t) {
      const std::size_t first = t + 1 == count
                                    ? n - 1
                                    : static_cast<std::size_t>(static_cast<double>(n) * 0.6180339887498949 *
                                                               static_cast<double>(t)) %
                                          n;
      std::size_t passed = 0;
      while (passed < std::min(n, max_left_out) && !is_kept((first + passed) % n)) ++passed;
      if (passed == std::min(n, max_left_out)) return chosen_of_all();
      found.push_back((first + passed) % n);
    }
    return found;
  }

  /// Each kept sample has the same chance (reservoir sampling).
  std::vector<std::size_t> chosen_of_all() const {
    std::vector<std::size_t> found;
    std::minstd_rand random;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < std::min(study_.samples, max_looked_at); ++k) {
      if (!is_kept(k)) continue;
      const std::size_t place = ++kept <= trials ? kept - 1 : random() % kept;
      if (found.size() < trials) found.push_back(k);
      if (place < trials) found[place] = k;
    }
    return found;
  }

  bool is_kept(std::size_t sample) const {
    axis_values(study_, {sample, 1}, false, values_);
    return !is_left_out(study_, values_);
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
    collect(solved->node(), "", paths);
    const std::string query(solved->text_at("query"));
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
    for (const Value& answer : answers_)
      if (is_solved(answer) && known.empty()) collect(answer.node(), "", known);
    for (const StudyOutput& output : study_.outputs) {
      const AnswerPath path(output.path);
      if (output.is_sometimes ||
          std::ranges::any_of(answers_, [&](const Value& a) { return path.number(a).has_value(); }))
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
    const Value description = session.answer(describe);
    const AnswerPlaces places(ask_of(answers_.front().text_at("query")).value());
    for (StudyOutput& output : study_.outputs) {
      if (!output.unit.empty()) continue;
      output.unit = places.unit(output.path);
      if (!output.path.starts_with("inputs[") || !description.contains("inputs")) continue;
      const Value::List& inputs = *description.find("inputs")->items();
      const auto index = static_cast<std::size_t>(std::atoi(output.path.c_str() + 7));
      if (index < inputs.size()) output.unit = inputs[index].text_at("unit");
    }
  }

  Study& study_;
  mutable std::vector<double> values_;  ///< of one sample
  Errors errors_;
  std::vector<Value> answers_;
  int solved_ = 0;
};

}  // namespace

Expected<std::string> prepare(Study& study) { return Trial(study).run(); }

}  // namespace sinew::inline v1
