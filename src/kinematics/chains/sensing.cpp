/// The wrench from tensions.
#include "kinematics/chain_sensing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/chains/path.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

template <class Space>
Report check_measured(const ChainLegs<Space>& robot, std::span<const MeasuredTension> measured,
                      const ChainState<Space>& state) {
  Report report;
  const auto refuse = [&](std::string_view why) {
    report.status = Status::bad_input;
    report.message.append(why);
    return report;
  };
  if (!fits(robot, state)) return refuse("the state is of another robot");
  if (measured.size() != static_cast<std::size_t>(Space::dof))
    return refuse("a wrench is told by as many tensions as the platform has freedoms");
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const auto [leg, tension] = measured[k];
    if (leg < 0 || leg >= static_cast<int>(robot.legs.size()) ||
        state.hold[static_cast<std::size_t>(leg)].length_of < 0 || !std::isfinite(tension))
      return refuse("a tension that is measured is a number, and of a tendon whose length is held");
    for (std::size_t j = 0; j < k; ++j)
      if (measured[j].leg == leg) return refuse("a leg's tension is measured once");
  }
  return check_hold(robot, std::span<const TendonConstraint>(state.hold));
}

/// The platform's pose by tensions of lengths that are held.
template <class Space>
class Sensor {
 public:
  static constexpr int dof = Space::dof;
  using Rows = Eigen::Matrix<double, dof, dof, Eigen::RowMajor>;

  Sensor(ChainGroup<Space>& group, std::span<const MeasuredTension> wanted) : group_(group), wanted_(wanted) {
    for (int k = 0; k < group.limbs(); ++k) unit_ += group.stiffness(k) / (group.length(k) * group.length(k));
  }

  /// Of the legs' own equations, and of tensions over Σ EI/ℓ².
  double error() const {
    double error = group_.limb_error();
    for (const MeasuredTension& one : wanted_)
      error = worse(error, (group_.effort(one.leg) - one.tension) / unit_);
    return error;
  }
  /// ∂tensions/∂pose, after `linearise`.
  Rows rows() const {
    Rows rows;
    for (int k = 0; k < dof; ++k) rows.row(k) = group_.effort_jacobian(leg(k)).transpose();
    return rows;
  }
  /// Newton's step. Infinite where there is none.
  double plan() {
    const Rows matrix = rows();
    Vec<double, dof> wanted, twist;
    for (int k = 0; k < dof; ++k)
      wanted[k] = wanted_[static_cast<std::size_t>(k)].tension - group_.closing_effort(leg(k));
    if (!solve(MatrixView(matrix.data(), dof, dof), MatrixView(wanted.data(), dof, 1),
               std::span(twist.data(), static_cast<std::size_t>(dof))))
      return std::numeric_limits<double>::infinity();
    return group_.plan(twist);
  }

 private:
  int leg(int k) const { return wanted_[static_cast<std::size_t>(k)].leg; }

  ChainGroup<Space>& group_;
  std::span<const MeasuredTension> wanted_;
  double unit_ = 0;
};

void say_not_reached(const ParameterPath& end, const ChainWork& work, Report& report) {
  report.status = end.ran_out ? Status::iteration_limit : Status::stalled;
  if (!note_stop(work.stop, report))
    report.message.append(end.ran_out ? "the iterations ran out before these tensions were met"
                                      : "no wrench near the unloaded platform makes the tendons so tense; "
                                        "check the tensions and lengths");
}

}  // namespace

template <class Space>
SensedLoad<Space> sense_wrench(const ChainLegs<Space>& robot, std::span<const MeasuredTension> measured,
                               ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  SensedLoad<Space> sensed{check_measured(robot, measured, state),
                           Mat<double, Space::dof, Space::dof>::Zero()};
  Report& report = sensed.report;
  if (!report.ok()) return sensed;
  std::vector<MeasuredTension> first(measured.begin(), measured.end()), now = first;
  for (MeasuredTension& one : first) {
    const auto leg = static_cast<std::size_t>(one.leg);
    one.tension = state.legs[leg].tension[static_cast<std::size_t>(state.hold[leg].length_of)];
  }
  state.wrench.setZero();
  auto& memory = memory_of(work, robot, state, options);
  auto& group = memory.group;
  Sensor<Space> sensor(group, now);
  const auto put = [&](double part) {
    for (std::size_t k = 0; k < now.size(); ++k)
      now[k].tension = std::lerp(first[k].tension, measured[k].tension, part);
  };
  const ParameterPath end =
      follow_path(memory, work.stop, options.max_iterations, put,
                  ChainSteps{[&] { return sensor.error(); }, [&] { return sensor.plan(); }});
  report.residual = sensor.error() * group.radius();
  report.iterations = end.iterations;
  group.measure();
  state = group.state();
  state.wrench = -group.wrench_residual();
  if (end.progress < 1) {
    say_not_reached(end, work, report);
  } else if (!(regularity<Space>(MatrixView(sensor.rows().data(), Space::dof, Space::dof), 1,
                                 group.radius()) > 1e-10)) {
    report.status = Status::singular;
    report.message.append("here the tensions do not tell the wrench: some motion changes none of them");
  } else {
    name_slack(state, report);
    // K R⁻¹, by Rᵀ on its transpose
    constexpr int dof = Space::dof;
    const typename Sensor<Space>::Rows by_pose = sensor.rows().transpose(),
                                       turned = group.stiffness().transpose();
    typename Sensor<Space>::Rows found;
    if (!solve(MatrixView(by_pose.data(), dof, dof), MatrixView(turned.data(), dof, dof),
               std::span(found.data(), static_cast<std::size_t>(dof * dof))))
      found.setConstant(std::numeric_limits<double>::quiet_NaN());
    sensed.sensitivity = found.transpose();
  }
  return sensed;
}

#define SINEW_OF(Space)                                                                                   \
  template SINEW_API SensedLoad<Space> sense_wrench(const ChainLegs<Space>&,                              \
                                                    std::span<const MeasuredTension>, ChainState<Space>&, \
                                                    ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
