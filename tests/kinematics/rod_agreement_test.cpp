/// Three ways to a loaded equilibrium of rods, put beside each other at random loads: cold `equilibrium`,
/// `follow_load`, and the curve by arc length. Where they come to the load they come to one pose; where one
/// does not it says why, and the others say the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>

#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::test {
namespace rod_agreement_test {

double distance(const SpatialPose& a, const SpatialPose& b) {
  const SE3<double> p = SE3<double>::from(a), q = SE3<double>::from(b);
  return (p.p - q.p).norm() + p.R.inverse().compose(q.R).log().norm();
}

/// A robot at random inputs around home, and a load.
struct Trial {
  std::vector<double> inputs;
  SpatialWrench wrench;
};

class Trials {
 public:
  Trials(const Robot& robot, double force, unsigned seed) : force_(force), random_(seed) {
    Workspace work(robot);
    const SpatialPose home = std::get<SpatialPose>(sinew::home(robot));
    const Equilibrium begun =
        input_count(robot) == 3
            ? inverse_equilibrium(robot, IndependentPose{home.position[2], 0, 0}, {}, work)
            : inverse_equilibrium(robot, home, {}, work);
    EXPECT_TRUE(begun.is_solved());
    home_.assign(begun.inputs.begin(), begun.inputs.end());
  }
  Trial next() {
    Trial trial;
    for (const double length : home_) trial.inputs.push_back(length + uniform(0.02));
    const double size = force_ * std::exp(uniform(1.5));
    for (int k = 0; k < 6; ++k) trial.wrench[k] = uniform(k < 3 ? size : 0.1 * size);
    return trial;
  }

 private:
  double uniform(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }
  double force_;
  std::mt19937 random_;
  std::vector<double> home_;
};

/// How far a way came, and why it ended there.
struct Arrival {
  double part = 0;  ///< of the load: 1 where it arrived
  std::string why = {};
  std::optional<SpatialPose> pose = {};  ///< where it arrived
  bool is_stable = false;
  double definite_until = -1;
};

Arrival by_forward(const Robot& robot, const Trial& trial, Workspace& work) {
  EquilibriumOptions options;
  options.wrench = trial.wrench;
  const Equilibrium found = equilibrium(robot, trial.inputs, options, work);
  if (found.is_solved()) return {1, "", found.pose, found.report.ok()};
  return {
      0, std::string(to_string(found.report.status)) + ": " + std::string(found.report.message.view()), {}};
}

Arrival by_until(const Robot& robot, const Trial& trial, Workspace& work) {
  if (!equilibrium(robot, trial.inputs, {}, work).report.ok()) return {-1, "unloaded"};
  const LoadPath path = follow_load(robot, trial.wrench, 1, work);
  Arrival arrival{path.load, std::string(to_string(path.end)), {}, true};
  if (path.end == LoadEnd::limit) {
    arrival.pose = path.pose;
    arrival.is_stable = path.unstable_directions == 0;
  }
  arrival.definite_until = path.definite_until;
  return arrival;
}

struct Traced : Arrival {
  std::vector<CurvePoint> events;
};

Traced by_track(const Robot& robot, const Trial& trial, Workspace& work) {
  Traced traced;
  if (!equilibrium(robot, trial.inputs, {}, work).report.ok()) {
    traced.part = -1;
    return traced;
  }
  CurveOptions how;
  how.added_wrench = trial.wrench;
  how.max_points = 2000;
  const auto curves = equilibrium_curves(robot, how, work);
  if (curves.empty()) return traced;
  traced.why = to_string(curves[0].end);
  for (const CurvePoint& point : curves[0].points) {
    traced.part = point.parameter;
    if (point.event == CurveEvent::none || point.event == CurveEvent::begin) continue;
    traced.events.push_back(point);
    if (point.event == CurveEvent::fold) break;
    if (point.event == CurveEvent::target) {
      traced.pose = point.pose;
      traced.is_stable = point.unstable_directions == 0;
      break;
    }
  }
  return traced;
}

/// The load in equal small steps, each resumed from the one before: what nobody could miss.
Arrival by_steps(const Robot& robot, const Trial& trial, Workspace& work, int steps) {
  Equilibrium found = equilibrium(robot, trial.inputs, {}, work);
  if (!found.report.ok()) return {-1, "unloaded"};
  EquilibriumOptions options;
  options.warm_start = true;
  for (int k = 1; k <= steps; ++k) {
    const SpatialPose before = found.pose;
    options.wrench = trial.wrench * k / steps;
    found = equilibrium(robot, trial.inputs, options, work);
    if (!found.is_solved() || distance(before, found.pose) > 0.02) return {double(k - 1) / steps, "step"};
  }
  return {1, "", found.pose, found.report.ok()};
}

std::string describe(const Arrival& arrival) {
  char text[400];
  std::snprintf(text, sizeof text, "%.6f %s%s", arrival.part, arrival.why.c_str(),
                arrival.pose ? arrival.is_stable ? " (stable)" : " (unstable)" : "");
  return text;
}

/// Empty where the three tell one story.
std::string difference(const Arrival& forward, const Arrival& until, const Traced& track) {
  if (until.part < 0 || track.part < 0) return "";  // nothing to load
  constexpr double near = 1e-6;
  const bool is_lost = !until.pose;  // stability, on the way
  if (forward.pose.has_value() != track.pose.has_value()) {
    return "forward or track does not arrive";
  }
  if (forward.pose) {
    if (!(distance(*forward.pose, *track.pose) < near)) return "other poses of forward and track";
    if (forward.is_stable != track.is_stable) return "other stability";
    if (until.pose && !(distance(*forward.pose, *until.pose) < near))
      return "other poses of forward and until";
    if (until.pose && until.is_stable != forward.is_stable) return "other stability of forward and until";
    if (is_lost && forward.is_stable && track.events.size() < 2) return "until loses what holds";
  } else if (until.pose) {
    return "only until arrives";
  }
  const auto is_at = [](const CurvePoint& point, double part) {
    return std::abs(point.parameter - part) < 1e-6 * part;
  };
  const bool is_driven = until.why == "stability";  // of which the curve tells what comes before
  if (is_lost && !is_driven) {                      // the curve says where too, and what
    const auto there = std::ranges::find_if(track.events, [&](const CurvePoint& point) {
      const bool is_bifurcation = until.why == "bifurcation" && point.event == CurveEvent::rod_bifurcation;
      return is_at(point, until.part) && (is_bifurcation || until.why == to_string(point.event));
    });
    const bool is_end = std::abs(track.part - until.part) < 0.05 && track.why == until.why;
    if (there == track.events.end() && !is_end) return "until ends where the curve has no such event";
  }
  if (until.definite_until >= 0) {
    const auto there = std::ranges::find_if(track.events, [&](const CurvePoint& point) {
      return point.event == CurveEvent::stability && is_at(point, until.definite_until);
    });
    if (there == track.events.end() && until.definite_until < until.part * (1 - 1e-6))
      return "until loses definiteness where the curve does not";
  }
  for (const CurvePoint& point : track.events) {
    if (point.event == CurveEvent::target || is_at(point, until.part)) continue;
    if (point.event == CurveEvent::stability && is_at(point, until.definite_until)) break;  // that is told
    if (until.pose || point.parameter < until.part) return "the curve has an event before until ends";
  }
  return "";
}

TEST(RodAgreement, ForwardUntilAndTrackTellOneStory) {
  const char* asked = std::getenv("SINEW_ROD_LOADS");
  const int whole = asked ? std::atoi(asked) : 120;
  struct Case {
    const char* name;
    double force;  ///< typical, so that some buckle
    int share;     ///< of 20
  };
  const Case cases[] = {{"3pfs-g1", 60, 5}, {"3pfs-g2", 30, 4},       {"6pfs", 60, 3},
                        {"hexapod", 5, 3},  {"hexapod-heavy", 25, 4}, {"hexapod-self-weight", 5, 1}};
  int arrived = 0, told = 0, wrong = 0;
  for (const Case& one : cases) {
    const Robot robot = load(one.name).value();
    Workspace work(robot);
    Trials trials(robot, one.force, 11);
    for (int k = 0; k < whole * one.share / 20; ++k) {
      const Trial trial = trials.next();
      const Arrival forward = by_forward(robot, trial, work), until = by_until(robot, trial, work);
      const Traced track = by_track(robot, trial, work);
      const std::string differs = difference(forward, until, track);
      if (differs.empty()) {
        ++(forward.pose ? arrived : told);
        continue;
      }
      ++wrong;
      std::string text = std::string(one.name) + " #" + std::to_string(k) + ": " + differs + "\n  forward " +
                         describe(forward) + "\n  until   " + describe(until) + "\n  track   " +
                         describe(track) + ", events:";
      for (const CurvePoint& point : track.events)
        text += " " + std::string(to_string(point.event)) + " " + std::to_string(point.parameter);
      const Arrival steps = by_steps(robot, trial, work, 2000);
      text += "\n  steps   " + describe(steps);
      if (steps.pose && forward.pose)
        text += ", from forward " + std::to_string(distance(*steps.pose, *forward.pose));
      if (steps.pose && track.pose)
        text += ", from track " + std::to_string(distance(*steps.pose, *track.pose));
      text += "\n  inputs";
      char number[40];
      for (const double x : trial.inputs) std::snprintf(number, sizeof number, " %.17g", x), text += number;
      text += "\n  wrench";
      for (const double x : trial.wrench) std::snprintf(number, sizeof number, " %.17g", x), text += number;
      ADD_FAILURE() << text;
    }
  }
  std::printf("%d agree at the load, %d agree on why they do not come there, %d differ\n", arrived, told,
              wrong);
}

SpatialWrench wrench_of(std::array<double, 6> parts) { return SpatialWrench(parts.data()); }

/// The curve passes near a bifurcation, of which a step from one side of it to the other made one on the
/// curve, each time where that step happened to end.
TEST(RodAgreement, ACurveNearABifurcationStaysItself) {
  const Robot robot = load("hexapod-heavy").value();
  Workspace work(robot);
  const std::vector<double> inputs{.435, .409, .417, .431, .408, .413};
  const SpatialWrench direction = wrench_of({-.6, -.78, 5.25, .09, -.11, -.08});
  for (const double most : {30.0, 32.0, 36.0}) {
    const Trial trial{inputs, most * direction};
    const Traced track = by_track(robot, trial, work);
    ASSERT_TRUE(track.pose) << most;
    ASSERT_EQ(track.events.size(), 1u) << most;  // the target
    EXPECT_TRUE(track.is_stable);
    const Arrival forward = by_forward(robot, trial, work), until = by_until(robot, trial, work),
                  steps = by_steps(robot, trial, work, int(most / 0.2));
    ASSERT_TRUE(forward.pose && until.pose && steps.pose) << most;
    for (const Arrival* other : {&forward, &until, &steps}) {
      EXPECT_TRUE(other->is_stable) << most;
      EXPECT_LT(distance(*other->pose, *track.pose), 1e-8) << most;
    }
  }
}

/// A load that is reached is not refused, nor is a fold claimed that no curve has.
TEST(RodAgreement, AFoldIsClaimedOnlyWhereTheCurveTurns) {
  const Robot robot = load("3pfs-g1").value();
  Workspace work(robot);
  const Trial trial{{.4167, .4279, .4096}, wrench_of({31.36, 12.56, -29.79, 0, 0, 0})};
  const Arrival forward = by_forward(robot, trial, work), until = by_until(robot, trial, work);
  const Traced track = by_track(robot, trial, work);
  ASSERT_TRUE(forward.pose && until.pose && track.pose) << forward.why << until.why;
  EXPECT_TRUE(forward.is_stable && until.is_stable && track.is_stable);
  EXPECT_LT(distance(*forward.pose, *track.pose), 1e-8);
  EXPECT_LT(distance(*until.pose, *track.pose), 1e-8);
}

/// Under a moment the symmetric part of the stiffness loses definiteness before the fold; that is told apart,
/// and neither depends on what the load is counted in.
TEST(RodAgreement, AMomentFoldsWhereTheCurveTurns) {
  const Robot robot = load("3pfs-g2").value();
  Workspace work(robot);
  const std::vector<double> inputs{.43, .44, .435};
  int apart = 0;
  for (const double moment : {0.5, 2.0, 5.0}) {
    SCOPED_TRACE(moment);
    const Trial trial{inputs, wrench_of({2, 1, -150, moment, -0.7 * moment, 0.3 * moment})};
    const Traced track = by_track(robot, trial, work);
    const auto fold = std::ranges::find(track.events, CurveEvent::fold, &CurvePoint::event);
    ASSERT_NE(fold, track.events.end());
    for (const double unit : {1.0, 1e-3, 1e3, 1e-300, 1e300}) {
      ASSERT_TRUE(equilibrium(robot, inputs, {}, work).is_solved());
      const LoadPath path = follow_load(robot, unit * trial.wrench, 1 / unit, work);
      EXPECT_EQ(path.end, LoadEnd::fold) << unit;
      EXPECT_NEAR(path.load * unit, fold->parameter, 1e-9) << unit;
      EXPECT_LT(path.definite_until, path.load);
      apart += path.definite_until > 0;
    }
  }
  EXPECT_GT(apart, 4);
}

/// The load found is exact beside itself, however far it might have gone.
TEST(RodAgreement, ALoadDoesNotDependOnItsLimit) {
  for (const char* name : {"3pfs-g2", "hexapod"}) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    const SpatialPose home = std::get<SpatialPose>(sinew::home(robot));
    std::optional<double> first;
    for (const double limit : {3e2, 1e9, 1e12, 1e300}) {
      const bool is_begun =
          input_count(robot) == 3
              ? inverse_equilibrium(robot, IndependentPose{home.position[2], 0.02, 0}, {}, work).is_solved()
              : inverse_equilibrium(robot, home, {}, work).is_solved();
      ASSERT_TRUE(is_begun);
      const LoadPath path = follow_load(robot, wrench_of({0.3, 0, -1, 0, 0, 0}), limit, work);
      if (!first) first = path.load;
      EXPECT_EQ(path.end, LoadEnd::fold) << name << limit;
      EXPECT_NEAR(path.load, *first, 1e-9 * *first) << name << limit;
      EXPECT_GT(path.load, 1);
    }
  }
}

}  // namespace rod_agreement_test
}  // namespace sinew::test
