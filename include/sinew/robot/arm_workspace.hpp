/// @file arm_workspace.hpp
/// Memory for questions to an arm; the equilibrium that the last one found stays in it.
#pragma once
#include <memory>

#include "sinew/base/export.hpp"
#include "sinew/base/stop.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// Memory for questions to one arm; one per thread.
class ArmWorkspace {
 public:
  /// For this arm and its copies.
  SINEW_API explicit ArmWorkspace(const Arm& arm);
  SINEW_API ~ArmWorkspace();
  SINEW_API ArmWorkspace(ArmWorkspace&&) noexcept;
  SINEW_API ArmWorkspace& operator=(ArmWorkspace&&) noexcept;

  StopToken stop;  ///< searches end with `stopped` once it is requested

  struct Impl;
  /// What solvers keep in it.
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::inline v1
