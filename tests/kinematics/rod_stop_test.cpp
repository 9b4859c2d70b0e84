/// Solves of rods that are asked to stop: before they begin, and from another thread while they run.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "cpu_time.hpp"
#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::test {
namespace rod_stop_test {

/// Computed after the request, by all threads: a hundred milliseconds of a machine that has nothing else to
/// do.
constexpr double max_seconds = 0.1;

/// One public function, on a workspace that holds an equilibrium; whether its answer says it was stopped.
struct Question {
  const char* name;
  std::function<bool(const Robot&, Workspace&)> ask;
};

SpatialWrench pressed() {
  SpatialWrench wrench = SpatialWrench::Zero();
  wrench << 0.3, 0, -1, 0, 0.01, 0;
  return wrench;
}

std::vector<double> inputs_of_home(const Robot& robot, Workspace& work) {
  const SpatialPose home = std::get<SpatialPose>(sinew::home(robot));
  const Equilibrium begun =
      input_count(robot) == 3 ? inverse_equilibrium(robot, IndependentPose{home.position[2], 0, 0}, {}, work)
                              : inverse_equilibrium(robot, home, {}, work);
  EXPECT_TRUE(begun.is_solved());
  return {begun.inputs.begin(), begun.inputs.end()};
}

std::vector<Question> questions(const std::vector<double>& home) {
  const auto is_stopped = [](const Report& report) { return report.status == Status::stopped; };
  std::vector<double> beside = home;
  for (std::size_t k = 0; k < beside.size(); ++k) beside[k] *= 1 + 0.03 * std::sin(double(k));
  std::vector<Question> all{{"equilibrium",
                             [=](const Robot& r, Workspace& work) {
                               return is_stopped(equilibrium(r, beside, {.wrench = pressed()}, work).report);
                             }},
                            {"follow_load",
                             [=](const Robot& r, Workspace& work) {
                               return follow_load(r, pressed(), 1e3, work).end == LoadEnd::stopped;
                             }},
                            {"equilibria",
                             [=](const Robot& r, Workspace& work) {
                               equilibria(r, home, {}, work);
                               return work.stop.stop_requested();
                             }},
                            {"equilibrium_curves",
                             [=](const Robot& r, Workspace& work) {
                               CurveOptions how;
                               how.added_wrench = 100 * pressed();
                               how.max_points = 20000;
                               how.follows_branches = true;
                               const auto curves = equilibrium_curves(r, how, work);
                               return curves.empty() || curves.front().end == CurveEnd::stopped;
                             }},
                            {"sense_wrench",
                             [=](const Robot& r, Workspace& work) {
                               const std::vector<double> axial{-.1, .05, -.02, .1, .03, -.04}, none(6, 0.0);
                               return is_stopped(sense_wrench(r, beside, axial, none, {}, work).report);
                             }},
                            {"equilibrium_batch", [=](const Robot& r, Workspace& work) {
                               constexpr std::size_t count = 4000;
                               std::vector<double> rows;
                               for (std::size_t k = 0; k < count; ++k)
                                 for (const double length : home)
                                   rows.push_back(length + 1e-4 * std::sin(double(k)));
                               std::vector<SpatialPose> poses(count);
                               std::vector<Status> statuses(count);
                               equilibrium_batch(r, rows, SpatialWrench::Zero(), poses, statuses, work, true);
                               return statuses.back() == Status::stopped;
                             }}};
  if (home.size() == 6)
    all.push_back({"inverse_equilibrium of a pose", [=](const Robot& r, Workspace& work) {
                     const SpatialPose wanted = pose_of(
                         {Vec3<double>(0.02, 0.03, 0.42), SO3<double>::exp(Vec3<double>(0.2, -0.1, 0.1))});
                     return is_stopped(inverse_equilibrium(r, wanted, {}, work).report);
                   }});
  else
    all.push_back(
        {"inverse_equilibrium of coordinates", [=](const Robot& r, Workspace& work) {
           const double z = std::get<SpatialPose>(sinew::home(r)).position[2];
           return is_stopped(inverse_equilibrium(r, IndependentPose{z, 0.05, 0.1}, {}, work).report);
         }});
  return all;
}

TEST(RodStop, ATokenStoppedBeforeIsSeenAtOnce) {
  for (const char* name : {"3pfs-g2", "hexapod", "hexapod-torsion"}) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    const std::vector<double> home = inputs_of_home(robot, work);
    const std::atomic<bool> flag{true};
    for (const Question& question : questions(home)) {
      SCOPED_TRACE(testing::Message() << name << ", " << question.name);
      work.stop = {};
      ASSERT_TRUE(equilibrium(robot, home, {}, work).is_solved());
      work.stop = StopToken(flag);
      const double begun = cpu_seconds();
      EXPECT_TRUE(question.ask(robot, work));
      EXPECT_LT(cpu_seconds() - begun, max_seconds);
    }
  }
}

/// Asked again and again until it is stopped: the last answer comes soon after the request.
TEST(RodStop, ARunningSolveEndsSoonAfterTheRequest) {
  for (const char* name : {"3pfs-g2", "hexapod", "hexapod-torsion"}) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    const std::vector<double> home = inputs_of_home(robot, work);
    for (const Question& question : questions(home)) {
      SCOPED_TRACE(testing::Message() << name << ", " << question.name);
      work.stop = {};
      ASSERT_TRUE(equilibrium(robot, home, {}, work).is_solved());
      std::atomic<bool> flag{false};
      double asked = 0;
      std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
        asked = cpu_seconds();
        flag = true;
      });
      work.stop = StopToken(flag);
      while (!question.ask(robot, work)) {
        if (work.stop.stop_requested())
          break;  // just before or after it was solved; what is stopped may leave nothing
        equilibrium(robot, home, {}, work);  // curves leave none behind
      }
      const double ended = cpu_seconds();
      other.join();
      EXPECT_LT(ended - asked, max_seconds);
      work.stop = {};  // and the workspace goes on
      EXPECT_TRUE(equilibrium(robot, home, {}, work).is_solved());
    }
  }
}

}  // namespace rod_stop_test
}  // namespace sinew::test
