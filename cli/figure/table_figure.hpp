/// @file table_figure.hpp
/// Figures of a table of results.
#pragma once
#include "io/figure/figure.hpp"
#include "sinew/io/table.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// What a table is drawn as where `--as` does not say: a map where its rows are a full grid over two axes or
/// more and no columns are chosen, or where a value is; points where a colour is; else lines.
std::string_view table_kind(const Table& table, const Arguments& arguments);

/// `line`, `points`, `map` or `contour`, as the options say.
/// @param paper which lines with numbers on them depend on
/// @param words for the numbers 0, 1, ... of a column `status`; empty where it is one like any other
Expected<Figure> table_figure(const Table& table, std::string_view kind, const Arguments& arguments,
                              const FigureOptions& paper, const std::vector<std::string>& words);

}  // namespace sinew::cli
