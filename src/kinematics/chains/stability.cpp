/// Energy of robots on chains: its value, and its curvature along what the closures leave free.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinematics/chains/chain_analysis.hpp"
#include "kinematics/chains/path.hpp"

namespace sinew::inline v1 {
namespace {

using Eigen::MatrixXd;

/// Eigenvalues of H where C is 0, ascending; none where that leaves nothing. Reflections turn one row of C
/// after the other onto an axis, the longest first; H is seen along the axes that are left.
Eigen::VectorXd on_null_space(MatrixXd H, MatrixXd C) {
  const Eigen::Index n = H.cols();
  double longest = 0;
  Eigen::Index rank = 0;
  for (; rank < std::min(C.rows(), n); ++rank) {
    const Eigen::Index left = n - rank;
    Eigen::Index row = 0;
    const double length = C.bottomRightCorner(C.rows() - rank, left).rowwise().norm().maxCoeff(&row);
    longest = std::max(longest, length);
    if (!(length > 1e-12 * longest)) break;  // rows may say the same twice
    C.row(rank).swap(C.row(rank + row));
    Eigen::VectorXd v = C.row(rank).tail(left).transpose();
    v[0] += std::copysign(length, v[0]);
    v.normalize();
    const auto reflect = [&](auto columns) {
      const Eigen::VectorXd along = columns * v;
      columns.noalias() -= 2 * along * v.transpose();
    };
    reflect(C.rightCols(left));
    reflect(H.rightCols(left));
    reflect(H.bottomRows(left).transpose());
  }
  if (rank == n) return {};
  const MatrixXd reduced = H.bottomRightCorner(n - rank, n - rank);
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(reduced, Eigen::EigenvaluesOnly).eigenvalues();
}

/// The energy's Hessian H and what is held C, in the pose and all angles.
struct Variation {
  MatrixXd H, C;
  struct Block {
    Eigen::Index angle, angles, row, rows;
  };
  std::vector<Block> legs;
};

template <class Space>
Variation variation(const ChainLegs<Space>& robot, const ChainState<Space>& state) {
  constexpr int dof = Space::dof;
  Variation all;
  Eigen::Index size = dof, rows = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    all.legs.push_back({size, robot.legs[i].chain.joints(), rows, state.hold[i].length_of >= 0 ? 2 : 1});
    size += all.legs.back().angles;
    rows += all.legs.back().rows;
  }
  MatrixXd &H = all.H, &C = all.C;
  H = MatrixXd::Zero(size, size), C = MatrixXd::Zero(rows, size);
  const auto platform = Space::frame(state.pose);
  LegSystem<Space> system;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& [first, n, row, own_rows] = all.legs[i];
    form(robot.legs[i], platform, state.legs[i], state.hold[i], system);
    const auto& closure = system.closure;
    const double force = system.force;
    C.row(row).head<dof>() = closure.c_x.transpose();
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      for (Eigen::Index k = 0; k < n; ++k)
        H(first + j, first + k) = force * closure.c_qq(joint, static_cast<std::size_t>(k));
      H(first + j, first + j) += system.stiffness[joint];
      H.row(first + j).head<dof>() = force * closure.across[joint] * closure.turn.transpose();
      C(row, first + j) = closure.c_q[joint];
      if (own_rows > 1) C(row + 1, first + j) = system.tendon[joint];
    }
    H.block(0, first, dof, n) = H.block(first, 0, n, dof).transpose();
    H.topLeftCorner<dof, dof>() += 0.5 * force * (closure.c_xx + closure.c_xx.transpose());
  }
  return all;
}

int count_negative(const Eigen::VectorXd& values) { return static_cast<int>((values.array() < 0).count()); }

double least(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values[0] : std::numeric_limits<double>::infinity();
}

/// Turns as lengths on the longest chain.
template <class Space>
Vec<double, Space::dof> scale_of(const ChainLegs<Space>& robot) {
  double size = 0;
  for (const auto& leg : robot.legs) size = std::max(size, leg.chain.length);
  Vec<double, Space::dof> scale = Vec<double, Space::dof>::Ones();
  scale.template tail<Space::dof - Space::dimension>() /= size;
  return scale;
}

}  // namespace

template <class Space>
double smallest_hessian_eigenvalue(const ChainLegs<Space>& robot, const ChainState<Space>& state) {
  if (!fits(robot, state)) return std::numeric_limits<double>::quiet_NaN();
  const Variation all = variation(robot, state);
  return least(on_null_space(all.H, all.C));
}

template <class Space>
ChainStability<Space> check_stability(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                      ChainWork& work) {
  constexpr int dof = Space::dof;
  ChainStability<Space> stability{std::numeric_limits<double>::quiet_NaN(), 0, {}, {}};
  if (!fits(robot, state)) return stability;
  const Variation all = variation(robot, state);
  const Eigen::VectorXd values = on_null_space(all.H, all.C);
  stability.smallest_eigenvalue = least(values);
  stability.unstable_directions = count_negative(values);
  if (stability.unstable_directions == 0) return stability;  // nor are they in any part
  const ChainGroup<Space>& group = linearised(work, robot, state);
  for (int i = 0; i < group.limbs(); ++i)
    if (group.unstable_with_tip_held(i)[0] > 0) stability.unstable_legs.push_back(i);
  const Vec<double, dof> scale = scale_of(robot);
  const MatrixXd S = scale.asDiagonal() * group.stiffness() * scale.asDiagonal();
  if (!S.allFinite()) return stability;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> own(0.5 * (S + S.transpose()));
  for (int k = 0; k < count_negative(own.eigenvalues()); ++k)
    stability.unstable.push_back(scale.cwiseProduct(own.eigenvectors().col(k)));
  return stability;
}

template <class Space>
ChainMargins margins(const ChainLegs<Space>& robot, const ChainState<Space>& state, ChainWork& work) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!fits(robot, state)) return {none, none};
  ChainMargins found{regularity(linearised(work, robot, state)), 0};
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    if (!(leg.diameter > 0)) found.strain = none;
    for (int j = 0; j < leg.chain.joints(); ++j) {
      const double bend = state.legs[i].angles[static_cast<std::size_t>(j)] /
                          (even_bend(leg.chain, j) * leg.chain.link_length());
      found.strain = worse(found.strain, 0.5 * leg.diameter * bend);
    }
  }
  return found;
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
double potential(const ChainLegs<Space>& robot, const ChainState<Space>& state) {
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

#define SINEW_OF(Space)                                                                             \
  template double smallest_hessian_eigenvalue(const ChainLegs<Space>&, const ChainState<Space>&);   \
  template ChainStability<Space> check_stability(const ChainLegs<Space>&, const ChainState<Space>&, \
                                                 ChainWork&);                                       \
  template ChainMargins margins(const ChainLegs<Space>&, const ChainState<Space>&, ChainWork&);     \
  template double potential(const ChainLegs<Space>&, const ChainState<Space>&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
