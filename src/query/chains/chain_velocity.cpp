/// `velocity` of pseudo-rigid chains, and `track` along poses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/chain_shape.hpp"
#include "io/document/reader.hpp"
#include "kinematics/chains/chain_motion.hpp"
#include "query/chains/chain_velocity.hpp"
#include "query/chains/chains.hpp"
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
struct ChainMotion : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;
  using Question::answer;

  void read();
  void tell();

 private:
  AnyPose pose_ = {};
  Joints<Space> joints_ = {};
  Wants wanted_ = {};
  std::vector<double> twist_ = {};
};

template <class Space>
void ChainMotion<Space>::read() {
  pose_ = read_pose(*this, this->query.required("pose", "pose of the platform"));
  joints_ = read_joints(*this, chains, read_branch(*this));
  wanted_ = read_wants(*this, usual_of(this->ask), usual_wants | Wants{Want::velocity, Want::shape});
  twist_ = read_twist<Space>(*this, wanted_);
}

template <class Space>
void ChainMotion<Space>::tell() {
  std::vector<ChainLegState> legs;
  if (const Report found = joints_.at(*this, chains, pose_, legs); !found.ok()) return this->report(found);
  const auto& pose = std::get<typename Space::Pose>(pose_);
  const auto velocity = chain_velocity(chains, pose, legs);
  refuse_open_legs(*this, velocity.rates.closure_error);
  if (!this->errors.empty()) return;
  this->report({});
  if (wanted_.has(Want::pose)) answer["pose"] = pose_value(pose_);
  put_velocity(*this, velocity, twist_);
  answer["residual"] = velocity.report.residual;
  if (wanted_.has(Want::legs)) answer["legs"] = legs_of(chains, legs);
  if (!wanted_.has(Want::shape)) return;
  put_shape(answer, chain_shape(chains, pose, legs));
  answer["frames"] = Value::list({pose_value(pose_)});
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
struct ChainPath : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;
  using Question::query, Question::answer;

  void read();
  void tell();

 private:
  std::vector<AnyPose> poses_ = {};
  Joints<Space> joints_ = {};
  ChainMotionOptions options_ = {};
};

template <class Space>
void ChainPath<Space>::read() {
  poses_ = read_path(*this);
  joints_ = read_joints(*this, chains, read_branch(*this));
  options_.objective = read_objective(query);
  if (const auto steps = query.optional("rk4_steps"))
    options_.rk4_steps = steps->integer(Range::between(1, 1000));
}

template <class Space>
void ChainPath<Space>::tell() {
  std::vector<ChainLegState> legs;
  Report found = joints_.at(*this, chains, poses_.front(), legs);
  Value rows = Value::list();
  double worst = 0;
  for (std::size_t k = 0; k < poses_.size() && found.ok(); ++k) {
    const auto& pose = std::get<typename Space::Pose>(poses_[k]);
    if (k > 0)
      found = follow_least_norm(chains, std::get<typename Space::Pose>(poses_[k - 1]), pose, legs, options_);
    if (!found.ok() || note_stop(this->work.stop, found)) break;
    rows.push_back(row_value(chains, poses_[k], legs));
    worst = std::max(worst, rows.back()["closure_error"].number().value_or(0));
    if (k == 0 && !(worst <= 1e-9))
      return query.fail("not_closed",
                        fmt::format("the first pose and the angles contradict each other: a leg misses "
                                    "by {:.3g} m; leave the angles out to have them solved",
                                    worst));
  }
  this->report(found);
  if (!found.ok()) answer["reached"] = {{"rows", rows.size()}};
  answer["residual"] = worst;
  answer["rows"] = std::move(rows);
}

}  // namespace

void answer_chains_track(Context& context) {
  if (is_curve(context.query))
    answer_chains_curves(context);
  else
    answer_chains<ChainPath>(context);
}

void answer_chains_velocity(Context& context) { answer_chains<ChainMotion>(context); }

}  // namespace sinew::inline v1
