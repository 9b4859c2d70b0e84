#include "plan/search.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v1 {
namespace {
// Scales of the terms: what each of them may be off before it costs as much as the others [m, rad].
constexpr double contact_scale = 0.05e-3, target_scale = 0.05e-3, direction_scale = 5e-3;

double min_radius(const SerialRobot& robot) {
  double least = 1e9;
  for (const Section& section : robot.sections) least = std::min(least, section.outer_radius());
  return least;
}
}  // namespace

Vec3<double> Guide::at(double arc) const {
  if (arc <= arcs.front()) return points.front() + (arc - arcs.front()) * behind;
  if (arc >= arcs.back()) {
    const Vec3<double> last = points.back() - points[points.size() - 2];
    return points.back() + last * ((arc - arcs.back()) / std::sqrt(squared_norm(last)));
  }
  const auto next = static_cast<std::size_t>(std::upper_bound(arcs.begin(), arcs.end(), arc) - arcs.begin());
  const double t = (arc - arcs[next - 1]) / (arcs[next] - arcs[next - 1]);
  return points[next - 1] + t * (points[next] - points[next - 1]);
}

Search::Search(const InsertionScene& scene, const Obstacles& obstacles, double spacing)
    : body(scene, spacing * min_radius(scene.robot)),
      scene_(&scene),
      obstacles_(&obstacles) {
  lower.push_back(0), upper.push_back(scene.stage_limit);
  for (const Section& section : scene.robot.sections)
    for (int i = 0; i < 2; ++i) {
      const double most = std::min(section.limit, section.is_twin() ? 1.5 : 3.0 * section.segments);
      lower.push_back(-most), upper.push_back(most);
    }
  goal = scene.clearance;
}

void Search::project(std::vector<double>& x) const {
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::clamp(x[k], lower[k], upper[k]);
  for (std::size_t m = 0; m < scene_->robot.sections.size(); ++m) {
    const Section& section = scene_->robot.sections[m];
    if (section.is_twin()) continue;
    const double size = std::hypot(x[1 + 2 * m], x[2 + 2 * m]);
    if (size > upper[1 + 2 * m])
      for (const std::size_t k : {1 + 2 * m, 2 + 2 * m}) x[k] *= upper[1 + 2 * m] / size * (1 - 1e-15);
  }
}

void Search::add_contact(Quadratic& at) const {
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double within = body.radius(i) + goal;
    const Nearest near = obstacles_->nearest(body.point(i), within);
    if (near.mesh < 0) continue;
    at.add((within - near.distance) / contact_scale, static_cast<Eigen::Index>(body.movers(i)),
           [&](Eigen::Index k) {
             return -dot(near.away, body.rate(i, static_cast<std::size_t>(k))) / contact_scale;
           });
  }
}

void Search::add_target(Quadratic& at) const {
  const std::size_t tip = body.size() - 1;
  const auto count = static_cast<Eigen::Index>(body.unknowns());
  for (int j = 0; j < 3; ++j)
    at.add((body.point(tip)[j] - scene_->target.tip[j]) / target_scale, count,
           [&](Eigen::Index k) { return body.rate(tip, static_cast<std::size_t>(k))[j] / target_scale; });
  if (!scene_->target.direction) return;
  for (int j = 0; j < 3; ++j)
    at.add((body.tip_direction()[j] - (*scene_->target.direction)[j]) / direction_scale, count,
           [&](Eigen::Index k) {
             return body.tip_direction_rate(static_cast<std::size_t>(k))[j] / direction_scale;
           });
}

void Search::add_guide(Quadratic& at, const Guide& guide, double advance, double weight) const {
  const double each = weight / std::sqrt(static_cast<double>(body.size()));
  for (std::size_t i = 1; i < body.size(); ++i) {
    const Vec3<double> to = guide.at(advance + body.arc(i));
    const double w = i + 1 == body.size() ? 3 * each : each;
    for (int j = 0; j < 3; ++j)
      at.add(w * (body.point(i)[j] - to[j]), static_cast<Eigen::Index>(body.movers(i)),
             [&](Eigen::Index k) { return w * body.rate(i, static_cast<std::size_t>(k))[j]; });
  }
}

Gap Search::gap(double within) const {
  Gap least{within, 0, -1};
  for (std::size_t i = 0; i < body.size(); ++i) {
    const Nearest near = obstacles_->nearest(body.point(i), body.radius(i) + std::max(least.size, 0.0));
    if (near.mesh >= 0 && near.distance - body.radius(i) < least.size)
      least = {near.distance - body.radius(i), i, near.mesh};
  }
  return least;
}

double Search::tip_error() const {
  return std::sqrt(squared_norm(Vec3<double>(body.point(body.size() - 1) - scene_->target.tip)));
}

bool Search::is_at_target() const {
  if (!(tip_error() <= scene_->target.tolerance)) return false;
  if (!scene_->target.direction) return true;
  const Vec3<double> is = body.tip_direction();
  const double off = std::atan2(std::sqrt(squared_norm(cross(is, *scene_->target.direction))),
                                dot(is, *scene_->target.direction));
  return off <= scene_->target.direction_tolerance;
}

Posture Search::descended(Posture x, const std::function<void(Quadratic&)>& more, int max_steps,
                          bool holds_stage) {
  std::vector<double> low = lower, high = upper;
  if (holds_stage) low[0] = high[0] = x[0];
  DescentOptions options;
  options.max_steps = max_steps;
  options.deadline = deadline;
  descend(
      x, low, high,
      [&](std::span<const double> where, Quadratic& at) {
        body.place(where, at.has_derivatives);
        add_contact(at);
        more(at);
      },
      [&](std::vector<double>& where) { project(where); }, options);
  body.place(x, false);
  return x;
}

}  // namespace sinew::inline v1
