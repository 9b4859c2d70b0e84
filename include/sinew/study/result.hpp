/// @file result.hpp
/// Files of results as tables: a line a sample, the axes written out.
#pragma once
#include <filesystem>

#include "sinew/io/table.hpp"

namespace sinew::inline v1 {

/// An HDF5 file as `sweep` writes it, or any whose root has columns of numbers of one shape, with dimension
/// scales or without: axes first, then columns in the order of their creation; `status` is its code. Codes:
/// `file_missing`, `file_unreadable`, `no_columns`.
SINEW_API Expected<Table> read_hdf5(const std::filesystem::path& path);

/// A file of results by its ending: `.h5` or `.csv`.
SINEW_API Expected<Table> read_result(const std::filesystem::path& path);

/// Writes one, by its ending: `.h5` or `.csv`. The first comment of the table is its title, others like
/// `seed: 3` are facts of its provenance. Codes: `unknown_format`, `file_unwritable`, `write_failed`.
SINEW_API Expected<void> write_result(const Table& table, const std::filesystem::path& path);

}  // namespace sinew::inline v1
