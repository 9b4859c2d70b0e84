/// @file compressor.hpp
/// A stand-in for the compressor of an engine, for which no public geometry exists: an annulus between case
/// and hub, rows of blades, and a port through the case. Every dimension is a parameter; the defaults are
/// ours, of the size of the one in [LSK] section 7.2. Theory: docs/theory/insertion.md
///
/// Axes: origin where the port's axis meets the inside of the case; x downstream along the engine, z inwards
/// to its axis, y around it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sinew/plan/scene.hpp"

namespace sinew::inline v1 {

/// One row of blades: prisms along the radius on a camber line whose angle changes evenly along the chord.
struct BladeRow {
  std::string name;
  double start = 0, chord = 0;         ///< along x [m]
  double angle_in = 0, angle_out = 0;  ///< of the camber line against x [rad]
  double thickness = 0;                ///< largest [m]
  int count = 0;                       ///< around the engine
  double offset = 0;                   ///< of the blade next to the port, around the case [m]
  double removed = 0;                  ///< blades whose middle is nearer to y = 0 are left out [m]
};

struct Compressor {
  double case_radius = 300e-3, hub_radius = 258e-3;  ///< that bound the annulus [m]
  double case_thickness = 6e-3, hub_thickness = 8e-3;
  double port_diameter = 9.5e-3;
  double sector = 75e-3;                         ///< half of what is made, around the case [m]
  double upstream = 40e-3, downstream = 130e-3;  ///< what is made along x, from the port [m]
  double stage_limit = 150e-3;                   ///< [m]
  std::vector<BladeRow> rows = {
      {"stator-1", -14e-3, 28e-3, 0.6632251157578453, 0.20943951023931956, 2.0e-3, 84, 2.0e-3, 0},
      {"rotor-1", 20e-3, 24e-3, -0.9075712110370514, -0.6632251157578453, 2.2e-3, 72, 0, 40e-3},
      {"stator-2", 50e-3, 24e-3, 0.6632251157578453, 0.20943951023931956, 2.0e-3, 84, 4e-3, 0},
      {"rotor-2", 92e-3, 24e-3, -0.9075712110370514, -0.6632251157578453, 2.2e-3, 72, 0, 0}};
  Vec3<double> target{84e-3, 17e-3, 21e-3};  ///< of the tip [m]
  std::string robot = "nottingham-tpcj";
};

/// The compressor with other clocking of its rows, blades, removed blades and target, drawn by the seed:
/// harder and easier ones.
Compressor drawn_compressor(std::uint64_t seed);

/// What cannot be built, as `out_of_range`.
Errors compressor_errors(const Compressor& compressor);

/// Its solids: `case`, `hub`, and every blade.
std::vector<Mesh> compressor_meshes(const Compressor& compressor);

/// The task of getting in: at stage 0 the straight robot's tip is at the outside of the case.
InsertionScene compressor_scene(const Compressor& compressor, SerialRobot robot);

/// The same as a scene file, each solid in an STL file of its name.
std::string compressor_scene_text(const Compressor& compressor, const SerialRobot& robot);

}  // namespace sinew::inline v1
