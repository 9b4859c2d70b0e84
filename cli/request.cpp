#include "request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/io/parse.hpp"
#include "sinew/io/quantity.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

std::vector<std::string_view> split(std::string_view list) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = list.find(',');
    parts.push_back(trimmed(list.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    list.remove_prefix(comma + 1);
  }
}

/// Members of a JSON object being written, and what was wrong with the options.
class Request {
 public:
  explicit Request(const Arguments& arguments) : arguments_(arguments) {}

  void member(std::string_view key, std::string_view json) {
    text_ += fmt::format("{}{}: {}", text_.empty() ? "" : ", ", json_text(key), json);
  }
  void fail(std::string_view code, std::string_view option, std::string_view message) {
    errors_.push_back({std::string(code), fmt::format("--{}", option), std::string(message)});
  }

  void pose(std::string_view key);
  void quantities(std::string_view key, Dimension dimension);
  void inputs();
  void bending();
  void twist();
  void whole_number(std::string_view option, std::string_view key);
  void set();

  Expected<std::string> done() const {
    return errors_.empty() ? Expected<std::string>("{" + text_ + "}") : tl::unexpected(errors_);
  }

 private:
  std::string number(std::string_view option, std::string_view text, std::size_t index, Dimension dimension,
                     std::string_view per = {});

  const Arguments& arguments_;
  std::string text_;
  Errors errors_;
};

/// One value of an option as an SI number in JSON; `per` may end its unit: "5 mm/s".
std::string Request::number(std::string_view option, std::string_view text, std::size_t index,
                            Dimension dimension, std::string_view per) {
  std::string_view bare = text;
  if (!per.empty() && bare.ends_with(per)) bare.remove_suffix(per.size());
  const Expected<double> value = parse_quantity(bare, dimension);
  if (value) return si_text(*value);
  const Error& error = value.error().front();
  errors_.push_back({error.code, fmt::format("--{}, value {}", option, index + 1), error.message});
  return "0";
}

void Request::pose(std::string_view key) {
  const std::string* given = arguments_.text(key);
  if (!given) return;
  const auto parts = split(*given);
  if (parts.size() != 3)
    return fail(
        "wrong_length", key,
        fmt::format("{} has {} value{}; a planar pose has three, x, y, phi: --{} \"10 mm, -5 mm, 10 deg\".",
                    in_quotes(*given), parts.size(), parts.size() == 1 ? "" : "s", key));
  const std::string x = number(key, parts[0], 0, Dimension::length),
                    y = number(key, parts[1], 1, Dimension::length),
                    phi = number(key, parts[2], 2, Dimension::angle);
  member(key, fmt::format(R"({{"x": {}, "y": {}, "phi": {}}})", x, y, phi));
}

void Request::quantities(std::string_view key, Dimension dimension) {
  const std::string* given = arguments_.text(key);
  if (!given) return;
  std::string list;
  const auto parts = split(*given);
  for (std::size_t i = 0; i < parts.size(); ++i)
    list += fmt::format("{}{}", i ? ", " : "", number(key, parts[i], i, dimension));
  member(key, "[" + list + "]");
}

void Request::bending() {
  const std::string* given = arguments_.text("bending");
  if (!given) return;
  std::string list;
  for (const std::string_view sign : split(*given)) {
    const bool plus = sign == "+" || sign == "+1" || sign == "1", minus = sign == "-" || sign == "-1";
    if (!plus && !minus)
      return fail(
          "not_a_sign", "bending",
          fmt::format("{} is no sign; give + or - for each leg: --bending \"+,-,+\".", in_quotes(sign)));
    list += fmt::format("{}{}", list.empty() ? "" : ", ", plus ? 1 : -1);
  }
  member("bending", "[" + list + "]");
}

void Request::twist() {
  const std::string* given = arguments_.text("twist");
  if (!given) return;
  const auto parts = split(*given);
  if (parts.size() != 3)
    return fail(
        "wrong_length", "twist",
        fmt::format(
            "{} has {} value{}; a planar twist has three, the velocity of the platform and its turning "
            "rate: --twist \"5 mm/s, 0, 2 deg/s\".",
            in_quotes(*given), parts.size(), parts.size() == 1 ? "" : "s"));
  std::string list;
  for (std::size_t i = 0; i < parts.size(); ++i)
    list += fmt::format("{}{}", i ? ", " : "",
                        number("twist", parts[i], i, i < 2 ? Dimension::length : Dimension::angle, "/s"));
  member("twist", "[" + list + "]");
}

void Request::whole_number(std::string_view option, std::string_view key) {
  if (const std::string* given = arguments_.text(option)) {
    const Expected<double> value = parse_quantity(*given, Dimension::count);
    if (value) return member(key, si_text(*value));
    fail(value.error().front().code, option, value.error().front().message);
  }
}

/// A value of `--set` as YAML reads it.
Expected<Node> value_of(std::string_view text) {
  if (!text.starts_with('[') && !text.starts_with('{')) return plain_scalar(text);
  auto document = parse_yaml(text, "--set");
  if (!document) return tl::unexpected(document.error());
  return std::move(document->root);
}

std::string as_json(const Node& node) {
  const auto list = [](const auto& parts, const auto& write) {
    std::string text;
    for (const auto& part : parts) text += (text.empty() ? "" : ", ") + write(part);
    return text;
  };
  switch (node.kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::number:
      return si_text(node.number);
    case Node::Kind::string:
      return json_text(node.text);
    case Node::Kind::list:
      return "[" + list(node.items, as_json) + "]";
    case Node::Kind::map:
      break;
  }
  return "{" +
         list(node.members, [](const Member& m) { return json_text(m.key) + ": " + as_json(m.value); }) + "}";
}

void Request::set() {
  const auto given = arguments_.options.find("set");
  if (given == arguments_.options.end()) return;
  std::string members;
  for (const std::string& change : given->second) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
      return fail(
          "not_a_change", "set",
          fmt::format("{} is no path=value; write --set \"legs[0].link.length=180 mm\".", in_quotes(change)));
    const auto value = value_of(trimmed(std::string_view(change).substr(equals + 1)));
    if (!value) return fail(value.error().front().code, "set", value.error().front().message);
    const std::string path = json_text(trimmed(std::string_view(change).substr(0, equals)));
    members += fmt::format("{}{}: {}", members.empty() ? "" : ", ", path, as_json(*value));
  }
  member("set", "{" + members + "}");
}

/// A text that begins with a field of the query, with the option of that field instead: `--pose.x` for
/// `pose.x`.
std::string as_option(std::string where) {
  const std::string field = where.substr(0, where.find_first_of(".[ :"));
  std::string name = field;
  std::ranges::replace(name, '_', '-');
  const bool is_option = std::ranges::any_of(verbs(), [&](const Verb& verb) {
    return std::ranges::find(verb.options, std::string_view(name)) != verb.options.end();
  });
  return is_option ? "--" + name + where.substr(field.size()) : where;
}

}  // namespace

Expected<std::string> request(std::string_view query, const Arguments& arguments) {
  Request request(arguments);
  request.member("query", json_text(query));
  request.pose("pose");
  request.quantities("inputs", Dimension::length);
  request.pose("start");
  request.bending();
  request.quantities("curvature", Dimension::curvature);
  request.twist();
  request.whole_number("max-iterations", "max_iterations");
  if (const std::string* model = arguments.text("model")) request.member("model", json_text(*model));
  if (arguments.has("all")) request.member("all", "true");
  request.set();
  return request.done();
}

std::string json_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      quoted += c;
  }
  return quoted + '"';
}

std::string json_error(const Errors& errors) {
  std::string message = errors.front().message;
  for (std::size_t i = 1; i < errors.size(); ++i)
    message +=
        fmt::format("{} {}: {}", message.ends_with('.') ? "" : ";", errors[i].where, errors[i].message);
  return fmt::format(R"({{"error":{{"code":{},"where":{},"message":{}}}}})", json_text(errors.front().code),
                     json_text(errors.front().where), json_text(message));
}

Answer ask(Session& session, const std::string& query) {
  Answer answer{session.answer(query), {}};
  auto tree = parse_json(answer.line, "answer");
  if (!tree) throw std::runtime_error("an answer cannot be read: " + to_string(tree.error()));
  answer.tree = std::move(*tree);
  return answer;
}

Answer describe(Session& session, const Arguments& arguments) {
  Arguments about{arguments.verb, {}, {}};
  if (const auto set = arguments.options.find("set"); set != arguments.options.end())
    about.options.insert(*set);
  return ask(session, request("describe", about).value());
}

std::string Answer::text(std::string_view path) const {
  const Node* node = find(path);
  return node ? node->text : std::string();
}

std::optional<double> Answer::number(std::string_view path) const {
  const Node* node = find(path);
  return node && node->kind == Node::Kind::number ? std::optional(node->number) : std::nullopt;
}

Errors Answer::errors() const {
  if (!find("error")) return {};
  const std::string where = text("error.where"), said = text("error.message");
  if (where == "query") return {{text("error.code"), "", said}};  // the command line as a whole
  return {{text("error.code"), as_option(where), said.starts_with(where) ? as_option(said) : said}};
}

int exit_code(const Answer& answer) {
  if (answer.find("error")) return bad_input;
  const std::string status = answer.text("status");
  if (status == "converged" || status == "unstable") return solved;
  return status == "iteration_limit" ? stopped : no_solution;
}

std::vector<double> numbers(const Node* list) {
  std::vector<double> values;
  if (list)
    for (const Node& item : list->items) values.push_back(item.number);
  return values;
}

}  // namespace sinew::cli
