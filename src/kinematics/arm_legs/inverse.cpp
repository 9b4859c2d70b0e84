/// Inverse statics: tensions that take the platform to a target.
#include <algorithm>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/legs_walk.hpp"
#include "kinematics/arms/tensions/refined_search.hpp"
#include "kinematics/arms/tensions/target_rows.hpp"

namespace sinew::inline v1 {
namespace {

/// Equilibria and their Newton's steps of a search, of all its beginnings together [1]: a bound of time, less
/// than an arm's, since each step is of several legs.
constexpr int most_work_of_inverse = 3000;

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
  void bring_back() override { walk_.bring_back(); }

 private:
  const ArmLegs& robot_;
  const ArmLegsLoad& load_;
  ArmLegsWorkspace& work_;
  LegsWalk walk_;
};

class RefinedLegs final : public RefinedSearch {
 public:
  RefinedLegs(const ArmLegs& robot, const ArmLegsLoad& load, const ArmOptions& options,
              ArmLegsWorkspace& work)
      : robot_(robot),
        load_(load),
        options_(options),
        work_(work) {}
  std::unique_ptr<PulledBody> body(bool is_first) override {
    return std::make_unique<PulledLegs>(robot_, load_, options_, work_,
                                        is_first ? LegsEnd::coarse : LegsEnd::anywhere);
  }
  Report refine(const std::vector<double>& tensions) override {
    ArmOptions last = options_;
    last.from_last = true;
    solve_legs(robot_, {robot_, as_commands(tensions), load_}, last, work_);
    return work_.impl().state.report;
  }
  bool refines_nearest() const override { return false; }
  Report as_found(PulledBody&, const std::vector<double>&) override { return work_.impl().state.report; }

 private:
  const ArmLegs& robot_;
  const ArmLegsLoad& load_;
  const ArmOptions& options_;
  ArmLegsWorkspace& work_;
};

/// In the plane bending about y alone counts.
Arm bending_as_it_may(const ArmLegs& robot, const ArmLeg& leg) {
  Arm arm = leg.arm;
  if (robot.is_planar)
    for (ArmSection& section : arm.sections) section.start.bending_x = section.start.bending_y;
  return arm;
}

Report inverse_misfit(const ArmLegs& robot, const ArmTarget& target, const ArmLegsLoad& load,
                      const ArmOptions& options, const ArmLegsWorkspace& work) {
  const std::vector<TendonCommand> loose(robot.tendons());
  Report misfit = legs_misfit(robot, loose, load, options, work);
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
  return misfit;
}

/// The least of the legs' [N].
double usual_tension_of(const ArmLegs& robot) {
  double usual = 1e300;
  for (const ArmLeg& leg : robot.legs)
    if (!leg.arm.tendons.empty()) usual = std::min(usual, usual_tension(bending_as_it_may(robot, leg)));
  return usual;
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
  if (const Report misfit = inverse_misfit(robot, target, load, options.arm, work); !misfit.ok()) {
    answer(misfit);
    best.state.report = misfit;
    return best;
  }
  const double usual = usual_tension_of(robot);
  TensionSearch search{.tendons = robot.tendons(),
                       .what = "platform",
                       .whose = "the longest leg's",
                       .length = legs_size(robot),
                       .usual = usual,
                       .most = most_tension(options, usual),
                       .asked = options.most_tension,
                       .precision = options.precision,
                       .starts = options.starts,
                       .from_last = options.arm.from_last,
                       .most_work = most_work_of_inverse};
  return answer(RefinedLegs(robot, load, options.arm, work).run(target, search));
}

}  // namespace sinew::inline v1
