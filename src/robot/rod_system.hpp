/// @file rod_system.hpp
/// Rods between a base and a platform as one system of equations: what Newton's method needs of a robot whose
/// legs bear load. The rods' own unknowns are eliminated in the same step, never solved at a fixed platform.
/// Theory: docs/theory/rod_robot.md
#pragma once
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "robot/rod_group.hpp"
#include "robot/rod_kernels.hpp"
#include "sinew/robot/rod_reading.hpp"

namespace sinew::inline v0 {

/// All numbers of one robot's equilibrium. No function here allocates unless it says so.
class RodSystem : public RodGroup {
 public:
  /// Whether a step costs some hundred times as much as one of the others: fewer are tried then.
  static constexpr bool is_slow = false;
  /// What is said where rods cannot be laid to their home.
  static constexpr std::string_view has_no_rest =
      "the rods cannot be laid to home: a tip lies on the line of its guide, so that where it bends is not "
      "determined, or behind it, or the rods' weight is too much for them";
  explicit RodSystem(const ParallelRobot<RodLeg>& robot);  ///< allocates

  /// Estimated error from which an answer that is not resumed takes the fine nodes: stiff robots turn it into
  /// forces.
  static constexpr double best_truncation = 1e-17;
  /// ... and one that is to be quick: poses were then within 2e-13 m of exact ones.
  static constexpr double quick_truncation = 1e-10;

  /// A state to return to.
  struct Snapshot {
    std::vector<PlaneRodState<coarse_nodes>> coarse;
    std::vector<PlaneRodState<fine_nodes>> fine;
    bool is_fine = false;
    SE3<double> platform;
    Wrench wrench = Wrench::Zero();
  };
  Snapshot snapshot() const;  ///< allocates: take it once and `save` into it
  void save(Snapshot& to) const;
  void restore(const Snapshot& from);

  /// @name What is held
  /// @{
  Vec3<double> base(int rod) const;
  Vec3<double> platform_point(int rod) const;
  double stiffness(int rod) const;  ///< EI [N m²]
  double length(int rod) const;
  void set_length(int rod, double length);
  void set_inputs(std::span<const double> inputs);                          ///< the lengths of all rods [m]
  Wrench wrench() const { return Eigen::Map<const Wrench>(held_.wrench); }  ///< of the world, base axes
  void set_wrench(const Wrench& wrench) { Eigen::Map<Wrench>(held_.wrench) = wrench; }
  bool is_fine() const { return is_fine_; }
  bool is_finest() const { return is_fine_; }
  void refine();                                       ///< to the fine nodes, the same shapes
  void coarsen();                                      ///< to the coarse nodes, the shapes interpolated
  bool can_coarsen(double) const { return is_fine_; }  ///< whether it is worth a try
  /// @}

  /// @name Newton's method
  /// @{

  /// Largest of closure error over length, of force error over EI/L² and moment error over EI/L, and of the
  /// rods' own equations. NaN where anything is.
  /// Where nothing but lengths, wrench and steps changed since the last time, not `anew` is quicker and
  /// rounds once more a step; after some dozens of steps it is anew all the same.
  double evaluate(bool anew = true);
  double rod_error() const {
    return sums_.rod_error;
  }  ///< of the last evaluation: the rods' own and their tips'
  /// Factors at the point last evaluated. False where the platform's stiffness is singular.
  bool linearise();
  /// Newton's step from the last evaluation with the last factors; `fresh` right after `linearise`.
  Twist step(bool fresh);
  /// After `linearise` or `step`: what is missing to balance once the rods' gaps are closed.
  Wrench missing() const;
  /// A step of the platform, and lengths fed by each input; the rods follow to first order.
  void move(const Twist& twist, std::span<const double> fed = {});
  Lu6 factors() const;                                              ///< of the stiffness
  MatrixView stiffness() const { return {sums_.stiffness, 6, 6}; }  ///< ∂(F, M)/∂(p, φ) at fixed lengths
  /// ∂(F, M)/∂length of one input at a resting platform [N/m, N].
  Wrench feed_wrench(int input) const;
  /// @}

  /// @name Single rods, after `evaluate`
  /// @{

  RodReading rod(int index) const;
  double axial_force(int rod) const;  ///< at its guide, pull > 0 [N]
  /// The same once the rod's gaps are closed at a resting platform, and its change by the platform's twist at
  /// fixed lengths; after `linearise`.
  double closing_axial_force(int rod) const;
  Twist axial_row(int rod) const;
  /// Unstable directions with the tip held, in the rod's plane and out of it; after `linearise`.
  std::array<int, 2> unstable_with_tip_held(int index) const;
  /// Estimated error of the shapes' polynomials at the tips, over the length: the worst rod's.
  double truncation() const;
  /// Polyline, `samples` ≥ 2 points in base axes [m]. Allocates.
  std::vector<Vec3<double>> centreline(int index, int samples) const;

  /// State as the coordinates of the leg (see RodLeg), on the side the tip lies ...
  void get_rod(int index, std::span<double> coordinates) const;
  /// ... the same back, with the lateral direction it bends to; refines first ...
  void set_rod(int index, std::span<const double> coordinates, const Vec3<double>& lateral);
  /// ... and that of all rods, each towards its tip.
  void set_rods(std::span<const double> coordinates);

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
  int carried_ = 0;  ///< steps since the last evaluation anew
  RodPlatform held_{};
  RodSums sums_{};
  bool has_inverse_ = false;  ///< in `held_`; else there are factors
};

}  // namespace sinew::inline v0
