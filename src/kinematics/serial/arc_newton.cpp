#include "kinematics/serial/arc_newton.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace detail {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// An arc whose chord has direction n turns its end by the quaternion n z⁻¹, and faster bends by 2 n × δn.
SE3<double> end_of(double length, const ChordOfBend& chord) {
  const Vec3<double>& n = chord.direction.at;
  return {length * chord.factor.at[0] * n, {n[2], Vec3<double>(-n[1], n[0], 0)}};
}
/// What is missing to the pose, and how it moves with the bends.
struct PoseError {
  Vector6 error;
  Matrix6 jacobian;
};
PoseError linearised(const ThreeArcPose& pose, const ThreeBends& bends) {
  std::array<ChordOfBend, 3> chords;
  std::array<SE3<double>, 4> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    chords[k] = chord_of(bends[k]);
    ends[k + 1] = ends[k].compose(end_of(pose.lengths[k], chords[k]));
  }
  PoseError at;
  const SE3<double>& tip = ends[3];
  at.error << tip.p - pose.tip.p, tip.R.compose(pose.tip.R.inverse()).log();
  for (int column = 0; column < 6; ++column) {
    const auto k = static_cast<std::size_t>(column / 2), j = static_cast<std::size_t>(column % 2);
    const Vec3<double>&n = chords[k].direction.at, &n_rate = chords[k].direction.rate[j];
    const Vec3<double> chord_rate =
        pose.lengths[k] * (chords[k].factor.rate[j][0] * n + chords[k].factor.at[0] * n_rate);
    const Vec3<double> turn = ends[k].rotate(Vec3<double>(2 * cross(n, n_rate)));
    at.jacobian.col(column) << ends[k].rotate(chord_rate) + cross(turn, Vec3<double>(tip.p - ends[k + 1].p)),
        turn;
  }
  return at;
}

Vector6 stacked(const ThreeBends& bends) {
  Vector6 b;
  b << bends[0], bends[1], bends[2];
  return b;
}
ThreeBends unstacked(const Vector6& b) {
  return {Vec2<double>(b.head<2>()), Vec2<double>(b.segment<2>(2)), Vec2<double>(b.tail<2>())};
}

double largest(const Vector6& error) { return error.cwiseAbs().maxCoeff(); }

/// The pose reached from this guess, if it is.
std::optional<ArcSolution> reached(const ThreeArcPose& pose, const Vector6& b, double residual) {
  if (!(residual < 1e-12)) return std::nullopt;
  const ThreeBends bends = unstacked(b);
  const SO3<double> turn = tip_of(pose.lengths, bends).R;
  return ArcSolution{bends, turn.w * pose.tip.R.w + dot(turn.v, pose.tip.R.v) < 0 ? -1 : 1, residual};
}

Vector6 whole(const ThreeArcPose& pose, const OuterBends& outer) {
  return stacked({outer.first, middle_bend(pose, outer), outer.last});
}

}  // namespace

SE3<double> tip_of(const std::array<double, 3>& lengths, const ThreeBends& bends) {
  SE3<double> tip = SE3<double>::identity();
  for (std::size_t k = 0; k < 3; ++k) tip = tip.compose(end_of(lengths[k], chord_of(bends[k])));
  return tip;
}

std::optional<ArcSolution> polished(const ThreeArcPose& pose, const OuterBends& guess) {
  Vector6 b = whole(pose, guess);
  PoseError at = linearised(pose, unstacked(b));
  for (int i = 0; i < 12; ++i) {
    const Vector6 next = b - at.jacobian.partialPivLu().solve(at.error);
    if (!next.allFinite()) return std::nullopt;
    const PoseError ahead = linearised(pose, unstacked(next));
    if (largest(at.error) < 1e-13 && !(largest(ahead.error) < largest(at.error))) break;
    b = next;
    at = ahead;
  }
  return reached(pose, b, largest(at.error));
}

// The method of Levenberg and Marquardt.
std::optional<ArcSolution> settled(const ThreeArcPose& pose, const OuterBends& guess) {
  Vector6 b = whole(pose, guess);
  PoseError at = linearised(pose, unstacked(b));
  double damping = 1e-2 * at.error.squaredNorm();
  for (int i = 0; i < 60 && largest(at.error) > 1e-15; ++i) {
    const Matrix6 normal = at.jacobian.transpose() * at.jacobian + damping * Matrix6::Identity();
    const Vector6 next = b - normal.partialPivLu().solve(at.jacobian.transpose() * at.error);
    const PoseError ahead = linearised(pose, unstacked(next));
    const bool is_better = ahead.error.squaredNorm() < at.error.squaredNorm();
    damping = std::max(damping * (is_better ? 0.1 : 8), 1e-14);  // not below rounding
    if (!is_better) continue;
    b = next;
    at = ahead;
  }
  return reached(pose, b, largest(at.error));
}

double regularity(const ThreeArcPose& pose, const ThreeBends& bends) {
  const Matrix6 J = linearised(pose, bends).jacobian;
  std::array<double, 6> sigma{};
  singular_values(MatrixView(J.data(), 6, 6), sigma);  // of the transpose: the same
  return sigma[5];
}

double pose_error(const ThreeBends& bends, const ThreeArcPose& pose) {
  return largest(linearised(pose, bends).error);
}

double distance(const ThreeBends& a, const ThreeBends& b) { return (stacked(a) - stacked(b)).norm(); }

bool is_within_limit(const ThreeArcPose& pose, const ThreeBends& bends) {
  return std::ranges::all_of(bends, [&](const Vec2<double>& b) { return b.norm() <= pose.limit; });
}

}  // namespace detail
}  // namespace sinew::inline v1
