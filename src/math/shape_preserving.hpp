/// @file shape_preserving.hpp
/// Curves through given points that do not overshoot: each coordinate stays between its values at the two
/// points around. Cubics whose slopes are continuous: F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5
/// (1984) 300.
#pragma once
#include <cstddef>
#include <vector>

namespace sinew::inline v1 {

class ShapePreservingCurve {
 public:
  /// @param parameters of the points, each greater than the one before
  /// @param values a row a point, as many as there are coordinates
  ShapePreservingCurve(std::vector<double> parameters, std::vector<double> values);

  std::size_t coordinates() const { return coordinates_; }
  std::size_t pieces() const { return parameters_.size() < 2 ? 0 : parameters_.size() - 1; }
  /// Where a piece begins; of the number of pieces, where the last ends.
  double knot(std::size_t piece) const { return parameters_[piece]; }

  /// @name A coordinate on the cubic of a piece, also beyond its ends, and its derivatives
  /// @{
  double value(std::size_t piece, std::size_t coordinate, double parameter) const;
  double first_derivative(std::size_t piece, std::size_t coordinate, double parameter) const;
  double second_derivative(std::size_t piece, std::size_t coordinate, double parameter) const;
  /// @}

 private:
  /// Of a + b t + c t² + d t³, t from the piece's beginning.
  struct Cubic {
    double a, b, c, d;
  };
  const Cubic& cubic(std::size_t piece, std::size_t coordinate) const {
    return cubics_[piece * coordinates_ + coordinate];
  }

  std::vector<double> parameters_;
  std::size_t coordinates_;
  std::vector<Cubic> cubics_;
};

}  // namespace sinew::inline v1
