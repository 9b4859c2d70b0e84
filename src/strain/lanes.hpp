/// @file lanes.hpp
/// One rod under eight loads and tensions at once, a case a lane of vector registers: sweeps, factors and
/// solutions as sweep.hpp and condense.hpp have them. What becomes of a lane does not depend on its
/// neighbours. Theory: docs/theory/strain_rod.md
#pragma once
#include <array>
#include <vector>

#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

/// Cases at once, whatever the width of registers.
inline constexpr int lane_count = 8;

/// One number of every case.
struct alignas(64) LaneValues {
  double of[lane_count] = {};
  double& operator[](int lane) { return of[lane]; }
  double operator[](int lane) const { return of[lane]; }
};

/// Memory of eight cases; one thread uses it.
struct LaneWork {
  /// @name What is asked
  /// @{
  std::vector<LaneValues> y;                 ///< coordinates
  std::vector<LaneValues> tensions;          ///< of tendons [N]
  std::array<LaneValues, 3> tip_force = {};  ///< a dead force beside the loads [N]
  std::vector<NodeLoad> loads;               ///< on nodes, the same for all; none without a potential
  /// @}

  /// @name What is told
  /// @{
  std::vector<LaneValues> gradient;     ///< of energy and of tendons at their tensions
  std::vector<LaneValues> lengths;      ///< of tendons [m]
  LaneValues energy = {};               ///< elastic and of loads, without tendons [J]
  std::array<LaneValues, 12> tip = {};  ///< its place [m], its rotation matrix, rows first
  LaneValues largest_turn = {};         ///< of an element: squared angle [rad²]
  LaneValues smallest_pivot = {};       ///< of the last factors [1]
  /// @}

  /// Right sides and solutions, a row for each coordinate.
  std::vector<LaneValues> side;

  /// @name Of the kernels alone, which lay them out by the width of registers
  /// @{
  std::vector<LaneValues> frames, steps, factors, scratch;
  std::vector<int> first_factor;  ///< of each piece
  int most_coordinates = 0;       ///< of a piece
  /// @}

  explicit LaneWork(const RodModel& model);
};

/// An element that turns by more than this has no place in lanes: its square [rad²].
inline constexpr double largest_lane_turn = 2;

/// Whether the rod is of what lanes compute: elements of two Gauss points.
bool fits_lanes(const RodModel& model);

/// From `y` and `tip_force` lengths, energy, the tip and the largest turn.
void sweep_out(const RodModel& model, LaneWork& work);
/// After it: the gradient.
void sweep_back(const RodModel& model, LaneWork& work);
/// After sweep_out(): the gradient, and factors of the Hessian, which are good where `smallest_pivot` is
/// positive.
/// @param more if not empty, what is added to the Hessian: of each piece a square of size × padded
void sweep_back_and_factor(const RodModel& model, LaneWork& work,
                           const std::vector<std::vector<double>>& more);
/// With the last factors: H⁻¹ `side` in its place.
void solve(const RodModel& model, LaneWork& work);

}  // namespace sinew::inline v1::strain
