/// Serial robots for tests, and the references of tests/data/lsk as such.
#pragma once
#include <numbers>
#include <random>

#include "reference_file.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::test {

inline const nlohmann::json& lsk_reference(const std::string& name) {
  return reference_file("data/lsk/" + name + ".json");
}

inline double degrees(double angle) { return angle * std::numbers::pi / 180; }

/// [LSK] Table 2 with so many sections and tendons; the tendons of section m are turned by m·angle.
inline SerialRobot nottingham(kernel::Backbone backbone = kernel::Backbone::twin_pivot, int sections = 5,
                              int tendons = 3, double angle = degrees(24)) {
  SerialRobot robot;
  robot.name = "nottingham";
  for (int m = 1; m <= sections; ++m) {
    Section section;
    section.backbone = backbone;
    section.segments = 8;
    section.joint = 2.375e-3;
    section.disc_height = 2e-3;
    section.disc_radius = 3e-3;
    section.tendons = tendons;
    section.tendon_radius = 2.45e-3;
    section.tendon_angle = m * angle;
    section.limit = section.is_twin() ? degrees(24) : 8 * degrees(24);
    robot.sections.push_back(section);
  }
  return robot;
}

/// The robot of a case of references.json; no limits.
template <class Json>
SerialRobot reference_robot(const Json& c) {
  const auto number = [](const Json& text) { return std::stod(text.template get<std::string>()); };
  SerialRobot robot = nottingham(c["kind"] == "tp" ? kernel::Backbone::twin_pivot : kernel::Backbone::neutral,
                                 c["M"].template get<int>(), c["n_cables"].template get<int>());
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    Section& section = robot.sections[m];
    section.segments = c["N"].template get<int>();
    section.joint = number(c["L_mm"]) * 1e-3;
    section.disc_height = number(c["h_mm"]) * 1e-3;
    section.tendon_radius = number(c["r_c_mm"]) * 1e-3;
    section.tendon_angle = degrees(number(c["delta_m_deg"][m]));
    section.limit = std::numeric_limits<double>::infinity();
  }
  return robot;
}

/// Bends of a list of [β₁, β₂] or [θ, φ] as texts.
template <class Json>
std::vector<Bend> reference_bends(const Json& c, const char* key) {
  std::vector<Bend> bends;
  for (const auto& pair : c[key]) {
    const double a = std::stod(pair[0].template get<std::string>()),
                 b = std::stod(pair[1].template get<std::string>());
    bends.push_back(c["kind"] == "tp" ? Bend(a, b) : Bend(a * std::cos(b), a * std::sin(b)));
  }
  return bends;
}

/// Bends within the limits of a robot; of one without, up to `most` a section.
inline std::vector<Bend> random_bends(const SerialRobot& robot, std::mt19937& random, double most = 2.5) {
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Bend> bends;
  for (const Section& section : robot.sections) {
    const double limit = std::min(section.limit, most);
    Bend bend(share(random), share(random));
    while (!section.is_twin() && bend.norm() > 1) bend = Bend(share(random), share(random));
    bends.push_back(limit * bend);
  }
  return bends;
}

}  // namespace sinew::test
