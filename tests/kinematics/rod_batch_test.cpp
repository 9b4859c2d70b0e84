/// Many poses at once are the poses that are found one by one.
#include <gtest/gtest.h>

#include <random>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::test {
namespace rod_batch_test {

/// Poses of these rows, all at once, and what is found for each alone.
struct Both {
  std::vector<SpatialPose> poses;
  std::vector<Status> statuses;
  std::vector<double> residuals;
  double worst = 0;  ///< largest difference of a coordinate where both are solved
  int differ = 0;    ///< rows that one way solves and the other does not

  Both(const char* name, const std::vector<double>& rows, const SpatialWrench& wrench = SpatialWrench::Zero())
      : poses(rows.size() / 3),
        statuses(rows.size() / 3),
        residuals(rows.size() / 3) {
    const Robot robot = load(name).value();
    Workspace work(robot), alone(robot);
    equilibrium_batch(robot, rows, wrench, poses, statuses, work, false, residuals);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const bool is_small = residuals[k] >= 0 && residuals[k] <= 1e-11;
      EXPECT_EQ(is_small, statuses[k] == Status::converged) << name << k << ": " << residuals[k];
      EXPECT_EQ(std::isnan(residuals[k]), statuses[k] != Status::converged) << name << k;
      const Equilibrium one =
          equilibrium(robot, std::span(rows).subspan(3 * k, 3), {.wrench = wrench}, alone);
      const bool is_solved = statuses[k] == Status::converged;
      differ += one.is_solved() != is_solved;
      if (!one.is_solved() || !is_solved) continue;
      worst = std::max(worst, (poses[k].position - one.pose.position).norm());
      for (std::size_t c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(poses[k].quaternion[c] - one.pose.quaternion[c]));
    }
  }
};

std::vector<double> random_rows(int count, double home, double range) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-range, range);
  std::vector<double> rows;
  for (int k = 0; k < 3 * count; ++k) rows.push_back(home + uniform(random));
  return rows;
}

/// A walk of small steps through the same box.
std::vector<double> walked_rows(int count, double home, double range) {
  std::vector<double> rows;
  for (int k = 0; k < count; ++k)
    for (const double speed : {0.021, 0.034, 0.055}) rows.push_back(home + range * std::sin(speed * k));
  return rows;
}

TEST(RodBatch, FindsWhatIsFoundOneByOne) {
  SpatialWrench wrench;
  wrench << 1, -0.5, -5, 0.2, 0.1, -0.1;
  for (const int count : {1, 7, 8, 500}) {
    for (const Both& both : {Both("3pfs-g1", walked_rows(count, 0.2076, 0.03)),
                             Both("3pfs-g2", walked_rows(count, 0.4347, 0.05), wrench)}) {
      EXPECT_EQ(both.differ, 0) << count;
      EXPECT_LT(both.worst, 1e-11) << count;
    }
  }
}

TEST(RodBatch, IsNotMisledByRowsFarFromEachOther) {
  const Both both("3pfs-g2", random_rows(200, 0.4347, 0.06));
  EXPECT_EQ(both.differ, 0);
  EXPECT_LT(both.worst, 1e-11);
}

TEST(RodBatch, TakesTheFineNodesWhereTheLanesDoNotResolveTheRods) {
  const Both both("3pfs-g2", walked_rows(400, 0.4347, 0.15));
  EXPECT_EQ(both.differ, 0);
  EXPECT_LT(both.worst, 1e-10);
}

TEST(RodBatch, SaysWhichRowsHaveNoPoseAndGoesOn) {
  std::vector<double> rows = walked_rows(64, 0.4347, 0.02);
  rows[3 * 20] = 0.01;  // out of reach
  rows[3 * 40 + 1] = std::numeric_limits<double>::quiet_NaN();
  const Both both("3pfs-g2", rows);
  EXPECT_EQ(both.differ, 0);
  EXPECT_LT(both.worst, 1e-11);
  EXPECT_EQ(both.statuses[20], Status::unreachable);
  EXPECT_EQ(both.statuses[40], Status::left_domain);
  EXPECT_EQ(std::ranges::count(both.statuses, Status::converged), 62);
}

TEST(RodBatch, AnswersAlikeWhateverTheWorkspaceHeld) {
  const Robot robot = load("3pfs-g1").value();
  Workspace used(robot);
  ASSERT_TRUE(equilibrium(robot, {0.23, 0.2, 0.19}, {}, used).is_solved());
  for (const int count : {100, 41, 1}) {  // in seven lanes, and in one, others have nothing to do
    const std::vector<double> rows = walked_rows(count, 0.2076, 0.03);
    std::vector<SpatialPose> first(rows.size() / 3), second(first);
    std::vector<Status> statuses(first.size());
    Workspace fresh(robot);
    equilibrium_batch(robot, rows, SpatialWrench::Zero(), first, statuses, fresh);
    equilibrium_batch(robot, rows, SpatialWrench::Zero(), second, statuses, used);
    for (std::size_t k = 0; k < first.size(); ++k) {
      EXPECT_EQ(first[k].position, second[k].position) << k << " of " << count;
      EXPECT_EQ(first[k].quaternion, second[k].quaternion) << k << " of " << count;
    }
  }
}

/// From home, whatever the rows before are: statuses, poses and branches of a search of its own.
TEST(RodBatch, FromHomeFindsWhatASearchFromHomeFinds) {
  struct Rows {
    const char* name;
    double middle, reach, load;
  };
  int solved = 0, unsolved = 0;
  for (const auto& [name, middle, reach, load] :
       {Rows{"3pfs-g2", 0.4347, 0.02, 0}, Rows{"3pfs-g2", 0.4347, 0.15, 0}, Rows{"3pfs-g2", 0.4347, 0.4, 0},
        Rows{"3pfs-g1", 0.2076, 0.1, 0}, Rows{"3pfs-g2", 0.4347, 0.05, -20},
        Rows{"3pfs-g2", 0.4347, 0.02, -112}, Rows{"3pfs-g1", 0.2076, 0.05, -150}}) {
    const Robot robot = sinew::load(name).value();
    std::vector<double> rows = random_rows(160, middle, reach);
    rows[7] = std::nan(""), rows[11] = -1, rows[13] = 1e9, rows[17] = 0;
    SpatialWrench wrench;
    wrench << 0.1 * load, 0, load, 0, 0.001 * load, 0;
    Workspace work(robot), alone(robot);
    std::vector<SpatialPose> poses(160);
    std::vector<Status> statuses(160);
    std::vector<double> residuals(160);
    equilibrium_batch(robot, rows, wrench, poses, statuses, work, true, residuals, RowStart::home);
    for (std::size_t k = 0; k < 160; ++k) {
      const Equilibrium one =
          equilibrium(robot, std::span(rows).subspan(3 * k, 3), {.wrench = wrench}, alone);
      EXPECT_EQ(statuses[k], one.report.status) << name << reach << load << ", row " << k;
      EXPECT_EQ(std::isfinite(residuals[k]), one.is_solved()) << k;
      (one.is_solved() ? solved : unsolved) += 1;
      if (!one.is_solved() || statuses[k] != one.report.status) continue;
      EXPECT_LT((poses[k].position - one.pose.position).norm(), 1e-8)
          << name << reach << load << ", row " << k;
    }
  }
  EXPECT_GT(solved, 400);
  EXPECT_GT(unsolved, 20);
}

/// The stability of an equilibrium is a fact of its pose, whichever way it was found.
TEST(RodBatch, JudgesStabilityAsOneByOne) {
  int unstable = 0;  // where home leads to none that holds either
  for (const auto& [name, home, load_z, is_symmetric] : {std::tuple{"3pfs-g2", 0.4347, -105.0, false},
                                                         {"3pfs-g1", 0.2076, -185.0, false},
                                                         {"3pfs-g2", 0.4347, -115.0, true}}) {
    const Robot robot = load(name).value();
    Workspace work(robot), alone(robot);
    SpatialWrench wrench;
    wrench << 0.5, 0, load_z, 0, 0.1, 0;
    std::vector<double> rows = walked_rows(600, home, 0.02);
    if (is_symmetric) {  // the state in the middle goes on beyond the bifurcation, unstable
      wrench << 0, 0, load_z, 0, 0, 0;
      for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = home + 1e-5 * static_cast<double>(k / 3);
    }
    std::vector<SpatialPose> poses(600);
    std::vector<Status> statuses(600);
    equilibrium_batch(robot, rows, wrench, poses, statuses, work, true);
    int compared = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (statuses[k] != Status::converged && statuses[k] != Status::unstable) continue;
      const Equilibrium one =
          equilibrium(robot, std::span(rows).subspan(3 * k, 3), {.wrench = wrench, .start = poses[k]}, alone);
      if (!one.is_solved() || (one.pose.position - poses[k].position).norm() > 1e-9)
        continue;  // another branch
      ++compared;
      unstable += statuses[k] == Status::unstable;
      EXPECT_EQ(statuses[k], one.report.status) << name << load_z << ", row " << k;
    }
    EXPECT_GT(compared, 40) << name << load_z;
  }
  EXPECT_GT(unstable, 0);
}

}  // namespace rod_batch_test
}  // namespace sinew::test
