#include "analysis/chain_velocity.hpp"

#include <cmath>

#include "analysis/lines.hpp"
#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// 2-norm of the rows of J⁻¹ diag(|gᵢ|) from `first` on.
template <class Space>
double block_norm(const ChainVelocity<Space>& velocity, int first, int count) {
  constexpr int dof = Space::dof;
  std::array<double, static_cast<std::size_t>(dof * dof)> block;
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < dof; ++i)
      block[static_cast<std::size_t>(k * dof + i)] =
          velocity.inverse(first + k, i) * velocity.drive[static_cast<std::size_t>(i)];
  std::array<double, max_rows> sigma;
  singular_values(MatrixView(block.data(), count, dof), sigma);
  return sigma[0];
}

template <int Columns>
using Rows =
    Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor | Eigen::DontAlign, max_rows, Columns>;

template <int Columns>
MatrixView view(const Rows<Columns>& rows) {
  return {rows.data(), rows.rows(), Columns};
}

/// Rows of unit lines, moments over the platform's radius; type I legs.
template <class Space>
Rows<Space::dof> unit_lines(const ChainLegs<Space>& robot, ChainVelocity<Space>& velocity,
                            std::array<double, max_rows>& distance) {
  const auto& rates = velocity.rates;
  Rows<Space::dof> lines = rates.J;
  for (std::size_t leg = 0; leg < rates.legs(); ++leg) {
    double squares = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(rates.columns[leg]); ++j)
      squares += rates.K[leg][j] * rates.K[leg][j];
    velocity.drive[leg] = std::sqrt(squares);
    auto row = lines.row(static_cast<Eigen::Index>(leg));
    distance[leg] = row.template head<Space::dimension>().norm();
    row /= distance[leg];
    row.template tail<Space::dof - Space::dimension>() /= robot.platform_radius;
    // chords are shorter than their chains, joints turn arms of their length
    if (!(velocity.drive[leg] > type_1_tolerance * distance[leg] * robot.legs[leg].chain.length))
      velocity.type_1_legs[static_cast<std::size_t>(velocity.type_1_count++)] = static_cast<int>(leg);
  }
  return lines;
}

/// J⁻¹ by way of the unit lines, and the norms of U; false where they have no inverse.
template <class Space>
bool invert(const Rows<Space::dof>& lines, std::span<const double> distance, double radius,
            ChainVelocity<Space>& velocity) {
  constexpr int dof = Space::dof, dimension = Space::dimension;
  using Square = Eigen::Matrix<double, dof, dof, Eigen::RowMajor>;
  Square scaled = Square::Zero(), inverse;
  for (int i = 0; i < dof; ++i) scaled(i, i) = 1 / distance[static_cast<std::size_t>(i)];
  if (!solve(view<dof>(lines), MatrixView(scaled.data(), dof, dof),
             std::span(inverse.data(), static_cast<std::size_t>(dof * dof))))
    return false;
  inverse.template bottomRows<dof - dimension>() /= radius;
  velocity.inverse = inverse;
  velocity.has_inverse = true;
  velocity.indices.position = block_norm(velocity, 0, dimension);
  velocity.indices.rotation = block_norm(velocity, dimension, dof - dimension);
  return true;
}

}  // namespace

template <class Space>
ChainVelocity<Space> chain_velocity(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                                    std::span<const ChainLegState> legs) {
  constexpr int dof = Space::dof;
  ChainVelocity<Space> velocity{};
  velocity.rates = chain_rates(robot, pose, legs);
  velocity.report.residual = velocity.rates.closure_error;
  velocity.determinant = not_a_number;
  velocity.indices = {not_a_number, not_a_number, not_a_number, not_a_number};
  const auto refuse = [&](Status status, std::string_view why, std::string_view more = {}) {
    velocity.report.status = status;
    velocity.report.message.append(why);
    velocity.report.message.append(more);
    return velocity;
  };
  const auto rows = static_cast<int>(velocity.rates.legs());
  if (rows == 0)
    return refuse(Status::bad_input,
                  "each leg of the robot needs a state of its own; the most legs are those of a robot file");
  std::array<double, max_rows> distance{};
  const Rows<dof> lines = unit_lines(robot, velocity, distance), J = velocity.rates.J;
  velocity.type_2 = classify(view<dof>(lines), Space::position(pose), robot.platform_radius);
  velocity.indices.condition_homogenised = velocity.type_2.condition;
  if (rows < dof)
    return refuse(Status::singular,
                  "the legs hold fewer freedoms than the platform has: it can move with all inputs held");
  std::array<double, max_rows> sigma;
  singular_values(view<dof>(J), sigma);
  const double condition = sigma[0] / sigma[static_cast<std::size_t>(dof - 1)];
  if (condition < 1e15) velocity.indices.condition = condition;
  if (rows == dof) velocity.determinant = determinant(view<dof>(J));
  if (velocity.type_2.singular || (rows == dof && !invert(lines, distance, robot.platform_radius, velocity)))
    return refuse(Status::singular,
                  "type II: the platform can move with all inputs held; class of the legs' lines: ",
                  to_string(velocity.type_2.kind));
  if (rows > dof)
    velocity.report.message.append(
        "there is no U: more constraints than freedoms, so the chords depend on each other");
  return velocity;
}

template <class Space>
std::vector<double> least_norm_rates(const ChainVelocity<Space>& velocity,
                                     const Vec<double, Space::dof>& twist) {
  std::vector<double> rates;
  for (std::size_t i = 0; i < velocity.rates.legs(); ++i) {
    const double needed = velocity.rates.J.row(static_cast<Eigen::Index>(i)).dot(twist),
                 share = needed / (velocity.drive[i] * velocity.drive[i]);
    for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns[i]); ++j)
      rates.push_back(share * velocity.rates.K[i][j]);
  }
  return rates;
}

template std::vector<double> least_norm_rates(const ChainVelocity<Planar>&, const Vec<double, 3>&);
template std::vector<double> least_norm_rates(const ChainVelocity<Spatial>&, const Vec<double, 6>&);
template ChainVelocity<Planar> chain_velocity(const ChainLegs<Planar>&, const PlanarPose&,
                                              std::span<const ChainLegState>);
template ChainVelocity<Spatial> chain_velocity(const ChainLegs<Spatial>&, const SpatialPose&,
                                               std::span<const ChainLegState>);

}  // namespace sinew::inline v1
