#include <algorithm>
#include <cmath>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arms/sense_search.hpp"
#include "math/plane_axes.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

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

}  // namespace

ArmLegsSensed arm_legs_sense(const ArmLegs& robot, const ArmLegsMeasurement& measured,
                             const ArmLegsLoad& load, bool force_alone, const ArmOptions& options,
                             ArmLegsWorkspace& work) {
  ArmLegsSensed sensed;
  const bool is_planar = robot.is_planar;
  const std::size_t forces = is_planar ? 2 : 3, turns = is_planar ? 1 : 3,
                    unknowns = force_alone ? forces : forces + turns,
                    others = (measured.position ? forces : 0U) + (measured.quaternion ? turns : 0U);
  Report misfit = legs_misfit(robot, measured.held, load, options, work);
  const auto bad = [&](std::string_view words) {
    if (misfit.ok() && !words.empty()) misfit = {Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  bad(measurement_misfit(robot.tendons(), measured.held, measured.answers, others, unknowns,
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
  if (!misfit.ok()) {
    sensed.report = misfit;
    sensed.state = work.impl().state;
    sensed.state.report = misfit;
    return sensed;
  }
  double usual = 0;
  for (const ArmLeg& leg : robot.legs) usual += usual_force(leg.arm);
  WrenchSearch search{
      .first = load.wrench,
      .unknowns = unknowns,
      .components = is_planar ? std::array<std::size_t, 6>{plane_axes[0], plane_axes[1], plane_axes[2]}
                              : std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5},
      .length = legs_size(robot),
      .usual = usual,
      .from_last = options.from_last,
      .most_work = 3000};
  ArmOptions each = options;
  FoundWrench found;
  // At the polynomials that the beginning needs; again where the end needs finer ones.
  for (int round = 0;; ++round) {
    MeasuredLegs body(robot, measured, load, each, work);
    found = search_wrench(search, body);
    if (!found.report.ok() || round == 3) break;
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
  sensed.report = found.report;
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = found.wrench[k] - load.wrench[k];
  sensed.covariance = found.covariance;
  sensed.misfit = found.misfit;
  sensed.condition = found.condition;
  sensed.state = work.impl().state;
  return sensed;
}

}  // namespace sinew::inline v1
