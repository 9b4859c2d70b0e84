/// @file elastica_system.hpp
/// Rods between a base and a platform as one system of equations: what Newton's method needs of a robot whose
/// legs bear load. The rods' own unknowns are eliminated in the same step, never solved at a fixed platform.
/// Theory: docs/theory/rod_robot.md
#pragma once
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "robot/rods/rod_group.hpp"
#include "robot/rods/rod_kernels.hpp"

namespace sinew::inline v1 {

/// All numbers of one robot's equilibrium. No function here allocates unless it says so.
class ElasticaSystem : public RodGroup {
 public:
  explicit ElasticaSystem(const ParallelRobot<RodLeg>& robot);  ///< allocates

  const LimbTraits& traits() const override;
  void save(LimbState& to) const override;
  void restore(const LimbState& from) override;
  ElasticaSystem* elastica() final { return this; }

  /// @name What is held
  /// @{
  Vec3<double> base(int rod) const override;
  Vec3<double> platform_point(int rod) const override;
  double stiffness(int rod) const override;
  double length(int rod) const override;
  void set_feed(int rod, double length) override;
  void set_inputs(Numbers inputs) override;
  Wrench wrench() const final { return Eigen::Map<const Wrench>(held_.wrench); }
  void set_wrench(const Wrench& wrench) final { Eigen::Map<Wrench>(held_.wrench) = wrench; }
  bool is_fine() const override { return is_fine_; }
  bool is_finest() const override { return is_fine_; }
  void refine() override;                                       ///< to the fine nodes, the same shapes
  void coarsen() override;                                      ///< to the coarse nodes, interpolated
  bool can_coarsen(double) const override { return is_fine_; }  ///< whether it is worth a try
  /// @}

  /// @name Newton's method
  /// @{

  /// Largest of closure error over length, of force error over EI/L² and moment error over EI/L, and of the
  /// rods' own equations. Not `from_scratch` rounds once more a step; after some dozens of steps it is from
  /// scratch all the same.
  double evaluate(bool from_scratch = true) override;
  double limb_error() const override { return sums_.rod_error; }
  bool linearise() override;
  Twist step(bool fresh) override;
  Wrench wrench_residual() const override;
  void move(const Twist& twist, Numbers fed = {}) override;
  const SmallLu<6>& factors() const override;
  MatrixView stiffness() const override { return {sums_.stiffness, 6, 6}; }
  Wrench input_wrench_jacobian(int input) const override;
  bool rest_at(const SE3<double>& platform) override;
  /// @}

  /// @name Single rods, after `evaluate`
  /// @{

  RodResult rod(int index) const override;
  double effort(int rod) const override;
  double closing_effort(int rod) const override;
  Twist effort_jacobian(int rod) const override;
  /// In the rod's plane and out of it.
  std::array<int, 2> unstable_with_tip_held(int index) const override;
  double truncation() const override;
  std::vector<Vec3<double>> centreline(int index, int samples) const override;

  /// On the side the tip lies ...
  void get_rod(int index, std::span<double> coordinates) const override;
  /// ... the same back, with the lateral direction it bends to; refines first ...
  void set_rod(int index, std::span<const double> coordinates, const Vec3<double>& lateral);
  /// ... and that of all rods, each towards its tip.
  void set_rods(Numbers coordinates) override;

  /// Where the platform holds the tip: lateral and axial distance, lateral direction, and EI. Needs no
  /// evaluation.
  struct Aim {
    double d, w;
    Vec3<double> lateral;
    double stiffness;
  };
  Aim aim(int index) const;
  /// Geometry and coarse state of a rod to a lane of a group of the same rod, and a state from there.
  void copy_rod(int index, CoarseRods& to, int lane) const;
  void take_rod(int index, const CoarseRods::State& from, int lane);
  /// A coarse state from its parts.
  void set_shape(int index, double length, std::span<const double> theta, double force_d, double force_w,
                 const Vec3<double>& lateral);
  /// @}

 private:
  template <class Use>
  decltype(auto) with(Use&& use) {
    return is_fine_ ? use(std::span<FineRods>(fine_)) : use(std::span<CoarseRods>(coarse_));
  }
  template <class Use>
  decltype(auto) with(Use&& use) const {
    return is_fine_ ? use(std::span<const FineRods>(fine_)) : use(std::span<const CoarseRods>(coarse_));
  }
  /// Calls `use(group, lane)` for the one or the other kind of group.
  template <class Use>
  decltype(auto) with_rod(int rod, Use&& use) const {
    return with([&](const auto& groups) -> decltype(auto) {
      return use(groups[static_cast<std::size_t>(rod / rod_lanes)], rod % rod_lanes);
    });
  }
  template <class Group>
  void fill_idle_lanes(Group& last) const;

  std::vector<CoarseRods> coarse_;
  std::vector<FineRods> fine_;
  std::vector<RodFeed> fed_;
  bool is_fine_ = false;
  int carried_ = 0;  ///< steps since the last evaluation from scratch
  RodPlatform held_{};
  RodSums sums_{};
  bool has_inverse_ = false;  ///< in `held_`; else there are factors
  mutable SmallLu<6> lu_;
};

}  // namespace sinew::inline v1
