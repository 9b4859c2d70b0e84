/// @file claims.hpp
/// What [3PFS] says in words about Figs. 14 to 16, measured. Theory: docs/theory/tripod_loads.md
#pragma once
#include <string>
#include <vector>

#include "study/reproduce.hpp"
#include "study/tripod/loads/loads.hpp"

namespace sinew::inline v1::tripod {

/// Relative RMS of every step, and the paper's claims at the largest load, over all of a study's poses on
/// rods of 3 mm. `name` is that of the geometry.
void add_load_claims(std::vector<Finding>& findings, const std::string& name, const Swept& study, Load load);

}  // namespace sinew::inline v1::tripod
