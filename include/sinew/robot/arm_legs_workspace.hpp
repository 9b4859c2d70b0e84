/// @file arm_legs_workspace.hpp
/// Memory for questions to a platform on arms; the equilibrium that the last one found stays in it.
#pragma once
#include <memory>

#include "sinew/base/export.hpp"
#include "sinew/base/stop.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

/// Memory for questions to one platform on arms; the equilibrium that the last one found stays in it. One per
/// thread.
class ArmLegsWorkspace {
 public:
  /// For this robot and its copies.
  SINEW_API explicit ArmLegsWorkspace(const ArmLegs& robot);
  SINEW_API ~ArmLegsWorkspace();
  SINEW_API ArmLegsWorkspace(ArmLegsWorkspace&&) noexcept;
  SINEW_API ArmLegsWorkspace& operator=(ArmLegsWorkspace&&) noexcept;

  StopToken stop;  ///< searches end with `stopped` once it is requested

  struct Impl;
  /// What solvers keep in it.
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::inline v1
