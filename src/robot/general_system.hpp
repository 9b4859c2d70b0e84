/// @file general_system.hpp
/// Rods that bear torque between a base and a platform as one system of equations: held against
/// axial rotation at both ends, of a section that is not round, or bent when free. Each is shot from its
/// base, and its six unknowns are eliminated in the same step. TangentSystem is the fast special case without
/// torque. Theory: docs/theory/spatial_rod.md
#pragma once
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "link/rod_bvp.hpp"
#include "robot/rod_group.hpp"

namespace sinew::inline v1 {

/// The rod as one that can bear torque. Where its material has no shear modulus nothing may depend on it.
SpatialRod spatial_rod(const Rod& rod);

/// One rod with all numbers of its Newton step. Its unknowns are dimensionless: force in EI/L², moment in
/// EI/L about the section's axes at axial rotation 0, where the last is the axial rotation instead if that is
/// free and matters.
struct GeneralRod {
  using Matrix = Mat<double, 6, 6>;

  /// @name What Newton's method moves, and what a path is resumed from: base axes
  /// @{
  Vec3<double> force = Vec3<double>::Zero();   ///< internal, at the base [N]
  Vec3<double> moment = Vec3<double>::Zero();  ///< [N m]
  double axial_rotation = 0;                   ///< of the section in its guide [rad]
  double length = 1;                           ///< L, unstretched [m]
  /// @}

  /// @name What it is
  /// @{
  SpatialRod rod;     ///< its load is weight and own load
  SE3<double> frame;  ///< of the section at the base, at axial rotation 0
  RodEnds ends;
  bool seeks_axial_rotation = false;
  Vec3<double> platform_point;
  SO3<double> platform_section;  ///< of the section at a clamp, platform axes
  double stiffness = 0;          ///< EI, the geometric mean of both ways [N m²]
  Vec2<double> reach{0, 0};      ///< of a strip from its x and y axes: half its height and width [m]
  /// @}

  /// @name At the last evaluation
  /// @{
  RodState<double> from, tip;
  double energy = 0, potential = 0;  ///< elastic; of the load, −∫f·(p − p(0)) ds [J]
  Vec3<double> arm;                  ///< platform point from the reference point, base axes [m]
  Vec<double, 6> gap;                ///< see TipGaps
  /// @}

  /// @name Kept from the last linearisation
  /// @{
  double force_unit = 0, moment_unit = 0;
  bool is_regular = false;     ///< the gap determines the unknowns; else the rest are no numbers
  SmallLu<6> factors;          ///< of the gap by the unknowns
  Matrix by_twist;             ///< the unknowns by the platform's twist, the gap held
  Vec<double, 6> by_length;    ///< ... by the length
  Matrix tip_wrench_jacobian;  ///< force and moment on the tip by the unknowns; of a ball no moment
  Vec<double, 6> feed;         ///< ... by the length, the gap held
  Vec<double, 6> fix;          ///< of the unknowns: closes the gap at a resting platform
  /// @}
};

/// All numbers of one robot's equilibrium. No function here allocates unless it says so.
class GeneralSystem : public HeavyRodGroup {
 public:
  explicit GeneralSystem(const ParallelRobot<RodLeg>& robot);  ///< allocates

  const LimbTraits& traits() const override;
  void save(LimbState& to) const override;
  void restore(const LimbState& from) override;

  /// @name What is held
  /// @{
  Vec3<double> base(int rod) const override { return at(rod).frame.p; }
  Vec3<double> platform_point(int rod) const override { return at(rod).platform_point; }
  double stiffness(int rod) const override { return at(rod).stiffness; }  ///< the mean of both ways
  double length(int rod) const override { return at(rod).length; }
  void hold(int rod, double length) override { at(rod).length = length; }
  void set_inputs(Numbers inputs) override;
  Wrench wrench() const final { return wrench_; }
  void set_wrench(const Wrench& wrench) final { wrench_ = wrench; }
  double weight_energy() const override;
  int elements() const { return elements_; }  ///< even steps of the integration along each rod
  bool is_fine() const override { return elements_ > coarse_elements; }
  bool is_finest() const override { return elements_ >= max_elements; }
  void refine() override { elements_ = is_finest() ? elements_ : 2 * elements_; }
  void coarsen() override { elements_ = is_fine() ? elements_ / 2 : elements_; }
  bool can_coarsen(double truncation) const override;
  /// @}

  /// @name Newton's method
  /// @{
  double evaluate(bool from_scratch = true) override;
  double limb_error() const override { return rod_error_; }
  bool linearise() override;
  Twist step(bool fresh) override;
  Wrench wrench_residual() const override { return wrench_ - sum_; }
  void move(const Twist& twist, Numbers fed = {}) override;
  MatrixView stiffness() const override { return {stiffness_.data(), 6, 6}; }
  Wrench input_wrench_jacobian(int input) const override;
  bool rest_at(const SE3<double>& platform) override;
  /// @}

  /// @name Single rods, after `evaluate`
  /// @{
  /// Curvatures of a section: about its x and y, twist about its tangent; the largest is that of bending,
  /// beyond the rod's own at rest.
  RodResult rod(int index) const override;
  double effort(int rod) const override;
  double closing_effort(int rod) const override;
  Twist effort_jacobian(int rod) const override;
  /// The second number is 0.
  std::array<int, 2> unstable_with_tip_held(int index) const override;
  /// Estimated error of the integration, of the length and in rad: the worst rod's.
  double truncation() const override;
  std::vector<Vec3<double>> centreline(int index, int samples) const override;
  void get_rod(int index, std::span<double> coordinates) const override;
  /// With the finest steps.
  void set_rods(Numbers coordinates) override;
  /// @}

  /// @name To lay rods to a pose
  /// @{

  /// Every rod between its guide and where the platform holds it, as long as the cubic between them: each in
  /// equilibrium, if possible a stable one. False where that is not found. Expensive.
  bool draw_rods();
  /// After `linearise`: a step of the rods alone, the platform held, each fed until nothing pulls along the
  /// line from base to tip. By at most `most` of its length; returns the largest part of a length fed.
  double move_to_rest(double most);
  /// @}

  static constexpr int coarse_elements = 8, max_elements = 128;

 private:
  GeneralRod& at(int rod) { return all_[static_cast<std::size_t>(rod)]; }
  const GeneralRod& at(int rod) const { return all_[static_cast<std::size_t>(rod)]; }
  void weigh(int rod, const Vec3<double>& weight) override { at(rod).rod.load = weight; }
  /// State as numbers: force, moment, axial rotation, length.
  static constexpr std::size_t rod_numbers = 8;
  static void set_rod(GeneralRod& rod, Numbers numbers);
  void sum_closed();
  static void move_rod(GeneralRod& rod, const Vec<double, 6>& by, double fed);

  std::vector<GeneralRod> all_;
  int elements_ = coarse_elements;
  Wrench wrench_ = Wrench::Zero(), sum_ = Wrench::Zero();
  double rod_error_ = 0;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> stiffness_ = Mat<double, 6, 6>::Zero();
};

}  // namespace sinew::inline v1
