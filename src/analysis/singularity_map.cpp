#include "sinew/analysis/singularity.hpp"

#include <cmath>

#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::size_t poses_between_reports = 256;

/// σmin/σmax from σmax/σmin, which is absent where J is singular to working precision.
double inverse_of(double condition) { return std::isfinite(condition) ? 1 / condition : 0; }

}  // namespace

PoseGrid PoseGrid::at(const AnyPose& pose) {
  PoseGrid grid;
  std::array<double, 6> values{};
  if (const auto* planar = std::get_if<PlanarPose>(&pose)) {
    values = {planar->x, planar->y, planar->phi};
  } else {
    grid.is_spatial = true;
    const auto frame = Spatial::frame(std::get<SpatialPose>(pose));
    const Vec3<double> turn = frame.R.log();
    values = {frame.p[0], frame.p[1], frame.p[2], turn[0], turn[1], turn[2]};
  }
  for (std::size_t a = 0; a < grid.axis_count(); ++a)
    grid.axes[a] = {.from = values[a], .to = values[a], .count = 1};
  return grid;
}

std::size_t PoseGrid::size() const {
  std::size_t product = 1;
  for (std::size_t a = 0; a < axis_count(); ++a) product *= static_cast<std::size_t>(axes[a].count);
  return product;
}

std::array<double, 6> PoseGrid::coordinates(std::size_t k) const {
  std::array<double, 6> values{};
  for (std::size_t a = 0; a < axis_count(); ++a) {
    const auto count = static_cast<std::size_t>(axes[a].count);
    values[a] = axes[a].at(static_cast<int>(k % count));
    k /= count;
  }
  return values;
}

AnyPose PoseGrid::pose(const std::array<double, 6>& coordinates) const {
  const auto [x, y, third, rx, ry, rz] = coordinates;
  if (!is_spatial) return PlanarPose{x, y, third};
  return spatial_pose(SE3<double>{Vec3<double>(x, y, third), SO3<double>::exp(Vec3<double>(rx, ry, rz))});
}

MapSample map_sample(const Robot& robot, const AnyPose& pose, const InverseOptions& branch, Workspace& work) {
  MapSample sample;
  const Inverse solved = inverse(robot, pose, branch, work);
  if (!solved.ok()) return sample;
  const Velocity at = velocity(robot, pose, solved.coordinates, work);
  sample.is_reachable = true;
  sample.is_type_2 = at.type_2.singular;
  sample.kind = at.type_2.kind;
  for (const int leg : at.type_1)
    if (leg < 32) sample.type_1 |= std::uint32_t{1} << leg;
  sample.determinant = at.determinant;
  sample.inverse_condition = inverse_of(at.indices.condition);
  sample.inverse_condition_homogenised = inverse_of(at.indices.condition_homogenised);
  return sample;
}

std::size_t visit_map(const Robot& robot, const PoseGrid& grid, const InverseOptions& branch, Workspace& work,
                      const TakeSample& take) {
  if (grid.is_spatial == is_planar(robot) || !check_workspace(robot, work).ok())
    return 0;  // not poses of this robot
  const std::size_t total = grid.size();
  for (std::size_t k = 0; k < total; ++k) {
    if (work.stop.stop_requested()) return k;
    if (!take(k, map_sample(robot, grid.pose(k), branch, work))) return k + 1;
  }
  return total;
}

SingularityMap singularity_map(const Robot& robot, const PoseGrid& grid, const InverseOptions& branch,
                               Workspace& work, const Progress& progress) {
  SingularityMap map{.grid = grid, .samples = {}};
  const std::size_t total = grid.size();
  if (progress && !progress(0, total)) return map;
  map.samples.reserve(total);
  visit_map(robot, grid, branch, work, [&](std::size_t k, const MapSample& sample) {
    map.samples.push_back(sample);
    const bool is_reported = progress && (k + 1) % poses_between_reports == 0 && k + 1 < total;
    return !is_reported || progress(k + 1, total);
  });
  if (progress && map.is_complete()) progress(total, total);
  return map;
}

}  // namespace sinew::inline v1
