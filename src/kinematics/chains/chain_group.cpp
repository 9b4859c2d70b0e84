#include "kinematics/chains/chain_group.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::inline v1 {

template <class Space>
void ChainGroup<Space>::set_robot(const ChainLegs<Space>& robot, bool is_evenly_bent) {
  robot_ = &robot;
  is_evenly_bent_ = is_evenly_bent;
  size_ = unit_ = 0;
  for (const auto& leg : robot.legs) {
    size_ = std::max(size_, leg.chain.length);
    unit_ = std::max(unit_, leg.bending_stiffness / std::pow(leg.chain.length, 3));
  }
  systems_.resize(robot.legs.size());
  factors_.resize(robot.legs.size());
}

template <class Space>
void ChainGroup<Space>::set_state(const State& state) {
  state_ = state;
  platform_ = Space::frame(state_.pose);
}

template <class Space>
void ChainGroup<Space>::hold_leg(std::size_t leg, const TendonConstraint& hold) {
  state_.hold[leg] = hold;
  for (std::size_t k = 0; k < 2; ++k)
    if (hold.length_of != static_cast<int>(k)) state_.legs[leg].tension[k] = hold.tension[k];
}

template <class Space>
void ChainGroup<Space>::measure() {
  for (std::size_t i = 0; i < state_.legs.size(); ++i) measure_tendons(robot_->legs[i], state_.legs[i]);
}

template <class Space>
const LimbTraits& ChainGroup<Space>::traits() const {
  static constexpr LimbTraits traits{.tolerance = 1e-11, .rounding = 1e-14};
  return traits;
}

template <class Space>
double ChainGroup<Space>::held(int feed) const {
  const TendonConstraint& hold = state_.hold[at(feed)];
  return hold.length_of >= 0 ? hold.length : effort(feed);
}

template <class Space>
void ChainGroup<Space>::set_feed(int feed, double value) {
  TendonConstraint& hold = state_.hold[at(feed)];
  const std::size_t fed = fed_tendon(leg(feed), state_.legs[at(feed)], hold);
  if (hold.length_of >= 0)
    hold.length = value;
  else
    hold.tension[fed] = state_.legs[at(feed)].tension[fed] = value;
}

template <class Space>
void ChainGroup<Space>::save(LimbState& to) const {
  to.clear();
  to.put(state_.pose);
  to.put(state_.wrench);
  to.put(std::span<const ChainLegState>(state_.legs));
  to.put(std::span<const TendonConstraint>(state_.hold));
}

template <class Space>
void ChainGroup<Space>::restore(const LimbState& from) {
  LimbState::Reader reader(from);
  reader.get(state_.pose);
  reader.get(state_.wrench);
  reader.get(std::span<ChainLegState>(state_.legs));
  reader.get(std::span<TendonConstraint>(state_.hold));
  platform_ = Space::frame(state_.pose);
}

template <class Space>
double ChainGroup<Space>::error_of(const ChainLeg<Space>& leg, const LegSystem<Space>& system) const {
  double error = worse(worse(0, system.closure.c / size_), system.length_error / size_), even = 0;
  for (int joint = 0; joint < system.joints; ++joint) {
    const double balance = system.balance[at(joint)];
    even += even_bend(leg.chain, joint) * balance;
    if (!is_evenly_bent_) error = worse(error, balance / leg.spring(joint));
  }
  return is_evenly_bent_ ? worse(error, even / leg.spring(0)) : error;
}

template <class Space>
double ChainGroup<Space>::evaluate(bool) {
  balance_ = state_.wrench;
  limb_error_ = 0;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const auto& leg = robot_->legs[i];
    form(leg, platform_, state_.legs[i], state_.hold[i], systems_[i]);
    balance_ -= systems_[i].force * systems_[i].closure.c_x;
    limb_error_ = worse(limb_error_, error_of(leg, systems_[i]));
  }
  error_ = limb_error_;
  for (int k = 0; k < dof; ++k)
    error_ = worse(error_, balance_[k] / unit_ / (k < Space::dimension ? size_ : size_ * size_));
  return error_;
}

template <class Space>
bool ChainGroup<Space>::linearise() {
  stiffness_.setZero();
  residual_ = balance_;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const LegSystem<Space>& system = systems_[i];
    LegFactors<Space>& factors = factors_[i];
    factors.factor(robot_->legs[i].chain, system, is_evenly_bent_);
    residual_ -= factors.push(system, factors.own);
    for (std::size_t k = 0; k < dof; ++k)
      stiffness_.col(static_cast<Eigen::Index>(k)) += factors.push(system, factors.platform + k);
    stiffness_ += system.force * system.closure.c_xx;
  }
  return lu_.factor(stiffness_.data(), size_);
}

template <class Space>
auto ChainGroup<Space>::step(bool fresh) -> Twist {
  if (!fresh) linearise();
  Twist twist;
  lu_.solve(residual_.data(), twist.data());
  return twist;
}

template <class Space>
double ChainGroup<Space>::plan(const Twist& twist, Numbers by_input) {
  planned_ = twist;
  planned_turn_ = 0;
  for (std::size_t i = 0; i < factors_.size(); ++i)
    planned_turn_ = worse(planned_turn_,
                          factors_[i].plan(robot_->legs[i].chain, twist, by_input.empty() ? 0 : by_input[i]));
  double size = planned_turn_;
  for (int k = 0; k < dof; ++k) size = worse(size, k < Space::dimension ? twist[k] / size_ : twist[k]);
  return size;
}

template <class Space>
void ChainGroup<Space>::move_as_planned() {
  for (std::size_t i = 0; i < factors_.size(); ++i)
    factors_[i].move(robot_->legs[i].chain, state_.legs[i], systems_[i].fed);
  turned_ += planned_turn_;
  if (planned_.isZero(0)) return;
  state_.pose = Space::moved(state_.pose, planned_);
  platform_ = Space::frame(state_.pose);
}

template <class Space>
void ChainGroup<Space>::move(const Twist& twist, Numbers by_input) {
  plan(twist, by_input);
  move_as_planned();
}

template <class Space>
auto ChainGroup<Space>::input_wrench_jacobian(int input) const -> Wrench {
  return factors_[at(input)].push(systems_[at(input)], LegFactors<Space>::feed);
}

template <class Space>
std::array<int, 2> ChainGroup<Space>::unstable_with_tip_held(int limb) const {
  return {factors_[at(limb)].unstable(), 0};
}

template <class Space>
double ChainGroup<Space>::energy() const {
  double sum = 0;
  for (int i = 0; i < limbs(); ++i)
    for (int j = 0; j < leg(i).chain.joints(); ++j) {
      const double angle = state_.legs[at(i)].angles[at(j)];
      sum += 0.5 * leg(i).spring(j) * angle * angle;
    }
  return sum;
}

template <class Space>
double ChainGroup<Space>::margin() const {
  double least = std::numeric_limits<double>::infinity();
  for (const ChainLegState& leg : state_.legs) least = std::min({least, leg.tension[0], leg.tension[1]});
  return least + slack_tolerance;
}

template <class Space>
double ChainGroup<Space>::effort(int feed) const {
  return state_.legs[at(feed)].tension[systems_[at(feed)].fed];
}

template <class Space>
double ChainGroup<Space>::closing_effort(int feed) const {
  return effort(feed) + factors_[at(feed)].tension_by(LegFactors<Space>::own);
}

template <class Space>
auto ChainGroup<Space>::effort_jacobian(int feed) const -> Twist {
  Twist row;
  for (int k = 0; k < dof; ++k)
    row[k] = factors_[at(feed)].tension_by(LegFactors<Space>::platform + static_cast<std::size_t>(k));
  return row;
}

template <class Space>
auto ChainGroup<Space>::hold_wrench_jacobian(std::size_t leg, const TendonConstraint& rate) const -> Wrench {
  const ChainLeg<Space>& own = robot_->legs[leg];
  LegSystem<Space> change = systems_[leg];  // a unit change as the leg's only imbalance
  change.closure.c = 0;
  change.length_error = change.holds_length ? -rate.length : 0;
  for (int j = 0; j < change.joints; ++j) {
    double& balance = change.balance[at(j)] = 0;
    for (int k = 0; k < 2; ++k)
      if (!change.holds_length || static_cast<int>(change.fed) != k)
        balance +=
            rate.tension[at(k)] *
            own.chain.tendon_bend(j, state_.legs[leg].angles[at(j)], own.tendon_offset, k == 0 ? 1 : -1).rate;
  }
  LegFactors<Space> factors;
  factors.factor(own.chain, change, is_evenly_bent_);
  return factors.push(change, factors.own);
}

template <class Space>
double ChainGroup<Space>::relief(int leg) const {
  const LegFactors<Space>& factors = factors_[at(leg)];
  return -(systems_[at(leg)].force + factors.force_by(factors.own)) / factors.force_by(factors.feed);
}

template class ChainGroup<Planar>;
template class ChainGroup<Spatial>;

}  // namespace sinew::inline v1
