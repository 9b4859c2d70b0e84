/// @file swept.hpp
/// Built-in studies run for a figure or a table of [3PFS], and what is made of their columns. Theory:
/// docs/theory/tripod_flexible.md
#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "sinew/io/table.hpp"
#include "sinew/study/sweep.hpp"

namespace sinew::inline v1::tripod {

/// The samples of a study, those left out dropped. Numbers of samples without a solution are NaN.
struct Swept {
  Table table;  ///< axes, derived values, outputs; as in the file
  SweepSummary summary;
  std::filesystem::path file;

  std::size_t size() const { return table.row_count(); }
  std::size_t converged() const;
  /// A column by its name; it must be one of the study's.
  const std::vector<double>& operator[](std::string_view column) const;
};

/// Runs the built-in study of this name into `folder`/name.h5, with all its samples: a reduction of its is
/// left aside. Results that are there already, of the same study and version, are read. Errors: those of
/// `sweep` and `read_hdf5`.
Expected<Swept> swept(std::string_view study, const std::filesystem::path& folder);

/// The rows of a study where `wanted(row)` holds.
std::vector<std::size_t> rows_where(const Swept& study, const std::function<bool(std::size_t)>& wanted);

/// Values of a column at these rows.
std::vector<double> at_rows(const std::vector<double>& column, std::span<const std::size_t> rows);

/// Of those that are finite.
double root_mean_square(std::span<const double> values);

/// Σab/√(Σa²Σb²) over the pairs that are finite: 1 where the shapes are the same, whatever their size.
double likeness(std::span<const double> a, std::span<const double> b);

}  // namespace sinew::inline v1::tripod
