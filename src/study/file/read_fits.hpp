/// @file read_fits.hpp
/// The fits of a study file: one column as a sum of terms, or several with the same coefficients.
#pragma once
#include "io/document/reader.hpp"
#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// Reads them into a study whose columns are known. Codes: `bad_name`, `duplicate_column`, `unknown_column`,
/// `bad_term`, `empty_list`, `empty_map`, `ambiguous`, `missing_key`, `unused_coefficient`.
void read_fits(const Reader& place, Study& study);

}  // namespace sinew::inline v1
