#include "sinew/analysis/chain_velocity.hpp"

#include <cmath>

#include "sinew/base/numbers.hpp"

namespace sinew::inline v0 {
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

}  // namespace

template <class Space>
ChainVelocity<Space> chain_velocity(const ChainRobot<Space>& robot, const typename Space::Pose& pose,
                                    std::span<const ChainLegState> legs) {
  constexpr int dof = Space::dof, dimension = Space::dimension;
  using Rows = Eigen::Matrix<double, dof, dof, Eigen::RowMajor>;
  ChainVelocity<Space> velocity{};
  velocity.rates = chain_rates(robot, pose, legs);
  velocity.report.residual = velocity.rates.closure_error;
  Rows lines, scaled = Rows::Zero();
  for (int i = 0; i < dof; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    double squares = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns[leg]); ++j)
      squares += velocity.rates.K[leg][j] * velocity.rates.K[leg][j];
    velocity.drive[leg] = std::sqrt(squares);
    const double distance = std::sqrt(
        squared_norm(Vec<double, dimension>(velocity.rates.J.row(i).template head<dimension>().transpose())));
    for (int k = 0; k < dof; ++k)
      lines(i, k) = velocity.rates.J(i, k) / (k < dimension ? distance : distance * robot.platform_radius);
    scaled(i, i) = 1 / distance;
    // chords are shorter than their chains, joints turn arms of their length
    if (!(velocity.drive[leg] > type_1_tolerance * distance * robot.legs[leg].chain.length))
      velocity.type_1_legs[static_cast<std::size_t>(velocity.type_1_count++)] = i;
  }
  velocity.type_2 =
      classify(MatrixView(lines.data(), dof, dof), Space::position(pose), robot.platform_radius);
  const Rows J = velocity.rates.J;
  std::array<double, max_rows> sigma;
  singular_values(MatrixView(J.data(), dof, dof), sigma);
  const double condition = sigma[0] / sigma[static_cast<std::size_t>(dof - 1)];
  velocity.indices = {condition < 1e15 ? condition : not_a_number, velocity.type_2.condition, not_a_number,
                      not_a_number};
  velocity.determinant = determinant(MatrixView(J.data(), dof, dof));
  Rows inverse;
  if (velocity.type_2.singular ||
      !solve(MatrixView(lines.data(), dof, dof), MatrixView(scaled.data(), dof, dof),
             std::span(inverse.data(), static_cast<std::size_t>(dof * dof)))) {
    velocity.report.status = Status::singular;
    velocity.report.message.append(
        "type II: the platform can move with all inputs held; class of the legs' lines: ");
    velocity.report.message.append(to_string(velocity.type_2.kind));
    return velocity;
  }
  for (int k = dimension; k < dof; ++k) inverse.row(k) /= robot.platform_radius;
  velocity.inverse = inverse;
  velocity.indices.position = block_norm(velocity, 0, dimension);
  velocity.indices.rotation = block_norm(velocity, dimension, dof - dimension);
  return velocity;
}

template <class Space>
std::vector<double> least_norm_rates(const ChainVelocity<Space>& velocity,
                                     const Vec<double, Space::dof>& twist) {
  std::vector<double> rates;
  const Vec<double, Space::dof> needed = velocity.rates.J * twist;
  for (std::size_t i = 0; i < velocity.drive.size(); ++i) {
    const double share = needed[static_cast<Eigen::Index>(i)] / (velocity.drive[i] * velocity.drive[i]);
    for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns[i]); ++j)
      rates.push_back(share * velocity.rates.K[i][j]);
  }
  return rates;
}

template SINEW_API std::vector<double> least_norm_rates(const ChainVelocity<Planar>&, const Vec<double, 3>&);
template SINEW_API std::vector<double> least_norm_rates(const ChainVelocity<Spatial>&, const Vec<double, 6>&);
template SINEW_API ChainVelocity<Planar> chain_velocity(const ChainRobot<Planar>&, const PlanarPose&,
                                                        std::span<const ChainLegState>);
template SINEW_API ChainVelocity<Spatial> chain_velocity(const ChainRobot<Spatial>&, const SpatialPose&,
                                                         std::span<const ChainLegState>);

}  // namespace sinew::inline v0
