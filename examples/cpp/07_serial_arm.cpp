/// A serial arm with tendons: bends to tendon lengths and tip, encoders back to bends, and bends for a
/// target.
#include <cstdio>
#include <string>
#include <vector>

#include "sinew/sinew.hpp"

int main() {
  const sinew::SerialRobot arm = sinew::load_serial("nottingham-tpcj").value();
  sinew::SerialWorkspace work(arm);
  constexpr auto exact = sinew::kernel::Model::exact;  // PCC; `linear` is LSK

  // Five sections, each bent by (β1, β2) a joint [rad]: what every tendon has to do, and where the tip is.
  const std::vector<sinew::Bend> bends = {{0.1, 0}, {0.1, 0.1}, {0, 0.2}, {0, 0}, {-0.2, 0}};
  sinew::tendon_changes(bends, exact, work);
  sinew::section_ends(bends, work);
  std::printf("section 0 pays out %.3f, %.3f, %.3f mm\n", 1e3 * work.changes[0], 1e3 * work.changes[1],
              1e3 * work.changes[2]);
  const auto& tip = work.ends.back();
  std::printf("tip at %.2f, %.2f, %.2f mm\n", 1e3 * tip.p.x(), 1e3 * tip.p.y(), 1e3 * tip.p.z());

  // From encoders: one tendon of section 1 has 0.4 mm too much. The bends that come nearest, and what is
  // wrong.
  std::vector<double> measured = work.changes;  // a copy: the workspace is used again
  measured[3] += 0.4e-3;
  const sinew::Report read = sinew::bends_of_changes(arm, measured, exact, work);
  std::printf("%s: tendon 0 of section 1 has %.3f mm too much\n",
              std::string(sinew::to_string(read.status)).c_str(), 1e3 * work.slack[3]);
  std::printf("section 1 bends by %.4f, %.4f rad\n", work.bends[1].x(), work.bends[1].y());

  // A target for the tip and its axis, within the limits of all sections.
  const sinew::TipTarget target{.position = {0.04, 0.02, 0.15}, .direction = sinew::Vec3<double>(0, 0, 1)};
  const auto found = sinew::inverse(arm, target, {}, work);
  if (!found.ok()) return std::puts(sinew::to_string(found.report).c_str()), 3;
  for (std::size_t m = 0; m < found.bends.size(); ++m)
    std::printf("section %zu: %7.4f, %7.4f rad\n", m, found.bends[m].x(), found.bends[m].y());
  std::printf("tip off by %.3f um, %.3f mrad\n", 1e6 * found.position_error, 1e3 * found.angle_error);
}

// Prints:
//   section 0 pays out -0.899, 0.789, 0.098 mm
//   tip at 55.87, 96.40, 98.17 mm
//   slack: tendon 0 of section 1 has 0.131 mm too much
//   section 1 bends by 0.0818, 0.0798 rad
//   section 0: -0.0884, -0.0334 rad
//   section 1:  0.2775,  0.1393 rad
//   section 2:  0.0450,  0.0179 rad
//   section 3: -0.2432, -0.1324 rad
//   section 4:  0.0173, -0.0036 rad
//   tip off by 0.000 um, 0.000 mrad
