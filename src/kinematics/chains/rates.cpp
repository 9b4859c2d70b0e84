/// Velocity equations of robots on chains, and what the paper's linear statics make of them.
#include <cmath>
#include <limits>

#include "base/limits.hpp"
#include "kinematics/chains/leg_system.hpp"
#include "math/linalg.hpp"

namespace sinew::inline v1 {

template <class Space>
ChainRates<Space> chain_rates(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                              std::span<const ChainLegState> legs) {
  ChainRates<Space> rates;
  if (legs.size() != robot.legs.size() || legs.size() > static_cast<std::size_t>(max_rows)) {
    rates.closure_error = std::numeric_limits<double>::quiet_NaN();
    return rates;
  }
  rates.J.resize(static_cast<Eigen::Index>(legs.size()), Space::dof);
  const auto platform = Space::frame(pose);
  ChainClosure<Space> at;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    close_chain(leg, platform, legs[i].of(leg.chain), at);
    rates.closure_error = worse(rates.closure_error, at.c);
    rates.J.row(static_cast<Eigen::Index>(i)) = at.distance * at.c_x.transpose();
    auto column = rates.K[i].begin();
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors) *column++ = -at.distance * motor_slope(leg, legs[i].of(leg.chain), at);
    for (std::size_t j = 0; j < static_cast<std::size_t>(leg.chain.joints()); ++j)
      *column++ = -at.distance * at.c_q[j];
    rates.columns[i] = static_cast<int>(column - rates.K[i].begin());
  }
  return rates;
}

namespace {

/// Not a number where there is none.
template <class Square>
Square inverse_of(const Square& matrix) {
  constexpr int n = Square::RowsAtCompileTime;
  using Rows = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
  const Rows rows = matrix, unit = Rows::Identity();
  Rows inverse;
  const bool is_found = solve(MatrixView(rows.data(), n, n), MatrixView(unit.data(), n, n),
                              std::span(inverse.data(), static_cast<std::size_t>(n * n)));
  return is_found ? Square(inverse) : Square(Square::Constant(std::numeric_limits<double>::quiet_NaN()));
}

/// ∂(pose)/∂(wrench) of springs: row i of `lines` times the platform's motion is what yields by `soft`[i]
/// times the force along it. Of as many lines as freedoms none has to yield.
template <class Lines>
auto compliance_along(const Lines& lines, std::span<const double> soft) {
  constexpr int dof = Lines::ColsAtCompileTime;
  using Square = Mat<double, dof, dof>;
  if (lines.rows() < dof) return Square(Square::Constant(std::numeric_limits<double>::quiet_NaN()));
  const Eigen::Map<const Eigen::VectorXd> softness(soft.data(), lines.rows());
  if (lines.rows() == dof) {
    const Square inverse = inverse_of(Square(lines));
    return Square(inverse * softness.asDiagonal() * inverse.transpose());
  }
  return inverse_of(Square(lines.transpose() * softness.cwiseInverse().asDiagonal() * lines));
}

}  // namespace

template <class Space>
Mat<double, Space::dof, Space::dof> linear_compliance(const ChainLegs<Space>& robot,
                                                      const ChainState<Space>& state) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const ChainRates<Space> rates = chain_rates(robot, state.pose, state.legs);
  if (!fits(robot, state) || rates.legs() == 0) return Mat<double, Space::dof, Space::dof>::Constant(none);
  const std::size_t motors = robot.has_base_motors ? 1 : 0;
  std::array<double, max_rows> softness{};
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    const int held = state.hold[i].length_of;
    double soft = 0, along = 0, tendon = 0;  // K k⁻¹ Kᵀ is diagonal: a row has joints of its own leg only
    for (int j = 0; j < leg.chain.joints(); ++j) {
      const double slope = rates.K[i][static_cast<std::size_t>(j) + motors], k = leg.spring(j);
      soft += slope * slope / k;
      if (held < 0) continue;
      const double pull = leg.chain
                              .tendon_bend(j, state.legs[i].angles[static_cast<std::size_t>(j)],
                                           leg.tendon_offset, held == 0 ? 1 : -1)
                              .rate;
      along += slope * pull / k;
      tendon += pull * pull / k;
    }
    if (held >= 0) soft -= along * along / tendon;  // what would change the length is not left
    softness[i] = soft;
  }
  return compliance_along(rates.J, softness);
}

template <class Space>
double constant_curvature_energy_gap(const ChainLegs<Space>& robot, const ChainState<Space>& unloaded,
                                     const Vec<double, Space::dof>& wrench) {
  if (!fits(robot, unloaded) || robot.legs.size() > static_cast<std::size_t>(max_rows))
    return std::numeric_limits<double>::quiet_NaN();
  const auto platform = Space::frame(unloaded.pose);
  ChainClosure<Space> at;
  decltype(ChainRates<Space>::J) lines(static_cast<Eigen::Index>(robot.legs.size()), Space::dof);
  std::array<double, max_rows> chain{}, even{};
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    close_chain(leg, platform, unloaded.legs[i].of(leg.chain), at);
    double along = 0, stiff = 0;
    for (int j = 0; j < leg.chain.joints(); ++j) {
      const double slope = at.c_q[static_cast<std::size_t>(j)], w = even_bend(leg.chain, j),
                   k = leg.spring(j);
      chain[i] += slope * slope / k;
      along += slope * w;
      stiff += w * k * w;
    }
    even[i] = along * along / stiff;
    lines.row(static_cast<Eigen::Index>(i)) = at.c_x.transpose();
  }
  return 0.5 * dot(wrench, Vec<double, Space::dof>(
                               (compliance_along(lines, chain) - compliance_along(lines, even)) * wrench));
}

double motor_torque(const ChainLeg<Planar>& leg, const ChainLegState& state, const SE2<double>& platform) {
  ChainClosure<Planar> at;
  const auto angles = state.of(leg.chain);
  close_chain(leg, platform, angles, at);
  return state.force * motor_slope(leg, angles, at);
}

TipWrench tip_wrench(const PseudoRigid& chain, std::span<const double> torques,
                     std::span<const double> angles) {
  const auto tip = chain.tip(angles);
  const double unit = chain.length;  // forces as moments, so that columns compare
  Mat<double, 3, 3> normal = Mat<double, 3, 3>::Zero();
  Vec3<double> right = Vec3<double>::Zero(), found;
  const auto row = [&](std::size_t j) {
    return Vec3<double>(tip.rate[j][0] / unit, tip.rate[j][1] / unit, chain.turn_weight(static_cast<int>(j)));
  };
  double size = 0, miss = 0;
  for (std::size_t j = 0; j < torques.size(); ++j) {
    const Vec3<double> one = row(j);
    normal += one * one.transpose();
    right += torques[j] * one;
    size += torques[j] * torques[j];
  }
  least_norm(MatrixView(normal.data(), 3, 3), std::span(right.data(), 3), std::span(found.data(), 3), 1e-14);
  for (std::size_t j = 0; j < torques.size(); ++j) {
    const double gap = dot(row(j), found) - torques[j];
    miss += gap * gap;
  }
  return {Vec2<double>(found[0], found[1]) / unit, found[2], size > 0 ? std::sqrt(miss / size) : 0};
}

template <class Space>
Vec<double, Space::dof> tip_wrench(const ChainLeg<Space>& leg, std::span<const double> angles,
                                   const typename Space::template Frame<double>& platform) {
  std::vector<double> torques;
  for (int j = 0; j < leg.chain.joints(); ++j)
    torques.push_back(leg.spring(j) * angles[static_cast<std::size_t>(j)]);
  const TipWrench own = tip_wrench(leg.chain, torques, angles);
  const auto frame = chain_frame(leg, angles, platform);
  Vec<double, Space::dof> wrench;
  if constexpr (Space::dimension == 2)
    wrench << frame.rotate(own.force), own.moment;
  else
    wrench << frame.rotate(Vec3<double>(own.force.x(), own.force.y(), 0)),
        frame.rotate(Vec3<double>(0, 0, own.moment));
  return wrench;
}

#define SINEW_OF(Space)                                                                            \
  template ChainRates<Space> chain_rates(const ChainLegs<Space>&, const Space::Pose&,              \
                                         std::span<const ChainLegState>);                          \
  template Mat<double, Space::dof, Space::dof> linear_compliance(const ChainLegs<Space>&,          \
                                                                 const ChainState<Space>&);        \
  template Vec<double, Space::dof> tip_wrench(const ChainLeg<Space>&, std::span<const double>,     \
                                              const Space::Frame<double>&);                        \
  template double constant_curvature_energy_gap(const ChainLegs<Space>&, const ChainState<Space>&, \
                                                const Vec<double, Space::dof>&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
