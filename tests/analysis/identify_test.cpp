/// Identification of arms: sensitivities against differences, arms that are known found again, and two
/// measured ones (data/measured/).
#include "sinew/analysis/identify.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

#include "analysis/identify/arm_rows.hpp"
#include "cpu_time.hpp"
#include "measured_arms.hpp"
#include "sanitizers.hpp"

namespace sinew::test {
namespace identify_test {

constexpr double pi = std::numbers::pi;

/// Two sections of five discs, or with tendons in channels; nothing of it is symmetric.
MeasuredArm some_arm(int discs = 5) {
  MeasuredArm a;
  for (int m = 0; m < 2; ++m) {
    ArmSection section;
    section.length = 0.1 + 0.02 * m;
    section.start = section.end = round_section({50e9, 19e9, 6450}, 1e-3);
    section.end.bending_x *= 0.9;
    section.curvature = {0.4, -0.3, 0.2};
    section.discs = {.count = discs, .mass = 2e-3, .radius = 0.008};
    a.arm.sections.push_back(section);
  }
  for (int i = 0; i < 6; ++i) {
    ArmTendon tendon;
    const double angle = 0.3 + 2 * pi / 3 * (i % 3) + 0.4 * (i / 3);
    for (int m = 0; m <= i / 3; ++m) tendon.routes.push_back({0.006, 0.0055, angle, angle + 0.2});
    tendon.compliance = 2e-4 * (1 + 0.1 * i);
    tendon.pretension = 1;
    a.arm.tendons.push_back(tendon);
  }
  a.arm.gravity = {3, -9, 1};
  a.arm.tip_mass = 3e-3;
  a.arm.tip_mass_place = {1e-3, 0, 4e-3};
  a.drive = {.gain = std::vector<double>(6, 1.02),
             .offset = std::vector<double>(6, 3e-4),
             .toe = std::vector<double>(6, 5e-4),
             .lag = 0.1,
             .play = 1e-4};
  a.marker = {.place = {1e-3, 2e-3, 8e-3}, .base = {1e-3, 0, -2e-3}, .tilt = {0.1, -0.2, 0.15}};
  return a;
}

/// A derivative of the marker's place against that by four solves.
void expect_derivative(const MeasuredArm& arm, ArmModel model, int field, double step,
                       const std::function<void(MeasuredArm&, std::vector<double>&, double)>& change) {
  const auto marker = [&](double by, Eigen::Matrix3Xd* fields) -> Eigen::Vector3d {
    MeasuredArm there = arm;
    ArmRows rows(arm, {.model = model});
    std::vector<double> free;
    for (std::size_t i = 0; i < arm.arm.tendons.size(); ++i) free.push_back(0);
    change(there, free, by);
    rows.tolerance = 1e-13;
    rows.set(there);
    for (std::size_t i = 0; i < free.size(); ++i)
      free[i] += rows.straight_length(static_cast<int>(i)) -
                 1e-3 * (i % 3 == 0 ? 3
                         : i == 4   ? -9
                                    : 0.3) -
                 there.arm.tendons[i].compliance * there.arm.tendons[i].pretension;
    std::vector<double> y(static_cast<std::size_t>(rows.size()), 0.0);
    EXPECT_EQ(rows.solve(free, y), Status::converged);
    EXPECT_GT(rows.slack(4), 0);
    if (fields) rows.sensitivities(*fields);
    return rows.marker();
  };
  Eigen::Matrix3Xd fields;
  marker(0, &fields);
  const Eigen::Vector3d difference = (8 * (marker(step, nullptr) - marker(-step, nullptr)) -
                                      marker(2 * step, nullptr) + marker(-2 * step, nullptr)) /
                                     (12 * step);
  EXPECT_LT((fields.col(field) - difference).norm(), 1e-6 * difference.norm() + 1e-9)
      << "model " << static_cast<int>(model) << " field " << field << ": " << fields.col(field).transpose()
      << " against " << difference.transpose();
}

TEST(ArmRows, SensitivitiesAreThoseOfSolves) {
  for (const int discs : {5, 0})
    for (const ArmModel model : {ArmModel::cc, ArmModel::subsegment_rod, ArmModel::rod}) {
      if (discs == 0 && model == ArmModel::subsegment_rod) continue;
      const MeasuredArm arm = some_arm(discs);
      const ArmFields f(arm.arm);
      using Numbers = std::vector<double>;
      const auto ends = [](double CrossSection::*member, int m) {
        return [=](MeasuredArm& a, Numbers&, double by) {
          a.arm.sections[static_cast<std::size_t>(m)].start.*member *= std::exp(by);
          a.arm.sections[static_cast<std::size_t>(m)].end.*member *= std::exp(by);
        };
      };
      for (int m = 0; m < 2; ++m) {
        const auto section = static_cast<std::size_t>(m);
        expect_derivative(arm, model, f.bending_x(m), 1e-3, ends(&CrossSection::bending_x, m));
        expect_derivative(arm, model, f.bending_y(m), 1e-3, ends(&CrossSection::bending_y, m));
        expect_derivative(arm, model, f.torsion(m), 1e-3, ends(&CrossSection::torsion, m));
        for (int axis = 0; axis < 3; ++axis)
          expect_derivative(arm, model, f.curvature(m, axis), 1e-3, [=](MeasuredArm& a, Numbers&, double by) {
            a.arm.sections[section].curvature[static_cast<std::size_t>(axis)] += by;
          });
      }
      for (const auto& [tendon, m] : {std::pair{0, 0}, std::pair{3, 0}, std::pair{3, 1}}) {
        const auto i = static_cast<std::size_t>(tendon), section = static_cast<std::size_t>(m);
        expect_derivative(arm, model, f.angle(tendon, m), 1e-3, [=](MeasuredArm& a, Numbers&, double by) {
          a.arm.tendons[i].routes[section].start_angle += by;
          a.arm.tendons[i].routes[section].end_angle += by;
        });
        expect_derivative(arm, model, f.radius(tendon, m), 1e-3, [=](MeasuredArm& a, Numbers&, double by) {
          a.arm.tendons[i].routes[section].start_radius *= std::exp(by);
          a.arm.tendons[i].routes[section].end_radius *= std::exp(by);
        });
        expect_derivative(arm, model, f.free_length(tendon), 1e-5,
                          [=](MeasuredArm&, Numbers& free, double by) { free[i] += by; });
        expect_derivative(arm, model, f.compliance(tendon), 1e-3, [=](MeasuredArm& a, Numbers&, double by) {
          a.arm.tendons[i].compliance *= std::exp(by);
        });
        expect_derivative(arm, model, f.toe(tendon), 1e-6,
                          [=](MeasuredArm& a, Numbers&, double by) { a.drive.toe[i] += by; });
      }
      for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        expect_derivative(arm, model, f.gravity(axis), 1e-2,
                          [=](MeasuredArm& a, Numbers&, double by) { a.arm.gravity[k] += by; });
        expect_derivative(arm, model, f.marker(axis), 1e-3,
                          [=](MeasuredArm& a, Numbers&, double by) { a.marker.place[k] += by; });
        expect_derivative(arm, model, f.base(axis), 1e-3,
                          [=](MeasuredArm& a, Numbers&, double by) { a.marker.base[k] += by; });
        expect_derivative(arm, model, f.tilt(axis), 1e-3,
                          [=](MeasuredArm& a, Numbers&, double by) { a.marker.tilt[k] += by; });
      }
      expect_derivative(arm, model, f.tip_mass(), 1e-6,
                        [](MeasuredArm& a, Numbers&, double by) { a.arm.tip_mass += by; });
      expect_derivative(arm, model, f.mass(), 1e-3, [](MeasuredArm& a, Numbers&, double by) {
        for (ArmSection& s : a.arm.sections) {
          s.start.mass *= std::exp(by);
          s.end.mass *= std::exp(by);
          s.discs.mass *= std::exp(by);
        }
      });
    }
}

/// A row every half second, every motor on a way of its own.
MeasuredRows some_rows(const MeasuredArm& arm, int count) {
  MeasuredRows rows;
  std::mt19937 gen(1);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<double> phase(arm.arm.tendons.size());
  for (double& x : phase) x = pi * share(gen);
  for (int k = 0; k < count; ++k) {
    rows.time.push_back(0.5 * k);
    rows.blocks.push_back(k / 10);
    for (std::size_t i = 0; i < phase.size(); ++i)
      rows.pulls.push_back(-5e-4 +
                           2.5e-3 * std::sin(0.31 * k * (1 + 0.07 * static_cast<double>(i)) + phase[i]));
  }
  rows.markers = *predict_markers(arm, rows);
  return rows;
}

TEST(Identify, FindsAnArmThatIsKnown) {
  const MeasuredArm truth = some_arm();
  const MeasuredRows rows = some_rows(truth, 150);
  MeasuredArm start = truth;
  start.drive.lag = 0;
  start.drive.play = 0;
  for (ArmSection& section : start.arm.sections) {
    for (double CrossSection::*member : {&CrossSection::bending_x, &CrossSection::bending_y}) {
      section.start.*member *= 1.2;
      section.end.*member *= 1.2;
    }
    section.curvature[0] = 0;
  }
  for (ArmTendon& tendon : start.arm.tendons) {
    tendon.compliance *= 0.7;
    for (TendonRoute& route : tendon.routes) {
      route.start_angle += 0.1;
      route.end_angle += 0.1;
    }
  }
  start.marker.place[0] = 0;
  auto parameters = fit_parameters(
      start, "sections.bending,sections.angle,compliance,sections.curvature.x,lag,play,marker.x");
  ASSERT_TRUE(parameters) << to_string(parameters.error());
  for (FitParameter& parameter : *parameters) parameter.prior = 0;
  const auto found = identify(start, *parameters, rows, {.noise = 1e-4, .correlated = 1, .tolerance = 1e-6});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->report.ok()) << to_string(found->report);
  EXPECT_GT(found->before.rms, 5e-3);
  EXPECT_LT(found->train.rms, 1e-6);
  EXPECT_NEAR(found->arm.drive.lag, 0.1, 1e-4);
  EXPECT_NEAR(found->arm.drive.play, 1e-4, 1e-7);
  EXPECT_NEAR(found->arm.marker.place[0], 1e-3, 1e-6);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_NEAR(found->arm.arm.sections[m].start.bending_x / truth.arm.sections[m].start.bending_x, 1, 1e-3);
    EXPECT_NEAR(found->arm.arm.sections[m].curvature[0], 0.4, 1e-3);
    EXPECT_NEAR(found->arm.arm.tendons[3].routes[m].start_angle, truth.arm.tendons[3].routes[m].start_angle,
                1e-5);
  }
}

/// Without weight a stiffer arm on stiffer tendons is the same: the rows do not tell, and that is named.
TEST(Identify, NamesWhatRowsDoNotTell) {
  MeasuredArm arm = some_arm();
  arm.arm.gravity = {0, 0, 0};
  for (ArmTendon& tendon : arm.arm.tendons) tendon.pretension = 0;
  const MeasuredRows rows = some_rows(arm, 60);
  const auto parameters = fit_parameters(arm, "bending,torsion,compliance,tip_mass,marker");
  ASSERT_TRUE(parameters);
  const auto found = identify(arm, *parameters, rows, {.noise = 1e-3});
  ASSERT_TRUE(found);
  ASSERT_GE(found->flat.size(), 2u);
  EXPECT_GT(found->parameters[3].prior_share, 0.999);  // the tip's mass
  EXPECT_LT(found->parameters[4].prior_share, 0.5);    // the marker's place
  bool scaled = false;
  for (const FlatDirection& flat : found->flat)
    if (std::abs(flat.coefficients[3]) < 0.1 && flat.deviation > 1e2)
      scaled =
          std::abs(flat.coefficients[0] * (*parameters)[0].prior +
                   flat.coefficients[2] * (*parameters)[2].prior) < 1e-3 * std::abs(flat.coefficients[0]);
  EXPECT_TRUE(scaled);
}

/// A toe that the file does not have is found, and stays away where there is none.
TEST(Identify, FindsAToeThatStartsAtNothing) {
  for (const double toe : {5e-4, 0.0}) {
    MeasuredArm truth = some_arm();
    truth.drive.toe.assign(6, toe);
    const MeasuredRows rows = some_rows(truth, 80);
    MeasuredArm start = truth;
    start.drive.toe.clear();
    auto parameters = fit_parameters(start, "toe,marker.x");
    ASSERT_TRUE(parameters);
    for (FitParameter& parameter : *parameters) parameter.prior = 0;
    const auto found =
        identify(start, *parameters, rows, {.noise = 1e-4, .correlated = 1, .tolerance = 1e-8});
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->report.ok()) << to_string(found->report);
    EXPECT_EQ(found->parameters[0].start, 0);
    EXPECT_NEAR(found->parameters[0].value, toe, 2e-6);
    EXPECT_EQ(found->arm.drive.toe[3], found->parameters[0].value);
  }
}

TEST(Identify, ValuesOfMassesAreFactors) {
  const MeasuredArm truth = some_arm();
  const MeasuredRows rows = some_rows(truth, 60);
  MeasuredArm start = truth;
  for (ArmSection& section : start.arm.sections) {
    for (CrossSection* one : {&section.start, &section.end}) one->mass *= 2;
    section.discs.mass *= 2;
  }
  auto parameters = fit_parameters(start, "mass");
  parameters->front().prior = 0;
  const auto found = identify(start, *parameters, rows, {.noise = 1e-4, .correlated = 1, .tolerance = 1e-6});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->parameters[0].start, 1);
  EXPECT_NEAR(found->parameters[0].value, 0.5, 1e-3);
  EXPECT_NEAR(found->arm.arm.sections[0].discs.mass, truth.arm.sections[0].discs.mass, 1e-6);
}

TEST(Identify, StopsWithWhatItHas) {
  const MeasuredArm truth = some_arm();
  const MeasuredRows rows = some_rows(truth, 60);
  MeasuredArm start = truth;
  start.marker.place[2] += 5e-3;
  const auto parameters = fit_parameters(start, "sections.bending,marker,tendons.offset");
  std::atomic<bool> flag = true;
  IdentifyOptions options{.stop = StopToken(flag)};
  const auto at_once = identify(start, *parameters, rows, options);
  ASSERT_TRUE(at_once);
  EXPECT_EQ(at_once->report.status, Status::stopped);
  EXPECT_EQ(at_once->arm.marker.place, start.marker.place);
  for (const FittedParameter& one : at_once->parameters) EXPECT_TRUE(std::isfinite(one.deviation));
  EXPECT_FALSE(hold_out(start, *parameters, rows, folds_of(rows, 3), options)->is_complete);
  flag = false;
  int steps = 0;
  double last = 1;
  options.progress = [&](int step, double rms) {
    steps = step;
    last = rms;
    flag = step == 2;
  };
  const auto later = identify(start, *parameters, rows, options);
  EXPECT_EQ(later->report.status, Status::stopped);
  EXPECT_EQ(steps, 2);
  EXPECT_EQ(at_once->train.rows, 0) << "nothing was computed";
  EXPECT_EQ(later->train.rows, 60);
  EXPECT_EQ(later->train.rms, last) << "of the last step that was kept";
  EXPECT_LT(later->train.rms, later->before.rms);
}

TEST(Identify, HoldsOutEveryRowOnce) {
  const MeasuredArm arm = some_arm();
  MeasuredRows rows = some_rows(arm, 60);
  for (std::size_t k = 0; k < rows.markers.size(); ++k)
    rows.markers[k] += 1e-3 * std::sin(37.0 * static_cast<double>(k));
  const auto parameters = fit_parameters(arm, "bending,marker");
  const std::vector<int> folds = folds_of(rows, 3);
  const auto held_out = hold_out(arm, *parameters, rows, folds);
  ASSERT_TRUE(held_out);
  EXPECT_TRUE(held_out->is_complete);
  EXPECT_EQ(held_out->errors.rows, 60);
  double squares = 0, largest = 0;
  for (int fold = 0; fold < 3; ++fold) {
    IdentifyOptions options;
    for (const int one : folds) options.held_out.push_back(one == fold);
    const auto part = identify(arm, *parameters, rows, options);
    for (std::size_t k = 0; k < folds.size(); ++k)
      if (folds[k] == fold) {
        EXPECT_EQ(held_out->by_row[k], part->errors[k]);
      }
    squares += part->held_out.rms * part->held_out.rms * part->held_out.rows;
    largest = std::max(largest, part->held_out.max);
  }
  EXPECT_NEAR(held_out->errors.rms, std::sqrt(squares / 60), 1e-12);
  EXPECT_EQ(held_out->errors.max, largest);
  EXPECT_EQ(hold_out(arm, *parameters, rows, {0, 1}).error().front().code, "wrong_size");
  EXPECT_EQ(hold_out(arm, *parameters, rows, std::vector<int>(60, 0)).error().front().code, "too_few");
}

/// As long as no tendon is slack, counts the other way are a half turn. Then they are what they should be.
TEST(Identify, TakesCountsAsDrawnInWhereATurnSaysTheSame) {
  MeasuredArm arm = some_arm();
  for (ArmTendon& tendon : arm.arm.tendons) tendon.pretension = 20;
  const MeasuredRows rows = some_rows(arm, 40);
  for (const double turn : {0.0, 1.7, -2.9}) {
    TendonMap back;
    back.turn = -turn;
    const auto found = map_tendons(mapped(arm, back), rows);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->sign, 1);
    EXPECT_FALSE(found->mirrored);
    EXPECT_NEAR(found->turn, turn, 0.3);
    EXPECT_NEAR(found->as_given, std::max(0.0, found->agreement * std::cos(found->turn)), 0.1);
  }
  TendonMap other;
  other.mirrored = true;
  other.turn = 0.5;
  const auto found = map_tendons(mapped(arm, other), rows);
  EXPECT_TRUE(found->mirrored);
  const MeasuredArm again = mapped(mapped(arm, other), *found);
  EXPECT_NEAR(
      std::remainder(again.arm.tendons[4].routes[0].start_angle - arm.arm.tendons[4].routes[0].start_angle,
                     2 * pi),
      0, 0.4);
}

TEST(Identify, UsuallyFitsWhatRowsCanTell) {
  MeasuredRows rows;
  const MeasuredArm arm = measured_arm("ftdcr-v4");
  EXPECT_EQ(usual_fit(arm, rows).find("lag"), std::string::npos);
  rows.time = {0, 1};
  EXPECT_NE(usual_fit(arm, rows).find(",lag"), std::string::npos);
  EXPECT_EQ(fit_parameters(arm, usual_fit(arm, rows))->size(), fit_parameters(arm, measured_names)->size());
  EXPECT_EQ(usual_fit(arm, rows, ArmModel::prb).find("curvature"), std::string::npos);
  EXPECT_EQ(usual_fit(measured(*load("two-segment")->arm()), rows).find("gravity"), std::string::npos);
}

TEST(Identify, SaysWhatIsWrong) {
  const MeasuredArm arm = some_arm();
  EXPECT_EQ(fit_parameters(arm, "stiffness").error().front().code, "unknown_name");
  EXPECT_EQ(fit_parameters(arm, "tendons.bending").error().front().code, "not_available");
  const auto parameters = fit_parameters(arm, "bending");
  EXPECT_EQ(identify(arm, *parameters, {}).error().front().code, "too_few");
  MeasuredRows rows = some_rows(arm, 4);
  EXPECT_EQ(identify(arm, {}, rows).error().front().code, "too_few");
  rows.pulls.pop_back();
  EXPECT_EQ(identify(arm, *parameters, rows).error().front().code, "wrong_size");
  rows = some_rows(arm, 4);
  rows.markers[5] = std::nan("");
  EXPECT_EQ(identify(arm, *parameters, rows).error().front().code, "not_a_number");
  rows = some_rows(arm, 4);
  EXPECT_EQ(identify(arm, *parameters, rows, {.held_out = {true}}).error().front().code, "wrong_size");
  EXPECT_EQ(identify(arm, *parameters, rows, {.held_out = {true, true, true, true}}).error().front().code,
            "too_few");
  MeasuredArm other = arm;
  other.drive.toe.pop_back();
  EXPECT_EQ(identify(other, *parameters, rows).error().front().code, "wrong_size");
  EXPECT_EQ(fit_parameters(arm, "friction").error().front().code, "not_available");
  EXPECT_EQ(fit_parameters(arm, "tendons.friction").error().front().code, "not_available");
  EXPECT_EQ(fit_parameters(arm, "bending,lag,bending").error().front().code, "duplicate_name");
  EXPECT_EQ(fit_parameters(arm, "marker,marker.x").error().front().code, "duplicate_name");
  EXPECT_EQ(fit_parameters(arm, "bending,,lag").error().front().code, "unknown_name");
  for (double& pull : rows.pulls) pull = 0.5;  // metres of tendon drawn into an arm of centimetres
  const auto lost = identify(arm, *parameters, rows);
  ASSERT_TRUE(lost);
  if (lost->train.rows == 0) {
    EXPECT_EQ(lost->report.status, Status::unreachable);
  }
  MeasuredArm rigid = arm;
  rigid.arm.tendons[2].compliance = 0;
  EXPECT_EQ(identify(rigid, *parameters, some_rows(arm, 4)).error().front().code, "out_of_range");
}

/// The makers' angles of version 6 are in axes that lie half a turn from those of the measurement.
TEST(Identify, FindsHowTendonsBelongToMotors) {
  MeasuredArm arm = measured_arm("ftdcr-v6");
  const Recording read = recording("ftdcr-v6");
  const auto here = map_tendons(arm, read.rows);
  ASSERT_TRUE(here);
  EXPECT_EQ(here->sign, 1);
  EXPECT_FALSE(here->mirrored);
  EXPECT_NEAR(here->turn, 0, 0.4);
  EXPECT_GT(here->agreement, here->next + 0.02);
  for (std::size_t i = 0; i < 9; ++i)
    for (TendonRoute& route : arm.arm.tendons[i].routes) {
      const double nominal = pi / 6 * static_cast<double>(i / 3) + 2 * pi / 3 * static_cast<double>(i % 3);
      route.start_angle = route.end_angle = nominal;
    }
  const auto nominal = map_tendons(arm, read.rows);
  EXPECT_EQ(nominal->sign, 1);
  EXPECT_FALSE(nominal->mirrored);
  EXPECT_NEAR(std::abs(nominal->turn), pi, 0.4);
}

void print_result(const Identified& found, double seconds, double pulls) {
  std::printf(
      "%d rows: %.2f mm before, %.2f mm after (median %.2f, max %.2f), single pulls %.2f; %d iterations, "
      "%.2f s\n",
      found.train.rows, 1e3 * found.before.rms, 1e3 * found.train.rms, 1e3 * found.train.median,
      1e3 * found.train.max, 1e3 * pulls, found.report.iterations, seconds);
}

struct Judged {
  const char* name;
  double train, held_out, pulls;  ///< [m]
};

class MeasuredArms : public ::testing::TestWithParam<Judged> {};

TEST_P(MeasuredArms, AreIdentified) {
  const Recording read = recording(GetParam().name);
  const MeasuredArm start = measured_arm(GetParam().name);
  const auto parameters = fit_parameters(start, measured_names);
  ASSERT_TRUE(parameters) << to_string(parameters.error());
  const double before = cpu_seconds();
  const auto found = identify(start, *parameters, read.rows);
  const double seconds = cpu_seconds() - before;
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->report.ok()) << to_string(found->report);
  EXPECT_EQ(found->train.failed, 0);
  EXPECT_LT(found->train.rms, GetParam().train);
  std::printf("%s: train %.2f mm in %.2f s\n", GetParam().name, 1e3 * found->train.rms, seconds);
  // bounds are kept, and pulls meet slack tendons
  for (std::size_t p = 0; p < parameters->size(); ++p) {
    EXPECT_GE(found->parameters[p].coordinate, (*parameters)[p].lower);
    EXPECT_LE(found->parameters[p].coordinate, (*parameters)[p].upper);
  }
  double pulls = 0, count = 0;
  for (std::size_t k = 0; k < read.labels.size(); ++k)
    if (read.labels[k].find("pull") != std::string::npos) {
      pulls += found->errors[k] * found->errors[k];
      ++count;
    }
  pulls = std::sqrt(pulls / count);
  EXPECT_LT(pulls, GetParam().pulls);
  print_result(*found, seconds, pulls);
  if (is_instrumented) return;  // more of the same
  // a part that the fit does not see
  const std::vector<int> folds = folds_of(read.rows, 5);
  IdentifyOptions options;
  double sum = 0;
  for (int fold = 0; fold < 5; ++fold) {
    options.held_out.assign(folds.size(), false);
    for (std::size_t k = 0; k < folds.size(); ++k) options.held_out[k] = folds[k] == fold;
    const auto part = identify(start, *parameters, read.rows, options);
    ASSERT_TRUE(part);
    sum += part->held_out.rms * part->held_out.rms * part->held_out.rows;
  }
  const double held_out = std::sqrt(sum / static_cast<double>(read.rows.size()));
  std::printf("held out, by blocks: %.2f mm\n", 1e3 * held_out);
  EXPECT_LT(held_out, GetParam().held_out);
}

INSTANTIATE_TEST_SUITE_P(Identify, MeasuredArms,
                         ::testing::Values(Judged{"ftdcr-v4", 4e-3, 5e-3, 7e-3},
                                           Judged{"ftdcr-v6", 7e-3, 10e-3, 10e-3}),
                         [](const auto& arm) { return std::string(arm.param.name).substr(6); });

}  // namespace identify_test
}  // namespace sinew::test
