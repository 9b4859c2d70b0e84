#include "answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "sinew/io/parse.hpp"
#include "sinew/io/quantity.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

/// A text that begins with a field of the query, with the option of that field instead: `--pose.x` for
/// `pose.x`.
std::string as_option(std::string where) {
  for (const auto& [path, option] : {std::pair("until.limit", "limit"), std::pair("until.wrench", "until")})
    if (where.starts_with(path)) where.replace(0, std::string_view(path).size(), option);
  const std::string field = where.substr(0, where.find_first_of(".[ :"));
  std::string name = field;
  std::ranges::replace(name, '_', '-');
  const bool is_option = std::ranges::any_of(verbs(), [&](const Verb& verb) {
    return std::ranges::find(verb.options, std::string_view(name)) != verb.options.end();
  });
  return is_option ? "--" + name + where.substr(field.size()) : where;
}

}  // namespace

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
  if (status == "converged") return solved;
  return status == "iteration_limit" ? stopped : no_solution;
}

std::vector<double> numbers(const Node* list) {
  std::vector<double> values;
  if (list)
    for (const Node& item : list->items) values.push_back(item.number);
  return values;
}

double number(const Node& map, std::string_view path) {
  const Node* node = at(map, path);
  return node ? node->number : 0.0;
}

}  // namespace sinew::cli
