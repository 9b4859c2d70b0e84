/// The legs of a group as they are made, and the problem that is set: commands of tendons, loads, and what
/// share of both acts.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "strain/rod_frames.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1 {
namespace {

/// The least radius of a platform over a leg [1]: by it moments count, of a platform with all tips in its
/// reference point, too.
constexpr double least_platform_radius = 0.01;
/// A tip that is nearer to the platform than this share of the bar between [1] gives it no direction.
constexpr double no_way = 1e-9;

}  // namespace

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
    radius_ = std::max(radius_, least_platform_radius * own.arm.length());
  }
  set_share(0);
}

/// At rest.
void ArmGroup::stand(Leg& leg, const ArmBasis& basis, const std::vector<double>& breaks) {
  ArmWorkspace::Impl& impl = leg.work.impl();
  impl.levels.clear();
  impl.levels.push_back(std::make_unique<ArmRod>(make_rod(leg.own->arm, basis, breaks)));
  impl.level = 0;
  const Mat<double, 3, 3> turn = leg.own->base.R.matrix();
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
  return way.norm() > no_way * leg.own->strut ? std::atan2(way.x(), way.z()) : 0;
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
  const std::vector<ArmLoad> loads = loads_of_legs(loads_, share, legs_.size());
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    Leg& leg = legs_[k];
    const ArmLoad& load = loads[k];
    set_loads(leg.own->arm, load, rod(leg).model(), rod(leg).work().loads);
    leg.tip = rod(leg).work().loads.back();
    leg.has_potential = load_has_potential(load, robot_->is_planar);
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

const LimbTraits& ArmGroup::traits() const {
  static constexpr LimbTraits traits{.tolerance = 1e-10, .rounding = 1e-13};
  return traits;
}

double ArmGroup::length(int limb) const { return legs_[at(limb)].own->arm.length(); }
double ArmGroup::stiffness(int limb) const {
  return rod(legs_[at(limb)]).model().energy_scale * length(limb);
}

}  // namespace sinew::inline v1
