/// @file prb_discretisation.hpp
/// How a backbone is cut into rigid links and springs. Theory: docs/theory/pseudo_rigid.md
#pragma once
#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// How the backbone is lumped into joints, and how its tendons run.
enum class PrbDiscretisation {
  even,      ///< M0, as [TDPCR]: all joints alike, tendons guided along the links
  weighted,  ///< M0w: joints next to an end stand for that end too. Of second order in chord and turn
  discs      ///< M1: as M0, tendons straight between discs at the middles of links
};

}  // namespace sinew::inline v1
