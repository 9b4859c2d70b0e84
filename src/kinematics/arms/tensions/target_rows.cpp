#include "kinematics/arms/tensions/target_rows.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v1 {
namespace {

/// Twist in base axes from the tip to the target, of what the target gives.
std::vector<double> tip_off(const ArmTarget& target, const SE3<double>& tip, double length) {
  std::vector<double> off;
  if (target.position)
    for (std::size_t i = 0; i < 3; ++i)
      off.push_back(((*target.position)[i] - tip.p[static_cast<int>(i)]) / length);
  if (target.quaternion) {
    const SO3<double> wanted = SE3<double>::from({{0, 0, 0}, *target.quaternion}).R;
    const Vec3<double> turn = wanted.compose(tip.R.inverse()).log();
    for (int i = 0; i < 3; ++i) off.push_back(turn[i]);
  } else if (target.direction) {
    Vec3<double> to((*target.direction)[0], (*target.direction)[1], (*target.direction)[2]);
    to /= to.norm();
    const Vec3<double> z = tip.rotate({0, 0, 1});
    Vec3<double> axis = cross(z, to);
    const double sine = axis.norm(), angle = std::atan2(sine, dot(z, to));
    if (sine > 1e-12)
      axis *= angle / sine;
    else if (angle > 1)
      axis = tip.rotate({angle, 0, 0});
    // the two turns across the axis
    const Vec3<double> x = tip.rotate({1, 0, 0}), y = tip.rotate({0, 1, 0});
    off.push_back(dot(axis, x));
    off.push_back(dot(axis, y));
  }
  return off;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

TargetRows rows_of(const ArmTarget& target, const SE3<double>& tip, const std::vector<double>& J,
                   double length) {
  TargetRows rows;
  rows.off = tip_off(target, tip, length);
  const std::size_t m = J.size() / 6;
  const auto add = [&](const Vec3<double>& by, std::size_t first, double scale) {
    for (std::size_t k = 0; k < m; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += by[static_cast<int>(i)] * J[(first + i) * m + k];
      rows.J.push_back(scale * sum);
    }
  };
  if (target.position)
    for (int i = 0; i < 3; ++i) add(Vec3<double>(i == 0, i == 1, i == 2), 0, 1 / length);
  if (target.quaternion)
    for (int i = 0; i < 3; ++i) add(Vec3<double>(i == 0, i == 1, i == 2), 3, 1);
  else if (target.direction) {
    add(tip.rotate({1, 0, 0}), 3, 1);
    add(tip.rotate({0, 1, 0}), 3, 1);
  }
  return rows;
}

double off_target(const ArmTarget& target, const SE3<double>& tip, double length) {
  return largest(tip_off(target, tip, length));
}

std::string_view target_misfit(const ArmTarget& target) {
  if (!target.position && !target.direction && !target.quaternion) return "the target is empty";
  if (target.direction && target.quaternion) return "the target has a direction and a quaternion; keep one";
  double sum = 0;
  if (target.position)
    for (const double x : *target.position) sum += x;
  if (target.direction) {
    double square = 0;
    for (const double x : *target.direction) square += x * x;
    if (!(square > 0)) return "the direction has no length";
    sum += square;
  }
  if (target.quaternion) {
    double square = 0;
    for (const double x : *target.quaternion) square += x * x;
    if (!(square > 0)) return "the quaternion has no length";
    sum += square;
  }
  if (!std::isfinite(sum)) return "the target is not finite";
  return {};
}

}  // namespace sinew::inline v1
