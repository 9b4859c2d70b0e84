/// @file spectral_rod.hpp
/// Fields along a rod by spectral elements of equal length: where their nodes lie, and how many elements
/// there may be. Of systems of rods; the kernels have this in lanes.
#pragma once
#include <algorithm>
#include <array>

#include "base/at.hpp"
#include "link/lobatto.hpp"

namespace sinew::inline v1::spectral {

inline constexpr int degree = static_cast<int>(element_degree);

/// ℓⱼ of one element at x in [0, 1].
inline void lagrange(double x, double (&value)[degree + 1]) {
  const auto& node = LobattoBasis<element_degree>::get().node;
  for (int j = 0; j <= degree; ++j) {
    value[j] = 1;
    for (int m = 0; m <= degree; ++m)
      if (m != j) value[j] *= (x - node[m]) / (node[j] - node[m]);
  }
}

/// Of [0, 1], and its share in an integral.
struct NodePlace {
  double along, weight;
};
inline NodePlace place_of(int node, int elements) {
  const auto& basis = LobattoBasis<element_degree>::get();
  const int element = node == 0 ? 0 : (node - 1) / degree, own = node - element * degree;
  double weight = basis.weight[own];
  if (own == degree && element + 1 < elements) weight += basis.weight[0];
  return {(element + basis.node[own]) / elements, weight / elements};
}

/// The numbers of elements there are, and the place of one among them. Errors go with the sixteenth power of
/// the elements' length: the next coarser ones have 100 to 660 times as much.
inline constexpr std::array<int, 5> levels = {2, 3, 4, 6, 8};
inline std::size_t level_of(int elements) {
  return static_cast<std::size_t>(std::ranges::find(levels, elements) - levels.begin());
}

}  // namespace sinew::inline v1::spectral
