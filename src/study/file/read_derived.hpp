/// @file read_derived.hpp
/// The derived values of a study file: `L3: "1.29 - L1 - L2"`, with limits or without.
#pragma once
#include "io/document/reader.hpp"
#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// Reads them into a study whose axes are known. Codes: `bad_name`, `duplicate_column`, `wrong_type`,
/// `bad_term`, `unknown_column`, `later_column`, `unknown_unit`, `wrong_dimension`, `out_of_range`.
void read_derived(const Reader& place, Study& study);

}  // namespace sinew::inline v1
