#include "answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "terminal.hpp"
#include "verbs.hpp"
#include "waiting.hpp"

namespace sinew::cli {
namespace {

/// The option of a field of queries, without dashes; empty where there is none.
std::string option_of(std::string_view field) {
  constexpr std::pair<std::string_view, std::string_view> others[] = {{"until.limit", "limit"},
                                                                      {"until.wrench", "until"},
                                                                      {"to.inputs", "to-inputs"},
                                                                      {"to.tensions", "to-tensions"},
                                                                      {"to.lengths", "to-lengths"},
                                                                      {"to.wrench", "to-wrench"},
                                                                      {"to.pose", "to"},
                                                                      {"branches", "all"}};
  for (const auto& [path, option] : others)
    if (field == path) return std::string(option);
  std::string name(field);
  std::ranges::replace(name, '_', '-');
  const bool is_option = std::ranges::any_of(verbs(), [&](const Verb& verb) {
    return std::ranges::find(verb.options, std::string_view(name)) != verb.options.end();
  });
  return is_option ? name : std::string();
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Fields of the query as a path begins with them, or alone: `until.limit`, `pose`.
std::size_t field_size(std::string_view path) {
  const auto end_of = [&](std::size_t from) {
    while (from < path.size() && is_word(path[from])) ++from;
    return from;
  };
  const std::size_t first = end_of(0);
  if (first + 1 < path.size() && path[first] == '.' && is_word(path[first + 1])) {
    const std::size_t second = end_of(first + 1);
    if (!option_of(path.substr(0, second)).empty()) return second;
  }
  return first;
}

}  // namespace

std::string json_text(std::string_view text) {
  constexpr std::string_view special = "\b\f\n\r\t", letters = "bfnrt";
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      quoted += {'\\', c};
    else if (const std::size_t known = special.find(c); known != std::string_view::npos)
      quoted += {'\\', letters[known]};
    else if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      quoted += c;
  }
  return quoted + '"';
}

namespace {

/// A long answer has a million values: into one text.
void append_json(const Node& node, std::string& text) {
  const auto list = [&](char open, const auto& parts, char close, const auto& write) {
    text += open;
    for (const auto& part : parts) {
      if (&part != parts.data()) text += ',';
      write(part);
    }
    text += close;
  };
  switch (node.kind) {
    case Node::Kind::null:
      text += "null";
      break;
    case Node::Kind::boolean:
      text += node.boolean ? "true" : "false";
      break;
    case Node::Kind::number:
      text += node.text.empty() ? si_text(node.number) : node.text;
      break;
    case Node::Kind::string:
      text += json_text(node.text);
      break;
    case Node::Kind::list:
      list('[', node.items, ']', [&](const Node& item) { append_json(item, text); });
      break;
    case Node::Kind::map:
      list('{', node.members, '}', [&](const Member& member) {
        text += json_text(member.key) + ':';
        append_json(member.value, text);
      });
  }
}

}  // namespace

std::string as_json(const Node& node) {
  std::string text;
  append_json(node, text);
  return text;
}

Node map_of(std::vector<Member> members) {
  Node map;
  map.kind = Node::Kind::map;
  map.members = std::move(members);
  return map;
}

Node list_of(std::vector<Node> items) {
  Node list;
  list.kind = Node::Kind::list;
  list.items = std::move(items);
  return list;
}

std::string as_option(std::string_view where) {
  const std::size_t size = field_size(where);
  const std::string name = option_of(where.substr(0, size));
  return name.empty() ? std::string(where) : fmt::format("--{}{}", name, where.substr(size));
}

/// A word is a field where it cannot be anything else: it has an underscore, a member or an index, or a value
/// after a colon, as in `model: prb` and `all: true`.
std::string in_options(std::string_view message) {
  constexpr std::string_view flag_value = ": true";
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const bool is_inside =
        at > 0 && (is_word(message[at - 1]) ||
                   std::string_view(".-\"/[").find(message[at - 1]) != std::string_view::npos);
    const std::size_t size = is_word(message[at]) && !is_inside ? field_size(message.substr(at)) : 0;
    const std::string_view word = message.substr(at, size), rest = message.substr(at + size);
    const bool has_member = rest.size() > 1 && (rest[0] == '[' || (rest[0] == '.' && is_word(rest[1])));
    const bool has_value =
        rest.starts_with(": ") && (word == "model" || word == "law" || word == "hold" || word == "accuracy");
    const bool is_flag = word == "all" && rest.starts_with(flag_value);
    const bool is_field = has_member || has_value || is_flag || word.find('_') != std::string_view::npos ||
                          word.find('.') != std::string_view::npos;
    const std::string name = size > 0 && is_field ? option_of(word) : std::string();
    text += name.empty() ? std::string(message.substr(at, std::max<std::size_t>(size, 1))) : "--" + name;
    at += std::max<std::size_t>(size, 1);
    if (!name.empty() && has_value) ++at;                   // --model prb
    if (!name.empty() && is_flag) at += flag_value.size();  // --all
  }
  return text;
}

namespace {

/// Of what is wrong with the keys of a question: keys in quotes, and those known there, as options.
std::string keys_as_options(std::string_view message) {
  constexpr std::string_view known = "Known here: ";
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const std::string_view rest = message.substr(at);
    std::string_view intro;
    for (const std::string_view word : {"key \"", "did you mean \""})
      if (rest.starts_with(word)) intro = word;
    const std::string_view key = rest.substr(intro.size(), rest.find('"', intro.size()) - intro.size());
    const std::size_t size = intro.size() + key.size() + 1;
    const std::string name = intro.empty() || rest.substr(std::min(size, rest.size())).starts_with(" in ")
                                 ? std::string()
                                 : option_of(key);
    if (!name.empty()) {
      text += fmt::format("{}--{}", intro.starts_with("key") ? "" : intro.substr(0, intro.size() - 1), name);
      at += size;
    } else if (rest.starts_with(known)) {
      const std::string_view list =
          rest.substr(known.size(), rest.find_first_of(".\n", known.size()) - known.size());
      std::vector<std::string> options;
      for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(", ", begin), list.size());
        if (const std::string option = option_of(list.substr(begin, end - begin)); !option.empty())
          options.push_back("--" + option);
        begin = end + 2;
      }
      text += options.empty() ? std::string(rest.substr(0, known.size() + list.size()))
                              : fmt::format("{}{}", known, fmt::join(options, ", "));
      at += known.size() + list.size();
    } else {
      text += message[at++];
    }
  }
  return text;
}

}  // namespace

std::string json_error(const Errors& errors) {
  std::string message = errors.front().message;
  for (std::size_t i = 1; i < errors.size(); ++i)
    message +=
        fmt::format("{} {}: {}", message.ends_with('.') ? "" : ";", errors[i].where, errors[i].message);
  return fmt::format(R"({{"error":{{"code":{},"where":{},"message":{}}}}})", json_text(errors.front().code),
                     json_text(errors.front().where), json_text(message));
}

Answer ask(Session& session, const Document& query, bool is_quiet) {
  finish_what_is_begun();
  session.stop_on(stop_token());
  const Waiting line(is_quiet);
  return {session.answer(query)};
}

std::string Answer::text(std::string_view path) const {
  const Node* node = find(path);
  return node ? visible_line(node->text) : std::string();
}

std::optional<double> Answer::number(std::string_view path) const {
  const Node* node = find(path);
  return node && node->kind == Node::Kind::number ? std::optional(node->number) : std::nullopt;
}

Errors Answer::errors() const {
  if (!find("error")) return {};
  const std::string where = text("error.where"), said = text("error.message");
  constexpr std::string_view unknown = "unknown key \"";
  if (said.starts_with(unknown)) {  // an option of the verb that this robot or question has no use for
    const std::string key = said.substr(unknown.size(), said.find('"', unknown.size()) - unknown.size());
    const std::size_t known = said.find("Known here: ");
    if (const std::string name = option_of(key); !name.empty())
      return {{text("error.code"), "--" + name,
               "this robot, or what is asked of it, has no use for it; leave it out" +
                   (known == said.npos ? "" : ". " + keys_as_options(std::string_view(said).substr(known)))}};
  }
  if (where == "query")  // the command line as a whole
    return {{text("error.code"), "", in_options(keys_as_options(said))}};
  return {{text("error.code"), as_option(where),
           said.starts_with(where)
               ? as_option(where) + in_options(std::string_view(said).substr(where.size()))
               : in_options(said)}};
}

int exit_code(const Answer& answer) {
  if (answer.find("error")) return bad_input;
  const std::string status = answer.text("status");
  if (status == "converged") return solved;
  return status == "iteration_limit" || status == "stopped" ? stopped : no_solution;
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
