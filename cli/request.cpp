#include "request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/parse.hpp"
#include "io/quantity.hpp"
#include "show.hpp"
#include "sinew/io/table.hpp"
#include "sinew/math/so3.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

std::vector<std::string_view> split(std::string_view list) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = list.find(',');
    parts.push_back(trimmed(list.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    list.remove_prefix(comma + 1);
  }
}

/// `"1, 2" has 2 values`.
std::string counted(std::string_view list, std::size_t count) {
  return fmt::format("{} has {} value{}", in_quotes(list), count, count == 1 ? "" : "s");
}

Dimension dimension_of(std::string_view unit) {
  return unit == "m" ? Dimension::length : unit == "rad" ? Dimension::angle : Dimension::number;
}

/// Some lengths, then some of another dimension: poses and twists.
std::vector<Dimension> lengths_then(std::size_t lengths, Dimension other, std::size_t count) {
  std::vector<Dimension> dimensions(lengths, Dimension::length);
  dimensions.resize(lengths + count, other);
  return dimensions;
}

std::string json_list(std::span<const double> values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ", ") + si_text(value);
  return "[" + list + "]";
}

std::string json_pose(std::span<const double> values) {
  if (values.size() == 3)
    return fmt::format(R"({{"x": {}, "y": {}, "phi": {}}})", si_text(values[0]), si_text(values[1]),
                       si_text(values[2]));
  std::vector<double> quaternion(values.begin() + 3, values.end());
  if (values.size() == 6) {
    const auto turn = SO3<double>::exp(Vec3<double>(values[3], values[4], values[5]));
    quaternion = {turn.w, turn.v[0], turn.v[1], turn.v[2]};
  }
  return fmt::format(R"({{"position": {}, "quaternion": {}}})", json_list(values.first(3)),
                     json_list(quaternion));
}

/// Whether three inputs hold z, e1 and e2 of the platform, and the rest of its pose follows.
bool is_held_by_three(const OpenRobot& robot) { return robot.is_on_rods && robot.inputs.size() == 3; }

/// These of a spatial pose.
std::string json_independent(std::span<const double> pose) {
  const auto turn = SO3<double>::exp(Vec3<double>(pose[3], pose[4], pose[5])).canonical();
  return fmt::format(R"({{"z": {}, "e1": {}, "e2": {}}})", si_text(pose[2]), si_text(turn.v[0]),
                     si_text(turn.v[1]));
}

/// `set_at` of the option `set-at`.
std::string member_name(std::string_view option) {
  std::string name(option);
  std::ranges::replace(name, '-', '_');
  return name;
}

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

/// Members of a JSON object being written, and what was wrong with the options.
class Request {
 public:
  Request(std::string_view query, const Arguments& arguments) : query_(query), arguments_(arguments) {
    member("query", json_text(query));
  }

  void member(std::string_view key, Node value) {
    members_.push_back({.key = std::string(key), .value = std::move(value)});
  }
  void member(std::string_view key, std::string_view json) {
    auto value = parse_json(json, "--" + option_name(key));
    if (value)
      member(key, std::move(value->root));
    else  // text of the command line that is no text
      errors_.insert(errors_.end(), value.error().begin(), value.error().end());
  }
  void fail(std::string_view code, std::string_view option, std::string_view message) {
    errors_.push_back({std::string(code), fmt::format("--{}", option), std::string(message)});
  }

  void pose(std::string_view option, const OpenRobot& robot, std::string_view key = {});
  void independent(std::string_view option = "independent", std::string_view key = "independent");
  void path_end(std::string_view option, const OpenRobot& robot);
  void poses(const OpenRobot& robot);
  void inputs(std::string_view option, const OpenRobot& robot, std::string_view key = {});
  void twist(const OpenRobot& robot);
  void wrench(const OpenRobot& robot);
  void until(const OpenRobot& robot);
  void target(const OpenRobot& robot);
  void range();
  void per_section(std::string_view key, Dimension dimension);
  void quantity(std::string_view option, Dimension dimension);
  void vector(std::string_view option, Dimension dimension);
  void list(std::string_view option, std::string_view key, Dimension dimension);
  void per_leg(std::string_view option, std::string_view key, Dimension dimension);
  void signs(std::string_view key);
  void curvature();
  void word(std::string_view option, std::string_view key);
  void words(std::string_view key);
  void whole_number(std::string_view option, std::string_view key);
  void set();

  Expected<Document> done() {
    if (!errors_.empty()) return tl::unexpected(errors_);
    return Document{"query", map_of(std::move(members_))};
  }

 private:
  std::vector<double> values(std::string_view option, std::span<const std::string_view> parts,
                             std::span<const Dimension> dimensions, std::string_view per = {},
                             std::span<const std::string_view> names = {});
  std::string wrench(std::string_view option, const OpenRobot& robot);

  std::string_view query_;
  const Arguments& arguments_;
  std::vector<Member> members_;
  Errors errors_;
};

/// The values of an option in SI; `per` may end a unit: "5 mm/s". What cannot be read is 0, and an error,
/// which tells the value's name where it has one.
std::vector<double> Request::values(std::string_view option, std::span<const std::string_view> parts,
                                    std::span<const Dimension> dimensions, std::string_view per,
                                    std::span<const std::string_view> names) {
  std::vector<double> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string_view bare = parts[i];
    if (!per.empty() && bare.ends_with(per)) bare.remove_suffix(per.size());
    const Expected<double> value = parse_quantity(bare, dimensions[i]);
    result.push_back(value.value_or(0.0));
    if (value) continue;
    const Error& error = value.error().front();
    const std::string name = names.empty() ? "" : fmt::format(" ({})", names[i]);
    errors_.push_back({error.code, fmt::format("--{}, value {}{}", option, i + 1, name), error.message});
  }
  return result;
}

/// A path out of a .csv file: the columns that `track -o` writes, any others are left alone.
void Request::poses(const OpenRobot& robot) {
  const std::string* file = arguments_.text("poses");
  if (!file) return;
  const Expected<Table> table = read_csv(*file);
  if (!table) {
    errors_.insert(errors_.end(), table.error().begin(), table.error().end());
    return;
  }
  std::vector<const Column*> columns;
  for (const Input& column : pose_columns(robot.is_spatial)) {
    const Column* found = table->find(column.name);
    if (!found || found->unit != column.unit)
      return fail(
          "missing_column", "poses",
          fmt::format("{} has no column {}[{}]; a path needs a heading like x[m],y[m],phi[rad] (in space "
                      "x[m],y[m],z[m],rx[rad],ry[rad],rz[rad]).",
                      *file, column.name, column.unit));
    columns.push_back(found);
  }
  std::vector<Node> list;
  list.reserve(table->row_count());
  for (std::size_t k = 0; k < table->row_count(); ++k) {
    std::vector<double> row;
    for (const Column* column : columns) row.push_back(column->values[k]);
    if (!std::ranges::all_of(row, [](double value) { return std::isfinite(value); }))
      return fail("not_a_number", "poses", fmt::format("{}: pose {} has an empty cell.", *file, k + 1));
    list.push_back(
        parse_json(is_held_by_three(robot) ? json_independent(row) : json_pose(row), "poses").value().root);
  }
  member("poses", list_of(std::move(list)));
}

void Request::pose(std::string_view option, const OpenRobot& robot, std::string_view key) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  const auto parts = split(*given);
  const std::size_t count = parts.size();
  if (robot.is_spatial ? count != 6 && count != 7 : count != 3)
    return fail("wrong_length", option,
                fmt::format("{}; {}.", counted(*given, count),
                            robot.is_spatial
                                ? fmt::format("a spatial pose has six, x, y, z and its rotation vector, or "
                                              "seven, x, y, z and its quaternion w, x, y, z: --{} \"0, 0, "
                                              "180 mm, 0, 10 deg, 0\"",
                                              option)
                                : fmt::format("a planar pose has three, x, y, phi: --{} \"10 mm, -5 mm, 10 "
                                              "deg\"",
                                              option)));
  const auto dimensions = count == 3   ? lengths_then(2, Dimension::angle, 1)
                          : count == 6 ? lengths_then(3, Dimension::angle, 3)
                                       : lengths_then(3, Dimension::number, 4);
  const std::vector<double> numbers = values(option, parts, dimensions);
  // the query holds a quaternion, which no longer tells
  for (std::size_t k = 3; k < numbers.size() && count == 6; ++k)
    if (std::abs(numbers[k]) > 2 * std::numbers::pi)
      message(fmt::format("--{}: a rotation of {:.6g} rad is {:.3g} turns; did you mean \"{:.6g} deg\"?",
                          option, numbers[k], std::abs(numbers[k]) / (2 * std::numbers::pi), numbers[k]));
  member(key.empty() ? member_name(option) : std::string(key), json_pose(numbers));
}

/// Where a path begins or ends: a pose, of rods with three inputs what those hold.
void Request::path_end(std::string_view option, const OpenRobot& robot) {
  if (is_held_by_three(robot))
    independent(option, option);
  else
    pose(option, robot);
}

void Request::independent(std::string_view option, std::string_view key) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  auto parts = split(*given);
  const std::size_t count = parts.size();
  std::string mode;
  if (count == 4) {
    mode = fmt::format(R"(, "mode": {})", json_text(parts.back()));
    parts.pop_back();
  }
  if (parts.size() != 3)
    return fail(
        "wrong_length", option,
        fmt::format(
            "{}; {} three, a height and two components of the quaternion{}: --{} \"0.54 m, 0.1, 0.05\".",
            counted(*given, count), option == "independent" ? "it has" : "three rod lengths hold",
            option == "independent" ? ", and after them half_turn for that mode" : "", option));
  const auto values_of = values(option, parts, lengths_then(1, Dimension::number, 2));
  member(key, fmt::format(R"({{"z": {}, "e1": {}, "e2": {}{}}})", si_text(values_of[0]),
                          si_text(values_of[1]), si_text(values_of[2]), mode));
}

void Request::inputs(std::string_view option, const OpenRobot& robot, std::string_view key) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  const auto parts = split(*given);
  std::vector<std::string_view> names;
  std::vector<Dimension> dimensions;
  for (const Input& input : robot.inputs) {
    names.push_back(input.name);
    dimensions.push_back(dimension_of(input.unit));
  }
  if (parts.size() != names.size())
    return fail("wrong_length", option,
                fmt::format("{}; this robot has {} input{}: {}.", counted(*given, parts.size()), names.size(),
                            names.size() == 1 ? "" : "s", fmt::join(names, ", ")));
  member(key.empty() ? option : key, json_list(values(option, parts, dimensions, {}, names)));
}

void Request::twist(const OpenRobot& robot) {
  const std::string* given = arguments_.text("twist");
  if (!given) return;
  const auto parts = split(*given);
  const std::size_t half = robot.is_spatial ? 3 : 2, count = robot.is_spatial ? 6 : 3;
  if (is_held_by_three(robot) && parts.size() == 3)  // vz, wx, wy
    return member("twist", json_list(values("twist", parts, lengths_then(1, Dimension::angle, 2), "/s")));
  if (parts.size() != count)
    return fail("wrong_length", "twist",
                fmt::format("{}; {}.", counted(*given, parts.size()),
                            robot.is_spatial
                                ? "a spatial twist has six, the velocity of the platform and its angular "
                                  "velocity: --twist \"5 mm/s, 0, 0, 0, 0, 2 deg/s\""
                                : "a planar twist has three, the velocity of the platform and its turning "
                                  "rate: --twist \"5 mm/s, 0, 2 deg/s\""));
  member("twist",
         json_list(values("twist", parts, lengths_then(half, Dimension::angle, count - half), "/s")));
}

/// Forces, then moments, as JSON; nothing where there are not as many as the robot's space has.
std::string Request::wrench(std::string_view option, const OpenRobot& robot) {
  const std::string& given = *arguments_.text(option);
  const auto parts = split(given);
  const std::size_t forces = robot.is_spatial ? 3 : 2, count = robot.is_spatial ? 6 : 3;
  if (parts.size() != count) {
    fail("wrong_length", option,
         fmt::format(
             "{}; {}.", counted(given, parts.size()),
             robot.is_spatial
                 ? fmt::format("a spatial wrench has six, force and moment on the platform: --{} \"1 N, "
                               "-0.5 N, -5 N, 0.2 N m, 0.1 N m, -0.1 N m\"",
                               option)
                 : fmt::format("a planar wrench has three, force and moment on the platform: --{} \"1 "
                               "N, -0.5 N, 0.2 N m\"",
                               option)));
    return {};
  }
  std::vector<Dimension> dimensions(forces, Dimension::force);
  dimensions.resize(count, Dimension::moment);
  return json_list(values(option, parts, dimensions));
}

void Request::wrench(const OpenRobot& robot) {
  if (!arguments_.has("wrench")) return;
  if (const std::string list = wrench("wrench", robot); !list.empty()) member("wrench", list);
}

/// What changes along a curve of equilibria: `to` and its members.
void Request::target(const OpenRobot& robot) {
  std::vector<Member> outer;
  std::swap(outer, members_);
  inputs("to-inputs", robot, "inputs");
  per_leg("to-tensions", "tensions", Dimension::force);
  per_leg("to-lengths", "lengths", Dimension::length);
  if (arguments_.has("to-wrench")) member("wrench", wrench("to-wrench", robot));
  pose("to", robot, "pose");
  std::swap(outer, members_);
  if (!outer.empty()) member("to", map_of(std::move(outer)));
}

/// Of the parameter along a curve: LOW, HIGH.
void Request::range() {
  const std::string* given = arguments_.text("range");
  if (!given) return;
  const auto parts = split(*given);
  if (parts.size() != 2)
    return fail("wrong_length", "range",
                fmt::format("{}; it has two, the lowest and the highest: --range \"-1, 2\".",
                            counted(*given, parts.size())));
  member("range", json_list(values("range", parts, std::vector<Dimension>(2, Dimension::number))));
}

/// A load that grows, and how far.
void Request::until(const OpenRobot& robot) {
  const std::string *given = arguments_.text("until"), *limit = arguments_.text("limit");
  if (given && !limit)
    return fail(
        "missing_option", "limit",
        "--until needs it: how many times its wrench is added at most: --until \"0, 0, -1 N, 0, 0, 0\" "
        "--limit 200.");
  if (limit && !given)
    return fail("no_effect", "limit", "it ends --until, which is not given; give both, or leave it out.");
  if (!given) return;
  const std::string list = wrench("until", robot);
  const Expected<double> most = parse_quantity(*limit, Dimension::number);
  if (!most) return fail(most.error().front().code, "limit", most.error().front().message);
  if (!list.empty()) member("until", fmt::format(R"({{"wrench": {}, "limit": {}}})", list, si_text(*most)));
}

/// Some values for each section, sections apart by semicolons; of one section they are a plain list where the
/// query takes that for the section's own.
void Request::per_section(std::string_view key, Dimension dimension) {
  const std::string* given = arguments_.text(key);
  if (!given) return;
  std::string list;
  std::string_view rest = *given;
  std::size_t sections = 0;
  for (bool more = true; more; ++sections) {
    const std::size_t end = rest.find(';');
    const auto parts = split(rest.substr(0, end));
    std::vector<Dimension> dimensions(parts.size(), dimension);
    if (dimension == Dimension::angle && parts.size() == 3)
      dimensions[2] = Dimension::length;  // the extension
    list += (sections ? ", " : "") + json_list(values(key, parts, dimensions));
    more = end != std::string_view::npos;
    if (more) rest.remove_prefix(end + 1);
  }
  const bool is_own = sections == 1 && query_ == "diagram";
  member(key, is_own ? list : "[" + list + "]");
}

void Request::quantity(std::string_view option, Dimension dimension) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  const Expected<double> value = parse_quantity(*given, dimension);
  if (value) return member(member_name(option), si_text(*value));
  fail(value.error().front().code, option, value.error().front().message);
}

void Request::list(std::string_view option, std::string_view key, Dimension dimension) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  const auto parts = split(*given);
  member(key, json_list(values(option, parts, std::vector<Dimension>(parts.size(), dimension))));
}

/// Two values for each leg, legs apart by semicolons; `-` where no length is held.
void Request::per_leg(std::string_view option, std::string_view key, Dimension dimension) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  std::string list;
  std::string_view rest = *given;
  for (bool more = true; more;) {
    const std::size_t end = rest.find(';');
    std::string pair;
    for (const std::string_view part : split(rest.substr(0, end))) {
      const bool is_loose = part == "-" && dimension == Dimension::length;
      const std::string value = is_loose ? "" : json_list(values(option, {&part, 1}, {&dimension, 1}));
      pair += (pair.empty() ? "" : ", ") + (is_loose ? "null" : value.substr(1, value.size() - 2));
    }
    list += fmt::format("{}[{}]", list.empty() ? "" : ", ", pair);
    more = end != std::string_view::npos;
    if (more) rest.remove_prefix(end + 1);
  }
  member(key, "[" + list + "]");
}

void Request::vector(std::string_view option, Dimension dimension) {
  const std::string* given = arguments_.text(option);
  if (!given) return;
  const auto parts = split(*given);
  if (parts.size() != 3)
    return fail("wrong_length", option,
                fmt::format("{}; it has three, x, y, z.", counted(*given, parts.size())));
  member(option, json_list(values(option, parts, std::vector<Dimension>(3, dimension))));
}

void Request::signs(std::string_view key) {
  const std::string* given = arguments_.text(key);
  if (!given) return;
  std::string list;
  for (const std::string_view sign : split(*given)) {
    const bool plus = sign == "+" || sign == "+1" || sign == "1", minus = sign == "-" || sign == "-1";
    if (!plus && !minus)
      return fail(
          "not_a_sign", key,
          fmt::format("{} is no sign; give + or - for each leg: --{} \"+,-,+\".", in_quotes(sign), key));
    list += fmt::format("{}{}", list.empty() ? "" : ", ", plus ? 1 : -1);
  }
  member(key, "[" + list + "]");
}

void Request::curvature() {
  const std::string* given = arguments_.text("curvature");
  if (!given) return;
  const auto parts = split(*given);
  const std::vector<Dimension> dimensions(parts.size(), Dimension::curvature);
  member("curvature", json_list(values("curvature", parts, dimensions)));
}

void Request::word(std::string_view option, std::string_view key) {
  if (const std::string* given = arguments_.text(option)) member(key, json_text(*given));
}

void Request::words(std::string_view key) {
  const std::string* given = arguments_.text(key);
  if (!given) return;
  std::string list;
  for (const std::string_view word : split(*given)) list += (list.empty() ? "" : ", ") + json_text(word);
  member(key, "[" + list + "]");
}

void Request::whole_number(std::string_view option, std::string_view key) {
  if (const std::string* given = arguments_.text(option)) {
    const Expected<double> value = parse_quantity(*given, Dimension::count);
    if (value) return member(key, si_text(*value));
    fail(value.error().front().code, option, value.error().front().message);
  }
}

void Request::set() {
  const auto changes = settings(arguments_);
  if (!changes) return fail(changes.error().front().code, "set", changes.error().front().message);
  if (!changes->empty()) member("set", map_of(*changes));
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

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
  Request about("describe", arguments);
  about.set();
  about.word("theta-is", "theta_is");
  const auto query = about.done();
  if (!query) return tl::unexpected(query.error());
  const bool is_quiet = arguments.has("quiet");
  Answer description = ask(*session, *query, is_quiet);
  if (const Errors errors = description.errors(); !errors.empty()) return tl::unexpected(errors);
  std::vector<Input> inputs;
  for (const Node& input : description.find("inputs")->items)
    inputs.push_back({input.find("name")->text, input.find("unit")->text});
  const bool is_spatial = description.text("space") == "spatial";
  const bool is_on_rods = description.text("model") == "rod";
  return OpenRobot{
      std::move(*session), std::move(description), std::move(inputs), is_spatial, is_on_rods, is_quiet};
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
  return robot;
}

Member at_home(const OpenRobot& robot) {
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
  Request request(query, arguments);
  const bool is_curve = arguments.verb == "branches";
  request.pose("pose", robot);
  request.path_end("from", robot);
  if (is_curve)
    request.target(robot);
  else
    request.path_end("to", robot);
  request.range();
  if (arguments.has("backward")) request.member("backward", "true");
  request.pose("set-at", robot);
  if (query == "statics" && arguments.has("pose")) request.member("inverse", "true");
  request.per_leg("tensions", "tensions", Dimension::force);
  request.per_leg("lengths", "lengths", Dimension::length);
  request.word("hold", "hold");
  request.word("law", "law");
  request.quantity("posture-threshold", Dimension::angle);
  request.whole_number("rk4-steps", "rk4_steps");
  request.independent();
  request.poses(robot);
  request.inputs("inputs", robot);
  if (is_serial(robot))
    request.per_section("start", Dimension::angle);
  else if (query == "inverse" || (query == "track" && !is_curve))
    request.inputs("start", robot);
  else
    request.pose("start", robot);
  request.signs("bending");
  request.signs("elbow");
  request.curvature();
  request.twist(robot);
  request.wrench(robot);
  request.vector("gravity", Dimension::acceleration);
  if (query == "diagram") {
    request.word("envelope", "envelope");
    const std::string* envelope = arguments.text("envelope");
    request.quantity("limit", envelope && *envelope == "actuator" ? Dimension::length : Dimension::angle);
    request.whole_number("section", "section");
  } else {
    request.until(robot);
  }
  request.per_section("configuration", Dimension::angle);
  request.per_section("changes", Dimension::length);
  request.per_section("measured", Dimension::length);
  request.list("slack", "slack", Dimension::length);
  request.list("axial-forces", "axial_forces", Dimension::force);
  request.list("measured-tensions", "measured_tensions", Dimension::force);
  request.quantity("deviation", Dimension::force);
  request.quantity("tolerance", Dimension::length);
  request.vector("position", Dimension::length);
  request.vector("direction", Dimension::number);
  request.words("want");
  request.word("objective", "objective");
  request.word("model", "model");
  request.word("theta-is", "theta_is");
  request.whole_number("samples", "samples");
  request.whole_number("max-iterations", "max_iterations");
  if (arguments.has("all")) request.member(is_curve ? "branches" : "all", "true");
  request.set();
  return request.done();
}

}  // namespace sinew::cli
