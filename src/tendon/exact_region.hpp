/// @file exact_region.hpp
/// The bends no tendon forbids in the exact model, whose frontiers are curves.
#pragma once
#include "tendon/margin.hpp"

namespace sinew::inline v1 {

struct ExactRegion {
  Polygon boundary;    ///< counter-clockwise [rad], of the largest part if there are several
  double area = 0;     ///< [rad²], of all parts
  int parts = 0;       ///< closed curves the boundary consists of
  bool closed = true;  ///< whether they close
};

ExactRegion exact_region(const SectionCase& c, const Margin& margin);

/// Where tendon i has neither slack nor stretch, around the envelope.
Curve exact_frontier(const SectionCase& c, std::size_t i);

}  // namespace sinew::inline v1
