/// @file reproduce.hpp
/// The papers' figures and tables, made again: ours beside the paper's, the difference, a verdict.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/figure/figure.hpp"
#include "sinew/base/error.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {

struct StudyItem;
struct ItemResult;
/// Computes an item and compares.
/// @param folder for results of sweeps, which are written as they are computed
using StudyFunction = Expected<ItemResult> (*)(const StudyItem& item, const std::filesystem::path& folder);

/// Something of a paper, or of what others measured or computed, that can be made again.
struct StudyItem {
  std::string_view id;  ///< paper/item: `tdpcr/fig9`
  std::string_view title;
  StudyFunction make = nullptr;  ///< null where another layer makes it
};

/// All of them, in the order of the papers.
std::span<const StudyItem> study_items();

/// One number or claim of the paper beside ours, formatted for people.
struct Finding {
  std::string quantity;
  std::string paper;  ///< as printed; `not printed` where the paper gives none; of `truth` the reference
  std::string ours;
  std::string difference;  ///< empty where there is nothing to subtract
  std::string verdict;     ///< `agrees`, `differs`, `holds`, `fails`, or `for information`
};

struct Reproduction {
  std::string id, title;
  std::vector<Finding> findings;
  std::vector<std::filesystem::path> files;  ///< written, in order

  /// What stands beside ours: heads its column.
  std::string_view compared_with() const { return id.starts_with("truth/") ? "reference" : "paper"; }
};

/// What an item found and has to show. `write_item` writes it.
struct ItemResult {
  std::vector<Finding> findings;
  std::vector<std::filesystem::path> swept;             ///< files that its sweeps have written there
  std::vector<std::pair<std::string, Table>> tables;    ///< by the names of their files, without extension
  std::vector<std::pair<std::string, Figure>> figures;  ///< the same
};

/// Writes it into a folder: tables, findings, then figures. Codes: as `reproduce`.
Expected<Reproduction> write_item(const StudyItem& item, const ItemResult& made,
                                  const std::filesystem::path& folder, const FigureOptions& page = {});

/// Makes one item again; its files go to `out`/paper/. What is written before an error stays: without gnuplot
/// the table, the findings and the scripts of the figures are there. Codes: `unknown_study`,
/// `file_unwritable`, `gnuplot_missing`, `gnuplot_failed`, `script_edited`.
/// @param page of the figures: width, font, formats, and whether scripts that were edited are replaced
Expected<Reproduction> reproduce(std::string_view id, const std::filesystem::path& out,
                                 const FigureOptions& page = {});

/// The findings as a Markdown table.
std::string to_markdown(const Reproduction& reproduction);

}  // namespace sinew::inline v1
