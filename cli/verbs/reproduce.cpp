/// reproduce: figures and tables of the papers, ours beside theirs.
#include "study/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "figure_file.hpp"
#include "request.hpp"
#include "study_items.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// All items, those of a paper, or one.
std::vector<StudyItem> wanted(std::string_view what) {
  std::vector<StudyItem> items;
  for (const StudyItem& item : all_items())
    if (what.empty() || item.id == what || item.id.substr(0, item.id.find('/')) == what)
      items.push_back(item);
  return items;
}

std::string list(std::span<const StudyItem> items) {
  TextTable table({"item", "title"});
  for (const StudyItem& item : items) table.add({std::string(item.id), std::string(item.title)});
  return table.text(line_width());
}

int refuse_item(const std::string& what) {
  std::vector<std::string_view> names;
  for (const StudyItem& item : all_items()) names.push_back(item.id);
  const std::string_view hint = closest(what, names);
  return refuse("reproduce", {{"unknown_study", in_quotes(what),
                               fmt::format("no such item{} There are: {}.",
                                           hint.empty() ? "." : fmt::format("; did you mean {}?", hint),
                                           fmt::join(names, ", "))}});
}

std::string show(const Reproduction& made) {
  TextTable table({"quantity", std::string(made.compared_with()), "ours", "difference", "verdict"}, " | ");
  for (const Finding& finding : made.findings)
    table.add({finding.quantity, finding.paper, finding.ours, finding.difference, finding.verdict});
  std::string text = fmt::format("{}: {}\n{}", made.id, made.title, table.text(line_width()));
  for (const auto& file : made.files) text += file.string() + '\n';
  return text;
}

std::string as_json(const Reproduction& made) {
  std::string findings, files;
  for (const Finding& finding : made.findings)
    findings +=
        fmt::format(R"({}{{"quantity":{},"paper":{},"ours":{},"difference":{},"verdict":{}}})",
                    findings.empty() ? "" : ",", json_text(finding.quantity), json_text(finding.paper),
                    json_text(finding.ours), json_text(finding.difference), json_text(finding.verdict));
  for (const auto& file : made.files) files += (files.empty() ? "" : ",") + json_text(file.string());
  return fmt::format(R"({{"id":{},"title":{},"findings":[{}],"files":[{}]}})", json_text(made.id),
                     json_text(made.title), findings, files) +
         '\n';
}

}  // namespace

std::vector<std::string_view> study_names() {
  std::vector<std::string_view> names;
  for (const StudyItem& item : all_items()) {
    const std::string_view paper = item.id.substr(0, item.id.find('/'));
    if (std::ranges::find(names, paper) == names.end()) names.push_back(paper);
    names.push_back(item.id);
  }
  return names;
}

int run_reproduce(const Arguments& arguments) {
  const std::vector<StudyItem> items = wanted(arguments.operand());
  if (items.empty()) return refuse_item(arguments.operand());
  if (arguments.has("list")) {
    print(list(items));
    return solved;
  }
  auto page = page_options(arguments);
  if (!page) return refuse("reproduce", page.error());
  page->replaces_edited_script = arguments.has("force");
  const std::string* folder = arguments.text("output");
  int exit = solved;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto made = reproduce_item(items[i].id, folder ? *folder : "out", *page);
    if (!made) {
      exit = refuse("reproduce", made.error());
      continue;
    }
    print(arguments.has("json") ? as_json(*made) : (i ? "\n" : "") + show(*made));
  }
  return exit;
}

}  // namespace sinew::cli
