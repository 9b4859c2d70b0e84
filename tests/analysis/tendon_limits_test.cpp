/// Travel, limits and tolerances of tendons: against tests/data/lsk and against searching.
#include "sinew/analysis/tendon_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "serial_robots.hpp"

namespace sinew::test {
namespace tendon_limits_test {

using kernel::Backbone;
using kernel::Model;
using std::numbers::pi;

double derived(const char* key) {
  return std::stod(lsk_reference("references")["derived"][key].get<std::string>());
}

TEST(TendonLimits, SensitivityIsTheirs) {  // @verifies LSK (23)
  const Section section = nottingham().sections[0];
  EXPECT_NEAR(bend_per_length(section) * 1e-3, degrees(derived("sensitivity_deg_per_mm")), 1e-15);
  // A tendon in the plane of β₁ drawn in by 1 mm: four joints bend.
  const double joint = 1e-3 / section.map().gain;
  EXPECT_NEAR(4 * joint, bend_per_length(section) * 1e-3, 1e-15);
}

TEST(TendonTravel, OfOneAxisIsThePrintedOneAndOfAllBendsMore) {  // @verifies LSK (24)
  const SerialRobot robot = nottingham();
  EXPECT_NEAR(one_axis_travel(robot).back() * 1e3, derived("stroke_eq24_mm"), 1e-12);
  const auto travel = tendon_travel(robot, Model::linear);
  ASSERT_EQ(travel.size(), 15U);
  EXPECT_NEAR(travel[12].span() * 1e3, derived("stroke_section5_lsk_mm"), 1e-12);
  EXPECT_NEAR(travel[13].span() * 1e3, derived("stroke_section5_lsk_mm"), 1e-12);
  EXPECT_NEAR(travel[14].span() * 1e3, derived("stroke_eq24_mm"), 1e-12);  // at 360°: in one plane
  SerialRobot turned = robot;
  for (Section& section : turned.sections) section.tendon_angle = pi / 4;
  EXPECT_NEAR(tendon_travel(turned, Model::linear)[12].span() * 1e3, std::sqrt(2) * derived("stroke_eq24_mm"),
              1e-12);
}

/// Robots whose extremes lie on the rim and inside it, of both backbones.
std::vector<SerialRobot> robots() {
  std::vector<SerialRobot> all{nottingham(), nottingham(Backbone::neutral),
                               nottingham(Backbone::twin_pivot, 2, 4)};
  for (const auto backbone : {Backbone::twin_pivot, Backbone::neutral}) {
    SerialRobot slender = nottingham(backbone, 2, 3, degrees(31));
    for (Section& section : slender.sections) {
      section.joint = 20e-3;
      section.limit *= 3;
    }
    slender.sections[1].tendon_radius = 1e-3;
    slender.sections[1].segments = 4;
    all.push_back(slender);
  }
  return all;
}

TEST(TendonTravel, HoldsEveryChangeOfRandomBends) {
  std::mt19937 random(11);
  for (const SerialRobot& robot : robots())
    for (const Model model : {Model::linear, Model::exact}) {
      const auto travel = tendon_travel(robot, model);
      SerialWorkspace work(robot);
      for (int k = 0; k < 2000; ++k) {
        tendon_changes(random_bends(robot, random, 100), model, work);
        for (std::size_t i = 0; i < travel.size(); ++i) {
          EXPECT_GE(work.changes[i], travel[i].least - 1e-15);
          EXPECT_LE(work.changes[i], travel[i].most + 1e-15);
        }
      }
    }
}

/// Least and most change of one tendon by one section, by looking everywhere on a grid.
TendonTravel searched(const Section& section, int tendon_at, const Section& own, Model model) {
  const auto at = own.direction(tendon_at);
  TendonTravel found{1, -1};
  constexpr int steps = 400;
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j) {
      const double a = section.limit * i / steps, b = section.limit * j / steps;
      // of a disc by polar coordinates, about the tendon's own direction: its best bends lie in its plane
      const double turn = pi * j / steps + std::atan2(at.sine, at.cosine);
      const kernel::Bend<double> bend = section.is_twin()
                                            ? kernel::Bend<double>{a, b}
                                            : kernel::Bend<double>{a * std::cos(turn), a * std::sin(turn)};
      const auto pull = model == Model::exact ? kernel::exact_pull(section.map(), bend)
                                              : kernel::linear_pull(section.map(), bend);
      const double change = kernel::tendon_change(pull, at);
      found.least = std::min(found.least, change);
      found.most = std::max(found.most, change);
    }
  return found;
}

TEST(TendonTravel, IsWhatSearchingFinds) {
  for (const SerialRobot& robot : robots())
    for (const Model model : {Model::linear, Model::exact}) {
      const auto travel = tendon_travel(robot, model);
      const Section& second = robot.sections[1];
      TendonTravel sum;
      for (int k = 0; k < 2; ++k) {
        const TendonTravel found = searched(robot.sections[static_cast<std::size_t>(k)], 1, second, model);
        sum.least += found.least;
        sum.most += found.most;
      }
      const TendonTravel& ours = travel[static_cast<std::size_t>(robot.sections[0].tendons) + 1];
      EXPECT_NEAR(ours.least, sum.least, 1e-14) << robot.sections[0].joint;
      EXPECT_GE(ours.most, sum.most - 1e-15);
      EXPECT_NEAR(ours.most, sum.most, 2e-7) << robot.sections[0].joint;  // the grid's step, squared
    }
}

TEST(TendonTravel, WithoutLimitsEndsWhereJointsAreBentByHalfATurn) {
  SerialRobot robot = nottingham(Backbone::twin_pivot, 1);
  robot.sections[0].limit = std::numeric_limits<double>::infinity();
  robot.sections[0].tendon_angle = 0;
  // s = 2/π of both axes; a tendon in the plane of β₁ is 4 · 2 r shorter or longer
  const auto travel = tendon_travel(robot, Model::exact);
  EXPECT_NEAR(travel[0].least, 19e-3 * (2 / pi - 1) - 4 * 2 * 2.45e-3, 1e-15);
  EXPECT_NEAR(one_axis_travel(robot)[0], 2 * 4 * 2.45e-3 * pi, 1e-15);
}

// ---------------------------------------------------------------- limits of a joint

TEST(TendonLimits, RimsTouchAtTheBendOfContact) {
  Section section = nottingham().sections[0];
  const double contact = contact_bend(section);
  EXPECT_NEAR(contact, degrees(derived("theta_max_disc_collision_per_segment_deg")), 1e-15);
  // A tendon in the rim has no length left between the discs of the joints that bend.
  section.tendon_radius = section.disc_radius;
  const double change =
      kernel::tendon_change(kernel::exact_pull(section.map(), {contact, 0}), kernel::direction<double>(0));
  EXPECT_NEAR(change, -4 * section.joint, 1e-17);
  section.disc_radius = 0;
  EXPECT_TRUE(std::isinf(contact_bend(section)));
}

TEST(TendonLimits, StrainOfTheBackbone) {
  const Section twin = nottingham().sections[0], neutral = nottingham(Backbone::neutral).sections[0];
  const double diameter = 0.44e-3;
  EXPECT_NEAR(backbone_strain(twin, Bend(degrees(-24), degrees(3)), diameter), 0.0388, 5e-6);
  EXPECT_NEAR(backbone_strain(neutral, 8 * Bend(0, degrees(24)), diameter),
              backbone_strain(twin, Bend(degrees(24), 0), diameter), 1e-16);
  const double bend = bend_at_strain(twin, 0.04, diameter);
  EXPECT_NEAR(backbone_strain(twin, Bend(bend, 0), diameter), 0.04, 1e-16);
}

// ---------------------------------------------------------------- stretch and tolerance

TEST(TendonLimits, StretchCountsTheLengthOutside) {
  SerialRobot robot = nottingham();
  EXPECT_FALSE(tendon_stretch(robot, 4, 10));
  robot.stretch = TendonStretch{.stiffness = 20e3, .outside = 0.3};
  EXPECT_NEAR(tendon_length(robot, 0, 0), 0.035, 1e-16);
  EXPECT_NEAR(tendon_length(robot, 4, 0.3), 0.475, 1e-15);
  EXPECT_NEAR(tendon_stretch(robot, 4, 10).value(), 10 * 0.475 / 20e3, 1e-18);
}

TEST(TendonLimits, ToleranceAddsWhatTheRobotSays) {
  SerialRobot robot = nottingham();
  EXPECT_EQ(tolerance_parts(robot, 0, {.tension = 5, .friction = 1}).sum(), 0);
  robot.motor = TendonMotor{.lead = 1e-3, .counts = 512, .gear = 16};
  robot.stretch = TendonStretch{.stiffness = 20e3, .outside = 0.3};
  const ToleranceParts parts = tolerance_parts(robot, 4, {.tension = 5, .friction = 1});
  EXPECT_NEAR(parts.step, 1e-3 / (512 * 16), 1e-20);
  EXPECT_NEAR(parts.stretch, 5 * 0.475 / 20e3, 1e-18);
  EXPECT_NEAR(parts.friction, 1 * 0.475 / 20e3, 1e-18);
  EXPECT_EQ(parts.sum(), parts.step + parts.stretch + parts.friction);
}

}  // namespace tendon_limits_test
}  // namespace sinew::test
