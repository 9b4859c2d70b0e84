/// @file tangent_system.hpp
/// Rods in space between a base and a platform as one system of equations: what Newton's method needs of a
/// robot whose rods are clamped at the platform, heavy, or stretch. ElasticaSystem is its fast special case.
/// Theory: docs/theory/tangent_rod.md
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "robot/rods/rod_group.hpp"
#include "robot/rods/rod_kernels.hpp"
#include "robot/rods/tangent_lanes.hpp"

namespace sinew::inline v1 {

/// All numbers of one robot's equilibrium. No function here allocates unless it says so.
class TangentSystem : public HeavyRodGroup {
 public:
  explicit TangentSystem(const ParallelRobot<RodLeg>& robot);  ///< allocates

  const LimbTraits& traits() const override;
  void save(LimbState& to) const override;
  void restore(const LimbState& from) override;

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
  double weight_energy() const override;
  int elements() const { return elements_; }
  bool is_fine() const override { return elements_ > coarse_elements; }
  bool is_finest() const override { return elements_ >= max_elements; }
  void refine() override;   ///< to more elements, the same shapes
  void coarsen() override;  ///< to fewer elements, the shapes interpolated
  bool can_coarsen(double truncation) const override;
  /// @}

  /// @name Newton's method
  /// @{
  double evaluate(bool from_scratch = true) override;
  double limb_error() const override { return sums_.rod_error; }
  bool linearise() override;
  Twist step(bool fresh) override;
  Wrench wrench_residual() const override;
  void move(const Twist& twist, Numbers fed = {}) override;
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
  /// The second number is 0.
  std::array<int, 2> unstable_with_tip_held(int index) const override;
  double truncation() const override;
  std::vector<Vec3<double>> centreline(int index, int samples) const override;
  void get_rod(int index, std::span<double> coordinates) const override;
  /// On the elements that coordinates are of.
  void set_rods(Numbers coordinates) override;
  /// @}

  /// @name To lay rods to a pose
  /// @{

  /// Every rod as the cubic between its guide and where the platform holds it, with the force and the length
  /// that go with it: not in equilibrium, a start of Newton's method. False where a tip lies on its base.
  bool draw_rods();
  /// After `linearise`: a step of the rods alone, the platform held, each fed until nothing pulls along the
  /// line from base to tip. By at most `most` of its length.
  void move_to_rest(double most);
  /// @}

  static constexpr int coarse_elements = 2, coordinate_elements = (rod_tangents - 1) / TangentState::degree;

 private:
  template <class Use>
  decltype(auto) with_rod(int rod, Use&& use) const {
    return use(groups_[static_cast<std::size_t>(rod / rod_lanes)], rod % rod_lanes);
  }
  void fill_idle_lanes();
  void weigh(int rod, const Vec3<double>& weight) override;
  Vec3<double> lever(const TangentRods& rods, int lane) const;
  void change_elements(int elements);
  Vec3<double> tangent_at(const RodLane (*tangents)[3], int lane, double along) const;

  std::vector<TangentRods> groups_;
  std::vector<RodFeed> fed_;
  int elements_ = coarse_elements;
  RodPlatform held_{};
  RodSums sums_{};
};

}  // namespace sinew::inline v1
