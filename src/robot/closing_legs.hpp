/// @file closing_legs.hpp
/// Legs that close on a platform beside rods: what they forbid it, and what holding it there does to its
/// balance. Theory: docs/theory/mixed_robot.md
#pragma once
#include <vector>

#include "sinew/base/limits.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/robot/any_robot.hpp"

namespace sinew::inline v0 {

/// One leg that closes, and where it stands in the robot.
struct ClosingLeg {
  AnySpatialLeg leg;
  LegPlace place;
  int index = 0;  ///< among the robot's legs
};

/// Most rows of all closing legs: more than a platform has freedoms, as several may forbid the same.
inline constexpr int max_closing_rows = max_rows;

using ClosingMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, max_closing_rows, max_rows>;

/// Rows and their derivatives, each divided by the length of its direction at that pose: in metres.
struct ClosingRows {
  int count = 0;
  Vec<double, max_closing_rows> gap = Vec<double, max_closing_rows>::Zero();  ///< [m]
  Mat<double, max_closing_rows, 6> by_platform = Mat<double, max_closing_rows, 6>::Zero();
  Vec<double, max_closing_rows> scale =
      Vec<double, max_closing_rows>::Zero();  ///< what each was multiplied by
  ClosingMatrix by_input;                     ///< rows × the robot's inputs
};

class ClosingLegs {
 public:
  ClosingLegs(std::vector<ClosingLeg> legs, int inputs);  ///< allocates

  std::span<const ClosingLeg> legs() const { return legs_; }
  int rows() const { return rows_; }
  /// Their own inputs, one after the other: how many, and which of the robot's each is.
  int feeds() const { return static_cast<int>(input_of_.size()); }
  int input_of(int feed) const { return input_of_[static_cast<std::size_t>(feed)]; }
  bool in_domain(int feed, double value) const;

  /// Inputs that close all legs at this pose, each leg nearest to what it has; false where one cannot.
  bool close_at(const SE3<double>& platform, std::span<double> feeds) const;

  void rows_at(const SE3<double>& platform, std::span<const double> feeds, ClosingRows& rows) const;

  /// What the wrench of the forces μ of the rows [N] changes by when the platform moves and when an input
  /// changes: the rows' second derivatives. Columns of `by_input`: the robot's inputs.
  void force_change(const SE3<double>& platform, std::span<const double> feeds, const ClosingRows& rows,
                    const Vec<double, max_closing_rows>& force, Mat<double, 6, 6>& by_platform,
                    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows>& by_input) const;

  /// Link coordinates among those of the robot, from the inputs and back.
  void get_coordinates(std::span<const double> feeds, std::span<double> all) const;
  void set_coordinates(std::span<const double> all, std::span<double> feeds) const;

 private:
  template <class Use>
  void for_each(Use&& use) const;

  std::vector<ClosingLeg> legs_;
  std::vector<int> input_of_;
  int rows_ = 0, inputs_ = 0;
};

}  // namespace sinew::inline v0
