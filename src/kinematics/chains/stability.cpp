/// Energy of robots on chains: its value, and its curvature along what the closures leave free.
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "kinematics/chains/leg_system.hpp"

namespace sinew::inline v0 {
namespace {

using Eigen::MatrixXd;

/// Smallest eigenvalue of H where C is 0; infinite where that leaves nothing.
double least_on_null_space(const MatrixXd& H, const MatrixXd& C) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(C.transpose());  // rows may say the same twice
  qr.setThreshold(1e-12);
  if (qr.rank() >= H.cols()) return std::numeric_limits<double>::infinity();
  const MatrixXd Q = qr.householderQ();
  const MatrixXd Z = Q.rightCols(H.cols() - qr.rank()), reduced = Z.transpose() * H * Z;
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(reduced, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

template <class Space>
double least_curvature(const ChainRobot<Space>& robot, const ChainState<Space>& state) {
  constexpr int dof = Space::dof;
  if (!fits(robot, state)) return std::numeric_limits<double>::quiet_NaN();
  Eigen::Index size = dof, rows = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    size += robot.legs[i].chain.joints();
    rows += state.hold[i].length_of >= 0 ? 2 : 1;
  }
  MatrixXd H = MatrixXd::Zero(size, size), C = MatrixXd::Zero(rows, size);
  const auto platform = Space::frame(state.pose);
  LegSystem<Space> system;
  Eigen::Index first = dof, row = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    form(robot.legs[i], platform, state.legs[i], state.hold[i], system);
    const auto& closure = system.closure;
    const double force = system.force;
    const Eigen::Index n = system.joints;
    C.row(row).head<dof>() = closure.c_x.transpose();
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      for (Eigen::Index k = 0; k < n; ++k)
        H(first + j, first + k) = force * closure.c_qq(joint, static_cast<std::size_t>(k));
      H(first + j, first + j) += system.stiffness[joint];
      H.row(first + j).head<dof>() = force * closure.across[joint] * closure.turn.transpose();
      C(row, first + j) = closure.c_q[joint];
      if (system.holds_length) C(row + 1, first + j) = system.tendon[joint];
    }
    H.block(0, first, dof, n) = H.block(first, 0, n, dof).transpose();
    H.topLeftCorner<dof, dof>() += 0.5 * force * (closure.c_xx + closure.c_xx.transpose());
    row += system.holds_length ? 2 : 1;
    first += n;
  }
  return least_on_null_space(H, C);
}

namespace {

double work_of(const Vec<double, 3>& wrench, const PlanarPose& pose) {
  return wrench[0] * pose.x + wrench[1] * pose.y + wrench[2] * pose.phi;
}
double work_of(const Vec<double, 6>& wrench, const SpatialPose& pose) {
  if (wrench[3] != 0 || wrench[4] != 0 || wrench[5] != 0) return std::numeric_limits<double>::quiet_NaN();
  return dot(Vec3<double>(wrench[0], wrench[1], wrench[2]), pose.position);
}

}  // namespace

template <class Space>
double potential(const ChainRobot<Space>& robot, const ChainState<Space>& state) {
  if (!fits(robot, state)) return std::numeric_limits<double>::quiet_NaN();
  double sum = -work_of(state.wrench, state.pose);
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    const ChainLegState& own = state.legs[i];
    for (int j = 0; j < leg.chain.joints(); ++j) {
      const double angle = own.angles[static_cast<std::size_t>(j)];
      sum += 0.5 * leg.spring(j) * angle * angle;
    }
    for (int k = 0; k < 2; ++k)
      if (state.hold[i].length_of != k)
        sum += own.tension[static_cast<std::size_t>(k)] * own.tendon_length[static_cast<std::size_t>(k)];
  }
  return sum;
}

#define SINEW_OF(Space)                                                                          \
  template SINEW_API double least_curvature(const ChainRobot<Space>&, const ChainState<Space>&); \
  template SINEW_API double potential(const ChainRobot<Space>&, const ChainState<Space>&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
