#include "sinew/robot/serial_workspace.hpp"

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

}  // namespace sinew::inline v1
