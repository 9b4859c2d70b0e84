/// @file chain_group.hpp
/// Pseudo-rigid chains between a base and a platform as one group of limbs. Theory:
/// docs/theory/chain_equilibrium.md
#pragma once
#include <vector>

#include "kinematics/chains/leg_factors.hpp"
#include "robot/limbs/limb_group.hpp"

namespace sinew::inline v1 {

/// The feed of a leg is the tendon whose length is held, or else the tension of its inner tendon.
template <class Space>
class ChainGroup final : public LimbGroup<Space> {
 public:
  using Base = LimbGroup<Space>;
  using Base::dof;
  using typename Base::Frame, typename Base::Twist, typename Base::Wrench;
  using State = ChainState<Space>;

  /// Of this robot from now on, which has to last as long. Allocates for more legs than before.
  void set_robot(const ChainLegs<Space>& robot, bool is_evenly_bent);
  const State& state() const { return state_; }
  void set_state(const State& state);  ///< of that robot
  /// Tensions that are held are those of the tendons from now on.
  void hold_leg(std::size_t leg, const TendonConstraint& hold);
  void measure();  ///< lengths of tendons, into the state

  const LimbTraits& traits() const override;
  int limbs() const override { return static_cast<int>(robot_->legs.size()); }
  int inputs() const override { return limbs(); }
  double length(int limb) const override { return leg(limb).chain.length; }
  double stiffness(int limb) const override { return leg(limb).bending_stiffness; }
  double radius() const override { return size_; }  ///< the longest chain

  int feeds() const override { return limbs(); }
  int input_of(int feed) const override { return feed; }
  double held(int feed) const override;
  void set_feed(int feed, double value) override;

  const Frame& platform() const override { return platform_; }
  Wrench wrench() const override { return state_.wrench; }
  void set_wrench(const Wrench& wrench) override { state_.wrench = wrench; }
  void save(LimbState& to) const override;
  void restore(const LimbState& from) override;

  /// Over the longest chain: closures, lengths that are held, what is left of joints' moments as angles, and
  /// of the platform's forces over EI/ℓ³.
  double evaluate(bool from_scratch = true) override;
  double error() const { return error_; }  ///< of the last evaluation
  double limb_error() const override { return limb_error_; }
  bool linearise() override;
  /// Factors are always new: what keeps a step near is that it is short.
  Twist step(bool fresh) override;
  Wrench wrench_residual() const override { return residual_; }
  void move(const Twist& twist, Numbers by_input = {}) override;
  const SmallLu<dof>& factors() const override { return lu_; }
  MatrixView stiffness() const override { return {stiffness_.data(), dof, dof}; }
  Wrench input_wrench_jacobian(int input) const override;

  std::array<int, 2> unstable_with_tip_held(int limb) const override;
  double energy() const override;
  double margin() const override;  ///< the least tension, as a tendon only pulls

  double effort(int feed) const override;
  double closing_effort(int feed) const override;
  Twist effort_jacobian(int feed) const override;

  const LegSystem<Space>& system(std::size_t leg) const { return systems_[leg]; }
  /// ∂(wrench needed)/∂ of all that a leg holds, along `rate`; the platform held.
  Wrench hold_wrench_jacobian(std::size_t leg, const TendonConstraint& rate) const;
  /// The change of a leg's feed that leaves the platform without the leg's force.
  double relief(int leg) const;
  /// A step that is only planned: its size, of the platform over the longest chain, turns in rad; and that
  /// step.
  double plan(const Twist& twist, Numbers by_input = {});
  void move_as_planned();
  /// The largest turns of a joint in the moves since `restart`, added up [rad].
  double turned() const { return turned_; }
  void restart() { turned_ = 0; }

 private:
  static std::size_t at(int leg) { return static_cast<std::size_t>(leg); }
  const ChainLeg<Space>& leg(int limb) const { return robot_->legs[at(limb)]; }
  double error_of(const ChainLeg<Space>& leg, const LegSystem<Space>& system) const;

  const ChainLegs<Space>* robot_ = nullptr;
  bool is_evenly_bent_ = false;
  State state_;
  Frame platform_;
  std::vector<LegSystem<Space>> systems_;
  std::vector<LegFactors<Space>> factors_;
  Wrench balance_ = Wrench::Zero(), residual_ = Wrench::Zero();  ///< what is missing; once legs have moved
  Eigen::Matrix<double, dof, dof, Eigen::RowMajor> stiffness_;
  SmallLu<dof> lu_;
  double size_ = 0, unit_ = 0;  ///< of the longest chain [m]; the largest EI/ℓ³ [N/m]
  double error_ = 0, limb_error_ = 0, turned_ = 0, planned_turn_ = 0;
  Twist planned_ = Twist::Zero();
};

}  // namespace sinew::inline v1
