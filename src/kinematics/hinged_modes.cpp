#include "sinew/kinematics/hinged_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/circle_polynomial.hpp"
#include "kinematics/closing.hpp"
#include "kinematics/four_bars.hpp"
#include "kinematics/sort_poses.hpp"
#include "kinematics/three_circles.hpp"
#include "sinew/solve/roots.hpp"

namespace sinew::inline v0 {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double same_pose = 1e-6;  // a double mode is known to the root of the rounding error only
constexpr double near_touch = 1e-7;  // of |F|: an extremum this small is tried for modes that merge

/// Angles at which A + B cos t + C sin t vanishes; where the circle hardly meets zero, where it comes nearest;
/// where every angle does, eight all round.
struct Starts {
  int count = 0;
  std::array<Vec2<double>, 8> at;
  bool are_complex = false;  ///< no real angle comes near

  explicit Starts(const Vec3<double>& form, double scale) {
    const double slope = std::hypot(form[1], form[2]);
    if (slope <= 1e-9 * scale) {
      for (; count < 8; ++count) add(count * turn / 8);
      return;
    }
    const double level = -form[0] / slope, towards = std::atan2(form[2], form[1]);
    are_complex = std::abs(level) > 1 + 1e-6;
    const double half = std::acos(std::clamp(level, -1.0, 1.0));
    for (const double sign : {1.0, -1.0}) {
      add(towards + sign * half);
      ++count;
    }
  }

 private:
  void add(double t) { at[static_cast<std::size_t>(count)] = {std::cos(t), std::sin(t)}; }
};

/// The search of one set of legs.
class Search {
 public:
  Search(std::span<const Reach<3>> legs, HingedModes& modes) : closing_(legs), circles_(legs, closing_.size(), SE3<double>::identity()), modes_(modes) {}

  /// False where the polynomial of every circle vanishes: the legs do not bind each other.
  bool run() {
    double best = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (const CirclePolynomial candidate(circles_, i); candidate.strength() > best) {
        best = candidate.strength();
        first_ = i;
      }
    if (!(best > 1e-13)) return false;
    follow(CirclePolynomial(circles_, first_));
    return true;
  }

  bool is_overfull() const { return overfull_; }

 private:
  void follow(const CirclePolynomial& F) {
    std::array<double, 40> extrema;
    const auto slope = [&](double t) {
      const auto f = F.at(t);
      return RootSample{f.rate, f.rate_rate, F.third_bound() + 1e-300, 8 * F.noise()};
    };
    const int found = all_roots(slope, {.low = -0.01, .high = turn + 0.01, .stride = 0.1}, extrema);
    if (found < 0 || found == static_cast<int>(extrema.size())) return;
    modes_.is_complete = true;
    for (int k = 0; k < found; ++k) {
      const double t = extrema[static_cast<std::size_t>(k)];
      if (std::abs(F.at(t).value) <= near_touch) touch(F, t);
      if (k + 1 < found) crossing(F, t, extrema[static_cast<std::size_t>(k + 1)]);
    }
  }

  /// Between two extrema there is one root at most.
  void crossing(const CirclePolynomial& F, double low, double high) {
    const bool sign = std::signbit(F.at(low).value);
    if (std::signbit(F.at(high).value) == sign) return;
    for (int i = 0; i < 60; ++i) {
      const double middle = low + 0.5 * (high - low);
      (std::signbit(F.at(middle).value) == sign ? low : high) = middle;
    }
    const bool is_found = try_at(low);
    // what rounding lets cross is a touch, and no promise of a mode
    if (!is_found && std::abs(F.at(low).rate) > 1e-5) modes_.is_complete = false;
  }

  /// Modes with one angle in common (mirror images), or merging: both are double roots of F.
  void touch(const CirclePolynomial& F, double t) {
    bool is_found = try_at(t);
    for (const double apart : {1e-5, -1e-5, 1e-3, -1e-3}) is_found = try_at(t + apart) || is_found;
    if (!is_found && !are_complex_ && std::abs(F.at(t).value) <= F.noise()) modes_.is_complete = false;
  }

  /// Newton from wherever the other two circles may be at this angle; true where a mode is near.
  bool try_at(double t) {
    const std::size_t second = ThreeCircles::next(first_), third = ThreeCircles::next(second);
    const Vec3<double> at(1, std::cos(t), std::sin(t));
    const Mat<double, 3, 3> to_second = circles_.form(first_), to_third = circles_.form(third);
    const Starts a(to_second.transpose() * at, to_second.norm()), b(to_third * at, to_third.norm());
    are_complex_ = a.are_complex || b.are_complex;
    bool is_found = false;
    for (int i = 0; i < a.count; ++i)
      for (int j = 0; j < b.count; ++j) {
        CircleAngles angles;
        angles[first_] = at.tail<2>();
        angles[second] = a.at[static_cast<std::size_t>(i)];
        angles[third] = b.at[static_cast<std::size_t>(j)];
        is_found = add(angles, at.tail<2>()) || is_found;
      }
    return is_found;
  }

  /// Takes the mode that Newton finds from here, if any; true if its first angle is the one started from.
  bool add(CircleAngles angles, const Vec2<double>& from) {
    newton(circles_, angles, {.tolerance = 1e-15 * circles_.size(), .max_iterations = 30});
    const SE3<double> pose = circles_.platform(angles);
    Linearised<6> at;
    closing_.linearise(pose, at);
    if (!(at.error <= 1e-12 * circles_.size()) || !pose.p.allFinite()) return false;
    const bool is_near = (angles[first_] - from).norm() < 1e-2;
    for (int k = 0; k < modes_.count; ++k)
      if (gap(found_[static_cast<std::size_t>(k)], pose) < same_pose) return is_near;
    if (modes_.count == HingedModes::most) {
      overfull_ = true;
      return is_near;
    }
    const auto k = static_cast<std::size_t>(modes_.count++);
    found_[k] = pose;
    modes_.poses[k] = spatial_pose(pose);
    return is_near;
  }

  double gap(const SE3<double>& a, const SE3<double>& b) const {
    const Vec3<double> turned = a.R.compose(b.R.inverse()).v;
    return std::max((a.p - b.p).norm() / circles_.size(), turned.norm());
  }

  Closing<Spatial> closing_;
  ThreeCircles circles_;
  HingedModes& modes_;
  std::array<SE3<double>, HingedModes::most> found_;
  std::size_t first_ = 0;
  bool overfull_ = false, are_complex_ = false;
};

/// Order, residuals, and where modes merge.
void tell(std::span<const Reach<3>> legs, HingedModes& modes) {
  const auto poses = std::span(modes.poses).first(static_cast<std::size_t>(modes.count));
  const Closing<Spatial> closing(legs);
  sort_poses(poses, closing.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const SE3<double> pose = SE3<double>::from(poses[k]);
    Linearised<6> at;
    closing.linearise(pose, at);
    modes.residual[k] = at.error;
    modes.report.residual = std::max(modes.report.residual, at.error);
    Linearised<3> sides;
    const ThreeCircles circles(legs, closing.size(), pose);
    circles.linearise(ThreeCircles::start(), sides);
    double volume = 1;
    for (int i = 0; i < 3; ++i) volume *= sides.jacobian.row(i).norm();
    const Mat<double, 3, 3> J = sides.jacobian;
    modes.is_double[k] = !(std::abs(dot(J.col(0), cross(J.col(1), J.col(2)))) > 1e-9 * volume);
  }
}

bool are_in_domain(std::span<const Reach<3>> legs) {
  if (!ThreeCircles::fit(legs)) return false;
  return std::ranges::all_of(legs, [](const Reach<3>& leg) {
    const double extent = leg.anchor.lpNorm<1>() + leg.platform_point.lpNorm<1>() + leg.distance;
    return std::isfinite(extent) && extent < 1e30 && leg.normal.allFinite();
  });
}

}  // namespace

bool are_hinged(std::span<const Reach<3>> legs) { return ThreeCircles::fit(legs); }

HingedModes hinged_modes(std::span<const Reach<3>> legs) {
  HingedModes modes;
  const auto end_with = [&](Status status, std::string_view why) {
    modes.report.status = status;
    modes.report.message.append(why);
    return modes;
  };
  if (!are_in_domain(legs))
    return end_with(Status::left_domain, "these are not three hinged legs of finite numbers");
  if (are_torn(legs, modes.report)) {
    modes.is_complete = true;
    return modes;
  }
  Search search(legs, modes);
  const bool binds = search.run();
  tell(legs, modes);
  if (!binds || search.is_overfull()) {
    modes.is_complete = false;
    return end_with(Status::singular, "the legs do not bind each other: a continuum of poses closes them");
  }
  if (modes.count > 0) return modes;
  return modes.is_complete
             ? end_with(Status::unreachable, "no pose closes all legs, though any two of them can be closed")
             : end_with(Status::stalled, "no pose found, but some may be missing");
}

}  // namespace sinew::inline v0
