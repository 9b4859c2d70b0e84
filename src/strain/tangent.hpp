/// @file tangent.hpp
/// How a rod moves as its coordinates do: strains and nodes along given directions. Theory:
/// docs/theory/identification.md
#pragma once
#include <vector>

#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

/// Derivatives of a rod by as many as eight directions of its coordinates: a column each.
struct Tangent {
  std::vector<Block> nodes;                   ///< twists of nodes, in their axes
  std::vector<std::array<Block, 2>> strains;  ///< of elements, at their Gauss points

  explicit Tangent(const RodModel& model);
};

/// After sweep_out. @param directions model.size rows of eight numbers
void tangents(const RodModel& model, const RodWork& work, const double* directions, Tangent& result);

}  // namespace sinew::inline v1::strain
