#include "kinematics/modes/planar_modes.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinematics/modes/four_bars.hpp"
#include "kinematics/modes/planar_legs.hpp"
#include "kinematics/modes/planar_sextic.hpp"

namespace sinew::inline v1 {
namespace {

using V = Vec2<double>;
using Motion = SE2<double>;

/// Do the rows of J, moments measured by the platform's extent, span hardly any volume?
bool is_singular(const ScaledLegs& legs, const Motion& pose) {
  double arm = 0;
  for (std::size_t i = 0; i < legs.count(); ++i) arm = std::max(arm, legs[i].platform_point.norm());
  const Mat<double, 3, 3> gram = normal_equations(legs, pose).matrix;
  return !(dot(gram.col(0), cross(gram.col(1), gram.col(2))) > 1e-9 * arm * arm);
}

/// The poses found so far.
class Found {
 public:
  explicit Found(const ScaledLegs& legs) : legs_(legs) {}

  void add(Motion pose) {
    if (!(pose.p.allFinite() && std::isfinite(pose.c + pose.s))) return;  // a maximum hides a NaN
    const bool over = legs_.constraints() > 3;
    double error = legs_.error(pose);
    if (over && error < 1e-4) error = fit(pose);
    if (!(error <= (over ? 1e-9 : 1e-12))) return;
    for (int i = 0; i < count_; ++i)
      if (is_same(pose, at(i), error)) return;
    if (count_ == PlanarModes::most)
      overfull_ = true;
    else
      at(count_++) = pose;
  }
  bool overfull() const { return overfull_; }
  bool empty() const { return count_ == 0; }

  void write(PlanarModes& modes, std::span<const PlatformConstraint<2>> legs) const;

 private:
  Motion& at(int i) { return poses_[static_cast<std::size_t>(i)]; }

  /// Gauss-Newton on all legs: the extra ones tell apart what the three solved for leave nearly equal.
  double fit(Motion& pose) const {
    double error = legs_.error(pose);
    for (int i = 0; i < 10; ++i) {
      const NormalEquations normal = normal_equations(legs_, pose);
      const Vec3<double> motion = normal.matrix.ldlt().solve(normal.right);
      if (!motion.allFinite()) break;
      const Motion ahead = pose.displaced(motion);
      const double ahead_error = legs_.error(ahead);
      if (!(ahead_error < error)) break;
      pose = ahead;
      error = ahead_error;
    }
    return error;
  }

  /// Is the pose half way as good? Then they are one, and the better closed one stays.
  bool is_same(const Motion& pose, Motion& known, double error) const {
    const double known_error = legs_.error(known);
    if (!joins(pose, known, std::max({1e-14, error, known_error}))) return false;
    if (error < known_error) known = pose;
    return true;
  }

  /// Does the pose half way between close the legs? Where several modes merge, poses all along a short curve
  /// do: the half way pose is first put onto it, by steps that the directions of no resistance do not enter.
  bool joins(const Motion& a, const Motion& b, double tolerance) const {
    const double gap = (a.p - b.p).norm() + std::abs(a.c - b.c) + std::abs(a.s - b.s);
    if (gap > 1e-2) return false;
    const V turn = V(a.c + b.c, a.s + b.s).normalized();
    Motion middle{0.5 * (a.p + b.p), turn.x(), turn.y()};
    for (int i = 0; i < 3; ++i) {
      if (legs_.error(middle) <= tolerance) return true;
      NormalEquations normal = normal_equations(legs_, middle);
      normal.matrix.diagonal().array() += 1e-10;
      const Vec3<double> motion = normal.matrix.ldlt().solve(normal.right);
      if (!(motion.norm() < 0.1 * gap)) return false;
      middle = middle.displaced(motion);
    }
    return false;
  }

  const ScaledLegs& legs_;
  std::array<Motion, PlanarModes::most> poses_;
  int count_ = 0;
  bool overfull_ = false;
};

double closure_error(std::span<const PlatformConstraint<2>> legs, const PlanarPose& pose) {
  const auto platform = Motion::from(pose);
  double worst = 0;
  for (const PlatformConstraint<2>& leg : legs)
    worst = std::max(worst, leg.closure_error(platform.point(leg.platform_point) - leg.anchor));
  return worst;
}

bool comes_before(const PlanarPose& a, const PlanarPose& b) {
  const auto key = [](const PlanarPose& p) { return std::tuple(std::round(p.phi * 1e9), p.x, p.y); };
  return key(a) < key(b);
}

void Found::write(PlanarModes& modes, std::span<const PlatformConstraint<2>> legs) const {
  for (int n = 0; n < count_; ++n) {
    const Motion& motion = poses_[static_cast<std::size_t>(n)];
    const PlanarPose pose = legs_.in_metres(motion);
    auto place = static_cast<std::size_t>(modes.count++);
    for (; place > 0 && comes_before(pose, modes.poses[place - 1]); --place) {
      modes.poses[place] = modes.poses[place - 1];
      modes.is_double[place] = modes.is_double[place - 1];
    }
    modes.poses[place] = pose;
    modes.is_double[place] = is_singular(legs_, motion);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    modes.residual[i] = closure_error(legs, modes.poses[i]);
    modes.report.residual = std::max(modes.report.residual, modes.residual[i]);
  }
}

/// B₁ is pinned: the platform turns about it until leg j closes, |R b − a| = D, the law of cosines. False if
/// no leg stops it.
bool turn_about_pin(const ScaledLegs& legs, Found& found) {
  const auto grip = [&](std::size_t i) { return legs[i].anchor.norm() * legs[i].platform_point.norm(); };
  std::size_t j = 0;
  for (std::size_t i = 1; i < legs.count(); ++i)
    if (grip(i) > grip(j)) j = i;
  if (!(grip(j) > 1e-14)) {
    found.add(Motion::identity());
    return false;
  }
  const PlatformConstraint<2> leg = legs[j];
  const double a = leg.anchor.norm(), b = leg.platform_point.norm(), d = leg.distance;
  const double aligned = angle_of(cross(leg.platform_point, leg.anchor), dot(leg.platform_point, leg.anchor));
  // sin² and cos² of half the turn from there, written so that nothing cancels.
  const double sine = std::max((d - a + b) * (d + a - b), 0.0),
               cosine = std::max((a + b - d) * (a + b + d), 0.0);
  const double turn = 2 * std::atan2(std::sqrt(sine), std::sqrt(cosine));
  found.add(Motion::from(0.0, 0.0, aligned - turn));
  found.add(Motion::from(0.0, 0.0, aligned + turn));
  return true;
}

/// How the search ended, and in words.
void report_search(std::span<const PlatformConstraint<2>> given, const ScaledLegs& legs, const Found& found,
                   bool binds, Report& report) {
  if (!found.overfull() && binds && !found.empty()) return;
  const bool torn = found.empty() && are_torn(given, report);
  if (torn || (found.empty() && binds)) {
    report.status = Status::unreachable;
    if (!torn) report.message.append("no pose closes all legs, though any two of them can be closed");
    return;
  }
  report.status = Status::singular;
  report.message.append(
      legs.constraints() < 3
          ? "a platform in the plane needs three distances, or a pinned point and one; these "
            "legs leave a continuum of poses"
          : "the legs do not bind each other: a continuum of poses closes them");
}

/// The shortest leg, the one that differs most from it, and of the rest the one that binds these two best.
/// False if none does: then the other legs say nothing new.
bool choose(const ScaledLegs& legs, Sextic& sextic) {
  const auto differs = [&](std::size_t i) {
    return legs[i].anchor.squaredNorm() + legs[i].platform_point.squaredNorm();
  };
  std::size_t second = legs.first();
  for (std::size_t i = 0; i < legs.count(); ++i)
    if (differs(i) > differs(second)) second = i;
  double best = 1e-14;
  for (std::size_t i = 0; i < legs.count(); ++i) {
    if (i == legs.first() || i == second) continue;
    const Sextic candidate(legs[legs.first()].distance, legs[second], legs[i]);
    if (!(candidate.strength() > best)) continue;
    best = candidate.strength();
    sextic = candidate;
  }
  return best > 1e-14;
}

bool is_in_domain(std::span<const PlatformConstraint<2>> legs) {
  const auto fits = [](double x) { return std::abs(x) < 1e150; };  // false for NaN
  return std::all_of(legs.begin(), legs.end(), [&](const PlatformConstraint<2>& leg) {
    return fits(leg.anchor.x()) && fits(leg.anchor.y()) && fits(leg.distance) && leg.distance >= 0 &&
           fits(leg.platform_point.x()) && fits(leg.platform_point.y());
  });
}

}  // namespace

PlanarModes planar_modes(std::span<const PlatformConstraint<2>> legs) {
  PlanarModes modes;
  if (!is_in_domain(legs)) {
    modes.report.status = Status::left_domain;
    modes.report.message.append(
        "a point or distance of a leg is not a number, too large to be squared, or a negative distance");
    return modes;
  }
  const ScaledLegs scaled(legs);
  Found found(scaled);
  bool binds = false;
  if (Sextic sextic; scaled.constraints() < 3) {
    // nothing to search
  } else if (scaled.is_pinned(scaled.first())) {
    binds = turn_about_pin(scaled, found);
  } else if (binds = choose(scaled, sextic); binds) {
    sextic.each_pose([&](const Motion& pose) { found.add(pose); });
  }
  found.write(modes, legs);
  report_search(legs, scaled, found, binds, modes.report);
  return modes;
}

}  // namespace sinew::inline v1
