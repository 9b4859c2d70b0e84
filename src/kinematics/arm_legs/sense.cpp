/// The wrench on the platform by what was measured of tendons and pose.
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/legs_walk.hpp"
#include "kinematics/arms/sense_search.hpp"
#include "kinematics/arms/tensions/tension_search.hpp"
#include "math/plane_axes.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

/// Equilibria and their Newton's steps of one search [1]: a bound of time, the same as of tensions.
constexpr int most_work_of_sensing = 3000;
/// Times that a search is made again by finer polynomials [1]: of five at most the first search ends at the
/// second or a finer one.
constexpr int most_refinements = 3;
/// First steps of a search that is made again, over those of the first one [1]: with long ones legs may snap
/// to another equilibrium or have none.
constexpr double short_steps = 0.05;

class MeasuredLegs final : public LoadedBody {
 public:
  MeasuredLegs(const ArmLegs& robot, const ArmLegsMeasurement& measured, const ArmLegsLoad& load,
               const ArmOptions& options, ArmLegsWorkspace& work)
      : robot_(robot),
        measured_(measured),
        problem_(robot, measured.held, load),
        work_(work),
        walk_(robot, options, work, LegsEnd::anywhere) {}
  Report load(const std::array<double, 6>& wrench, bool from_last) override {
    std::copy(wrench.begin(), wrench.end(), problem_.wrench.begin());
    // Where a step failed the legs stay where they were.
    const Report report = walk_.go(problem_, from_last || has_begun_);
    has_begun_ = true;
    return report;
  }
  bool compare(Comparison& with) override {
    const ArmLegsState& state = work_.impl().state;
    const ArmLegsRates rates = arm_legs_rates(robot_, work_);
    if (!rates.regular) return false;
    with.add_tendons(measured_, state, rates.answers_by_wrench);
    leave_out_undetermined(with);
    if (measured_.position)
      for (std::size_t i = 0; i < (robot_.is_planar ? 2U : 3U); ++i)
        with.add((*measured_.position)[i] - state.platform.p[static_cast<int>(i)],
                 rates.compliance.data() + 6 * i, measured_.position_deviation);
    if (!measured_.quaternion) return true;
    const SE3<double> seen = SE3<double>::from({{0, 0, 0}, *measured_.quaternion});
    const auto turn = twist_between(state.platform, seen);
    for (std::size_t i = robot_.is_planar ? 5 : 3; i < 6; ++i)
      with.add(turn[static_cast<int>(i)], rates.compliance.data() + 6 * i, measured_.angle_deviation);
    return true;
  }

 private:
  /// Tensions that no equilibrium determines explain themselves: they do not count, nor do the equilibrium's
  /// own.
  void leave_out_undetermined(Comparison& with) const {
    const Eigen::MatrixXd all = work_.impl().group().undetermined_tensions();
    if (all.cols() == 0) return;
    const auto count = static_cast<Eigen::Index>(with.off.size());
    Eigen::MatrixXd free = Eigen::MatrixXd::Zero(count, all.cols());
    for (Eigen::Index row = 0, i = 0; i < all.rows(); ++i)
      if (!std::isnan(measured_.answers[at(static_cast<int>(i))])) free.row(row++) = all.row(i);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(free);
    Eigen::Map<Eigen::VectorXd> off(with.off.data(), count);
    Eigen::Map<ArmGroup::Matrix> rows(with.rows.data(), count, 6);
    off -= free * factors.solve(off).eval();
    rows -= free * factors.solve(rows).eval();
  }

  const ArmLegs& robot_;
  const ArmLegsMeasurement& measured_;
  LegsProblem problem_;
  ArmLegsWorkspace& work_;
  LegsWalk walk_;
  bool has_begun_ = false;
};

/// Of the wrench, or of the force alone.
std::size_t unknowns_of(const ArmLegs& robot, bool force_alone) {
  if (robot.is_planar) return force_alone ? 2 : 3;
  return force_alone ? 3 : 6;
}

Report sense_misfit(const ArmLegs& robot, const ArmLegsMeasurement& measured, const ArmLegsLoad& load,
                    bool force_alone, const ArmOptions& options, const ArmLegsWorkspace& work) {
  Report misfit = legs_misfit(robot, measured.held, load, options, work);
  const bool is_planar = robot.is_planar;
  const std::size_t forces = is_planar ? 2 : 3, turns = is_planar ? 1 : 3,
                    others = (measured.position ? forces : 0U) + (measured.quaternion ? turns : 0U);
  const auto bad = [&](std::string_view words) {
    if (misfit.ok() && !words.empty()) misfit = {Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  bad(measurement_misfit(robot.tendons(), measured.held, measured.answers, others,
                         unknowns_of(robot, force_alone),
                         {measured.tension_deviation, measured.change_deviation, measured.position_deviation,
                          measured.angle_deviation}));
  const auto finite = [](double x) { return std::isfinite(x); };
  if (measured.position && !std::ranges::all_of(*measured.position, finite))
    bad("the position is not finite");
  if (measured.quaternion) {
    double square = 0;
    for (const double x : *measured.quaternion) square += x * x;
    if (!(square > 0 && std::isfinite(square))) bad("the quaternion has no length, or is not finite");
  }
  if (misfit.ok() && is_planar && measured.position && (*measured.position)[2] != 0)
    bad("the position is out of the plane");
  if (misfit.ok() && measured.quaternion &&
      leaves_plane(robot, SE3<double>::from({{0, 0, 0}, *measured.quaternion})))
    bad("the quaternion turns out of the plane");
  return misfit;
}

WrenchSearch search_from(const ArmLegs& robot, const ArmLegsLoad& load, const std::array<double, 6>& first,
                         bool force_alone, const ArmOptions& options) {
  double usual = 0;
  for (const ArmLeg& leg : robot.legs) usual += usual_force(leg.arm);
  return {.first = first,
          .unknowns = unknowns_of(robot, force_alone),
          .components = robot.is_planar
                            ? std::array<std::size_t, 6>{plane_axes[0], plane_axes[1], plane_axes[2]}
                            : std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5},
          .known = load.wrench,
          .length = legs_size(robot),
          .usual = usual,
          .from_last = options.from_last,
          .most_work = most_work_of_sensing};
}

/// At the polynomials that the beginning needs; again where the end needs finer ones.
FoundWrench search_refined(const ArmLegs& robot, const ArmLegsMeasurement& measured, const ArmLegsLoad& load,
                           const std::array<double, 6>& first, double first_step, bool force_alone,
                           const ArmOptions& options, ArmLegsWorkspace& work) {
  WrenchSearch search = search_from(robot, load, first, force_alone, options);
  search.usual *= first_step;
  ArmOptions each = options;
  FoundWrench found;
  for (int round = 0;; ++round) {
    MeasuredLegs body(robot, measured, load, each, work);
    found = search_wrench(search, body);
    if (!found.report.ok() || round == most_refinements) break;
    const int level = work.impl().level;
    ArmLegsLoad all = load;
    all.wrench = found.wrench;
    each.from_last = true;
    solve_legs(robot, {robot, measured.held, all}, each, work);
    found.report.residual = work.impl().state.report.residual;
    if (!work.impl().has_last()) found.report = work.impl().state.report;
    if (!work.impl().has_last() || work.impl().level <= level) break;
    search.first = found.wrench;
    search.from_last = true;
  }
  return found;
}

/// What a tendon's length changes by one unit of its tension, roughly [m/N].
double usual_yield(const ArmLegs& robot) {
  const Arm& arm = robot.legs.front().arm;
  return arm.tendons.empty() ? 1 : arm.tendons.front().routes.front().start_radius / usual_tension(arm);
}

/// From the wrench under which the tensions that were measured lead to the lengths that are held: where
/// tendons do not stretch and hold legs nearly twice, wrenches between none and this one may lead to no
/// equilibrium.
FoundWrench search_from_tensions(const ArmLegs& robot, const ArmLegsMeasurement& measured,
                                 const ArmLegsLoad& load, bool force_alone, const ArmOptions& options,
                                 ArmLegsWorkspace& work) {
  ArmLegsMeasurement turned = measured;
  turned.change_deviation = measured.tension_deviation * usual_yield(robot);
  for (std::size_t i = 0; i < measured.answers.size(); ++i) {
    if (measured.held[i].held == TendonHeld::tension || std::isnan(measured.answers[i])) continue;
    turned.held[i] = {TendonHeld::tension, std::max(0.0, measured.answers[i])};
    turned.answers[i] = measured.held[i].value;
  }
  ArmOptions each = options;
  each.from_last = false;
  FoundWrench found;
  {
    MeasuredLegs body(robot, turned, load, each, work);
    found = search_wrench(search_from(robot, load, load.wrench, force_alone, each), body);
  }
  if (!found.report.ok()) return found;
  each.from_last = true;
  return search_refined(robot, measured, load, found.wrench, 1, force_alone, each, work);
}

bool is_explained(const FoundWrench& found) { return found.report.ok() && found.misfit <= large_misfit; }

/// Of a tendon that is held by its length at least.
bool has_tensions(const ArmLegsMeasurement& measured) {
  for (std::size_t i = 0; i < measured.answers.size(); ++i)
    if (measured.held[i].held == TendonHeld::change && !std::isnan(measured.answers[i])) return true;
  return false;
}

/// Nearly as well is better where only that search ended.
bool explains_better(const FoundWrench& one, const FoundWrench& other) {
  constexpr double nearly = 1.5;
  if (std::isnan(one.misfit)) return false;
  if (std::isnan(other.misfit)) return true;
  const double more = !one.report.ok() && other.report.ok() ? nearly : 1,
               less = one.report.ok() && !other.report.ok() ? nearly : 1;
  return one.misfit * more < other.misfit * less;
}

/// Ways to search, tried in turn until one explains what was measured.
enum class SensingWay { as_asked, from_tensions, in_short_steps };

/// As it was asked; else in other ways; the best is answered.
FoundWrench search_all(const ArmLegs& robot, const ArmLegsMeasurement& measured, const ArmLegsLoad& load,
                       bool force_alone, const ArmOptions& options, ArmLegsWorkspace& work) {
  ArmOptions how = options;
  const auto go = [&](SensingWay way) {
    if (way == SensingWay::from_tensions)
      return search_from_tensions(robot, measured, load, force_alone, how, work);
    const double step = way == SensingWay::as_asked ? 1 : short_steps;
    return search_refined(robot, measured, load, load.wrench, step, force_alone, how, work);
  };
  FoundWrench best = go(SensingWay::as_asked);
  if (best.report.status == Status::bad_input || best.report.status == Status::unsupported) return best;
  SensingWay best_way = SensingWay::as_asked, last_way = best_way;
  how.from_last = false;
  for (const SensingWay way : {SensingWay::from_tensions, SensingWay::in_short_steps}) {
    if (is_explained(best) || work.stop.stop_requested()) break;
    if (way == SensingWay::from_tensions && !has_tensions(measured)) continue;
    const FoundWrench found = go(way);
    last_way = way;
    if (found.report.status == Status::stopped) return found;
    if (explains_better(found, best)) best = found, best_way = way;
  }
  return best_way == last_way ? best : go(best_way);
}

}  // namespace

ArmLegsSensed arm_legs_sense(const ArmLegs& robot, const ArmLegsMeasurement& measured,
                             const ArmLegsLoad& load, bool force_alone, const ArmOptions& options,
                             ArmLegsWorkspace& work) {
  ArmLegsSensed sensed;
  if (const Report misfit = sense_misfit(robot, measured, load, force_alone, options, work); !misfit.ok()) {
    sensed.report = misfit;
    sensed.state = work.impl().state;
    sensed.state.report = misfit;
    return sensed;
  }
  const FoundWrench found = search_all(robot, measured, load, force_alone, options, work);
  sensed.report = found.report;
  report_misfit(found.misfit, sensed.report);
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = found.wrench[k] - load.wrench[k];
  sensed.covariance = found.covariance;
  sensed.misfit = found.misfit;
  sensed.condition = found.condition;
  sensed.state = work.impl().state;
  return sensed;
}

}  // namespace sinew::inline v1
