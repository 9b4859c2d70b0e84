/// Sections of variable length: the third coordinate against a robot built as long, against differences, and
/// there and back.
#include <gtest/gtest.h>

#include "reference_file.hpp"
#include "serial_robots.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/analysis/tendon_limits.hpp"
#include "sinew/kernel/fixed.h"
#include "sinew/kernel/serial.h"
#include "sinew/kinematics/serial.hpp"

namespace sinew::test {
namespace extension_test {

using kernel::Backbone;
using kernel::Model;

constexpr double mm = 1e-3;

/// Five sections, of which the second and the fourth vary their length: an odd number, mixed.
SerialRobot growing(int tendons = 3) {
  SerialRobot robot = nottingham(Backbone::neutral, 5, tendons, degrees(18));
  for (const std::size_t m : {1U, 3U}) {
    robot.sections[m].min_extension = -5 * mm;
    robot.sections[m].max_extension = 15 * mm;
  }
  return robot;
}

class Extension : public testing::TestWithParam<int> {
 protected:
  SerialRobot robot = growing(GetParam());
  SerialWorkspace work{robot};
  std::mt19937 random{11};
  std::vector<Bend> bends;
  std::vector<double> extensions;

  void any_shape(double share = 1) {
    bends = random_bends(robot, random);
    extensions.clear();
    for (const Section& section : robot.sections)
      extensions.push_back(std::uniform_real_distribution<double>(
          share * section.min_extension, share * section.max_extension + 1e-300)(random));
    set_extensions(robot, extensions, work);
  }
};

TEST_P(Extension, IsARobotBuiltAsLong) {
  for (int k = 0; k < 20; ++k) {
    any_shape();
    const SerialRobot built = robot.extended(extensions);
    SerialWorkspace other(built);
    tip_motion(bends, work);
    tip_motion(bends, other);
    EXPECT_EQ(work.J, other.J);
    EXPECT_EQ(work.ends.back().p, other.ends.back().p);
    for (const Model model : {Model::exact, Model::linear}) {
      tendon_changes(bends, model, work);
      tendon_changes(bends, model, other);
      std::size_t i = 0;
      double longer = 0;
      for (std::size_t m = 0; m < bends.size(); ++m) {
        longer += extensions[m];
        for (int n = 0; n < robot.sections[m].tendons; ++n, ++i)
          EXPECT_NEAR(work.changes[i], other.changes[i] + longer, 1e-16);
      }
      tendon_rates(bends, model, work);
      tendon_rates(bends, model, other);
      EXPECT_EQ(work.K, other.K);
    }
  }
}

/// Drawn from hole to hole, whatever formula gave the changes.
TEST_P(Extension, TendonsHaveTheLengthsOfTheDrawnOnes) {
  for (int k = 0; k < 20; ++k) {
    any_shape();
    const SerialShape shape = serial_shape(robot.extended(extensions), bends, 2);
    tendon_changes(bends, Model::exact, work);
    std::size_t tendon = 0;
    double straight = 0;
    for (std::size_t m = 0; m < bends.size(); ++m) {
      straight += robot.sections[m].arc_length();
      for (const auto& line : shape.tendons[m]) {
        double spans = 0;
        for (std::size_t i = 0; i + 1 < line.size(); i += 2) spans += (line[i + 1] - line[i]).norm();
        EXPECT_NEAR(spans - straight, work.changes[tendon++], 1e-15);
      }
    }
  }
}

TEST_P(Extension, IsWhatTendonsHaveInCommon) {  // there and back, through straight sections
  for (int k = 0; k < 200; ++k) {
    any_shape();
    bends[static_cast<std::size_t>(k % 5)].setZero();
    if (k % 4 == 0) bends[3] *= 1e-9;
    for (const Model model : {Model::exact, Model::linear}) {
      set_extensions(robot, extensions, work);
      tendon_changes(bends, model, work);
      const std::vector<double> changes = work.changes;
      set_extensions(robot, std::vector<double>(5, 0.0), work);
      const Report report = bends_of_changes(robot, changes, model, work);
      ASSERT_TRUE(report.ok()) << to_string(report);
      for (std::size_t m = 0; m < bends.size(); ++m) {
        EXPECT_LT((work.bends[m] - bends[m]).norm(), 1e-12);
        EXPECT_NEAR(work.extensions[m], extensions[m], 1e-15);
      }
      for (const double slack : work.slack) EXPECT_LT(std::abs(slack), 1e-15);
    }
  }
}

TEST_P(Extension, SlackOfAFixedSectionIsNotTakenForLength) {
  any_shape(0.5);
  tendon_changes(bends, Model::exact, work);
  const std::array more{0.0, 0.0, 1 * mm, 0.0, 0.0};
  add_slack(more, work);
  const std::vector<double> changes = work.changes;
  const Report report = bends_of_changes(robot, changes, Model::exact, work);
  EXPECT_EQ(report.status, Status::slack);
  EXPECT_TRUE(report.message.view().starts_with("sections[2]")) << report.message.view();
  for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_NEAR(work.extensions[m], extensions[m], 1e-15);
}

TEST_P(Extension, BatchesHaveTheLengthsOfTheWorkspace) {
  any_shape();
  constexpr std::size_t poses = 13;
  std::vector<double> rows(10 * poses), changes(work.changes.size() * poses);
  for (double& x : rows) x = std::uniform_real_distribution<double>(-1, 1)(random);
  for (const Model model : {Model::exact, Model::linear}) {
    tendon_changes_batch(rows, model, changes, work);
    for (std::size_t k = 0; k < poses; ++k) {
      for (std::size_t m = 0; m < 5; ++m) bends[m] = {rows[2 * m * poses + k], rows[(2 * m + 1) * poses + k]};
      tendon_changes(bends, model, work);
      for (std::size_t i = 0; i < work.changes.size(); ++i)
        EXPECT_NEAR(changes[i * poses + k], work.changes[i], 1e-16);
    }
  }
}

TEST_P(Extension, MovesTipAndTendonsAsDifferencesSay) {
  for (int k = 0; k < 20; ++k) {
    any_shape();
    if (k % 5 == 0) bends[3].setZero();
    for (const Model model : {Model::exact, Model::linear})
      for (const std::size_t m : {0U, 1U, 3U, 4U}) {  // also of sections whose length is fixed
        const double step = 1e-3;                     // all is linear in the extension
        const auto at = [&](double change) {
          std::vector<double> moved = extensions;
          moved[m] += change;
          set_extensions(robot, moved, work);
          section_ends(bends, work);
          tendon_changes(bends, model, work);
          return std::pair(work.ends.back(), work.changes);
        };
        const auto ahead = at(step), behind = at(-step);
        set_extensions(robot, extensions, work);
        tip_motion(bends, work);
        extension_motion(bends, model, work);
        EXPECT_LT(((ahead.first.p - behind.first.p) / (2 * step) - work.extension_jacobians[m].tip).norm(),
                  1e-12);
        EXPECT_LT(ahead.first.R.compose(behind.first.R.inverse()).log().norm(), 1e-15);
        std::size_t i = 0;
        for (std::size_t j = 0; j < bends.size(); ++j)
          for (int n = 0; n < robot.sections[j].tendons; ++n, ++i)
            EXPECT_NEAR((ahead.second[i] - behind.second[i]) / (2 * step),
                        j < m ? 0 : work.extension_jacobians[m].tendons, 1e-12);
      }
  }
}

TEST_P(Extension, LimitsAreNamed) {
  any_shape();
  EXPECT_TRUE(check_limits(robot, bends, extensions).ok());
  extensions[3] = 15.01 * mm;
  Report report = check_limits(robot, bends, extensions);
  EXPECT_EQ(report.status, Status::left_domain);
  EXPECT_EQ(report.message.view(), "sections[3] is 15.01 mm longer than at rest, its limit is 15 mm");
  extensions[1] = -6 * mm;
  report = check_limits(robot, bends, extensions);
  EXPECT_EQ(report.message.view(), "sections[1] is 6 mm shorter than at rest, its limit is 5 mm");
  // Tendons that ask for more than the limits are slack, or too short; no section gets shorter than it can.
  for (auto& bend : bends) bend.setZero();
  for (const double asked : {-6 * mm, 18 * mm}) {
    set_extensions(robot, std::array{0.0, asked, 0.0, 0.0, 0.0}, work);
    tendon_changes(bends, Model::exact, work);
    const std::vector<double> changes = work.changes;
    report = bends_of_changes(robot, changes, Model::exact, work);
    EXPECT_EQ(report.status, asked < 0 ? Status::unreachable : Status::slack) << to_string(report);
    EXPECT_TRUE(report.message.view().starts_with("sections[1]")) << report.message.view();
    EXPECT_EQ(work.extensions[1], asked < 0 ? -5 * mm : 15 * mm);
    EXPECT_NEAR(work.slack[std::size_t(GetParam())], asked < 0 ? -1 * mm : 3 * mm, 1e-15);
  }
}

TEST_P(Extension, InverseUsesIt) {
  int converged = 0;
  constexpr int targets = 300;
  for (int k = 0; k < targets; ++k) {
    any_shape();
    section_ends(bends, work);
    const SE3<double> tip = work.ends.back();
    TipTarget target{.position = tip.p};
    if (k % 3 == 1) target.direction = tip.rotate(Vec3<double>(0, 0, 1));
    if (k % 3 == 2) target.rotation = tip.R;
    const SerialInverse answer = inverse(robot, target, {}, work);
    converged += answer.ok();
    EXPECT_TRUE(check_limits(robot, answer.bends, answer.extensions).ok());
    const SerialRobot built = robot.extended(answer.extensions);
    SerialWorkspace other(built);
    section_ends(answer.bends, other);
    EXPECT_NEAR((other.ends.back().p - tip.p).norm(), answer.position_error, 1e-14);
  }
  EXPECT_EQ(converged, targets);
}

TEST_P(Extension, ReachesBeyondTheLengthAtRest) {
  const Vec3<double> beyond(0, 0, robot.length() + 20 * mm);
  SerialInverse answer = inverse(robot, {.position = beyond}, {}, work);
  ASSERT_TRUE(answer.ok()) << to_string(answer.report);
  EXPECT_GT(answer.extensions[1] + answer.extensions[3], 20 * mm - 1e-12);
  answer = inverse(robot, {.position = Vec3<double>(0, 0, robot.length() + 31 * mm)}, {}, work);
  EXPECT_EQ(answer.report.status, Status::unreachable);
  EXPECT_NE(answer.report.message.view().find("1 mm beyond"), std::string_view::npos)
      << answer.report.message.view();
}

TEST_P(Extension, MayBeAsLongAsARodThatSlidesIn) {
  SerialRobot slides = robot;
  slides.sections[1].max_extension = 1e6;
  SerialWorkspace other(slides);
  const SerialInverse answer = inverse(slides, {.position = Vec3<double>(0.1, 0.2, 3)}, {}, other);
  ASSERT_TRUE(answer.ok()) << to_string(answer.report);
  EXPECT_LT(answer.report.iterations, 30);
}

TEST_P(Extension, RatesUseItAndStopAtItsLimits) {
  std::vector<Bend> straight(5, Bend::Zero());
  const TipTwist along{.linear = Vec3<double>(0, 0, 0.01)};
  set_extensions(robot, std::array{0.0, 5 * mm, 0.0, 0.0, 0.0}, work);
  ResolvedRate answer = resolved_rate(robot, straight, along, {.task = TipTask::position}, work);
  ASSERT_TRUE(answer.ok()) << to_string(answer.report);
  EXPECT_NEAR(answer.extensions[1] + answer.extensions[3], 0.01, 1e-8);
  for (const double tendon : answer.tendons.last(3)) EXPECT_NEAR(tendon, 0.01, 1e-8);
  set_extensions(robot, std::array{0.0, 15 * mm, 0.0, 15 * mm, 0.0}, work);
  answer = resolved_rate(robot, straight, along, {.task = TipTask::position}, work);
  EXPECT_EQ(answer.report.status, Status::left_domain);
  EXPECT_EQ(answer.held, 2);

  any_shape(0.5);
  const std::vector<Bend> from = bends;
  const std::vector<double> at_first = extensions;
  const TipTwist wanted{Vec3<double>(0.004, -0.003, 0.002), Vec3<double>(0.1, 0.2, -0.1)};
  answer = resolved_rate(robot, bends, wanted, {}, work);
  ASSERT_TRUE(answer.ok()) << to_string(answer.report);
  const auto after = [&](double time) {
    for (std::size_t m = 0; m < 5; ++m) {
      bends[m] = from[m] + time * Bend(answer.bends[2 * m], answer.bends[2 * m + 1]);
      extensions[m] = at_first[m] + time * answer.extensions[m];
    }
    set_extensions(robot, extensions, work);
    section_ends(bends, work);
    tendon_changes(bends, Model::exact, work);
    return std::pair(work.ends.back(), work.changes);
  };
  const double time = 1e-5;
  const auto ahead = after(time), behind = after(-time);
  EXPECT_LT(((ahead.first.p - behind.first.p) / (2 * time) - wanted.linear).norm(), 1e-8);
  EXPECT_LT((ahead.first.R.compose(behind.first.R.inverse()).log() / (2 * time) - wanted.angular).norm(),
            1e-6);
  for (std::size_t i = 0; i < answer.tendons.size(); ++i)
    EXPECT_NEAR(answer.tendons[i], (ahead.second[i] - behind.second[i]) / (2 * time), 1e-10);
}

TEST_P(Extension, TravelCoversEveryLength) {
  for (const Model model : {Model::exact, Model::linear}) {
    const auto travel = tendon_travel(robot, model);
    std::vector<double> least(work.changes.size(), 0), most(least);
    for (int k = 0; k < 2000; ++k) {
      any_shape();
      tendon_changes(bends, model, work);
      for (std::size_t i = 0; i < most.size(); ++i) {
        EXPECT_LE(work.changes[i], travel[i].most + 1e-15);
        EXPECT_GE(work.changes[i], travel[i].least - 1e-15);
      }
    }
    // the first section is at most drawn in by its bend, the second pays out its length as well
    EXPECT_GT(travel.back().most, tendon_travel(nottingham(Backbone::neutral), model).back().most + 20 * mm);
  }
}

INSTANTIATE_TEST_SUITE_P(Tendons, Extension, testing::Values(3, 4));

TEST(KernelExtension, RunsInFixedPointOfTwoFormats) {
  using Angle = kernel::Fixed<32, 27>;
  using Length = kernel::Fixed<32, 20>;
  constexpr auto robot = kernel::make_serial<2, 3, Angle, Length>(Backbone::neutral, 8, 2.375, 2.45, 0.4);
  const kernel::Bend<Angle> bends[2] = {{Angle(0.3), Angle(-0.2)}, {Angle(0.0), Angle(0.0)}};
  const Length extensions[2] = {Length(1.5), Length(-0.5)};
  Length changes[2][3], found[2];
  kernel::Bend<Angle> back[2];
  robot.changes<Model::exact>(bends, extensions, changes);
  robot.bends<Model::exact>(changes, back, found);
  for (int m = 0; m < 2; ++m) {
    EXPECT_NEAR(static_cast<double>(back[m].x), static_cast<double>(bends[m].x), 1e-5);
    EXPECT_NEAR(static_cast<double>(found[m]), static_cast<double>(extensions[m]), 2e-5);
  }
}

TEST(KernelExtension, RunsThereAndBackOnAController) {
  constexpr auto robot = kernel::make_serial<2, 3, float>(Backbone::neutral, 8, 2.375, 2.45, 0.4f);
  const kernel::Bend<float> bends[2] = {{0.3f, -0.2f}, {0, 0}};
  const float extensions[2] = {1.5f, -0.5f};
  float changes[2][3], found[2];
  kernel::Bend<float> back[2];
  robot.changes<Model::exact>(bends, extensions, changes);
  robot.bends<Model::exact>(changes, back, found);
  for (int m = 0; m < 2; ++m) {
    EXPECT_NEAR(back[m].x, bends[m].x, 1e-6);
    EXPECT_NEAR(back[m].y, bends[m].y, 1e-6);
    EXPECT_NEAR(found[m], extensions[m], 1e-5);
  }
}

}  // namespace extension_test
}  // namespace sinew::test
