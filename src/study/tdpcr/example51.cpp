#include "study/tdpcr/example51.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/linalg.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1::example51 {

using std::numbers::pi, std::numbers::sqrt3;

std::array<Vec2<double>, 3> Printed::base_points() const {
  const double c = sqrt3 / 2, s = 0.5;  // of π/6
  return {Vec2<double>(0, base_radius), Vec2<double>(-c * base_radius, -s * base_radius),
          Vec2<double>(c * base_radius, -s * base_radius)};
}

std::array<Vec2<double>, 3> Printed::platform_points() const {
  const double c = sqrt3 / 2, s = 0.5;
  return {Vec2<double>(c * platform_radius, s * platform_radius),
          Vec2<double>(-c * platform_radius, s * platform_radius), Vec2<double>(0, -platform_radius)};
}

PlanarPose pose(double eta) { return {Printed{}.last_x * eta, 0.0, eta * pi / 3}; }

Expected<Sample> sample(const Robot& robot, double eta, Workspace& work) {
  Sample answer{.eta = eta,
                .pose = pose(eta),
                .tendons = {},
                .curvatures = {},
                .input_rate = {},
                .indices = {},
                .determinant = 0,
                .closure_error = 0,
                .sigma = {},
                .type_2 = {}};
  const std::vector<int> bending(static_cast<std::size_t>(leg_count(robot)), 1);
  const Inverse inverse_answer = inverse(robot, answer.pose, {.bending = bending}, work);
  if (!inverse_answer.ok()) return failure("no_solution", robot.name(), to_string(inverse_answer.report));
  answer.tendons.assign(inverse_answer.inputs.begin(), inverse_answer.inputs.end());
  answer.curvatures.assign(inverse_answer.coordinates.begin(), inverse_answer.coordinates.end());

  const Velocity at = velocity(robot, answer.pose, answer.curvatures, work);
  answer.indices = at.indices;
  answer.determinant = at.determinant;
  answer.closure_error = at.report.residual;
  answer.type_2 = at.type_2;
  singular_values(at.J, answer.sigma);
  for (Eigen::Index i = 0; i < at.K.rows(); ++i) answer.input_rate.push_back(at.K(i, i));
  return answer;
}

Expected<std::vector<Sample>> trajectory(const Robot& robot) {
  const int last = Printed{}.configurations - 1;
  Workspace work(robot);
  std::vector<Sample> samples;
  for (int k = 0; k <= last; ++k) {
    auto next = sample(robot, static_cast<double>(k) / last, work);
    if (!next) return tl::unexpected(std::move(next.error()));
    samples.push_back(std::move(*next));
  }
  return samples;
}

double determinant(const PlanarPose& pose) {
  const Printed robot;
  const double psi = pose.phi - pi / 3, product = robot.base_radius * robot.platform_radius;
  const double radii = robot.base_radius * robot.base_radius + robot.platform_radius * robot.platform_radius;
  return -1.5 * sqrt3 * product * std::sin(psi) *
         (pose.x * pose.x + pose.y * pose.y - radii + 2 * product * std::cos(psi));
}

Vec2<double> meeting_point() {
  const Printed robot;
  return Vec2<double>(robot.last_x, 0) / (1 - robot.platform_radius / robot.base_radius);
}

Rates rates(const Sample& last) {
  const Printed robot;
  const double ratio = robot.platform_radius / robot.base_radius, radius = robot.platform_radius;
  const Vec2<double> from_platform = meeting_point() - Vec2<double>(last.pose.x, last.pose.y);  // c
  // The left null vector of J: barycentric coordinates of the meeting point, for platform points R b =
  // (R_p/R_b) a.
  double weighted = 0, squared = 0;
  const auto base = robot.base_points();
  for (std::size_t i = 0; i < base.size(); ++i) {
    const double u = (1 + 2 * dot(from_platform, base[i]) * ratio / (radius * radius)) / 3;
    weighted += std::pow(u * last.input_rate[i], 2);
    squared += u * u;
  }
  const double c2 = squared_norm(from_platform), scale = ratio / (radius * radius - c2);
  const double rotation = scale * std::sqrt(weighted);
  return {last.sigma[0] * scale * std::sqrt(squared * (1 + c2)), std::sqrt(c2) * rotation, rotation};
}

}  // namespace sinew::inline v1::example51
