/// Tendons of the legs: which are taut, and their tensions, changes of length and slack.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/at.hpp"
#include "solve/contraction.hpp"

namespace sinew::inline v1 {

/// Of the length's error of a tendon by its tension: what an arm yields to it, roughly [m/N].
double ArmGroup::yields(const Arm& arm, const ArmTendon& tendon) {
  double sum = 0;
  for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
    const ArmSection& section = arm.sections[m];
    const double r = tendon.routes[m].start_radius;
    sum += r * r * section.length / std::min(section.start.bending_x, section.start.bending_y);
  }
  return sum;
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

/// Which tendons are taut, the numbers of their unknowns, and what they pull with at holes and guides, after
/// the rod's sweep. A tendon of prescribed length pulls where it is shorter than its way, or would be without
/// its tension.
/// @returns the largest error of a taut one's length, over the leg's
double ArmGroup::measure_tendons(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
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
      error = worse(error, std::abs(missing) / size);
    else
      tendon.tension = 0;
  }
  const auto tension = [&](int index) { return leg.tendons[at(index)].tension; };
  for (std::size_t i = 0; i < model.holes.size(); ++i) work.hole_tension[i] = tension(model.holes[i].tendon);
  for (std::size_t i = 0; i < model.guides.size(); ++i)
    work.guide_tension[i] = tension(model.guides[i].tendon);
  return error;
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

}  // namespace sinew::inline v1
