#include "sinew/analysis/velocity.hpp"

#include <cmath>

#include "analysis/lines.hpp"
#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "robot/arguments.hpp"
#include "robot/parallel.hpp"
#include "robot/pose.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// σmax/σmin; absent beyond 1e15, where it says how the matrix was rounded and not what it is.
double condition(std::span<const double> sigma) {
  const double ratio = sigma.front() / sigma.back();
  return ratio < 1e15 ? ratio : not_a_number;
}

/// 2-norm of a block of rows of U.
double block_norm(const MatrixView& U, Eigen::Index first, Eigen::Index count) {
  std::array<double, max_rows> sigma;
  const MatrixView block(U.data() + first * U.cols(), count, U.cols());
  singular_values(block, sigma);
  return sigma[0];
}

/// The leg's inputs move its rows in no direction, or in fewer than they could: the largest (of a pin: the
/// smaller) singular value of g_q, its columns scaled by the speed they give the tip, rows by the pull. The
/// row of a plane is nobody's to move.
template <class LegT, class Frame>
bool is_type_one(const LegT& leg, const Frame& platform, const typename LegT::Coordinates& q) {
  const auto tip = leg.template tip<double>(q);
  const auto blocks = leg.template blocks<double>(platform, tip);
  constexpr int rows = LegT::driven_rows;
  Mat<double, rows, LegT::coordinates> slope = blocks.g_q.template topRows<rows>();
  for (int i = 0; i < rows; ++i) {
    const double pull = blocks.g_x.row(i).template head<LegT::Space::dimension>().norm();
    for (int j = 0; j < LegT::coordinates; ++j) slope(i, j) /= pull * tip.rate.col(j).norm();
  }
  if (!slope.allFinite()) return true;  // folded on the spot: no line, or a tip that no input moves
  if constexpr (rows == 1) {
    return slope.cwiseAbs().maxCoeff() <= type_1_tolerance;
  } else {
    std::array<double, max_rows> sigma;
    const Eigen::Matrix<double, rows, LegT::coordinates, Eigen::RowMajor> by_rows = slope;
    singular_values(MatrixView(by_rows.data(), rows, LegT::coordinates), sigma);
    return sigma[rows - 1] <= type_1_tolerance;
  }
}

/// Legs that cannot follow every motion of the platform at once.
template <class LegT>
std::size_t type_one(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                     Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  std::size_t count = 0;
  robot.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int i) {
    if (is_type_one(leg, platform, own_coordinates(leg, place, coordinates))) work.type_1[count++] = i;
  });
  return count;
}

Velocity nothing_yet(const Reduced& reduced, Workspace& work) {
  Velocity answer{.report = {},
                  .J = reduced.J,
                  .K = reduced.K,
                  .U = MatrixView(work.U.data(), 0, reduced.K.cols()),
                  .determinant = not_a_number,
                  .indices = {not_a_number, not_a_number, not_a_number, not_a_number},
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
Velocity velocity_of(const ParallelRobot<LegT>& robot, const Robot& any, const AnyPose& pose,
                     Numbers coordinates, const Reduced& reduced, Workspace& work) {
  using Space = typename LegT::Space;
  Velocity answer = nothing_yet(reduced, work);
  if (std::isinf(reduced.closure_error)) {
    refuse(answer, Status::left_domain, "the configuration is not a finite number in every coordinate");
    return answer;
  }
  answer.type_1 = std::span(work.type_1).first(type_one(robot, pose, coordinates, work));
  const MatrixView lines = homogenise(any, reduced, work);
  answer.type_2 = classify(lines, Space::position(in_space<Space>(pose)), robot.platform_radius);
  answer.indices.condition_homogenised = answer.type_2.condition;

  std::array<double, max_rows> sigma;
  singular_values(reduced.J, sigma);
  if (reduced.J.rows() >= Space::dof)
    answer.indices.condition = condition(std::span(sigma).first(Space::dof));
  if (reduced.J.rows() == Space::dof) answer.determinant = determinant(reduced.J);
  if (reduced.J.rows() < Space::dof)
    refuse(answer, Status::singular,
           "the legs hold fewer freedoms than the platform has: it can move with all inputs held");
  else if (answer.type_2.singular)
    refuse(answer, Status::singular,
           "type II: the platform can move with all inputs held; class of the legs' lines: ",
           to_string(answer.type_2.kind));
  else if (reduced.J.rows() > Space::dof)
    answer.report.message.append(
        "there is no U: more constraints than freedoms, so the inputs depend on each other");
  else
    sensitivities<Space>(answer, lines, robot.platform_radius, work);
  return answer;
}

}  // namespace

Velocity velocity(const Robot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  const Report fits = check_arguments(robot, pose, coordinates, work);
  if (!fits.ok()) {
    Velocity answer = nothing_yet(assemble(robot, pose, coordinates, work), work);
    answer.report = fits;
    return answer;
  }
  const Reduced reduced = assemble(robot, pose, coordinates, work);
  return with_closing_legs(
      robot, [&](const auto& r) { return velocity_of(r, robot, pose, coordinates, reduced, work); },
      [&] {
        Velocity answer = nothing_yet(reduced, work);
        refuse(answer, Status::unsupported,
               "the legs bear load: analyse_equilibrium has their stiffness and sensitivity");
        return answer;
      });
}

Report rates(const Velocity& velocity, Numbers twist, Workspace& work) {
  Report report;
  const auto refuse_with = [&](std::string_view why) {
    report.status = Status::singular;
    report.message.append(why);
    return report;
  };
  const Eigen::Index inputs = velocity.K.cols(), rows = velocity.J.rows();
  if (static_cast<Eigen::Index>(twist.size()) != velocity.J.cols() || rows == 0 ||
      static_cast<std::size_t>(rows) != work.s.size() ||
      static_cast<std::size_t>(inputs) != work.rates.size()) {
    report.status = Status::bad_input;
    report.message.append(
        "a twist has one number for each freedom of the platform, of a velocity that was found with this "
        "workspace");
    return report;
  }
  if (!velocity.type_1.empty())
    return refuse_with("a leg at a type I singularity cannot follow a twist; see type_1");
  const Eigen::Map<const Eigen::VectorXd> t(twist.data(), static_cast<Eigen::Index>(twist.size()));
  for (Eigen::Index i = 0; i < velocity.J.rows();
       ++i) {  // rows of K scaled to one: legs may be of unlike size
    const double drive = velocity.K.row(i).cwiseAbs().maxCoeff();
    if (drive == 0) {  // a plane: no input moves it, so the twist must keep to it
      const double along = velocity.J.row(i).dot(t), size = velocity.J.row(i).cwiseAbs().dot(t.cwiseAbs());
      if (!(std::abs(along) <= 1e-9 * size))
        return refuse_with("the platform cannot move so: a hinge holds a platform point in its plane");
      work.s[static_cast<std::size_t>(i)] = 0;
      std::fill_n(work.unit_K.begin() + i * inputs, inputs, 0.0);
      continue;
    }
    const double scale = 1 / drive;
    work.s[static_cast<std::size_t>(i)] = velocity.J.row(i).dot(t) * scale;
    for (Eigen::Index j = 0; j < inputs; ++j)
      work.unit_K[static_cast<std::size_t>(i * inputs + j)] = velocity.K(i, j) * scale;
  }
  const MatrixView unit_K(work.unit_K.data(), velocity.K.rows(), inputs);
  least_norm(unit_K, work.s, work.rates);
  const Eigen::Map<const Eigen::VectorXd> needed(work.s.data(), unit_K.rows()),
      found(work.rates.data(), inputs);
  if (!found.allFinite()) return refuse_with("the rates that this twist needs are too large to be written");
  for (Eigen::Index i = 0; i < unit_K.rows(); ++i)
    if (!(std::abs(unit_K.row(i).dot(found) - needed[i]) <= 1e-9 * needed.cwiseAbs().maxCoeff()))
      return refuse_with("legs that share an input would need different rates for this twist");
  return report;
}

}  // namespace sinew::inline v1
