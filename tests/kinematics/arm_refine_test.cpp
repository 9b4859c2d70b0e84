/// How arms are refined: Newton's steps by the Hessian of fewer elements, the way to a finer rod by gradients
/// alone, and what both say of the answer.
#include <gtest/gtest.h>

#include <random>

#include "arms.hpp"
#include "robot/arms/arm_model.hpp"
#include "strain/relax.hpp"

namespace sinew::test {
namespace arm_refine_test {

using strain::LoadedRod;
using strain::RodModel;

RodModel rod_of(const Arm& arm, int order, int elements) {
  return make_rod(arm, {ArmModel::subsegment_rod, order, elements, false});
}

void set(LoadedRod& rod, const std::vector<double>& tensions, const std::array<double, 3>& tip_force) {
  for (std::size_t i = 0; i < tensions.size(); ++i) rod.holds[i].tension = tensions[i];
  for (std::size_t i = 0; i < 3; ++i) rod.work().loads.back().force[i] = tip_force[i];
}

double tip_apart(const LoadedRod& a, const LoadedRod& b) {
  const double *p = a.work().frames.back().p, *q = b.work().frames.back().p;
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Whoever leans on a coarse Hessian ends at the same equilibrium.
TEST(ArmRefine, TheHessianOfFewerElementsLeavesTheAnswer) {
  const Arm arm = two_sections(4, 1e-4);
  const RodModel fine = rod_of(arm, 3, 8), coarse = rod_of(arm, 3, 2);
  std::mt19937 gen(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 12; ++round) {
    LoadedRod own(fine), leaning(fine), lean(coarse);
    std::vector<double> pulls(6);
    for (double& pull : pulls) pull = (round < 8 ? 3 : 15) * share(gen);
    const std::array<double, 3> force{0.1 * share(gen), 0.1 * share(gen), -0.05};
    for (LoadedRod* rod : {&own, &leaning, &lean}) {
      set(*rod, pulls, force);
      if (round % 2 == 1)
        for (std::size_t i = 0; i < 3; ++i)  // the first section's by their ends
          rod->holds[i] = {
              .by_tension = false, .free_length = 0.198 + 0.001 * static_cast<double>(i), .compliance = 1e-4};
    }
    leaning.lean_on(lean);
    const auto alone = own.relax({}), with = leaning.relax({});
    EXPECT_EQ(alone.status, with.status) << round;
    EXPECT_EQ(alone.negative, with.negative) << round;
    if (alone.status != Status::converged) continue;
    EXPECT_LT(with.residual, 1e-10) << round;
    EXPECT_LT(tip_apart(own, leaning), 1e-9) << round;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(own.tensions()[i], leaning.tensions()[i], 1e-6) << round;
  }
}

/// A straight arm under an axial force: which force buckles it is for its own Hessian to say.
TEST(ArmRefine, BucklingIsToldAsWithoutIt) {
  const Arm arm = two_sections(4);
  const RodModel fine = rod_of(arm, 3, 8), coarse = rod_of(arm, 3, 2);
  const double bending = arm.sections[0].start.bending_x, length = arm.length(),
               critical = std::numbers::pi * std::numbers::pi * bending / (4 * length * length);
  for (const double share : {0.5, 0.99, 0.999, 1.001, 1.01, 1.5}) {
    LoadedRod rod(fine), lean(coarse);
    rod.lean_on(lean);
    for (LoadedRod* each : {&rod, &lean}) set(*each, std::vector<double>(6, 0.0), {0, 0, -share * critical});
    strain::RelaxOptions options;
    options.leave_saddles = false;
    options.max_iterations = 60;  // loads are not grown then
    const auto found = rod.relax(options);
    EXPECT_EQ(found.negative > 0, share > 1) << share;
    EXPECT_EQ(found.status, share > 1 ? Status::unstable : Status::converged) << share;
  }
}

/// A smooth load on strongly bent sections, against twice the elements of the highest order.
TEST(ArmRefine, EachOrderIsNearerThanTheOneBefore) {
  const Arm arm = two_sections(5, 1e-4);
  const ArmLoad load{.wrench = {0.1, 0.15, -0.1}, .along = {0.2, 0, 0.1}};
  const auto tip = [&](const ArmOptions& options) {
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, tensions({4, 0, 0, 0, 2, 0}), load, options, work);
    EXPECT_TRUE(state.report.ok()) << options.order << " " << state.report.message.view();
    return state.tip.p;
  };
  const auto fine = tip({.order = 9, .elements = 100, .tolerance = 1e-12});
  double before = 1;
  for (int order = 0; order <= 9; ++order) {
    const double off = (tip({.order = order, .tolerance = 1e-12}) - fine).norm() / arm.length();
    EXPECT_LT(off, 0.5 * before) << order;
    before = off;
  }
  EXPECT_LT(before, 1e-9);
}

/// Whatever the elements: as many coefficients as they have Gauss points at most, or a word.
TEST(ArmRefine, OrdersThatElementsDoNotTellAreRefused) {
  const Arm arm = two_sections(4);
  for (const ArmModel model : {ArmModel::rod, ArmModel::subsegment_rod})
    for (int elements = 1; elements <= 4; ++elements)
      for (int order = -1; order <= 9; ++order) {
        const ArmOptions options{.model = model, .order = order, .elements = elements};
        ArmWorkspace work(arm);
        const ArmState state = arm_forward(arm, tensions({0, 0, 0, 0, 0, 0}), {}, options, work);
        EXPECT_EQ(state.report.status, order < 2 * elements ? Status::converged : Status::bad_input)
            << order << " " << elements << " " << state.report.message.view();
      }
  ArmWorkspace work(arm);
  const ArmOptions options{.order = 6, .elements = 2};
  EXPECT_EQ(
      arm_inverse(arm, {.position = std::array{0.05, 0.03, 0.38}}, {}, {.arm = options}, work).report.status,
      Status::bad_input);
  ArmMeasurement seen;
  seen.held = tensions({1, 0, 0, 0, 0, 0});
  seen.tip = {0.05, 0.03, 0.38};
  EXPECT_EQ(arm_sense(arm, seen, {}, true, options, work).report.status, Status::bad_input);
}

TEST(ArmRefine, GradientsAloneTellHowFarTheFinerTipIs) {
  const Arm arm = two_sections(6, 1e-4);
  const RodModel coarse = rod_of(arm, -1, 2), fine = rod_of(arm, 3, 3);
  ASSERT_TRUE(is_within(coarse, fine));
  EXPECT_FALSE(is_within(fine, coarse));
  EXPECT_FALSE(is_within(rod_of(two_sections(5), -1, 2), fine));
  std::mt19937 gen(5);
  std::uniform_real_distribution<double> share(0, 1);
  int close = 0;
  for (int round = 0; round < 20; ++round) {
    LoadedRod rough(coarse), finer(fine), solved(fine);
    std::vector<double> pulls(6);
    for (double& pull : pulls) pull = 4 * share(gen);
    for (LoadedRod* rod : {&rough, &finer, &solved}) {
      set(*rod, pulls, {0.05, 0.02, -0.03});
      if (round % 2 == 1) rod->holds[4] = {.by_tension = false, .free_length = 0.397, .compliance = 1e-4};
    }
    ASSERT_EQ(rough.relax({}).status, Status::converged);
    ASSERT_EQ(solved.relax({}).status, Status::converged);
    const strain::Approach found = finer.approach(rough, 0);
    if (!found.close) continue;
    ++close;
    const double moved = tip_apart(rough, solved);
    EXPECT_GE(found.moved, 0.99 * moved) << round;
    EXPECT_LE(found.moved, 1.12 * moved) << round;
    EXPECT_LE(tip_apart(finer, solved), 0.06 * moved) << round;
  }
  EXPECT_GE(close, 15);
}

/// What is said of the tip's resolution holds against a rod far finer.
TEST(ArmRefine, ResolutionCoversTheError) {
  std::mt19937 gen(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 8; ++round) {
    const Arm arm = two_sections(10, 1e-4);
    std::vector<double> pulls(6);
    for (double& pull : pulls) pull = (round < 6 ? 4 : 10) * share(gen);
    ArmLoad load;
    load.wrench = {0.05 * share(gen), 0.02, -0.05 * share(gen), 0, 0, 0};
    ArmWorkspace best(arm);
    const ArmState exact =
        arm_forward(arm, tensions(pulls), load, {.order = 7, .elements = 28, .accuracy = 0}, best);
    ASSERT_TRUE(exact.report.ok());
    for (const double accuracy : {1e-4, 1e-6, 1e-7, 1e-8}) {
      ArmWorkspace work(arm);
      const ArmState state = arm_forward(arm, tensions(pulls), load, {.accuracy = accuracy}, work);
      ASSERT_TRUE(state.report.ok()) << accuracy;
      const double off = (state.tip.p - exact.tip.p).norm();
      EXPECT_LE(off, 1.3 * state.resolution + 3e-12) << round << " " << accuracy;
      if (round < 6 && accuracy >= 1e-7) {
        EXPECT_LE(state.resolution, accuracy * arm.length()) << round << " " << accuracy;
      }
    }
  }
}

/// An arm that is asked on and on, at tensions that grow and fall, is resolved as one that begins anew, and
/// by no more than it then needs.
TEST(ArmRefine, WarmAnswersAreResolvedToo) {
  const Arm arm = two_sections(10, 1e-4);
  ArmWorkspace warm(arm), best(arm);
  ArmLoad load;
  load.wrench = {0.03, 0.02, -0.02, 0, 0, 0};
  int most = 0, last = 0;
  for (int k = 0; k <= 40; ++k) {
    const double size = 0.3 + 9 * std::pow(std::sin(std::numbers::pi * k / 40), 2);
    const auto commands = tensions({size, 0.2 * size, 0, 0.1, 0.6 * size, 0.2});
    const ArmState state = arm_forward(arm, commands, load, {.from_last = k > 0}, warm);
    const ArmState exact = arm_forward(arm, commands, load,
                                       {.order = 7, .elements = 24, .accuracy = 0, .from_last = k > 0}, best);
    ASSERT_TRUE(state.report.ok() && exact.report.ok()) << k;
    EXPECT_LE((state.tip.p - exact.tip.p).norm(), 1.3e-6 * arm.length()) << k;
    EXPECT_TRUE(std::isfinite(state.resolution)) << k;
    most = std::max(most, state.coordinates);
    last = state.coordinates;
  }
  EXPECT_GT(most, last);
  EXPECT_EQ(last, 300);
}

/// On a walk the tip's error passes through zero, where coarse polynomials seem to do, and grows again while
/// the shape hardly changes: it is looked at again before it is too large.
TEST(ArmRefine, WarmWalksKeepWhatWasAsked) {
  const Arm arm = two_sections(10);
  const auto walk = [&](int k) {
    std::vector<double> pulls;
    for (int i = 0; i < 6; ++i)
      pulls.push_back(2 + 1.9 * std::sin(2 * std::numbers::pi * (i + 1) * k / 2048 + i));
    return tensions(pulls);
  };
  struct Part {
    int first, last;
    double accuracy;
  };
  for (const Part& part :
       {Part{704, 760, 1e-6}, Part{1420, 1490, 1e-6}, Part{1700, 1850, 1e-7}, Part{700, 740, 1e-8}}) {
    ArmWorkspace warm(arm), best(arm);
    for (int k = part.first; k <= part.last; ++k) {
      const bool follows = k > part.first;
      const ArmState state =
          arm_forward(arm, walk(k), {}, {.accuracy = part.accuracy, .from_last = follows}, warm);
      ASSERT_TRUE(state.report.ok()) << k;
      EXPECT_LE(state.resolution, part.accuracy * arm.length()) << k;
      if ((k - part.first) % 5 > 0) continue;
      const ArmState exact = arm_forward(
          arm, walk(k), {}, {.order = 7, .elements = 24, .accuracy = 0, .from_last = follows}, best);
      ASSERT_TRUE(exact.report.ok()) << k;
      const double off = (state.tip.p - exact.tip.p).norm();
      EXPECT_LE(off, 1.1 * part.accuracy * arm.length()) << k;
      EXPECT_LE(off, 1.25 * state.resolution + 1e-11) << k;
    }
  }
}

/// More tendons through a disc than a register has lanes.
TEST(ArmRefine, GradientsOfLengthsAgainstDifferences) {
  Arm arm = two_sections(3);
  for (int i = 0; i < 7; ++i) arm.tendons.push_back(tendon_at(1, 0.008, 0.9 * i, 1e-4));
  const RodModel model = rod_of(arm, 2, 2);
  LoadedRod rod(model);
  for (std::size_t i = 0; i < rod.holds.size(); ++i) rod.holds[i].tension = 0.3;
  std::mt19937 gen(2);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<double>& y = rod.work().y;
  for (double& x : y) x = 0.05 * share(gen);
  rod.evaluate();
  rod.linearise(false);
  const std::vector<double> by_gradient = rod.work().length_gradient;
  rod.linearise(true);
  for (std::size_t i = 0; i < by_gradient.size(); ++i)
    EXPECT_NEAR(rod.work().length_gradient[i], by_gradient[i], 1e-13);
  for (std::size_t k = 0; k < y.size(); k += 5) {
    const double at = y[k], h = 1e-5;
    y[k] = at + h;
    rod.evaluate();
    const std::vector<double> more = rod.work().lengths;
    y[k] = at - h;
    rod.evaluate();
    for (std::size_t i = 0; i < more.size(); ++i)
      EXPECT_NEAR(by_gradient[i * y.size() + k], (more[i] - rod.work().lengths[i]) / (2 * h), 1e-8);
    y[k] = at;
  }
}

/// One column and eight are solved by other loops.
TEST(ArmRefine, OneSideIsSolvedAsEight) {
  const Arm arm = two_sections(5);
  for (const bool follows : {false, true}) {
    const RodModel model = rod_of(arm, 3, 3);
    LoadedRod rod(model);
    set(rod, {2, 1, 0, 0.5, 0, 1}, {0.03, 0, 0});
    if (follows) rod.work().loads.back().following[0] = 0.1;
    rod.relax({});
    rod.linearise(true);
    ASSERT_EQ(rod.factor_all(0), 0);
    std::mt19937 gen(4);
    std::uniform_real_distribution<double> share(-1, 1);
    const auto n = static_cast<std::size_t>(model.size);
    std::vector<double> one(n * 8), eight(n * 8);
    for (std::size_t i = 0; i < n; ++i) one[8 * i] = eight[8 * i] = share(gen);
    rod.solve_all(one, 1, 8);
    rod.solve_all(eight, 8, 8);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(one[8 * i], eight[8 * i], 1e-12) << i;
  }
}

/// The weight of a round taper is a square of the place: it is summed to fourth order like all else, so that
/// the error that a coarse arm tells is the one that it has.
TEST(ArmRefine, TaperedArmsConvergeWithTheFourthPower) {
  Arm arm = two_sections(5);
  for (ArmSection& section : arm.sections) {
    section.start = round_section({54e9, 54e9 / 2.6, 8000}, 0.0014);
    section.end = round_section({54e9, 54e9 / 2.6, 8000}, 0.0008);
    section.round_taper = true;
  }
  arm.gravity = {9.81, 0, 0};
  const auto held = tensions({1, 0, 0, 0.5, 0, 0});
  const auto tip = [&](int elements) {
    ArmWorkspace work(arm);
    return arm_forward(arm, held, {}, {.order = 5, .elements = elements, .accuracy = 0}, work).tip.p;
  };
  const auto fine = tip(24);
  const double at_2 = (tip(2) - fine).norm(), at_4 = (tip(4) - fine).norm();
  EXPECT_GT(at_2 / at_4, 12);
  ArmWorkspace work(arm);
  const ArmState usual = arm_forward(arm, held, {}, {}, work);
  EXPECT_NEAR(usual.resolution / (usual.tip.p - fine).norm(), 1, 0.2);
}

}  // namespace arm_refine_test
}  // namespace sinew::test
