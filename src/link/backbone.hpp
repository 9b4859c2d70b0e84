/// @file backbone.hpp
/// What is known of a backbone beside its length. Constant-curvature answers do not depend on it.
#pragma once
#include <optional>

#include "sinew/units.hpp"

namespace sinew::inline v1 {

struct Backbone {
  std::optional<double> youngs_modulus;  ///< E [Pa]; in a file under `material`
  std::optional<double> diameter;        ///< of a round solid section [m]
  std::optional<int> joints;             ///< n of a pseudo-rigid model

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("diameter", self.diameter, Dimension::length, Range::positive(), "diameter of the round backbone");
    visit("joints", self.joints, Dimension::count, Range::between(1, 32), "joints of the pseudo-rigid model");
  }
};

}  // namespace sinew::inline v1
