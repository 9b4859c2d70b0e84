/// Stability: the number of unstable modes by Sylvester's law of inertia, of the whole, at a prescribed pose
/// and of a leg with its tip held. Under loads without a potential they are those of the symmetric part of
/// the stiffness.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>

#include "base/at.hpp"
#include "strain/condense.hpp"

namespace sinew::inline v1 {

/// The rod's factors stay those of its own Hessian.
ArmGroup::SymmetricPart ArmGroup::symmetric_part(const Leg& leg) const {
  if (leg.has_potential) return {leg.D, leg.negative, true};
  SymmetricPart part;
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  const std::vector<strain::PieceTerms> kept = work.pieces;
  make_symmetric(model, work);
  if (const strain::Inertia inertia = strain::factor(model, work, 0); inertia.ok) {
    const int all = leg.unknowns(), stride = (all + strain::row - 1) / strain::row * strain::row;
    Matrix sides = Matrix::Zero(model.size, stride);
    sides.leftCols(all) = leg.B.transpose();
    strain::solve(model, work, sides.data(), all, stride);
    part.D = leg.B * sides.leftCols(all);
    part.D.diagonal() += leg.C;
    part.D = (0.5 * (part.D + part.D.transpose())).eval();
    part.negative = inertia.negative;
    part.ok = part.D.allFinite();
  }
  work.pieces = kept;
  work.symmetric = false;
  return part;
}

int ArmGroup::unstable() const {
  std::vector<SymmetricPart> parts;
  int count = 0;
  for (const Leg& leg : legs_) {
    const SymmetricPart& part = parts.emplace_back(symmetric_part(leg));
    if (!part.ok) return -1;
    count += part.negative - leg.forces();
  }
  const Matrix matrix = whole(parts);
  if (!matrix.allFinite()) return -1;
  const Matrix symmetric = 0.5 * (matrix + matrix.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> found(symmetric, Eigen::EigenvaluesOnly);
  for (const double value : found.eigenvalues()) count += value < 0;
  return count;
}

int ArmGroup::unstable_at_prescribed_pose() const {
  int count = 0;
  for (const Leg& leg : legs_) {
    const SymmetricPart part = symmetric_part(leg);
    if (!part.ok) return -1;
    count += unstable_with_tip_held(leg, part.D, part.negative);
  }
  return count;
}

int ArmGroup::unstable_by_symmetric_part() const {
  const bool all = std::ranges::all_of(legs_, [](const Leg& leg) { return leg.has_potential; });
  return all ? -1 : std::max(0, unstable());
}

/// @param D, negative symmetric: the compliance, and directions of the Hessian
int ArmGroup::unstable_with_tip_held(const Leg& leg, const Matrix& D, int negative) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> found(D, Eigen::EigenvaluesOnly);
  int stiff = 0;
  for (const double value : found.eigenvalues()) stiff += value < 0;
  return negative - stiff + static_cast<int>(leg.pivots().size());
}

/// Where loads have no potential the sign of the leg's determinant is told, by 0 or 1.
std::array<int, 2> ArmGroup::unstable_with_tip_held(int limb) const {
  const Leg& leg = legs_[at(limb)];
  if (leg.has_potential) return {unstable_with_tip_held(leg, leg.D, leg.negative), 0};
  const Vector unit = units_of(leg);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(unit.asDiagonal() * leg.D * unit.asDiagonal());
  const int is_turned = lu.determinant() < 0, pivots = static_cast<int>(leg.pivots().size());
  return {(leg.negative + is_turned + pivots) % 2, 0};
}

}  // namespace sinew::inline v1
