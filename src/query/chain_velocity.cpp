/// Handler of velocity on pseudo-rigid chains.
#include <fmt/format.h>

#include <cmath>

#include "query/chains.hpp"
#include "sinew/analysis/chain_velocity.hpp"

namespace sinew::inline v0 {
namespace {

using namespace chains;

/// Angles per leg, from the first sprung joint; before them the direction of the first link where a motor
/// turns it.
template <class Space>
std::vector<ChainLegState> read_angles(const Reader& list, ChainRobot<Space>& robot) {
  std::vector<ChainLegState> legs(robot.legs.size());
  const auto items = list.items(robot.legs.size());
  for (std::size_t i = 0; i < std::min(items.size(), legs.size()); ++i) {
    auto& leg = robot.legs[i];
    const auto joints = static_cast<std::size_t>(leg.chain.joints());
    const std::size_t motors = robot.has_base_motors ? 1 : 0;
    const auto angles = items[i].quantities(Dimension::angle, Range::turn(), joints + motors);
    std::copy(angles.begin() + static_cast<std::ptrdiff_t>(motors), angles.end(), legs[i].angles.begin());
    if constexpr (Space::dimension == 2)
      if (motors > 0)
        leg.base = SE2<double>::from(leg.base.p.x(), leg.base.p.y(), angles[0] - std::numbers::pi / 2);
  }
  return legs;
}

template <class Space>
Json K_json(const ChainRates<Space>& rates) {
  Json rows = Json::array();
  const auto columns = static_cast<std::size_t>(rates.columns), legs = rates.K.size();
  for (std::size_t i = 0; i < legs; ++i) {
    std::vector<double> row(columns * legs);
    std::copy_n(rates.K[i].begin(), columns, row.begin() + static_cast<std::ptrdiff_t>(columns * i));
    rows.push_back(to_json(row));
  }
  return rows;
}

template <class Space>
Json U_json(const ChainVelocity<Space>& velocity) {
  Json rows = Json::array();
  for (int k = 0; k < Space::dof; ++k) {
    std::vector<double> row;
    for (std::size_t i = 0; i < velocity.rates.K.size(); ++i)
      for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns); ++j)
        row.push_back(velocity.inverse(k, static_cast<Eigen::Index>(i)) * velocity.rates.K[i][j]);
    rows.push_back(to_json(row));
  }
  return rows;
}

/// The shortest rates of all joints for a twist, leg by leg: θ̇ = g (J t)ᵢ / |g|².
template <class Space>
Json rates_json(const ChainVelocity<Space>& velocity, std::span<const double> twist) {
  Json rates = Json::array();
  for (std::size_t i = 0; i < velocity.rates.K.size(); ++i) {
    double needed = 0;
    for (int k = 0; k < Space::dof; ++k)
      needed += velocity.rates.J(static_cast<Eigen::Index>(i), k) * twist[static_cast<std::size_t>(k)];
    const double share = needed / (velocity.drive[i] * velocity.drive[i]);
    for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns); ++j)
      rates.push_back(share * velocity.rates.K[i][j]);
  }
  return rates;
}

template <class Space>
void put_velocity(Context& context, const ChainRobot<Space>& robot, const ChainVelocity<Space>& velocity,
                  const std::vector<ChainLegState>& legs, std::span<const double> twist) {
  Json& answer = context.answer;
  context.report(velocity.report);
  const Eigen::Matrix<double, Space::dof, Space::dof, Eigen::RowMajor> J = velocity.rates.J;
  answer["J"] = to_json(MatrixView(J.data(), Space::dof, Space::dof));
  answer["K"] = K_json(velocity.rates);
  if (velocity.report.ok()) answer["U"] = U_json(velocity);
  put_number(answer, "determinant", velocity.determinant);
  answer["indices"] = to_json(velocity.indices);
  answer["type_1"] = std::vector<int>(velocity.type_1().begin(), velocity.type_1().end());
  answer["type_2"] = type_two_json(velocity.type_2, Space::dimension == 2);
  answer["residual"] = velocity.report.residual;
  if (!twist.empty()) {
    if (velocity.type_1_count == 0)
      answer["rates"] = rates_json(velocity, twist);
    else if (velocity.report.ok()) {
      Report report;
      report.status = Status::singular;
      report.message.append("a leg at a type I singularity cannot follow a twist; see type_1");
      context.report(report);
    }
  }
  Json list = Json::array();
  for (std::size_t i = 0; i < legs.size(); ++i)
    list.push_back({{"angles", to_json(legs[i].of(robot.legs[i].chain))}});
  answer["legs"] = std::move(list);
}

template <class Space>
void answer_velocity_of(Context& context, ChainRobot<Space>& robot) {
  Reader& query = context.query;
  const AnyPose pose = read_pose(context, query.required("pose", "pose of the platform"));
  const Branch branch = read_branch(context);
  std::vector<double> twist;
  if (const auto asked = query.optional("twist"))
    twist = asked->quantities(Dimension::number, {}, static_cast<std::size_t>(Space::dof));
  const auto angles = query.optional("angles");
  std::vector<ChainLegState> legs;
  if (angles) legs = read_angles(*angles, robot);
  if (angles && !branch.is_default())
    query.fail("ambiguous", "bending, curvature and elbow choose among solutions; the angles are given");
  if (!context.ready()) return;
  if (!angles) {
    const Arcs arcs = arcs_at(context, pose, branch);
    if (!arcs.report.ok()) return context.report(arcs.report);
    aim_bases(robot, arcs);
    ChainState<Space> state;
    const Report report = rest(robot, std::get<typename Space::Pose>(pose), arcs.curvature, false, state);
    if (!report.ok()) return context.report(report);
    legs = state.legs;
  }
  const auto velocity = chain_velocity(robot, std::get<typename Space::Pose>(pose), legs);
  if (!(velocity.rates.closure_error <= 1e-9))
    return query.fail("not_closed",
                      fmt::format("pose and angles contradict each other: a leg misses by {:.3g} "
                                  "m; leave the angles out to have them solved",
                                  velocity.rates.closure_error));
  context.answer["pose"] = to_json(pose);
  put_velocity(context, robot, velocity, legs, twist);
}

}  // namespace

void answer_chains_velocity(Context& context) {
  auto robot = read_robot(context, read_law(context));
  if (robot) std::visit([&](auto& chains) { answer_velocity_of(context, chains); }, *robot);
}

}  // namespace sinew::inline v0
