/// @file arm_lanes.hpp
/// Equilibria of one arm for many rows of tensions and forces at its tip, eight rows in the lanes of vector
/// registers. Each row climbs the ladder of resolutions by itself: rows that are to be solved with the same
/// polynomials share lanes, whatever their order. No row's answer depends on its neighbours, and one that
/// Newton's steps alone do not solve is solved as `arm_forward` does, from its start. Theory:
/// docs/theory/strain_rod.md
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

class ArmLanes {
 public:
  /// What a row asks; false: nothing that can be solved.
  using Ask = std::function<bool(std::size_t row, std::span<TendonCommand> commands, ArmLoad& load)>;
  /// What it is told, once it is solved; rows come in any order. No state: it asked nothing.
  using Tell = std::function<void(std::size_t row, const ArmState* state)>;

  /// Whether lanes can solve arms by these options where tensions are held.
  static bool fits(const Arm& arm, const ArmOptions& options);

  ArmLanes(const Arm& arm, const ArmOptions& options);
  ~ArmLanes();
  ArmLanes(const ArmLanes&) = delete;
  ArmLanes& operator=(const ArmLanes&) = delete;

  /// @param stretch rows of which each begins where the one before it ended, the first at the straight arm;
  /// 1: all begin there
  void solve(std::size_t rows, std::size_t stretch, const Ask& ask, const Tell& tell, StopToken stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::inline v1
