#include "kinematics/arms/sense_search.hpp"

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
  bool compare(std::vector<double>& off, std::vector<double>& rows) override {
    const ArmState& state = work_.impl().state;
    const ArmRates rates = arm_rates(arm_, work_, false);
    if (!rates.regular) return false;
    const auto add = [&](double difference, const double* row, double deviation) {
      off.push_back(difference / deviation);
      for (std::size_t k = 0; k < 6; ++k) rows.push_back(row[k] / deviation);
    };
    for (std::size_t i = 0; i < measured_.answers.size(); ++i) {
      if (std::isnan(measured_.answers[i])) continue;
      const bool is_change = measured_.held[i].held == TendonHeld::tension;
      add(measured_.answers[i] - (is_change ? state.changes[i] : state.tensions[i]),
          rates.answers_by_wrench.data() + 6 * i,
          is_change ? measured_.change_deviation : measured_.tension_deviation);
    }
    if (measured_.tip)
      for (std::size_t i = 0; i < 3; ++i)
        add((*measured_.tip)[i] - state.tip.p[static_cast<int>(i)], rates.compliance.data() + 6 * i,
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
  const auto misfit =
      measurement_misfit(arm.tendons.size(), measured.held, measured.answers, measured.tip ? 3 : 0, unknowns);
  if (!misfit.empty()) {
    sensed.report = {Status::bad_input, 0, 0, FixedText<240>(misfit)};
    sensed.state = work.impl().state;
    return sensed;
  }
  MeasuredArm body(arm, measured, load, options, work);
  const FoundWrench found = search_wrench({.first = load.wrench,
                                           .unknowns = unknowns,
                                           .length = arm.length(),
                                           .usual = usual_force(arm),
                                           .from_last = options.from_last},
                                          body);
  sensed.report = found.report;
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = found.wrench[k] - load.wrench[k];
  sensed.covariance = found.covariance;
  sensed.misfit = found.misfit;
  sensed.condition = found.condition;
  sensed.state = work.impl().state;
  return sensed;
}

}  // namespace sinew::inline v1
