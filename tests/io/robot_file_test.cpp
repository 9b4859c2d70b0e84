#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

#include <gtest/gtest.h>

#include "cpu_time.hpp"
#include "every_robot.hpp"
#include "io/document/parse.hpp"
#include "io/robots/serial_file.hpp"
#include "paths.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::test {
namespace robot_file_test {

Expected<Robot> read(const std::string& yaml) { return read_robot(parse_yaml(yaml, "robot.yaml").value()); }

const std::string head = "sinew: 1\nname: test\n";
const std::string rfr_parts =
    "defaults:\n  link: {type: arc, length: 200 mm, tendon_offset: 5 mm}\n  closure: {type: chord}\n";
const std::string rfr_legs =
    "legs:\n"
    "  - {base: {point: {radius: 190 mm, angle: 90 deg}}, platform_point: {radius: 50 mm, angle: 30 deg}}\n"
    "  - {base: {point: {radius: 190 mm, angle: 210 deg}}, platform_point: {radius: 50 mm, angle: 150 deg}}\n"
    "  - {base: {point: {radius: 190 mm, angle: 330 deg}}, platform_point: {radius: 50 mm, angle: 270 "
    "deg}}\n";

void expect_same_motion(const Robot& a, const Robot& b) {
  Workspace wa(a), wb(b);
  const PlanarPose pose{0.01, -0.008, 0.2};
  ASSERT_TRUE(inverse(a, pose, {}, wa).ok());
  ASSERT_TRUE(inverse(b, pose, {}, wb).ok());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(wa.inputs[i], wb.inputs[i], 1e-15);
}

TEST(RobotFile, ListsLegsOrNamesAnArchitectureOrIsBuiltInCodeAllTheSame) {
  const auto listed = read(head + rfr_parts + rfr_legs);
  const auto named = read(head +
                          "architecture: 3-RFR\nbase: {radius: 190 mm, angle: 90 deg}\n"
                          "platform: {radius: 50 mm, angle: 30 deg}\n"
                          "defaults: {link: {length: 200 mm, tendon_offset: 5 mm}}\n");
  ASSERT_TRUE(listed) << to_string(listed.error());
  ASSERT_TRUE(named) << to_string(named.error());
  expect_same_motion(*listed, *named);
  expect_same_motion(*listed, rfr_in_code());
  expect_same_motion(*listed, load("3-rfr").value());
  expect_same_motion(*listed, load(std::string(source_folder) + "/robots/3-rfr.yaml").value());
  EXPECT_EQ(legs_of<RfrLeg>(*named).legs.size(), 3U);
}

TEST(RobotFile, FrrAsAnArchitectureIsTheListedOne) {
  const auto named =
      read(head +
           "architecture: 3-FRR\nbase: {radius: 190 mm, angle: 90 deg, direction: 320 deg}\n"
           "platform: {radius: 50 mm, angle: 30 deg}\n"
           "defaults: {link: {length: 200 mm, tendon_offset: 5 mm}, closure: {length: 100 mm}}\n");
  ASSERT_TRUE(named) << to_string(named.error());
  expect_same_motion(*named, load("3-frr").value());
}

/// Legs, home and size of two robots, which must be of one kind.
void expect_same_robot(const Robot& a, const Robot& b) {
  EXPECT_LT(motion(home(a), home(b)).norm(), 1e-15);
  const auto expect_same_legs = [](const auto& leg, const auto& other) {
    EXPECT_LT((leg.base.p - other.base.p).norm(), 1e-15);
    for (int k = 0; k < leg.base.p.size(); ++k) {
      using Point = typename std::decay_t<decltype(leg)>::Point;
      const Point axis = Point::Unit(k);
      const Point here = leg.base.rotate(axis), there = other.base.rotate(axis);
      // the axis of a hinge may point either way
      EXPECT_LT(
          leg.has_plane ? std::min((here - there).norm(), (here + there).norm()) : (here - there).norm(),
          1e-14);
    }
    EXPECT_LT((leg.platform_point - other.platform_point).norm(), 1e-15);
    EXPECT_EQ(leg.link.size(), other.link.size());
    if constexpr (requires { leg.drive.tendon_offset(); }) {
      EXPECT_EQ(leg.drive.tendon_offset(), other.drive.tendon_offset());
    }
    if constexpr (requires { leg.closure.length; }) {
      EXPECT_EQ(leg.closure.length, other.closure.length);
    }
    EXPECT_EQ(leg.backbone.diameter, other.backbone.diameter);
    EXPECT_EQ(leg.backbone.joints, other.backbone.joints);
    EXPECT_EQ(leg.backbone.youngs_modulus, other.backbone.youngs_modulus);
  };
  ASSERT_EQ(leg_count(a), leg_count(b));
  EXPECT_EQ(platform_radius(a), platform_radius(b));
  with_legs(a, [&]<class LegT>(const ParallelRobot<LegT>& robot) {
    robot.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace&, int i) {
      const auto others = legs_of<L>(b).legs;
      ASSERT_EQ(others.size(), robot.legs.size());
      expect_same_legs(leg, others[static_cast<std::size_t>(i)]);
    });
  });
}

TEST(RobotFile, AShortFormIsTheListedRobot) {
  for (const char* name : {"3-rfr", "3-frr", "3-rfrr", "6-ufs", "3prs"}) {
    SCOPED_TRACE(name);
    const Document short_form = parse_yaml(robot_template(name), name).value();
    const auto longer = expanded(short_form);
    ASSERT_TRUE(longer) << to_string(longer.error());
    EXPECT_NE(short_form.root.find("architecture"), nullptr);
    for (const char* gone : {"architecture", "base"}) EXPECT_EQ(longer->root.find(gone), nullptr);
    const Document listed = read_robot_file(name).value();
    EXPECT_EQ(longer->root.find("space")->text, listed.root.find("space")->text);
    const auto robot = read_robot(*longer);
    ASSERT_TRUE(robot) << to_string(robot.error());
    expect_same_robot(*robot, read_robot(listed).value());
  }
}

TEST(RobotFile, PointsAndListedAnglesStandForACircle) {
  const std::string link =
      "defaults: {link: {length: 200 mm, tendon_offset: 5 mm}, closure: {length: 100 mm}}\n";
  const std::string platform = "platform: {radius: 50 mm, angle: 30 deg}\n";
  const std::string frr = head + "architecture: 3-FRR\n" + link;
  const auto circle = read(frr + platform + "base: {radius: 190 mm, angle: 90 deg, direction: 320 deg}\n");
  ASSERT_TRUE(circle) << to_string(circle.error());
  for (const char* base :
       {"base: {radius: 190 mm, angles: [90 deg, 210 deg, 330 deg], directions: [320 deg, 80 deg, 200 "
        "deg]}\n",
        "base: {points: [[0, 190 mm], {radius: 190 mm, angle: 210 deg}, {radius: 190 mm, angle: 330 deg}], "
        "direction: 320 deg}\n"}) {
    const auto robot = read(frr + platform + base);
    ASSERT_TRUE(robot) << to_string(robot.error());
    expect_same_robot(*circle, *robot);
  }
}

TEST(RobotFile, AShortFormNamesWhatIsMissingOrTooMuch) {
  const std::string link = "defaults: {link: {length: 200 mm, tendon_offset: 5 mm}}\n";
  const std::string base = "base: {radius: 190 mm, angle: 90 deg}\n",
                    platform = "platform: {radius: 50 mm, angle: 30 deg}\n";
  const auto says = [&](const std::string& rest, std::string_view message) {
    const auto robot = read(head + link + rest);
    ASSERT_FALSE(robot) << message;
    EXPECT_EQ(robot.error()[0].message, message);
  };
  const std::string rfr = "architecture: 3-RFR\n", ufs = "architecture: 6-UFS\n";
  says(rfr + base + "platform: {points: [[50 mm, 0], [0, 50 mm]]}\n",
       "platform.points: 3-RFR needs 3 platform points, found 2; give one for each leg.");
  says(ufs + "base: {radius: 1, angles: [0, 1, 2]}\n" + platform,
       "base.angles: 6-UFS needs 6 base angles, found 3; give one for each leg.");
  says(rfr + base + platform + rfr_legs + "  - {}\n",
       "legs: the file gives an architecture and legs; keep one. A 3-RFR has 3 legs, these are 4.");
  says(rfr + base + platform + rfr_legs, "legs: the file gives an architecture and legs; keep one.");
  says(rfr + base + platform + "space: spatial\n",
       "space = spatial; a 3-RFR is planar; remove space, or choose another architecture.");
  says(rfr + platform + "base: {radius: 190 mm, angle: 90 deg, direction: 0}\n",
       "base: direction has no effect: the legs of a 3-RFR turn at their base; remove it");
  says(rfr + platform + "base: {points: [[0, 1], [1, 0], [1, 1]], angle: 0}\n",
       "base: gives both points and angle; keep one");
}

TEST(RobotFile, ATemplateIsReachedRegularlyAtHomeAndBack) {
  for (const std::string_view name : robot_template_names()) {
    SCOPED_TRACE(name);
    const std::string text(robot_template(name));
    if (text.find("kind: serial") != text.npos) continue;  // those are read in serial_file_test.cpp
    const auto robot = read(text);
    ASSERT_TRUE(robot) << to_string(robot.error());
    Workspace work(*robot);
    const AnyPose at_home = home(*robot);
    if (bears_load(*robot)) {
      const auto& pose = std::get<SpatialPose>(at_home);
      const Equilibrium there = input_count(*robot) == 3
                                    ? inverse_equilibrium(*robot, {pose.position[2], 0, 0}, {}, work)
                                    : inverse_equilibrium(*robot, pose, {}, work);
      EXPECT_TRUE(there.report.ok()) << to_string(there.report);
      continue;
    }
    const Inverse there = inverse(*robot, at_home, {}, work);
    ASSERT_TRUE(there.ok()) << to_string(there.report);
    const auto inputs = values(there.inputs), coordinates = values(there.coordinates);
    const Velocity moving = velocity(*robot, at_home, coordinates, work);
    EXPECT_TRUE(moving.report.ok()) << to_string(moving.report);
    EXPECT_LT(moving.indices.condition_homogenised, 20);
    std::mt19937 random(1);
    const ForwardOptions from_beside{.start = pose_near_home(*robot, random, 0.005, 0.05)};
    const Forward back = forward(*robot, inputs, from_beside, work);
    ASSERT_TRUE(back.ok()) << to_string(back.report);
    EXPECT_LT(motion(back.pose, at_home).norm(), 1e-10);
  }
  EXPECT_TRUE(robot_template("no-legged").empty());
}

TEST(RobotFile, TwoChordsAreARobotThatMovesWithItsInputsHeld) {
  const auto robot = read(head + rfr_parts +
                          "legs:\n"
                          "  - {base: {point: [-120 mm, -120 mm]}, platform_point: [-40 mm, 0]}\n"
                          "  - {base: {point: [120 mm, -120 mm]}, platform_point: [40 mm, 0]}\n");
  ASSERT_TRUE(robot) << to_string(robot.error());
  EXPECT_EQ(input_count(*robot), 2);
  Workspace work(*robot);
  EXPECT_TRUE(inverse(*robot, PlanarPose{}, {}, work).ok());
}

TEST(RobotFile, LegsFromOnePointSayThatTheyShareIt) {
  const auto legs = [](const char* shared) {
    return head + rfr_parts +
           "legs:\n  - {base: {point: [0, 190 mm]}, platform_point: [40 mm, 0]}\n"
           "  - {base: {point: [0, 190 mm]" +
           shared + "}, platform_point: [-40 mm, 0]}\n";
  };
  EXPECT_TRUE(read(legs(", shared: true")));
  for (const char* shared : {"", ", shared: false"}) {
    const auto robot = read(legs(shared));
    ASSERT_FALSE(robot);
    EXPECT_EQ(robot.error()[0].code, "coincident_base_points");
  }
}

TEST(RobotFile, UnlikeLegsMakeAMixedRobotThatMovesAsItsParts) {
  const auto mixed = read(head +
                          "defaults: {link: {type: arc, length: 200 mm, tendon_offset: 5 mm}}\n"
                          "legs:\n"
                          "  - {base: {point: {radius: 190 mm, angle: 90 deg}}, closure: {type: chord}, "
                          "platform_point: {radius: 50 mm, angle: 30 deg}}\n"
                          "  - {base: {point: {radius: 190 mm, angle: 210 deg}, direction: 80 deg}, closure: "
                          "{type: strut, length: 100 mm}, platform_point: {radius: 50 mm, angle: 150 deg}}\n"
                          "  - {base: {point: {radius: 190 mm, angle: 330 deg}}, closure: {type: chord}, "
                          "platform_point: {radius: 50 mm, angle: 270 deg}}\n");
  ASSERT_TRUE(mixed) << to_string(mixed.error());
  const Robot rfr = load("3-rfr").value(), frr = load("3-frr").value();
  Workspace work(*mixed), rfr_work(rfr), frr_work(frr);
  const PlanarPose pose{0.01, -0.008, 0.02};
  ASSERT_TRUE(inverse(*mixed, pose, {}, work).ok());
  ASSERT_TRUE(inverse(rfr, pose, {}, rfr_work).ok());
  ASSERT_TRUE(inverse(frr, pose, {}, frr_work).ok());
  EXPECT_EQ(work.inputs[0], rfr_work.inputs[0]);
  EXPECT_EQ(work.inputs[1], frr_work.inputs[1]);
  EXPECT_EQ(work.inputs[2], rfr_work.inputs[2]);
  const Forward back = forward(*mixed, values(work.inputs), {}, work);
  ASSERT_TRUE(back.ok()) << to_string(back.report);
  EXPECT_NEAR(std::get<PlanarPose>(back.pose).phi, pose.phi, 1e-12);
}

TEST(RobotFile, PointsArePolarOrCartesianAndHomeIsRead) {
  const auto robot = read(head + rfr_parts +
                          "platform: {home: {x: 1 mm, phi: 10 deg}, radius: 60 mm}\n"
                          "legs:\n"
                          "  - {base: {point: [0, 0.19]}, platform_point: [0.04, 0.02]}\n"
                          "  - {base: {point: [-0.16, -0.1]}, platform_point: [-0.04, 0.02]}\n"
                          "  - {base: {point: [0.16, -0.1]}, platform_point: [0, -0.05]}\n");
  ASSERT_TRUE(robot) << to_string(robot.error());
  const PlanarRobot& model = *robot->planar();
  EXPECT_EQ(model.home.x, 0.001);
  EXPECT_EQ(model.home.y, 0);
  EXPECT_NEAR(model.home.phi, 0.17453292519943295, 1e-16);
  EXPECT_EQ(model.platform_radius, 0.06);
  EXPECT_EQ(legs_of<RfrLeg>(*robot).legs[0].base.p.y(), 0.19);
}

TEST(RobotFile, TiedLegsShareAnActuator) {
  const auto robot = read(
      head + rfr_parts +
      "legs:\n"
      "  - {base: {point: {radius: 190 mm, angle: 90 deg}}, platform_point: {radius: 50 mm, angle: 30 deg}}\n"
      "  - {base: {point: {radius: 190 mm, angle: 210 deg}}, platform_point: {radius: 50 mm, angle: 150 "
      "deg}}\n"
      "  - {base: {point: {radius: 190 mm, angle: 330 deg}}, platform_point: {radius: 50 mm, angle: 270 "
      "deg}, tied: 1}\n");
  ASSERT_TRUE(robot) << to_string(robot.error());
  Workspace work(*robot);
  EXPECT_EQ(input_count(*robot), 2);
  const Forward there = forward(*robot, {0.193, 0.188}, {}, work);
  ASSERT_TRUE(there.ok());
  const auto single = load("3-rfr").value();
  Workspace single_work(single);
  const Forward same = forward(single, {0.193, 0.188, 0.188}, {}, single_work);
  EXPECT_NEAR(std::get<PlanarPose>(there.pose).x, std::get<PlanarPose>(same.pose).x, 1e-15);
  // J δx = K δa: the tied column carries both legs.
  const Reduced reduced = assemble(*robot, there.pose, values(there.coordinates), work);
  EXPECT_EQ(reduced.K.cols(), 2);
  EXPECT_NE(reduced.K(1, 1), 0);
  EXPECT_NE(reduced.K(2, 1), 0);
  // A pose at which the tied legs need different lengths cannot be held.
  const Inverse no = inverse(*robot, PlanarPose{0.02, 0.01, 0.1}, {}, work);
  EXPECT_EQ(no.report.status, Status::unreachable);
  EXPECT_NE(no.report.message.view().find("legs[1] and those tied to it have one actuator"),
            std::string_view::npos);
}

TEST(RobotFile, FourLegsAreARedundantRobot) {
  const auto robot =
      read(head + rfr_parts + rfr_legs + "  - {base: {point: [0, -0.2]}, platform_point: [0, -0.04]}\n");
  ASSERT_TRUE(robot) << to_string(robot.error());
  Workspace work(*robot);
  const PlanarPose pose{0.005, 0.004, 0.05};
  ASSERT_TRUE(inverse(*robot, pose, {}, work).ok());
  const Forward back = forward(*robot, values(work.inputs), {}, work);
  ASSERT_TRUE(back.ok()) << to_string(back.report);
  EXPECT_NEAR(std::get<PlanarPose>(back.pose).phi, pose.phi, 1e-12);
  const Velocity v = velocity(*robot, pose, values(back.coordinates), work);
  EXPECT_TRUE(v.report.ok());
  EXPECT_EQ(v.U.rows(), 0);
  EXPECT_NE(v.report.message.view().find("no U"), std::string_view::npos);
  const std::array twist{0.01, 0.02, 0.1};  // every leg follows a twist, redundant or not
  ASSERT_TRUE(rates(v, twist, work).ok());
  for (Eigen::Index i = 0; i < 4; ++i)
    EXPECT_NEAR(v.K(i, i) * work.rates[static_cast<std::size_t>(i)],
                v.J(i, 0) * twist[0] + v.J(i, 1) * twist[1] + v.J(i, 2) * twist[2], 1e-15);
}

TEST(RobotFile, ASettingReplacesOneValue) {
  const Document document = read_robot_file("3-rfr").value();
  Node length = make_node(0.21);
  const auto changed = read_robot(with(document, "legs[1].link.length", length).value());
  ASSERT_TRUE(changed) << to_string(changed.error());
  const auto legs = legs_of<RfrLeg>(*changed).legs;
  EXPECT_EQ(legs[0].link.length, 0.2);
  EXPECT_EQ(legs[1].link.length, 0.21);
  const auto all = read_robot(with(document, "defaults.link.length", length).value());
  EXPECT_EQ(legs_of<RfrLeg>(*all).legs[2].link.length, 0.21);
  // a setting of the defaults still reaches a leg of which something else was set before
  const Document leg_first = with(document, "legs[1].link.length", length).value();
  const auto both = read_robot(with(leg_first, "defaults.link.tendon_offset", make_node(0.004)).value());
  ASSERT_TRUE(both) << to_string(both.error());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(legs_of<RfrLeg>(*both).legs[k].drive.offset, 0.004) << k;
    EXPECT_EQ(legs_of<RfrLeg>(*both).legs[k].link.length, k == 1 ? 0.21 : 0.2) << k;
  }
  EXPECT_FALSE(with(document, "legs[7].link.length", length));
}

TEST(RobotFile, ErrorsOfSharedDefaultsAreToldOnce) {
  const auto robot = read(head +
                          "defaults:\n  link: {type: arc, length: -200 mm, tendon_offset: 5 mm}\n"
                          "  closure: {type: chord}\n" +
                          rfr_legs);
  ASSERT_FALSE(robot);
  ASSERT_EQ(robot.error().size(), 1U) << to_string(robot.error());
  EXPECT_EQ(robot.error()[0].where, "robot.yaml:4:29");
}

std::string many(const std::string& begin, const std::string& one, int count, const std::string& end) {
  std::string text = head + begin;
  for (int i = 0; i < count; ++i) text += one + ", ";
  return text + end;
}

/// Some of these took a minute, or all memory, of a text of one MiB.
TEST(RobotFile, WhatNoRobotHasCostsAsMuchAsItIsLong) {
  const auto code = [](const std::string& text) {
    const auto document = parse_yaml(text, "robot.yaml");
    const auto robot = document ? read_robot(*document) : tl::unexpected(document.error());
    EXPECT_FALSE(robot);
    return robot.error().front().code;
  };
  const double begin = cpu_seconds();
  EXPECT_EQ(code(many("legs: [", "{}", 190'000, "]")), "too_large");
  EXPECT_EQ(code(many("legs: [", "0", 190'000, "]")), "too_large");
  EXPECT_EQ(code(many("defaults: {a: [", "0", 90'000, "]}") +
                 many("\nlegs: [", "{}", 90'000, "]").substr(head.size())),
            "too_large");
  EXPECT_EQ(code(many("kind: serial\nsections: [", "{}", 190'000, "]")), "too_large");
  const auto sections =
      read_serial_robot(parse_yaml(many("kind: serial\nsections: [", "{}", 4000, "]"), "robot.yaml").value());
  EXPECT_EQ(sections.error().front().code, "too_many_sections");
  EXPECT_EQ(code(many("legs: [", "{}", 4000, "]")), "too_many_legs");
  EXPECT_EQ(code(many("a: {", "a: 1", 90'000, "}")), "duplicate_key");
  EXPECT_EQ(code(head + "a: " + std::string(1'000'000, '[')), "too_deep");
  EXPECT_LT(cpu_seconds() - begin, 20);  // 1, or several under a sanitizer
}

TEST(RobotFile, SettingsAreNoMoreThanARobotHas) {
  const Document document = read_robot_file("3-rfr").value();
  std::vector<Member> settings(500, {"legs[0].link.length", 0, 0, make_node(0.2)});
  EXPECT_TRUE(with(document, settings));
  settings.push_back(settings.back());
  EXPECT_EQ(with(document, settings).error().front().code, "too_large");
  Node list;
  list.kind = Node::Kind::list;
  list.items.resize(5000);
  EXPECT_EQ(with(document, "legs[0].link.length", list).error().front().code, "too_large");
}

}  // namespace robot_file_test
}  // namespace sinew::test
