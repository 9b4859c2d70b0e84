/// @file index_panel.hpp
/// A performance index along the trajectory of section 5.1, up to where it grows without bound.
#pragma once
#include <string>
#include <vector>

#include "io/figure/figure.hpp"

namespace sinew::inline v1::example51 {

Axis log_axis(std::string label, std::string unit, double low, double high);

/// The curves over η, the derived rate limit/(π/3 − φ), and the singular last pose.
Panel index_panel(Axis y, std::vector<Series> curves, double limit);

}  // namespace sinew::inline v1::example51
