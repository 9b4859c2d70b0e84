/// @file rod_group.hpp
/// Rods between a base and a platform: what questions ask of them beside what they ask of all limbs, and what
/// every group of rods holds. Only tests and the batch depend on which group it is.
#pragma once
#include <cmath>

#include "leg/rod_leg.hpp"
#include "robot/limbs/limb_group.hpp"
#include "robot/parallel.hpp"
#include "sinew/link/state.hpp"

namespace sinew::inline v1 {

class ElasticaSystem;

/// Of rods that are laid to their home as fields of tangents.
inline constexpr std::string_view no_rest_of_tangents =
    "the rods cannot be laid to home: a tip lies on the line of its guide, so that where it bends is not "
    "determined, or behind it, or the rods' weight is too much for them";

/// On `evaluate`: what counts as solved, and below which Newton's method can only lose to rounding.
inline constexpr double rod_tolerance = 1e-12, rod_rounding = 2e-13;

/// A feed is a rod, whose length is held, or an input of a leg that closes beside them.
class RodGroup : public LimbGroup<Spatial> {
 public:
  explicit RodGroup(const ParallelRobot<RodLeg>& robot)  ///< allocates
      : rods_(robot.leg_count()),
        platform_(SE3<double>::from(robot.home)),
        radius_(robot.platform_radius),
        inputs_(robot.total.input) {
    for (const LegPlace& place : robot.places) {
      input_of_.push_back(place.input);
      coordinate_of_.push_back(place.coordinate);
    }
  }

  int limbs() const final { return rods_; }
  int inputs() const final { return inputs_; }
  int feeds() const final { return static_cast<int>(input_of_.size()); }
  int input_of(int feed) const final { return input_of_[static_cast<std::size_t>(feed)]; }
  double radius() const final { return radius_; }
  const SE3<double>& platform() const final { return platform_; }
  void set_platform(const SE3<double>& pose) { platform_ = pose; }

  /// @name What is held
  /// @{
  double held(int feed) const override { return length(feed); }
  virtual bool in_domain(int, double length) const { return length > 0 && std::isfinite(length); }
  virtual void set_inputs(Numbers inputs) = 0;
  /// What the rods weigh by, beside their own load [m/s²]. True where that changes their equilibrium.
  virtual bool set_gravity(const Vec3<double>&) { return false; }
  /// Of the rods' weight and own load, after `evaluate` [J]; 0 with the rods in their bases.
  virtual double weight_energy() const { return 0; }
  virtual bool is_fine() const = 0;  ///< shapes are resolved more finely than at first
  /// @}

  /// @name Single rods, after `evaluate`
  /// @{
  virtual Vec3<double> base(int rod) const = 0;
  virtual Vec3<double> platform_point(int rod) const = 0;
  virtual RodResult rod(int index) const = 0;
  std::vector<RodResult> readings() const;  ///< allocates
  double energy() const final;
  /// With that of weight and load beside the rods' own; NaN under a moment, which keeps its axes and so has
  /// no potential.
  double potential(double energy) const;
  /// Polyline, `samples` ≥ 2 points in base axes [m]. Allocates.
  virtual std::vector<Vec3<double>> centreline(int index, int samples) const = 0;
  /// Where a rod's coordinates begin among the robot's.
  int coordinate_of(int rod) const { return coordinate_of_[static_cast<std::size_t>(rod)]; }
  /// State as the coordinates of the leg (see RodLeg) ...
  virtual void get_rod(int index, std::span<double> coordinates) const = 0;
  /// ... and that of all rods back, and of closing legs, from the robot's.
  virtual void set_rods(Numbers coordinates) = 0;
  /// @}

  /// @name Legs that close beside the rods; after `linearise`
  /// @{
  virtual int closing_legs() const { return 0; }
  /// Of the platform on a closing leg, at its platform point, base axes [N].
  virtual Vec3<double> closing_force(int) const { return Vec3<double>::Zero(); }
  virtual void get_closing(std::span<double>) const {}  ///< their part of the robot's coordinates
  /// On the motions they leave free: stiffness, `input_wrench_jacobian`, and what of a twist they allow.
  virtual Square platform_stiffness() const { return stiffness(); }
  virtual Wrench platform_feed(int input) const { return input_wrench_jacobian(input); }
  virtual Twist free_motion(const Twist& twist) const { return twist; }
  /// @}

  /// @name Equilibria
  /// @{

  /// Every rod as it rests at a pose that nothing but the joints' side forces holds: the length at which it
  /// neither pulls nor pushes, along its guide or, of those that do not bend in one plane, along the line to
  /// its tip; other legs closed. False where a rod's tip lies on its guide's line or behind it, or where a
  /// leg cannot be closed.
  virtual bool rest_at(const SE3<double>& platform) = 0;
  /// Newton's method from the state before, with the factors kept from there. False, with the state lost,
  /// where it does not contract. One call for the whole of it: it takes a microsecond.
  virtual bool solve_warm(Report& report) = 0;
  /// Newton's method on the rods alone, the platform held.
  bool correct_rods(int& iterations, double& residual, double tolerance);
  /// Evaluated and linearised under the wrench that holds this state. @param once_closed the rods' gaps
  bool balance(bool once_closed);
  /// @}

  /// Itself, if they are elasticas without weight.
  virtual ElasticaSystem* elastica() { return nullptr; }

 protected:
  /// Turned by half-angle quaternion: like the exponential to second order, and exactly a rotation.
  void move_platform(const Twist& twist) {
    const SO3<double> turn{1, Vec3<double>(twist.tail<3>()) / 2};
    platform_ = {platform_.p + twist.head<3>(), turn.compose(platform_.R).normalised()};
  }
  /// Rods that are nearly in equilibrium: exactly, with their wrench. False where they do not get there.
  bool settle_rods();

  /// What all states begin with: pose, load, and how finely shapes are resolved.
  struct Common {
    double position[3], rotation[4], wrench[6];
    int level;
  };
  /// Begins a state. @param most bytes of the rods in any
  void save_common(LimbState& to, int level, std::size_t most) const;
  int restore_common(LimbState::Reader& from);  ///< its level

  std::vector<int> input_of_;  ///< of each feed
  int rods_;
  SE3<double> platform_;
  double radius_;

 private:
  std::vector<int> coordinate_of_;
  int inputs_;
};

/// Of rods that may be heavy.
class HeavyRodGroup : public RodGroup {
 public:
  explicit HeavyRodGroup(const ParallelRobot<RodLeg>& robot);  ///< allocates
  bool set_gravity(const Vec3<double>& gravity) final;
  const SmallLu<6>& factors() const override { return lu_; }

 protected:
  virtual void weigh(int rod, const Vec3<double>& weight) = 0;  ///< along its length [N/m]

  SmallLu<6> lu_;

 private:
  Vec3<double> gravity_ = Vec3<double>::Zero();
  std::vector<double> mass_;        ///< of each rod along its length [kg/m]
  std::vector<Vec3<double>> load_;  ///< beside its weight [N/m]
};

}  // namespace sinew::inline v1
