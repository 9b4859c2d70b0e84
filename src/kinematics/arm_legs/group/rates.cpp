/// Derivatives of an equilibrium by commands of tendons and by a wrench on the platform, with the matrix of
/// all unknown forces and the platform.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include "kinematics/arm_legs/group/regular_lu.hpp"

namespace sinew::inline v1 {

/// What each command, and then the wrench, adds to the equations.
ArmGroup::Matrix ArmGroup::rate_sides(Eigen::Index size) const {
  Matrix sides = Matrix::Zero(size, feeds_ + 6);
  sides.bottomRightCorner(6, 6).setIdentity();
  if (robot_->is_planar) sides.bottomRightCorner(6, 6).diagonal().segment(2, 3).setZero();
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
      const Tendon& tendon = leg.tendons[i];
      const Eigen::Index column = leg.first_feed + static_cast<int>(i);
      if (tendon.is_taut)
        sides(next + tendon.place, column) = 1;
      else if (tendon.command.held == TendonHeld::tension)
        sides.block(next, column, leg.unknowns(), 1) = leg.B * leg.HL.col(tendon.place);
    }
    next += leg.unknowns();
  }
  return sides;
}

/// Of a leg's tendons what is not prescribed, by all commands and by the wrench.
/// @param forces the rates of the leg's unknown forces
void ArmGroup::set_tendon_rates(const Leg& leg, const Matrix& forces, Matrix& by_tendon) const {
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    const Tendon& tendon = leg.tendons[i];
    const Eigen::Index row = leg.first_feed + static_cast<int>(i);
    if (tendon.is_taut) {
      by_tendon.row(row) = forces.row(tendon.place);
    } else if (tendon.command.held == TendonHeld::tension) {
      const auto way = leg.L.row(tendon.place);
      by_tendon.row(row) = -(way * leg.HB) * forces;
      for (std::size_t j = 0; j < leg.tendons.size(); ++j)
        if (leg.tendons[j].command.held == TendonHeld::tension)
          by_tendon(row, leg.first_feed + static_cast<int>(j)) -= way.dot(leg.HL.col(leg.tendons[j].place));
      by_tendon(row, row) -= tendon.compliance;
    }
  }
}

bool ArmGroup::answers(Matrix& twists, Matrix& by_tendon) const {
  const Vector unit = units();
  const auto lu = regular_lu(whole());
  if (!lu) return false;
  const Matrix sides = (unit.asDiagonal() * rate_sides(unit.size())).eval();
  const Matrix found = unit.asDiagonal() * lu->solve(sides).eval();
  twists = found.bottomRows(6);
  by_tendon.setZero(feeds_, feeds_ + 6);
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    set_tendon_rates(leg, found.middleRows(next, leg.unknowns()), by_tendon);
    next += leg.unknowns();
  }
  return found.allFinite();
}

}  // namespace sinew::inline v1
