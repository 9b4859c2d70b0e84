#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::server::device {
namespace {

constexpr double min_step = 2e-4;             // [m] between recorded postures, of a tendon or the stage
constexpr double min_bend = 2e-3;             // [rad]
constexpr std::size_t max_postures = 50'000;  // 10 m of way

/// Cheap, and enough to thin out a path.
bool is_near(const Posture& a, const Posture& b) {
  double bend = 0;
  for (std::size_t m = 0; m < a.bends.size(); ++m) bend = std::max(bend, (a.bends[m] - b.bends[m]).norm());
  return bend < min_bend && std::abs(a.stage - b.stage) < min_step;
}

double apart(const Posture& a, const Posture& b) {
  double sum = std::abs(a.stage - b.stage) / min_step;
  for (std::size_t m = 0; m < a.bends.size(); ++m) sum += (a.bends[m] - b.bends[m]).norm() / min_bend;
  return sum;
}

}  // namespace

Posture between(const Posture& from, const Posture& to, double share) {
  Posture result = from;
  for (std::size_t m = 0; m < from.bends.size(); ++m)
    result.bends[m] += (to.bends[m] - from.bends[m]) * share;
  result.stage += (to.stage - from.stage) * share;
  return result;
}

void Path::record(const Posture& posture) {
  while (!postures_.empty() && postures_.back().stage > posture.stage) postures_.pop_back();
  if (!postures_.empty() && is_near(postures_.back(), posture)) return;
  if (postures_.size() < max_postures) postures_.push_back(posture);
}

void Path::rewind(const Posture& posture) {
  while (postures_.size() > 1 &&
         (postures_.back().stage > posture.stage ||
          apart(postures_[postures_.size() - 2], posture) <= apart(postures_.back(), posture)))
    postures_.pop_back();
}

bool Path::pop() {
  if (postures_.size() < 2) return false;
  postures_.pop_back();
  return true;
}

void Motion::begin(const Posture& posture, bool follows) {
  set_ = posture;
  if (follows) follower_.begin(set_.bends);
}

double Motion::distance(const Posture& a, const Posture& b) {
  const std::vector<double> from = arm_.changes(a.bends), to = arm_.changes(b.bends);
  double most = std::abs(a.stage - b.stage);
  for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, std::abs(from[i] - to[i]));
  return most;
}

bool Motion::go_to(const Posture& target, double way) {
  const double left = distance(set_, target);
  const double rounding = 1e-9;
  if (left < rounding) return false;
  set_ = left <= way ? target : between(set_, target, way / left);
  return true;
}

bool Motion::go_back(Path& path, double way) {
  bool has_moved = false;
  while (way > 0 && !path.is_empty()) {
    const double left = distance(set_, path.last());
    has_moved = go_to(path.last(), way) || has_moved;
    if (left > way || !path.pop()) break;
    way -= left;
  }
  return has_moved;
}

bool Motion::advance(const Bends& lead, double way) {
  const double room = stage_limit_ - set_.stage;
  if (room <= 0) return false;
  FollowTheLeader trial = follower_;
  Posture next;
  double step = std::min(way, room);
  // Tendons may have farther to go than the stage: then it goes less.
  for (int i = 0; i < 2; ++i) {
    trial = follower_;
    next = {trial.advance(step, lead.back()), set_.stage + step};
    const double needed = distance(set_, next);
    if (needed <= way) break;
    step *= way / needed;
  }
  follower_ = std::move(trial);
  set_ = std::move(next);
  return true;
}

}  // namespace sinew::server::device
