/// @file arm_group.hpp
/// Arms between a base and a platform as one group of limbs. Theory: docs/theory/arm_legs.md
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "kinematics/arm_legs/group/legs_loads.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "robot/limbs/limb_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

/// A feed is a tendon: those of leg 0 first. Its own states are strains, tensions where lengths are
/// prescribed, and what the platform exerts on the tip. Unlike other groups it allocates.
class ArmGroup final : public LimbGroup<Spatial> {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Vector = Eigen::VectorXd;

  /// At rest: strains of the rest shape, the platform at home. The robot has to last as long.
  /// @param breaks where loads may act on legs
  ArmGroup(const ArmLegs& robot, const ArmBasis& basis, const LegsBreaks& breaks);
  /// Commands of all tendons, and the load of the whole.
  void set_problem(std::span<const TendonCommand> commands, const Wrench& wrench, const LegsLoads& loads);
  /// Only a share of inputs and loads acts, and only that share of the gaps between tips and platform at home
  /// is closed: at 0 the rest is an equilibrium, at 1 all act and every gap is closed.
  void set_share(double share);
  /// At rest with the platform elsewhere, free joints turned towards it: the gaps are those of there. Of a
  /// group at rest.
  void begin_at(const Frame& platform);
  /// Near a shape, without forces, and no gap is left: legs turn at their free joints towards the platform.
  void take(const ArmLegsStart& start);
  ArmLegsStart start_here(int parts) const;
  /// The state of another group of the same robot, of another basis.
  void carry_over_from(const ArmGroup& other);

  const LimbTraits& traits() const override;
  int limbs() const override { return static_cast<int>(legs_.size()); }
  int inputs() const override { return feeds_; }
  double length(int limb) const override;
  double stiffness(int limb) const override;
  double radius() const override { return radius_; }

  int feeds() const override { return feeds_; }
  int input_of(int feed) const override { return feed; }
  double held(int feed) const override;
  void set_feed(int feed, double value) override;

  const Frame& platform() const override { return platform_; }
  Wrench wrench() const override { return wrench_; }
  void set_wrench(const Wrench& wrench) override { wrench_ = wrench; }
  void save(LimbState& to) const override;
  void restore(const LimbState& from) override;

  /// Of strains over √(EI/L), of lengths over a leg's length, tendons' over its tendons' distance, of forces
  /// of the platform over EI/L²: the worst.
  double evaluate(bool from_scratch = true) override;
  double limb_error() const override { return limb_error_; }
  bool linearise() override;
  Twist step(bool fresh) override;
  Wrench wrench_residual() const override { return residual_; }
  void move(const Twist& twist, Numbers by_input = {}) override;
  const SmallLu<6>& factors() const override { return lu_; }
  MatrixView stiffness() const override { return {stiffness_.data(), 6, 6}; }
  Wrench input_wrench_jacobian(int input) const override;

  std::array<int, 2> unstable_with_tip_held(int limb) const override;
  double energy() const override;

  double effort(int feed) const override;
  double closing_effort(int feed) const override;
  Twist effort_jacobian(int feed) const override;

  /// @name Newton's step of all at once, which the straight legs of inextensible backbones need: their own
  /// equations at a fixed platform are singular
  /// @{
  bool factor_limbs();  ///< after `evaluate`
  bool plan();          ///< after `factor_limbs`: false where the whole is singular
  double planned_size() const { return planned_size_; }  ///< shapes as angles, turns of the platform [rad]
  void move_as_planned();
  /// Directions of the whole, after `factor_limbs`; −1 where it is not finite. Under loads that have no
  /// potential they are those of the symmetric part.
  int unstable() const;
  /// Of an equilibrium, after `factor_limbs`: columns by the command of every tendon, then by a wrench on
  /// the platform. It needs no finite stiffness. False where the whole is singular.
  bool answers(Matrix& twists, Matrix& by_tendon) const;
  /// @}

  /// @name At a prescribed pose: the platform's balance does not count
  /// @{
  void set_platform(const Frame& platform) { platform_ = platform; }
  bool plan_at_prescribed_pose();           ///< after `factor_limbs`: false where a leg alone is singular
  int unstable_at_prescribed_pose() const;  ///< directions of the legs, after `factor_limbs`
  /// What the legs need on the platform beyond weight and wrench, after `evaluate`.
  Wrench constraint_wrench() const { return -balance_; }
  /// @}

  /// Tendons whose lengths are prescribed give way by this share of what an arm yields to them where that is
  /// more than their own compliance, about the tensions that they have now; 0: by their own alone.
  void soften(double share);
  struct LengthError {
    double error = 0;   ///< > 0: it is longer than it is held [m]
    double length = 1;  ///< of its leg [m]
    int feed = -1;
  };
  /// Of softened tendons that which is farthest from as long as it is held.
  LengthError softened_error() const;
  /// Tendons that do not stretch pull against one another, and nothing that is prescribed determines with
  /// what. After `factor_limbs`.
  bool has_redundant_tendons() const;
  /// Tensions of which any multiple may be added without any change of shape, columns without dimension: of
  /// tendons that are as long as their way and hold a leg more often than once. After `factor_limbs`.
  Eigen::MatrixXd undetermined_tensions() const;
  /// By how much the planned step changes tensions that are not determined, to the least ones, over usual
  /// tensions. After `factor_limbs`.
  double relief() const;

  /// The tension or the change that the tendon has.
  double value_of(int feed, TendonHeld quantity) const {
    return quantity == TendonHeld::tension ? tension(feed) : change(feed);
  }
  const LegsLoads& loads() const { return loads_; }

  bool has_potential() const override;
  bool loads_have_potential() const;  ///< at whatever share of them
  int unstable_by_symmetric_part() const override;
  /// Elastic, of weight, of forces that keep their direction and of tendons that stretch [J].
  double potential() const;
  double tension(int feed) const;
  double change(int feed) const;      ///< of its end, > 0: paid out [m]
  double slack(int feed) const;       ///< what it is longer than its way [m]
  Wrench tip_wrench(int limb) const;  ///< of the platform on a tip, about the tip, base axes
  const ArmWorkspace& shape(int limb) const { return legs_[static_cast<std::size_t>(limb)].work; }
  /// No clamped tip is turned against its mount by 90 degrees or more: the closure's equations have solutions
  /// there, too.
  bool clamps_are_aligned() const;

 private:
  struct Tendon {
    TendonCommand command;
    double rest = 0, compliance = 0, pretension = 0;
    double free_length = 0, target = 0;  ///< at the share that acts [m], [N]
    double tension = 0;                  ///< [N]
    double unit = 0;                     ///< of its own length's error by tension [m/N]
    double expected = 0;                 ///< at which a softened one is as long as it should be [N]
    bool is_taut = false;                ///< its length is prescribed and it pulls
    /// It is, but others prescribe the length of its way already: its tension is not determined.
    bool is_redundant = false;
    double relief = 0;  ///< of the next step, by which redundant ones come to the least tensions [N]
    int place = -1;     ///< among the unknown forces, or the prescribed tensions
  };
  struct Leg {
    const ArmLeg* own;
    ArmWorkspace work;
    std::vector<Tendon> tendons;
    int first_feed = 0;
    Vec3<double> force = Vec3<double>::Zero();    ///< of the platform on the tip, base axes [N]
    Vec3<double> moment = Vec3<double>::Zero();   ///< the same, in the mount's axes [N m]
    Vec<double, 6> gap = Vec<double, 6>::Zero();  ///< of the rest at home: what closes as the share grows
    strain::NodeLoad tip;                         ///< its weight, and what of loads on the leg acts there
    Vec<double, 6> off = Vec<double, 6>::Zero();  ///< closure's error
    Eigen::MatrixXd undetermined;                 ///< tensions that act on no strain, a row each tendon
    int taut = 0, closed = 3;                     ///< unknown forces: of tendons, of the closure
    /// Which of force and moment the closure's unknowns are: 0 to 2 and 3 to 5.
    std::array<int, 6> components{0, 1, 2, 3, 4, 5};
    Matrix B, HB;            ///< rows of the unknowns, those of joints that turn freely last; H⁻¹Bᵀ
    Matrix L, HL;            ///< of prescribed tensions
    Vector y0, r;            ///< −H⁻¹ gradient; what is missing with it
    Matrix D, D_inverse, X;  ///< their compliance; rows by the platform's twist
    Vector C;                ///< what the compliance is without the backbone's
    /// What acts on the backbone has a potential. Else H and D are not symmetric, and `negative` is 1 where
    /// the determinant of H is.
    bool has_potential = true;
    int negative = 0;
    Vector du;

    int forces() const { return taut + closed; }
    /// A joint that turns freely has one more: what takes its coordinate's stiffness back.
    int unknowns() const { return forces() + static_cast<int>(pivots().size()); }
    std::span<const int> pivots() const { return rod(*this).model().pivots; }
    explicit Leg(const ArmLeg& leg) : own(&leg), work(leg.arm) {}
  };
  static strain::LoadedRod& rod(const Leg& leg) { return leg.work.impl().levels.front()->rod; }
  Frame mount_of(const Leg& leg) const;
  Vec3<double> moment_of(const Leg& leg) const;  ///< base axes
  Wrench needs(const Leg& leg) const;
  void stand(Leg& leg, const ArmBasis& basis, const std::vector<double>& breaks);
  void aim(Leg& leg);
  double way_to_platform(const Leg& leg) const;
  void measure_closure(Leg& leg);
  void keep_in_plane(Wrench& wrench) const;
  /// Of a robot in the plane: what moves it out is as stiff as `units` say, and coupled to nothing.
  void constrain_to_plane(Eigen::Ref<Matrix> by_twist, const std::array<double, 2>& units) const;
  static double yields(const Arm& arm, const ArmTendon& tendon);
  /// By which a tendon gives way more than by its own compliance [m/N].
  double softness(const Tendon& tendon) const {
    return std::max(0.0, softness_ * tendon.unit - tendon.compliance);
  }
  double missing_length(const Leg& leg, std::size_t index) const;
  double measure_tendons(Leg& leg);
  void leave_out_redundant_tendons(Leg& leg) const;
  static void set_undetermined(Leg& leg, const std::vector<std::size_t>& tight,
                               const std::vector<double>& gradients);
  static void relieve(Leg& leg, const std::vector<std::size_t>& tight);
  void evaluate(Leg& leg);
  void set_tendon_rows(Leg& leg) const;
  void set_closure_rows(Leg& leg);
  static void condense(Leg& leg);
  bool factor(Leg& leg);
  void advance(Leg& leg, const Frame& after, Numbers by_input);
  Mat<double, 6, 6> curvature(const Leg& leg) const;
  double force_unit(const Leg& leg) const;
  bool factor_compliance(Leg& leg) const;
  bool platform_has_potential() const;  ///< what acts on the platform has one
  /// The symmetric part of a leg's Hessian as its unknown forces feel it.
  struct SymmetricPart {
    Matrix D;
    int negative = 0;  ///< directions of the Hessian
    bool ok = false;
  };
  SymmetricPart symmetric_part(const Leg& leg) const;
  int unstable_with_tip_held(const Leg& leg, const Matrix& D, int negative) const;
  /// Of the platform's balance by its twist, what turns with it.
  Mat<double, 6, 6> following_curvature() const;
  Wrench turning_wrench() const;  ///< of what turns with the platform, base axes
  /// Of all unknown forces and the platform, without dimension. @param D of every leg, or of none: its own
  Matrix whole(std::span<const SymmetricPart> parts = {}) const;
  static double planned_bend(const Leg& leg);
  Matrix rate_sides(Eigen::Index size) const;
  void set_tendon_rates(const Leg& leg, const Matrix& forces, Matrix& by_tendon) const;
  Vector units() const;
  Vector units_of(const Leg& leg) const;
  std::pair<const Leg*, const Tendon*> find(int feed) const;

  const ArmLegs* robot_;
  std::vector<Leg> legs_;
  Frame platform_;
  Wrench wrench_ = Wrench::Zero();
  LegsLoads loads_;
  double share_ = 0, radius_ = 0, softness_ = 0;
  int feeds_ = 0;
  double limb_error_ = 0, planned_size_ = 0;
  Wrench balance_ = Wrench::Zero(), residual_ = Wrench::Zero();
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> stiffness_ = Eigen::Matrix<double, 6, 6>::Zero();
  SmallLu<6> lu_;
  Twist planned_ = Twist::Zero();
};

}  // namespace sinew::inline v1
