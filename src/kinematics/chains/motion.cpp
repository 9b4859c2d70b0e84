#include <cmath>

#include "base/limits.hpp"
#include "kinematics/chains/chain_motion.hpp"
#include "kinematics/chains/leg_system.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int most = max_chain_joints + 1;  // and a motor
using Angles = std::array<double, most>;

/// One leg on the way: how its angles, the motor's first, follow the platform.
template <class Space>
class LegMotion {
 public:
  using Pose = typename Space::Pose;

  LegMotion(const ChainLeg<Space>& leg, bool has_motor, const Pose& from, const Pose& to)
      : leg_(leg),
        at_rest_(leg.base),
        from_(from),
        to_(to),
        motors_(has_motor ? 1 : 0),
        size_(static_cast<std::size_t>(leg.chain.joints()) + motors_),
        twist_(twist_between(from, to)) {}

  std::size_t size() const { return size_; }
  std::size_t motors() const { return motors_; }
  const ChainLeg<Space>& leg() const { return leg_; }

  /// Closure error and its slope g by all angles.
  double slope(double part, const Angles& angles, Angles& g) {
    const auto platform = Space::frame(std::get<Pose>(between(from_, to_, part)));
    if constexpr (Space::dimension == 2)
      if (motors_ > 0)
        leg_.base = SE2<double>::from(at_rest_.p.x(), at_rest_.p.y(), at_rest_.angle() + angles[0]);
    const std::span<const double> joints(angles.data() + motors_, size_ - motors_);
    close_chain(leg_, platform, joints, at_);
    if constexpr (Space::dimension == 2)
      if (motors_ > 0) g[0] = motor_slope(leg_, joints, at_);
    for (std::size_t j = motors_; j < size_; ++j) g[j] = at_.c_q[j - motors_];
    return at_.c;
  }

  /// dθ/ds, s from 0 to 1 between the poses.
  void rate(double part, const Angles& angles, const ChainMotionOptions& options, Angles& rate) {
    Angles g;
    slope(part, angles, g);
    double needed = 0, squares = 0;
    for (int k = 0; k < Space::dof; ++k) needed -= at_.c_x[k] * twist_[k];
    for (std::size_t j = 0; j < size_; ++j) squares += g[j] * g[j];
    for (std::size_t j = 0; j < size_; ++j) rate[j] = g[j] * (needed / squares);
    if (options.objective != Objective::none) add_null_motion(angles, g, squares, options, rate);
  }

 private:
  /// Downhill on the objective in what g leaves free, no faster than the options allow.
  void add_null_motion(const Angles& angles, const Angles& g, double squares,
                       const ChainMotionOptions& options, Angles& rate) const {
    Angles down{};
    for (std::size_t j = motors_; j < size_; ++j) {
      const std::size_t joint = j - motors_;
      if (options.objective == Objective::singularity) {
        for (std::size_t k = 0; k + motors_ < size_; ++k) down[j] += at_.c_qq(joint, k) * at_.c_q[k];
        down[j] /= leg_.chain.length;
      } else {
        const double angle = angles[j];
        down[j] = options.objective == Objective::limits
                      ? -angle * angle * angle
                      : -leg_.chain.spring(static_cast<int>(joint)) * angle;
      }
    }
    double along = 0, size = 0;
    for (std::size_t j = 0; j < size_; ++j) along += down[j] * g[j];
    for (std::size_t j = 0; j < size_; ++j) {
      down[j] -= along / squares * g[j];
      size += down[j] * down[j];
    }
    const double eager = 4;  // small enough that RK4 stays stable, whatever its steps
    const double share = std::min(eager, options.null_step / std::sqrt(size + 1e-300));
    for (std::size_t j = 0; j < size_; ++j) rate[j] += share * down[j];
  }

  ChainLeg<Space> leg_;
  typename Space::template Frame<double> at_rest_;
  Pose from_, to_;
  std::size_t motors_, size_;
  Vec<double, Space::dof> twist_;
  ChainClosure<Space> at_;
};

template <class Space>
void runge_kutta(LegMotion<Space>& motion, int steps, const ChainMotionOptions& options, Angles& angles) {
  const double h = 1.0 / steps;
  const std::size_t n = motion.size();
  Angles k1, k2, k3, k4, at;
  const auto ahead = [&](const Angles& k, double by) {
    for (std::size_t j = 0; j < n; ++j) at[j] = angles[j] + by * k[j];
  };
  for (int step = 0; step < steps; ++step) {
    const double part = step * h;
    motion.rate(part, angles, options, k1);
    ahead(k1, 0.5 * h);
    motion.rate(part + 0.5 * h, at, options, k2);
    ahead(k2, 0.5 * h);
    motion.rate(part + 0.5 * h, at, options, k3);
    ahead(k3, h);
    motion.rate(part + h, at, options, k4);
    for (std::size_t j = 0; j < n; ++j) angles[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
}

/// Runge-Kutta with twice as many steps again and again, extrapolated, until that changes nothing.
template <class Space>
bool flow(LegMotion<Space>& motion, const ChainMotionOptions& options, Angles& angles) {
  const Angles start = angles;
  Angles coarse = start, fine, best{};
  runge_kutta(motion, 1, options, coarse);
  for (int steps = 2; steps <= 1024; steps *= 2) {
    fine = start;
    runge_kutta(motion, steps, options, fine);
    double change = 0;
    for (std::size_t j = 0; j < motion.size(); ++j) {
      const double extrapolated = fine[j] + (fine[j] - coarse[j]) / 15;
      change = std::max(change, std::abs(extrapolated - best[j]));
      if (!std::isfinite(extrapolated)) return false;
      best[j] = extrapolated;
    }
    angles = best;
    if (change < 1e-14 || (steps > 64 && change < 1e-12)) return true;
    coarse = fine;
  }
  return false;
}

/// The shortest way back onto the closure.
template <class Space>
double put_right(LegMotion<Space>& motion, Angles& angles) {
  Angles g;
  double c = motion.slope(1, angles, g);
  for (int round = 0; round < 10 && std::isfinite(c); ++round) {
    double squares = 0;
    for (std::size_t j = 0; j < motion.size(); ++j) squares += g[j] * g[j];
    for (std::size_t j = 0; j < motion.size(); ++j) angles[j] -= g[j] * (c / squares);
    c = motion.slope(1, angles, g);
    if (std::abs(c) < 1e-16) break;
  }
  return c;
}

}  // namespace

template <class Space>
Report follow_least_norm(ChainLegs<Space>& robot, const typename Space::Pose& from,
                         const typename Space::Pose& to, std::span<ChainLegState> legs,
                         const ChainMotionOptions& options) {
  Report report;
  if (legs.size() != robot.legs.size()) {
    report.status = Status::bad_input;
    report.message.append("each leg of the robot needs a state");
    return report;
  }
  std::vector<ChainLegState> moved(legs.begin(), legs.end());
  auto bases = robot.legs;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const ChainLeg<Space>& leg = robot.legs[i];
    LegMotion<Space> motion(leg, robot.has_base_motors, from, to);
    Angles angles{}, g;
    const std::size_t motors = motion.motors(), joints = motion.size() - motors;
    std::copy_n(legs[i].angles.begin(), joints, angles.begin() + static_cast<std::ptrdiff_t>(motors));
    motion.slope(0, angles, g);
    double squares = 0;
    for (std::size_t j = 0; j < motion.size(); ++j) squares += g[j] * g[j];
    const auto refuse = [&](Status status, std::string_view why) {
      say_leg(report, status, i, why);
      return report;
    };
    if (!(squares > 1e-16 * leg.chain.length * leg.chain.length))
      return refuse(Status::singular, " is straight or folded: no motion of its joints is the shortest");
    const double turn = leg.chain.turn(legs[i].of(leg.chain));
    const bool is_exact = options.rk4_steps == 0;
    if (!is_exact || options.objective != Objective::none)
      // an objective's motion need not be exact: only the closure counts
      runge_kutta(motion, is_exact ? 16 : options.rk4_steps, options, angles);
    else if (!flow(motion, options, angles))
      return refuse(Status::unreachable, " cannot follow: its joints would have to move without bound");
    const double error = is_exact ? put_right(motion, angles) : motion.slope(1, angles, g);
    // what rounding leaves, or Runge-Kutta's own error: more means that the pose is out of reach
    if (!(std::abs(error) < (is_exact ? 1e-12 : 1e-2) * leg.chain.length))
      return refuse(Status::unreachable, " cannot follow: it does not reach the pose");
    report.residual = std::max(report.residual, std::abs(error));
    if (motors > 0) bases[i].base = motion.leg().base;
    std::copy_n(angles.begin() + static_cast<std::ptrdiff_t>(motors), joints, moved[i].angles.begin());
    if (!leg.has_strut() && turn * leg.chain.turn(moved[i].of(leg.chain)) < 0)
      return refuse(Status::unreachable, " cannot follow: it would have to pass through straight");
  }
  std::copy(moved.begin(), moved.end(), legs.begin());
  robot.legs = std::move(bases);
  return report;
}

#define SINEW_OF(Space)                                                                        \
  template Report follow_least_norm(ChainLegs<Space>&, const Space::Pose&, const Space::Pose&, \
                                    std::span<ChainLegState>, const ChainMotionOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
