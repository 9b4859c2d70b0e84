#include "kinematics/arms/inverse_search.hpp"

#include "kinematics/arms/arm_work.hpp"

namespace sinew::inline v1 {
namespace {

class PulledArm final : public PulledBody {
 public:
  PulledArm(const Arm& arm, const ArmLoad& load, const ArmOptions& options, ArmWorkspace& work)
      : arm_(arm),
        load_(load),
        options_(options),
        work_(work) {}
  Report pull(const std::vector<double>& tensions, bool from_last) override {
    ArmOptions options = options_;
    options.from_last = from_last;
    return arm_forward(arm_, as_commands(tensions), load_, options, work_).report;
  }
  const SE3<double>& tip() const override { return work_.impl().state.tip; }
  bool rates(std::vector<double>& J) override {
    ArmRates rates = arm_rates(arm_, work_, false);
    J = std::move(rates.J);
    return rates.regular;
  }
  std::vector<double> last_tensions() const override {
    return work_.impl().level >= 0 ? work_.impl().state.tensions : std::vector<double>();
  }
  void keep() override {
    kept_level_ = work_.impl().level;
    kept_ = work_.impl().rod().work().y;
  }
  /// The workspace begins again from what was kept.
  void bring_back() {
    if (kept_level_ < 0) return;
    work_.impl().level = kept_level_;
    work_.impl().rod().work().y = kept_;
  }

 private:
  const Arm& arm_;
  const ArmLoad& load_;
  ArmOptions options_;
  ArmWorkspace& work_;
  int kept_level_ = -1;
  std::vector<double> kept_;  ///< coordinates of the arm's strain
};

}  // namespace

ArmInverse arm_inverse(const Arm& arm, const ArmTarget& target, const ArmLoad& load,
                       const ArmInverseOptions& options, ArmWorkspace& work) {
  ArmInverse best;
  const auto answer = [&](const Report& report) {
    best.report = report;
    best.state = work.impl().state;
    return best;
  };
  const std::string_view text =
      arm.tendons.empty() ? "the arm has no tendons that could move its tip" : target_misfit(target);
  if (!text.empty()) {
    answer({Status::bad_input, 0, 0, FixedText<240>(text)});
    best.state.report = best.report;
    return best;
  }
  const double length = arm.length(), usual = usual_tension(arm);
  TensionSearch search{.tendons = arm.tendons.size(),
                       .length = length,
                       .usual = usual,
                       .most = options.most_tension > 0 ? options.most_tension : 1e3 * usual,
                       .precision = options.precision,
                       .starts = options.starts,
                       .from_last = options.arm.from_last,
                       .most_work = 10000};
  // The model's usual polynomials find the way; those that the accuracy needs only its end.
  ArmOptions coarse = options.arm;
  coarse.accuracy = 0;
  int iterations = 0;
  for (int round = 0; round < 4; ++round) {
    PulledArm body(arm, load, round == 0 ? coarse : options.arm, work);
    const FoundTensions found = search_tensions(target, search, body);
    iterations += found.report.iterations;
    const Status status = found.report.status;
    if (status == Status::bad_input || status == Status::unsupported || status == Status::stopped)
      return answer(found.report);
    if (!(found.report.residual < 1e300))
      return answer(
          {Status::stalled, iterations, 0, FixedText<240>("no equilibrium was found to begin from")});
    // the workspace is left in what is answered
    body.bring_back();
    PulledArm end(arm, load, options.arm, work);
    answer(end.pull(found.tensions, true));
    best.report.iterations = iterations;
    if (!best.report.is_solved()) return best;
    best.report.residual = off_target(target, best.state.tip, length);
    if (found.report.residual > options.precision || best.report.residual <= options.precision) break;
    search.from_last = true;
    search.starts = 1;
    search.most_work = 1000;
  }
  if (best.report.residual > 10 * options.precision) {
    best.report.status = Status::unreachable;
    best.report.message = unreachable_words("tip", "the arm's", options.most_tension, best.report.residual);
  }
  return best;
}

}  // namespace sinew::inline v1
