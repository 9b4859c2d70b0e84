/// @file follow.hpp
/// Follow-the-leader: the arm advances along the curve that its tip draws. The curve is kept as bend per
/// length; a section takes the mean of what it lies on. The base moves on a straight line, so the body stays
/// on the curve as far as the curve began straight; where the arm was bent at its base, it leaves it there.
#pragma once
#include <deque>
#include <span>
#include <vector>

#include "arm.hpp"

namespace sinew::server::device {

class Follower {
 public:
  explicit Follower(const SerialRobot& robot);

  void begin(std::span<const Bend> bends);
  /// The arm that much [m] further, its new end bent as the last section of `lead` is.
  Bends advance(double way, std::span<const Bend> lead);

 private:
  struct Piece {
    double end;         ///< [m] from the base
    Vec2<double> bend;  ///< in all, per length [rad/m]
  };
  Vec2<double> mean(double from, double to) const;

  std::vector<double> ends_;    ///< of the sections, from the base [m]
  std::vector<double> shares_;  ///< bend of a section for a bend of 1 rad/m in all
  std::deque<Piece> curve_;
};

}  // namespace sinew::server::device
