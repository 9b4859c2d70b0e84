#include "request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "option_reader.hpp"
#include "show.hpp"

namespace sinew::cli {
namespace {

std::string option_name(std::string_view member) {
  std::string name(member);
  std::ranges::replace(name, '_', '-');
  return name;
}

/// A value of `--set` as YAML reads it.
Expected<Node> value_of(std::string_view text) {
  if (!text.starts_with('[') && !text.starts_with('{')) return plain_scalar(text);
  auto document = parse_yaml(text, "--set");
  if (!document) return tl::unexpected(document.error());
  return std::move(document->root);
}

/// A question out of options.
class Request {
 public:
  Request(std::string_view query, const Arguments& arguments, const OpenRobot* robot)
      : arguments_(arguments),
        reader_(query, arguments, robot) {
    member("query", make_node(query));
  }

  void member(std::string_view key, Node value) { members_.push_back(member_of(key, std::move(value))); }
  /// From the option of its name, if it is given.
  void field(const Field& field);
  void target();
  void growing_load();
  void changes();
  void want_both();

  Expected<Document> done() {
    if (!reader_.errors().empty()) return tl::unexpected(reader_.errors());
    return Document{"query", map_of(std::move(members_))};
  }

 private:
  const Arguments& arguments_;
  OptionReader reader_;
  std::vector<Member> members_;
};

void Request::field(const Field& field) {
  const std::string option = option_name(field.name);
  if (!arguments_.has(option)) return;
  const std::string* text = arguments_.text(option);
  if (auto value = reader_.read(field, option, text ? std::string_view(*text) : std::string_view()))
    member(field.name, std::move(*value));
}

/// What changes along a curve of equilibria: `to` and its members.
void Request::target() {
  std::vector<Member> to;
  const auto put = [&](std::string_view option, std::string_view key, auto read) {
    const std::string* text = arguments_.text(option);
    if (!text) return;
    if (auto value = read(option, *text)) to.push_back(member_of(key, std::move(*value)));
  };
  using View = std::string_view;
  put("to-inputs", "inputs", [&](View option, View text) { return reader_.inputs(option, text); });
  put("to-tensions", "tensions",
      [&](View option, View text) { return reader_.pairs(option, text, Dimension::force); });
  put("to-lengths", "lengths",
      [&](View option, View text) { return reader_.pairs(option, text, Dimension::length); });
  put("to-wrench", "wrench", [&](View option, View text) { return reader_.wrench(option, text); });
  put("to", "pose", [&](View option, View text) { return reader_.pose(option, text); });
  if (!to.empty()) member("to", map_of(std::move(to)));
}

/// A load that grows, and how far.
void Request::growing_load() {
  const std::string *given = arguments_.text("until"), *limit = arguments_.text("limit");
  if (given && !limit)
    return reader_.fail(
        "missing_option", "limit",
        "--until needs it: how many times its wrench is added at most: --until \"0, 0, -1 N, 0, 0, 0\" "
        "--limit 200.");
  if (limit && !given)
    return reader_.fail("no_effect", "limit",
                        "it ends --until, which is not given; give both, or leave it out.");
  if (!given) return;
  auto list = reader_.wrench("until", *given);
  auto most = reader_.quantity("limit", *limit, Dimension::number);
  if (list && most)
    member("until", map_of({member_of("wrench", std::move(*list)), member_of("limit", std::move(*most))}));
}

/// What `--set` changes.
void Request::changes() {
  const auto found = settings(arguments_);
  if (!found) return reader_.fail(found.error().front().code, "set", found.error().front().message);
  if (!found->empty()) member("set", map_of(*found));
}

/// Tables show the pose and the legs: where a list of wants names one of them, the other one, too.
void Request::want_both() {
  const auto want = std::ranges::find(members_, "want", &Member::key);
  if (want == members_.end()) return;
  std::vector<Node>& words = want->value.items;
  const auto has = [&](std::string_view word) {
    return std::ranges::find(words, word, &Node::text) != words.end();
  };
  for (const auto& [named, other] : {std::pair{"pose", "legs"}, std::pair{"legs", "pose"}})
    if (has(named) && !has(other)) words.push_back(make_node(other));
}

}  // namespace

int whole_option(const Arguments& arguments, std::string_view name, int least, int most, int otherwise,
                 Errors& errors) {
  const std::string* text = arguments.text(name);
  if (!text) return otherwise;
  const auto value = parse_quantity(*text, Dimension::count);
  if (value && *value >= least && *value <= most) return static_cast<int>(*value);
  errors.push_back({"out_of_range", fmt::format("--{}", name),
                    fmt::format("{} is no whole number from {} to {}.", in_quotes(*text), least, most)});
  return otherwise;
}

Expected<std::vector<Member>> settings(const Arguments& arguments) {
  std::vector<Member> members;
  const auto given = arguments.options.find("set");
  if (given == arguments.options.end()) return members;
  for (const std::string& change : given->second) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
      return failure(
          "not_a_change", "--set",
          fmt::format("{} is no path=value; write --set \"legs[0].link.length=180 mm\".", in_quotes(change)));
    auto value = value_of(trimmed(std::string_view(change).substr(equals + 1)));
    if (!value) return failure(value.error().front().code, "--set", value.error().front().message);
    members.push_back({.key = std::string(trimmed(std::string_view(change).substr(0, equals))),
                       .value = std::move(*value)});
  }
  return members;
}

std::string OpenRobot::input_unit() const {
  const auto is_first = [&](const Input& input) { return input.unit == inputs.front().unit; };
  return !inputs.empty() && std::ranges::all_of(inputs, is_first) ? inputs.front().unit : std::string();
}

Expected<OpenRobot> open(const Arguments& arguments) {
  auto session = Session::open(arguments.operand());
  if (!session) return tl::unexpected(session.error());
  const bool is_quiet = arguments.has("quiet");
  const auto describe = [&](bool is_of_lengths) -> Expected<Answer> {
    Request about("describe", arguments, nullptr);
    about.changes();
    about.field(*find_field("theta_is"));
    if (is_of_lengths) about.member("model", make_node("lsk"));
    const auto query = about.done();
    if (!query) return tl::unexpected(query.error());
    Answer answer = ask(*session, *query, is_quiet);
    if (const Errors errors = answer.errors(); !errors.empty()) return tl::unexpected(errors);
    return answer;
  };
  auto description = describe(false);
  const std::string* model = arguments.text("model");
  const bool is_of_lengths = arguments.verb == "diagram" || (model && (*model == "pcc" || *model == "lsk"));
  if (description && description->text("kind") == "arm" && is_of_lengths) {
    description = describe(true);  // it is asked as a serial robot
    if (description && description->text("status") == "unsupported")
      return failure("not_available", "", description->text("message"));
  }
  if (!description) return tl::unexpected(description.error());
  std::vector<Input> inputs;
  for (const Node& input : description->find("inputs")->items)
    inputs.push_back({input.find("name")->text, input.find("unit")->text});
  const bool is_spatial = description->text("space") == "spatial";
  const bool is_on_rods = description->text("model") == "rod";
  return OpenRobot{
      std::move(*session), std::move(*description), std::move(inputs), is_spatial, is_on_rods, is_quiet};
}

Expected<OpenRobot> open_with_platform(const Arguments& arguments) {
  auto robot = open(arguments);
  if (robot && is_serial(*robot))
    return tl::unexpected(Errors{
        {"not_available", "",
         fmt::format(
             "{} is a serial robot; {} is for robots with a platform in this version. Of a serial robot ask "
             "forward, inverse, analyse or diagram, pose by pose",
             robot->description.text("robot"), arguments.verb)}});
  if (robot && is_arm(*robot))
    return tl::unexpected(Errors{{"not_available", "",
                                  fmt::format("{} is an arm without a platform; {} is for robots with one",
                                              robot->description.text("robot"), arguments.verb)}});
  if (robot && stands_on_arms(*robot))
    return tl::unexpected(
        Errors{{"not_available", "",
                fmt::format("{} stands on legs of sections; of these {} is not available in "
                            "this version: ask forward or analyse",
                            robot->description.text("robot"), arguments.verb)}});
  return robot;
}

Member at_home(const OpenRobot& robot) {
  if (is_arm(robot) || stands_on_arms(robot))
    return {.key = "changes", .value = list_of({})};                            // as long as at rest
  if (is_serial(robot)) return {.key = "configuration", .value = list_of({})};  // straight
  const Node& home = *robot.description.find("home");
  if (!robot.is_on_rods || robot.inputs.size() == 6) return {.key = "pose", .value = home};
  std::vector<Member> free;
  for (const auto& [key, path] :
       {std::pair("z", "position[2]"), std::pair("e1", "quaternion[1]"), std::pair("e2", "quaternion[2]")})
    free.push_back({.key = key, .value = make_node(number(home, path))});
  return {.key = "independent", .value = map_of(std::move(free))};
}

Answer ask(OpenRobot& robot, const Document& query) { return ask(robot.session, query, robot.is_quiet); }

Expected<Document> request(std::string_view query, const Arguments& arguments, const OpenRobot& robot) {
  Request request(query, arguments, &robot);
  const bool is_curve = arguments.verb == "branches";
  for (const Field& field : question_fields()) {
    const bool is_spelled_otherwise = (is_curve && (field.name == "to" || field.name == "all")) ||
                                      (field.name == "limit" && query != "diagram");
    if (!is_spelled_otherwise) request.field(field);
  }
  if (is_curve) request.target();
  if (query != "diagram") request.growing_load();
  if (query == "statics" && arguments.has("pose") && !stands_on_arms(robot))
    request.member("inverse", make_node(true));
  if (is_curve && arguments.has("all")) request.member("branches", make_node(true));
  request.changes();
  if (!arguments.has("json") && !is_serial(robot) && !is_arm(robot) && !stands_on_arms(robot))
    request.want_both();
  return request.done();
}

}  // namespace sinew::cli
