#include "sinew/analysis/velocity.hpp"

#include <cmath>

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// σmax/σmin; absent beyond 1e15, where it says how the matrix was rounded and not what it is.
double condition(std::span<const double> sigma) {
  const double ratio = sigma.front() / sigma.back();
  return ratio < 1e15 ? ratio : absent;
}

/// J and K with their rows scaled to unit lines and the moments of J divided by the platform radius, in the
/// workspace: numbers of one size, whatever the robot's.
template <class Space>
MatrixView homogenise(const Reduced& reduced, double radius, Workspace& work) {
  for (Eigen::Index i = 0; i < reduced.J.rows(); ++i) {
    const double length = reduced.J.row(i).template head<Space::dimension>().norm();
    const double scale = length > 0 ? 1 / length : 0;
    for (Eigen::Index j = 0; j < Space::dof; ++j)
      work.unit_J[static_cast<std::size_t>(i * Space::dof + j)] =
          reduced.J(i, j) * (j < Space::dimension ? scale : scale / radius);
    for (Eigen::Index j = 0; j < reduced.K.cols(); ++j)
      work.unit_K[static_cast<std::size_t>(i * reduced.K.cols() + j)] = reduced.K(i, j) * scale;
  }
  return {work.unit_J.data(), reduced.J.rows(), Space::dof};
}

/// 2-norm of a block of rows of U.
double block_norm(const MatrixView& U, Eigen::Index first, Eigen::Index count) {
  std::array<double, max_rows> sigma;
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
TypeTwo type_two(const ParallelRobot<LegT>& robot, const AnyPose& pose, const MatrixView& lines,
                 double& homogeneous) {
  using Space = typename LegT::Space;
  std::array<double, max_rows> sigma;
  const std::span<double> values(sigma.data(),
                                 static_cast<std::size_t>(std::min(lines.rows(), lines.cols())));
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

namespace {

Velocity nothing_yet(const Reduced& reduced, Workspace& work) {
  Velocity answer{.report = {},
                  .J = reduced.J,
                  .K = reduced.K,
                  .U = MatrixView(work.U.data(), 0, reduced.K.cols()),
                  .determinant = absent,
                  .indices = {absent, absent, absent, absent},
                  .type_1 = {},
                  .type_2 = {}};
  answer.report.residual = reduced.closure_error;
  return answer;
}

void refuse(Velocity& answer, Status status, std::string_view why, std::string_view more = {}) {
  answer.report.status = status;
  answer.report.message.append(why);
  answer.report.message.append(more);
}

/// U = J⁻¹K by way of the homogenised matrices; its norms. @implements TDPCR (39)
template <class Space>
void sensitivities(Velocity& answer, const MatrixView& lines, double radius, Workspace& work) {
  const Eigen::Index inputs = answer.K.cols();
  if (!solve(lines, MatrixView(work.unit_K.data(), answer.K.rows(), inputs), work.U))
    return refuse(answer, Status::singular, "J cannot be inverted in double precision");
  for (Eigen::Index k = Space::dimension * inputs; k < Space::dof * inputs; ++k)
    work.U[static_cast<std::size_t>(k)] /= radius;
  // A Map is seated anew by placement, as Eigen documents.
  new (&answer.U) MatrixView(work.U.data(), Space::dof, inputs);
  answer.indices.position = block_norm(answer.U, 0, Space::dimension);
  answer.indices.rotation = block_norm(answer.U, Space::dimension, Space::dof - Space::dimension);
}

template <class LegT>
Velocity velocity_of(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                     const Reduced& reduced, Workspace& work) {
  using Space = typename LegT::Space;
  Velocity answer = nothing_yet(reduced, work);
  if (std::isinf(reduced.closure_error)) {
    refuse(answer, Status::left_domain, "the configuration is not a finite number in every coordinate");
    return answer;
  }
  answer.type_1 = std::span(work.type_1).first(type_one(robot, pose, coordinates, work));
  const MatrixView lines = homogenise<Space>(reduced, robot.platform_radius, work);
  answer.type_2 = type_two(robot, pose, lines, answer.indices.condition_homogenised);

  std::array<double, max_rows> sigma;
  singular_values(reduced.J, sigma);
  answer.indices.condition = condition(std::span(sigma).first(Space::dof));
  if (reduced.J.rows() == Space::dof) answer.determinant = determinant(reduced.J);
  if (answer.type_2.singular)
    refuse(answer, Status::singular,
           "type II: the platform can move with all inputs held; the lines of the legs are ",
           to_string(answer.type_2.kind));
  else if (reduced.J.rows() > Space::dof)
    answer.report.message.append(
        "there is no U: more legs than freedoms, so the inputs depend on each other");
  else
    sensitivities<Space>(answer, lines, robot.platform_radius, work);
  return answer;
}

}  // namespace

Velocity velocity(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  const Reduced reduced = assemble(robot, pose, coordinates, work);
  return std::visit([&](const auto& r) { return velocity_of(r, pose, coordinates, reduced, work); },
                    robot.model);
}

Report rates(const Velocity& velocity, Numbers twist, Workspace& work) {
  Report report;
  const auto refuse_with = [&](std::string_view why) {
    report.status = Status::singular;
    report.message.append(why);
    return report;
  };
  if (!velocity.type_1.empty())
    return refuse_with("a leg at a type I singularity cannot follow a twist; see type_1");
  const Eigen::Index inputs = velocity.K.cols();
  const Eigen::Map<const Eigen::VectorXd> t(twist.data(), static_cast<Eigen::Index>(twist.size()));
  for (Eigen::Index i = 0; i < velocity.J.rows();
       ++i) {  // rows of K scaled to one: legs may be of unlike size
    const double scale = 1 / velocity.K.row(i).cwiseAbs().maxCoeff();
    work.s[static_cast<std::size_t>(i)] = velocity.J.row(i).dot(t) * scale;
    for (Eigen::Index j = 0; j < inputs; ++j)
      work.unit_K[static_cast<std::size_t>(i * inputs + j)] = velocity.K(i, j) * scale;
  }
  const MatrixView unit_K(work.unit_K.data(), velocity.K.rows(), inputs);
  least_norm(unit_K, work.s, work.rates);
  const Eigen::Map<const Eigen::VectorXd> needed(work.s.data(), unit_K.rows()),
      found(work.rates.data(), inputs);
  for (Eigen::Index i = 0; i < unit_K.rows(); ++i)
    if (std::abs(unit_K.row(i).dot(found) - needed[i]) > 1e-9 * needed.cwiseAbs().maxCoeff())
      return refuse_with("legs that share an input would need different rates for this twist");
  return report;
}

}  // namespace sinew::inline v0
