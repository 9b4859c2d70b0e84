/// Serial robots against tests/data/lsk, whose numbers come from another implementation in many digits.
#include <gtest/gtest.h>

#include "check_jacobian.hpp"
#include "serial_robots.hpp"

namespace sinew::test {
namespace serial_test {

using kernel::Model;

double number(const nlohmann::json& text) { return std::stod(text.get<std::string>()); }

class SerialReference : public testing::TestWithParam<int> {
 protected:
  SerialReference()
      : c(lsk_reference("references")["cases"][static_cast<std::size_t>(GetParam())]),
        robot(reference_robot(c)),
        bends(reference_bends(c, "q_rad")),
        work(robot) {}

  /// Largest difference from a list of changes [m].
  double change_error(const char* key) const {
    double worst = 0;
    std::size_t k = 0;
    for (const auto& section : c[key])
      for (const auto& change : section)
        worst = std::max(worst, std::abs(work.changes[k++] - number(change) * 1e-3));
    return worst;
  }
  /// Bends from the changes that stand in the workspace.
  double bend_error(Model model, const char* key) {
    const std::vector<double> changes = work.changes;
    bends_of_changes(robot, changes, model, work);
    const auto expected = reference_bends(c, key);
    double worst = 0;
    for (std::size_t m = 0; m < expected.size(); ++m)
      worst = std::max(worst, (work.bends[m] - expected[m]).lpNorm<Eigen::Infinity>());
    return worst;
  }

  nlohmann::json c;
  SerialRobot robot;
  std::vector<Bend> bends;
  SerialWorkspace work;
};

TEST_P(SerialReference, ChangesAreTheirs) {  // @verifies LSK (1), (2), (5), (7)-(9), (11)-(13), (15), (16)
  tendon_changes(bends, Model::exact, work);
  EXPECT_LT(change_error("dl_pcc_mm"), 1e-15);  // 1e-12 mm
  tendon_changes(bends, Model::linear, work);
  EXPECT_LT(change_error("dl_lsk_mm"), 1e-15);
}

TEST_P(SerialReference, BendsComeBack) {  // @verifies LSK (10)
  tendon_changes(bends, Model::linear, work);
  EXPECT_LT(bend_error(Model::linear, "lsk_inverse_of_dl_lsk"), 1e-13);
  tendon_changes(bends, Model::exact, work);
  EXPECT_LT(bend_error(Model::exact, "pcc_inverse_of_dl_pcc"), 1e-13);
  tendon_changes(bends, Model::exact, work);
  EXPECT_LT(bend_error(Model::linear, "lsk_inverse_of_dl_pcc"), 1e-13);
}

TEST_P(SerialReference, SectionsEndWhereTheirsDo) {  // @verifies LSK (3), (4)
  section_ends(bends, work);
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const auto& pose = c["section_end_pose"][m];
    const Mat<double, 3, 3> turn = work.ends[m].R.matrix();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(work.ends[m].p[i], number(pose[std::size_t(i)][3]) * 1e-3, 1e-15);
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(turn(i, j), number(pose[std::size_t(i)][std::size_t(j)]), 2e-14);
    }
  }
}

TEST_P(SerialReference, TipErrorOfLinearisedCommandsIsTheirs) {
  tendon_changes(bends, Model::exact, work);
  const std::vector<double> changes = work.changes;
  bends_of_changes(robot, changes, Model::linear, work);
  const std::vector<Bend> read = work.bends;
  section_ends(bends, work);
  const Vec3<double> tip = work.ends.back().p;
  section_ends(read, work);
  EXPECT_NEAR((work.ends.back().p - tip).norm(), number(c["tip_error_lsk_inverse_mm"]) * 1e-3, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Lsk, SerialReference, testing::Range(0, 12));

class SerialRobots : public testing::TestWithParam<std::tuple<kernel::Backbone, int>> {
 protected:
  SerialRobot robot = nottingham(std::get<0>(GetParam()), 5, std::get<1>(GetParam()), degrees(18));
  SerialWorkspace work{robot};
  std::mt19937 random{7};
};

TEST_P(SerialRobots, GoFromBendsToChangesAndBack) {
  for (int k = 0; k < 200; ++k) {
    auto bends = random_bends(robot, random);
    bends[static_cast<std::size_t>(k % 5)].setZero();  // through straight sections
    if (k % 3 == 0) bends[2] *= 1e-9;
    for (const Model model : {Model::exact, Model::linear}) {
      tendon_changes(bends, model, work);
      const std::vector<double> changes = work.changes;
      const Report report = bends_of_changes(robot, changes, model, work);
      EXPECT_TRUE(report.ok()) << to_string(report);
      for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_LT((work.bends[m] - bends[m]).norm(), 1e-12);
      for (const double slack : work.slack) EXPECT_LT(std::abs(slack), 1e-15);
    }
  }
}

TEST_P(SerialRobots, BatchesAreWhatSinglePosesAre) {
  for (const std::size_t poses : {1U, 3U, 8U, 21U}) {
    std::vector<double> bends(10 * poses), changes(work.changes.size() * poses);
    std::vector<std::vector<Bend>> each;
    for (std::size_t k = 0; k < poses; ++k) {
      each.push_back(random_bends(robot, random));
      if (k == 2) each.back()[1] = Bend(4, 3);  // beyond the series
      if (k == 1) each.back()[3].setZero();
      for (std::size_t m = 0; m < 5; ++m)
        for (std::size_t j = 0; j < 2; ++j)
          bends[(2 * m + j) * poses + k] = each[k][m][static_cast<Eigen::Index>(j)];
    }
    for (const Model model : {Model::exact, Model::linear}) {
      tendon_changes_batch(bends, model, changes, work);
      for (std::size_t k = 0; k < poses; ++k) {
        tendon_changes(each[k], model, work);
        for (std::size_t i = 0; i < work.changes.size(); ++i)
          EXPECT_NEAR(changes[i * poses + k], work.changes[i], 1e-17);
      }
    }
  }
}

TEST_P(SerialRobots, RatesAreDifferences) {
  for (int k = 0; k < 20; ++k) {
    auto bends = random_bends(robot, random);
    if (k < 5) bends[static_cast<std::size_t>(k)].setZero();
    if (k == 5) bends[1] *= 1e-8;
    for (const Model model : {Model::exact, Model::linear}) {
      tendon_rates(bends, model, work);
      const auto K = work.tendon_jacobian().eval();
      const double h = 1e-5;
      for (std::size_t j = 0; j < 2 * bends.size(); ++j) {
        auto ahead = bends, behind = bends;
        ahead[j / 2][static_cast<Eigen::Index>(j % 2)] += h;
        behind[j / 2][static_cast<Eigen::Index>(j % 2)] -= h;
        tendon_changes(ahead, model, work);
        const std::vector<double> more = work.changes;
        tendon_changes(behind, model, work);
        for (std::size_t i = 0; i < more.size(); ++i)
          EXPECT_NEAR(K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                      (more[i] - work.changes[i]) / (2 * h), 1e-11);
      }
    }
  }
}

TEST_P(SerialRobots, SayWhichTendonIsSlackOrTooShort) {  // [LSK] section 4.1
  robot.tolerance = 0.05e-3;
  const auto bends = random_bends(robot, random);
  const auto n = static_cast<std::size_t>(robot.sections[0].tendons);
  tendon_changes(bends, Model::exact, work);
  const std::vector<double> taut = work.changes;
  const auto report_of = [&](double change, bool all) {
    std::vector<double> changes = taut;
    for (std::size_t i = 0; i < n; ++i)
      if (all || i == 1) changes[2 * n + i] += change;
    return bends_of_changes(robot, changes, Model::exact, work);
  };
  EXPECT_TRUE(report_of(0.04e-3, true).ok());
  EXPECT_EQ(report_of(0.2e-3, true).status, Status::slack);
  EXPECT_NE(std::string(report_of(0.2e-3, true).message.view()).find("sections[2]"), std::string::npos);
  EXPECT_EQ(report_of(-0.2e-3, true).status, Status::unreachable);
  EXPECT_EQ(report_of(-0.4e-3, false).status, Status::unreachable);
  EXPECT_NE(std::string(report_of(-0.4e-3, false).message.view()).find("over-tensioned"), std::string::npos);
  std::vector<double> far = taut;
  far[0] -= 1;
  EXPECT_EQ(bends_of_changes(robot, far, Model::exact, work).status, Status::unreachable);
  for (const Bend& bend : work.bends) EXPECT_TRUE(bend.allFinite());
}

TEST_P(SerialRobots, AreSlackByWhatWasPaidOut) {
  const auto bends = random_bends(robot, random);
  const std::vector<double> more{0, 0.3e-3, 0, -0.1e-3, 0};
  tendon_changes(bends, Model::exact, work);
  add_slack(more, work);
  const std::vector<double> changes = work.changes;
  const Report report = bends_of_changes(robot, changes, Model::exact, work);
  EXPECT_EQ(report.status, Status::unreachable);  // section 3 is stiffened: no bend is exact
  std::size_t k = 0;
  for (std::size_t m = 0; m < 5; ++m) {
    EXPECT_LT((work.bends[m] - bends[m]).norm(), 1e-12);  // the common mode does not bend
    for (int i = 0; i < robot.sections[m].tendons; ++i) EXPECT_NEAR(work.slack[k++], more[m], 1e-15);
  }
}

TEST_P(SerialRobots, NameTheSectionBeyondItsLimit) {
  auto bends = random_bends(robot, random);
  EXPECT_TRUE(check_limits(robot, bends).ok());
  bends[3] = Bend(1.01 * robot.sections[3].limit, 0);
  const Report report = check_limits(robot, bends);
  EXPECT_EQ(report.status, Status::left_domain);
  EXPECT_EQ(report.message.view().substr(0, 11), "sections[3]");
}

INSTANTIATE_TEST_SUITE_P(Kinds, SerialRobots,
                         testing::Combine(testing::Values(kernel::Backbone::twin_pivot,
                                                          kernel::Backbone::neutral),
                                          testing::Values(3, 4, 6)));

TEST(SerialRobot, IsAsLongAsThePaperSays) { EXPECT_NEAR(nottingham().length(), 0.175, 1e-16); }

}  // namespace serial_test
}  // namespace sinew::test
