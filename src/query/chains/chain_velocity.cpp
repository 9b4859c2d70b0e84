/// Handlers of velocity and track on pseudo-rigid chains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/chain_shape.hpp"
#include "io/reader.hpp"
#include "kinematics/chains/chain_motion.hpp"
#include "query/chains/chain_velocity.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace chains {
namespace {

template <class Space>
Value K_value(const ChainRates<Space>& rates) {
  Value rows = Value::list();
  const auto all = std::accumulate(rates.columns.begin(), rates.columns.end(), std::size_t{0});
  std::size_t first = 0;
  for (std::size_t i = 0; i < rates.legs(); ++i) {
    std::vector<double> row(all);
    std::copy_n(rates.K[i].begin(), rates.columns[i], row.begin() + static_cast<std::ptrdiff_t>(first));
    first += static_cast<std::size_t>(rates.columns[i]);
    rows.push_back(Value(row));
  }
  return rows;
}

template <class Space>
Value U_value(const ChainVelocity<Space>& velocity) {
  Value rows = Value::list();
  for (int k = 0; k < Space::dof; ++k) {
    std::vector<double> row;
    for (std::size_t i = 0; i < velocity.rates.legs(); ++i)
      for (std::size_t j = 0; j < static_cast<std::size_t>(velocity.rates.columns[i]); ++j)
        row.push_back(velocity.inverse(k, static_cast<Eigen::Index>(i)) * velocity.rates.K[i][j]);
    rows.push_back(Value(row));
  }
  return rows;
}

}  // namespace

template <class Space>
void put_velocity(Context& context, const ChainVelocity<Space>& velocity, std::span<const double> twist) {
  Value& answer = context.answer;
  context.add_report(velocity.report);
  const Eigen::Matrix<double, Eigen::Dynamic, Space::dof, Eigen::RowMajor> J = velocity.rates.J;
  answer["J"] = Value(MatrixView(J.data(), J.rows(), Space::dof));
  answer["K"] = K_value(velocity.rates);
  if (velocity.has_inverse) answer["U"] = U_value(velocity);
  put_number(answer, "determinant", velocity.determinant);
  answer["indices"] = indices_value(velocity.indices);
  answer["type_1"] = Value(velocity.type_1());
  answer["type_2"] = type_two_value(velocity.type_2, Space::dimension == 2);
  if (!twist.empty()) {
    if (velocity.type_1_count == 0)
      answer["rates"] = Value(least_norm_rates(velocity, Vec<double, Space::dof>(twist.data())));
    else if (velocity.report.ok()) {
      Report report;
      report.status = Status::singular;
      report.message.append("a leg at a type I singularity cannot follow a twist; see type_1");
      context.add_report(report);
    }
  }
}

template void put_velocity(Context&, const ChainVelocity<Planar>&, std::span<const double>);
template void put_velocity(Context&, const ChainVelocity<Spatial>&, std::span<const double>);

}  // namespace chains

namespace {

using namespace chains;

template <class Space>
Value legs_of(const ChainLegs<Space>& robot, std::span<const ChainLegState> legs) {
  Value list = Value::list();
  for (Value& angles : angles_value(robot, legs)) list.push_back({{"angles", std::move(angles)}});
  return list;
}

template <class Space>
struct ChainMotion {
  AnyPose pose;
  Joints<Space> joints;
  Wants wanted;
  std::vector<double> twist;

  static ChainMotion read(ChainContext<Space>& context);
  static void answer(ChainContext<Space>& context, const ChainMotion& asked);
};

template <class Space>
ChainMotion<Space> ChainMotion<Space>::read(ChainContext<Space>& context) {
  const AnyPose pose = read_pose(context, context.query.required("pose", "pose of the platform"));
  Joints joints(context, context.chains, read_branch(context));
  const Wants wanted =
      read_wants(context, usual_of(context.ask), usual_wants | Wants{Want::velocity, Want::shape});
  return {pose, std::move(joints), wanted, read_twist<Space>(context, wanted)};
}

template <class Space>
void ChainMotion<Space>::answer(ChainContext<Space>& context, const ChainMotion& asked) {
  const auto& [pose, joints, wanted, twist] = asked;
  ChainLegs<Space>& robot = context.chains;
  std::vector<ChainLegState> legs;
  const Report report = joints.at(context, robot, pose, legs);
  if (!report.ok()) return context.report(report);
  const auto velocity = chain_velocity(robot, std::get<typename Space::Pose>(pose), legs);
  refuse_open_legs(context, velocity.rates.closure_error);
  if (!context.errors.empty()) return;
  context.report({});
  if (wanted.has(Want::pose)) context.answer["pose"] = pose_value(pose);
  put_velocity(context, velocity, twist);
  context.answer["residual"] = velocity.report.residual;
  if (wanted.has(Want::legs)) context.answer["legs"] = legs_of(robot, legs);
  if (!wanted.has(Want::shape)) return;
  put_shape(context.answer, chain_shape(robot, std::get<typename Space::Pose>(pose), legs));
  context.answer["frames"] = Value::list({pose_value(pose)});
}

template <class Space>
Value row_value(const ChainLegs<Space>& robot, const AnyPose& pose, std::span<const ChainLegState> legs) {
  const auto velocity = chain_velocity(robot, std::get<typename Space::Pose>(pose), legs);
  Value row{{"pose", pose_value(pose)},
            {"angles", angles_value(robot, legs)},
            {"closure_error", velocity.rates.closure_error},
            {"indices", indices_value(velocity.indices)}};
  if (velocity.type_1_count > 0) row["type_1"] = Value(velocity.type_1());
  if (velocity.type_2.singular) row["singular"] = true;
  return row;
}

/// Whether a track leads to a load, or to what tendons hold, and to no pose.
bool is_curve(Reader& query) {
  const auto says = [](Reader& map, std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return map.has(key); });
  };
  auto to = query.optional("to");
  return says(query, {"set_at", "tensions", "lengths"}) ||
         (to && to->is(Node::Kind::map) && says(*to, {"wrench", "tensions", "lengths", "inputs"}));
}

template <class Space>
struct ChainPath {
  std::vector<AnyPose> poses;
  Joints<Space> joints;
  ChainMotionOptions options = {};

  static ChainPath read(ChainContext<Space>& context);
  static void answer(ChainContext<Space>& context, const ChainPath& asked);
};

template <class Space>
ChainPath<Space> ChainPath<Space>::read(ChainContext<Space>& context) {
  std::vector<AnyPose> poses = read_path(context);
  Joints joints(context, context.chains, read_branch(context));
  ChainPath asked{std::move(poses), std::move(joints)};
  asked.options.objective = read_objective(context.query);
  if (const auto steps = context.query.optional("rk4_steps"))
    asked.options.rk4_steps = steps->integer(Range::between(1, 1000));
  return asked;
}

template <class Space>
void ChainPath<Space>::answer(ChainContext<Space>& context, const ChainPath& asked) {
  const auto& [poses, joints, options] = asked;
  ChainLegs<Space>& robot = context.chains;
  std::vector<ChainLegState> legs;
  Report report = joints.at(context, robot, poses.front(), legs);
  Value rows = Value::list();
  double worst = 0;
  for (std::size_t k = 0; k < poses.size() && report.ok(); ++k) {
    const auto& pose = std::get<typename Space::Pose>(poses[k]);
    if (k > 0)
      report = follow_least_norm(robot, std::get<typename Space::Pose>(poses[k - 1]), pose, legs, options);
    if (!report.ok() || note_stop(context.work.stop, report)) break;
    rows.push_back(row_value(robot, poses[k], legs));
    worst = std::max(worst, rows.back()["closure_error"].number().value_or(0));
    if (k == 0 && !(worst <= 1e-9))
      return context.query.fail(
          "not_closed", fmt::format("the first pose and the angles contradict each other: a leg misses "
                                    "by {:.3g} m; leave the angles out to have them solved",
                                    worst));
  }
  context.report(report);
  if (!report.ok()) context.answer["reached"] = {{"rows", rows.size()}};
  context.answer["residual"] = worst;
  context.answer["rows"] = std::move(rows);
}

}  // namespace

void answer_chains_track(Context& context) {
  if (is_curve(context.query))
    answer_chains_curves(context);
  else
    handle_chains<ChainPath>(context);
}

void answer_chains_velocity(Context& context) { handle_chains<ChainMotion>(context); }

}  // namespace sinew::inline v1
