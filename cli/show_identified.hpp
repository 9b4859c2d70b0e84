/// @file show_identified.hpp
/// What sinew identify found, as people read it and as JSON.
#pragma once
#include <string>

#include "query/identify/identification.hpp"

namespace sinew::cli {

/// @param is_quiet without times
std::string show_identified(const Identification& done, bool is_quiet);
/// @param output the file that was written; null: none
std::string identified_json(const Identification& done, const std::string* output);

}  // namespace sinew::cli
