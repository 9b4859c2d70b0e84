#include "kinematics/modes/spatial_modes.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "kinematics/closing.hpp"
#include "kinematics/modes/four_bars.hpp"
#include "kinematics/modes/normal_legs.hpp"
#include "kinematics/modes/sort_poses.hpp"
#include "math/linalg.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

using namespace detail;

Complex square(const Vec<Complex, 4>& e) { return (e.array() * e.array()).sum(); }

/// Where one set of 40 paths ended.
struct Ends {
  std::vector<Study> finite;
  int infinite = 0, singular = 0, lost = max_modes;

  bool knows(const Study& x, double tolerance) const {
    return std::ranges::any_of(finite, [&](const Study& y) { return same_ray(x, y, tolerance); });
  }

  void add(const PathEnd<8>& end) {
    using Kind = PathEnd<8>::Kind;
    if (end.kind == Kind::lost) return;
    const bool is_regular = end.kind == Kind::regular;
    // A regular end is known to rounding, a limit to the root of it; real poses are at 0.1 and above.
    const double nothing = is_regular ? 1e-12 : 1e-6;
    if (end.kind == Kind::infinite || std::abs(square(end.point.head<4>())) < nothing) {
      ++infinite;
    } else if (!knows(end.point, is_regular ? 1e-9 : same_pose)) {
      finite.push_back(end.point);
      singular += !is_regular;
    } else if (is_regular) {
      return;  // two paths never meet at a regular point: one of them was lost on the way
    }
    --lost;
  }
};

Ends follow_all(const Sections& target, const SpatialModesOptions& options) {
  const GenericLegs& generic = generic_legs();
  const Pencil pencil(generic.sections, target);
  Ends ends;
  for (const Study& start : generic.solutions) {
    if (options.stop.stop_requested()) break;
    Path<Pencil> path(pencil, start, 0.0, {.max_steps = options.max_steps});
    ends.add(follow(pencil, path, Complex(1)));
  }
  return ends;
}

/// The pose of a complex solution, if that is real as far as paths can tell.
std::optional<SE3<double>> real_pose(const Study& x) {
  const Study unit = x / std::sqrt(square(x.head<4>()));  // the representative that is real if any is
  if (unit.imag().norm() > 1e-3 * unit.norm()) return std::nullopt;
  const Vec<double, 8> real = unit.real();
  const SO3<double> turn{real[0], real.segment<3>(1)};
  const Vec3<double> g = real.tail<3>();
  return SE3<double>{g * turn.w - turn.v * real[4] - cross(g, turn.v), turn.normalised()};
}

/// The poses of one set of legs, gathered from wherever candidates come.
class Poses {
 public:
  explicit Poses(const NormalLegs& normal) : normal_(normal), closing_(normal.legs) {}

  const std::vector<SE3<double>>& all() const { return all_; }
  bool are_too_many() const { return all_.size() > max_modes; }

  /// Takes the pose that Newton finds from here, if any and new.
  void add(SE3<double> pose) {
    const Report found = newton(closing_, pose, {.tolerance = 1e-15});
    // legs beyond the sixth need not fit to rounding
    if (!found.ok() && (normal_.legs.size() <= 6 || !(found.residual <= 1e-9))) return;
    const auto is_same = [&](const SE3<double>& other) { return gap(pose, other) < same_pose; };
    if (std::ranges::none_of(all_, is_same)) all_.push_back(pose);
  }

  /// Flat base and flat platform: what is above the base plane is also below it.
  void add_mirrored() {
    if (!normal_.base_is_flat || !normal_.platform_is_flat) return;
    const Mat<double, 3, 3> base = reflection(normal_.base_normal),
                            platform = reflection(normal_.platform_normal);
    for (std::size_t i = 0, count = all_.size(); i < count; ++i) {
      const SE3<double> pose = all_[i];
      add({base * pose.p, SO3<double>::from(base * pose.R.matrix() * platform)});
    }
  }

  /// Starts spread evenly over turns and places (an additive recurrence), until too many are found.
  void add_from_everywhere(int starts, StopToken stop) {
    for (int i = 1; i <= starts && !are_too_many() && !stop.stop_requested(); ++i) {
      std::array<double, 6> u;
      double step = 1;
      for (double& coordinate : u) {
        step /= 1.1347241384015194;  // root of x⁷ = x + 1: the six powers are badly approximated together
        coordinate = std::fmod(0.5 + i * step, 1.0);
      }
      const double low = std::sqrt(1 - u[0]), high = std::sqrt(u[0]), turn = 2 * std::numbers::pi;
      const SO3<double> R{low * std::sin(turn * u[1]),
                          Vec3<double>(low * std::cos(turn * u[1]), high * std::sin(turn * u[2]),
                                       high * std::cos(turn * u[2]))};
      add({Vec3<double>(2 * u[3] - 1, 2 * u[4] - 1, 2 * u[5] - 1), R});
    }
  }

  int singular_count() const {
    return static_cast<int>(
        std::ranges::count_if(all_, [&](const SE3<double>& pose) { return free_motions(pose).cols() > 0; }));
  }

  /// Whether the platform can leave some pose along a motion that J does not hold: one that Newton brings
  /// back to another pose nearby, not to the same.
  bool can_move() const {
    constexpr double shift = 0.02;
    return std::ranges::any_of(all_, [&](const SE3<double>& pose) {
      const Eigen::MatrixXd motions = free_motions(pose);
      for (Eigen::Index i = 0; i < motions.cols(); ++i) {
        SE3<double> moved = closing_.moved(pose, shift * motions.col(i));
        const bool closes = newton(closing_, moved, {.tolerance = 1e-15}).ok();
        if (closes && gap(pose, moved) > 0.1 * shift && gap(pose, moved) < 2 * shift) return true;
      }
      return false;
    });
  }

 private:
  static Mat<double, 3, 3> reflection(const Vec3<double>& normal) {
    return Mat<double, 3, 3>::Identity() - 2 * normal * normal.transpose();
  }
  static double gap(const SE3<double>& a, const SE3<double>& b) {
    const Vec3<double> turn = a.R.compose(b.R.inverse()).v;
    return std::max((a.p - b.p).norm(), turn.norm());
  }

  /// Twists that no leg resists to first order.
  Eigen::MatrixXd free_motions(const SE3<double>& pose) const {
    Linearised<6> system;
    closing_.linearise(pose, system);
    const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> rows = system.jacobian;
    const Svd twists = svd(MatrixView(rows.data(), rows.rows(), 6));
    return twists.v().rightCols(6 - rank(twists.sigma(), 1e-6));
  }

  const NormalLegs& normal_;
  Closing<Spatial> closing_;
  std::vector<SE3<double>> all_;
};

/// Puts the poses into the answer, in the given legs' units.
void tell(const Poses& poses, const NormalLegs& normal, std::span<const PlatformConstraint<3>> legs,
          SpatialModes& modes) {
  for (const SE3<double>& pose : poses.all()) modes.poses.push_back(spatial_pose(normal.given(pose)));
  sort_poses(modes.poses, normal.size);
  const Closing<Spatial> closing(legs);
  Linearised<6> at;
  for (const SpatialPose& pose : modes.poses) {
    closing.linearise(SE3<double>::from(pose), at);
    modes.residual.push_back(at.error);
    modes.report.residual = std::max(modes.report.residual, modes.residual.back());
  }
}

void explain(const Poses& poses, SpatialModes& modes) {
  FixedText<240>& message = modes.report.message;
  if (poses.are_too_many() || poses.can_move()) {
    modes.report.status = Status::singular;
    message.append("the platform can move with all legs held: the poses found are examples of a continuum");
  } else if (modes.poses.empty()) {
    modes.report.status = modes.is_complete() ? Status::unreachable : Status::stalled;
    message.append(modes.is_complete() ? "no pose closes the legs: none of all " : "no pose found; none of ");
    append_number(message, modes.complex_count);
    message.append(" solutions is real");
    message.append(modes.is_complete() ? "" : ", but some may be missing; try another seed");
  }
}

}  // namespace

SpatialModes spatial_modes(std::span<const PlatformConstraint<3>> legs, const SpatialModesOptions& options) {
  SpatialModes modes;
  const std::optional<NormalLegs> normal = normal_legs(legs, modes.report);
  if (Report torn;
      (normal || legs.size() < 6) && modes.report.status != Status::left_domain && are_torn(legs, torn)) {
    modes.report = torn;
    modes.lost_paths = 0;  // proven without a path
    return modes;
  }
  if (!normal) return modes;
  ComplexNumbers random(options.seed);
  Poses poses(*normal);
  for (int attempt = 0; attempt < options.attempts && modes.lost_paths > 0 && !options.stop.stop_requested();
       ++attempt) {
    const Ends ends = follow_all(random.phase() * normal->sections, options);
    for (const Study& x : ends.finite)
      if (const auto pose = real_pose(x)) poses.add(*pose);
    if (ends.lost >= modes.lost_paths) continue;
    modes.complex_count = static_cast<int>(ends.finite.size());
    modes.infinite_paths = ends.infinite;
    modes.lost_paths = ends.lost;
    modes.singular_count = ends.singular;
  }
  if (!modes.is_complete()) {
    poses.add_from_everywhere(options.newton_starts, options.stop);
    poses.add_mirrored();
    modes.singular_count = std::max(modes.singular_count, poses.singular_count());
  }
  tell(poses, *normal, legs, modes);
  if (!note_stop(options.stop, modes.report)) explain(poses, modes);
  return modes;
}

}  // namespace sinew::inline v1
