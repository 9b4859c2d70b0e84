#include "robot/rods/general_system.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "math/linalg.hpp"
#include "robot/rods/frame_kernels.hpp"
#include "robot/rods/spectral_rod.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {

using namespace spectral;

namespace {

using Vector6 = GeneralRod::Vector;
using Matrix3 = GeneralRod::Square;
using Basis = LobattoBasis<element_degree>;

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

SO3<double> frame_of(const RodLane* frame, int i) {
  return {frame[0][i], Vec3<double>(frame[1][i], frame[2][i], frame[3][i])};
}
void put_frame(const SO3<double>& R, RodLane* frame, int i) {
  frame[0][i] = R.w;
  for (int c = 0; c < 3; ++c) frame[c + 1][i] = R.v[c];
}
double product(const SO3<double>& a, const SO3<double>& b) { return a.w * b.w + dot(a.v, b.v); }
/// Of the two quaternions of a rotation the one near this.
SO3<double> near(const SO3<double>& R, const SO3<double>& other) {
  return product(R, other) < 0 ? SO3<double>{-R.w, Vec3<double>(-R.v)} : R;
}
Vec3<double> z_axis(const SO3<double>& R) { return R.rotate(Vec3<double>(0, 0, 1)); }
/// The least rotation that takes one unit vector to another.
SO3<double> least_turn(const Vec3<double>& from, const Vec3<double>& to) {
  const double cosine = dot(from, to);
  if (cosine < -1 + 1e-12) return {0, cross(from, Vec3<double>(0.6, 0, 0.8)).normalized()};
  return SO3<double>{1 + cosine, cross(from, to)}.normalised();
}
/// The angle about the sections' tangent from one to another that has the same.
double twist_between(const SO3<double>& from, const SO3<double>& to) {
  const SO3<double> by = from.inverse().compose(to);
  double angle = 2 * std::atan2(by.v[2], by.w);
  if (angle > std::numbers::pi) angle -= 2 * std::numbers::pi;
  if (angle < -std::numbers::pi) angle += 2 * std::numbers::pi;
  return angle;
}

/// The same about the platform's point.
Vector6 on_platform(const GeneralRod& rod, Vector6 wrench) {
  wrench.tail<3>() += cross(rod.arm, Vec3<double>(wrench.head<3>()));
  return wrench;
}

/// Where a rod does not determine its force: nothing that follows is a number.
void spoil(GeneralRod& rod) {
  rod.is_regular = false;
  rod.by_twist.setConstant(not_a_number);
  rod.stiffness_by_twist.setConstant(not_a_number);
  rod.by_length.setConstant(not_a_number);
  rod.feed.setConstant(not_a_number);
  rod.fix.setConstant(not_a_number);
  rod.closed.setConstant(not_a_number);
}

/// The tip's stiffness as the platform sees it. Forces keep their direction while their arms turn.
Mat<double, 6, 6> on_platform_stiffness(const GeneralRod& rod) {
  Mat<double, 6, 6> out = rod.stiffness_by_twist;
  const Vec3<double>&b = rod.arm, &n = rod.force;
  out.bottomRows<3>() += skew(b) * out.topRows<3>();
  out.bottomRightCorner<3, 3>() += b * n.transpose() - dot(b, n) * Matrix3::Identity();
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

GeneralSystem::GeneralSystem(const ParallelRobot<RodLeg>& robot)
    : HeavyRodGroup(robot),
      groups_(v1::at((robot.leg_count() + rod_lanes - 1) / rod_lanes)),
      spare_(groups_.size()),
      first_(groups_.size()),
      shifted_(groups_.size()) {
  for (FrameRods& rods : groups_) rods = {};
  for (int k = 0; k < static_cast<int>(groups_.size()) * rod_lanes; ++k) {
    const RodLeg& leg = robot.legs[v1::at(k < rods_ ? k : k / rod_lanes * rod_lanes)];
    GeneralRod rod;
    rod.rod = spatial_rod(leg.link);
    rod.frame = {leg.base.p, section_of(leg.base.R)};
    rod.ends = ends_of(leg);
    const bool turns = rod.ends.base == RodEnds::Base::spins &&
                       (rod.ends.tip == RodEnds::Tip::clamp || !rod.rod.is_isotropic());
    // an axial rotation that nothing depends on is none: held, it costs no torque
    if (!turns) rod.ends.base = RodEnds::Base::held;
    rod.platform_point = leg.platform_point;
    rod.platform_section = section_of(leg.platform_across, leg.platform_tangent);
    rod.stiffness = std::sqrt(rod.rod.bending_stiffness[0]) * std::sqrt(rod.rod.bending_stiffness[1]);
    if (!leg.link.is_round()) rod.reach = Vec2<double>(leg.link.height, leg.link.width) / 2;
    rod.arm.setZero();
    spoil(rod);

    FrameRods& rods = groups_[v1::at(k / rod_lanes)];
    const int i = lane(k);
    rods.length[i] = 1;
    rods.unit[i] = rod.stiffness;
    for (int c = 0; c < 2; ++c) rods.stiffness[c][i] = rod.rod.bending_stiffness[c] / rod.stiffness;
    rods.stiffness[2][i] = rod.rod.torsion_stiffness / rod.stiffness;
    put({rod.rod.shear_compliance[0], rod.rod.shear_compliance[1], rod.rod.extension_compliance},
        rods.compliance, i);
    put(rod.rod.precurvature, rods.precurvature, i);
    put(rod.rod.load, rods.weight, i);
    rods.turns_at_base[i] = turns ? 1 : 0;
    for (auto& frame : rods.frame) put_frame(rod.frame.R, frame, i);
    if (k < rods_) all_.push_back(rod);
  }
}

const LimbTraits& GeneralSystem::traits() const {
  static constexpr LimbTraits traits{
      // lengths are good to 1e-9 of themselves with the quick truncation
      .best_truncation = 1e-15,
      .quick_truncation = 1e-9,
      .has_no_rest =
          "no equilibrium was found of each rod by itself, held at home: a wide strip or a "
          "strongly bent rod may have none near an arc"};
  return traits;
}

void GeneralSystem::save(LimbState& to) const {
  save_common(to, elements_, groups_.size() * sizeof(FrameState));
  for (const FrameRods& rods : groups_) {
    to.put(std::span(rods.frame).first(v1::at(elements_ * degree + 1)));
    to.put(rods.length);
    to.put(rods.force);
  }
}

void GeneralSystem::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  elements_ = restore_common(reader);
  for (FrameRods& rods : groups_) {
    reader.get(std::span(rods.frame).first(v1::at(elements_ * degree + 1)));
    reader.get(rods.length);
    reader.get(rods.force);
  }
}

void GeneralSystem::set_inputs(Numbers inputs) {
  for (int k = 0; k < limbs(); ++k) set_feed(k, inputs[v1::at(input_of(k))]);
}

void GeneralSystem::weigh(int rod, const Vec3<double>& weight) {
  at(rod).rod.load = weight;
  put(weight, lanes(rod).weight, lane(rod));
}

/// L² ∫ (1 − σ) p′ dσ: where the rod's own weight acts, times its length.
Vec3<double> GeneralSystem::lever(int rod) const {
  const FrameRods& rods = lanes(rod);
  const int i = lane(rod);
  const double length = rods.length[i];
  Vec3<double> sum = Vec3<double>::Zero();
  for (int node = 0; node <= elements_ * degree; ++node) {
    const auto [s, share] = place_of(node, elements_);
    const SO3<double> R = frame_of(rods.frame[node], i);
    const Vec3<double> n = vector_of(rods.force, i) + at(rod).rod.load * (length * (1 - s));
    Vec3<double> v = vector_of(rods.compliance, i).cwiseProduct(R.rotate_back(n));
    v[2] += 1;
    sum += share * (1 - s) * R.rotate(v);
  }
  return sum * (length * length);
}

double GeneralSystem::weight_energy() const {
  double energy = 0;
  for (int k = 0; k < limbs(); ++k) {
    const Vec3<double>& load = at(k).rod.load;
    if (!load.isZero(0)) energy -= dot(load, Vec3<double>(lever(k) + length(k) * at(k).frame.p));
  }
  return energy;
}

bool GeneralSystem::can_coarsen(double wanted) const { return is_fine() && 1000 * truncation() < wanted; }

void GeneralSystem::refine() {
  if (!is_finest()) change_elements(levels[level_of(elements_) + 1]);
}
void GeneralSystem::coarsen() {
  if (is_fine()) change_elements(levels[level_of(elements_) - 1]);
}

void GeneralSystem::change_elements(int elements) {
  for (FrameRods& rods : groups_) {
    RodLane old[FrameState::max_nodes + 1][4];
    std::copy_n(&rods.frame[0][0][0], (elements_ * degree + 1) * 4 * rod_lanes, &old[0][0][0]);
    for (int node = 1; node <= elements * degree; ++node) {
      const double along = place_of(node, elements).along * elements_;
      const int element = std::min(static_cast<int>(along), elements_ - 1);
      double row[degree + 1];
      lagrange(along - element, row);
      for (int i = 0; i < rod_lanes; ++i) {
        SO3<double> sum{0, Vec3<double>::Zero()};
        for (int j = 0; j <= degree; ++j) {
          const SO3<double> frame = frame_of(old[element * degree + j], i);
          sum.w += row[j] * frame.w;
          sum.v += row[j] * frame.v;
        }
        put_frame(sum.normalised(), rods.frame[node], i);
      }
    }
  }
  elements_ = elements;
}

/// Where the platform holds the tip, and at a clamp its section or its tangent.
void GeneralSystem::place_tip(int k) {
  GeneralRod& rod = at(k);
  RodLane* frame = lanes(k).frame[elements_ * degree];
  rod.length = length(k);
  rod.moment_unit = rod.stiffness / rod.length;
  rod.force_unit = rod.moment_unit / rod.length;
  rod.arm = platform_.R.rotate(rod.platform_point);
  rod.way = (platform_.p + rod.arm - rod.frame.p) / rod.length;
  if (!rod.follows()) return;
  const SO3<double> held = platform_.R.compose(rod.platform_section), now = frame_of(frame, lane(k));
  const SO3<double> there = rod.ends.tip == RodEnds::Tip::clamp
                                ? held
                                : least_turn(z_axis(now), z_axis(held)).compose(now).normalised();
  put_frame(near(there, now), frame, lane(k));
}

/// After the kernels' evaluation; the rod's error.
double GeneralSystem::read_tip(int k) {
  GeneralRod& rod = at(k);
  const FrameRods& rods = lanes(k);
  const int i = lane(k), tip = elements_ * degree;
  rod.force = vector_of(rods.force, i);
  rod.moment = vector_of(rods.gap[tip], i);
  rod.section = frame_of(rods.frame[tip], i).matrix();
  double error = rods.error[i], nothing = rod.force.sum() * 0;
  const Vec3<double> off = rod.way - vector_of(rods.reached, i);
  for (int c = 0; c < 3; ++c) {
    error = std::max(error, std::abs(off[c]));
    if (rod.is_free(c)) error = std::max(error, std::abs(rod.moment[c]));
    nothing += (off[c] + rod.moment[c]) * 0;
  }
  return rod.error = error + nothing + rods.error[i] * 0;
}

double GeneralSystem::evaluate(bool /*from_scratch*/) {
  for (int k = 0; k < limbs(); ++k) place_tip(k);
  frame_kernels::evaluate(groups_, elements_);
  sum_.setZero();
  rod_error_ = 0;
  double stiffest[2] = {0, 0}, nothing = 0;
  for (int k = 0; k < limbs(); ++k) {
    const double error = read_tip(k);
    const GeneralRod& rod = at(k);
    rod_error_ = std::max(rod_error_, error);
    nothing += error * 0;
    Vector6 wrench = Vector6::Zero();
    wrench.head<3>() = rod.force;
    if (rod.follows()) wrench.tail<3>() = rod.section * rod.moment * rod.moment_unit;
    sum_ += on_platform(rod, wrench);
    stiffest[0] = std::max(stiffest[0], rod.force_unit);
    stiffest[1] = std::max(stiffest[1], rod.moment_unit);
  }
  rod_error_ += nothing;
  const Wrench open = GeneralSystem::wrench_residual();
  const double balance = std::max(open.head<3>().lpNorm<Eigen::Infinity>() / stiffest[0],
                                  open.tail<3>().lpNorm<Eigen::Infinity>() / stiffest[1]);
  return std::max(rod_error_, balance) + nothing + open.sum() * 0;
}

/// Everything kept of the last linearisation.
void GeneralSystem::linearise_rod(int k) {
  GeneralRod& rod = at(k);
  const FrameRods& rods = lanes(k);
  const int i = lane(k);
  Eigen::Matrix<double, FrameRods::left, FrameRods::left> whole;
  for (int r = 0; r < FrameRods::left; ++r)
    for (int c = 0; c <= r; ++c) whole(r, c) = whole(c, r) = rods.condensed[triangle_place(r, c)][i];
  if (!whole.allFinite()) return spoil(rod);
  rod.turned = rod.section;
  // turns do not commute: the derivative of the gradient at a turned section
  rod.by_turn = whole.topLeftCorner<3, 3>() + 0.5 * skew(rod.moment);
  rod.by_force = whole.block<3, 3>(0, 3);
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> matrix;
  matrix << rod.by_turn, rod.by_force, rod.by_force.transpose(), whole.block<3, 3>(3, 3);
  for (int c = 0; c < 3; ++c)
    if (!rod.is_free(c)) matrix.row(c) = Vector6::Unit(c).transpose();
  if (!rod.factors.factor(matrix.data(), 1)) return spoil(rod);
  const auto solved = [&](Vector6 open) {  // of the gaps that are to close
    for (int c = 0; c < 3; ++c) open[c] = rod.is_free(c) ? -open[c] : 0;
    open.tail<3>() *= -1;
    Vector6 out;
    rod.factors.solve(open.data(), out.data());
    return out;
  };
  // a tip that follows turns with the platform; its moment turns, too
  const Matrix3 turn = rod.follows() ? Matrix3(rod.section.transpose()) : Matrix3(Matrix3::Zero());
  const Matrix3 turning = skew(rod.moment);
  const double L = rod.length;
  for (int c = 0; c < 6; ++c) {
    Vec3<double> turns = Vec3<double>::Zero(), moved = Vec3<double>::Zero();
    if (c < 3) {
      moved[c] = 1 / L;
    } else {
      turns = turn.col(c - 3);
      moved = cross(Vec3<double>(Vec3<double>::Unit(c - 3)), rod.arm) / L;
    }
    Vector6 open;
    open << rod.by_turn * turns, rod.by_force.transpose() * turns + moved;
    const Vector6 unknowns = solved(open);
    rod.by_twist.col(c) = unknowns;
    rod.stiffness_by_twist.col(c).head<3>() = unknowns.tail<3>() * rod.force_unit;
    const Vec3<double> all = turns + unknowns.head<3>(),
                       by = rod.by_turn * all + rod.by_force * unknowns.tail<3>();
    rod.stiffness_by_twist.col(c).tail<3>() = rod.section * (by - turning * all) * rod.moment_unit;
  }
  Vector6 open = whole.col(6).head<6>();
  open.tail<3>() -= rod.way;
  rod.by_length = solved(open);
  const Vec3<double> turned = rod.by_length.head<3>();
  const Vec3<double> by = open.head<3>() + rod.by_turn * turned + rod.by_force * rod.by_length.tail<3>();
  rod.feed << (rod.by_length.tail<3>() * rod.force_unit - 2 * rod.force) / L,
      rod.section * (by - turning * turned - rod.moment) * (rod.moment_unit / L);
  if (!rod.follows()) {
    rod.stiffness_by_twist.bottomRows<3>().setZero();
    rod.feed.tail<3>().setZero();
  }
  rod.is_regular = true;
}

/// The sum of what the rods hand over once their gaps are closed.
void GeneralSystem::sum_closed() {
  sum_.setZero();
  for (int k = 0; k < limbs(); ++k) {
    GeneralRod& rod = at(k);
    if (rod.is_regular) {
      Vector6 open, right;
      for (int c = 0; c < 6; ++c) open[c] = lanes(k).open[c][lane(k)];
      open.tail<3>() += rod.way;
      right = -open;
      for (int c = 0; c < 3; ++c)
        if (!rod.is_free(c)) right[c] = 0;
      rod.factors.solve(right.data(), rod.fix.data());
      const Vec3<double> turned = rod.fix.head<3>(), more = rod.fix.tail<3>();
      rod.closed.head<3>() = rod.force + more * rod.force_unit;
      const Vec3<double> moment = open.head<3>() + rod.by_turn * turned + rod.by_force * more;
      rod.closed.tail<3>() = rod.section * (moment + cross(turned, rod.moment)) * rod.moment_unit;
      if (!rod.follows()) rod.closed.tail<3>().setZero();
    }
    sum_ += on_platform(rod, rod.closed);
  }
}

bool GeneralSystem::linearise() {
  is_shifted_ = false;
  frame_kernels::linearise(groups_, elements_);
  stiffness_.setZero();
  for (int k = 0; k < limbs(); ++k) {
    linearise_rod(k);
    stiffness_ += on_platform_stiffness(at(k));
  }
  sum_closed();
  return lu_.factor(stiffness_.data(), radius_);
}

GeneralSystem::Twist GeneralSystem::step(bool fresh) {
  if (!fresh) {
    frame_kernels::close(groups_, elements_);
    sum_closed();
  }
  const Wrench wanted = GeneralSystem::wrench_residual();
  Twist twist;
  lu_.solve(wanted.data(), twist.data());
  return twist;
}

/// @param turn of the platform
void GeneralSystem::give_step(int k, const Vector6& unknowns, const Vec3<double>& turn, double longer) {
  const GeneralRod& rod = at(k);
  Vec3<double> turns = unknowns.head<3>();
  if (rod.follows()) turns += rod.turned.transpose() * turn;
  auto& step = lanes(k).step;
  for (int c = 0; c < 3; ++c) {
    step[c][lane(k)] = turns[c];
    step[3 + c][lane(k)] = unknowns[3 + c];
  }
  step[6][lane(k)] = longer / length(k);
}

void GeneralSystem::move(const Twist& twist, Numbers fed) {
  move_platform(twist);
  for (int k = 0; k < limbs(); ++k) {
    const GeneralRod& rod = at(k);
    const double more = fed.empty() ? 0 : fed[v1::at(input_of(k))];
    const Vector6 unknowns = rod.fix + rod.by_twist * twist + rod.by_length * (more / rod.length);
    give_step(k, unknowns, twist.tail<3>(), more);
  }
  frame_kernels::apply(groups_, elements_);
}

GeneralSystem::Wrench GeneralSystem::input_wrench_jacobian(int input) const {
  Wrench sum = Wrench::Zero();
  for (int k = 0; k < limbs(); ++k)
    if (input_of(k) == input) sum += on_platform(at(k), at(k).feed);
  return sum;
}

double GeneralSystem::effort(int k) const {
  const GeneralRod& rod = at(k);
  return dot(z_axis(rod.frame.R),
             Vec3<double>(vector_of(lanes(k).force, lane(k)) + rod.rod.load * length(k)));
}

double GeneralSystem::closing_effort(int k) const {
  const GeneralRod& rod = at(k);
  return effort(k) + dot(z_axis(rod.frame.R), Vec3<double>(rod.fix.tail<3>())) * rod.force_unit;
}

GeneralSystem::Twist GeneralSystem::effort_jacobian(int k) const {
  const GeneralRod& rod = at(k);
  return rod.stiffness_by_twist.topRows<3>().transpose() * z_axis(rod.frame.R);
}

/// m(0), in the section's axes: what keeps it from turning there [N m].
Vec3<double> GeneralSystem::base_moment(int k) const {
  return vector_of(lanes(k).gap[0], lane(k)) * -(at(k).stiffness / length(k));
}

double GeneralSystem::axial_rotation(int k) const {
  return twist_between(at(k).frame.R, frame_of(lanes(k).frame[0], lane(k)));
}

/// Calls `use(place, section, strain)` at places in [0, 1]: the section's frame, and u in its axes [1/m].
template <class Use>
void GeneralSystem::each_section(int k, std::span<const double> places, Use&& use) const {
  const auto& basis = Basis::get();
  const FrameRods& rods = lanes(k);
  const int i = lane(k);
  using Numbers4 = Vec<double, 4>;
  std::array<Numbers4, FrameState::degree + 1> frames, rates;
  int prepared = -1;
  for (const double place : places) {
    const int element = std::min(static_cast<int>(place * elements_), elements_ - 1);
    if (element != prepared) {
      prepared = element;
      for (int j = 0; j <= degree; ++j)
        for (int c = 0; c < 4; ++c) frames[v1::at(j)][c] = rods.frame[element * degree + j][c][i];
      for (int j = 0; j <= degree; ++j) {
        rates[v1::at(j)].setZero();
        for (int m = 0; m <= degree; ++m)
          rates[v1::at(j)] += basis.slope[j][m] * elements_ / rods.length[i] * frames[v1::at(m)];
      }
    }
    double row[degree + 1];
    lagrange(place * elements_ - element, row);
    Numbers4 frame = Numbers4::Zero(), rate = Numbers4::Zero();
    for (int j = 0; j <= degree; ++j) {
      frame += row[j] * frames[v1::at(j)];
      rate += row[j] * rates[v1::at(j)];
    }
    const double square = frame.squaredNorm();
    const SO3<double> q{frame[0], frame.tail<3>()};
    const SO3<double> turn = q.inverse().compose({rate[0], rate.tail<3>()});
    use(place, q.normalised(), Vec3<double>(turn.v * (2 / square)));
  }
}

RodResult GeneralSystem::rod(int index) const {
  const GeneralRod& rod = at(index);
  const FrameRods& rods = lanes(index);
  const int i = lane(index);
  const double length = rods.length[i];
  const Vec3<double> flexibility(1 / rod.rod.bending_stiffness[0], 1 / rod.rod.bending_stiffness[1],
                                 1 / rod.rod.torsion_stiffness);
  const SO3<double> first = frame_of(rods.frame[0], i), last = frame_of(rods.frame[elements_ * degree], i);
  const Vec3<double> t0 = z_axis(rod.frame.R), way = vector_of(rods.reached, i) * length, t1 = z_axis(last);
  RodResult reading;
  reading.length = length;
  reading.chord = way.norm();
  reading.tip = rod.frame.p + way;
  reading.force = vector_of(rods.force, i);
  reading.force_0 = reading.force + rod.rod.load * length;
  if (rod.follows()) reading.moment = last.rotate(Vec3<double>(rod.moment * rod.moment_unit));
  const Vec3<double> moment_0 = base_moment(index);
  reading.moment_0 = first.rotate(moment_0);
  reading.curvature_0 = first.rotate(Vec3<double>(rod.rod.precurvature + flexibility.cwiseProduct(moment_0)));
  reading.axial_force = dot(reading.force, t0);
  // away from the guide's line, as the tip lies; of a rod that does not bend in one plane what is left
  const Vec3<double> aside = (way - t0 * dot(t0, way)).stableNormalized();
  reading.lateral_force =
      std::copysign((reading.force - t0 * reading.axial_force).norm(), dot(reading.force, aside));
  reading.tip_angle = std::copysign(std::atan2(cross(t0, t1).norm(), dot(t0, t1)), dot(t1, aside));

  const auto& basis = Basis::get();
  std::array<double, 65> places;
  for (int e = 0; e < elements_; ++e) {  // both sides of a node where two elements meet
    for (int j = 0; j <= degree; ++j) {
      const SO3<double> R = frame_of(rods.frame[e * degree + j], i);
      SO3<double> rate{0, Vec3<double>::Zero()};
      for (int m = 0; m <= degree; ++m) {
        const SO3<double> other = frame_of(rods.frame[e * degree + m], i);
        rate.w += basis.slope[j][m] * other.w;
        rate.v += basis.slope[j][m] * other.v;
      }
      const Vec3<double> u = R.inverse().compose(rate).v * (2 * elements_ / length),
                         bent = u - rod.rod.precurvature;
      const double left = 1 - (e + basis.node[j]) / elements_;
      const Vec3<double> a = R.rotate_back(Vec3<double>(reading.force + rod.rod.load * (length * left)));
      reading.energy += 0.5 * length * basis.weight[j] / elements_ *
                        (dot(bent, Vec3<double>(bent.cwiseQuotient(flexibility))) +
                         dot(a, Vec3<double>(vector_of(rods.compliance, i).cwiseProduct(a))));
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = static_cast<double>(k) / 64;
  each_section(index, places, [&](double, const SO3<double>&, const Vec3<double>& u) {
    const Vec2<double> about = (u - rod.rod.precurvature).head<2>();
    reading.largest_curvature = std::max(reading.largest_curvature, about.norm());
    if (rod.reach[0] > 0)  // at a corner of a strip
      reading.largest_strain =
          std::fmax(reading.largest_strain, dot(Vec2<double>(about.cwiseAbs()), rod.reach));
  });
  return reading;
}

/// By the inertia of bordered matrices, as TangentSystem: that of all unknowns, less the three that the tip's
/// place takes.
int GeneralSystem::count_unstable(const FrameRods& rods, int k) const {
  const GeneralRod& rod = at(k);
  const int i = lane(k);
  int count = -3;
  for (int e = 0; e < elements_; ++e)
    for (int pivot = 0; pivot < FrameRods::eliminated; ++pivot)
      count += rods.factors[e][triangle_place(pivot, pivot)][i] < 0;
  std::array<int, 6> kept;
  int size = 0;
  for (int c = 0; c < 6; ++c)
    if (c >= 3 || rod.is_free(c)) kept[v1::at(size++)] = c;
  std::array<double, 36> left;
  std::array<double, 6> values;
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c) {
      const auto [a, b] = std::minmax(kept[v1::at(r)], kept[v1::at(c)]);
      left[v1::at(r * size + c)] = rods.condensed[triangle_place(b, a)][i];
    }
  symmetric_eigenvalues(MatrixView(left.data(), size, size), std::span(values).first(v1::at(size)));
  for (int r = 0; r < size; ++r) count += values[v1::at(r)] < 0;
  return count;
}

/// A motion that costs nothing, as that of a rod whose ends let it turn about its axis, is told from one that
/// the energy falls by: those count that still do where every turn resists a little.
std::array<int, 2> GeneralSystem::unstable_with_tip_held(int index) const {
  constexpr double free_turn = 1e-5;
  if (!at(index).is_regular) return {1, 0};  // what cannot be counted is not vouched for
  const int count = count_unstable(lanes(index), index);
  if (count <= 0) return {0, 0};
  if (!is_shifted_) {
    std::ranges::copy(groups_, shifted_.begin());
    frame_kernels::linearise(shifted_, elements_, free_turn);
    is_shifted_ = true;
  }
  return {std::max(0, count_unstable(shifted_[v1::at(index / rod_lanes)], index)), 0};
}

double GeneralSystem::truncation() const {
  // as of tangents, whose rates are twice those of the quaternion
  constexpr double per_square = 4e-4;
  alignas(64) RodLane largest;
  frame_kernels::truncation(groups_, elements_, largest);
  return per_square * *std::max_element(largest, largest + rod_lanes);
}

std::vector<Vec3<double>> GeneralSystem::centreline(int index, int samples) const {
  const GeneralRod& rod = at(index);
  const FrameRods& rods = lanes(index);
  const int i = lane(index);
  const double length = rods.length[i];
  const Vec3<double> force = vector_of(rods.force, i), compliance = vector_of(rods.compliance, i);
  std::vector<Vec3<double>> points{rod.frame.p};
  const int panels = 1 + 64 / (samples - 1);  // between two points; 64 in all give the tip to 1e-12
  const double step = 1.0 / (panels * (samples - 1)), offset = std::sqrt(3.0 / 5) / 2;
  Vec3<double> p = points.front();
  for (int k = 0; k < panels * (samples - 1); ++k) {  // three-point Gauss
    const double places[3] = {(k + 0.5 - offset) * step, (k + 0.5) * step, (k + 0.5 + offset) * step};
    int point = 0;
    each_section(index, places, [&](double place, const SO3<double>& R, const Vec3<double>&) {
      const Vec3<double> n = force + rod.rod.load * (length * (1 - place));
      Vec3<double> v = compliance.cwiseProduct(R.rotate_back(n));
      v[2] += 1;
      p += length * step * (point++ == 1 ? 8.0 / 18 : 5.0 / 18) * R.rotate(v);
    });
    if ((k + 1) % panels == 0) points.push_back(p);
  }
  return points;
}

void GeneralSystem::get_rod(int index, std::span<double> coordinates) const {
  std::array<double, rod_tangents> places;
  for (int node = 0; node < rod_tangents; ++node)
    places[v1::at(node)] = place_of(node, coordinate_elements).along;
  auto to = coordinates.begin();
  each_section(index, places, [&](double, const SO3<double>& R, const Vec3<double>&) {
    to = std::ranges::copy(R.log(), to).out;
  });
  to = std::ranges::copy(vector_of(lanes(index).force, lane(index)), to).out;
  *to = length(index);
}

void GeneralSystem::set_rods(Numbers coordinates) {
  elements_ = coordinate_elements;
  for (int k = 0; k < limbs(); ++k) {
    FrameRods& rods = lanes(k);
    const int i = lane(k);
    auto from = coordinates.begin() + coordinate_of(k);
    const auto next = [&] {
      const Vec3<double> v(from[0], from[1], from[2]);
      from += 3;
      return v;
    };
    for (int node = 0; node < rod_tangents; ++node) {
      const SO3<double> R = SO3<double>::exp(next());
      put_frame(near(R, frame_of(rods.frame[std::max(node - 1, 0)], i)), rods.frame[node], i);
    }
    put(next(), rods.force, i);
    rods.length[i] = *from;
  }
}

bool GeneralSystem::draw_rods() {
  elements_ = coarse_elements;
  for (int k = 0; k < limbs(); ++k)
    if (!draw_rod(k, 0)) return false;
  return true;
}

/// @param spin of the section at the end that may turn about its tangent
bool GeneralSystem::draw_rod(int k, double spin) {
  const int tip = elements_ * degree;
  const GeneralRod& rod = at(k);
  FrameRods& rods = lanes(k);
  const int i = lane(k);
  const SO3<double> held = platform_.R.compose(rod.platform_section);
  const Vec3<double> way = platform_.p + platform_.R.rotate(rod.platform_point) - rod.frame.p;
  const double chord = way.norm();
  if (!(chord > 0)) return false;
  const Vec3<double> from = z_axis(rod.frame.R) * chord;
  // without moment at the tip the cubic's second derivative is 0 there
  const Vec3<double> to =
      rod.follows() ? Vec3<double>(z_axis(held) * chord) : Vec3<double>(1.5 * way - 0.5 * from);
  const Vec3<double> twice = 6 * way - 4 * from - 2 * to, thrice = 6 * from + 6 * to - 12 * way;
  SO3<double> frames[max_elements * degree + 1];
  frames[0] = rod.frame.R;
  double length = 0;
  for (int node = 0; node <= tip; ++node) {
    const auto [s, weight] = place_of(node, elements_);
    const Vec3<double> slope = from + s * twice + s * s / 2 * thrice;
    length += weight * slope.norm();
    if (node > 0)
      frames[node] =
          least_turn(z_axis(frames[node - 1]), slope.normalized()).compose(frames[node - 1]).normalised();
  }
  if (!(length * rod.rod.precurvature.norm() < max_elements)) return false;
  // a clamp twists the rod, or turns it in its guide
  const bool turns = rod.ends.base == RodEnds::Base::spins;
  const double twist = rod.ends.tip == RodEnds::Tip::clamp ? twist_between(frames[tip], held) : 0;
  for (int node = 0; node <= tip; ++node) {
    const double along = place_of(node, elements_).along;
    const double angle = turns ? twist + spin * (1 - along) : (twist + spin) * along;
    put_frame(frames[node].compose(SO3<double>::exp({0, 0, angle})), rods.frame[node], i);
  }
  rods.length[i] = length;
  const Vec3<double> ahead = way / chord;
  put((ahead * dot(ahead, thrice) - thrice) * (rod.stiffness / (length * length * length)), rods.force, i);
  return true;
}

/// A rod's law with `share` of what it differs by from a round, straight rod without load.
void GeneralSystem::scale_law(int k, double share) {
  const GeneralRod& rod = at(k);
  FrameRods& rods = lanes(k);
  for (int c = 0; c < 2; ++c)
    rods.stiffness[c][lane(k)] = 1 + share * (rod.rod.bending_stiffness[c] / rod.stiffness - 1);
  put(rod.rod.precurvature * share, rods.precurvature, lane(k));
  put(rod.rod.load * share, rods.weight, lane(k));
}

void GeneralSystem::copy_rod(std::span<const FrameState> from, int k) {
  const FrameState& before = from[v1::at(k / rod_lanes)];
  FrameRods& rods = lanes(k);
  for (int node = 0; node <= elements_ * degree; ++node)
    put_frame(frame_of(before.frame[node], lane(k)), rods.frame[node], lane(k));
  put(vector_of(before.force, lane(k)), rods.force, lane(k));
  rods.length[lane(k)] = before.length[lane(k)];
}

bool GeneralSystem::grow_rods() {
  constexpr std::array spins = {0.0, 1.6, -1.6, 3.1};
  constexpr double near = 1e-7;
  if (!draw_rods()) return false;
  std::array<bool, max_rods> grows, found{};
  grows.fill(true);
  int left = limbs();
  for (std::size_t attempt = 0; left > 0 && attempt < spins.size(); ++attempt) {
    std::ranges::copy(groups_, first_.begin());
    for (int k = 0; k < limbs(); ++k)
      if (attempt > 0 && grows[v1::at(k)]) draw_rod(k, spins[attempt]);
    grow(grows, attempt > 0);
    evaluate();
    linearise();
    left = 0;
    for (int k = 0; k < limbs(); ++k) {
      if (!grows[v1::at(k)]) continue;
      const bool is_solved = at(k).error < near, is_stable = is_solved && unstable_with_tip_held(k)[0] == 0;
      if (!is_stable && found[v1::at(k)]) copy_rod(first_, k);
      found[v1::at(k)] = found[v1::at(k)] || is_solved;
      const bool turns = at(k).ends.base == RodEnds::Base::spins || at(k).ends.tip == RodEnds::Tip::tangent;
      left += grows[v1::at(k)] = turns && !is_stable;
    }
  }
  evaluate();
  return limb_error() < near;
}

/// These rods, the platform held; the others are in equilibrium.
/// @param keeps_spin their sections are drawn turned, and would turn back if they were round
bool GeneralSystem::grow(std::span<const bool> which, bool keeps_spin) {
  constexpr double near = 1e-8, shortest = 1e-3;
  const auto each = [&](auto&& use) {
    for (int k = 0; k < limbs(); ++k)
      if (which[v1::at(k)]) use(k);
  };
  const auto let_turn = [&](bool lets) {
    each([&](int k) {
      if (at(k).ends.base == RodEnds::Base::spins && (keeps_spin || at(k).ends.tip != RodEnds::Tip::clamp))
        lanes(k).turns_at_base[lane(k)] = lets ? 1 : 0;
    });
  };
  const auto settled = [&] {
    int iterations = 0;
    double residual = 0;
    return correct_rods(iterations, residual, near);
  };
  let_turn(false);
  each([&](int k) { scale_law(k, keeps_spin && at(k).ends.tip == RodEnds::Tip::tangent ? 1 : 0); });
  bool is_grown = settled();
  for (double share = 0, stride = 1; is_grown && share < 1;) {
    std::ranges::copy(groups_, spare_.begin());
    const double next = std::min(1.0, share + stride);
    each([&](int k) { scale_law(k, keeps_spin && at(k).ends.tip == RodEnds::Tip::tangent ? 1 : next); });
    if (settled()) {
      share = next;
      stride *= 1.5;
    } else {
      each([&](int k) { copy_rod(spare_, k); });
      stride *= 0.4;
      is_grown = stride > shortest;
    }
  }
  each([&](int k) { scale_law(k, 1); });
  is_grown = is_grown && turn_to_rest();
  let_turn(true);
  return is_grown && settled();
}

/// Rods whose sections the guides let turn, one after the other held at angles downhill: ∂E/∂ψ is the torque
/// in the guide.
bool GeneralSystem::turn_to_rest() {
  constexpr double near = 1e-8, shortest = 1e-4, longest = 0.3;
  std::array<double, max_rods> stride, torque;
  const auto torque_of = [&](int k) { return lanes(k).gap[0][2][lane(k)]; };
  int left = 0;
  evaluate();
  for (int k = 0; k < limbs(); ++k) {
    torque[v1::at(k)] = torque_of(k);
    const bool turns = at(k).ends.base == RodEnds::Base::spins && lanes(k).turns_at_base[lane(k)] == 0;
    stride[v1::at(k)] = turns ? std::copysign(0.1, -torque_of(k)) : 0;
    left += turns;
  }
  const int tip = elements_ * degree;
  for (int tries = 0; left > 0 && tries < 200; ++tries) {
    std::ranges::copy(groups_, spare_.begin());
    for (int k = 0; k < limbs(); ++k)
      for (int node = 0; node < tip && stride[v1::at(k)] != 0; ++node) {
        RodLane* frame = lanes(k).frame[node];
        const double angle = stride[v1::at(k)] * (1 - place_of(node, elements_).along);
        put_frame(frame_of(frame, lane(k)).compose(SO3<double>::exp({0, 0, angle})), frame, lane(k));
      }
    int iterations = 0;
    double residual = 0;
    correct_rods(iterations, residual, near);
    for (int k = 0; k < limbs(); ++k) {
      double& by = stride[v1::at(k)];
      if (by == 0) continue;
      if (!(at(k).error < near)) {  // back, and less far
        copy_rod(spare_, k);
        by *= 0.4;
        if (std::abs(by) < shortest) return false;
        continue;
      }
      if (torque_of(k) * torque[v1::at(k)] <= 0) {
        by = 0;
        --left;
      } else {
        torque[v1::at(k)] = torque_of(k);
        by = std::copysign(std::min(1.5 * std::abs(by), longest), by);
      }
    }
  }
  return left == 0;
}

bool GeneralSystem::is_stable_by_rods() const {
  for (int k = 0; k < limbs(); ++k)
    if (unstable_with_tip_held(k)[0] != 0) return false;
  return true;
}

double GeneralSystem::move_to_rest(double most) {
  double largest = 0;
  for (int k = 0; k < limbs(); ++k) {
    const GeneralRod& rod = at(k);
    const Vec3<double> ahead = rod.way / rod.way.norm();
    const double pull = dot(ahead, Vec3<double>(rod.closed.head<3>()));
    const double wanted = -pull / dot(ahead, Vec3<double>(rod.feed.head<3>())), limit = most * rod.length;
    const double fed = std::isfinite(wanted) ? std::clamp(wanted, -limit, limit) : 0;
    largest = std::max(largest, std::abs(fed) / rod.length);
    give_step(k, rod.fix + rod.by_length * (fed / rod.length), Vec3<double>::Zero(), fed);
  }
  frame_kernels::apply(groups_, elements_);
  return largest;
}

}  // namespace sinew::inline v1
