/// The coordinates of a group: strains of its rods, the unknown forces and the pose of the platform; where
/// they begin, and how they are taken over, saved and restored.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/rod_frames.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1 {
namespace {

/// Parts of a leg by whose curvatures a shape is taken over where polynomials do not [1]: as many as a
/// section has elements at the finest.
constexpr int parts_taken_over = 64;

/// Shapes that polynomials do not tell one another: joints in other places.
bool has_other_joints(const strain::RodModel& a, const strain::RodModel& b) {
  return a.pieces.size() != b.pieces.size() &&
         std::ranges::any_of(b.elements, [](const strain::Element& element) {
           return element.points == 1 && !element.is_pivot;
         });
}

}  // namespace

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

void ArmGroup::carry_over_from(const ArmGroup& other) {
  platform_ = other.platform_;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& from = other.legs_[k];
    Leg& leg = legs_[k];
    if (has_other_joints(rod(from).model(), rod(leg).model()))
      take_curvatures(arm_curvatures(from.own->arm, parts_taken_over, from.work), rod(leg).model(),
                      rod(leg).work().y);
    else
      carry_over(rod(from).model(), rod(from).work(), rod(leg).model(), rod(leg).work().y);
    for (std::size_t i = 0; i < leg.pivots().size(); ++i)
      rod(leg).work().y[at(leg.pivots()[i])] = rod(from).work().y[at(from.pivots()[i])];
    leg.force = from.force;
    leg.moment = from.moment;
    for (std::size_t i = 0; i < leg.tendons.size(); ++i) leg.tendons[i].tension = from.tendons[i].tension;
  }
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

}  // namespace sinew::inline v1
