/// @file table_findings.hpp
/// Every cell of Table 1 or 2 of [3PFS] beside three geometries, and what the tables say by themselves.
/// Theory: docs/theory/tripod_loads.md
#pragma once
#include <string>
#include <vector>

#include "study/reproduce.hpp"
#include "study/tripod/loads/printed_tables.hpp"

namespace sinew::inline v1::tripod {

/// What becomes of one geometry on rods of one kind.
struct TableOfOurs {
  std::string name;
  std::string modulus;  ///< of the rods, `210 GPa`; empty where there is one only
  RmsCells cells;

  /// `G1` or `G1, 210 GPa`.
  std::string label() const { return modulus.empty() ? name : name + ", " + modulus; }
};

/// The three geometries on the rods that are compared, the fitted one last, and on others beside them.
struct ComparedTables {
  std::vector<TableOfOurs> ours, beside;
};

/// A cell agrees within this factor: the fitted geometry comes no closer than 1.34.
inline constexpr double close = 1.2;

void add_table_findings(std::vector<Finding>& findings, const PrintedTable& paper, const ComparedTables& all);

/// `f(load, step, variable)`, row by row.
template <class F>
void each_cell(const F& f) {
  for (const Load load : loads)
    for (std::size_t step = 1; step <= load_steps; ++step)
      for (std::size_t v = 0; v < variables.size(); ++v) f(load, step, v);
}

}  // namespace sinew::inline v1::tripod
