/// @file table_grid.hpp
/// Tables whose rows form a grid: which columns are its axes, where a cut through it lies, and its values as
/// a map.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/figure/figure.hpp"
#include "sinew/io/table.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// The column of that name; an error, to which `option` is the place, where there is none.
const Column* column(const Table& table, std::string_view name, std::string_view option, Errors& errors);

/// What takes the SI values of a column to those that a figure shows, and the unit these have: lengths in mm,
/// angles in deg, and where all are tiny or huge a power of ten in the unit, so that no axis is full of
/// zeros.
struct Scale {
  double factor = 1;
  std::string unit;  ///< `10⁻⁶ m^4`

  std::vector<double> shown(const std::vector<double>& values) const;
};
/// @param is_log of a logarithmic axis, which numbers powers of ten by itself
Scale scale_of(const Column& column, bool is_log = false);
/// `det J (10⁻⁶ m⁴)`
Text titled(const Column& column, const Scale& scale, bool is_ours);

/// Round ends of the colours of some values, of which at least one is finite, so that the bar has a number at
/// both; of logarithmic colours powers of ten where the values reach over less than two.
std::array<double, 2> colour_ends(const std::vector<double>& values, bool log);

/// The first columns that vary and tell the rows apart, the one that runs fastest first.
struct GridAxes {
  std::vector<const Column*> columns;
  bool is_full = false;  ///< every combination of their values is a row
};
GridAxes grid_axes(const Table& table);

/// A part of a table, and how it was chosen.
struct Cut {
  Table table;
  Text place;  ///< `φ = 30°`; empty where nothing was cut
};
/// The rows that `--at "phi=30 deg, z=0.4"` leaves: of each column the values nearest to those.
Expected<Cut> cut(Table table, const Arguments& arguments);

/// Which columns a map is over, and what it shows.
struct MapColumns {
  const Column *x, *y, *value;
};
/// As `--x`, `--y` and `--value` say, default the first two axes of the grid and the first other column that
/// has more than two values.
Expected<MapColumns> map_columns(const Table& table, const Arguments& arguments);

/// The values over the grid of x and y, in any order of rows; a place without a row is an empty cell.
Expected<HeatMap> heat_map(const Table& table, const MapColumns& columns, bool log);

}  // namespace sinew::cli
