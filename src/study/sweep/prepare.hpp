/// @file prepare.hpp
/// What a study needs to know of its robot before it begins.
#pragma once
#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// Puts the query at a few samples spread over the study: refuses one that is no good question at any of
/// them, outputs that no answer has, and fills in what the file leaves out: outputs and their units. A
/// warning where none of them is solved. Codes: those of robot files and queries, `unknown_output`,
/// `no_outputs`, `all_left_out`.
Expected<std::string> prepare(Study& study);

}  // namespace sinew::inline v1
