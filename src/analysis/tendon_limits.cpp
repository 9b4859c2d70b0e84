#include "sinew/analysis/tendon_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/assert.hpp"
#include "sinew/kernel/arc.h"
#include "sinew/math/entire.hpp"

namespace sinew::inline v1 {
namespace {

/// A joint and a tendon at this distance from the backbone, towards the bend.
struct Gap {
  double length, offset;

  double linear(double bend) const { return -offset * bend; }
  /// s (L − offset β) − L.
  double exact(double bend) const {
    const double loss = kernel::chord_loss(0.25 * bend * bend);
    return length * loss - offset * bend * (1 + loss);
  }
  double exact_rate(double bend) const {
    return 0.5 * length * dsinc(0.5 * bend) - offset * std::cos(0.5 * bend);
  }

  /// Where the change is largest within ±limit ≤ π. The rate over cos(β/2) falls all the way, so that it has
  /// one root at most, and that is a maximum.
  double longest(double limit) const {
    double low = -limit, high = limit;
    if (!(exact_rate(low) > 0)) return low;
    if (!(exact_rate(high) < 0)) return high;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (exact_rate(middle) > 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  TendonTravel travel(double limit, kernel::Model model) const {
    if (model == kernel::Model::linear) {
      const double most = std::abs(linear(limit));
      return {-most, most};
    }
    return {std::min(exact(-limit), exact(limit)), exact(longest(limit))};
  }
};

TendonTravel operator+(const TendonTravel& a, const TendonTravel& b) {
  return {a.least + b.least, a.most + b.most};
}
TendonTravel operator*(double scale, const TendonTravel& a) { return {scale * a.least, scale * a.most}; }

/// What one joint may bend by about an axis.
double joint_limit(const Section& section) {
  return std::min(section.is_twin() ? section.limit : section.limit / section.segments, std::numbers::pi);
}

/// What a section of that length asks of a tendon that passes it at that angle.
TendonTravel bending_travel(const Section& section, double angle, kernel::Model model) {
  const double r = section.tendon_radius, limit = joint_limit(section);
  // A neutral backbone bends any way, and a tendon is moved most by bends in its own plane.
  if (!section.is_twin()) return section.segments * Gap{section.joint, r}.travel(limit, model);
  return 0.5 * section.segments *
         (Gap{section.joint, r * std::cos(angle)}.travel(limit, model) +
          Gap{section.joint, r * std::sin(angle)}.travel(limit, model));
}

/// The same with all its lengths: for each bend it is linear in the extension.
TendonTravel section_travel(const Section& section, double angle, kernel::Model model) {
  const double least = section.min_extension, most = section.max_extension;
  const TendonTravel shorter = bending_travel(section.extended(least), angle, model),
                     longer = bending_travel(section.extended(most), angle, model);
  return {std::min(shorter.least + least, longer.least + most),
          std::max(shorter.most + least, longer.most + most)};
}

}  // namespace

double bend_per_length(const Section& section) { return 1 / section.tendon_radius; }

std::vector<TendonTravel> tendon_travel(const SerialRobot& robot, kernel::Model model) {
  std::vector<TendonTravel> all;
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Section& own = robot.sections[m];
    for (int i = 0; i < own.tendons; ++i) {
      TendonTravel sum;
      for (std::size_t k = 0; k <= m; ++k)
        sum = sum + section_travel(robot.sections[k], own.angle_of(i), model);
      all.push_back(sum);
    }
  }
  return all;
}

std::vector<double> one_axis_travel(const SerialRobot& robot) {
  std::vector<double> all;
  double sum = 0;
  for (const Section& section : robot.sections) {
    const int joints = section.is_twin() ? section.segments / 2 : section.segments;
    all.push_back(sum += 2 * joints * section.tendon_radius * joint_limit(section));
  }
  return all;
}

double contact_bend(const Section& section) {
  return section.disc_radius > 0 ? section.joint / section.disc_radius
                                 : std::numeric_limits<double>::infinity();
}

double backbone_strain(const Section& section, const Bend& bend, double diameter) {
  const double joint = section.is_twin() ? bend.lpNorm<Eigen::Infinity>() : bend.norm() / section.segments;
  return 0.5 * diameter * joint / section.joint;
}

double bend_at_strain(const Section& section, double strain, double diameter) {
  return strain * section.joint / (0.5 * diameter);
}

double tendon_length(const SerialRobot& robot, int section, double outside) {
  SINEW_EXPECTS(section >= 0 && section < robot.section_count());
  double length = outside;
  for (int k = 0; k <= section; ++k) {
    const Section& passed = robot.sections[static_cast<std::size_t>(k)];
    length += passed.length() + passed.max_extension;
  }
  return length;
}

std::optional<double> tendon_stretch(const SerialRobot& robot, int section, double tension) {
  if (!robot.stretch) return std::nullopt;
  return tension * tendon_length(robot, section, robot.stretch->outside) / robot.stretch->stiffness;
}

ToleranceParts tolerance_parts(const SerialRobot& robot, int section, const TendonForces& forces) {
  return {robot.motor ? 1 / robot.motor->counts_per_length() : 0,
          tendon_stretch(robot, section, forces.tension).value_or(0),
          tendon_stretch(robot, section, forces.friction).value_or(0)};
}

}  // namespace sinew::inline v1
