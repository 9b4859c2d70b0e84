#include "sinew/kinematics/trajectory.hpp"

#include <algorithm>

namespace sinew::inline v1 {

FollowTheLeader::FollowTheLeader(const SerialRobot& robot) {
  double end = 0;
  for (const Section& section : robot.sections) {
    ends_.push_back(end += section.length());
    // Half of the joints of twin pivots bend about one axis, each by the section's bend.
    shares_.push_back(section.length() / (section.is_twin() ? section.segments / 2.0 : 1.0));
  }
}

void FollowTheLeader::begin(std::span<const Bend> bends) {
  curve_.clear();
  for (std::size_t m = 0; m < ends_.size(); ++m) curve_.push_back({ends_[m], bends[m] / shares_[m]});
}

std::vector<Bend> FollowTheLeader::advance(double way, const Bend& leader) {
  for (Piece& piece : curve_) piece.end -= way;
  while (curve_.size() > 1 && curve_.front().end <= 0) curve_.pop_front();
  curve_.push_back({ends_.back(), leader / shares_.back()});
  std::vector<Bend> bends;
  for (std::size_t m = 0; m < ends_.size(); ++m)
    bends.push_back(mean(m > 0 ? ends_[m - 1] : 0, ends_[m]) * shares_[m]);
  return bends;
}

Vec2<double> FollowTheLeader::mean(double from, double to) const {
  Vec2<double> sum{0, 0};
  double at = 0;
  for (const Piece& piece : curve_) {
    const double length = std::min(piece.end, to) - std::max(at, from);
    if (length > 0) sum += piece.bend * length;
    at = piece.end;
  }
  return sum / (to - from);
}

}  // namespace sinew::inline v1
