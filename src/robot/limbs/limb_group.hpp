/// @file limb_group.hpp
/// Limbs of one kind between a base and a platform, side by side under load: what every question about loaded
/// robots is put to, whatever the limbs are. Their own states are eliminated in each Newton step, so that six
/// equations (in the plane three) are left, of the platform. Theory: docs/theory/limb_group.md
#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "leg/space.hpp"
#include "math/linalg.hpp"
#include "robot/limbs/limb_state.hpp"
#include "robot/limbs/small_lu.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Estimated error of a shape at its tip, over the length, from which a path and a resumed answer refine it.
inline constexpr double coarse_truncation = 1e-12;

/// What differs from one kind of limbs to another in how it is best solved.
struct LimbTraits {
  /// On LimbGroup::evaluate: what counts as solved, and below which a step along a curve can only lose.
  double tolerance = 1e-12, rounding = 1e-12;
  /// Estimated error of the shapes from which an answer that is not resumed refines them ...
  double best_truncation = 0;
  /// ... and one that is to be quick.
  double quick_truncation = 0;
  /// What is said where limbs have no unloaded equilibrium at home.
  std::string_view has_no_rest = {};
};

/// No function here allocates unless it says so. A group holds the state of its limbs, of the platform and
/// of the load; after `evaluate`, and for some after `linearise`, it tells about them.
template <class SpaceT>
class LimbGroup {
 public:
  using Space = SpaceT;
  static constexpr int dof = Space::dof;
  using Frame = typename Space::template Frame<double>;
  using Wrench = Vec<double, dof>;  ///< force, then moment about the platform's reference point, base axes
  using Twist = Vec<double, dof>;
  using Square = Mat<double, dof, dof>;

  LimbGroup() = default;
  LimbGroup(const LimbGroup&) = delete;
  LimbGroup& operator=(const LimbGroup&) = delete;
  virtual ~LimbGroup() = default;

  virtual const LimbTraits& traits() const = 0;

  /// @name What it is
  /// @{
  virtual int limbs() const = 0;
  virtual int inputs() const = 0;  ///< of the robot
  virtual int leg_of(int limb) const { return limb; }
  virtual double length(int limb) const = 0;     ///< of its backbone [m]: what its shape is measured by
  virtual double stiffness(int limb) const = 0;  ///< EI [N m²]
  virtual double radius() const = 0;             ///< makes moments comparable with forces [m]
  /// Whether legs close beside the limbs ...
  virtual bool closes() const { return false; }
  /// ... and the motions they forbid, less those their own inputs drive.
  virtual int undriven() const { return 0; }
  /// @}

  /// @name What is held: one of the two quantities of each feed, length or tension; the other is its effort
  /// @{
  virtual int feeds() const = 0;
  virtual int input_of(int feed) const = 0;
  virtual double held(int feed) const = 0;
  virtual void set_feed(int feed, double value) = 0;  ///< from now on it is held at this
  /// To where what the limbs allow ends: positive on this side.
  virtual double margin() const { return 1; }
  /// @}

  /// @name Platform and load
  /// @{
  virtual const Frame& platform() const = 0;
  virtual Wrench wrench() const = 0;  ///< of the world on the platform
  virtual void set_wrench(const Wrench& wrench) = 0;
  /// @}

  /// @name States to return to
  /// @{
  virtual void save(LimbState& to) const = 0;  ///< allocates the first time
  virtual void restore(const LimbState& from) = 0;
  LimbState state() const {  ///< allocates
    LimbState state;
    save(state);
    return state;
  }
  /// @}

  /// @name How finely shapes are resolved
  /// @{
  virtual double truncation() const {
    return 0;
  }  ///< estimated error at the tips, over the length: the worst
  virtual bool is_finest() const { return true; }
  virtual void refine() {}
  virtual void coarsen() {}
  virtual bool can_coarsen(double) const { return false; }  ///< and perhaps stay below this truncation
  /// @}

  /// @name Newton's method
  /// @{

  /// Largest error of all equations, without dimension; NaN where anything is. Where nothing but inputs,
  /// wrench and steps changed since the last time, not `from_scratch` may be quicker and round more.
  virtual double evaluate(bool from_scratch = true) = 0;
  virtual double limb_error() const = 0;  ///< of the last evaluation: of the limbs' own equations
  /// Factors at the point last evaluated. False where the platform's stiffness is singular.
  virtual bool linearise() = 0;
  /// Newton's step of the platform from the last evaluation; `fresh` right after `linearise`, else with the
  /// factors that are kept.
  virtual Twist step(bool fresh) = 0;
  /// After `linearise` or `step`: what is missing to balance once the limbs' own equations hold.
  virtual Wrench wrench_residual() const = 0;
  /// A step of the platform, and changes of the inputs; the limbs follow to first order.
  virtual void move(const Twist& twist, Numbers by_input = {}) = 0;
  virtual const SmallLu<dof>& factors() const = 0;            ///< of the stiffness
  virtual MatrixView stiffness() const = 0;                   ///< ∂(wrench needed)/∂(pose), inputs held
  virtual Wrench input_wrench_jacobian(int input) const = 0;  ///< ∂(wrench needed)/∂(input), platform held
  /// What of a load the limbs bear: closing legs may take some.
  virtual Wrench project_wrench(const Wrench& wrench) const { return wrench; }
  /// @}

  /// @name Of a state that was linearised
  /// @{
  /// Unstable directions of a limb by itself, its tip held.
  virtual std::array<int, 2> unstable_with_tip_held(int limb) const = 0;
  /// Whether all that acts has a potential, without which the stiffness is not symmetric.
  virtual bool has_potential() const {
    constexpr int moments = dof - Space::dimension;
    return Space::dimension == 2 || wrench().template tail<moments>().isZero(0);
  }
  /// Where limbs themselves bear loads without a potential, the directions of the whole in which the
  /// symmetric part of the second variation falls; else −1.
  virtual int unstable_by_symmetric_part() const { return -1; }
  virtual double energy() const = 0;  ///< elastic, of all limbs [J]
  /// @}

  /// @name The effort of a feed: the force that goes with a length that is held
  /// @{
  virtual double effort(int feed) const = 0;  ///< pull > 0 [N]
  /// The same once the limb's own equations hold, the platform resting ...
  virtual double closing_effort(int feed) const = 0;
  /// ... and its change by the platform's twist.
  virtual Twist effort_jacobian(int feed) const = 0;
  /// @}
};

/// One state on a curve of equilibria, to come back to.
template <class Space>
struct LimbPlace {
  struct State {
    LimbState limbs;
    typename LimbGroup<Space>::Frame platform;
  };
  State state;
  double lambda = 0;                                                          ///< parameter of the curve
  Vec<double, Space::dof + 1> tangent = Vec<double, Space::dof + 1>::Zero();  ///< unit, see Tracer
};

/// Memory for following a curve by its arc length.
template <class Space>
using LimbPlaces = std::array<LimbPlace<Space>, 4>;
/// ... so large that states of this group do not allocate.
template <class Space>
LimbPlaces<Space> places_of(const LimbGroup<Space>& group) {
  const LimbPlace<Space> place{{group.state(), group.platform()}};
  return {place, place, place, place};
}

}  // namespace sinew::inline v1
