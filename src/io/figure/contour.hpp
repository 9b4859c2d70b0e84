/// @file contour.hpp
/// Lines of equal value over a heat map, with their values written on them.
#pragma once
#include <vector>

#include "io/figure/figure.hpp"

namespace sinew::inline v1 {

/// The lines of one value, linear between the cells' middles; pieces are joined where they meet and apart by
/// a point that is not finite. A cell with a corner that is not finite has none. White on the dark half of
/// the map's colours, black on the other.
Series contour_line(const HeatMap& map, double level);

/// At most about `most` round values between the ends of the map's colours: 1, 2 or 5 times a power of ten
/// apart; of a logarithmic map 1, 2 and 5 times powers of ten, or fewer of them.
std::vector<double> contour_levels(const HeatMap& map, double most = 12);

/// Those lines into the panel with the map, each with its value where there is room for it.
/// @param width,height of the panel [px of the SVG]: how much of it a number hides
void add_contours(Panel& panel, const std::vector<double>& levels, double width, double height);

}  // namespace sinew::inline v1
