#include "study/tripod/example.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "math/tilt.hpp"
#include "robot/parallel.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1::tripod {
namespace {

using std::numbers::pi;
using HingedLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;

constexpr double degree = pi / 180;

void add_point(Series& series, double radius, double direction) {
  series.x.push_back(radius * std::cos(direction));
  series.y.push_back(radius * std::sin(direction));
}

/// One arc of the forward locus, from the inverse locus to the inverse locus, about a direction of 60°, 180°
/// or 300°; by its symmetry computed between 0° and 60° only.
void add_arc(const TripodSize& size, double middle, Series& series) {
  constexpr int half = 60;
  const double end = gap(size);
  for (int k = -half; k <= half; ++k) {
    const double off = std::abs(k) / static_cast<double>(half) * (pi / 3 - end);
    const double radius = std::abs(k) == half ? inverse_radius(size, end)
                                              : forward_locus(size, pi / 3 - off).value_or(not_a_number);
    add_point(series, radius, middle + (k < 0 ? -off : off));
  }
}

/// ∫ ρ² dα of the inverse locus from direction 0 to one up to 30°: ∫ dα/(3 cos² α − sin² α), t = tan α.
double inverse_sector(const TripodSize& size, double direction) {
  using std::numbers::sqrt3;
  const double t = std::tan(direction);
  const double factor = (size.platform_radius - size.base_radius + size.strut_length) / size.platform_radius;
  return factor / (2 * sqrt3) * std::log((sqrt3 + t) / (sqrt3 - t));
}

}  // namespace

TripodSize size_of(const Robot& robot) {
  const auto legs = legs_of<HingedLeg>(robot).legs;
  if (legs.empty()) return {not_a_number, not_a_number, not_a_number};
  const auto& leg = legs.front();
  return {leg.base.p.norm(), leg.platform_point.norm(), leg.closure.length};
}

Robot with_platform_radius(const Robot& robot, double radius) {
  return with_changed_legs(robot,
                           [&](auto& leg) { leg.platform_point *= radius / leg.platform_point.norm(); });
}

double tilt(double radius) {
  const double rest = std::sqrt((1 - radius) * (1 + radius));
  return tilt_torsion({rest, Vec3<double>(radius, 0, 0)}).tilt / degree;
}

// ---------------------------------------------------------------- places

std::vector<double> places() {
  std::vector<double> values;
  for (int k = -50; k <= 50; ++k) values.push_back(k / 50.0);
  return values;
}

bool Sample::is_reached() const { return !std::isnan(forward_norm); }
double Sample::frobenius() const { return std::hypot(rises[0], rises[1], rises[2]); }
double Sample::largest() const { return is_reached() ? *std::ranges::max_element(rises) : not_a_number; }
double Sample::smallest() const { return is_reached() ? *std::ranges::min_element(rises) : not_a_number; }

Sample sample(const Robot& robot, const IndependentPose& at, Workspace& work) {
  Sample out{at.e1,        at.e2,        {not_a_number, not_a_number, not_a_number},
             not_a_number, not_a_number, not_a_number,
             not_a_number};
  const ConstrainedPose place = constrained_pose(robot, at);
  if (!place.ok()) return out;
  const Inverse legs = inverse(robot, place.pose, {}, work);
  if (!legs.ok()) return out;
  const Velocity rates = velocity(robot, place.pose, legs.coordinates, work);
  for (Eigen::Index i = 0; i < 3; ++i) out.rises[static_cast<std::size_t>(i)] = rates.K(i, i);
  out.forward_norm = rates.J.norm();
  out.determinant = rates.determinant;
  out.position = rates.indices.position;
  out.rotation = rates.indices.rotation;
  return out;
}

std::vector<Sample> samples(const Robot& robot, Workspace& work) {
  std::vector<Sample> all;
  for (const double e2 : places())
    for (const double e1 : places()) all.push_back(sample(robot, {height, e1, e2}, work));
  return all;
}

double change_with_height(const Robot& robot, const std::vector<Sample>& all,
                          const std::function<double(const Sample&, const Sample&)>& off, Workspace& work) {
  double most = 0;
  for (std::size_t k = 0; k < all.size(); k += 7) {
    const Sample other = sample(robot, {other_height, all[k].e1, all[k].e2}, work);
    if (all[k].is_reached() != other.is_reached()) return not_a_number;
    if (!other.is_reached()) continue;
    const double here = off(all[k], other);
    most = here <= most ? most : here;
  }
  return most;
}

// ---------------------------------------------------------------- loci

double inverse_radius(const TripodSize& size, double direction) {
  const double off = std::remainder(direction, pi / 3), c = std::cos(off);
  const double factor = (size.platform_radius - size.base_radius + size.strut_length) / size.platform_radius;
  return std::sqrt(factor / (4 * c * c - 1));
}

double gap(const TripodSize& size) {
  constexpr double inside = 1 - 1e-12;  // on the locus itself rounding decides whether a strut reaches
  const double sign = tripod_determinant(size, 0, 0) < 0 ? -1 : 1;
  double low = 0, high = pi / 6;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high), radius = inside * inverse_radius(size, middle);
    const double value = tripod_determinant(size, radius * std::cos(middle), radius * std::sin(middle));
    (sign * value > 0 ? low : high) = middle;
  }
  return low;
}

Areas areas(const TripodSize& size) {
  constexpr int pieces = 120;  // even, of Simpson's rule over the forward locus between the gap and 60°
  const double end = gap(size), step = (pi / 3 - end) / pieces;
  double sum = 0;
  for (int k = 0; k <= pieces; ++k) {
    const double radius =
        k == 0 ? inverse_radius(size, end) : forward_locus(size, end + k * step).value_or(not_a_number);
    sum += (k == 0 || k == pieces ? 1 : k % 2 ? 4 : 2) * radius * radius;
  }
  // of twelve sectors of 30° the inverse locus; of six of 60° the first: each half of ∫ ρ² dα
  return {6 * inverse_sector(size, pi / 6), 3 * (inverse_sector(size, end) + sum * step / 3)};
}

// ---------------------------------------------------------------- drawing

Series circle(double radius, Mark mark, Colour colour, double width) {
  Series series{.label = {}, .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  for (int k = 0; k <= 360; ++k) add_point(series, radius, k * degree);
  return series;
}

Series inverse_curve(const TripodSize& size, Mark mark, double width) {
  Series series{.label = {}, .x = {}, .y = {}, .mark = mark, .colour = Colour::black, .width = width};
  for (int k = 0; k < 360; ++k) add_point(series, inverse_radius(size, k * degree), k * degree);
  return series;
}

Series forward_curve(const TripodSize& size, double width) {
  Series series{
      .label = {}, .x = {}, .y = {}, .mark = Mark::line, .colour = Colour::vermillion, .width = width};
  for (const int middle : {60, 180, 300}) {
    add_arc(size, middle * degree, series);
    series.x.push_back(not_a_number);
    series.y.push_back(not_a_number);
  }
  return series;
}

Series first_curve(const TripodSize& size) {
  Series series{.label = {}, .x = {}, .y = {}, .mark = Mark::polygon, .colour = Colour::green, .width = 0.5};
  const double end = gap(size);
  for (const int middle : {60, 180, 300}) {
    add_arc(size, middle * degree, series);
    for (int k = -9; k <= 9; ++k) {
      const double direction = (middle + 60) * degree + k * end / 10;
      add_point(series, inverse_radius(size, direction), direction);
    }
  }
  return series;
}

HeatMap map_of(std::vector<double> values, std::string label) {
  return {.x = places(), .y = places(), .values = std::move(values), .label = std::move(label)};
}

Panel plane(std::string title) {
  return {.title = std::move(title),
          .x = {.label = "e₁", .unit = "", .low = -1, .high = 1, .step = 0.5},
          .y = {.label = "e₂", .unit = "", .low = -1, .high = 1, .step = 0.5},
          .series = {},
          .notes = {},
          .legend = Legend::none,
          .equal_aspect = true};
}

Panel map_panel(const TripodSize& size, std::string title, HeatMap map,
                const std::vector<contour::Levels>& levels) {
  Panel panel = plane(std::move(title));
  panel.legend = Legend::below;
  panel.map = contour::spread(std::move(map));
  contour::add(panel, levels);
  panel.series.push_back(inverse_curve(size, Mark::outside, 1));
  panel.series.push_back(circle(1, Mark::line, Colour::grey, 1));
  panel.series.push_back(inverse_curve(size, Mark::outline, 2));
  panel.series.back().label = "IK singular, (19)";
  panel.series.push_back(forward_curve(size, 2));
  panel.series.back().label = "FK singular, det = 0";
  return panel;
}

}  // namespace sinew::inline v1::tripod
