#include "kinematics/rods/path.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "sinew/math/linalg.hpp"

namespace sinew::inline v0 {
namespace {

/// A step of the platform as one length [m].
double size_of(const Vec<double, 6>& twist, double radius) {
  return std::hypot(twist.head<3>().norm(), radius * twist.tail<3>().norm());
}

template <class System>
void set(System& system, const RodTarget& from, const RodTarget& to, double part) {
  for (int k = 0; k < system.feeds(); ++k)
    system.set_length(k, std::lerp(from.lengths[at(k)], to.lengths[at(k)], part));  // exact at the end
  system.set_wrench(from.wrench + part * (to.wrench - from.wrench));
}

}  // namespace

template <class System>
bool correct(System& system, int& iterations, double& residual, double tolerance) {
  const auto step = [&] {
    if (!system.linearise()) return false;
    system.move(system.step(true));
    return true;
  };
  return contract([&] { return system.evaluate(); }, step, tolerance, rod_rounding, iterations, residual);
}

template <class System>
bool correct_rods(System& system, int& iterations, double& residual, double tolerance) {
  const auto error = [&] {
    system.evaluate();
    return system.rod_error();
  };
  const auto step = [&] {
    system.linearise();  // the platform's stiffness, which may be singular, is not asked for
    system.move(System::Twist::Zero());
    return true;
  };
  return contract(error, step, tolerance, rod_rounding, iterations, residual);
}

template <class System>
RodTarget present(const System& system) {
  RodTarget target;
  for (int k = 0; k < system.feeds(); ++k) target.lengths[at(k)] = system.length(k);
  target.wrench = system.wrench();
  return target;
}

template <class System>
int unstable_directions(const System& system) {
  return signs_of(system).unstable;
}

template <class System>
RodSigns signs_of(const System& system) {
  RodSigns signs;
  for (int k = 0; k < system.rods(); ++k) {
    const auto [in_plane, aside] = system.unstable_with_tip_held(k);
    signs.own += in_plane + aside;
  }
  signs.is_odd = system.factors().has_negative_determinant() != (signs.own % 2 == 1);
  signs.unstable = signs.own;
  std::array<double, 6> values;
  symmetric_eigenvalues(system.stiffness(), values);
  for (const double value : values) signs.unstable += value < 0;
  return signs;
}

namespace {

/// One path being followed.
template <class System>
class Follower {
 public:
  Follower(System& system, const RodTarget& target, const RodPathOptions& options,
           typename System::Snapshot& spare)
      : system_(system),
        from_(present(system)),
        to_(target),
        options_(options),
        spare_(spare) {}

  RodPathEnd run() {
    signs_ = signs_of(system_);
    const ParameterOptions how{{1, least, options_.stop}, shortest, options_.max_iterations};
    follow_parameter(end_, how, [&](double next, double taken) { return attempt(next, taken); });
    return end_;
  }

 private:
  /// A path ends where its strides are shorter than this part of what is behind, or of the whole.
  static constexpr double shortest = 1e-9, least = 1e-18;
  static constexpr double longest = 0.15;   ///< predictor, over a rod's length
  static constexpr double crossing = 1e-5;  ///< ... over which signs may change

  ParameterStep attempt(double next, double taken) {
    system_.save(spare_);
    if (!reach(next)) {
      retreat();
      const double fits = 0.9 * longest * system_.length(0) / predicted_;
      return {ParameterStep::failed, taken * (fits > 1e-6 ? std::min(fits, 0.25) : 1e-6)};  // NaN too
    }
    const double verifiable = crossing * system_.length(0) / predicted_ * taken;
    const RodSigns now = options_.may_stray ? signs_ : signs_of(system_);
    const bool changes = now != signs_;
    if (changes && predicted_ > crossing * system_.length(0)) {
      retreat();
      return {ParameterStep::crossed, 0, verifiable};
    }
    signs_ = now;
    return {changes ? ParameterStep::reached_other_side : ParameterStep::reached, quick_ ? 2 * taken : taken,
            verifiable};
  }

  /// Predictor with the last factors, Newton's method after it. The corrections must stay small beside the
  /// prediction: else it may have found another branch.
  bool reach(double part) {
    set(system_, from_, to_, part);
    system_.evaluate();
    const Vec<double, 6> ahead = system_.step(false);
    predicted_ = size_of(ahead, system_.radius());
    if (!(predicted_ <= longest * system_.length(0))) return false;
    system_.move(ahead);
    const SE3<double> predicted = system_.platform();
    const int before = end_.iterations;
    double residual = 0;
    if (!correct(system_, end_.iterations, residual, options_.tolerance)) return false;
    Vec<double, 6> correction;
    correction << system_.platform().p - predicted.p,
        predicted.R.inverse().compose(system_.platform().R).log();
    if (size_of(correction, system_.radius()) > (options_.may_stray ? 0.5 : 0.3) * predicted_ + 1e-9)
      return false;
    while (!system_.is_finest() && system_.truncation() > coarse_truncation) {
      system_.refine();
      if (!correct(system_, end_.iterations, residual, options_.tolerance)) return false;
    }
    if (!system_.linearise()) return false;
    quick_ = end_.iterations - before <= 4;
    end_.residual = residual;
    return true;
  }

  void retreat() {
    system_.restore(spare_);
    system_.evaluate();
    system_.linearise();
  }

  System& system_;
  RodTarget from_;
  const RodTarget& to_;
  const RodPathOptions& options_;
  typename System::Snapshot& spare_;
  RodPathEnd end_;
  RodSigns signs_;
  bool quick_ = false;
  double predicted_ = 0;  ///< length of the last predictor [m]
};

}  // namespace

template <class System>
RodPathEnd follow(System& system, const RodTarget& target, const RodPathOptions& options,
                  typename System::Snapshot& spare) {
  return Follower<System>(system, target, options, spare).run();
}

#define SINEW_FOR(System)                                                                          \
  template bool correct(System&, int&, double&, double);                                           \
  template bool correct_rods(System&, int&, double&, double);                                      \
  template RodPathEnd follow(System&, const RodTarget&, const RodPathOptions&, System::Snapshot&); \
  template RodTarget present(const System&);                                                       \
  template RodSigns signs_of(const System&);                                                       \
  template int unstable_directions(const System&);
SINEW_FOR_EACH_ROD_SYSTEM(SINEW_FOR)
#undef SINEW_FOR

namespace {

constexpr int N = coarse_nodes;

/// The rod that pushes only sideways, unit length: θ and fd for the direction of its tip, tan γ = d/w. One
/// parameter, from the straight rod on.
bool rest_shape(double angle, std::array<double, N + 1>& unknowns) {
  const auto& basis = GalerkinBasis<coarse_nodes>::get();
  unknowns.fill(0);
  const int strides = std::max(1, static_cast<int>(std::ceil(angle / 0.2)));
  for (int k = 1; k <= strides; ++k) {
    const double d = std::sin(angle * k / strides), w = std::cos(angle * k / strides);
    double largest = 1;
    for (int iteration = 0; iteration < 20 && !(largest < 1e-13); ++iteration) {
      std::array<double, (N + 1) * (N + 1)> matrix{};
      std::array<double, N + 1> gap{}, step{};
      for (int i = 0; i < N; ++i) {
        const double s = std::sin(unknowns[at(i)]), c = std::cos(unknowns[at(i)]), weight = basis.weight[i];
        gap[at(i)] = -weight * unknowns[N] * c;
        for (int j = 0; j < N; ++j) {
          gap[at(i)] += basis.bending[i][j] * unknowns[at(j)];
          matrix[at(i * (N + 1) + j)] = basis.bending[i][j];
        }
        matrix[at(i * (N + 2))] += weight * unknowns[N] * s;
        matrix[at(i * (N + 1) + N)] = -weight * c;
        matrix[at(N * (N + 1) + i)] = weight * (w * c + d * s);
        gap[N] += weight * (w * s - d * c);
      }
      if (!solve(MatrixView(matrix.data(), N + 1, N + 1), MatrixView(gap.data(), N + 1, 1), step))
        return false;
      largest = 0;
      for (int i = 0; i <= N; ++i) {
        unknowns[at(i)] -= step[at(i)];
        largest = std::max(largest, std::abs(step[at(i)]));
      }
      if (!(largest < 1e3)) return false;
    }
    if (!(largest < 1e-9)) return false;
  }
  return true;
}

}  // namespace

bool rest_at(RodSystem& system, const SE3<double>& platform) {
  const auto& basis = GalerkinBasis<coarse_nodes>::get();
  system.set_platform(platform);
  for (int k = 0; k < system.rods(); ++k) {
    const auto [d, w, lateral, stiffness] = system.aim(k);
    const double distance = std::hypot(d, w);
    if (!(d > 1e-9 * distance) || !(w > 0)) return false;
    std::array<double, N + 1> shape;
    if (!rest_shape(std::atan2(d, w), shape)) return false;
    double reach = 0;
    for (int j = 0; j < N; ++j)
      reach += basis.weight[j] * (d * std::sin(shape[at(j)]) + w * std::cos(shape[at(j)])) / distance;
    const double length = distance / reach;
    system.set_shape(k, length, std::span(shape).first(N), shape[N] * stiffness / (length * length), 0,
                     lateral);
  }
  system.set_wrench(RodSystem::Wrench::Zero());
  system.evaluate();
  system.set_wrench(-system.missing());
  system.evaluate();
  return system.linearise();
}

namespace {

/// Rods that are nearly in equilibrium: exactly, with their wrench. False where they do not get there.
template <class System>
bool settle_rods(System& system) {
  int iterations = 0;
  double residual = 0;
  if (!correct_rods(system, iterations, residual, rod_tolerance)) return false;
  while (!system.is_finest() && system.truncation() > coarse_truncation) {
    system.refine();
    if (!correct_rods(system, iterations, residual, rod_tolerance)) return false;
  }
  system.set_wrench(System::Wrench::Zero());
  system.evaluate();
  system.linearise();
  system.set_wrench(-system.missing());
  system.evaluate();
  return system.linearise();
}

}  // namespace

/// From the cubics between guides and tips.
bool rest_at(TangentSystem& system, const SE3<double>& platform) {
  system.set_platform(platform);
  if (!system.draw_rods()) return false;
  constexpr double near = 1e-6;
  system.evaluate();
  for (int k = 0; k < 20 && !(system.rod_error() < near); ++k) {
    system.linearise();
    system.move_to_rest(0.1);
    system.evaluate();
  }
  return system.rod_error() < near && settle_rods(system);
}

/// From rods held at the lengths of those cubics, each in equilibrium by itself. Where no length is found at
/// which nothing pulls, those are kept: any equilibrium will do.
bool rest_at(GeneralSystem& system, const SE3<double>& platform) {
  system.set_platform(platform);
  if (!system.draw_rods()) return false;
  constexpr double near = 1e-6;
  double fed = 1;
  system.evaluate();
  for (int k = 0; k < 30 && !(fed < near && system.rod_error() < near); ++k) {
    system.linearise();
    fed = system.move_to_rest(0.02);
    system.evaluate();
  }
  if (fed < near && system.rod_error() < near && settle_rods(system)) return true;
  return system.draw_rods() && settle_rods(system);
}

template <class Rods>
bool rest_at(Mechanism<Rods>& system, const SE3<double>& platform) {
  if (!rest_at(static_cast<Rods&>(system), platform)) return false;
  if (!system.closes()) return true;
  if (!system.close()) return false;
  system.set_wrench(Vec<double, 6>::Zero());
  system.evaluate();
  system.linearise();
  system.set_wrench(-system.missing());
  system.evaluate();
  return system.linearise();
}
template bool rest_at(Mechanism<RodSystem>&, const SE3<double>&);
template bool rest_at(Mechanism<TangentSystem>&, const SE3<double>&);
template bool rest_at(Mechanism<GeneralSystem>&, const SE3<double>&);

}  // namespace sinew::inline v0
