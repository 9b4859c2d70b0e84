/// A leg condensed to its unknown forces: their rows B, the solves by its Hessian H, and their compliance
/// D = C + B H⁻¹ Bᵀ.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/arm_legs/group/regular_lu.hpp"
#include "strain/condense.hpp"
#include "strain/rod_frames.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1 {

/// By which a leg's unknown forces count alike.
ArmGroup::Vector ArmGroup::units_of(const Leg& leg) const {
  const double energy = rod(leg).model().energy_scale, size = leg.own->arm.length();
  Vector unit(leg.unknowns());
  for (const Tendon& tendon : leg.tendons)
    if (tendon.is_taut) unit[tendon.place] = std::sqrt(energy / (tendon.unit + tendon.compliance));
  for (int i = 0; i < leg.closed; ++i)
    unit[leg.taut + i] = leg.components[at(i)] < 3 ? energy / size : energy;
  unit.tail(unit.size() - leg.forces()).setConstant(std::sqrt(energy));
  return unit / std::sqrt(energy);
}

/// Rows of the tendons: of taut ones among the unknowns, of prescribed tensions in L.
void ArmGroup::set_tendon_rows(Leg& leg) const {
  const strain::RodWork& work = rod(leg).work();
  const int n = rod(leg).model().size;
  leg.L.setZero(static_cast<int>(leg.tendons.size()), n);
  int prescribed = 0;
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    const Tendon& tendon = leg.tendons[i];
    const Eigen::Map<const Eigen::RowVectorXd> row(work.length_gradient.data() + i * at(n), n);
    if (tendon.is_taut) {
      leg.B.row(tendon.place) = row;
      leg.r[tendon.place] = missing_length(leg, i);
      leg.C[tendon.place] = tendon.compliance + softness(tendon);
    } else if (tendon.command.held == TendonHeld::tension) {
      leg.L.row(tendon.place) = row;
      ++prescribed;
    }
  }
  leg.L.conservativeResize(prescribed, n);
}

/// Rows of the closure between tip and platform, by strains and by the platform's twist.
void ArmGroup::set_closure_rows(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  const strain::RodWork& work = rod(leg).work();
  const int n = model.size, taut = leg.taut;
  Matrix twists(6, n);
  tip_twists(model, work, twists.data());
  const Frame mount = mount_of(leg);
  const Mat<double, 3, 3> tip = turn_of(work.frames.back()), turn = mount.R.matrix(),
                          off = turn.transpose() * tip;
  const Vec<double, 6> open = leg.off - (1 - share_) * leg.gap;
  Matrix by_strain(6, n);
  Eigen::Matrix<double, 6, 6> by_platform = Eigen::Matrix<double, 6, 6>::Zero();
  by_strain.topRows(3) = -tip * twists.topRows(3);
  by_platform.topLeftCorner<3, 3>().setIdentity();
  by_platform.topRightCorner<3, 3>() = -skew<double>(mount.p - platform_.p);
  if (leg.own->is_clamped) {
    const Mat<double, 3, 3> whole = off.trace() * Mat<double, 3, 3>::Identity();
    by_strain.bottomRows(3) = -0.5 * (whole - off.transpose()) * twists.bottomRows(3);
    by_platform.bottomRightCorner<3, 3>() = 0.5 * (whole - off) * turn.transpose();
  }
  leg.X.setZero(leg.unknowns(), 6);
  for (int i = 0; i < leg.closed; ++i) {
    const int component = leg.components[at(i)];
    leg.B.row(taut + i) = by_strain.row(component);
    leg.r[taut + i] = -open[component];
    leg.X.row(taut + i) = by_platform.row(component);
  }
}

/// H⁻¹ Bᵀ, H⁻¹ Lᵀ and −H⁻¹ (gradient), and with them the compliance and the right-hand side.
void ArmGroup::condense(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  const int n = model.size, all = leg.unknowns(), prescribed = static_cast<int>(leg.L.rows());
  const int columns = all + prescribed + 1, stride = (columns + strain::row - 1) / strain::row * strain::row;
  Matrix sides = Matrix::Zero(n, stride);
  sides.leftCols(all) = leg.B.transpose();
  sides.middleCols(all, prescribed) = leg.L.transpose();
  for (int i = 0; i < n; ++i) sides(i, all + prescribed) = -work.gradient[at(i)];
  strain::solve(model, work, sides.data(), columns, stride);
  leg.HB = sides.leftCols(all);
  leg.HL = sides.middleCols(all, prescribed);
  leg.y0 = sides.col(all + prescribed);
  leg.D = leg.B * leg.HB;
  leg.D.diagonal() += leg.C;
  if (leg.has_potential) leg.D = (0.5 * (leg.D + leg.D.transpose())).eval();
  leg.r += leg.B * leg.y0;
}

bool ArmGroup::factor(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  const strain::Inertia inertia = strain::factor(model, rod(leg).work(), 0);
  if (!inertia.ok) return false;
  leave_out_redundant_tendons(leg);
  const int all = leg.unknowns();
  leg.negative = inertia.negative;
  leg.B.setZero(all, model.size);
  leg.r.resize(all);
  leg.C.setZero(all);
  set_tendon_rows(leg);
  set_closure_rows(leg);
  for (int next = leg.forces(); const int pivot : model.pivots) {
    leg.B(next, pivot) = 1;
    leg.C[next] = -1;
    leg.r[next] = 0;
    ++next;
  }
  condense(leg);
  leg.du = Vector::Zero(all);
  return leg.D.allFinite() && leg.r.allFinite();
}

bool ArmGroup::factor_limbs() {
  return std::ranges::all_of(legs_, [&](Leg& leg) { return factor(leg); });
}

/// False where the compliance is singular, as of a straight backbone that does not stretch: it has no finite
/// stiffness along itself.
bool ArmGroup::factor_compliance(Leg& leg) const {
  const Vector unit = units_of(leg);
  const auto lu = regular_lu(unit.asDiagonal() * leg.D * unit.asDiagonal());
  if (!lu) return false;
  leg.D_inverse = unit.asDiagonal() * lu->inverse() * unit.asDiagonal();
  return leg.D_inverse.allFinite();
}

}  // namespace sinew::inline v1
