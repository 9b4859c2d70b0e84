/// 3PFS Tables 1 and 2: relative RMS error between loaded and unloaded poses, every cell. The paper prints
/// neither the geometry nor the inputs of its robot, so three geometries stand beside it; one of them was
/// fitted to Table 1 itself. Theory: docs/theory/tripod_loads.md
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "sinew/io/table.hpp"
#include "study/item.hpp"
#include "study/tripod/loads/loads.hpp"
#include "study/tripod/loads/table_findings.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::cell, tripod::ComparedTables, tripod::Load, tripod::PrintedTable, tripod::Rods,
    tripod::TableOfOurs;

// ---------------------------------------------------------------- files

std::vector<std::string> provenance(const StudyItem& item) {
  return {fmt::format("sinew {}, study {}: relative RMS error between loaded and unloaded poses", version(),
                      item.id),
          "variables: 1 x_p, 2 y_p, 3 z_p, 4 e_3, in the columns' true order"};
}

Table table_of(const StudyItem& item, const PrintedTable& paper, const ComparedTables& all) {
  Table table{"F_z[N]", "M_x[N m]", "M_y[N m]", "variable", "paper[%]"};
  table.comments = provenance(item);
  for (const auto* some : {&all.ours, &all.beside})
    for (const TableOfOurs& one : *some) {
      std::string heading = one.label();
      std::erase(heading, ' ');
      std::ranges::replace(heading, ',', '_');
      table.columns.push_back({.name = heading, .unit = "%", .values = {}});
    }
  tripod::each_cell([&](Load load, std::size_t step, std::size_t v) {
    std::vector<double> row;
    for (const Load other : tripod::loads) row.push_back(other == load ? tripod::value_of(load, step) : 0);
    row.push_back(static_cast<double>(v + 1));
    row.push_back(cell(paper.cells, load, step, v));
    for (const auto* some : {&all.ours, &all.beside})
      for (const TableOfOurs& one : *some) row.push_back(cell(one.cells, load, step, v));
    table.add_row(row);
  });
  return table;
}

/// The part of the panel's square from low to high where ours is `factor` times the paper's.
Series line_of(double factor, double low, double high, Mark mark) {
  const double from = std::max(low, low / factor), to = std::min(high, high / factor);
  return {.label = "",
          .x = {from, to},
          .y = {from * factor, to * factor},
          .mark = mark,
          .colour = Colour::grey,
          .width = 1.5};
}

Series dots_of(const PrintedTable& paper, const TableOfOurs& ours, std::size_t variable, Mark mark,
               Colour colour) {
  Series series{.label = ours.label(),
                .x = {},
                .y = {},
                .mark = mark,
                .colour = colour,
                .width = mark == Mark::circles ? 1.5 : 5.0};
  tripod::each_cell([&](Load load, std::size_t step, std::size_t v) {
    if (v != variable) return;
    series.x.push_back(cell(paper.cells, load, step, v));
    series.y.push_back(cell(ours.cells, load, step, v));
  });
  return series;
}

Panel panel_of(const PrintedTable& paper, const ComparedTables& all, std::size_t v) {
  constexpr std::array colours{Colour::blue, Colour::vermillion, Colour::green};
  constexpr std::array titles{"xₚ", "yₚ", "zₚ", "e₃"};
  Panel panel{.title = titles[v],
              .x = {.label = "the paper", .unit = "%", .log = true},
              .y = {.label = "ours", .unit = "%", .log = true},
              .series = {},
              .legend = v == 0 ? Legend::bottom_right : Legend::none};
  for (std::size_t i = 0; i < all.ours.size(); ++i)
    panel.series.push_back(dots_of(paper, all.ours[i], v, Mark::points, colours[i]));
  for (std::size_t i = 0; i < all.beside.size(); ++i)
    panel.series.push_back(dots_of(paper, all.beside[i], v, Mark::circles, colours[i]));
  double low = 1e9, high = 0;
  for (const Series& series : panel.series)
    for (const auto* values : {&series.x, &series.y}) {
      low = std::min(low, std::ranges::min(*values) / 1.4);
      high = std::max(high, std::ranges::max(*values) * 1.4);
    }
  panel.x.low = panel.y.low = low;
  panel.x.high = panel.y.high = high;
  panel.series.insert(panel.series.begin(),
                      {line_of(1, low, high, Mark::line), line_of(tripod::close, low, high, Mark::dotted),
                       line_of(1 / tripod::close, low, high, Mark::dotted)});
  return panel;
}

Figure figure_of(const StudyItem& item, const PrintedTable& paper, const ComparedTables& all) {
  Figure figure{
      .title = "", .panels = {}, .columns = 2, .width = 1100, .height = 1000, .comments = provenance(item)};
  for (std::size_t v = 0; v < tripod::variables.size(); ++v) figure.panels.push_back(panel_of(paper, all, v));
  return figure;
}

/// The studies run; their files go into the reproduction.
Expected<ComparedTables> compared(bool is_steel, ItemResult& result, const std::filesystem::path& folder) {
  ComparedTables all;
  for (const tripod::LoadedGeometry& geometry : tripod::loaded_geometries) {
    const auto study = tripod::swept(geometry.study, folder);
    if (!study) return tl::unexpected(study.error());
    result.swept.push_back(study->file);
    all.ours.push_back({geometry.name, is_steel ? "210 GPa" : "",
                        relative_rms(*study, is_steel ? Rods::thick_steel : Rods::thin)});
    if (is_steel) all.beside.push_back({geometry.name, "83 GPa", relative_rms(*study, Rods::thick)});
  }
  return all;
}

Expected<ItemResult> table(const StudyItem& item, const PrintedTable& paper, bool is_steel,
                           const std::filesystem::path& folder) {
  ItemResult result;
  const auto all = compared(is_steel, result, folder);
  if (!all) return tl::unexpected(all.error());
  tripod::add_table_findings(result.findings, paper, *all);

  const std::string stem = paper.stem;
  result.tables.emplace_back(stem, table_of(item, paper, *all));
  result.figures.emplace_back(stem, figure_of(item, paper, *all));
  return result;
}

}  // namespace

Expected<ItemResult> tripod_table1(const StudyItem& item, const std::filesystem::path& folder) {
  return table(item, tripod::table_1, false, folder);
}

Expected<ItemResult> tripod_table2(const StudyItem& item, const std::filesystem::path& folder) {
  return table(item, tripod::table_2, true, folder);
}

}  // namespace sinew::inline v1
