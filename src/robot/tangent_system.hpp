/// @file tangent_system.hpp
/// Rods in space between a base and a platform as one system of equations: what Newton's method needs of a
/// robot whose rods are clamped at the platform, heavy, or stretch. RodSystem is its fast special case and
/// has the same face. Theory: docs/theory/tangent_rod.md
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "robot/rod_system.hpp"
#include "robot/tangent_lanes.hpp"

namespace sinew::inline v0 {

/// All numbers of one robot's equilibrium. No function here allocates unless it says so.
class TangentSystem : public HeavyRodGroup {
 public:
  static constexpr bool is_slow = false;
  static constexpr std::string_view has_no_rest = RodSystem::has_no_rest;
  explicit TangentSystem(const ParallelRobot<RodLeg>& robot);  ///< allocates

  /// A state to return to.
  struct Snapshot {
    std::vector<TangentState> rods;
    int elements = 0;
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
  void set_gravity(const Vec3<double>& gravity);
  double weight_energy() const;  ///< of all rods, after `evaluate` [J]; 0 with the rods in their bases
  int elements() const { return elements_; }
  bool is_fine() const { return elements_ > coarse_elements; }
  bool is_finest() const { return elements_ >= max_elements; }
  void refine();                              ///< to more elements, the same shapes
  void coarsen();                             ///< to fewer elements, the shapes interpolated
  bool can_coarsen(double truncation) const;  ///< and stay below this estimate of the error
  /// @}

  /// @name Newton's method, as RodSystem has it
  /// @{
  double evaluate(bool anew = true);
  double rod_error() const { return sums_.rod_error; }
  bool linearise();
  Twist step(bool fresh);
  Wrench missing() const;
  void move(const Twist& twist, std::span<const double> fed = {});
  Lu6 factors() const;
  MatrixView stiffness() const { return {sums_.stiffness, 6, 6}; }
  Wrench feed_wrench(int input) const;
  /// @}

  /// @name Single rods, after `evaluate`
  /// @{
  RodReading rod(int index) const;
  double axial_force(int rod) const;  ///< at its guide, pull > 0 [N]
  double closing_axial_force(int rod) const;
  Twist axial_row(int rod) const;
  /// Unstable directions with the tip held; after `linearise`. The second number is 0.
  std::array<int, 2> unstable_with_tip_held(int index) const;
  /// Estimated error of the shapes' polynomials at the tips, over the length: the worst rod's.
  double truncation() const;
  /// Polyline, `samples` ≥ 2 points in base axes [m]. Allocates.
  std::vector<Vec3<double>> centreline(int index, int samples) const;
  /// State as the coordinates of the leg (see RodLeg) ...
  void get_rod(int index, std::span<double> coordinates) const;
  /// ... and that of all rods back, on the elements those are of.
  void set_rods(std::span<const double> coordinates);
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
  /// Estimated error from which an answer that is not resumed takes more elements: forces are then good to
  /// 1e-12 of themselves.
  static constexpr double best_truncation = 1e-15;
  /// ... and one that is to be quick: lengths to 1e-9 of themselves.
  static constexpr double quick_truncation = 1e-9;

 private:
  template <class Use>
  decltype(auto) with_rod(int rod, Use&& use) const {
    return use(groups_[static_cast<std::size_t>(rod / rod_lanes)], rod % rod_lanes);
  }
  void fill_idle_lanes();
  Vec3<double> lever(const TangentRods& rods, int lane) const;
  void change_elements(int elements);
  Vec3<double> tangent_at(const RodLane (*tangents)[3], int lane, double along) const;

  std::vector<TangentRods> groups_;
  std::vector<RodFeed> fed_;
  int elements_ = coarse_elements;
  RodPlatform held_{};
  RodSums sums_{};
};

}  // namespace sinew::inline v0
