/// @file planar_sextic.hpp
/// Three distance legs: the platform angles at which they can close, and the poses there.
/// Theory: docs/theory/assembly_modes.md
#pragma once
#include <array>

#include "leg/platform_constraint.hpp"
#include "math/polynomial.hpp"
#include "sinew/math/se2.hpp"

namespace sinew::inline v1 {

/// Three legs in units of their size. The first has its anchor and its platform point at the origin, so that
/// the pose is (s, R) with |s| = `length`, and leg i closes where |s + wᵢ| is its distance, wᵢ = R bᵢ − aᵢ.
class Sextic {
 public:
  Sextic() = default;
  Sextic(double length, const PlatformConstraint<2>& second, const PlatformConstraint<2>& third);

  /// Largest |F(φ)| against the terms it is the difference of: 0 where every φ is a root.
  double strength() const { return strength_; }

  /// Calls `add(SE2<double>)` with every pose that closes the legs, some of them more than once, and with the
  /// remains of searches that did not.
  template <class Add>
  void each_pose(const Add& add) const {
    for (const PolynomialRoot& root : roots()) {
      const SE2<double> turn = at(root.x);
      each_start(turn, add);
      if (!root.touches) continue;
      // Where modes merge, φ is known to half the digits or fewer: Newton from outside finds either one.
      for (const double apart : {1e-5, -1e-5, 1e-3, -1e-3}) each_start(turn.displaced({0, 0, apart}), add);
    }
  }

 private:
  using V = Vec2<double>;

  struct Starts {
    int count = 0;
    std::array<V, 10> direction;  ///< of s
  };

  /// Closures of the other two legs, by (direction of s, φ).
  struct Closure {
    Vec2<double> residual;
    Mat<double, 2, 2> jacobian;
    double error = 0;
  };

  template <class Add>
  void each_start(const SE2<double>& turn, const Add& add) const {
    const Starts starts = directions(turn);
    for (int i = 0; i < starts.count; ++i)
      add(closed({length_ * starts.direction[static_cast<std::size_t>(i)], turn.c, turn.s}));
  }

  V w(std::size_t i, const SE2<double>& turn) const {
    return turn.rotate(leg_[i].platform_point) - leg_[i].anchor;
  }
  /// e of 2 w·s + e = 0, the difference of |s + wᵢ| = its distance and |s| = length.
  double e(std::size_t i, const V& wi) const {
    return squared_norm(wi) + (length_ - leg_[i].distance) * (length_ + leg_[i].distance);
  }

  /// φ at T = tan(½(φ − origin)).
  SE2<double> at(double T) const;
  PolynomialRoots roots() const;
  std::array<double, 7> coefficients() const;
  Starts directions(const SE2<double>& turn) const;
  Closure closure(const SE2<double>& pose) const;
  SE2<double> closed(SE2<double> pose) const;

  double length_ = 0;
  std::array<PlatformConstraint<2>, 2> leg_{};
  double strength_ = 0;
  double origin_c_ = 1, origin_s_ = 0;  ///< φ of T = 0; T = ∞ is opposite, where |F| is largest
};

}  // namespace sinew::inline v1
