/// The wrench on the platform by what was measured of tendons and pose.
#include <algorithm>
#include <cmath>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/legs_walk.hpp"
#include "kinematics/arms/sense_search.hpp"
#include "math/plane_axes.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

/// Equilibria and their Newton's steps of one search [1]: a bound of time, the same as of tensions.
constexpr int most_work_of_sensing = 3000;
/// Times that a search is made again by finer polynomials [1]: of five at most the first search ends at the
/// second or a finer one.
constexpr int most_refinements = 3;

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

/// At the polynomials that the beginning needs; again where the end needs finer ones.
FoundWrench search_refined(const ArmLegs& robot, const ArmLegsMeasurement& measured, const ArmLegsLoad& load,
                           bool force_alone, const ArmOptions& options, ArmLegsWorkspace& work) {
  double usual = 0;
  for (const ArmLeg& leg : robot.legs) usual += usual_force(leg.arm);
  WrenchSearch search{
      .first = load.wrench,
      .unknowns = unknowns_of(robot, force_alone),
      .components = robot.is_planar ? std::array<std::size_t, 6>{plane_axes[0], plane_axes[1], plane_axes[2]}
                                    : std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5},
      .length = legs_size(robot),
      .usual = usual,
      .from_last = options.from_last,
      .most_work = most_work_of_sensing};
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
  const FoundWrench found = search_refined(robot, measured, load, force_alone, options, work);
  sensed.report = found.report;
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = found.wrench[k] - load.wrench[k];
  sensed.covariance = found.covariance;
  sensed.misfit = found.misfit;
  sensed.condition = found.condition;
  sensed.state = work.impl().state;
  return sensed;
}

}  // namespace sinew::inline v1
