/// list: what comes with sinew, a line each.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "answer.hpp"
#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/study/study.hpp"
#include "study/reproduce.hpp"
#include "study_items.hpp"
#include "terminal.hpp"
#include "text_table.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

struct Entry {
  std::string name, title;
};

/// The first sentence of the comment that a file begins with.
std::string title_of(std::string_view text) {
  std::string comment;
  while (text.starts_with("# ")) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    comment += (comment.empty() ? "" : " ") + std::string(text.substr(2, end - 2));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  comment.resize(std::min(comment.find(". "), comment.size()));
  if (comment.ends_with('.')) comment.pop_back();
  return comment;
}

std::vector<Entry> robots() {
  std::vector<Entry> entries;
  for (const std::string_view name : builtin_robot_names())
    entries.push_back({std::string(name), title_of(read_robot_text(std::string(name)).value_or(""))});
  return entries;
}

std::vector<Entry> studies() {
  std::vector<Entry> entries;
  for (const std::string_view name : builtin_study_names())
    if (const auto study = read_study(std::string(name)))
      entries.push_back({std::string(name), study->title});
  return entries;
}

std::vector<Entry> figures() {
  std::vector<Entry> entries;
  for (const StudyItem& item : all_items())
    entries.push_back({std::string(item.id), std::string(item.title)});
  return entries;
}

struct Shelf {
  std::string_view name, one;
  std::vector<Entry> (*entries)();
};
constexpr std::array shelves{Shelf{"robots", "robot", robots}, Shelf{"studies", "study", studies},
                             Shelf{"figures", "figure", figures}};

std::string show(const Shelf& shelf) {
  TextTable table({std::string(shelf.one), "what it is"});
  for (const Entry& entry : shelf.entries()) table.add({entry.name, entry.title});
  return table.text(line_width());
}

std::string as_json(const Shelf& shelf) {
  std::string list;
  for (const Entry& entry : shelf.entries())
    list += fmt::format("{}{{\"name\":{},\"title\":{}}}", list.empty() ? "" : ",", json_text(entry.name),
                        json_text(entry.title));
  return fmt::format("{}:[{}]", json_text(shelf.name), list);
}

int refuse_shelf(const std::string& word) {
  std::vector<std::string_view> names;
  for (const Shelf& shelf : shelves) names.push_back(shelf.name);
  const std::string_view hint = closest(word, names);
  return refuse("list", {{"unknown_choice", in_quotes(word),
                          fmt::format("is nothing that can be listed{} There are: {}.",
                                      hint.empty() ? "." : fmt::format("; did you mean {}?", hint),
                                      fmt::join(names, ", "))}});
}

}  // namespace

int run_list(const Arguments& arguments) {
  const std::string word = arguments.operand();
  const bool is_json = arguments.has("json");
  if (!word.empty() && std::ranges::find(shelves, word, &Shelf::name) == shelves.end())
    return refuse_shelf(word);
  std::string text;
  for (const Shelf& shelf : shelves) {
    if (!word.empty() && shelf.name != word) continue;
    text += is_json ? (text.empty() ? "" : ",") + as_json(shelf) : (text.empty() ? "" : "\n") + show(shelf);
  }
  print(is_json ? '{' + text + "}\n" : text);
  return solved;
}

}  // namespace sinew::cli
