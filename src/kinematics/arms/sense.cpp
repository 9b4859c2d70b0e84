#include "kinematics/arms/sense_search.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/arms/arm_work.hpp"
#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

class MeasuredArm final : public LoadedBody {
 public:
  MeasuredArm(const Arm& arm, const ArmMeasurement& measured, const ArmLoad& load, const ArmOptions& options,
              ArmWorkspace& work)
      : arm_(arm),
        measured_(measured),
        load_(load),
        options_(options),
        work_(work) {}
  Report load(const std::array<double, 6>& wrench, bool from_last) override {
    load_.wrench = wrench;
    options_.from_last = from_last;
    return arm_forward(arm_, measured_.held, load_, options_, work_).report;
  }
  bool compare(Comparison& with) override {
    const ArmState& state = work_.impl().state;
    const ArmRates rates = arm_rates(arm_, work_, false);
    if (!rates.regular) return false;
    with.add_tendons(measured_, state, rates.answers_by_wrench);
    if (measured_.tip)
      for (std::size_t i = 0; i < 3; ++i)
        with.add((*measured_.tip)[i] - state.tip.p[static_cast<int>(i)], rates.compliance.data() + 6 * i,
                 measured_.tip_deviation);
    return true;
  }

 private:
  const Arm& arm_;
  const ArmMeasurement& measured_;
  ArmLoad load_;
  ArmOptions options_;
  ArmWorkspace& work_;
};

}  // namespace

ArmSensed arm_sense(const Arm& arm, const ArmMeasurement& measured, const ArmLoad& load, bool force_alone,
                    const ArmOptions& options, ArmWorkspace& work) {
  ArmSensed sensed;
  const std::size_t unknowns = force_alone ? 3 : 6;
  std::string misfit(
      measurement_misfit(arm.tendons.size(), measured.held, measured.answers, measured.tip ? 3 : 0, unknowns,
                         {measured.tension_deviation, measured.change_deviation, measured.tip_deviation}));
  const auto finite = [](double x) { return std::isfinite(x); };
  if (misfit.empty() && measured.tip && !std::ranges::all_of(*measured.tip, finite))
    misfit = "the tip's place is not finite";
  if (misfit.empty()) misfit = basis_misfit(options.model, options.order, options.elements);
  if (!misfit.empty()) {
    sensed.report = {Status::bad_input, 0, 0, FixedText<240>(misfit)};
    sensed.state = work.impl().state;
    return sensed;
  }
  MeasuredArm body(arm, measured, load, options, work);
  const FoundWrench found = search_wrench({.first = load.wrench,
                                           .unknowns = unknowns,
                                           .known = load.wrench,
                                           .length = arm.length(),
                                           .usual = usual_force(arm),
                                           .from_last = options.from_last},
                                          body);
  sensed.report = found.report;
  report_misfit(found.misfit, sensed.report);
  if (sensed.report.status == Status::converged && sensed.report.message.empty() && !force_alone &&
      found.measured == unknowns)
    sensed.report.message = FixedText<240>(
        "as much is measured as a wrench has components, so that other wrenches may explain it as well and "
        "nothing would tell: measure more, or ask the force alone");
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = found.wrench[k] - load.wrench[k];
  sensed.covariance = found.covariance;
  sensed.misfit = found.misfit;
  sensed.condition = found.condition;
  sensed.state = work.impl().state;
  return sensed;
}

}  // namespace sinew::inline v1
