#include "plan/tip_curve.hpp"

#ifdef SINEW_WITH_OMPL

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "plan/draw.hpp"

namespace sinew::inline v0 {
namespace {

namespace ob = ompl::base;
using Point = Vec3<double>;
using Curve = std::vector<Point>;

constexpr double spacing = 1e-3;       // of points on the curve [m]
constexpr double resolution = 0.3e-3;  // at which straight pieces are looked at [m]
constexpr double range = 8e-3;         // of a step of the tree [m]
constexpr double thickness = 0.6;  // of the ball, in radii of the robot: the body finds its own place around
constexpr int most_samples = 200000;
constexpr double approach = 10e-3;  // straight, before a target with a direction [m]

Point point_of(const ob::State* state) {
  const double* x = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {x[0], x[1], x[2]};
}

double distance(const Point& a, const Point& b) { return std::sqrt(squared_norm(Point(a - b))); }

/// Samples of one seed: OMPL's own are those of the process.
class SeededSampler : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::shared_ptr<Draw> draw)
      : RealVectorStateSampler(space),
        draw_(std::move(draw)) {}
  void sampleUniform(ob::State* state) override {
    const auto& bounds = space_->as<ob::RealVectorStateSpace>()->getBounds();
    for (unsigned k = 0; k < 3; ++k)
      state->as<ob::RealVectorStateSpace::StateType>()->values[k] =
          draw_->between(bounds.low[k], bounds.high[k]);
  }

 private:
  std::shared_ptr<Draw> draw_;
};

class TipSearch {
 public:
  TipSearch(const InsertionScene& scene, const Obstacles& obstacles, std::uint64_t seed)
      : scene_(scene),
        obstacles_(obstacles),
        draw_(std::make_shared<Draw>(seed * 0x9E3779B9 + 17)) {
    for (const Section& section : scene.robot.sections) radius_ = std::max(radius_, section.outer_radius());
    radius_ = thickness * radius_;
    start_ = scene.base.p + scene.robot.length() * scene.base.R.rotate(Point(0, 0, 1));
    goal_ = scene.target.tip;
    if (scene.target.direction) goal_ = goal_ - approach * *scene.target.direction;
  }

  Curve found(const Deadline& deadline) {
    Curve curve = searched(deadline);
    if (curve.empty()) return {};
    shorten(curve);
    if (scene_.target.direction) curve = dense({curve, {scene_.target.tip}});
    round_off(curve);
    return curve;
  }

 private:
  /// Clear, and on no detour that is longer than the stage.
  bool is_clear(const Point& p) const {
    if (distance(p, start_) + distance(p, goal_) > scene_.stage_limit) return false;
    const Nearest near = obstacles_.nearest(p, radius_);
    return near.mesh < 0 || near.distance >= radius_;
  }
  bool is_clear(const Point& a, const Point& b) const {
    const int count = std::max(1, static_cast<int>(std::ceil(distance(a, b) / resolution)));
    for (int i = 0; i <= count; ++i)
      if (!is_clear(Point(a + (b - a) * (static_cast<double>(i) / count)))) return false;
    return true;
  }

  Curve searched(const Deadline& deadline) {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    auto space = std::make_shared<ob::RealVectorStateSpace>(3);
    ob::RealVectorBounds bounds(3);
    for (unsigned k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      bounds.low[k] = std::min(start_[axis], goal_[axis]) - 0.4 * scene_.stage_limit;
      bounds.high[k] = std::max(start_[axis], goal_[axis]) + 0.4 * scene_.stage_limit;
    }
    space->setBounds(bounds);
    space->setStateSamplerAllocator([draw = draw_](const ob::StateSpace* of) -> ob::StateSamplerPtr {
      return std::make_shared<SeededSampler>(of, draw);
    });
    auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker(
        [this](const ob::State* state) { return is_clear(point_of(state)); });
    information->setStateValidityCheckingResolution(resolution / space->getMaximumExtent());
    information->setup();
    auto problem = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> from(space), to(space);
    for (unsigned k = 0; k < 3; ++k)
      from[k] = start_[static_cast<int>(k)], to[k] = goal_[static_cast<int>(k)];
    problem->setStartAndGoalStates(from, to);
    ompl::geometric::RRTConnect planner(information);
    planner.setRange(range);
    planner.setProblemDefinition(problem);
    planner.setup();
    int asked = 0;
    const auto status = planner.solve(
        ob::PlannerTerminationCondition([&] { return ++asked > most_samples || deadline.is_over(); }));
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};
    Curve curve;
    for (const ob::State* state :
         problem->getSolutionPath()->as<ompl::geometric::PathGeometric>()->getStates())
      curve.push_back(point_of(state));
    return curve;
  }

  /// Points between, so that none is farther than `spacing` from the next.
  static Curve dense(const std::vector<Curve>& parts) {
    Curve all, corners;
    for (const Curve& part : parts) corners.insert(corners.end(), part.begin(), part.end());
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
      const int count =
          std::max(1, static_cast<int>(std::ceil(distance(corners[k], corners[k + 1]) / spacing)));
      for (int i = 0; i < count; ++i)
        all.push_back(corners[k] + (corners[k + 1] - corners[k]) * (static_cast<double>(i) / count));
    }
    all.push_back(corners.back());
    return all;
  }

  /// Straight on between points of the curve, where that is clear.
  void shorten(Curve& curve) {
    curve = dense({curve});
    for (int attempt = 0; attempt < 200 && curve.size() > 2; ++attempt) {
      const auto drawn = [&] {
        return static_cast<std::size_t>(draw_->between(0, static_cast<double>(curve.size())));
      };
      const auto [a, b] = std::minmax(drawn(), drawn());
      if (b < a + 2 || !is_clear(curve[a], curve[b])) continue;
      const auto begin = curve.begin();
      const Curve head(begin, begin + static_cast<std::ptrdiff_t>(a) + 1),
          tail(begin + static_cast<std::ptrdiff_t>(b), curve.end());
      curve = dense({head, tail});
    }
  }

  /// Each point towards the middle of its neighbours, where it stays clear. The first, which the stage
  /// leads straight on, and the last, with a direction its whole approach, stay.
  void round_off(Curve& curve) const {
    const std::size_t last = scene_.target.direction ? static_cast<std::size_t>(approach / spacing) : 1;
    for (int round = 0; round < 300; ++round)
      for (std::size_t k = 1; k + last < curve.size(); ++k) {
        const Point middle = 0.5 * (curve[k - 1] + curve[k + 1]);
        if (is_clear(middle)) curve[k] = middle;
      }
  }

  const InsertionScene& scene_;
  const Obstacles& obstacles_;
  std::shared_ptr<Draw> draw_;
  double radius_ = 0;
  Point start_, goal_;
};

}  // namespace

std::vector<Vec3<double>> tip_curve(const InsertionScene& scene, const Obstacles& obstacles,
                                    std::uint64_t seed, const Deadline& deadline) {
  return TipSearch(scene, obstacles, seed).found(deadline);
}

}  // namespace sinew::inline v0

#else

namespace sinew::inline v0 {

std::vector<Vec3<double>> tip_curve(const InsertionScene&, const Obstacles&, std::uint64_t, const Deadline&) {
  return {};
}

}  // namespace sinew::inline v0

#endif
