/// @file ladder.hpp
/// Which polynomials an arm's equilibrium is found with: coarse ones first, finer ones until the tip stays
/// where it is. Whoever solves, one arm or several at once, asks the ladder for its next step and tells it
/// what came of it. Theory: docs/theory/strain_rod.md
#pragma once
#include <array>

#include "sinew/kinematics/arm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1 {

/// Orders and elements of polynomials.
struct Resolution {
  int order;  ///< −1: the model's, which has one less of what is stiff
  int elements;
};

/// How many levels these options have: 1 where the resolution is given.
int level_count(const ArmOptions& options);
/// Order and elements of a level, where there are several.
Resolution resolution_at(const ArmOptions& options, int level);
/// Of the highest modes of bending: what a polynomial of this order may lack.
double size_of_highest(const strain::RodModel& model, const std::vector<double>& y);

/// What the last question leaves to the next one.
struct Rung {
  int level = -1;           ///< what the last answer was found with; −1: there is none
  double checked_size = 0;  ///< size of the highest modes when the resolution was last checked
  double checked = 0;       ///< what that check gave [m]
};

class ResolutionLadder {
 public:
  struct Step {
    enum class Kind {
      answer,  ///< what was found at the level of the rung is the answer
      solve,   ///< an equilibrium at `level`, from the coordinates that `from` has
      compare  ///< the equilibrium at `from` with what `level` makes of it: LoadedRod::approach
    } kind;
    int level = 0, from = 0;
  };
  /// What came of a solve.
  struct Solved {
    bool converged;
    double size;  ///< size_of_highest()
    strain::Three tip;
  };

  /// @param length of the arm [m]
  ResolutionLadder(const ArmOptions& options, double length, Rung& rung);

  /// The first step: a solve.
  /// @param warm the rung's answer is known
  /// @param size size_of_highest() of that answer
  Step begin(bool warm, double size);
  Step after_solve(const Solved& solved);
  Step after_comparison(const strain::Approach& near);

  /// Whether the last solve is what now stands for an answer, at the level of the rung.
  bool stands() const { return stands_; }
  bool refines() const { return refines_; }
  /// The error of the tip that is wanted at most [m].
  double wanted() const { return wanted_; }

 private:
  /// What the solve that goes on is for.
  enum class Aim {
    answer,         ///< to stand for an answer
    leaner,         ///< whether the order before does with more elements, after a comparison
    finer,          ///< to be compared
    leaner_at_last  ///< as `leaner`, after a solve of the finer one
  };
  Step go_on();
  Step beyond();
  bool leaner_does(const Solved& solved);
  Step answer() const { return {Step::Kind::answer, rung_->level, rung_->level}; }
  Step aim(Aim what, int level, int from) {
    aim_ = what;
    return {Step::Kind::solve, level, from};
  }

  ArmOptions options_;
  double length_, wanted_;
  int count_;
  bool refines_;
  Rung* rung_;
  bool knows_ = false;  ///< how large the error is, from the question before
  bool stands_ = false;
  Aim aim_ = Aim::answer;
  int next_ = 0;                 ///< the level that is compared with
  double size_ = 0;              ///< of what stands
  strain::Three tip_{};          ///< of what stands [m]
  strain::Approach near_ = {};   ///< the last comparison
  double ratio_ = 1, left_ = 0;  ///< of errors; what the finer one is off [m]
  strain::Three reference_{};    ///< the tip that a leaner one is to meet [m]
  double off_ = 0;               ///< by how much that is off at most [m]
};

}  // namespace sinew::inline v1
