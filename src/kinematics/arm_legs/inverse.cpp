#include <fmt/format.h>

#include <algorithm>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arms/inverse_search.hpp"

namespace sinew::inline v1 {
namespace {

class PulledLegs final : public PulledBody {
 public:
  PulledLegs(const ArmLegs& robot, const ArmLegsLoad& load, const ArmOptions& options, ArmLegsWorkspace& work,
             LegsEnd first)
      : robot_(robot),
        load_(load),
        work_(work),
        walk_(robot, options, work, first) {}
  Report pull(const std::vector<double>& tensions, bool from_last) override {
    return walk_.go({robot_, as_commands(tensions), load_}, from_last);
  }
  const SE3<double>& tip() const override { return work_.impl().state.platform; }
  bool rates(std::vector<double>& J) override {
    ArmLegsRates rates = arm_legs_rates(robot_, work_);
    J = std::move(rates.J);
    return rates.regular;
  }
  std::vector<double> last_tensions() const override {
    return work_.impl().has_last() ? work_.impl().state.tensions : std::vector<double>();
  }
  void keep() override { walk_.keep(); }
  void bring_back() { walk_.bring_back(); }

 private:
  const ArmLegs& robot_;
  const ArmLegsLoad& load_;
  ArmLegsWorkspace& work_;
  LegsWalk walk_;
};

/// In the plane bending about y alone counts.
Arm bending_as_it_may(const ArmLegs& robot, const ArmLeg& leg) {
  Arm arm = leg.arm;
  if (robot.is_planar)
    for (ArmSection& section : arm.sections) section.start.bending_x = section.start.bending_y;
  return arm;
}

}  // namespace

ArmLegsInverse arm_legs_inverse(const ArmLegs& robot, const ArmTarget& target, const ArmLegsLoad& load,
                                const ArmInverseOptions& options, ArmLegsWorkspace& work) {
  ArmLegsInverse best;
  const ArmLegsState& state = work.impl().state;
  const auto answer = [&](const Report& report) {
    best.report = report;
    best.state = state;
    return best;
  };
  const std::vector<TendonCommand> loose(robot.tendons());
  Report misfit = legs_misfit(robot, loose, load, options.arm, work);
  if (const auto text = target_misfit(target); misfit.ok() && !text.empty())
    misfit = {Status::bad_input, 0, 0, FixedText<240>(text)};
  if (misfit.ok() && robot.is_planar) {
    if (target.direction)
      misfit = {Status::bad_input, 0, 0,
                FixedText<240>("in the plane a platform has no z axis to point: give a quaternion about z")};
    else if ((target.position && (*target.position)[2] != 0) ||
             (target.quaternion && leaves_plane(robot, SE3<double>::from({{0, 0, 0}, *target.quaternion}))))
      misfit = {Status::bad_input, 0, 0, FixedText<240>("the target is out of the plane")};
  }
  if (misfit.ok() && loose.empty())
    misfit = {Status::bad_input, 0, 0, FixedText<240>("the legs have no tendons that could move it")};
  if (!misfit.ok()) {
    answer(misfit);
    best.state.report = misfit;
    return best;
  }
  const double length = legs_size(robot);
  double usual = 1e300;
  for (const ArmLeg& leg : robot.legs)
    if (!leg.arm.tendons.empty()) usual = std::min(usual, usual_tension(bending_as_it_may(robot, leg)));
  TensionSearch search{.tendons = loose.size(),
                       .length = length,
                       .usual = usual,
                       .most = options.most_tension > 0 ? options.most_tension : 1e3 * usual,
                       .precision = options.precision,
                       .starts = options.starts,
                       .from_last = options.arm.from_last,
                       .most_work = 3000};
  // At the coarsest polynomials, then at those that the end needs.
  int iterations = 0;
  for (int round = 0;; ++round) {
    PulledLegs body(robot, load, options.arm, work, round == 0 ? LegsEnd::coarse : LegsEnd::anywhere);
    const FoundTensions found = search_tensions(target, search, body);
    iterations += found.report.iterations;
    const Status status = found.report.status;
    if (status == Status::bad_input || status == Status::unsupported || status == Status::stopped)
      return answer(found.report);
    if (!(found.report.residual < 1e300)) {
      answer(
          {Status::stalled, iterations, 0,
           FixedText<240>(fmt::format(
               "the search for tensions has nowhere to begin: of {} first tensions, none at all and some of "
               "each, "
               "none holds the platform under these loads; give a start, where others hold it, or less load",
               search.starts))});
      return best;
    }
    const LegsProblem there(robot, as_commands(found.tensions), load);
    ArmOptions last = options.arm;
    last.from_last = true;
    body.bring_back();
    const bool is_near = found.report.residual <= search.precision;
    if (is_near) solve_legs(robot, there, last, work);
    answer(state.report);
    best.report.iterations = iterations;
    best.report.residual = off_target(target, state.platform, length);
    if (!state.report.ok() || !is_near || best.report.residual <= options.precision || round == 3) break;
    search.from_last = true;
    search.starts = 1;
    search.most_work = 1000;
  }
  if (best.report.ok() && best.report.residual > 10 * options.precision) {
    best.report.status = Status::unreachable;
    best.report.message =
        unreachable_words("platform", "the longest leg's", options.most_tension, best.report.residual);
  }
  return best;
}

}  // namespace sinew::inline v1
