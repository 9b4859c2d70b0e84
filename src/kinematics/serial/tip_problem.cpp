/// The tip's distance from its target, and steps towards it within the limits.
#include "kinematics/serial/tip_problem.hpp"

#include <numbers>

#include "sinew/base/assert.hpp"

namespace sinew::inline v0 {
namespace {

/// The shortest turn from one unit vector to the other; between opposite ones any across.
Vec3<double> turn_between(const Vec3<double>& from, const Vec3<double>& to) {
  const Vec3<double> axis = cross(from, to);
  const double sine = std::sqrt(squared_norm(axis)), cosine = dot(from, to);
  if (sine > 0) return axis * (std::atan2(sine, cosine) / sine);
  if (cosine > 0) return Vec3<double>(0, 0, 0);
  const Vec3<double> across =
      std::abs(from.x()) < 0.7 ? cross(from, Vec3<double>(1, 0, 0)) : cross(from, Vec3<double>(0, 1, 0));
  return across * (std::numbers::pi / std::sqrt(squared_norm(across)));
}

}  // namespace

TipProblem::TipProblem(const SerialRobot& robot, const TipTarget& target, SerialWorkspace& work)
    : robot_(robot),
      work_(work),
      target_(target),
      rows_(3),
      length_(robot.length()) {
  SINEW_EXPECTS(!robot.sections.empty() && robot.section_count() <= max_sections);
  SINEW_EXPECTS(work.ends.size() == robot.sections.size());
  SINEW_EXPECTS(!(target.direction && target.rotation));
  if (target_.direction) {
    const double size = std::sqrt(squared_norm(*target_.direction));
    SINEW_EXPECTS(size > 0);
    *target_.direction /= size;
    rows_ = 5;
  }
  if (target_.rotation) {
    target_.rotation = target_.rotation->normalised();
    rows_ = 6;
  }
}

/// Nothing of the robot is longer than straight; where the tip's axis is known, its last disc is known too.
double TipProblem::farthest() const {
  double disc = 0;
  Vec3<double> reached = target_.position;
  if (rows_ > 3) {
    disc = robot_.sections.back().disc_height;
    reached -=
        disc * (target_.direction ? *target_.direction : target_.rotation->rotate(Vec3<double>(0, 0, 1)));
  }
  const double beyond = std::sqrt(squared_norm(reached)) - (length_ - disc);
  return beyond > 1e-12 * length_ ? beyond : 0;
}

void TipProblem::bring_within(Bends& bends) const {
  for (std::size_t m = 0; m < robot_.sections.size(); ++m) {
    const double limit = robot_.sections[m].limit;
    Bend& bend = bends[m];
    if (robot_.sections[m].is_twin()) {
      bend = Bend(std::clamp(bend.x(), -limit, limit), std::clamp(bend.y(), -limit, limit));
    } else if (const double size = std::sqrt(squared_norm(bend)); size > limit) {
      bend *= limit / size;
    }
  }
}

TipMiss TipProblem::screen(const Bends& bends) const {
  section_ends(robot_, {bends.data(), robot_.sections.size()}, work_);
  return miss();
}

TipMiss TipProblem::measure(const Bends& bends) const {
  tip_motion(robot_, {bends.data(), robot_.sections.size()}, work_);
  return miss();
}

TipMiss TipProblem::miss() const {
  const SE3<double>& tip = work_.ends.back();
  TipMiss miss{target_.position - tip.p, Vec3<double>(0, 0, 0)};
  if (target_.direction) miss.turn = turn_between(tip.rotate(Vec3<double>(0, 0, 1)), *target_.direction);
  if (target_.rotation) miss.turn = target_.rotation->compose(tip.R.inverse()).log();
  miss.position = std::sqrt(squared_norm(miss.shift));
  miss.angle = std::sqrt(squared_norm(miss.turn));
  return miss;
}

/// The turn that is missing changes by −δθ to first order, and exactly so in its own direction: the merit's
/// gradient is right however large it is.
void TipProblem::linearise(const Bends& bends, const TipMiss& miss, double most, BoundedStep& system) const {
  system.rows = rows_;
  system.columns = 2 * static_cast<int>(robot_.sections.size());
  tip_rows(robot_, bends, work_, length_, miss.shift, miss.turn, system);
  for (std::size_t m = 0; m < robot_.sections.size(); ++m) {
    const Room free = room(robot_.sections[m], bends[m]);
    for (std::size_t j = 0; j < 2; ++j) {
      system.low[2 * m + j] = std::max(free.low[j], -most);
      system.high[2 * m + j] = std::min(free.high[j], most);
    }
  }
}

Bends TipProblem::moved(const Bends& bends, const BoundedStep& system) const {
  Bends ahead = bends;
  for (std::size_t m = 0; m < robot_.sections.size(); ++m)
    ahead[m] += bend_change(robot_.sections[m], bends[m], system.step[2 * m], system.step[2 * m + 1]);
  bring_within(ahead);
  return ahead;
}

}  // namespace sinew::inline v0
