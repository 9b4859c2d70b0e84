#include "sinew/analysis/singularity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "math/polygon.hpp"
#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double step_size = 0.02;  // of a step [rad, or platform radii]
constexpr double stencil = 0.2;     // spacing of the points of a derivative, in steps
constexpr int max_steps = 20000;    // four hundred platform radii, or sixty turns
constexpr double min_dip = 1e-9;    // of the volume beside a smallest one; less is rounding

/// A straight motion of the platform, by its distance s; put back into the planes that hinges may hold it in.
struct Line {
  const Robot& robot;
  AnyPose start;
  Vec<double, 6> direction;  // in the plane the first three
  double step;               // of the search, in s

  /// Whether hinges leave at least half of the motion.
  bool is_allowed() const {
    const auto* spatial = std::get_if<SpatialPose>(&start);
    if (!spatial || plane_count(robot) == 0) return true;
    const SpatialPose moved = Spatial::moved(*spatial, Vec<double, 6>(step * direction));
    const double radius = platform_radius(robot);
    return gap(std::get<SpatialPose>(project_to_constraints(robot, moved)), moved, radius) <
           0.5 * gap(moved, *spatial, radius);
  }

  AnyPose at(double s) const {
    if (const auto* planar = std::get_if<PlanarPose>(&start))
      return Planar::moved(*planar, Vec<double, 3>(s * direction.head<3>()));
    return project_to_constraints(
        robot, Spatial::moved(std::get<SpatialPose>(start), Vec<double, 6>(s * direction)));
  }
};

/// The robot at a place of the line.
struct Place {
  double s;
  Track track;
  double volume;
};

/// Walks along the line and looks for zeros of the volume that the unit lines span.
class LineWalk {
 public:
  LineWalk(const Robot& robot, const Line& line, double limit, Workspace& work)
      : robot_(robot),
        line_(line),
        limit_(limit),
        work_(work) {}

  TypeTwoDistance run(const InverseOptions& branch);

 private:
  double volume(const Track& track);
  Place moved(const Place& from, double s);
  double slope(const Place& near, double s);
  template <class F>
  double zero(double low, double high, const F& f);
  std::optional<TypeTwoDistance> found_at(const Place& near, double s);
  std::optional<TypeTwoDistance> crossing(const Place& from, double to);
  std::optional<TypeTwoDistance> touching(const Place& before, const Place& here, const Place& after);
  std::optional<TypeTwoDistance> in_step(const Place& before, const Place& here, const Place& next);
  TypeTwo type_2(const Track& track) {
    return velocity(robot_, track.pose(), track.coordinates(), work_).type_2;
  }

  const Robot& robot_;
  const Line& line_;
  double limit_;
  Workspace& work_;
  Report report_;  // of the last advance
};

/// det J of the homogenised lines; of more lines than freedoms det JᵀJ, which cannot change its sign.
double LineWalk::volume(const Track& track) {
  const MatrixView lines =
      homogenise(robot_, assemble(robot_, track.pose(), track.coordinates(), work_), work_);
  if (lines.rows() == lines.cols()) return determinant(lines);
  if (lines.rows() < lines.cols()) return 0;
  std::array<double, max_rows> sigma;
  const auto count = static_cast<std::size_t>(lines.cols());
  singular_values(lines, std::span(sigma).first(count));
  double product = 1;
  for (std::size_t k = 0; k < count; ++k) product *= sigma[k] * sigma[k];
  return product;
}

/// On the branch of a place to another near by; as far as the branch goes, `report_` says why not further.
Place LineWalk::moved(const Place& from, double s) {
  Place to{s, from.track, 0};
  report_ = to.track.advance(line_.at(s));
  if (!report_.ok()) to.s = std::lerp(from.s, s, to.track.progress());
  to.volume = volume(to.track);
  return to;
}

/// d volume/ds, by central differences of sixth order: what they leave is of the size of rounding.
double LineWalk::slope(const Place& near, double s) {
  constexpr std::array weights{45.0, -9.0, 1.0};
  const double h = stencil * line_.step;
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double beside = static_cast<double>(k + 1) * h;
    sum += weights[k] * (moved(near, s + beside).volume - moved(near, s - beside).volume);
  }
  return sum / (60 * h);
}

/// Where f changes its sign, to the last digit.
template <class F>
double LineWalk::zero(double low, double high, const F& f) {
  const bool sign = std::signbit(f(low));
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) return high;
    (std::signbit(f(middle)) == sign ? low : high) = middle;
  }
}

/// The answer if the robot is at a type II there. A volume may change its sign at other places too: where a
/// line turns round because its points meet.
std::optional<TypeTwoDistance> LineWalk::found_at(const Place& near, double s) {
  const Place there = moved(near, s);
  const TypeTwo type = type_2(there.track);
  if (!report_.ok() || !type.singular) return {};
  return TypeTwoDistance{
      .found = true, .distance = s, .pose = there.track.pose(), .type_2 = type, .report = {}};
}

std::optional<TypeTwoDistance> LineWalk::crossing(const Place& from, double to) {
  return found_at(from, zero(from.s, to, [&](double s) { return moved(from, s).volume; }));
}

/// Three places, the volume smallest at the middle one: it may touch zero near by, or cross it twice.
std::optional<TypeTwoDistance> LineWalk::touching(const Place& before, const Place& here,
                                                  const Place& after) {
  const double lowest = zero(before.s, after.s, [&](double s) { return slope(here, s); });
  const bool is_beyond = std::signbit(moved(here, lowest).volume) != std::signbit(here.volume);
  if (is_beyond) return crossing(before, lowest);
  return found_at(here, lowest);
}

/// The type II in the step from here to the next place, or, where the volume is smallest here, beside it.
std::optional<TypeTwoDistance> LineWalk::in_step(const Place& before, const Place& here, const Place& next) {
  const double size = std::abs(here.volume);
  std::optional<TypeTwoDistance> found;
  if (std::signbit(here.volume) != std::signbit(next.volume))
    found = crossing(here, next.s);
  else if (before.s < here.s && size <= std::abs(before.volume) && size < std::abs(next.volume) &&
           (1 + min_dip) * size < std::max(std::abs(before.volume), std::abs(next.volume)))
    found = touching(before, here, next);
  return found || next.s < limit_ ? found : found_at(here, next.s);
}

TypeTwoDistance LineWalk::run(const InverseOptions& branch) {
  Track start(robot_, {.branch = branch}, work_);
  Report report = start.advance(line_.start);
  TypeTwoDistance answer{.found = false, .distance = 0, .pose = line_.start, .type_2 = {}, .report = report};
  if (!report.ok()) return answer;
  Place here{0, start, volume(start)}, before = here;
  answer.found = type_2(start).singular;
  for (int steps = 0; !answer.found && report.ok() && here.s < limit_; ++steps) {
    Place next = moved(here, std::min(here.s + line_.step, limit_));
    report = report_;
    if (steps == max_steps) {
      report.status = Status::iteration_limit;
      report.message = std::string_view("there is none this far; to look farther, begin from here");
    }
    if (auto found = in_step(before, here, next)) return *found;
    before = std::exchange(here, std::move(next));
  }
  answer.distance = here.s;
  answer.pose = here.track.pose();
  answer.type_2 = type_2(here.track);
  answer.report = report;
  return answer;
}

/// A step of the search: small against the platform, and against a radian.
double step_of(const Robot& robot, const Vec<double, 6>& direction) {
  const double radius = platform_radius(robot);
  const int dimension = dof(robot) == 3 ? 2 : 3;
  const double turning = direction.segment(dimension, dof(robot) - dimension).norm();
  return step_size / std::max(direction.head(dimension).norm() / radius, turning);
}

double full_turn(const Robot& robot, const Vec<double, 6>& direction) {
  const int dimension = dof(robot) == 3 ? 2 : 3;
  return 2 * std::numbers::pi / direction.segment(dimension, dof(robot) - dimension).norm();
}

TypeTwoDistance one_way(const Robot& robot, const AnyPose& pose, const Vec<double, 6>& direction,
                        const TypeTwoSearch& search, Workspace& work) {
  const Line line{robot, pose, direction, step_of(robot, direction)};
  if (!std::isfinite(line.step) || line.step == 0) {
    TypeTwoDistance answer{.found = false, .distance = 0, .pose = pose, .type_2 = {}, .report = {}};
    answer.report.status = Status::left_domain;
    answer.report.message.append("the direction is zero, or not a finite number");
    return answer;
  }
  if (!line.is_allowed()) {
    TypeTwoDistance answer{.found = false, .distance = 0, .pose = pose, .type_2 = {}, .report = {}};
    answer.report.status = Status::unreachable;
    answer.report.message.append("the platform cannot move that way: hinges hold its points in their planes");
    return answer;
  }
  const double limit = std::isnan(search.limit) ? full_turn(robot, direction) : search.limit;
  return LineWalk(robot, line, limit, work).run(search.branch);
}

}  // namespace

TypeTwoDistance type_2_distance(const Robot& robot, const AnyPose& pose, Numbers direction,
                                const TypeTwoSearch& search, Workspace& work) {
  TypeTwoDistance refused{.found = false, .distance = 0, .pose = pose, .type_2 = {}, .report = {}};
  refused.report = check_arguments(robot, pose, work);
  if (refused.report.ok() && direction.size() != static_cast<std::size_t>(dof(robot))) {
    refused.report.status = Status::bad_input;
    refused.report.message.append("the direction needs a number for each freedom of the platform");
  }
  if (!refused.report.ok()) return refused;
  Vec<double, 6> along = Vec<double, 6>::Zero();
  std::copy_n(direction.begin(), std::min<std::size_t>(direction.size(), 6), along.data());
  // its squares neither overflow nor vanish; by a power of two, exactly
  const double largest = along.cwiseAbs().maxCoeff();
  const int scale = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
  for (double& part : along) part = std::scalbn(part, -scale);
  TypeTwoSearch scaled = search;
  scaled.limit = std::scalbn(search.limit, scale);
  const auto search_one_way = [&](const Vec<double, 6>& way) {
    TypeTwoDistance found = one_way(robot, pose, way, scaled, work);
    found.distance = std::scalbn(found.distance, -scale);
    return found;
  };
  TypeTwoDistance ahead = search_one_way(along);
  if (!search.both_ways) return ahead;
  TypeTwoDistance behind = search_one_way(-along);
  if (!behind.found || (ahead.found && ahead.distance <= behind.distance)) return ahead;
  behind.distance = -behind.distance;
  return behind;
}

}  // namespace sinew::inline v1
