#include "sinew/plan/insertion.hpp"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>

#include "math/polygon.hpp"
#include "plan/body.hpp"
#include "plan/deadline.hpp"
#include "plan/obstacles.hpp"
#include "plan/parallel.hpp"
#include "sinew/analysis/tendon_limits.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {
namespace {

using Solid = fcl::BVHModel<fcl::OBBRSSd>;

/// Solids as FCL has them; read by all threads.
class Solids {
 public:
  explicit Solids(std::span<const Mesh> meshes) {
    for (const Mesh& mesh : meshes) {
      std::vector<fcl::Vector3d> vertices(mesh.vertices.begin(), mesh.vertices.end());
      std::vector<fcl::Triangle> triangles;
      for (const auto& [a, b, c] : mesh.triangles)
        triangles.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                               static_cast<std::size_t>(c));
      auto solid = std::make_shared<Solid>();
      solid->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
      solid->addSubModel(vertices, triangles);
      solid->endModel();
      solid->computeLocalAABB();
      all_.push_back(std::move(solid));
    }
  }
  const std::vector<std::shared_ptr<Solid>>& all() const { return all_; }

 private:
  std::vector<std::shared_ptr<Solid>> all_;
};

fcl::Transform3d capsule_pose(const Vec3<double>& from, const Vec3<double>& to) {
  const fcl::Vector3d a(from[0], from[1], from[2]), b(to[0], to[1], to[2]);
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = 0.5 * (a + b);
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(fcl::Vector3d::UnitZ(), b - a).toRotationMatrix();
  return pose;
}

/// Square of the distance between a box and the box about a segment.
double box_gap(const fcl::AABBd& box, const Vec3<double>& from, const Vec3<double>& to) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double low = std::min(from[i], to[i]), high = std::max(from[i], to[i]);
    const double out = std::max({0.0, low - box.max_[i], box.min_[i] - high});
    sum += out * out;
  }
  return sum;
}

/// One robot among the solids, of one thread.
class Examiner {
 public:
  Examiner(const InsertionScene& scene, const Solids& solids)
      : body_(scene, std::numeric_limits<double>::infinity()),
        solids_(&solids) {}

  Body& body() { return body_; }

  /// Where the placed robot is nearest to a solid.
  TightSpot nearest(double reach) const {
    TightSpot best;
    best.distance = reach;
    const fcl::Transform3d here = fcl::Transform3d::Identity();
    for (std::size_t i = 0; i + 1 < body_.size(); ++i) {
      const double radius = radius_of(i);
      const fcl::Transform3d pose = capsule_pose(body_.point(i), body_.point(i + 1));
      // of a thin one: the nearest points of the backbone are told more exactly than of a thick one
      const fcl::Capsuled thin(thin_radius, length_of(i));
      for (std::size_t m = 0; m < solids_->all().size(); ++m) {
        const auto& solid = solids_->all()[m];
        const double most = radius + best.distance;
        if (!(most > 0) || box_gap(solid->aabb_local, body_.point(i), body_.point(i + 1)) > most * most)
          continue;
        fcl::DistanceRequestd request(true);
        request.abs_err = 1e-9;
        fcl::DistanceResultd result(most);  // nothing farther is looked for
        const double gap = fcl::distance(solid.get(), here, &thin, pose, request, result);
        const double distance = (gap < 0 ? 0 : gap + thin_radius) - radius;
        if (!(distance < best.distance) || result.b1 == fcl::DistanceResultd::NONE) continue;
        // FCL has no nearest points of what overlaps
        const Vec3<double> through = gap < 0 ? crossing(i, *solid, result.b1) : Vec3<double>(0, 0, 0);
        best = {distance,
                body_.section(i + 1),
                static_cast<int>(m),
                static_cast<int>(result.b1),
                gap < 0 ? through : vector_of(result.nearest_points[1]),
                gap < 0 ? through : vector_of(result.nearest_points[0])};
      }
    }
    return best;
  }

  /// Whether any part touches a solid while it is thicker by what belongs to it. @param more of every point
  /// [m]
  bool touches(std::span<const double> more) const {
    const fcl::Transform3d here = fcl::Transform3d::Identity();
    fcl::CollisionRequestd request(1, false);
    for (std::size_t i = body_.size() - 1; i-- > 0;) {  // the tip first, which is farthest off
      const double radius = radius_of(i) + std::max(more[i], more[i + 1]);
      const fcl::Capsuled thick(radius, length_of(i));
      std::optional<fcl::Transform3d> pose;
      for (const auto& solid : solids_->all()) {
        if (box_gap(solid->aabb_local, body_.point(i), body_.point(i + 1)) > radius * radius) continue;
        if (!pose) pose = capsule_pose(body_.point(i), body_.point(i + 1));
        fcl::CollisionResultd result;
        if (fcl::collide(&thick, *pose, solid.get(), here, request, result) > 0) return true;
      }
    }
    return false;
  }

 private:
  static constexpr double thin_radius = 1e-5;  // [m]
  static Vec3<double> vector_of(const fcl::Vector3d& v) { return {v[0], v[1], v[2]}; }
  /// Where a piece of the backbone goes through a triangle.
  Vec3<double> crossing(std::size_t i, const Solid& solid, std::intptr_t triangle) const {
    const fcl::Triangle& corners = solid.tri_indices[triangle];
    const auto corner = [&](int k) {
      return vector_of(solid.vertices[corners[static_cast<std::size_t>(k)]]);
    };
    const Vec3<double> a = corner(0), from = body_.point(i), along = body_.point(i + 1) - from,
                       normal = cross(Vec3<double>(corner(1) - a), Vec3<double>(corner(2) - a));
    const double steep = dot(along, normal);
    const double part = steep == 0 ? 0.5 : std::clamp(dot(Vec3<double>(a - from), normal) / steep, 0.0, 1.0);
    return from + part * along;
  }
  double length_of(std::size_t i) const {
    return std::sqrt(squared_norm(Vec3<double>(body_.point(i + 1) - body_.point(i))));
  }
  /// Of a piece: an arc leaves its chord by less than an eighth of its length times what it turns.
  double radius_of(std::size_t i) const {
    return std::max(body_.radius(i), body_.radius(i + 1)) + body_.sagitta(i);
  }

  Body body_;
  const Solids* solids_;
};

/// Whether robots at all postures between two are clear: each point moves by at most its bound away from
/// where it is in the middle, so a robot thicker by that is clear there, or both halves are.
bool is_clear_between(Examiner& examiner, const std::vector<double>& from, const std::vector<double>& to,
                      double min_motion, const Deadline& deadline, std::size_t& poses) {
  if (deadline.is_over()) return false;
  Body& body = examiner.body();
  std::vector<double> middle(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) middle[k] = 0.5 * (from[k] + to[k]);
  body.place(middle, false);
  std::vector<double> more(body.size());
  double most = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    more[i] = body.motion_bound(i, from, middle);
    most = std::max(most, more[i]);
  }
  ++poses;
  if (!examiner.touches(more)) return true;
  if (most < min_motion) return false;
  return is_clear_between(examiner, from, middle, min_motion, deadline, poses) &&
         is_clear_between(examiner, middle, to, min_motion, deadline, poses);
}

/// Of a tendon that passes the sections up to `m`: its tolerance, and what tension stretches it by where all
/// sections are bent away from it as far as they can be, and it is longest.
double uncertainty(const InsertionScene& scene, std::size_t m) {
  const auto& stretch = scene.robot.stretch;
  if (!stretch) return scene.robot.tolerance;
  double length = tendon_length(scene.robot, static_cast<int>(m), stretch->outside);
  for (std::size_t k = 0; k <= m; ++k) {
    const Section& section = scene.robot.sections[k];
    const double limit =
        std::min(section.limit, section.is_twin() ? std::numbers::pi : section.segments * std::numbers::pi);
    length += section.map().gain * limit * (section.is_twin() ? std::numbers::sqrt2 : 1.0);
  }
  return scene.robot.tolerance + scene.tension * length / stretch->stiffness;
}

/// How far every point of the robot may be off by its tendons, whatever it does. Tendons that pass several
/// sections hold the sum of what these may bend; each may bend as far as two sums differ.
std::vector<double> tendon_offsets(const InsertionScene& scene, const Body& body) {
  std::vector<double> bend(scene.robot.sections.size());
  double before = 0;
  for (std::size_t m = 0; m < bend.size(); ++m) {
    const Section& section = scene.robot.sections[m];
    const double sum = uncertainty(scene, m) / std::cos(std::numbers::pi / section.tendons);
    bend[m] = (sum + before) / section.map().gain;
    before = sum;
  }
  std::vector<double> off(body.size(), 0.0);
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t m = 0; 1 + 2 * m < body.movers(i); ++m)
      off[i] += bend[m] * std::max(body.lever(i, 1 + 2 * m), body.lever(i, 2 + 2 * m)) *
                (scene.robot.sections[m].is_twin() ? std::numbers::sqrt2 : 1.0);
  return off;
}

/// How far every point may be off altogether. @param at_tip its parts there
std::vector<double> offsets(const InsertionScene& scene, const Body& body, InsertionOff& at_tip) {
  std::vector<double> off = tendon_offsets(scene, body);
  for (std::size_t i = 0; i < body.size(); ++i) {
    at_tip = {off[i], scene.weight ? body.sag_bound(i, *scene.weight) : 0.0, scene.model_error};
    off[i] = at_tip.sum();
  }
  return off;
}

constexpr int share_levels = 1024;  // in which what may be off is told apart

/// Largest level of what may be off, at most `most`, at which the placed robot is clear. Levels are whole, so
/// that it does not matter what was known before.
int clear_level(const Examiner& examiner, const std::vector<double>& off, int most) {
  const auto is_clear = [&](int level) {
    std::vector<double> more(off);
    for (double& x : more) x *= static_cast<double>(level) / share_levels;
    return !examiner.touches(more);
  };
  if (is_clear(most)) return most;
  int low = 0, high = most;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (is_clear(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

std::string_view to_string(InsertionVerdict verdict) noexcept {
  switch (verdict) {
    case InsertionVerdict::clear:
      return "CLEAR";
    case InsertionVerdict::clear_if_taut:
      return "CLEAR ONLY IF TAUT";
    case InsertionVerdict::touches:
      return "TOUCHES";
  }
  return "";
}

InsertionCheck check_insertion(const InsertionScene& scene, std::span<const InsertionStep> steps,
                               const InsertionCheckOptions& options) {
  InsertionCheck check;
  if (steps.empty()) return check;
  for (const InsertionStep& step : steps)
    if (step.bends.size() != scene.robot.sections.size() ||
        !std::ranges::all_of(posture_of(step), [](double x) { return std::isfinite(x); }))
      return check;
  const Solids solids(scene.solids);
  const Obstacles obstacles(scene.solids);
  const std::size_t threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<Examiner> examiners;
  for (std::size_t t = 0; t < std::min(threads, steps.size()); ++t) examiners.emplace_back(scene, solids);
  const std::vector<double> off = offsets(scene, examiners.front().body(), check.off);
  check.steps.resize(steps.size());
  const Deadline deadline{options.stop, options.deadline};
  std::atomic<int> level = share_levels;
  std::vector<std::size_t> poses(steps.size(), 0);
  in_parallel(steps.size(), examiners.size(), [&](std::size_t k, std::size_t thread) {
    Examiner& examiner = examiners[thread];
    CheckedStep& step = check.steps[k];
    step.stage = steps[k].stage;
    if (deadline.is_over()) return;
    const std::vector<double> here = posture_of(steps[k]);
    examiner.body().place(here, false);
    step.spot = examiner.nearest(options.reach);
    // surfaces alone do not tell a robot within a solid; where it crosses none, one of its points is enough
    const Nearest inside = obstacles.nearest(examiner.body().point(0), 0);
    if (inside.mesh >= 0 && inside.distance < 0)
      step.spot = {inside.distance - examiner.body().radius(0),
                   0,
                   inside.mesh,
                   inside.triangle,
                   examiner.body().point(0),
                   Vec3<double>(examiner.body().point(0) - inside.distance * inside.away)};
    if (!(step.spot.distance > 0)) return;
    const bool is_clear_if_off = !examiner.touches(off);
    step.verdict = is_clear_if_off ? InsertionVerdict::clear : InsertionVerdict::clear_if_taut;
    if (!is_clear_if_off) {
      const int here_level = clear_level(examiner, off, level.load());
      for (int known = level.load(); here_level < known && !level.compare_exchange_weak(known, here_level);) {
      }
    }
    if (k + 1 < steps.size() &&
        !is_clear_between(examiner, here, posture_of(steps[k + 1]), options.min_motion, deadline, poses[k]))
      step.verdict = InsertionVerdict::touches;
  });
  check.is_stopped = deadline.is_over();
  check.verdict = InsertionVerdict::clear;
  for (std::size_t k = 0; k < check.steps.size(); ++k) {
    check.poses += poses[k];
    check.verdict = std::max(check.verdict, check.steps[k].verdict);
    if (check.steps[k].spot.distance < check.steps[check.worst].spot.distance) check.worst = k;
  }
  check.allowed_share = static_cast<double>(level.load()) / share_levels;
  check.clearance = check.steps[check.worst].spot.distance;
  return check;
}

std::string exceeded_limit(const InsertionScene& scene, const InsertionStep& step) {
  if (const Report report = check_limits(scene.robot, step.bends); !report.ok())
    return std::string(report.message.view());
  if (step.stage >= 0 && step.stage <= scene.stage_limit) return {};
  return fmt::format("the stage is at {:.3f} mm, its limits are 0 and {:.3f} mm", 1e3 * step.stage,
                     1e3 * scene.stage_limit);
}

}  // namespace sinew::inline v1
