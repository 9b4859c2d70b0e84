/// Arms in the lanes of vector registers: the kernels beside those of one rod, by every instruction set, and
/// rows beside arm_forward.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <random>

#include "arms.hpp"
#include "kinematics/arms/arm_lanes.hpp"
#include "robot/arms/arm_model.hpp"
#include "strain/condense.hpp"
#include "strain/lanes.hpp"
#include "strain/relax.hpp"
#include "strain/sweep.hpp"

namespace sinew::test {
namespace arm_lanes_test {

using strain::lane_count;
using strain::LaneWork;
using strain::RodModel;
using strain::RodWork;

struct Basis {
  ArmModel model;
  int order, elements;
};

/// Every lane has its own coordinates, tensions and force.
void fill(const RodModel& model, LaneWork& lanes, double size) {
  std::mt19937 gen(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (auto& y : lanes.y)
    for (double& x : y.of) x = size * std::sqrt(model.energy_scale) * any(gen);
  for (auto& tension : lanes.tensions)
    for (double& x : tension.of) x = 2 + 1.5 * any(gen);
  for (auto& force : lanes.tip_force)
    for (double& x : force.of) x = 0.05 * any(gen);
  for (std::size_t k = 1; k < lanes.loads.size(); ++k) {
    for (double& x : lanes.loads[k].force) x = 0.01 * any(gen);
    for (double& x : lanes.loads[k].couple) x = 1e-5 * any(gen);
  }
}

void copy_lane(const LaneWork& lanes, int lane, const RodModel& model, RodWork& one) {
  for (std::size_t i = 0; i < one.y.size(); ++i) one.y[i] = lanes.y[i][lane];
  one.loads = lanes.loads;
  for (std::size_t i = 0; i < 3; ++i) one.loads.back().force[i] += lanes.tip_force[i][lane];
  for (std::size_t i = 0; i < model.holes.size(); ++i)
    one.hole_tension[i] = lanes.tensions[static_cast<std::size_t>(model.holes[i].tendon)][lane];
  for (std::size_t i = 0; i < model.guides.size(); ++i)
    one.guide_tension[i] = lanes.tensions[static_cast<std::size_t>(model.guides[i].tendon)][lane];
}

void compare_with_one_rod(const Arm& arm, const Basis& basis) {
  const RodModel model = make_rod(arm, {basis.model, basis.order, basis.elements, false});
  ASSERT_TRUE(strain::fits_lanes(model));
  LaneWork lanes(model);
  fill(model, lanes, 0.1);
  sweep_out(model, lanes);
  sweep_back(model, lanes);
  const auto gradient = lanes.gradient;
  sweep_back_and_factor(model, lanes, {});
  const auto sides = [&](std::size_t i, int lane) {
    return std::sin(1.0 + static_cast<double>(i) * (lane + 1));
  };
  for (std::size_t i = 0; i < lanes.side.size(); ++i)
    for (int l = 0; l < lane_count; ++l) lanes.side[i][l] = sides(i, l);
  solve(model, lanes);
  for (int l = 0; l < lane_count; ++l) {
    RodWork one(model);
    copy_lane(lanes, l, model, one);
    sweep_out(model, one);
    EXPECT_NEAR(lanes.energy[l], one.energy, 1e-12 * (1 + std::abs(one.energy)));
    for (std::size_t i = 0; i < one.lengths.size(); ++i)
      EXPECT_NEAR(lanes.lengths[i][l], one.lengths[i], 1e-14);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(lanes.tip[i][l], one.frames.back().p[i], 1e-13);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(lanes.tip[i + 3][l], one.frames.back().R[i], 1e-13);
    sweep_back_with_hessian(model, one);
    double most = 0, apart = 0, twice = 0;
    for (std::size_t i = 0; i < one.gradient.size(); ++i) {
      most = std::max(most, std::abs(one.gradient[i]));
      apart = std::max(apart, std::abs(one.gradient[i] - gradient[i][l]));
      twice = std::max(twice, std::abs(lanes.gradient[i][l] - gradient[i][l]));
    }
    EXPECT_LT(apart, 1e-12 * (1 + most)) << l;
    EXPECT_LT(twice, 1e-12 * (1 + most)) << l;
    const strain::Inertia inertia = factor(model, one, 0);
    ASSERT_TRUE(inertia.ok);
    EXPECT_EQ(inertia.negative == 0, lanes.smallest_pivot[l] > 0) << l;
    std::vector<double> x(8 * one.y.size());
    for (std::size_t i = 0; i < one.y.size(); ++i) x[8 * i] = sides(i, l);
    solve(model, one, x.data(), 1, 8);
    double size = 0, off = 0;
    for (std::size_t i = 0; i < one.y.size(); ++i) {
      size = std::max(size, std::abs(x[8 * i]));
      off = std::max(off, std::abs(x[8 * i] - lanes.side[i][l]));
    }
    EXPECT_LT(off, 1e-9 * size) << l;
  }
}

/// Of each instruction set that this machine has.
template <class Check>
void by_every_instruction_set(Check check) {
  for (const std::int64_t set : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(set);
    check(hwy::TargetName(set));
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(ArmLanes, KernelsMeetThoseOfOneRod) {
  by_every_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    compare_with_one_rod(two_sections(3), {ArmModel::subsegment_rod, 3, 3});
    compare_with_one_rod(two_sections(3), {ArmModel::subsegment_rod, -1, 2});
    compare_with_one_rod(two_sections(3), {ArmModel::subsegment_cc, -1, 0});
    compare_with_one_rod(two_sections(3), {ArmModel::cc, -1, 0});
    compare_with_one_rod(two_sections(3), {ArmModel::rod, 5, 6});
    compare_with_one_rod(tendon_rod(), {ArmModel::rod, -1, 4});
  });
}

struct Row {
  std::vector<double> tensions;
  std::array<double, 6> wrench{};
  bool is_asked = true;
};
struct Answer {
  int told = 0;
  bool has_state = false;
  ArmState state;
};

std::vector<Answer> in_lanes(ArmLanes& lanes, const std::vector<Row>& rows, std::size_t stretch) {
  std::vector<Answer> answers(rows.size());
  lanes.solve(
      rows.size(), stretch,
      [&](std::size_t k, std::span<TendonCommand> commands, ArmLoad& load) {
        const auto held = tensions(rows[k].tensions);
        std::copy(held.begin(), held.end(), commands.begin());
        load.wrench = rows[k].wrench;
        return rows[k].is_asked;
      },
      [&](std::size_t k, const ArmState* state) {
        ++answers[k].told;
        answers[k].has_state = state != nullptr;
        if (state) answers[k].state = *state;
      },
      {});
  return answers;
}

std::vector<Row> some_rows(std::size_t count, double most, unsigned seed) {
  std::mt19937 gen(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Row> rows(count);
  for (Row& row : rows) {
    for (int i = 0; i < 6; ++i) row.tensions.push_back(most * share(gen));
    for (std::size_t i = 0; i < 3; ++i) row.wrench[i] = 0.1 * (share(gen) - 0.5);
  }
  return rows;
}

/// The scalar answers, where they tell the same as in lanes; those of rows that lanes leave to it as well.
void expect_as_alone(const Arm& arm, const ArmOptions& options, const std::vector<Row>& rows) {
  ArmLanes lanes(arm, options);
  const auto answers = in_lanes(lanes, rows, 1);
  ArmWorkspace work(arm);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(answers[k].told, 1) << k;
    ASSERT_EQ(answers[k].has_state, rows[k].is_asked) << k;
    if (!rows[k].is_asked) continue;
    ArmLoad load;
    load.wrench = rows[k].wrench;
    const ArmState &one = arm_forward(arm, tensions(rows[k].tensions), load, options, work),
                   &many = answers[k].state;
    ASSERT_EQ(to_string(many.report.status), to_string(one.report.status)) << k;
    if (!one.report.ok()) continue;
    EXPECT_LE(many.report.residual, options.tolerance) << k;
    EXPECT_LT((many.tip.p - one.tip.p).norm(), 1e-9) << k;
    EXPECT_LT((many.tip.R.matrix() - one.tip.R.matrix()).norm(), 1e-8) << k;
    EXPECT_NEAR(many.resolution, one.resolution, 0.02 * one.resolution + 1e-12) << k;
    EXPECT_EQ(many.coordinates, one.coordinates) << k;
    EXPECT_NEAR(many.energy, one.energy, 1e-10) << k;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(many.changes[i], one.changes[i], 1e-9) << k;
      EXPECT_EQ(many.tensions[i], one.tensions[i]) << k;
      EXPECT_EQ(many.slack[i], 0) << k;
    }
  }
}

TEST(ArmLanes, RowsAreAsTheyAreAlone) {
  Arm arm = two_sections(5, 1e-4);
  arm.gravity = {0, 0, -9.81};
  auto rows = some_rows(60, 4, 1);
  rows[7].is_asked = false;
  rows[20].tensions[2] = -1;                 // bad input
  rows[21].wrench[4] = 0.002;                // no potential
  rows[22].tensions = {40, 0, 0, 35, 0, 0};  // bends beyond what Newton's steps alone follow
  rows[23].tensions = {60, 60, 60, 60, 60, 60};
  for (const ArmModel model :
       {ArmModel::subsegment_rod, ArmModel::rod, ArmModel::subsegment_cc, ArmModel::cc})
    expect_as_alone(arm, {.model = model}, rows);
  expect_as_alone(arm, {.accuracy = 1e-8}, some_rows(20, 4, 3));
  expect_as_alone(arm, {.accuracy = 0}, rows);
}

/// Straight columns under a force from the tip to the base, up to twice what buckles them: their equilibria
/// are saddles, and lanes must not take them for answers.
TEST(ArmLanes, ColumnsBuckleAsTheyDoAlone) {
  const Arm arm = two_sections(5);
  std::vector<Row> rows;
  for (int k = 0; k < 24; ++k)
    rows.push_back({.tensions = std::vector<double>(6, 0.0), .wrench = {1e-4, 0, -0.12 * k, 0, 0, 0}});
  expect_as_alone(arm, {.model = ArmModel::rod}, rows);
}

/// A row has the same bytes whoever is beside it and in whatever order rows come.
TEST(ArmLanes, NoRowDependsOnItsNeighbours) {
  const Arm arm = two_sections(4, 1e-4);
  auto rows = some_rows(37, 4, 2);
  ArmLanes lanes(arm, {});
  const auto together = in_lanes(lanes, rows, 1);
  std::vector<Row> turned(rows.rbegin(), rows.rend());
  turned.insert(turned.begin(), {.tensions = {30, 0, 0, 30, 0, 0}});
  const auto otherwise = in_lanes(lanes, turned, 1);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto alone = in_lanes(lanes, {rows[k]}, 1);
    for (const Answer& other : {otherwise[rows.size() - k], alone[0]}) {
      const Answer& one = together[k];
      EXPECT_EQ(0, std::memcmp(one.state.tip.p.data(), other.state.tip.p.data(), 3 * sizeof(double))) << k;
      EXPECT_EQ(one.state.resolution, other.state.resolution) << k;
      EXPECT_EQ(one.state.report.residual, other.state.report.residual) << k;
      EXPECT_EQ(one.state.report.iterations, other.state.report.iterations) << k;
    }
  }
}

/// On a path rows begin where the one before ended; after one that is refused, or has no answer, anew.
TEST(ArmLanes, PathsMeetTheSameEquilibria) {
  const Arm arm = two_sections(4, 1e-4);
  std::vector<Row> rows(150);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < 6; ++i)
      rows[k].tensions.push_back(1.5 + 1.4 * std::sin(0.03 * static_cast<double>((i + 1) * k + i)));
  rows[40].is_asked = false;
  rows[70].tensions[1] = -2;
  rows[90].wrench[5] = 1e-3;  // by itself, and the next one from there
  ArmLanes lanes(arm, {});
  const auto path = in_lanes(lanes, rows, 16);
  ArmWorkspace work(arm);
  int first = 0, later = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(path[k].told, 1) << k;
    if (k == 40 || k == 70) {
      EXPECT_TRUE(!path[k].has_state || path[k].state.report.status == Status::bad_input) << k;
      continue;
    }
    ArmLoad load;
    load.wrench = rows[k].wrench;
    const ArmState& one = arm_forward(arm, tensions(rows[k].tensions), load, {}, work);
    ASSERT_TRUE(one.report.ok() && path[k].state.report.ok()) << k;
    EXPECT_LT((path[k].state.tip.p - one.tip.p).norm(), 2e-6 * arm.length()) << k;
    (k % 16 == 0 ? first : later) += path[k].state.report.iterations;
  }
  EXPECT_GT(8 * first, later);  // of 10 and 138 rows: those that follow take fewer steps
}

TEST(ArmLanes, StopsWhenAsked) {
  const Arm arm = two_sections(4);
  ArmLanes lanes(arm, {});
  const std::atomic<bool> now{true};
  const auto rows = some_rows(20, 3, 6);
  int told = 0;
  lanes.solve(
      rows.size(), 1, [&](std::size_t, std::span<TendonCommand>, ArmLoad&) { return true; },
      [&](std::size_t, const ArmState*) { ++told; }, StopToken(now));
  EXPECT_EQ(told, 0);
}

}  // namespace arm_lanes_test
}  // namespace sinew::test
