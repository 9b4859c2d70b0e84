/// @file contour.hpp
/// Lines of equal value over a heat map, with their values written where a ray from its middle meets them.
#pragma once
#include <vector>

#include "io/figure/figure.hpp"

namespace sinew::inline v1::contour {

/// Lines of some values, each written where its line first crosses a ray from the middle of the map, once for
/// each direction in which it does.
struct Levels {
  std::vector<double> values;
  std::vector<double> directions;  ///< [deg]
};

/// The lines into the panel with the map: white on the dark half of its colours, black on the other.
void add(Panel& panel, const std::vector<Levels>& all);

/// The values of the cells next to the map's edge carried one cell further, and so on `rings` times: what
/// lies under an edge that cuts through cells. The map's own values stay.
HeatMap spread(HeatMap map, int rings = 2);

}  // namespace sinew::inline v1::contour
