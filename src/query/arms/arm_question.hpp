/// @file arm_question.hpp
/// One configuration of an arm, or of a platform on arms, as a question gives it.
#pragma once
#include "query/arms/arms.hpp"

namespace sinew::inline v1 {

/// @tparam Arms Arm or ArmLegs
template <class Arms>
struct ArmQuestion : ArmContextOf<Arms> {
  using Types = ArmTypes<Arms>;
  using ArmContextOf<Arms>::ArmContextOf;
  using ArmContextOf<Arms>::robot, ArmContextOf<Arms>::work;
  using Question::answer, Question::ask, Question::query;

  /// @name What was read
  /// @{
  ArmInverseOptions options = {};
  std::vector<TendonCommand> commands = {};  ///< but of `inverse`
  typename Types::Load load = {};
  typename Types::Start start = {};
  std::optional<Until<Spatial>> until = {};
  bool wants_all = false;
  ArmTarget target = {};                      ///< of `inverse`
  typename Types::Measurement measured = {};  ///< of `statics`, with `force_alone`
  bool force_alone = true;
  /// Of `statics`: the platform is held there, and nothing is measured.
  std::optional<SE3<double>> held_at = {};
  Wants words = {};
  int samples = 0;  ///< of `shape`
  /// @}

  void read();
  void solve();
  void tell();
  void tell_all();

 private:
  void read_start();
  void read_shape();
  void read_measured();
  void read_seen(bool has_tensions);
  void solve_forward();
  void solve_statics();

  /// @name What was found
  /// @{
  Report found_ = {};  ///< of the question
  typename Types::State state_ = {};
  std::optional<typename Types::Growth> growth_ = {};
  std::optional<typename Types::Sensed> sensed_ = {};
  std::optional<std::array<double, 6>> holding_ = {};  ///< the wrench that holds the platform at `held_at`
  /// @}
};

}  // namespace sinew::inline v1
