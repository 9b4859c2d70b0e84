/// Curves of equilibria through folds and bifurcations, against what other ways find there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::test {
namespace equilibrium_curve_test {

Robot builtin(const char* name) { return load(name).value(); }

double distance(const SpatialPose& a, const SpatialPose& b) {
  const SE3<double> p = SE3<double>::from(a), q = SE3<double>::from(b);
  return (p.p - q.p).norm() + p.R.inverse().compose(q.R).log().norm();
}

SpatialWrench along_z(double force) {
  SpatialWrench wrench = SpatialWrench::Zero();
  wrench[2] = force;
  return wrench;
}

std::vector<const CurvePoint*> events_of(const EquilibriumCurve& curve, CurveEvent event) {
  std::vector<const CurvePoint*> points;
  for (const CurvePoint& point : curve.points)
    if (point.event == event) points.push_back(&point);
  return points;
}

/// Pressed down in the middle, the tripods lose two directions at once, by symmetry, at the loads of
/// docs/theory/rod_robot.md. Of each bifurcation three ways of leaving lead down and three up, each the
/// others turned by 120 degrees.
TEST(EquilibriumCurve, SymmetricTripodsBifurcateIntoSixCurves) {
  const std::pair<const char*, double> robots[] = {{"3pfs-g1", -194.987}, {"3pfs-g2", -110.923}};
  for (const auto& [name, load] : robots) {
    SCOPED_TRACE(name);
    const Robot robot = builtin(name);
    Workspace work(robot);
    const SpatialPose home = std::get<SpatialPose>(sinew::home(robot));
    ASSERT_TRUE(inverse_equilibrium(robot, IndependentPose{home.position[2], 0, 0}, {}, work).is_solved());
    CurveOptions how;
    how.added_wrench = along_z(1.05 * load);
    how.follows_branches = true;
    how.max_points = 60;
    const auto curves = equilibrium_curves(robot, how, work);
    ASSERT_GE(curves.size(), 7u);
    const auto first = events_of(curves[0], CurveEvent::bifurcation);
    ASSERT_FALSE(first.empty());
    EXPECT_NEAR(1.05 * load * first[0]->parameter, load, 6e-4);  // told to 1e-3
    EXPECT_EQ(first[0]->unstable_directions, 0);
    std::vector<const EquilibriumCurve*> six;
    for (const EquilibriumCurve& curve : curves)
      if (curve.from_curve == 0 && &curves[0].points[static_cast<std::size_t>(curve.from_point)] == first[0])
        six.push_back(&curve);
    ASSERT_EQ(six.size(), 6u);
    for (const EquilibriumCurve* curve : six) {
      const CurvePoint& last = curve->points.back();
      const Vec3<double> turned =
          SO3<double>::exp(Vec3<double>(0, 0, 2 * std::numbers::pi / 3)).rotate(last.pose.position);
      double nearest = 1;
      for (const EquilibriumCurve* other : six)
        nearest = std::min(nearest, (other->points.back().pose.position - turned).norm());
      EXPECT_LT(nearest, 1e-9);
    }
  }
}

/// The points of a curve are equilibria by themselves: the solver that starts there stays there. Beyond the
/// fold rods laid to a pose alone may bend otherwise; some of them do not.
TEST(EquilibriumCurve, ItsPointsAreEquilibria) {
  const Robot robot = builtin("3pfs-g2");
  Workspace work(robot), other(robot);
  ASSERT_TRUE(inverse_equilibrium(robot, IndependentPose{0.4, 0.05, 0}, {}, work).is_solved());
  CurveOptions how;
  how.added_wrench = along_z(-150);
  const auto curves = equilibrium_curves(robot, how, work);
  ASSERT_EQ(curves.size(), 1u);
  const auto folds = events_of(curves[0], CurveEvent::fold);
  ASSERT_FALSE(folds.empty());
  int met_beyond = 0;
  for (std::size_t k = 1; k < curves[0].points.size(); ++k) {
    const CurvePoint& point = curves[0].points[k];
    if (point.event != CurveEvent::none) continue;
    EquilibriumOptions options;
    options.wrench = point.parameter * how.added_wrench;
    options.start = point.pose;
    const Equilibrium found = equilibrium(robot, point.inputs, options, other);
    const bool is_before = &point < folds[0];
    if (!is_before && (!found.is_solved() || distance(found.pose, point.pose) > 1e-4)) continue;
    ASSERT_TRUE(found.is_solved()) << k << ": " << found.report.message.view();
    EXPECT_LT(distance(found.pose, point.pose), 1e-8) << k;
    EXPECT_EQ(analyse_equilibrium(robot, other).unstable_directions, point.unstable_directions) << k;
    met_beyond += !is_before;
  }
  EXPECT_GE(met_beyond, 2);
}

/// The load at which a path along it ends is that at which the curve turns back, of planar and other rods.
TEST(EquilibriumCurve, FoldsWhereTheLoadPathEnds) {
  for (const char* name : {"3pfs-g1", "3pfs-g2", "hexapod-heavy"}) {
    SCOPED_TRACE(name);
    const Robot robot = builtin(name);
    Workspace work(robot);
    EquilibriumOptions options;
    options.wrench[0] = 0.5;
    SpatialPose home = std::get<SpatialPose>(sinew::home(robot));
    const auto begin = [&] {
      if (input_count(robot) == 3)
        return inverse_equilibrium(robot, IndependentPose{home.position[2], 0, 0}, options, work);
      return inverse_equilibrium(robot, home, options, work);
    };
    ASSERT_TRUE(begin().is_solved());
    const LoadPath path = follow_load(robot, along_z(-1), 400, work);
    ASSERT_EQ(path.end, LoadEnd::fold);
    ASSERT_TRUE(begin().is_solved());
    CurveOptions how;
    how.added_wrench = along_z(-400);
    const auto curves = equilibrium_curves(robot, how, work);
    const auto folds = events_of(curves.at(0), CurveEvent::fold);
    ASSERT_FALSE(folds.empty());
    EXPECT_NEAR(400 * folds[0]->parameter, path.load, 1e-6 * path.load);
    EXPECT_LT((folds[0]->pose.position - path.pose.position).norm(), 1e-3);
  }
}

/// From its target backwards a curve leads to its beginning, and beyond a fold to an equilibrium that starts
/// scattered around home may find too.
TEST(EquilibriumCurve, LeadsBackAndFindsOtherEquilibria) {
  const Robot robot = builtin("3pfs-g2");
  Workspace work(robot);
  const Equilibrium begun = inverse_equilibrium(robot, IndependentPose{0.4, 0.1, 0.05}, {}, work);
  ASSERT_TRUE(begun.is_solved());
  const SpatialPose pose = begun.pose;
  const std::vector<double> inputs(begun.inputs.begin(), begun.inputs.end());
  CurveOptions how;
  how.inputs = {inputs[0] + 0.05, inputs[1] - 0.02, inputs[2] + 0.01};
  auto curves = equilibrium_curves(robot, how, work);
  ASSERT_EQ(curves.at(0).end, CurveEnd::left_range);
  const CurvePoint& target = curves[0].points.back();
  ASSERT_EQ(target.event, CurveEvent::target);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(target.inputs[k], how.inputs[k]);
  const SpatialPose there = target.pose;
  EquilibriumOptions options;
  options.start = there;
  ASSERT_TRUE(equilibrium(robot, how.inputs, options, work).is_solved());
  how.inputs = inputs;
  curves = equilibrium_curves(robot, how, work);
  ASSERT_EQ(curves.at(0).points.back().event, CurveEvent::target);
  EXPECT_LT(distance(curves[0].points.back().pose, pose), 1e-9);
}

/// A load just below the fold is met twice, on the way there and back, however short that way is.
TEST(EquilibriumCurve, MeetsALoadJustBelowItsFoldTwice) {
  const Robot robot = builtin("3pfs-g2");
  Workspace work(robot);
  const auto begin = [&] {
    return inverse_equilibrium(robot, IndependentPose{0.4, 0.05, 0.02}, {}, work).is_solved();
  };
  ASSERT_TRUE(begin());
  CurveOptions how;
  how.added_wrench = along_z(-150);
  const auto whole = equilibrium_curves(robot, how, work);
  const auto folds = events_of(whole.at(0), CurveEvent::fold);
  ASSERT_FALSE(folds.empty());
  const double fold = -150 * folds[0]->parameter;
  for (const double below : {1e-2, 1e-3, 1e-4, 1e-6}) {
    ASSERT_TRUE(begin());
    how.added_wrench = along_z((1 - below) * fold);
    how.highest = 1.5;
    const auto curves = equilibrium_curves(robot, how, work);
    const auto met = events_of(curves.at(0), CurveEvent::target);
    ASSERT_EQ(met.size(), 2u) << below;
    EXPECT_EQ(met[1]->unstable_directions, met[0]->unstable_directions + 1);
    EXPECT_NEAR(events_of(curves[0], CurveEvent::fold).at(0)->parameter, 1 / (1 - below), 1e-9);
  }
}

/// A pose on the straight way from home where the lengths fold: the tracer, which knows no path, and the cold
/// inverse agree on where; rods then grow.
TEST(EquilibriumCurve, FoldsOfHeldPosesAreThoseTheInverseNames) {
  const Robot robot = builtin("hexapod");
  Workspace work(robot);
  const SpatialPose wanted = pose_of(
      {Vec3<double>(0.0725, 0.109, 0.5287), SO3<double>::exp(Vec3<double>(0.3437, -0.2009, -0.1995))});
  const Equilibrium refused = inverse_equilibrium(robot, wanted, {}, work);
  ASSERT_EQ(refused.report.status, Status::singular) << refused.report.message.view();
  EXPECT_NE(refused.report.message.view().find("pass a fold at 70 %"), std::string_view::npos)
      << refused.report.message.view();
  ASSERT_TRUE(inverse_equilibrium(robot, pose_of(level(0.4)), {}, work).is_solved());
  CurveOptions how;
  how.pose = wanted;
  const auto curves = equilibrium_curves(robot, how, work);
  const auto folds = events_of(curves.at(0), CurveEvent::fold);
  ASSERT_FALSE(folds.empty());
  EXPECT_NEAR(folds[0]->parameter, 0.70, 0.01);
  EXPECT_EQ(curves[0].end, CurveEnd::far);
  EXPECT_EQ(folds[0]->unstable_directions, 0);  // at fixed lengths the platform stays held
  double largest = 0;
  for (const CurvePoint& point : curves[0].points) largest = std::max(largest, point.residual);
  EXPECT_LT(largest, 1e-10);
  // a point in between, by the lengths alone
  const CurvePoint& point = curves[0].points[10];
  EquilibriumOptions options;
  options.start = point.pose;
  const Equilibrium free = equilibrium(robot, point.inputs, options, work);
  ASSERT_TRUE(free.is_solved());
  EXPECT_LT(distance(free.pose, point.pose), 1e-8);
}

TEST(EquilibriumCurve, RefusesWhatIsNoCurve) {
  const Robot rods = builtin("3pfs-g2"), arcs = builtin("6-ufs");
  Workspace work(rods), other(arcs);
  CurveOptions how;
  how.added_wrench = along_z(-1);
  EXPECT_TRUE(equilibrium_curves(arcs, how, other).empty());
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());  // nothing is solved yet
  const auto begin = [&] {
    return inverse_equilibrium(rods, IndependentPose{0.4, 0, 0}, {}, work).is_solved();
  };
  ASSERT_TRUE(begin());
  EXPECT_TRUE(equilibrium_curves(rods, {}, work).empty());  // nothing changes
  how.inputs = {0.4, 0.4};
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());
  how.inputs = {0.4, std::nan(""), 0.4};
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());
  how.inputs.clear();
  how.pose = SpatialPose{};
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());  // three inputs hold no pose
  how.pose.reset();
  how.lowest = 0.5;
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());
  how.lowest = 0;
  how.added_wrench[0] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(equilibrium_curves(rods, how, work).empty());
  how.added_wrench = along_z(-1);
  how.max_points = 2;
  EXPECT_EQ(equilibrium_curves(rods, how, work).at(0).points.size(), 2u);
}

/// One bifurcation a curve of a single point, in place of what would leave there.
TEST(EquilibriumCurve, SaysWhichBifurcationsItDidNotLeave) {
  const Robot robot = builtin("3pfs-g2");
  Workspace work(robot);
  const double home = std::get<SpatialPose>(sinew::home(robot)).position[2];
  ASSERT_TRUE(inverse_equilibrium(robot, IndependentPose{home, 0, 0}, {}, work).is_solved());
  CurveOptions how;
  how.added_wrench = along_z(-116);
  how.follows_branches = true;
  how.max_total_points = 1;
  const auto curves = equilibrium_curves(robot, how, work);
  const auto met = events_of(curves.at(0), CurveEvent::bifurcation);
  ASSERT_EQ(curves.size(), 1 + met.size());
  for (std::size_t k = 1; k < curves.size(); ++k) {
    EXPECT_EQ(to_string(curves[k].end), "not_followed");
    EXPECT_EQ(curves[k].points.size(), 1u);
    EXPECT_EQ(&curves[0].points[static_cast<std::size_t>(curves[k].from_point)], met[k - 1]);
  }
  ASSERT_TRUE(inverse_equilibrium(robot, IndependentPose{home, 0, 0}, {}, work).is_solved());
  how.max_total_points = 0;
  EXPECT_TRUE(equilibrium_curves(robot, how, work).empty());
}

}  // namespace equilibrium_curve_test
}  // namespace sinew::test
