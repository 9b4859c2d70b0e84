/// @file general_system.hpp
/// Rods that bear torque between a base and a platform as one system of equations: held against axial
/// rotation at both ends, of a section that is not round, or bent when free. Each is a field of frames on
/// spectral elements. TangentSystem is the fast special case without torque. Theory:
/// docs/theory/spatial_rod.md
#pragma once
#include <array>
#include <span>
#include <vector>

#include "link/spatial_rod.hpp"
#include "robot/rods/frame_lanes.hpp"
#include "robot/rods/rod_group.hpp"

namespace sinew::inline v1 {

/// The rod as one that can bear torque. Where its material has no shear modulus nothing may depend on it.
SpatialRod spatial_rod(const Rod& rod);

/// One rod at its ends. Its unknowns are what the tip is free to turn, in the section's axes, and the tip's
/// force in EI/L²; the shape is eliminated onto them.
struct GeneralRod {
  using Square = Mat<double, 3, 3>;
  using Matrix = Mat<double, 6, 6>;
  using Vector = Vec<double, 6>;

  /// @name What it is
  /// @{
  SE3<double> frame;  ///< of the section at the base, at axial rotation 0
  RodEnds ends;
  SpatialRod rod;  ///< its load is weight and own load
  Vec3<double> platform_point;
  SO3<double> platform_section;  ///< of the section at a clamp, platform axes
  double stiffness = 0;          ///< EI, the geometric mean of both ways [N m²]
  Vec2<double> reach{0, 0};      ///< of a strip from its x and y axes: half its height and width [m]
  bool is_free(int turn) const {
    return ends.tip == RodEnds::Tip::ball || (follows() && turn == 2 && ends.tip == RodEnds::Tip::tangent);
  }
  bool follows() const { return ends.tip != RodEnds::Tip::ball; }
  /// @}

  /// @name At the last evaluation
  /// @{
  double error = 0;  ///< of the rod's own equations and its tip's
  double length = 1, force_unit = 0, moment_unit = 0;
  Vec3<double> arm;     ///< platform point from the reference point, base axes [m]
  Vec3<double> way;     ///< from the base to where the platform holds the tip, over L
  Vec3<double> force;   ///< on the tip [N]
  Vec3<double> moment;  ///< on the tip, over EI/L, section's axes
  Square section;       ///< of the tip, to base axes
  /// @}

  /// @name Kept from the last linearisation
  /// @{
  bool is_regular = false;    ///< the gap determines the unknowns; else the rest are no numbers
  SmallLu<6> factors;         ///< of the gap by the unknowns
  Square turned;              ///< section then
  Square by_turn, by_force;   ///< the tip's moment by its turns and force
  Matrix by_twist;            ///< the unknowns by the platform's twist, the gap held
  Vector by_length;           ///< ... by ln L
  Matrix stiffness_by_twist;  ///< force and moment on the tip by the platform's twist [N/m], ...
  Vector feed;                ///< ... by the length
  Vector fix;                 ///< of the unknowns: closes the gap at a resting platform
  Vector closed;              ///< force and moment on the tip once it is closed
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
  double length(int rod) const override { return lanes(rod).length[lane(rod)]; }
  void set_feed(int rod, double length) override { lanes(rod).length[lane(rod)] = length; }
  void set_inputs(Numbers inputs) override;
  Wrench wrench() const final { return wrench_; }
  void set_wrench(const Wrench& wrench) final { wrench_ = wrench; }
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
  /// Of the section in its guide [rad]; 0 where nothing depends on it.
  double axial_rotation(int rod) const;
  /// Estimated error of the shapes, of the length and in rad: the worst rod's.
  double truncation() const override;
  std::vector<Vec3<double>> centreline(int index, int samples) const override;
  void get_rod(int index, std::span<double> coordinates) const override;
  /// On the elements that coordinates are of.
  void set_rods(Numbers coordinates) override;
  /// @}

  /// @name To lay rods to a pose
  /// @{

  /// Every rod as the cubic between its guide and where the platform holds it, its frames along it by the
  /// least rotation and evenly twisted to the tip's, with the force and the length that go with it: not in
  /// equilibrium, a start of Newton's method. False where a tip lies on its base.
  bool draw_rods();
  /// After `linearise`: a step of the rods alone, the platform held, each fed until nothing pulls along the
  /// line from base to tip. By at most `most` of its length; returns the largest part of a length fed.
  double move_to_rest(double most);
  /// From `draw_rods`, the platform held: the rods at those lengths in equilibrium, grown from round,
  /// straight ones without load, and turned in their guides to where no torque is left; stable ones, if they
  /// are found from sections turned at the end that lets them. False where none is found.
  bool grow_rods();
  /// @}

  static constexpr int coarse_elements = 2, coordinate_elements = (rod_tangents - 1) / FrameState::degree;

 private:
  GeneralRod& at(int rod) { return all_[static_cast<std::size_t>(rod)]; }
  const GeneralRod& at(int rod) const { return all_[static_cast<std::size_t>(rod)]; }
  FrameRods& lanes(int rod) { return groups_[static_cast<std::size_t>(rod / rod_lanes)]; }
  const FrameRods& lanes(int rod) const { return groups_[static_cast<std::size_t>(rod / rod_lanes)]; }
  static int lane(int rod) { return rod % rod_lanes; }
  void weigh(int rod, const Vec3<double>& weight) override;
  bool feed_to_rest();
  bool is_stable_by_rods() const;
  bool draw_rod(int rod, double spin);
  void scale_law(int rod, double share);
  bool grow(std::span<const bool> which, bool keeps_spin);
  void copy_rod(std::span<const FrameState> from, int rod);
  bool turn_to_rest();
  void place_tip(int rod);
  double read_tip(int rod);
  void linearise_rod(int rod);
  void sum_closed();
  void give_step(int rod, const GeneralRod::Vector& unknowns, const Vec3<double>& turn, double longer);
  void change_elements(int elements);
  Vec3<double> lever(int rod) const;
  Vec3<double> base_moment(int rod) const;
  int count_unstable(const FrameRods& rods, int rod) const;
  template <class Use>
  void each_section(int rod, std::span<const double> places, Use&& use) const;

  std::vector<GeneralRod> all_;
  std::vector<FrameRods> groups_;
  std::vector<FrameState> spare_, first_;   ///< states to return to
  mutable std::vector<FrameRods> shifted_;  ///< of the last linearisation, if a rod was not stable
  mutable bool is_shifted_ = false;
  int elements_ = coarse_elements;
  Wrench wrench_ = Wrench::Zero(), sum_ = Wrench::Zero();
  double rod_error_ = 0;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> stiffness_ = Mat<double, 6, 6>::Zero();
};

}  // namespace sinew::inline v1
