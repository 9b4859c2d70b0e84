/// @file relax.hpp
/// Equilibria of a rod with tendons: Newton's steps in a trust region of the energy; where a load has no
/// potential, Newton's steps that lower the residual. Theory: docs/theory/strain_rod.md
#pragma once
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "sinew/solve/report.hpp"
#include "strain/condense.hpp"
#include "strain/rod_model.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1::strain {

/// What holds a tendon: its tension, or its end, so that it pulls by what it is longer than its free length.
struct TendonHold {
  bool by_tension = true;
  double tension = 0;      ///< [N], where it is held
  double free_length = 0;  ///< from the base, unstretched [m]
  double compliance = 0;   ///< of the whole tendon [m/N]; 0: it does not stretch
  double toe = 0;          ///< up to this stretch the tension grows with its square [m]; 0: linearly at once
};

struct RelaxOptions {
  int max_iterations = 200;
  double tolerance = 1e-10;  ///< of the gradient, over √(EI/L)
  bool leave_saddles = true;
  bool may_grow = true;  ///< where all else fails loads and inputs grow from nothing: from wherever it began
  std::function<bool()> stop;
};

struct Relaxed {
  Status status = Status::converged;
  int iterations = 0, evaluations = 0;
  double residual = 0;  ///< of the gradient, over √(EI/L)
  int negative = 0;     ///< directions in which the energy falls
  double reached = 1;   ///< share of loads and inputs up to which equilibria were found
  bool grew = false;    ///< loads and inputs grew from nothing
};

/// After each round of a search that has not found its end: whether it ends nevertheless, and why.
/// @param spent what it may cost is used up, whatever the bound on iterations
inline bool must_end(Relaxed& result, const RelaxOptions& options, bool spent = false) {
  if (!std::isfinite(result.residual))
    result.status = Status::left_domain;
  else if (result.iterations >= options.max_iterations || spent)
    result.status = Status::iteration_limit;
  else if (options.stop && options.stop())
    result.status = Status::stopped;
  else
    return false;
  return true;
}

/// Whether the coordinates of one rod are the first of each component of another, finer one.
bool is_within(const RodModel& from, const RodModel& to);
/// Coordinates of one rod in another, where either is within the other: what both have; 0 beyond.
void take_shared(const RodModel& from, std::span<const double> y, const RodModel& to, std::span<double> out);

/// Of every piece, size × padded: the elastic Hessian of a rod less that of one with the same coordinates and
/// fewer elements.
std::vector<std::vector<double>> elastic_difference(const RodModel& model, const RodModel& fewer);

/// How far the equilibrium of a finer rod is off that of a coarse one.
struct Approach {
  bool close = false;  ///< it is known; else steps did not become shorter soon enough
  int iterations = 0;
  Three tip{};       ///< the finer rod's [m]
  double rest = 0;   ///< what the steps may still lack of it [m]
  double moved = 0;  ///< from the coarse rod's tip, that included [m]
};

/// The rod, its tendons and their memory.
class LoadedRod {
 public:
  explicit LoadedRod(const RodModel& model);
  LoadedRod(const LoadedRod&) = delete;
  LoadedRod& operator=(const LoadedRod&) = delete;

  const RodModel& model() const { return *model_; }
  RodWork& work() { return work_; }
  const RodWork& work() const { return work_; }

  std::vector<TendonHold> holds;
  /// Tensions that the next `relax` may begin with, as those of another rod of the same arm.
  void expect(std::span<const double> tensions) { expected_.assign(tensions.begin(), tensions.end()); }
  /// From the coordinates that stand in `work().y`.
  Relaxed relax(const RelaxOptions& options);
  /// Newton's steps of relax() take the Hessian of another rod from now on: the same coordinates and loads,
  /// fewer elements. Equilibria do not depend on it, nor does whether they hold: where that Hessian is not
  /// positive definite, this rod's own is taken.
  void lean_on(LoadedRod& fewer);
  /// From the equilibrium of a coarse rod towards this one's by that one's last factors, so that only
  /// gradients are made; what the coarse one lacks answers by its elastic energy. This tells how far the tip
  /// moves, to a twentieth or to `enough` [m].
  Approach approach(LoadedRod& coarse, double enough);
  /// Frames, lengths and tensions at `work().y`; returns the potential of rod and tendons [J].
  double evaluate();
  /// After evaluate(): gradient, and the Hessian's terms.
  void linearise(bool hessian);
  /// Factors the Hessian with all tendons that pull by their stretch, after relax() with what they truly give
  /// way by; the number of negative directions, or −1.
  int factor_all(double shift);
  /// Solves with what factor_all left; a row a coordinate.
  /// @param pulls if not null: by how much the tensions of `active()` change, a row each, `stride` apart
  void solve_all(std::span<double> sides, int columns, int stride, double* pulls = nullptr);
  /// Tendons that factor_all took as pulling by their stretch.
  std::span<const int> active() const { return active_; }
  /// How coordinates and tensions of `active()` change with the free length of its k-th tendon.
  void answer_to_feed(int k, std::span<double> step, std::span<double> pulls) const;
  /// Of rod and tendons, after evaluate() [J].
  double potential() const { return potential_energy_; }
  bool has_potential() const { return potential_; }
  /// Of the tendons [N].
  std::span<const double> tensions() const { return tensions_; }
  /// What a tendon is longer than it needs to be [m]; 0 where it is taut.
  double slack(std::size_t tendon) const;
  /// What a tendon held by its end is too short by, where relax() found it unreachable [m].
  double lacks(std::size_t tendon) const;
  /// The least ratio of the energy's second variation to the elastic one, with its direction: without load 1,
  /// at any resolution. Below 0 it is the ratio in the direction of the Hessian's lowest eigenvalue. Tendons
  /// that are exactly at rest resist where they would be longer, so that its sign matters.
  double lowest(std::span<double> direction);
  /// The last lowest() is a lower bound: too many tendons are at rest, and none of them was counted.
  bool is_bound() const { return is_bound_; }
  /// Held by its end, and neither taut nor slack but for rounding.
  bool at_rest(std::size_t tendon) const;

 private:
  void spread_tensions();
  void take_holds();
  bool pulls_like(const LoadedRod& other) const;
  void take_hessian_of_lean();
  /// How a tendon gives way at its stretch: its derivative by the tension [m/N].
  double give(std::size_t tendon) const;
  double slope_of_toe(std::size_t tendon) const;
  /// A step downhill.
  struct Descent {
    int negative = 0;      ///< directions in which the energy falls, with the tendons assumed
    double shift = 0;      ///< of the Hessian
    double surplus = 0;    ///< what the model's energy is more than its equation says [J]
    double predicted = 0;  ///< what the energy is to fall by [J]
    bool factored = true;  ///< what factor_all left is of this step
  };
  bool newton_step(double radius, std::span<double> step, Descent& descent);
  bool step_with_assumed(double radius, std::span<double> step, Descent& descent);
  double beyond(std::size_t tendon) const;
  double foreseen(std::span<const double> step, const Descent& descent);
  void go_along_lowest(double length, std::span<double> step, Descent& descent);
  bool same_active() const;
  int factor_with_tendons(double shift);
  bool leave_saddle(Relaxed& result, double& energy);
  double restore();
  /// How far a search for the least energy is.
  struct EnergySearch {
    Relaxed result = {};
    double energy = 0, radius = 0;  ///< at hand [J]; of the trust region
    double before = 0;              ///< residual before the last step
    int forgiven = 0;               ///< steps that raised the gradient where the energy does not tell
    bool kept = false;              ///< a factor of a Hessian near by, positive definite
    bool swept = false;             ///< the Hessian at hand is of this iterate
    bool left_saddle = false;       ///< where no step was short enough
  };
  enum class StepEnd { accepted, refused, as_near_as_rounding_lets };
  Relaxed relax_energy(const RelaxOptions& options);
  bool ends_at_rest(const RelaxOptions& options, EnergySearch& search);
  bool is_worth_keeping(const RelaxOptions& options, const EnergySearch& search);
  void step_by_kept_factor(EnergySearch& search);
  bool try_step(const RelaxOptions& options, EnergySearch& search);
  StepEnd check_step(const RelaxOptions& options, const Descent& descent, double next, EnergySearch& search,
                     double& ratio);
  bool leaves_where_stuck(const RelaxOptions& options, const Descent& descent, EnergySearch& search);
  Relaxed relax_residual(const RelaxOptions& options, double shift);
  Relaxed relax_without_potential(const RelaxOptions& options);
  Relaxed search(const RelaxOptions& options);
  void find_yields();
  void elastic(std::span<const double> x, std::span<double> y) const;
  void soften(double share, std::span<const double> expected);
  Relaxed tighten(const RelaxOptions& options, double share, std::vector<double> expected);
  Relaxed grow(const RelaxOptions& options, double softness);
  bool check_stability(Relaxed& result);
  bool comes_back(const RelaxOptions& options, Relaxed& result);
  double gradient_norm() const;

  void solve_small(std::span<double> t) const;
  bool pulls(std::size_t tendon) const;
  std::span<const double> length_gradient(std::size_t tendon) const {
    return std::span(work_.length_gradient).subspan(tendon * work_.y.size(), work_.y.size());
  }
  /// With those tendons alone that count.
  /// @param square |direction|² per elastic energy
  double lowest_on_face(std::span<double> direction, double& square);

  bool potential_ = true;
  bool searches_ = false;  ///< tendons may be softened
  double potential_energy_ = 0;

  LoadedRod* lean_ = nullptr;
  bool leans_ = false;                        ///< in the relax() that goes on
  std::vector<std::vector<double>> elastic_;  ///< of every piece: elastic Hessian without that of lean_
  LoadedRod* factors_ = nullptr;              ///< the rod whose Hessian was factored last

  const RodModel* model_;
  RodWork work_;
  std::vector<double> tensions_,
      offsets_;                   ///< offsets: multipliers of tendons that do not stretch, as length [m]
  std::vector<double> stiff_;     ///< compliance used [m/N]
  std::vector<double> soft_;      ///< what of that is not the tendon's own [m/N]
  std::vector<double> yields_;    ///< what the rod, straight, gives way by to each tendon [m/N]
  std::vector<double> expected_;  ///< tensions to begin with [N]
  int left_ = 0;                  ///< Hessians and factors that a search may still take
  std::vector<int> active_;
  bool leaves_ = true;                ///< steps may leave a saddle where the gradient does not tell the way
  bool assumes_ = false;              ///< factor_all takes tendons as in assumed_, not as they are
  std::vector<char> assumed_, then_;  ///< tendons that a step takes as taut; that are after it
  std::vector<double> first_, best_, lowest_;  ///< steps
  std::vector<std::size_t> resting_;  ///< tendons at rest, while lowest() tries which of them become taut
  unsigned tautened_ = 0;             ///< a bit for each of them
  bool is_bound_ = false, is_one_sided_ = false;  ///< of the last lowest()
  double tolerance_ = 1e-10;                      ///< of the last relax()
  std::vector<double> columns_, small_, sides_;
  std::vector<double> trial_, step_;
  int stride_ = 8;
};

}  // namespace sinew::inline v1::strain
