/// @file read_fits.hpp
/// The fits of a study file: columns as sums of terms.
#pragma once
#include "sinew/io/reader.hpp"
#include "sinew/study/study.hpp"

namespace sinew::inline v0 {

/// Reads them into a study whose columns are known. Codes: `bad_name`, `unknown_column`, `bad_term`,
/// `empty_list`.
void read_fits(const Reader& place, Study& study);

}  // namespace sinew::inline v0
