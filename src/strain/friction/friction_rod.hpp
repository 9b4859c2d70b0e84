/// @file friction_rod.hpp
/// Equilibria of a rod whose tendons rub at their guides (Coulomb), one after the other along a path: what
/// lies of a tendon between two guides is remembered. Theory: docs/theory/tendon_friction.md
#pragma once
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <span>
#include <vector>

#include "sinew/math/vec.hpp"
#include "strain/friction/capstan.hpp"
#include "strain/relax.hpp"
#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

/// A tendon as far as friction needs it.
struct RubbingTendon {
  double friction = 0;    ///< μ, ≥ 0
  double compliance = 0;  ///< of the part in the rod [m/N]; 0: it does not stretch
  double outside = 0;     ///< compliance of the part between motor and rod [m/N]; 0: that does not stretch
  double pretension = 0;  ///< [N]
};

/// What is done to a tendon's end.
struct TendonInput {
  bool by_tension = true;
  double value = 0;  ///< tension [N], or what its end is pulled in [m]
};

/// What a step did.
struct PathStep {
  Relaxed found;        ///< `reached`: share of the step
  int parts = 0;        ///< into which it was cut
  double motors = 0;    ///< work of the ends of tendons [J]
  double friction = 0;  ///< lost at guides [J]
};

/// What changes at once where inputs begin to change at some rates, one-sided.
struct PathRates {
  enum class Why { singular, known, no_turn, pushes, undecided };
  Why why = Why::singular;  ///< what is not known otherwise
  std::vector<double> y;    ///< of coordinates
  std::vector<std::vector<double>>
      tension;              ///< before the rod, not a number where a motor's may jump; of spans
  std::vector<double> end;  ///< pulled in
  int slipping = 0;         ///< guides

  /// What a change of one input, or one force on the coordinates, adds while the same guides slip.
  struct Column {
    std::vector<double> y, tension, end;  ///< tension: of each tendon at its motor
  };
  std::vector<Column> by_inputs, by_forces;  ///< where they are asked for
  std::vector<double> least, most;  ///< rate of each input, the others as they are, between which the
                                    ///< same guides slip; may be infinite
};

/// A rod, its tendons and what they remember.
class FrictionRod {
 public:
  FrictionRod(const RodModel& model, std::span<const RubbingTendon> tendons);
  FrictionRod(const FrictionRod&) = delete;
  FrictionRod& operator=(const FrictionRod&) = delete;

  const RodModel& model() const { return *model_; }
  const RodWork& work() const { return work_; }
  /// Straight, free, never pulled.
  void forget();
  /// Takes over what another rod of the same tendons and guides remembers; false if they are not the same.
  /// @param loads,y the other's, on the nodes and in the coordinates of this one
  bool remember(const FrictionRod& other, std::span<const NodeLoad> loads, std::span<const double> y);

  /// Inputs and loads change evenly from those of the last step to these. Where no equilibrium is found the
  /// rod stays at the last one that was.
  PathStep step(std::span<const TendonInput> inputs, std::span<const NodeLoad> loads,
                const RelaxOptions& options);

  /// @name Of the equilibrium at hand
  /// @{
  double tension_at_motor(std::size_t tendon) const { return now_.tendons[tendon].tension.front(); }
  double pulled_in(std::size_t tendon) const { return now_.tendons[tendon].end; }
  double slack(std::size_t tendon) const;
  /// Of the part before the rod, then of every span from base to tip [N].
  std::span<const double> tensions(std::size_t tendon) const { return now_.tendons[tendon].tension; }
  /// Unstretched length in every span [m].
  std::span<const double> contents(std::size_t tendon) const { return now_.tendons[tendon].content; }
  /// By which it turns at every guide, that at the base first [rad].
  std::span<const double> angles(std::size_t tendon) const { return chains_[tendon].angle; }
  /// Of the last step's inputs, tension or pulled in, at these rates; loads stay. What is remembered stays.
  PathRates rates(std::span<const double> direction) { return rates(direction, {}, 0); }
  /// And what is linear around that direction: `by_inputs`, and `by_forces` of so many forces.
  /// @param forces of each a number for every coordinate, one force after the other
  PathRates rates(std::span<const double> direction, std::span<const double> forces, int count);
  /// Elastic, of loads that have a potential, and of tendons that stretch [J].
  double stored() const { return now_.stored; }
  /// @}

  /// @name For tests: at any coordinates, with what is remembered
  /// @{
  void put(std::span<const double> y, std::span<const TendonInput> inputs, std::span<const NodeLoad> loads);
  /// After put(): Newton's equations of this right side, in place; false where they are singular.
  bool solve_newton(std::span<double> side);
  /// @}

 private:
  /// A length of the rod over which tendons run straight.
  struct Segment {
    int first_element = 0, elements = 0, piece = 0;
    Eigen::Matrix<double, 6, Eigen::Dynamic> twist;  ///< of its end against its start by the coordinates
  };
  /// A tendon along a segment.
  struct Unit {
    int segment = 0, entry = 0;  ///< in RodModel::holes or ::guides
    bool hole = true;
    Three start{}, end{};  ///< in the axes of the nodes there [m]
    double length = 0;     ///< [m]
    Vec3<double> along_start = Vec3<double>::Zero(), along_end = Vec3<double>::Zero();
    double chord = 0;
    Mat<double, 3, 3> turn = Mat<double, 3, 3>::Identity();
    std::vector<double> gradient;  ///< of the length by the piece's coordinates
  };
  struct Chain {
    RubbingTendon tendon;
    std::vector<Unit> units;
    Vec3<double> entry = Vec3<double>::Zero();  ///< how it comes to the base
    std::vector<double> rest, compliance, offset;
    std::vector<double> give;   ///< of spans that do not stretch, where they are looked for first
    std::vector<double> angle;  ///< at the base, then between units [rad]
    std::vector<std::vector<double>> turns;  ///< their gradients by the coordinates from `first` on
    std::vector<int> first;
    CapstanSpans spans;
    CapstanTensions tensions;
    std::vector<double> pull;  ///< of each span, where the Hessian is taken [N]
    bool moves = false;        ///< tensions may depend on the coordinates
    bool taut = false, was_taut = false;
    std::vector<Grip> chosen;  ///< in the last step
    int first_column = 0;      ///< of its spans in the update below
    int first_span = 0;        ///< the same with those outside of the rod
    bool has_outer = true;     ///< the part outside of the rod is a span
    std::vector<double> by_stretch, by_grip;
  };
  /// What is remembered of a tendon.
  struct Memory {
    std::vector<double> content;  ///< of every span of the rod [m]
    double outer = 0;             ///< of the part outside: unstretched, over that straight and free [m]
    double end = 0;               ///< pulled in [m]
    std::vector<double> tension;  ///< outside, then of every span [N]
    bool slack = false;
  };
  struct State {
    std::vector<double> y;
    std::vector<Memory> tendons;
    std::vector<NodeLoad> loads;
    double stored = 0;
  };

  class GripProblem;
  class RateProblem;

  void build(std::span<const RubbingTendon> tendons);
  void set(std::span<const TendonInput> inputs, std::span<const NodeLoad> loads);
  void evaluate();
  void lengths();
  Vec3<double> guided(const Segment& segment, const Guide& guide, std::size_t g) const;
  void linearise();
  void gradients();
  Mat<double, 6, 6> omega_by_strain(std::size_t element, int point) const;
  void find_twist(Segment& segment) const;
  void find_length_gradient(Unit& unit) const;
  void find_angle_gradient(Chain& chain, std::size_t k) const;
  void geometry_rates(const double* x, int stride, int columns, Eigen::MatrixXd& lengths_of,
                      Eigen::MatrixXd& angles_of) const;
  void tension_rates(const Eigen::MatrixXd& lengths_of, const Eigen::MatrixXd& angles_of,
                     Eigen::MatrixXd& rates) const;
  bool factor_rod(double shift);
  bool factor_tendons();
  bool factor_all(double shift);
  void add_tendons(std::span<double> sides, const Eigen::VectorXd& jumps);
  void add_drag();
  bool find_step();
  void choose_grips(const Eigen::VectorXd& tensions);
  void solve_all(std::span<double> sides);
  double residual() const;
  bool holds();
  Relaxed newton(const RelaxOptions& options, double share_left);
  Relaxed flow(const RelaxOptions& options);
  void soften(double share);
  Relaxed rigid(const RelaxOptions& options, bool flows);
  Relaxed equilibrium(const RelaxOptions& options, bool flows);
  /// @param turned guides slip by the tensions at its end alone, after those before had another direction
  void commit(PathStep& result, bool turned);

  const RodModel* model_;
  RodWork work_;
  std::vector<Segment> segments_;
  std::vector<Chain> chains_;
  std::vector<TendonInput> inputs_;
  State now_;

  bool potential_ = true;
  int first_iterations_ = 0;  ///< of the first round of the last equilibrium
  int columns_ = 0, stride_ = 8, negative_ = 0;
  bool same_sign_ = true;  ///< of the Jacobian's determinant as of the unloaded rod's
  double drag_ = 0;        ///< of a motion away from `anchor_`
  std::vector<double> fed_, side_, start_, anchor_;
  Eigen::VectorXd change_;                                  ///< of tensions
  Eigen::MatrixXd small_, length_answers_, angle_answers_;  ///< of lengths and angles to tensions
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace sinew::inline v1::strain
