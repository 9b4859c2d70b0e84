/// The tip's distance from its target, and steps towards it within the limits.
#include "kinematics/serial/tip_problem.hpp"

#include <numbers>

namespace sinew::inline v1 {
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
      length_(robot.length()),
      is_extensible_(robot.is_extensible()) {
  if (target_.direction) {
    const double size = std::sqrt(squared_norm(*target_.direction));
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
  const double beyond = std::sqrt(squared_norm(reached)) - (robot_.longest() - disc);
  return beyond > 1e-12 * length_ ? beyond : 0;
}

void TipProblem::bring_within(Shape& shape) const {
  for (std::size_t m = 0; m < robot_.sections.size(); ++m) {
    const Section& section = robot_.sections[m];
    const double limit = section.limit;
    Bend& bend = shape.bends[m];
    if (section.is_twin()) {
      bend = Bend(std::clamp(bend.x(), -limit, limit), std::clamp(bend.y(), -limit, limit));
    } else if (const double size = std::sqrt(squared_norm(bend)); size > limit) {
      bend *= limit / size;
    }
    shape.extensions[m] = std::clamp(shape.extensions[m], section.min_extension, section.max_extension);
  }
}

std::span<const Bend> TipProblem::bends_of(const Shape& shape) const {
  return {shape.bends.data(), robot_.sections.size()};
}

void TipProblem::set_lengths(const Shape& shape) const {
  if (is_extensible_) set_extensions(robot_, {shape.extensions.data(), robot_.sections.size()}, work_);
}

TipMiss TipProblem::screen(const Shape& shape) const {
  set_lengths(shape);
  section_ends(bends_of(shape), work_);
  return miss();
}

TipMiss TipProblem::measure(const Shape& shape) const {
  set_lengths(shape);
  tip_motion(bends_of(shape), work_);
  if (is_extensible_) extension_motion(bends_of(shape), kernel::Model::linear, work_);
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
void TipProblem::linearise(const Shape& shape, const TipMiss& miss, double most, BoundedStep& system) const {
  system.rows = rows_;
  system.columns = unknowns(robot_);
  tip_rows(robot_, bends_of(shape), work_, length_, miss.shift, miss.turn, system);
  const auto bound = [&](std::size_t j, double low, double high) {
    system.low[j] = low;
    system.high[j] = high;
  };
  const std::size_t count = robot_.sections.size();
  for (std::size_t m = 0; m < count; ++m) {
    const Room free = room(robot_.sections[m], shape.bends[m]);
    for (std::size_t j = 0; j < 2; ++j)
      bound(2 * m + j, std::max(free.low[j], -most), std::min(free.high[j], most));
  }
  if (!is_extensible_) return;
  for (std::size_t m = 0; m < count; ++m)
    bound(2 * count + m, (robot_.sections[m].min_extension - shape.extensions[m]) / length_,
          (robot_.sections[m].max_extension - shape.extensions[m]) / length_);
  if (count % 2 == 1) bound(3 * count, 0, 0);  // fills the pair
}

Shape TipProblem::moved(const Shape& shape, const BoundedStep& system) const {
  Shape ahead = shape;
  const std::size_t count = robot_.sections.size();
  for (std::size_t m = 0; m < count; ++m) {
    ahead.bends[m] +=
        bend_change(robot_.sections[m], shape.bends[m], system.step[2 * m], system.step[2 * m + 1]);
    if (is_extensible_) ahead.extensions[m] += length_ * system.step[2 * count + m];
  }
  bring_within(ahead);
  return ahead;
}

}  // namespace sinew::inline v1
