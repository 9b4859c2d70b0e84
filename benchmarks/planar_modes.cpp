/// All assembly modes of a planar robot. Run: build/dev/bin/bench_planar_modes
/// The baseline is what one writes first: Newton on (x, y, φ) from starts all over the workspace, as many as
/// find every mode of these robots.
#include <fmt/format.h>

#include <Eigen/LU>
#include <memory>
#include <numbers>
#include <random>

#include "kinematics/modes/planar_modes.hpp"
#include "report.hpp"

namespace sinew::bench {
namespace {

using Legs = std::array<PlatformConstraint<2>, 3>;

double closure_error(const Legs& legs, const PlanarPose& pose) {
  double worst = 0;
  for (const PlatformConstraint<2>& leg : legs)
    worst = std::max(worst, std::abs((SE2<double>::from(pose).point(leg.platform_point) - leg.anchor).norm() -
                                     leg.distance));
  return worst;
}

/// Where Newton leads from a start.
PlanarPose newton(const Legs& legs, Eigen::Vector3d x) {
  for (int i = 0; i < 20; ++i) {
    Eigen::Vector3d g;
    Eigen::Matrix3d J;
    const auto platform = SE2<double>::from(x[0], x[1], x[2]);
    for (int k = 0; k < 3; ++k) {
      const auto& leg = legs[static_cast<std::size_t>(k)];
      const Vec2<double> arm = platform.rotate(leg.platform_point), d = platform.p + arm - leg.anchor;
      g[k] = 0.5 * (d.squaredNorm() - leg.distance * leg.distance);
      J.row(k) << d.x(), d.y(), cross(arm, d);
    }
    const Eigen::Vector3d step = J.partialPivLu().solve(g);
    x -= step;
    if (!x.allFinite()) return {};
    if (step.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return {x[0], x[1], wrap_angle(x[2])};
}

struct Found {
  int count = 0;
  std::array<PlanarPose, 8> poses;
};

Found multi_start(const Legs& legs, const std::vector<Eigen::Vector3d>& starts) {
  Found found;
  for (const Eigen::Vector3d& start : starts) {
    const PlanarPose pose = newton(legs, start);
    if (!(closure_error(legs, pose) < 1e-12) || found.count == 8) continue;
    bool is_new = true;
    for (int i = 0; i < found.count; ++i) {
      const PlanarPose& known = found.poses[static_cast<std::size_t>(i)];
      is_new &= std::abs(known.x - pose.x) + std::abs(known.y - pose.y) > 1e-8 ||
                std::abs(wrap_angle(known.phi - pose.phi)) > 1e-8;
    }
    if (is_new) found.poses[static_cast<std::size_t>(found.count++)] = pose;
  }
  return found;
}

std::vector<Eigen::Vector3d> scattered(int count) {
  std::mt19937 random{3};
  const auto uniform = [&](double half) {
    return std::uniform_real_distribution<double>(-half, half)(random);
  };
  std::vector<Eigen::Vector3d> starts;
  for (int i = 0; i < count; ++i)
    starts.emplace_back(uniform(0.25), uniform(0.25), uniform(std::numbers::pi));
  return starts;
}

/// Robots whose distances come from poses near the given one, so that the answer is known.
std::vector<Legs> around(const Legs& robot, const PlanarPose& pose) {
  std::vector<Legs> all;
  for (int i = 0; i < 256; ++i) {
    const double t = 2 * std::numbers::pi * i / 256;
    const auto at = SE2<double>::from(pose.x + 0.01 * std::cos(t), pose.y + 0.01 * std::sin(t),
                                      pose.phi + 0.1 * std::sin(2 * t + 0.3));
    all.push_back(robot);
    for (auto& leg : all.back()) leg.distance = (at.point(leg.platform_point) - leg.anchor).norm();
  }
  return all;
}

void compare_modes(const std::string& name, const std::vector<Legs>& given, int start_count) {
  auto all = std::make_shared<std::vector<Legs>>(given);
  auto starts = std::make_shared<std::vector<Eigen::Vector3d>>(scattered(start_count));
  double off = 0;
  int ours = 0, theirs = 0;
  for (const Legs& legs : *all) {
    const PlanarModes modes = planar_modes(legs);
    const Found found = multi_start(legs, *starts);
    ours += modes.count;
    theirs += found.count;
    for (int i = 0; i < found.count; ++i) {
      const PlanarPose& a = found.poses[static_cast<std::size_t>(i)];
      double nearest = 10;
      for (const PlanarPose& b : std::span(modes.poses).first(static_cast<std::size_t>(modes.count)))
        nearest = std::min(nearest, std::max({std::abs(a.x - b.x), std::abs(a.y - b.y),
                                              std::abs(wrap_angle(a.phi - b.phi))}));
      off = std::max(off, nearest);
    }
  }
  auto next = std::make_shared<std::size_t>(0);
  const auto step = [all, next] { return (*all)[*next = (*next + 1) % all->size()]; };
  compare({name + ", all modes", fmt::format("Newton from {} starts", start_count),
           [step] { benchmark::DoNotOptimize(planar_modes(step()).count); },
           [step, starts] { benchmark::DoNotOptimize(multi_start(step(), *starts).count); },
           fmt::format("{} modes against {} of {} robots, none off by more than {:.0e}", ours, theirs,
                       all->size(), off)});
}

Legs paper_example() {
  Legs legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const double foot = (90 + 120 * static_cast<double>(i)) * std::numbers::pi / 180,
                 head = foot - std::numbers::pi / 3;
    legs[i] = {0.19 * Vec2<double>(std::cos(foot), std::sin(foot)), 0,
               0.05 * Vec2<double>(std::cos(head), std::sin(head))};
  }
  return legs;
}

Legs six_modes() {
  using Point = Vec2<double>;
  return {{{Point(0, 0), 0.144, Point(-0.04, -0.03)},
           {Point(0.16, 0), 0.097, Point(0.07, -0.01)},
           {Point(0.03, 0.14), 0.196, Point(0, 0.05)}}};
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  compare_modes("3-RFR of TDPCR 5.1", around(paper_example(), {0, -0.01, 0}), 64);
  compare_modes("generic 3-RPR, six modes", {six_modes()}, 256);
  return sinew::bench::main(argc, argv);
}
