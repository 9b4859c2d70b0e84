/// help fields: the fields of questions, for people and, with --json, for what is made of them.
#include <fmt/format.h>

#include <algorithm>

#include "answer.hpp"
#include "io/document/quantity.hpp"
#include "query/fields/answer_fields.hpp"
#include "query/fields/fields.hpp"
#include "text_table.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

constexpr std::pair<Mechanics, std::string_view> mechanics[] = {{of_kinematic, "kinematic"},
                                                                {of_chains, "chains"},
                                                                {of_rods, "rods"},
                                                                {of_serial, "serial"},
                                                                {of_arms, "arms"}};

std::string_view name_of(FieldShape shape) {
  constexpr std::string_view names[] = {
      "flag",   "whole",          "quantity", "word",        "words",       "point",         "numbers",
      "inputs", "per_leg",        "signs",    "pairs",       "lists",       "pose",          "independent",
      "start",  "place",          "places",   "target",      "wrench",      "twist",         "growing_load",
      "range",  "text_or_number", "settings", "point_loads", "path_points", "measured_rows", "names"};
  return names[static_cast<std::size_t>(shape)];
}

Node texts(std::span<const std::string_view> words) {
  std::vector<Node> items;
  for (const std::string_view word : words) items.push_back(make_node(word));
  return list_of(std::move(items));
}

/// Who takes the field, in each kind of question that has it.
Node uses_of(const Field& field) {
  std::vector<Member> kinds;
  for (const Ask ask : every_ask) {
    std::vector<Node> takers;
    for (const auto& [bit, name] : mechanics)
      if ((field.uses.of(ask) & bit) != 0) takers.push_back(make_node(name));
    if (!takers.empty())
      kinds.push_back({.key = std::string(word_of(ask)), .value = list_of(std::move(takers))});
  }
  return map_of(std::move(kinds));
}

std::string kinds_of(const Field& field) {
  std::string kinds;
  std::size_t count = 0;
  for (const Ask ask : every_ask)
    if (field.uses.of(ask) != 0) {
      kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", word_of(ask));
      ++count;
    }
  return count == every_ask.size() ? "all" : kinds;
}

}  // namespace

std::string help_fields() {
  TextTable table({"field", "what", "unit", "of", "meaning"});
  for (const Field& field : question_fields())
    table.add({std::string(field.name), std::string(name_of(field.shape)), std::string(unit(field.dimension)),
               kinds_of(field), std::string(field.meaning)});
  return table.text();
}

std::string fields_json() {
  std::vector<Node> list;
  for (const Field& field : question_fields())
    list.push_back(map_of({{.key = "name", .value = make_node(field.name)},
                           {.key = "shape", .value = make_node(name_of(field.shape))},
                           {.key = "unit", .value = make_node(unit(field.dimension))},
                           {.key = "uses", .value = uses_of(field)},
                           {.key = "meaning", .value = make_node(field.meaning)},
                           {.key = "words", .value = texts(field.words)}}));
  std::vector<Node> answers;
  for (const AnswerField& field : answer_fields())
    answers.push_back(map_of({{.key = "name", .value = make_node(field.name)},
                              {.key = "unit", .value = make_node(field.unit)},
                              {.key = "meaning", .value = make_node(field.meaning)}}));
  return as_json(map_of({{.key = "questions", .value = list_of(std::move(list))},
                         {.key = "answers", .value = list_of(std::move(answers))}}));
}

}  // namespace sinew::cli
