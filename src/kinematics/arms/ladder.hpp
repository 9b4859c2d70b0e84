/// @file ladder.hpp
/// Which polynomials an arm's equilibrium is found with: coarse ones first, finer ones until the tip stays
/// where it is. Whoever solves, one arm or several at once, asks the ladder for its next step and tells it
/// what came of it. Theory: docs/theory/strain_rod.md
#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "sinew/kinematics/arm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1 {

/// Orders and elements of polynomials.
struct Resolution {
  int order;  ///< −1: the model's, which has one less of what is stiff
  int elements;
};

/// What a model is refined by, coarse to fine, in order and elements alike, so that a step tells what either
/// of them was off; empty where it has one resolution.
std::span<const Resolution> resolutions_of(const ArmOptions& options);
/// How many levels these options have: 1 where the resolution is given. Level 2 k is the k-th resolution, and
/// between two of them is the finer one's elements with the coarser one's order, which often does as well.
int level_count(const ArmOptions& options);
/// Order and elements of a level, where there are several.
Resolution resolution_at(const ArmOptions& options, int level);
/// Of bending and torsion what is not constant along a piece, over √(EI/L): what errors come from. The
/// highest modes alone would not tell: by symmetry they may be next to none.
double size_of_variation(const strain::RodModel& model, const std::vector<double>& y);

/// Says so where an error is far from the accuracy that was asked: `stalled`.
/// @param error that the finest polynomials leave [m]
/// @param accuracy that was asked, over that length
/// @param length of an arm, or the size of legs [m]
/// @param what is moved by that error, in words
void report_coarse(double error, double accuracy, double length, std::string_view what, Report& report);
/// Whether a report is that: there is an equilibrium, and looking for another one does not help.
bool is_coarse(const Report& report);

/// What the last question leaves to the next one.
struct Rung {
  int level = -1;    ///< what the last answer was found with; −1: there is none
  double told = 0;   ///< how far its tip may be off [m]
  double power = 4;  ///< of the elements' length with which errors fall [1]

  /// @name Of the answer whose error was looked at last
  /// @{
  int checked_level = -1;    ///< −1: there is none to go by
  double checked_size = 0;   ///< size_of_variation()
  double checked = 0;        ///< the error [m]
  strain::Three error = {};  ///< what the tip lacks [m]
  std::vector<double> checked_y;
  double weight = 0;  ///< of differences of the variation in ways from it
  double slope = 0;   ///< how fast the error changed on such ways [m]
  double reach = 0;   ///< ways on which that may be relied upon
  /// @}
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
    const strain::RodModel& model;
    std::span<const double> y;  ///< stays until another solve at this level
    strain::Three tip;
  };

  /// @param length of the arm [m]
  ResolutionLadder(const ArmOptions& options, double length, Rung& rung);

  /// The first step: a solve.
  /// @param warm the rung's answer is known
  /// @param size size_of_variation() of that answer
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
  /// How far the tip moves between two numbers of elements.
  struct Move {
    double fewer = 0, more = 0;
    double size = 0;  ///< [m]; 0: not known
  };
  void watch(double moved);
  void stand(const Solved& solved);
  Step go_on();
  Step beyond();
  bool is_near();
  double way_from_checked() const;
  void know(const strain::Three& error, double size);
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
  int next_ = 0;                             ///< the level that is compared with
  const strain::RodModel* model_ = nullptr;  ///< of what stands
  std::span<const double> y_;                ///< of what stands
  strain::Three tip_{};                      ///< of what stands [m]
  Move last_move_ = {}, move_before_ = {};
  double ratio_ = 1, left_ = 0;  ///< of errors; what the finer one is off [m]
  strain::Three reference_{};    ///< the tip that a leaner one is to meet [m]
  strain::Three left_by_{};      ///< what the finer one's tip lacks [m]
  double off_ = 0;               ///< by how much that is off at most [m]
};

}  // namespace sinew::inline v1
