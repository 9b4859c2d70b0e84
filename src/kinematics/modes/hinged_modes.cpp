#include "kinematics/modes/hinged_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/closing.hpp"
#include "kinematics/modes/circle_polynomial.hpp"
#include "kinematics/modes/four_bars.hpp"
#include "kinematics/modes/sort_poses.hpp"
#include "kinematics/modes/three_circles.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr int samples = 720;  // of the first angle; ten times as many where a root is missed
/// Roots of the polynomial this near to a real one count as real [rad]: where a pair of complex ones is near,
/// the smaller one tells.
constexpr std::array margins{1e-3, 1e-5};
constexpr double min_strength = 1e-12;  ///< of a polynomial that is not 0 everywhere

/// The two angles at which A + B cos t + C sin t vanishes; where it has none, twice the one at which it comes
/// nearest.
std::array<Vec2<double>, 2> zeros(const Vec3<double>& form) {
  const double square = form[1] * form[1] + form[2] * form[2];
  if (!(square > 0)) return {Vec2<double>(1, 0), Vec2<double>(-1, 0)};
  const double slope = std::sqrt(square), along = std::clamp(-form[0] / slope, -1.0, 1.0);
  const Vec2<double> n(form[1] / slope, form[2] / slope);
  const Vec2<double> across = std::sqrt((1 - along) * (1 + along)) * perp(n);
  return {along * n + across, along * n - across};
}

/// Whether the sides hold the angles of a pose hardly: two modes are nearer there than about 1e-5.
bool is_merged(std::span<const PlatformConstraint<3>> legs, double size, const SE3<double>& pose) {
  Linearised<3> sides;
  ThreeCircles(legs, size, pose).linearise(ThreeCircles::start(), sides);
  double volume = 1;
  for (int i = 0; i < 3; ++i) volume *= sides.jacobian.row(i).norm();
  const Mat<double, 3, 3> J = sides.jacobian;
  return !(std::abs(dot(J.col(0), cross(J.col(1), J.col(2)))) > 1e-6 * volume);
}

/// The search of one set of legs: at every value of the first angle the others have two each; the third side
/// is followed along these four branches.
class Search {
 public:
  Search(std::span<const PlatformConstraint<3>> legs, HingedModes& modes)
      : legs_(legs),
        closing_(legs),
        circles_(legs, closing_.size(), SE3<double>::identity()),
        modes_(modes) {}

  /// False where every angle of some circle will do: the legs do not bind each other.
  bool run() {
    double best = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (const double strength = CirclePolynomial(circles_, i).strength(); strength > best) {
        best = strength;
        first_ = i;
      }
    if (!(best > min_strength)) return false;
    follow(samples);
    if (!is_complete()) follow(10 * samples);
    modes_.is_complete = is_complete();
    return true;
  }

  bool is_overfull() const { return overfull_; }

 private:
  struct Place {
    CircleAngles angles;
    double value;  ///< of the third side, over its largest terms
  };
  using Branches = std::array<Place, 4>;

  /// Whether every real root of the polynomial of some angle is accounted for. Complex modes come in pairs,
  /// so that the real ones are even in number.
  bool is_complete() const {
    int known = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(modes_.count); ++k)
      known += is_merged(legs_, closing_.size(), found_[k]) ? 2 : 1;
    if (known % 2 != 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const CirclePolynomial F(circles_, (first_ + i) % 3);
      if (F.strength() > min_strength && std::ranges::any_of(margins, [&](double margin) {
            const std::optional<int> count = F.count_real(margin);
            return count && *count <= known;
          }))
        return true;
    }
    return false;
  }

  Branches at(double t) const {
    const std::size_t second = ThreeCircles::next(first_), third = ThreeCircles::next(second);
    const Vec3<double> first(1, std::cos(t), std::sin(t));
    const auto a = zeros(circles_.form(first_).transpose() * first), b = zeros(circles_.form(third) * first);
    const Mat<double, 3, 3>& side = circles_.form(second);
    Branches places;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2<double>&u = a[k / 2], &v = b[k % 2];
      places[k].angles[first_] = first.tail<2>();
      places[k].angles[second] = u;
      places[k].angles[third] = v;
      places[k].value = dot(Vec3<double>(1, u[0], u[1]), side * Vec3<double>(1, v[0], v[1])) / side.norm();
    }
    return places;
  }

  /// Newton from every change of sign, and from every place where a branch comes near zero and leaves.
  void follow(int steps) {
    Branches before = at(-full_turn / steps), here = at(0);
    for (int n = 0; n < steps; ++n) {
      const Branches ahead = at(full_turn * (n + 1) / steps);
      for (std::size_t k = 0; k < 4; ++k) {
        const double v = here[k].value, size = std::abs(v);
        const bool crosses = (v < 0) != (ahead[k].value < 0);
        const bool turns =
            size <= std::abs(before[k].value) && size <= std::abs(ahead[k].value) && size < 0.05;
        if (!crosses && !turns) continue;
        add(here[k].angles);
        add(ahead[k].angles);
        if (turns) add(before[k].angles);
      }
      before = here;
      here = ahead;
    }
  }

  /// Takes the mode that Newton finds from here, if any and new.
  void add(CircleAngles angles) {
    newton(circles_, angles, {.tolerance = 1e-15 * circles_.size(), .max_iterations = 30});
    const SE3<double> pose = circles_.platform(angles);
    Linearised<6> at;
    closing_.linearise(pose, at);
    if (!(at.error <= 1e-12 * circles_.size()) || !pose.p.allFinite()) return;
    for (int k = 0; k < modes_.count; ++k)
      if (gap(found_[static_cast<std::size_t>(k)], pose) < same_pose) return;
    if (modes_.count == HingedModes::most) {
      overfull_ = true;
      return;
    }
    const auto k = static_cast<std::size_t>(modes_.count++);
    found_[k] = pose;
    modes_.poses[k] = spatial_pose(pose);
  }

  double gap(const SE3<double>& a, const SE3<double>& b) const {
    const Vec3<double> turned = a.R.compose(b.R.inverse()).v;
    return std::max((a.p - b.p).norm() / circles_.size(), turned.norm());
  }

  std::span<const PlatformConstraint<3>> legs_;
  Closing<Spatial> closing_;
  ThreeCircles circles_;
  HingedModes& modes_;
  std::array<SE3<double>, HingedModes::most> found_;
  std::size_t first_ = 0;
  bool overfull_ = false;
};

/// Order, residuals, and where modes merge.
void tell(std::span<const PlatformConstraint<3>> legs, HingedModes& modes) {
  const auto poses = std::span(modes.poses).first(static_cast<std::size_t>(modes.count));
  const Closing<Spatial> closing(legs);
  sort_poses(poses, closing.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const SE3<double> pose = SE3<double>::from(poses[k]);
    Linearised<6> at;
    closing.linearise(pose, at);
    modes.residual[k] = at.error;
    modes.report.residual = std::max(modes.report.residual, at.error);
    modes.is_double[k] = is_merged(legs, closing.size(), pose);
  }
}

bool are_in_domain(std::span<const PlatformConstraint<3>> legs) {
  if (!ThreeCircles::fit(legs)) return false;
  return std::ranges::all_of(legs, [](const PlatformConstraint<3>& leg) {
    const double extent = leg.anchor.lpNorm<1>() + leg.platform_point.lpNorm<1>() + leg.distance;
    return std::isfinite(extent) && extent < 1e30 && leg.normal.allFinite();
  });
}

}  // namespace

bool are_hinged(std::span<const PlatformConstraint<3>> legs) { return ThreeCircles::fit(legs); }

HingedModes hinged_modes(std::span<const PlatformConstraint<3>> legs) {
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

}  // namespace sinew::inline v1
