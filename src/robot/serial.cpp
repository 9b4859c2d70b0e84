#include "sinew/robot/serial.hpp"

#include "robot/arms/section_motion.hpp"

namespace sinew::inline v1 {

SerialWorkspace::SerialWorkspace(const SerialRobot& any)
    : robot(any.identity),
      bends(any.sections.size(), Bend::Zero()),
      changes(static_cast<std::size_t>(any.tendon_count())),
      slack(changes.size()),
      ends(bends.size()),
      J(12 * bends.size()),
      K(changes.size() * 2 * bends.size()),
      extensions(bends.size()),
      bend_rates(2 * bends.size()),
      extension_rates(bends.size()),
      tendon_rates(changes.size()),
      extension_jacobians(bends.size()),
      sections(any.sections) {
  for (const Section& section : any.sections) {
    maps.push_back(section.map());
    tendons.push_back(section.tendons);
    for (int i = 0; i < section.tendons; ++i) directions.push_back(section.direction(i));
  }
}

SE3<double> Section::pose(const Bend& bend) const { return section_pose(*this, bend).rigid(); }

Vec3<double> Section::extension_motion(const Bend& bend) const {
  Section chords = *this;  // the end is linear in the length of the joints
  chords.joint = 1.0 / segments;
  chords.disc_height = 0;
  return chords.pose(bend).p;
}

}  // namespace sinew::inline v1
