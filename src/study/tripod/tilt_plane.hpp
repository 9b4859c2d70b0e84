/// @file tilt_plane.hpp
/// Panels over the plane of e₁ and e₂ for the flexible tripod: samples shaded by a value, maps at one height.
#pragma once
#include <string>
#include <vector>

#include "io/figure/figure.hpp"
#include "study/tripod/swept.hpp"

namespace sinew::inline v1::tripod {

/// A geometry that the paper may have had; robots/3pfs-*.yaml say what is known of each.
struct Preset {
  const char *name, *robot;        ///< in figures, and its file
  const char *parasitic, *height;  ///< studies: poses near three heights, at three heights exactly
  const char* workspace;           ///< study of a cube of inputs
  double side;                     ///< D: how far an input goes to either side [m]
};
inline constexpr Preset presets[] = {
    {"G1", "3pfs-g1", "3pfs-g1-parasitic", "3pfs-g1-height", "3pfs-g1-workspace", 0.064},
    {"G2", "3pfs-g2", "3pfs-g2-parasitic", "3pfs-g2-height", "3pfs-g2-workspace", 0.060}};

/// Heights that the studies go to [m], in the order of their first axis.
inline constexpr double heights[] = {0.2, 0.4, 0.6};

/// The ends of those values that are finite.
struct Extent {
  double low, high;
};
Extent range_of(std::span<const double> values);

/// Of all poses that were found [deg].
double largest_tilt(const Swept& study);

/// Empty, from −reach to reach both ways.
Panel tilt_panel(std::string title, double reach);

/// Dots at (e₁, e₂), one shade a value.
Series shaded(std::vector<double> e1, std::vector<double> e2, std::vector<double> values, double width);

/// What a study at constant height found at one of its heights, as a map; places outside its disc are empty.
HeatMap height_map(const Swept& study, double z, const std::vector<double>& values, std::string label);

/// The page's white outside the disc of tilts that the studies at constant height go to.
Series rim();

}  // namespace sinew::inline v1::tripod
