#include "sinew/analysis/velocity.hpp"

#include <cmath>

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// σmax/σmin; infinite where the smaller is zero.
double condition(std::span<const double> sigma) { return sigma.front() / sigma.back(); }

/// J with rows scaled to unit direction and moments divided by the platform radius, into `out` (row-major).
template <int Dimension>
MatrixView homogenised(const MatrixView& J, double radius, std::span<double> out) {
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    const double length = J.row(i).head<Dimension>().norm();
    const double scale = length > 0 ? 1 / length : 0;
    for (Eigen::Index j = 0; j < J.cols(); ++j)
      out[static_cast<std::size_t>(i * J.cols() + j)] = J(i, j) * (j < Dimension ? scale : scale / radius);
  }
  return {out.data(), J.rows(), J.cols()};
}

/// 2-norm of a block of rows of U.
double block_norm(const MatrixView& U, Eigen::Index first, Eigen::Index count) {
  std::array<double, max_matrix_size> sigma;
  const MatrixView block(U.data() + first * U.cols(), count, U.cols());
  singular_values(block, sigma);
  return sigma[0];
}

/// Dependent lines of the plane, told by the twists they leave free: a rotation about a point all of them
/// meet, a translation all of them are perpendicular to, or both where they are one line.
void classify(TypeTwo& type, const Svd& decomposition, const PlanarPose& pose, double radius) {
  if (type.rank < 2) {
    type.kind = LineClass::coincident;
    return;
  }
  const auto free = decomposition.v().col(2);  // (v, ω·radius)
  const double turn = free[2];
  if (std::abs(turn) < type_2_tolerance) {
    type.kind = LineClass::parallel;
    return;
  }
  type.kind = LineClass::concurrent;
  type.point = Vec2<double>(pose.x, pose.y) + perp(Vec2<double>(free[0], free[1])) * (radius / turn);
}

template <class LegT>
TypeTwo type_two(const ParallelRobot<LegT>& robot, const AnyPose& pose, const MatrixView& J,
                 double& homogeneous, Workspace& work) {
  using Space = typename LegT::Space;
  const MatrixView lines = homogenised<Space::dimension>(J, robot.platform_radius, work.scratch);
  std::array<double, max_matrix_size> sigma;
  const std::span<double> values(sigma.data(), static_cast<std::size_t>(std::min(J.rows(), J.cols())));
  singular_values(lines, values);
  homogeneous = condition(values);
  TypeTwo type;
  type.rank = rank(values, type_2_tolerance);
  type.singular = type.rank < Space::dof;
  if (type.singular) classify(type, svd(lines), in_space<Space>(pose), robot.platform_radius);
  return type;
}

/// Legs whose tip velocity is perpendicular to the line they pull along, or that have no line (folded on the
/// spot).
template <class LegT>
std::size_t type_one(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                     Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  std::size_t count = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const bool lost = with_leg(robot.legs[i], [&](const auto& leg) {
      const auto tip = leg.tip(coordinates[i]);
      const auto blocks = leg.template blocks<double>(platform, tip);
      const double line = blocks.g_x.template head<Space::dimension>().norm();
      return std::abs(blocks.g_q[0]) <= type_1_tolerance * line * tip.rate.norm();
    });
    if (lost) work.type_1[count++] = static_cast<int>(i);
  }
  return count;
}

}  // namespace

std::string_view to_string(LineClass kind) noexcept {
  switch (kind) {
    case LineClass::regular:
      return "regular";
    case LineClass::concurrent:
      return "concurrent";
    case LineClass::parallel:
      return "parallel";
    case LineClass::coincident:
      return "coincident";
  }
  return "unknown";
}

Velocity velocity(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  const Reduced reduced = assemble(robot, pose, coordinates, work);
  const Eigen::Index freedoms = reduced.J.cols();
  Velocity answer{.report = {},
                  .J = reduced.J,
                  .K = reduced.K,
                  .U = MatrixView(work.U.data(), 0, reduced.K.cols()),
                  .determinant = absent,
                  .indices = {absent, absent, absent, absent},
                  .type_1 = {},
                  .type_2 = {}};
  answer.report.residual = reduced.closure_error;
  if (std::isinf(reduced.closure_error)) {
    answer.report.status = Status::left_domain;
    answer.report.message.append("the configuration is not a finite number in every coordinate");
    return answer;
  }
  answer.type_1 = std::span(work.type_1)
                      .first(std::visit([&](const auto& r) { return type_one(r, pose, coordinates, work); },
                                        robot.model));
  answer.type_2 = std::visit(
      [&](const auto& r) { return type_two(r, pose, reduced.J, answer.indices.condition_homogenised, work); },
      robot.model);

  std::array<double, max_matrix_size> sigma;
  singular_values(reduced.J, sigma);
  answer.indices.condition = sigma[0] / sigma[static_cast<std::size_t>(freedoms - 1)];
  if (reduced.J.rows() == freedoms) answer.determinant = determinant(reduced.J);
  const bool square = reduced.J.rows() == freedoms;
  if (answer.type_2.singular || !square || !solve(reduced.J, reduced.K, work.U)) {
    if (answer.type_2.singular) {
      answer.report.status = Status::singular;
      answer.report.message.append(
          "type II: the platform can move with all inputs held; the lines of the legs are ");
      answer.report.message.append(to_string(answer.type_2.kind));
    }
    return answer;
  }
  // A Map is seated anew by placement, as Eigen documents.
  new (&answer.U) MatrixView(work.U.data(), freedoms, reduced.K.cols());
  const Eigen::Index linear = freedoms == 3 ? 2 : 3;
  answer.indices.position = block_norm(answer.U, 0, linear);
  answer.indices.rotation = block_norm(answer.U, linear, freedoms - linear);
  return answer;
}

bool rates(const Velocity& velocity, Numbers twist, Workspace& work) {
  if (!velocity.type_1.empty()) return false;
  const Eigen::Map<const Eigen::VectorXd> t(twist.data(), static_cast<Eigen::Index>(twist.size()));
  for (Eigen::Index i = 0; i < velocity.J.rows(); ++i)
    work.s[static_cast<std::size_t>(i)] = velocity.J.row(i).dot(t);
  least_norm(velocity.K, work.s, work.rates);
  return true;
}

}  // namespace sinew::inline v0
