/// @file limb_signs.hpp
/// How many directions of a loaded robot are unstable. Theory: docs/theory/limb_group.md
#pragma once
#include <algorithm>

#include "math/linalg.hpp"
#include "robot/limbs/limb_group.hpp"

namespace sinew::inline v1 {

/// What does not change on a smooth piece of a curve of equilibria, at fixed inputs and load.
struct LimbSigns {
  int unstable = 0;     ///< directions of the whole robot
  int own = 0;          ///< ... of its limbs, tips held; as `unstable` has them
  bool is_odd = false;  ///< the sign of the determinant of the whole, limbs and platform
  bool operator==(const LimbSigns& other) const {
    return unstable == other.unstable && is_odd == other.is_odd;
  }
};
/// After `linearise`. @param own_of(limb) its unstable directions, tip held
template <class Space, class OwnOf>
LimbSigns signs_of(const LimbGroup<Space>& group, OwnOf&& own_of) {
  LimbSigns signs;
  for (int k = 0; k < group.limbs(); ++k) {
    const auto [in_plane, aside] = own_of(k);
    signs.own += in_plane + aside;
  }
  signs.is_odd = group.factors().has_negative_determinant() != (signs.own % 2 == 1);
  const int even = group.unstable_by_symmetric_part();
  signs.unstable = even >= 0 ? even : signs.own + count_negative_eigenvalues(group.stiffness());
  return signs;
}
template <class Space>
LimbSigns signs_of(const LimbGroup<Space>& group) {
  return signs_of(group, [&](int limb) { return group.unstable_with_tip_held(limb); });
}

/// Unstable directions of the whole robot: the second variation with every limb free to move. After
/// `linearise`.
template <class Space>
int unstable_directions(const LimbGroup<Space>& group) {
  return signs_of(group).unstable;
}

}  // namespace sinew::inline v1
