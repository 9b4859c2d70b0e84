#include "robot/general_system.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "link/tip_gaps.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

using Vector6 = Vec<double, 6>;
using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Of a leg's frame, whose +y is the tangent: that of the section, whose third axis it is.
SO3<double> section_of(const SO3<double>& leg) {
  const double half = std::sqrt(0.5);
  return leg.compose({half, Vec3<double>(-half, 0, 0)});  // z to y, x stays
}

/// @param across its x; what of it is along the tangent does not count
SO3<double> section_of(Vec3<double> across, const Vec3<double>& tangent) {
  across -= tangent * dot(tangent, across);
  if (across.norm() < 1e-9) across = cross(tangent, Vec3<double>(0.6, 0, 0.8));
  if (across.norm() < 1e-9) across = Vec3<double>(0, 1, 0);
  across.normalize();
  Mat<double, 3, 3> axes;
  axes << across, cross(tangent, across), tangent;
  return SO3<double>::from(axes);
}

RodEnds ends_of(const RodLeg& leg) {
  RodEnds ends;
  ends.base = leg.is_spin_held ? RodEnds::Base::held : RodEnds::Base::spins;
  ends.tip = !leg.is_clamped        ? RodEnds::Tip::ball
             : leg.is_tip_spin_free ? RodEnds::Tip::tangent
                                    : RodEnds::Tip::clamp;
  return ends;
}

TipGaps gaps_of(const GeneralRod& rod, const SE3<double>& platform) {
  return {rod.ends.tip,
          {platform.p + rod.arm, platform.R.compose(rod.platform_section)},
          rod.length,
          rod.stiffness / rod.length};
}

/// Force and moment of the platform on the tip.
Vector6 wrench_of(const GeneralRod& rod) {
  Vector6 wrench = Vector6::Zero();
  wrench.head<3>() = rod.tip.n;
  if (rod.ends.tip != RodEnds::Tip::ball) wrench.tail<3>() = rod.tip.m;
  return wrench;
}

/// The same about the platform's point.
Vector6 on_platform(const GeneralRod& rod, Vector6 wrench) {
  wrench.tail<3>() += cross(rod.arm, Vec3<double>(wrench.head<3>()));
  return wrench;
}

/// What an unknown changes at the base, as columns of RodTangent.
Mat<double, 8, 6> base_columns(const GeneralRod& rod) {
  Mat<double, 8, 6> columns = Mat<double, 8, 6>::Zero();
  columns.topLeftCorner<3, 3>() = Mat<double, 3, 3>::Identity() * rod.force_unit;
  columns.block<3, 3>(RodTangent::moment, 3) = rod.frame.R.matrix() * rod.moment_unit;
  if (rod.seeks_axial_rotation) {  // the torque stays 0 while the section turns
    columns.col(5).setZero();
    columns(RodTangent::axial_rotation, 5) = 1;
  }
  return columns;
}

/// What a twist of the platform does to a point with this arm and the frame there.
Mat<double, 6, 6> carried(const Vec3<double>& arm) {
  Mat<double, 6, 6> out = Mat<double, 6, 6>::Identity();
  out.topRightCorner<3, 3>() = -skew(arm);
  return out;
}

/// Where a rod does not determine its force: nothing that follows is a number.
void spoil(GeneralRod& rod) {
  rod.is_regular = false;
  rod.by_twist.setConstant(not_a_number);
  rod.tip_wrench_jacobian.setConstant(not_a_number);
  rod.by_length.setConstant(not_a_number);
  rod.feed.setConstant(not_a_number);
  rod.fix.setConstant(not_a_number);
}

/// Everything kept of the last linearisation.
void linearise_rod(GeneralRod& rod, const SE3<double>& platform, int steps) {
  const RodTangent tangent = integrate_tangent(rod.rod, rod.length, rod.from, {steps, 0});
  if (tangent.tip.status != Status::converged) return spoil(rod);
  rod.moment_unit = rod.stiffness / rod.length;
  rod.force_unit = rod.moment_unit / rod.length;
  const TipGaps gaps = gaps_of(rod, platform);
  const Mat<double, 12, 6> rate = tangent.rate * base_columns(rod);
  const Mat<double, 12, 1> fed = tangent.rate.col(RodTangent::length);
  const RowMajor jacobian = gaps.rows<6>(tangent.tip.state, rate);
  if (!rod.factors.factor(jacobian.data(), 1)) return spoil(rod);
  const Mat<double, 6, 6> by_twist = -gaps.by_tip(tangent.tip.state) * carried(rod.arm);
  const Vector6 by_length = -gaps.rows<1>(tangent.tip.state, fed);
  for (int c = 0; c < 6; ++c) {
    const Vector6 column = by_twist.col(c);
    Vector6 solved;
    rod.factors.solve(column.data(), solved.data());
    rod.by_twist.col(c) = solved;
  }
  rod.factors.solve(by_length.data(), rod.by_length.data());
  rod.tip_wrench_jacobian = rate.bottomRows<6>();
  rod.feed = fed.tail<6>();
  if (rod.ends.tip == RodEnds::Tip::ball) {
    rod.tip_wrench_jacobian.bottomRows<3>().setZero();
    rod.feed.tail<3>().setZero();
  }
  rod.feed += rod.tip_wrench_jacobian * rod.by_length;
  rod.is_regular = true;
}

/// The tip's stiffness as the platform sees it. Forces keep their direction while their arms turn.
Mat<double, 6, 6> on_platform_stiffness(const GeneralRod& rod) {
  Mat<double, 6, 6> out = rod.tip_wrench_jacobian * rod.by_twist;
  const Vec3<double>&b = rod.arm, &n = rod.tip.n;
  out.bottomRows<3>() += skew(b) * out.topRows<3>();
  out.bottomRightCorner<3, 3>() += b * n.transpose() - dot(b, n) * Mat<double, 3, 3>::Identity();
  return out;
}

}  // namespace

SpatialRod spatial_rod(const Rod& rod) {
  // where it is not given, no torque and no shear ask for it
  const double shear = rod.shear_modulus > 0 ? rod.shear_modulus : rod.youngs_modulus / 2.6;
  const RodLaw law = rod.is_cosserat ? RodLaw::cosserat : RodLaw::kirchhoff;
  SpatialRod out = rod.is_round() ? SpatialRod::round(rod.youngs_modulus, shear, rod.diameter, law)
                                  : SpatialRod::strip(rod.youngs_modulus, shear, rod.width, rod.height, law);
  out.precurvature = rod.precurvature;
  out.load = rod.load;
  return out;
}

GeneralSystem::GeneralSystem(const ParallelRobot<RodLeg>& robot) : HeavyRodGroup(robot) {
  for (const RodLeg& leg : robot.legs) {
    GeneralRod rod;
    rod.rod = spatial_rod(leg.link);
    rod.frame = {leg.base.p, section_of(leg.base.R)};
    rod.ends = ends_of(leg);
    rod.seeks_axial_rotation = rod.ends.base == RodEnds::Base::spins &&
                               (rod.ends.tip == RodEnds::Tip::clamp || !rod.rod.is_isotropic());
    // an axial rotation that nothing depends on is none: held, it costs no torque
    if (!rod.seeks_axial_rotation) rod.ends.base = RodEnds::Base::held;
    rod.platform_point = leg.platform_point;
    rod.platform_section = section_of(leg.platform_across, leg.platform_tangent);
    rod.stiffness = std::sqrt(rod.rod.bending_stiffness[0]) * std::sqrt(rod.rod.bending_stiffness[1]);
    if (!leg.link.is_round()) rod.reach = Vec2<double>(leg.link.height, leg.link.width) / 2;
    rod.arm.setZero();
    rod.gap.setZero();
    spoil(rod);
    all_.push_back(rod);
  }
}

const LimbTraits& GeneralSystem::traits() const {
  static constexpr LimbTraits traits{
      // lengths are good to 1e-9 of themselves with the quick truncation
      .is_slow = true,
      .best_truncation = 1e-15,
      .quick_truncation = 1e-9,
      .has_no_rest =
          "no equilibrium was found of each rod by itself, held at home: a wide strip or a "
          "strongly bent rod may have none near an arc"};
  return traits;
}

void GeneralSystem::save(LimbState& to) const {
  std::array<double, rod_numbers> numbers;
  save_common(to, elements_, all_.size() * sizeof(numbers));
  for (int k = 0; k < limbs(); ++k) {
    get_rod(k, numbers);
    to.put(numbers);
  }
}

void GeneralSystem::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  elements_ = restore_common(reader);
  for (GeneralRod& rod : all_) set_rod(rod, reader.next<std::array<double, rod_numbers>>());
}

void GeneralSystem::set_inputs(Numbers inputs) {
  for (int k = 0; k < limbs(); ++k) at(k).length = inputs[v1::at(input_of(k))];
}

double GeneralSystem::weight_energy() const {
  double energy = 0;
  for (const GeneralRod& rod : all_) energy += rod.potential - rod.length * dot(rod.rod.load, rod.frame.p);
  return energy;
}

/// Order 8: half the steps leave 256 times the error.
bool GeneralSystem::can_coarsen(double wanted) const { return is_fine() && 1000 * truncation() < wanted; }

double GeneralSystem::evaluate(bool /*from_scratch*/) {
  sum_.setZero();
  rod_error_ = 0;
  double stiffest[2] = {0, 0}, nothing = 0;
  const Mat<double, 3, 3> R = platform_.R.matrix();
  for (GeneralRod& rod : all_) {
    const SO3<double> section = rod.frame.R.compose(SO3<double>::exp({0, 0, rod.axial_rotation}));
    rod.from = {rod.frame.p, section, rod.force, rod.moment};
    const RodTip tip = integrate(rod.rod, rod.length, rod.from, {elements_, 0});
    rod.tip = tip.state;
    rod.energy = tip.energy - tip.potential;
    rod.potential = tip.potential;
    rod.arm = R * rod.platform_point;
    rod.gap = gaps_of(rod, platform_).gap(rod.tip);
    if (tip.status != Status::converged) rod.gap.setConstant(not_a_number);
    rod_error_ = std::max(rod_error_, rod.gap.lpNorm<Eigen::Infinity>());
    nothing += rod.gap.sum() * 0;
    sum_ += on_platform(rod, wrench_of(rod));
    const double moment = rod.stiffness / rod.length, force = moment / rod.length;
    stiffest[0] = std::max(stiffest[0], force);
    stiffest[1] = std::max(stiffest[1], moment);
  }
  rod_error_ += nothing;
  const Wrench open = GeneralSystem::wrench_residual();
  const double balance = std::max(open.head<3>().lpNorm<Eigen::Infinity>() / stiffest[0],
                                  open.tail<3>().lpNorm<Eigen::Infinity>() / stiffest[1]);
  return std::max(rod_error_, balance) + nothing + open.sum() * 0;
}

/// The sum of what the rods hand over once their gaps are closed.
void GeneralSystem::sum_closed() {
  sum_.setZero();
  for (GeneralRod& rod : all_) {
    const Vector6 open = -rod.gap;
    if (rod.is_regular) rod.factors.solve(open.data(), rod.fix.data());
    sum_ += on_platform(rod, wrench_of(rod) + rod.tip_wrench_jacobian * rod.fix);
  }
}

bool GeneralSystem::linearise() {
  stiffness_.setZero();
  for (GeneralRod& rod : all_) {
    linearise_rod(rod, platform_, elements_);
    stiffness_ += on_platform_stiffness(rod);
  }
  sum_closed();
  return lu_.factor(stiffness_.data(), radius_);
}

GeneralSystem::Twist GeneralSystem::step(bool fresh) {
  if (!fresh) sum_closed();
  const Wrench wanted = GeneralSystem::wrench_residual();
  Twist twist;
  lu_.solve(wanted.data(), twist.data());
  return twist;
}

void GeneralSystem::move_rod(GeneralRod& rod, const Vector6& by, double fed) {
  rod.force += by.head<3>() * rod.force_unit;
  const Vec3<double> bent(by[3], by[4], rod.seeks_axial_rotation ? 0 : by[5]);
  rod.moment += rod.frame.R.rotate(bent) * rod.moment_unit;
  if (rod.seeks_axial_rotation) rod.axial_rotation += by[5];
  rod.length += fed;
}

void GeneralSystem::move(const Twist& twist, Numbers fed) {
  move_platform(twist);
  for (int k = 0; k < limbs(); ++k) {
    GeneralRod& rod = at(k);
    const double more = fed.empty() ? 0 : fed[v1::at(input_of(k))];
    move_rod(rod, rod.fix + rod.by_twist * twist + rod.by_length * more, more);
  }
}

GeneralSystem::Wrench GeneralSystem::input_wrench_jacobian(int input) const {
  Wrench sum = Wrench::Zero();
  for (int k = 0; k < limbs(); ++k)
    if (input_of(k) == input) sum += on_platform(at(k), at(k).feed);
  return sum;
}

double GeneralSystem::effort(int rod) const { return dot(at(rod).from.tangent(), at(rod).force); }

double GeneralSystem::closing_effort(int rod) const {
  const GeneralRod& one = at(rod);
  return effort(rod) + dot(one.from.tangent(), Vec3<double>(one.fix.head<3>())) * one.force_unit;
}

GeneralSystem::Twist GeneralSystem::effort_jacobian(int rod) const {
  const GeneralRod& one = at(rod);
  return one.by_twist.topRows<3>().transpose() * one.from.tangent() * one.force_unit;
}

RodResult GeneralSystem::rod(int index) const {
  const GeneralRod& rod = at(index);
  const Vec3<double> compliance(1 / rod.rod.bending_stiffness[0], 1 / rod.rod.bending_stiffness[1],
                                1 / rod.rod.torsion_stiffness);
  const auto bend = [&](const RodState<double>& here) -> Vec3<double> {  // beyond that at rest
    return compliance.cwiseProduct(here.R.rotate_back(here.m));
  };
  const Vec3<double> t0 = rod.from.tangent(), way = rod.tip.p - rod.frame.p, last = rod.tip.tangent();
  RodResult reading;
  reading.length = rod.length;
  reading.chord = way.norm();
  reading.tip = rod.tip.p;
  reading.force = rod.tip.n;
  reading.force_0 = rod.force;
  if (rod.ends.tip != RodEnds::Tip::ball) reading.moment = rod.tip.m;
  reading.moment_0 = rod.moment;
  reading.curvature_0 = rod.from.R.rotate(Vec3<double>(rod.rod.precurvature + bend(rod.from)));
  reading.axial_force = dot(reading.force, t0);
  // away from the guide's line, as the tip lies; of a rod that does not bend in one plane what is left
  const Vec3<double> aside = (way - t0 * dot(t0, way)).stableNormalized();
  reading.lateral_force =
      std::copysign((reading.force - t0 * reading.axial_force).norm(), dot(reading.force, aside));
  reading.tip_angle = std::copysign(std::atan2(cross(t0, last).norm(), dot(t0, last)), dot(last, aside));
  reading.energy = rod.energy;
  std::array<RodState<double>, 65> sections;
  rod_sections(rod.rod, rod.length, rod.from, sections, {elements_, 0});
  for (const RodState<double>& section : sections) {
    const Vec2<double> about = bend(section).head<2>();
    reading.largest_curvature = std::max(reading.largest_curvature, about.norm());
    if (rod.reach[0] > 0)  // at a corner of a strip
      reading.largest_strain =
          std::fmax(reading.largest_strain, dot(Vec2<double>(about.cwiseAbs()), rod.reach));
  }
  return reading;
}

std::array<int, 2> GeneralSystem::unstable_with_tip_held(int index) const {
  const GeneralRod& rod = at(index);
  const int count = v1::unstable_directions(rod.rod, rod.length, rod.from, rod.ends);
  return {count < 0 ? 1 : count, 0};  // what cannot be counted is not vouched for
}

double GeneralSystem::truncation() const {
  constexpr double per_difference = 1.0 / 64;  // 1/255 by the order; fewer and long steps do not show it yet
  double worst = 0;
  for (const GeneralRod& rod : all_) {
    const RodTip coarse = integrate(rod.rod, rod.length, rod.from, {elements_ / 2, 0});
    const double turn = rod.tip.R.compose(coarse.state.R.inverse()).log().norm();
    const double missed = std::max((rod.tip.p - coarse.state.p).norm() / rod.length, turn) * per_difference;
    if (!(missed <= worst) && !std::isnan(worst)) worst = missed;
  }
  return worst;
}

std::vector<Vec3<double>> GeneralSystem::centreline(int index, int samples) const {
  const GeneralRod& rod = at(index);
  std::vector<RodState<double>> sections(v1::at(samples));
  rod_sections(rod.rod, rod.length, rod.from, sections, {elements_, 0});
  std::vector<Vec3<double>> points;
  for (const RodState<double>& section : sections) points.push_back(section.p);
  return points;
}

void GeneralSystem::get_rod(int index, std::span<double> coordinates) const {
  const GeneralRod& rod = at(index);
  auto to = std::ranges::copy(rod.force, coordinates.begin()).out;
  to = std::ranges::copy(rod.moment, to).out;
  *to++ = rod.axial_rotation;
  *to++ = rod.length;
  std::fill(to, coordinates.end(), 0.0);
}

void GeneralSystem::set_rod(GeneralRod& rod, Numbers numbers) {
  rod.force = {numbers[0], numbers[1], numbers[2]};
  rod.moment = {numbers[3], numbers[4], numbers[5]};
  rod.axial_rotation = numbers[6];
  rod.length = numbers[7];
}

void GeneralSystem::set_rods(Numbers coordinates) {
  elements_ = max_elements;
  for (int k = 0; k < limbs(); ++k) set_rod(at(k), coordinates.subspan(v1::at(coordinate_of(k))));
}

bool GeneralSystem::draw_rods() {
  elements_ = coarse_elements;
  const Mat<double, 3, 3> R = platform_.R.matrix();
  for (GeneralRod& rod : all_) {
    const SE3<double> tip{platform_.p + R * rod.platform_point, platform_.R.compose(rod.platform_section)};
    const Vec3<double> way = tip.p - rod.frame.p;
    const double chord = way.norm();
    if (!(chord > 0)) return false;
    const Vec3<double> from = rod.frame.R.rotate(Vec3<double>(0, 0, chord));
    // without moment at the tip the cubic's second derivative is 0 there
    const Vec3<double> to = rod.ends.tip == RodEnds::Tip::ball ? Vec3<double>(1.5 * way - 0.5 * from)
                                                               : tip.R.rotate(Vec3<double>(0, 0, chord));
    const Vec3<double> twice = 6 * way - 4 * from - 2 * to, thrice = 6 * from + 6 * to - 12 * way;
    constexpr int panels = 32;
    rod.length = 0;
    for (int k = 0; k < panels; ++k) {
      const double s = (k + 0.5) / panels;
      rod.length += (from + s * twice + s * s / 2 * thrice).norm() / panels;
    }
    // one that turns further than its steps resolve at rest, too
    if (!(rod.length * rod.rod.precurvature.norm() < max_elements)) return false;
    const RodBvpSolution held =
        v1::solve_rod_bvp(rod.rod, rod.frame, rod.length, rod.ends, tip, {.tolerance = 1e-9});
    if (!held.report.ok()) return false;
    rod.force = held.base.n;
    rod.moment = held.base.m;
    rod.axial_rotation = held.axial_rotation;
  }
  return true;
}

double GeneralSystem::move_to_rest(double most) {
  double largest = 0;
  for (GeneralRod& rod : all_) {
    const Vec3<double> way = platform_.p + rod.arm - rod.frame.p, ahead = way / way.norm();
    const Vector6 by_fix = rod.tip_wrench_jacobian * rod.fix;
    const double pull = dot(ahead, Vec3<double>(rod.tip.n + by_fix.head<3>()));
    const double wanted = -pull / dot(ahead, Vec3<double>(rod.feed.head<3>())), limit = most * rod.length;
    const double fed = std::isfinite(wanted) ? std::clamp(wanted, -limit, limit) : 0;
    largest = std::max(largest, std::abs(fed) / rod.length);
    move_rod(rod, rod.fix + rod.by_length * fed, fed);
  }
  return largest;
}

}  // namespace sinew::inline v1
