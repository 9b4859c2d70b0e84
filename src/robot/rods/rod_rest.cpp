/// @file rod_rest.cpp
/// Rods at rest at a pose, from nothing: where every search for an equilibrium begins.
#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "link/galerkin.hpp"
#include "robot/rods/elastica_system.hpp"
#include "robot/rods/general_system.hpp"
#include "robot/rods/tangent_system.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int N = coarse_nodes;

/// The rod that pushes only sideways, unit length: θ and fd for the direction of its tip, tan γ = d/w. One
/// parameter, from the straight rod on.
bool rest_shape(double angle, std::array<double, N + 1>& unknowns) {
  const auto& basis = GalerkinBasis<coarse_nodes>::get();
  unknowns.fill(0);
  const int strides = std::max(1, static_cast<int>(std::ceil(angle / 0.2)));
  for (int k = 1; k <= strides; ++k) {
    const double d = std::sin(angle * k / strides), w = std::cos(angle * k / strides);
    double largest = 1;
    for (int iteration = 0; iteration < 20 && !(largest < 1e-13); ++iteration) {
      std::array<double, (N + 1) * (N + 1)> matrix{};
      std::array<double, N + 1> gap{}, step{};
      for (int i = 0; i < N; ++i) {
        const double s = std::sin(unknowns[at(i)]), c = std::cos(unknowns[at(i)]), weight = basis.weight[i];
        gap[at(i)] = -weight * unknowns[N] * c;
        for (int j = 0; j < N; ++j) {
          gap[at(i)] += basis.bending[i][j] * unknowns[at(j)];
          matrix[at(i * (N + 1) + j)] = basis.bending[i][j];
        }
        matrix[at(i * (N + 2))] += weight * unknowns[N] * s;
        matrix[at(i * (N + 1) + N)] = -weight * c;
        matrix[at(N * (N + 1) + i)] = weight * (w * c + d * s);
        gap[N] += weight * (w * s - d * c);
      }
      if (!solve(MatrixView(matrix.data(), N + 1, N + 1), MatrixView(gap.data(), N + 1, 1), step))
        return false;
      largest = 0;
      for (int i = 0; i <= N; ++i) {
        unknowns[at(i)] -= step[at(i)];
        largest = std::max(largest, std::abs(step[at(i)]));
      }
      if (!(largest < 1e3)) return false;
    }
    if (!(largest < 1e-9)) return false;
  }
  return true;
}

}  // namespace

bool ElasticaSystem::rest_at(const SE3<double>& platform) {
  const auto& basis = GalerkinBasis<coarse_nodes>::get();
  set_platform(platform);
  for (int k = 0; k < limbs(); ++k) {
    const auto [d, w, lateral, stiffness] = aim(k);
    const double distance = std::hypot(d, w);
    if (!(d > 1e-9 * distance) || !(w > 0)) return false;
    std::array<double, N + 1> shape;
    if (!rest_shape(std::atan2(d, w), shape)) return false;
    double reach = 0;
    for (int j = 0; j < N; ++j)
      reach += basis.weight[j] * (d * std::sin(shape[at(j)]) + w * std::cos(shape[at(j)])) / distance;
    const double length = distance / reach;
    set_shape(k, length, std::span(shape).first(N), shape[N] * stiffness / (length * length), 0, lateral);
  }
  return balance(false);
}

/// From the cubics between guides and tips.
bool TangentSystem::rest_at(const SE3<double>& platform) {
  set_platform(platform);
  if (!draw_rods()) return false;
  constexpr double near = 1e-6;
  evaluate();
  for (int k = 0; k < 20 && !(limb_error() < near); ++k) {
    linearise();
    move_to_rest(0.1);
    evaluate();
  }
  return limb_error() < near && settle_rods();
}

/// Of rods in equilibrium: each fed until nothing pulls along its chord.
bool GeneralSystem::feed_to_rest() {
  constexpr double near = 1e-6;
  double fed = 1;
  evaluate();
  for (int k = 0; k < 30 && !(fed < near && limb_error() < near); ++k) {
    if (!(limb_error() < 1e6)) return false;
    linearise();
    fed = move_to_rest(0.1);
    evaluate();
  }
  return fed < near && limb_error() < near && settle_rods();
}

/// From the cubics; where that does not lead to rods that hold by themselves, from rods that are grown into
/// what they are at those lengths. Where no length is found at which nothing pulls, those are kept: any
/// equilibrium will do.
bool GeneralSystem::rest_at(const SE3<double>& platform) {
  set_platform(platform);
  if (!draw_rods()) return false;
  if (feed_to_rest() && is_stable_by_rods()) return true;
  if (!grow_rods()) return false;
  if (feed_to_rest() && is_stable_by_rods()) return true;
  return grow_rods() && settle_rods();
}

}  // namespace sinew::inline v1
