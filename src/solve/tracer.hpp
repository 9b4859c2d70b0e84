/// @file tracer.hpp
/// One point after the other on the curve of N equations in N unknowns and a parameter λ, by predictor and
/// corrector in all N + 1 of them: through folds, where no path along λ goes on.
/// Theory: docs/theory/continuation.md
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "math/linalg.hpp"
#include "solve/continuation.hpp"
#include "solve/curve.hpp"

namespace sinew::inline v1 {

template <CurveProblem Problem>
class Tracer {
 public:
  static constexpr int N = Problem::unknowns;
  using Place = typename Problem::Place;
  /// Of the unknowns and of the parameter, all in metres.
  using Step = Vec<double, N + 1>;

  /// From where the problem is. @param before, origin memory
  Tracer(Problem problem, double parameter, Place& before, Place& origin)
      : problem_(problem),
        lambda_(parameter),
        before_(before),
        origin_(origin) {
    residual_ = problem_.evaluate();
    problem_.linearise();
    find_scale();
    find_tangent(Step::Unit(N));
    save(before_);
  }

  void save(Place& to) const {
    problem_.save(to.state);
    to.lambda = lambda_;
    to.tangent = tangent_;
  }
  void restore(const Place& from) {
    problem_.restore(from.state);
    lambda_ = from.lambda;
    tangent_ = from.tangent;
    residual_ = problem_.evaluate();
    problem_.linearise();
  }

  const Problem& problem() const { return problem_; }
  double lambda() const { return lambda_; }
  double size() const { return problem_.size(); }
  /// What counts as a length of λ [m].
  double scale() const { return scale_; }
  double residual() const { return residual_; }
  const Step& tangent() const { return tangent_; }
  double along() const { return tangent_[N]; }  ///< dλ/ds
  Place& before() { return before_; }
  int iterations() const { return iterations_; }  ///< Newton steps of all

  /// To a point so far along `direction`: predictor along the curve, or where that leads aside along
  /// `direction`, and corrector at right angles to it. False, and the state is lost, where there is none
  /// nearby.
  /// @param most that is corrected, of the stride: else it may have found another branch
  bool advance(const Step& direction, double stride, double most = 0.5) {
    const double along = dot(tangent_, direction);
    move(along > 0.5 ? Step(stride / along * tangent_) : Step(stride * direction));
    const int begun = iterations_;
    double moved = 0;
    const auto correct = [&] {
      return contract_onto([&] {
        const auto step = correction(direction);
        if (!step) return false;
        moved += step->norm();
        move(*step);
        return std::isfinite(lambda_);
      });
    };
    if (!correct() || !(moved < most * std::abs(stride) + 1e-9 * size())) return false;
    while (problem_.refine())
      if (!correct()) return false;
    corrections_ = iterations_ - begun;
    problem_.linearise();  // at fixed λ it may be singular here
    find_tangent(direction);
    return true;
  }
  int corrections() const { return corrections_; }

  /// Whether a pair of folds may hide in the stride from the place before to here: where λ grows far slower
  /// in its middle than at both ends, by the cubic through both, or slower and slower, or faster and faster.
  bool hides_folds(double stride) const {
    const double begin = before_.tangent[N], end = along() / dot(tangent_, before_.tangent);
    if (!(stride > shortest_verified * size()) || (begin > 0) != (end > 0)) return false;
    const double middle = 1.5 * (lambda_ - before_.lambda) * scale_ / stride - 0.25 * (begin + end);
    const double least = std::min(std::abs(begin), std::abs(end)),
                 most = std::max(std::abs(begin), std::abs(end));
    constexpr double steep = 0.1, ratio = 2.5;
    return (begin > 0 ? middle : -middle) < 0.5 * least || (least < steep && most > ratio * least);
  }

  /// A step along the curve from the place before, on which there is no sign of another curve. False, and the
  /// state is lost, where it must be shorter.
  bool step(double stride) {
    const Step ahead = before_.tangent;
    constexpr double max_turned = 0.9;  // its cosine
    return advance(ahead, stride) && dot(tangent_, ahead) > max_turned && !hides_folds(stride);
  }

  CurveSigns signs() const {
    CurveSigns signs = problem_.signs();
    signs.along = along();
    auto bordered = border(tangent_);
    const bool is_negative = determinant(MatrixView(bordered.data(), N + 1, N + 1)) < 0;
    signs.is_odd = is_negative != (signs.own % 2 == 1);
    return signs;
  }

  /// Singular values of [A c], and right singular vectors: the last along the curve, those before it with
  /// values near 0 along others that cross it here.
  struct NullSpace {
    Mat<double, N + 1, N + 1> vectors;
    int multiplicity = 0;  ///< of other curves
  };
  /// @param tolerance in the problem's own unit of A
  NullSpace null_space(double tolerance) const {
    const auto rows = problem_.equations(scale_);
    const auto decomposed = svd(MatrixView(rows.data(), N, N + 1));
    NullSpace space{decomposed.v(), 0};
    while (space.multiplicity < N &&
           decomposed.sigma()[index(N - 1 - space.multiplicity)] < tolerance * problem_.unit())
      ++space.multiplicity;
    return space;
  }

  /// To where `value` changes its sign between the place before, which moves along, and `stride` beyond it in
  /// its direction: just beyond. By the rule of false position (Illinois), or where it `is_smooth` no more
  /// than a sign by halving. How far that is; nothing, and the state is lost, where no such place is in
  /// between: the stride had left its curve.
  template <class Value>
  std::optional<double> locate(const Step& direction, double stride, Value&& value, bool is_smooth = true) {
    constexpr double finest = 1e-11;  // of the size
    origin_ = before_;
    restore(before_);
    double at_low = value(), low = 0, width = stride, other = 0.5;
    double at_high = -at_low;
    int side = 0;
    for (int k = 0; k < 200 && std::abs(width) > finest * size(); ++k) {
      const double guess = is_smooth && side != 0 ? at_low / (at_low - at_high) : 0.5;
      const double part = other < 0.5 ? other : std::clamp(guess, 0.01, 0.99);
      restore(before_);
      if (!advance(direction, part * width)) {
        // near to where the equations are singular: another place, and at last this bracket is all there is
        other -= 0.13;
        if (other < 0.1) break;
        continue;
      }
      other = 0.5;
      const double here = value();
      if (here == 0) return low + part * width;
      if ((here > 0) == (at_low > 0)) {
        low += part * width;
        width *= 1 - part;
        save(before_);
        at_low = here;
        if (side < 0) at_high /= 2;
        side = -1;
      } else {
        width *= part;
        at_high = here;
        if (side > 0) at_low /= 2;
        side = 1;
      }
    }
    if (std::abs(width) > shortest_verified * size()) return {};  // too wide a bracket to be believed
    // the last one, or as little more as it takes where the equations are singular
    const double widest = std::max(4 * width, 1e-5 * size());
    for (; width <= widest && low + width <= stride * (1 + 1e-9); width *= 1.5) {
      restore(before_);
      if (advance(direction, width) && (value() > 0) != (at_low > 0)) return low + width;
    }
    if (stride > shortest_verified * size()) return {};
    before_ = origin_;  // all that is known
    restore(before_);
    if (!advance(direction, stride)) return {};
    return stride;
  }

  /// Of the size: shorter strides are believed as they are.
  static constexpr double shortest_verified = 1e-4;

  /// Another curve that is near may cross this one, or pass by. At first it is taken to cross, and one goes
  /// straight on; looked at closely the tangent is that of the curve itself, until the other is far.
  void look_closely() {
    looks_closely_ = true;
    find_tangent(tangent_);
  }
  void look_farther() { looks_closely_ = looks_closely_ && null_space(near_singular).multiplicity > 0; }

  /// Exactly onto a parameter nearby.
  bool settle_at(double parameter) {
    lambda_ = parameter;
    problem_.put(lambda_);
    const auto step_along = [&] {
      const auto step = correction(Step::Unit(N));
      if (!step) return false;
      move(*step);
      lambda_ = parameter;
      problem_.put(lambda_);
      return true;
    };
    return contract_onto(step_along) && problem_.linearise();
  }

  /// To λ = `parameter`, passed over the stride from `begun` to here.
  std::optional<double> settle_between(const Place& begun, double stride, double parameter) {
    before_ = begun;
    const auto there = locate(begun.tangent, stride, [&] { return lambda_ - parameter; });
    return there && settle_at(parameter) ? there : std::nullopt;
  }

 private:
  using Unknowns = Vec<double, N>;
  static constexpr double near_singular = 1e-2;  ///< tolerance of null_space
  static constexpr std::size_t index(int k) { return static_cast<std::size_t>(k); }

  /// Unit vector along the curve, towards `ahead`: where others cross, what of it goes on.
  void find_tangent(const Step& ahead) {
    const NullSpace space = null_space(looks_closely_ ? 1e-7 : near_singular);
    Step sum = Step::Zero();
    for (int k = N - space.multiplicity; k <= N; ++k) {
      const Step v = space.vectors.col(k);
      sum += v * dot(v, ahead);
    }
    tangent_ = sum.norm() > 1e-3 ? Step(sum.normalized()) : Step(space.vectors.col(N));
    if (dot(tangent_, ahead) < 0) tangent_ = -tangent_;  // just before a fold λ hardly grows
  }

  template <class Advance>
  bool contract_onto(Advance&& take_step) {
    const auto error = [&] { return residual_ = problem_.evaluate(); };
    return contract(error, take_step, problem_.tolerance(), problem_.rounding(), iterations_, residual_);
  }

  void move(const Step& step) {
    const double change = step[N] / scale_;
    problem_.move(Unknowns(step.template head<N>()), lambda_, change);
    lambda_ += change;
  }

  std::array<double, index((N + 1) * (N + 1))> border(const Step& row) const {
    std::array<double, index((N + 1) * (N + 1))> bordered;
    const auto rows = problem_.equations(scale_);
    std::ranges::copy(row, std::ranges::copy(rows, bordered.begin()).out);
    return bordered;
  }

  /// Newton's step at right angles to `direction`, from the point last evaluated.
  std::optional<Step> correction(const Step& direction) {
    problem_.linearise();
    auto matrix = border(direction);
    Step wanted, step;
    wanted << problem_.residual(), 0;
    if (!solve(MatrixView(matrix.data(), N + 1, N + 1), MatrixView(wanted.data(), N + 1, 1),
               std::span(step.data(), index(N + 1))))
      return {};
    return step.allFinite() && step.norm() < size() ? std::optional(step) : std::nullopt;
  }

  /// A parameter as long as what it moves at the beginning, within bounds.
  void find_scale() {
    const auto rows = problem_.equations(scale_);
    Eigen::Matrix<double, N, N + 1, Eigen::RowMajor> all(rows.data());
    Eigen::Matrix<double, N, N, Eigen::RowMajor> matrix = all.template leftCols<N>();
    Unknowns column = all.col(N), moved;
    const bool is_regular = solve(MatrixView(matrix.data(), N, N), MatrixView(column.data(), N, 1),
                                  std::span(moved.data(), index(N)));
    double square = 0;
    for (int k = 0; is_regular && k < N; ++k) square += moved[k] * moved[k];
    scale_ = std::clamp(std::sqrt(square), 0.01 * size(), problem_.longest_scale());
  }

  Problem problem_;
  double lambda_, scale_ = 1, residual_ = 0;
  Step tangent_ = Step::Unit(N);
  Place &before_, &origin_;
  int iterations_ = 0, corrections_ = 0;
  bool looks_closely_ = false;
};

}  // namespace sinew::inline v1
