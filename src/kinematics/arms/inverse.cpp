/// Inverse statics of an arm: tensions that take its tip to a target.
#include "kinematics/arms/arm_work.hpp"
#include "kinematics/arms/tensions/refined_search.hpp"
#include "kinematics/arms/tensions/target_rows.hpp"

namespace sinew::inline v1 {
namespace {

/// Equilibria and their Newton's steps of a search, of all its beginnings together [1]: a bound of time.
constexpr int most_work_of_arm = 10000;

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
  void bring_back() override {
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

class RefinedArm final : public RefinedSearch {
 public:
  RefinedArm(const Arm& arm, const ArmLoad& load, const ArmOptions& options, ArmWorkspace& work)
      : arm_(arm),
        load_(load),
        options_(options),
        work_(work) {}
  std::unique_ptr<PulledBody> body(bool is_first) override {
    ArmOptions options = options_;
    if (is_first) options.accuracy = 0;  // the model's usual polynomials
    return std::make_unique<PulledArm>(arm_, load_, options, work_);
  }
  Report refine(const std::vector<double>& tensions) override {
    return PulledArm(arm_, load_, options_, work_).pull(tensions, true);
  }
  bool refines_nearest() const override { return true; }
  Report as_found(PulledBody& body, const std::vector<double>& tensions) override {
    return body.pull(tensions, true);
  }

 private:
  const Arm& arm_;
  const ArmLoad& load_;
  const ArmOptions& options_;
  ArmWorkspace& work_;
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
  std::string text(arm.tendons.empty() ? "the arm has no tendons that could move its tip"
                                       : target_misfit(target));
  if (text.empty()) text = basis_misfit(options.arm.model, options.arm.order, options.arm.elements);
  if (!text.empty()) {
    answer({Status::bad_input, 0, 0, FixedText<240>(text)});
    best.state.report = best.report;
    return best;
  }
  const double length = arm.length(), usual = usual_tension(arm);
  TensionSearch search{.tendons = arm.tendons.size(),
                       .length = length,
                       .usual = usual,
                       .most = most_tension(options, usual),
                       .asked = options.most_tension,
                       .precision = options.precision,
                       .starts = options.starts,
                       .from_last = options.arm.from_last,
                       .most_work = most_work_of_arm};
  return answer(RefinedArm(arm, load, options.arm, work).run(target, search));
}

}  // namespace sinew::inline v1
