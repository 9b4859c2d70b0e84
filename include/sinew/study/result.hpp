/// @file result.hpp
/// Files of results read back, as tables: a line a sample, the axes written out.
#pragma once
#include <filesystem>

#include "sinew/io/table.hpp"

namespace sinew::inline v0 {

/// An HDF5 file as `sweep` writes it, or any whose root has columns of numbers of one shape, with dimension
/// scales or without: axes first, then columns in the order of their creation; `status` is its code. Codes:
/// `file_missing`, `file_unreadable`, `no_columns`.
SINEW_API Expected<Table> read_hdf5(const std::filesystem::path& path);

/// A file of results by its ending: `.h5` or `.csv`.
SINEW_API Expected<Table> read_result(const std::filesystem::path& path);

}  // namespace sinew::inline v0
