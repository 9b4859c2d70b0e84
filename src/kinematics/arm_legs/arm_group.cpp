#include "kinematics/arm_legs/arm_group.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "strain/condense.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1 {
namespace {

using Three3 = Mat<double, 3, 3>;

/// Twice the skew part of a matrix, as a vector: of ½ [v] it is v.
Vec3<double> axial(const Three3& m) { return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}; }
Three3 turn_of(const strain::RodFrame& frame) {
  Three3 turn;
  turn << frame.R[0], frame.R[1], frame.R[2], frame.R[3], frame.R[4], frame.R[5], frame.R[6], frame.R[7],
      frame.R[8];
  return turn;
}
Vec3<double> place_of(const strain::RodFrame& frame) { return {frame.p[0], frame.p[1], frame.p[2]}; }

double worst_of(double a, double b) { return !(b <= a) ? b : a; }  // NaN wins

/// Of the length's error of a tendon by its tension: what an arm yields to it, roughly [m/N].
double yields(const Arm& arm, const ArmTendon& tendon) {
  double sum = 0;
  for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
    const ArmSection& section = arm.sections[m];
    const double r = tendon.routes[m].start_radius;
    sum += r * r * section.length / std::min(section.start.bending_x, section.start.bending_y);
  }
  return sum;
}

/// Shapes that polynomials do not tell one another: joints in other places.
bool has_other_joints(const strain::RodModel& a, const strain::RodModel& b) {
  return a.pieces.size() != b.pieces.size() &&
         std::ranges::any_of(b.elements, [](const strain::Element& element) {
           return element.points == 1 && !element.is_pivot;
         });
}

/// A moment has a potential in the plane, where all turns are about one axis.
bool bears_a_potential(const ArmLoad& load, bool is_planar) {
  const auto is_zero = [](std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return x == 0; });
  };
  return is_zero(load.following_along) && std::ranges::all_of(load.points, [&](const PointLoad& point) {
           return is_zero(point.following || !is_planar
                              ? std::span(point.wrench).last(point.following ? 6 : 3)
                              : std::span<const double>());
         });
}

}  // namespace

LegsLoads mix(const LegsLoads& from, const LegsLoads& to, double share) {
  if (share == 1) return to;
  LegsLoads loads;
  for (std::size_t i = 0; i < 3; ++i) {
    loads.gravity[i] = std::lerp(from.gravity[i], to.gravity[i], share);
    loads.along[i] = std::lerp(from.along[i], to.along[i], share);
    loads.following_along[i] = std::lerp(from.following_along[i], to.following_along[i], share);
  }
  for (std::size_t i = 0; i < 6; ++i)
    loads.following[i] = std::lerp(from.following[i], to.following[i], share);
  const auto add = [&](const std::vector<ArmLegsPointLoad>& points, double part) {
    if (part == 0) return;
    for (ArmLegsPointLoad point : points) {
      for (double& number : point.wrench) number *= part;
      loads.points.push_back(point);
    }
  };
  add(from.points, 1 - share);
  add(to.points, share);
  return loads;
}

LegsBreaks breaks_for(const ArmLegs& robot, const LegsLoads& loads) {
  LegsBreaks breaks(robot.legs.size());
  for (const ArmLegsPointLoad& point : loads.points)
    if (std::ranges::any_of(point.wrench, [](double number) { return number != 0; }))
      breaks[point.leg].push_back(point.place);
  for (std::vector<double>& places : breaks) {
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
  }
  return breaks;
}

ArmGroup::ArmGroup(const ArmLegs& robot, const ArmBasis& basis, const LegsBreaks& breaks)
    : robot_(&robot),
      platform_(Frame::from(robot.home)),
      loads_{.gravity = robot.gravity} {
  legs_.reserve(robot.legs.size());
  for (const ArmLeg& own : robot.legs) {
    const std::vector<double>& places = breaks[legs_.size()];
    Leg& leg = legs_.emplace_back(own);
    ArmBasis of_leg = basis;
    of_leg.in_plane = robot.is_planar;
    of_leg.turns_at_base = own.turns_at_base;
    stand(leg, of_leg, places);
    if (own.strut > 0) {
      of_leg.strut = own.strut;
      of_leg.strut_angle = way_to_platform(leg);
      stand(leg, of_leg, places);
    }
    strain::RodWork& work = rod(leg).work();
    leg.first_feed = feeds_;
    leg.closed = own.is_clamped ? 6 : 3;
    if (robot.is_planar) {  // the mount's y axis is square to the plane
      leg.closed = own.is_clamped ? 3 : 2;
      leg.components = {0, 1, 4, 0, 0, 0};
    }
    for (std::size_t i = 0; i < own.arm.tendons.size(); ++i) {
      const ArmTendon& from = own.arm.tendons[i];
      Tendon& tendon = leg.tendons.emplace_back();
      tendon.rest = work.lengths[i];
      tendon.compliance = from.compliance;
      tendon.pretension = from.pretension;
      tendon.unit = yields(own.arm, from);
    }
    feeds_ += static_cast<int>(leg.tendons.size());
    measure_closure(leg);
    leg.gap = leg.off;
    radius_ = std::max(radius_, own.platform_point.norm());
    radius_ = std::max(radius_, 0.01 * own.arm.length());
  }
  set_share(0);
}

/// At rest.
void ArmGroup::stand(Leg& leg, const ArmBasis& basis, const std::vector<double>& breaks) {
  ArmWorkspace::Impl& impl = leg.work.impl();
  impl.levels.clear();
  impl.levels.push_back(std::make_unique<ArmRod>(make_rod(leg.own->arm, basis, breaks)));
  impl.level = 0;
  const Three3 turn = leg.own->base.R.matrix();
  strain::RodFrame& foot = rod(leg).work().frames.front();
  for (int i = 0; i < 3; ++i) {
    foot.p[i] = leg.own->base.p[i];
    for (int j = 0; j < 3; ++j) foot.R[3 * i + j] = turn(i, j);
  }
  sweep_out(rod(leg).model(), rod(leg).work());
}

/// From the tip's z axis, about its y [rad].
double ArmGroup::way_to_platform(const Leg& leg) const {
  const strain::RodFrame& tip = rod(leg).work().frames.back();
  const Vec3<double> way = turn_of(tip).transpose() * (mount_of(leg).p - place_of(tip));
  return way.norm() > 1e-9 * leg.own->strut ? std::atan2(way.x(), way.z()) : 0;
}

void ArmGroup::begin_at(const Frame& platform) {
  platform_ = platform;
  for (Leg& leg : legs_) {
    std::ranges::fill(rod(leg).work().y, 0.0);
    aim(leg);
    measure_closure(leg);
    leg.gap = leg.off;
  }
}

/// Turns the leg's free joints towards the platform.
void ArmGroup::aim(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  const double unit = std::sqrt(model.energy_scale);
  sweep_out(model, work);
  const Vec3<double> point = mount_of(leg).p;
  const strain::RodFrame& end = work.frames.back();
  if (leg.own->turns_at_base) {
    const auto angle_of = [&](const Vec3<double>& place) {
      const Vec3<double> way = leg.own->base.rotate_back(place - leg.own->base.p);
      return std::atan2(way.x(), way.z());
    };
    work.y[at(leg.pivots().front())] += unit * (angle_of(point) - angle_of(place_of(end)));
  } else if (leg.own->strut > 0) {  // the bar's own axis is turned as the joint is
    const Vec3<double> joint = place_of(end) - leg.own->strut * turn_of(end).col(2),
                       way = turn_of(end).transpose() * (point - joint);
    work.y[at(leg.pivots().front())] += unit * std::atan2(way.x(), way.z());
  }
  sweep_out(model, work);
}

void ArmGroup::take(const ArmLegsStart& start) {
  platform_ = start.platform;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    Leg& leg = legs_[k];
    take_curvatures(start.curvatures[k], rod(leg).model(), rod(leg).work().y);
    aim(leg);
    leg.force.setZero();
    leg.moment.setZero();
    for (Tendon& tendon : leg.tendons) tendon.tension = 0;
    leg.gap.setZero();
  }
  set_share(1);
}

ArmLegsStart ArmGroup::start_here(int parts) const {
  ArmLegsStart start{platform_, {}};
  for (const Leg& leg : legs_) start.curvatures.push_back(arm_curvatures(leg.own->arm, parts, leg.work));
  return start;
}

void ArmGroup::keep_in_plane(Wrench& wrench) const {
  if (robot_->is_planar) wrench.segment<3>(2).setZero();
}
template <class AnySquare>
void ArmGroup::hold_in_plane(AnySquare& by_twist, const std::array<double, 2>& units) const {
  if (!robot_->is_planar) return;
  const Eigen::Index first = by_twist.rows() - 6;
  for (const int i : {2, 3, 4}) {
    by_twist.row(first + i).setZero();
    by_twist.col(first + i).setZero();
    by_twist(first + i, first + i) = units[i == 2 ? 0 : 1];
  }
}

void ArmGroup::set_problem(std::span<const TendonCommand> commands, const Wrench& wrench,
                           const LegsLoads& loads) {
  for (Leg& leg : legs_)
    for (std::size_t i = 0; i < leg.tendons.size(); ++i)
      leg.tendons[i].command = commands[at(leg.first_feed) + i];
  loads_ = loads;
  wrench_ = wrench;
  set_share(share_);
}

void ArmGroup::set_share(double share) {
  share_ = share;
  std::vector<ArmLoad> loads(legs_.size());
  for (ArmLoad& load : loads) {
    load.gravity.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
      (*load.gravity)[i] = share * loads_.gravity[i];
      load.along[i] = share * loads_.along[i];
      load.following_along[i] = share * loads_.following_along[i];
    }
  }
  for (const ArmLegsPointLoad& point : loads_.points) {
    PointLoad& own = loads[point.leg].points.emplace_back();
    own.place = point.place;
    own.following = point.following;
    for (std::size_t i = 0; i < 6; ++i) own.wrench[i] = share * point.wrench[i];
  }
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    Leg& leg = legs_[k];
    const ArmLoad& load = loads[k];
    set_loads(leg.own->arm, load, rod(leg).model(), rod(leg).work().loads);
    leg.tip = rod(leg).work().loads.back();
    leg.has_potential = bears_a_potential(load, robot_->is_planar);
    rod(leg).work().symmetric = leg.has_potential;
    for (Tendon& tendon : leg.tendons) {
      const double value = tendon.command.value;
      if (tendon.command.held == TendonHeld::tension)
        tendon.target = share * value;
      else
        tendon.free_length = tendon.rest + share * (value - tendon.compliance * tendon.pretension);
    }
  }
}

void ArmGroup::carry_over_from(const ArmGroup& other) {
  platform_ = other.platform_;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& from = other.legs_[k];
    Leg& leg = legs_[k];
    if (has_other_joints(rod(from).model(), rod(leg).model()))
      take_curvatures(arm_curvatures(from.own->arm, 64, from.work), rod(leg).model(), rod(leg).work().y);
    else
      carry_over(rod(from).model(), rod(from).work(), rod(leg).model(), rod(leg).work().y);
    for (std::size_t i = 0; i < leg.pivots().size(); ++i)
      rod(leg).work().y[at(leg.pivots()[i])] = rod(from).work().y[at(from.pivots()[i])];
    leg.force = from.force;
    leg.moment = from.moment;
    for (std::size_t i = 0; i < leg.tendons.size(); ++i) leg.tendons[i].tension = from.tendons[i].tension;
  }
}

const LimbTraits& ArmGroup::traits() const {
  static constexpr LimbTraits traits{.tolerance = 1e-10, .rounding = 1e-13};
  return traits;
}

double ArmGroup::length(int limb) const { return legs_[at(limb)].own->arm.length(); }
double ArmGroup::stiffness(int limb) const {
  return rod(legs_[at(limb)]).model().energy_scale * length(limb);
}

std::pair<const ArmGroup::Leg*, const ArmGroup::Tendon*> ArmGroup::find(int feed) const {
  const auto after = std::ranges::find_if(legs_, [&](const Leg& leg) { return leg.first_feed > feed; });
  const Leg& leg = *std::prev(after);
  return {&leg, &leg.tendons[at(feed - leg.first_feed)]};
}
double ArmGroup::held(int feed) const { return find(feed).second->command.value; }
void ArmGroup::set_feed(int feed, double value) {
  const_cast<Tendon*>(find(feed).second)->command.value = value;  // of this group, which is not const here
  set_share(share_);
}

void ArmGroup::save(LimbState& to) const {
  to.clear();
  to.put(platform_);
  to.put(wrench_);
  to.put(share_);
  for (const Leg& leg : legs_) {
    to.put(leg.force);
    to.put(leg.moment);
    to.put(std::span<const double>(rod(leg).work().y));
    for (const Tendon& tendon : leg.tendons) {
      to.put(tendon.command.value);
      to.put(tendon.tension);
    }
  }
}

void ArmGroup::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  reader.get(platform_);
  reader.get(wrench_);
  reader.get(share_);
  for (Leg& leg : legs_) {
    reader.get(leg.force);
    reader.get(leg.moment);
    reader.get(std::span<double>(rod(leg).work().y));
    for (Tendon& tendon : leg.tendons) {
      reader.get(tendon.command.value);
      reader.get(tendon.tension);
    }
  }
  set_share(share_);
}

auto ArmGroup::mount_of(const Leg& leg) const -> Frame {
  return {platform_.point(leg.own->platform_point), platform_.R.compose(leg.own->mount)};
}
Vec3<double> ArmGroup::moment_of(const Leg& leg) const { return mount_of(leg).rotate(leg.moment); }

void ArmGroup::measure_closure(Leg& leg) {
  const Frame mount = mount_of(leg);
  const strain::RodFrame& tip = rod(leg).work().frames.back();
  leg.off.head<3>() = place_of(tip) - mount.p;
  leg.off.tail<3>() = 0.5 * axial(mount.R.matrix().transpose() * turn_of(tip));
  if (!leg.own->is_clamped) leg.off.tail<3>().setZero();
}

bool ArmGroup::mounts_hold() const {
  return std::ranges::all_of(legs_, [&](const Leg& leg) {
    if (!leg.own->is_clamped) return true;
    const Three3 turn = mount_of(leg).R.matrix().transpose() * turn_of(rod(leg).work().frames.back());
    return turn.trace() > 1;
  });
}

auto ArmGroup::needs(const Leg& leg) const -> Wrench {
  const Vec3<double> b = platform_.rotate(leg.own->platform_point);
  Wrench wrench;
  wrench.head<3>() = leg.force;
  wrench.tail<3>() = cross(b, leg.force) + moment_of(leg);
  keep_in_plane(wrench);
  return wrench;
}
auto ArmGroup::push(int limb) const -> Wrench { return -needs(legs_[at(limb)]); }
auto ArmGroup::tip_wrench(int limb) const -> Wrench {
  Wrench wrench;
  wrench.head<3>() = legs_[at(limb)].force;
  wrench.tail<3>() = moment_of(legs_[at(limb)]);
  return wrench;
}

double ArmGroup::force_unit(const Leg& leg) const {
  return rod(leg).model().energy_scale / leg.own->arm.length();
}

void ArmGroup::evaluate(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  strain::NodeLoad& tip = work.loads.back();
  tip = leg.tip;
  // The moment as dead forces at points of the tip: a potential that is linear in the tip's rotation.
  const Three3 couple = 0.5 * mount_of(leg).R.matrix() * skew<double>(leg.moment);
  for (int i = 0; i < 3; ++i) {
    tip.force[i] += leg.force[i];
    for (int j = 0; j < 3; ++j) tip.couple[3 * i + j] += couple(i, j);
  }
  sweep_out(model, work);
  leg.taut = 0;
  int loose = 0;
  double error = 0;
  const double size = leg.own->arm.length();
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    Tendon& tendon = leg.tendons[i];
    tendon.is_taut = false;
    if (tendon.command.held == TendonHeld::tension) {
      tendon.tension = tendon.target;
      tendon.place = loose++;
      continue;
    }
    const double missing = work.lengths[i] - tendon.free_length - tendon.compliance * tendon.tension;
    tendon.is_taut = tendon.tension + missing / tendon.unit > 0;
    tendon.place = tendon.is_taut ? leg.taut++ : -1;
    if (tendon.is_taut)
      error = worst_of(error, std::abs(missing) / size);
    else
      tendon.tension = 0;
  }
  const auto tension = [&](int index) { return leg.tendons[at(index)].tension; };
  for (std::size_t i = 0; i < model.holes.size(); ++i) work.hole_tension[i] = tension(model.holes[i].tendon);
  for (std::size_t i = 0; i < model.guides.size(); ++i)
    work.guide_tension[i] = tension(model.guides[i].tendon);
  sweep_back_with_hessian(model, work);
  for (const int pivot : model.pivots) {  // it has no stiffness
    const double y = work.y[at(pivot)];
    work.energy -= 0.5 * y * y;
    work.gradient[at(pivot)] -= y;
  }
  measure_closure(leg);
  const Vec<double, 6> open = leg.off - (1 - share_) * leg.gap;
  error = worst_of(error, open.head<3>().norm() / size);
  error = worst_of(error, open.tail<3>().norm());
  double sum = 0;
  for (const double g : work.gradient) sum += g * g;
  limb_error_ = worst_of(limb_error_, worst_of(error, std::sqrt(sum / model.energy_scale)));
}

double ArmGroup::evaluate(bool) {
  balance_ = share_ * wrench_ + turning_wrench();
  for (int i = 0; i < 3; ++i) balance_[i] += share_ * robot_->platform_mass * loads_.gravity[at(i)];
  limb_error_ = 0;
  double unit = 0;
  for (Leg& leg : legs_) {
    evaluate(leg);
    balance_ -= needs(leg);
    unit = std::max(unit, force_unit(leg));
  }
  keep_in_plane(balance_);
  error_ = worst_of(limb_error_, balance_.head<3>().norm() / unit);
  error_ = worst_of(error_, balance_.tail<3>().norm() / (unit * radius_));
  return error_;
}

bool ArmGroup::factor(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  const int n = model.size, taut = leg.taut, all = leg.unknowns();
  const strain::Inertia inertia = strain::factor(model, work, 0);
  if (!inertia.ok) return false;
  leg.negative = inertia.negative;
  leg.B.setZero(all, n);
  leg.L.setZero(static_cast<int>(leg.tendons.size()) - taut, n);
  leg.r.resize(all);
  leg.C.setZero(all);
  int held = 0;
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    Tendon& tendon = leg.tendons[i];
    const Eigen::Map<const Eigen::RowVectorXd> row(work.length_gradient.data() + i * at(n), n);
    if (tendon.is_taut) {
      leg.B.row(tendon.place) = row;
      leg.r[tendon.place] = work.lengths[i] - tendon.free_length - tendon.compliance * tendon.tension;
      leg.C[tendon.place] = tendon.compliance;
    } else if (tendon.command.held == TendonHeld::tension) {
      leg.L.row(tendon.place) = row;
      ++held;
    }
  }
  leg.L.conservativeResize(held, n);
  Matrix twists(6, n);
  tip_twists(model, work, twists.data());
  const Frame mount = mount_of(leg);
  const Three3 tip = turn_of(work.frames.back()), turn = mount.R.matrix(), off = turn.transpose() * tip;
  const Vec<double, 6> open = leg.off - (1 - share_) * leg.gap;
  Matrix by_strain(6, n);
  Eigen::Matrix<double, 6, 6> by_platform = Eigen::Matrix<double, 6, 6>::Zero();
  by_strain.topRows(3) = -tip * twists.topRows(3);
  by_platform.topLeftCorner<3, 3>().setIdentity();
  by_platform.topRightCorner<3, 3>() = -skew<double>(mount.p - platform_.p);
  if (leg.own->is_clamped) {
    const Three3 whole = off.trace() * Three3::Identity();
    by_strain.bottomRows(3) = -0.5 * (whole - off.transpose()) * twists.bottomRows(3);
    by_platform.bottomRightCorner<3, 3>() = 0.5 * (whole - off) * turn.transpose();
  }
  leg.X.setZero(all, 6);
  for (int i = 0; i < leg.closed; ++i) {
    const int component = leg.components[at(i)];
    leg.B.row(taut + i) = by_strain.row(component);
    leg.r[taut + i] = -open[component];
    leg.X.row(taut + i) = by_platform.row(component);
  }
  for (int next = leg.forces(); const int pivot : model.pivots) {
    leg.B(next, pivot) = 1;
    leg.C[next] = -1;
    leg.r[next] = 0;
    ++next;
  }
  const int columns = all + held + 1, stride = (columns + strain::row - 1) / strain::row * strain::row;
  Matrix sides = Matrix::Zero(n, stride);
  sides.leftCols(all) = leg.B.transpose();
  sides.middleCols(all, held) = leg.L.transpose();
  for (int i = 0; i < n; ++i) sides(i, all + held) = -work.gradient[at(i)];
  strain::solve(model, work, sides.data(), columns, stride);
  leg.HB = sides.leftCols(all);
  leg.HL = sides.middleCols(all, held);
  leg.y0 = sides.col(all + held);
  leg.D = leg.B * leg.HB;
  leg.D.diagonal() += leg.C;
  if (leg.has_potential) leg.D = (0.5 * (leg.D + leg.D.transpose())).eval();
  leg.r += leg.B * leg.y0;
  leg.du = Vector::Zero(all);
  return leg.D.allFinite() && leg.r.allFinite();
}

bool ArmGroup::factor_limbs() {
  return std::ranges::all_of(legs_, [&](Leg& leg) { return factor(leg); });
}

/// Of what a leg needs of the platform's wrench, by the platform's twist, its own forces held.
Mat<double, 6, 6> ArmGroup::curvature(const Leg& leg) const {
  Mat<double, 6, 6> change = Mat<double, 6, 6>::Zero();
  const Vec3<double> b = platform_.rotate(leg.own->platform_point);
  change.bottomRightCorner<3, 3>() =
      skew<double>(leg.force) * skew<double>(b) - 0.5 * skew<double>(moment_of(leg));
  return change;
}

auto ArmGroup::turning_wrench() const -> Wrench {
  const auto& own = loads_.following;
  Wrench wrench;
  wrench.head<3>() = platform_.rotate(Vec3<double>(own[0], own[1], own[2]));
  wrench.tail<3>() = platform_.rotate(Vec3<double>(own[3], own[4], own[5]));
  return share_ * wrench;
}
Mat<double, 6, 6> ArmGroup::following_curvature() const {
  const Wrench wrench = turning_wrench();
  Mat<double, 6, 6> change = Mat<double, 6, 6>::Zero();
  change.topRightCorner<3, 3>() = skew<double>(wrench.head<3>());
  change.bottomRightCorner<3, 3>() = skew<double>(wrench.tail<3>());
  return change;
}

bool ArmGroup::platform_has_potential() const {
  return std::ranges::all_of(loads_.following, [](double x) { return x == 0; }) &&
         (robot_->is_planar || wrench_.tail<3>().isZero(0));
}

bool ArmGroup::loads_have_potential() const {
  ArmLoad on_legs;
  on_legs.following_along = loads_.following_along;
  for (const ArmLegsPointLoad& point : loads_.points) {
    PointLoad& own = on_legs.points.emplace_back();
    own.wrench = point.wrench;
    own.following = point.following;
  }
  return platform_has_potential() && bears_a_potential(on_legs, robot_->is_planar);
}

bool ArmGroup::has_potential() const {
  return platform_has_potential() &&
         std::ranges::all_of(legs_, [](const Leg& leg) { return leg.has_potential; });
}

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

/// The same of all legs, then of the platform's motion.
ArmGroup::Vector ArmGroup::units() const {
  int all = 6;
  double energy = 0, size = 0;
  for (const Leg& leg : legs_) {
    all += leg.unknowns();
    energy = std::max(energy, rod(leg).model().energy_scale);
    size = std::max(size, leg.own->arm.length());
  }
  Vector unit(all);
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    unit.segment(next, leg.unknowns()) = units_of(leg);
    next += leg.unknowns();
  }
  unit.tail(6) << size, size, size, 1, 1, 1;
  unit.tail(6) /= std::sqrt(energy);
  return unit;
}

ArmGroup::Matrix ArmGroup::whole(std::span<const SymmetricPart> parts) const {
  const Vector unit = units();
  const auto size = unit.size();
  Matrix whole = Matrix::Zero(size, size);
  whole.bottomRightCorner(6, 6) = following_curvature();
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& leg = legs_[k];
    const int all = leg.unknowns();
    whole.block(next, next, all, all) = parts.empty() ? -leg.D : -parts[k].D;
    whole.block(next, size - 6, all, 6) = leg.X;
    whole.block(size - 6, next, 6, all) = leg.X.transpose();
    whole.bottomRightCorner(6, 6) += curvature(leg);
    next += all;
  }
  whole = (unit.asDiagonal() * whole * unit.asDiagonal()).eval();
  hold_in_plane(whole, {1, 1});
  return whole;
}

bool ArmGroup::plan() {
  const Vector unit = units();
  const Matrix matrix = whole();
  if (!matrix.allFinite()) return false;
  Vector side(unit.size());
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    side.segment(next, leg.unknowns()) = -leg.r;
    next += leg.unknowns();
  }
  side.tail(6) = balance_;
  side = unit.asDiagonal() * side;
  const Eigen::FullPivLU<Matrix> lu(matrix);
  if (!(std::abs(lu.matrixLU().diagonal().tail(1)[0]) > 1e-13 * lu.maxPivot())) return false;
  const Vector answer = unit.asDiagonal() * lu.solve(side).eval();
  if (!answer.allFinite()) return false;
  planned_ = answer.tail(6);
  planned_size_ = planned_.tail<3>().norm();
  next = 0;
  for (Leg& leg : legs_) {
    leg.du = answer.segment(next, leg.unknowns());
    next += leg.unknowns();
    const double bent = (leg.y0 - leg.HB * leg.du).norm() / std::sqrt(rod(leg).model().energy_scale);
    planned_size_ = worst_of(planned_size_, bent);
    planned_size_ = worst_of(planned_size_, planned_.head<3>().norm() / leg.own->arm.length());
  }
  return true;
}

/// By `du`. @param after the platform; by_input changes of this leg's own inputs, or none
void ArmGroup::advance(Leg& leg, const Frame& after, Numbers by_input) {
  Vector step = leg.y0 - leg.HB * leg.du;
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    Tendon& tendon = leg.tendons[i];
    if (tendon.is_taut)
      tendon.tension += leg.du[tendon.place];
    else if (tendon.command.held == TendonHeld::tension && !by_input.empty())
      step -= leg.HL.col(tendon.place) * by_input[i];
  }
  std::vector<double>& y = rod(leg).work().y;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += step[static_cast<Eigen::Index>(i)];
  Vec<double, 6> change = Vec<double, 6>::Zero();
  for (int i = 0; i < leg.closed; ++i) change[leg.components[at(i)]] = leg.du[leg.taut + i];
  leg.force += change.head<3>();
  if (!leg.own->is_clamped) return;
  // The forces that make the moment kept their directions while the platform turned.
  const Three3 turned = (after.R.compose(leg.own->mount)).matrix().transpose() * mount_of(leg).R.matrix();
  leg.moment =
      0.5 * (turned.trace() * Three3::Identity() - turned.transpose()) * (leg.moment + change.tail<3>());
}

void ArmGroup::move_as_planned() {
  const Frame after = platform_.displaced(planned_);
  for (Leg& leg : legs_) advance(leg, after, {});
  platform_ = after;
}

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

bool ArmGroup::answers(Matrix& twists, Matrix& by_tendon) const {
  const Vector unit = units();
  const Matrix matrix = whole();
  if (!matrix.allFinite()) return false;
  const Eigen::FullPivLU<Matrix> lu(matrix);
  if (!(std::abs(lu.matrixLU().diagonal().tail(1)[0]) > 1e-13 * lu.maxPivot())) return false;
  Matrix sides = Matrix::Zero(unit.size(), feeds_ + 6);
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
  sides = (unit.asDiagonal() * sides).eval();
  const Matrix found = unit.asDiagonal() * lu.solve(sides).eval();
  twists = found.bottomRows(6);
  by_tendon.setZero(feeds_, feeds_ + 6);
  next = 0;
  for (const Leg& leg : legs_) {
    const Matrix forces = found.middleRows(next, leg.unknowns());
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
    next += leg.unknowns();
  }
  return found.allFinite();
}

/// A backbone that does not stretch and is straight holds its tip: its stiffness has no bound.
bool ArmGroup::factor_compliance(Leg& leg) const {
  const Vector unit = units_of(leg);
  const Eigen::FullPivLU<Matrix> lu(unit.asDiagonal() * leg.D * unit.asDiagonal());
  if (!(std::abs(lu.matrixLU().diagonal().tail(1)[0]) > 1e-13 * lu.maxPivot())) return false;
  leg.D_inverse = unit.asDiagonal() * lu.inverse() * unit.asDiagonal();
  return leg.D_inverse.allFinite();
}

bool ArmGroup::plan_held() {
  planned_.setZero();
  planned_size_ = 0;
  for (Leg& leg : legs_) {
    if (!factor_compliance(leg)) return false;
    leg.du = leg.D_inverse * leg.r;
    const double bent = (leg.y0 - leg.HB * leg.du).norm() / std::sqrt(rod(leg).model().energy_scale);
    planned_size_ = worst_of(planned_size_, bent);
  }
  return std::isfinite(planned_size_);
}

int ArmGroup::unstable_held() const {
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

bool ArmGroup::linearise() {
  if (!factor_limbs()) return false;
  stiffness_ = following_curvature();
  residual_ = balance_;
  double across = 0, around = 0;
  for (Leg& leg : legs_) {
    const double length = leg.own->arm.length();
    if (!factor_compliance(leg)) return false;
    stiffness_ += curvature(leg) + leg.X.transpose() * leg.D_inverse * leg.X;
    residual_ -= leg.X.transpose() * (leg.D_inverse * leg.r);
    across = std::max(across, force_unit(leg) / length);
    around = std::max(around, rod(leg).model().energy_scale);
  }
  hold_in_plane(stiffness_, {across, around});
  keep_in_plane(residual_);
  return lu_.factor(stiffness_.data(), radius_);
}

auto ArmGroup::step(bool fresh) -> Twist {
  Twist twist = Twist::Constant(not_a_number);
  if (!fresh && !linearise()) return twist;
  lu_.solve(residual_.data(), twist.data());
  return twist;
}

void ArmGroup::move(const Twist& twist, Numbers by_input) {
  const Frame after = platform_.displaced(twist);
  for (Leg& leg : legs_) {
    Vector side = leg.r + leg.X * twist;
    Numbers own;
    if (!by_input.empty()) {
      own = Numbers(by_input.subspan(at(leg.first_feed), leg.tendons.size()));
      for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
        const Tendon& tendon = leg.tendons[i];
        if (tendon.is_taut)
          side[tendon.place] -= own[i];
        else if (tendon.command.held == TendonHeld::tension)
          side -= leg.B * leg.HL.col(tendon.place) * own[i];
      }
    }
    leg.du = leg.D_inverse * side;
    advance(leg, after, own);
  }
  platform_ = after;
}

auto ArmGroup::input_wrench_jacobian(int input) const -> Wrench {
  const auto [leg, tendon] = find(input);
  if (tendon->is_taut) return -leg->X.transpose() * leg->D_inverse.col(tendon->place);
  if (tendon->command.held != TendonHeld::tension) return Wrench::Zero();  // a slack tendon does nothing
  return -leg->X.transpose() * (leg->D_inverse * (leg->B * leg->HL.col(tendon->place)));
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

double ArmGroup::energy() const {
  double sum = 0;
  for (const Leg& leg : legs_) {
    const std::vector<double>& strains = rod(leg).work().y;
    for (const double y : strains) sum += 0.5 * y * y;
    for (const int pivot : leg.pivots()) sum -= 0.5 * strains[at(pivot)] * strains[at(pivot)];
  }
  return sum;
}

double ArmGroup::potential() const {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum -= (wrench_[i] + robot_->platform_mass * loads_.gravity[at(i)]) * platform_.p[i];
  for (const Leg& leg : legs_) {
    const strain::RodWork& work = rod(leg).work();
    const strain::NodeLoad& tip = work.loads.back();
    sum += work.energy;
    for (int i = 0; i < 3; ++i) sum += leg.force[i] * work.frames.back().p[i];
    for (int i = 0; i < 9; ++i) sum += (tip.couple[i] - leg.tip.couple[i]) * work.frames.back().R[i];
    for (const Tendon& tendon : leg.tendons) sum += 0.5 * tendon.compliance * tendon.tension * tendon.tension;
  }
  return sum;
}

double ArmGroup::tension(int feed) const { return find(feed).second->tension; }
double ArmGroup::effort(int feed) const { return tension(feed); }
double ArmGroup::change(int feed) const {
  const auto [leg, tendon] = find(feed);
  if (tendon->command.held == TendonHeld::change) return tendon->command.value;
  const double way = rod(*leg).work().lengths[at(feed - leg->first_feed)];
  return way - tendon->rest - tendon->compliance * (tendon->tension - tendon->pretension);
}
double ArmGroup::slack(int feed) const {
  const auto [leg, tendon] = find(feed);
  if (tendon->command.held == TendonHeld::tension || tendon->is_taut) return 0;
  return std::max(0.0, tendon->free_length - rod(*leg).work().lengths[at(feed - leg->first_feed)]);
}
double ArmGroup::closing_effort(int feed) const {
  const auto [leg, tendon] = find(feed);
  return tendon->tension + (tendon->is_taut ? leg->D_inverse.row(tendon->place).dot(leg->r) : 0);
}
auto ArmGroup::effort_jacobian(int feed) const -> Twist {
  const auto [leg, tendon] = find(feed);
  if (!tendon->is_taut) return Twist::Zero();
  return (leg->D_inverse.row(tendon->place) * leg->X).transpose();
}

}  // namespace sinew::inline v1
