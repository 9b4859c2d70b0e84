/// @file tracer.hpp
/// One point after the other on a curve of equilibria, by predictor and corrector in the six unknowns of the
/// platform and the parameter together. Theory: docs/theory/rod_robot.md
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/at.hpp"
#include "kinematics/rods/trace.hpp"

namespace sinew::inline v0 {

/// What decides where something happened between two points of a curve.
struct CurveSigns {
  double along = 0;     ///< dλ/ds
  int unstable = 0;     ///< directions, of the whole robot
  int own = 0;          ///< ... of its rods, tips held
  bool is_odd = false;  ///< the sign of the bordered determinant, without the rods' own poles
};

template <class System>
class Tracer {
 public:
  /// A step of the six unknowns, twist or lengths, and of the parameter, all in metres.
  using Step = Vec<double, 7>;

  /// In the first two places of `work`.
  Tracer(RodWorkOf<System>& work, const RodWay& way, double parameter)
      : system_(work.system),
        way_(way),
        lambda_(parameter),
        before_(work.places[0]),
        origin_(work.places[1]) {
    for (int k = 0; k < system_.rods(); ++k) {
      const double length = system_.length(k);
      size_ = std::max(size_, length);
      unit_ += system_.stiffness(k) / (length * length * length);
    }
    system_.evaluate();
    system_.linearise();
    find_scale();
    find_tangent(Step::Unit(6));
    save(before_);
  }

  using Place = RodPlace<System>;

  void save(Place& to) const {
    system_.save(to.state);
    to.lambda = lambda_;
    to.tangent = tangent_;
  }
  void restore(const Place& from) {
    system_.restore(from.state);
    lambda_ = from.lambda;
    tangent_ = from.tangent;
    system_.evaluate();
    system_.linearise();
  }

  double lambda() const { return lambda_; }
  double size() const { return size_; }
  /// What counts as a length of λ [m].
  double scale() const { return scale_; }
  double residual() const { return residual_; }
  const Step& tangent() const { return tangent_; }
  Place& before() { return before_; }

  /// To a point so far along `direction`: predictor along the curve, or where that leads aside along
  /// `direction`, and corrector at right angles to it. False, and the state is lost, where there is none
  /// nearby.
  /// @param most that is corrected, of the stride: else it may have found another branch
  bool advance(const Step& direction, double stride, double most = 0.5) {
    const double along = dot(tangent_, direction);
    move(along > 0.5 ? Step(stride / along * tangent_) : Step(stride * direction));
    int iterations = 0;
    double moved = 0;
    const auto correct = [&] {
      return contract_onto(
          [&] {
            const auto step = correction(direction);
            if (!step) return false;
            moved += step->norm();
            move(*step);
            return std::isfinite(lambda_);
          },
          iterations);
    };
    if (!correct() || !(moved < most * std::abs(stride) + 1e-9 * size_)) return false;
    while (!system_.is_finest() && system_.truncation() > coarse_truncation) {
      system_.refine();
      if (!correct()) return false;
    }
    corrections_ = iterations;
    system_.linearise();  // the platform's own stiffness may be singular here
    find_tangent(direction);
    return true;
  }
  int corrections() const { return corrections_; }

  /// Whether a pair of folds may hide in the stride from the place before to here: where λ grows far slower
  /// in its middle than at both ends, by the cubic through both, or slower and slower, or faster and faster.
  bool hides_folds(double stride) const {
    const double begin = before_.tangent[6], end = tangent_[6] / dot(tangent_, before_.tangent);
    if (!(stride > shortest_verified * size_) || (begin > 0) != (end > 0)) return false;
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
    constexpr double most_turned = 0.9;  // its cosine
    return advance(ahead, stride) && dot(tangent_, ahead) > most_turned && !hides_folds(stride);
  }

  CurveSigns signs() {
    CurveSigns signs;
    signs.along = tangent_[6];
    signs.unstable = unstable_directions(system_);
    for (int k = 0; k < system_.rods(); ++k) {
      const auto [in_plane, aside] = system_.unstable_with_tip_held(k);
      signs.own += in_plane + aside;
    }
    std::array<double, 49> bordered;
    border(tangent_, bordered);
    signs.is_odd = (determinant(MatrixView(bordered.data(), 7, 7)) < 0) != (signs.own % 2 == 1);
    return signs;
  }

  /// Singular values of [A c], and right singular vectors: the last along the curve, those before it with
  /// values near 0 along others that cross it here.
  struct NullSpace {
    Mat<double, 7, 7> vectors;
    int multiplicity = 0;  ///< of other curves
  };
  /// @param tolerance in the rods' own unit of stiffness, EI/L³
  NullSpace null_space(double tolerance) const {
    const std::array<double, 42> rows = equations();
    const auto decomposed = svd(MatrixView(rows.data(), 6, 7));
    NullSpace space{decomposed.v(), 0};
    while (space.multiplicity < 6 && decomposed.sigma()[at(5 - space.multiplicity)] < tolerance * unit_)
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
    for (int k = 0; k < 200 && std::abs(width) > finest * size_; ++k) {
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
    // the last bracket, or as little more as it takes where the equations are singular
    const double widest = std::max(4 * width, 1e-5 * size_);
    for (; width <= widest && low + width <= stride * (1 + 1e-9); width *= 1.5) {
      restore(before_);
      if (advance(direction, width) && (value() > 0) != (at_low > 0)) return low + width;
    }
    if (stride > shortest_verified * size_) return {};
    before_ = origin_;  // all that is known
    restore(before_);
    if (!advance(direction, stride)) return {};
    return stride;
  }

  /// Of the size: shorter strides are believed as they are.
  static constexpr double shortest_verified = 1e-4;

  /// Exactly onto a parameter nearby.
  bool settle_at(double parameter) {
    lambda_ = parameter;
    put();
    int iterations = 0;
    const Step along = Step::Unit(6);
    const auto step_along = [&] {
      const auto step = correction(along);
      if (!step) return false;
      move(*step);
      lambda_ = parameter;
      put();
      return true;
    };
    return contract_onto(step_along, iterations) && system_.linearise();
  }

 private:
  using Twist = Vec<double, 6>;
  /// Unit vector along the curve, towards `ahead`: where others cross, what of it goes on.
  void find_tangent(const Step& ahead) {
    const NullSpace space = null_space(1e-2);
    Step sum = Step::Zero();
    for (int k = 6 - space.multiplicity; k <= 6; ++k) {
      const Step v = space.vectors.col(k);
      sum += v * dot(v, ahead);
    }
    tangent_ = sum.norm() > 1e-3 ? Step(sum.normalized()) : Step(space.vectors.col(6));
    if (dot(tangent_, ahead) < 0) tangent_ = -tangent_;  // just before a fold λ hardly grows
  }

  /// A pose that is held is known to rounding, which stiff rods turn into forces.
  double tolerance() const { return way_.holds_pose ? rod_quick_tolerance : rod_tolerance; }

  /// Newton's method as long as each step halves the error. No step where it is small enough: near to where
  /// the equations are singular it would be one in the dark.
  template <class Advance>
  bool contract_onto(Advance&& take_step, int& iterations) {
    residual_ = system_.evaluate();
    for (int k = 0; k < 12 && !(residual_ <= tolerance()); ++k) {
      if (!take_step()) return false;
      ++iterations;
      const double next = system_.evaluate();
      if (!(next < 0.5 * residual_) && !(next <= tolerance())) return false;
      residual_ = next;
    }
    return residual_ <= tolerance();
  }

  /// Lengths, wrench and held pose as λ has them: what a step moved by increments, exactly.
  void put() {
    const RodTarget now = way_.at(lambda_, system_.feeds());
    system_.set_wrench(now.wrench);
    if (way_.holds_pose)
      system_.set_platform(way_.pose(lambda_));
    else
      for (int k = 0; k < system_.feeds(); ++k) system_.set_length(k, now.lengths[at(k)]);
  }

  void move(const Step& step) {
    const double change = step[6] / scale_;
    std::array<double, max_rods> fed{};
    Twist twist = Twist::Zero();
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) fed[at(k)] = step[k];
      twist = between(system_.platform(), way_.pose(lambda_ + change));
    } else {
      twist = step.head<6>();
      twist.tail<3>() /= system_.radius();
      for (int k = 0; k < system_.feeds(); ++k) fed[at(system_.input_of(k))] = change * rate(k);
    }
    lambda_ += change;
    system_.move(twist, std::span<const double>(fed).first(at(system_.inputs())));
    put();
  }

  /// dL/dλ of a rod.
  double rate(int rod) const { return way_.target.lengths[at(rod)] - way_.begin.lengths[at(rod)]; }

  /// [A c], rows first: what the unknowns, and λ, each in metres, do to the balance of forces and, over the
  /// platform's radius, of moments. After `linearise`.
  std::array<double, 42> equations() const {
    const double radius = system_.radius();
    std::array<double, 42> rows;
    const auto put_column = [&](int column, const Twist& wrench, double per) {
      for (int r = 0; r < 6; ++r) rows[at(7 * r + column)] = wrench[r] / (r < 3 ? per : per * radius);
    };
    const auto stiffness = system_.stiffness();
    Twist by_parameter = system_.felt(way_.begin.wrench - way_.target.wrench);
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) put_column(k, system_.feed_wrench(k), 1);
      by_parameter += stiffness * between(way_.from, way_.to);
    } else {
      for (int k = 0; k < 6; ++k) put_column(k, stiffness.col(k), k < 3 ? 1 : radius);
      for (int input = 0; input < system_.inputs(); ++input)
        for (int rod = 0; rod < system_.feeds(); ++rod)
          if (system_.input_of(rod) == input) {
            by_parameter += rate(rod) * system_.feed_wrench(input);
            break;
          }
    }
    put_column(6, by_parameter, scale_);
    return rows;
  }

  void border(const Step& row, std::array<double, 49>& to) const {
    const auto rows = equations();
    std::ranges::copy(rows, to.begin());
    for (int k = 0; k < 7; ++k) to[at(42 + k)] = row[k];
  }

  /// Newton's step at right angles to `direction`, from the point last evaluated.
  std::optional<Step> correction(const Step& direction) {
    system_.linearise();
    std::array<double, 49> matrix;
    border(direction, matrix);
    std::array<double, 7> wanted{};
    const Twist missing = system_.missing();
    for (int r = 0; r < 6; ++r) wanted[at(r)] = missing[r] / (r < 3 ? 1 : system_.radius());
    Step step;
    if (!solve(MatrixView(matrix.data(), 7, 7), MatrixView(wanted.data(), 7, 1), std::span(step.data(), 7)))
      return {};
    return step.allFinite() && step.norm() < size_ ? std::optional(step) : std::nullopt;
  }

  /// A parameter as long as what it moves at the beginning, within bounds.
  void find_scale() {
    const auto rows = equations();
    std::array<double, 36> matrix;
    std::array<double, 6> column{}, moved{};
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) matrix[at(6 * r + c)] = rows[at(7 * r + c)];
      column[at(r)] = rows[at(7 * r + 6)];
    }
    double length = 0;
    if (solve(MatrixView(matrix.data(), 6, 6), MatrixView(column.data(), 6, 1), moved))
      for (const double x : moved) length += x * x;
    double fed = 0;
    for (int k = 0; k < system_.feeds(); ++k) fed = std::max(fed, std::abs(rate(k)));
    const Twist load = way_.target.wrench - way_.begin.wrench;
    const double pressed =
        size_ * std::hypot(load.template head<3>().norm(), load.template tail<3>().norm() / system_.radius());
    scale_ = std::clamp(std::sqrt(length), 0.01 * size_, std::max(size_, fed + pressed / (unit_ * size_)));
  }

  System& system_;
  const RodWay& way_;
  double lambda_, scale_ = 1, size_ = 0, unit_ = 0, residual_ = 0;
  Step tangent_ = Step::Unit(6);
  Place &before_, &origin_;
  int corrections_ = 0;
};

}  // namespace sinew::inline v0
