/// @file measures.hpp
/// What flexible tripods of given dimensions, under given loads, do that nobody asks of them: parasitic turn
/// and shift over all tilts to 20°, and how far the shift is from that of the rigid tripod. Theory:
/// docs/tripod-design.md
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "study/tripod/swept.hpp"

namespace sinew::inline v1::tripod {

/// Root mean squares over the tilts of one tripod.
struct Measures {
  std::size_t asked = 0, solved = 0;  ///< poses
  double turn = 0;                    ///< of e₃
  double shift = 0;                   ///< of (x, y) [m]
  double rigid = 0;                   ///< of (x, y) by (10), at the same tilts [m]
  double distance = 0;                ///< from the one (x, y) to the other [m]
  double drift = 0;  ///< c₁ of x = c₁ e₂ + 2 c₂ e₁ e₂, y = −c₁ e₁ + c₂ (e₁² − e₂²), least squares [m]
  double square = 0;  ///< c₂ [m]; of the rigid tripod c₁ = 0, c₂ = −r

  double twist() const;     ///< turn about the vertical that has this e₃ [deg]
  double relative() const;  ///< distance over the rigid shift
};

using Measure = double Measures::*;

Measures measures(const Swept& study, std::span<const std::size_t> rows);

/// All tripods of the study 3pfs-design.
struct Designs {
  std::vector<double> radii, heights;  ///< of the base, of the platform's home [mm]
  std::vector<double> angles;          ///< half of the angle between the rods of a pair [deg]
  std::vector<Measures> all;           ///< angle fastest

  const Measures& at(std::size_t radius, std::size_t height, std::size_t angle) const;
  std::vector<double> over_angle(std::size_t radius, std::size_t height, Measure measure) const;
};

Designs designs(const Swept& study);

/// One preset under loads, by the diameter of its rods.
struct Loaded {
  std::string name;               ///< `G1`
  double height;                  ///< [mm]
  std::vector<double> diameters;  ///< [mm]
  std::vector<Measures> all;      ///< load after load, the first one none
  double unloaded_change;         ///< of x, y [m] and e₃ from one diameter to another, at most

  const Measures& at(std::size_t load, std::size_t diameter) const;
  std::vector<double> over_diameter(std::size_t load, Measure measure) const;
};

/// The loads of the studies 3pfs-g1-diameter and 3pfs-g2-diameter, in words.
inline constexpr const char* load_names[] = {"none", "5 N sideways", "10 N downwards", "0.5 N m about z"};

Loaded loaded(const Swept& study, std::string name, double height);

/// The larger of two; NaN stays.
inline double worse(double most, double here) { return here <= most ? most : here; }

/// What is above 0, else 0; NaN stays.
inline double excess(double value) { return value <= 0 ? 0 : value; }

}  // namespace sinew::inline v1::tripod
