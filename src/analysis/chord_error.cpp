#include "analysis/chord_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/assert.hpp"
#include "sinew/kernel/arc.h"
#include "sinew/kinematics/serial.hpp"
#include "sinew/tendon/diagram.hpp"

namespace sinew::inline v1 {
namespace {

// ---------------------------------------------------------------- the series

/// cₖ of x/sin x = Σ cₖ x²ᵏ, from the product of the two series; 32 of them leave 2⁻⁶⁴ at x = π/2.
constexpr int terms = 32;
constexpr std::array<double, terms> inverse_sinc_terms() {
  std::array<double, terms> sinc{}, c{};
  double factorial = 1;
  for (int k = 0; k < terms; ++k) {
    sinc[static_cast<std::size_t>(k)] = (k % 2 == 0 ? 1.0 : -1.0) / factorial;
    factorial *= (2.0 * k + 2) * (2.0 * k + 3);
  }
  for (std::size_t k = 0; k < terms; ++k) {
    c[k] = k == 0 ? 1.0 : 0.0;
    for (std::size_t j = 1; j <= k; ++j) c[k] -= sinc[j] * c[k - j];
  }
  return c;
}
constexpr auto series = inverse_sinc_terms();

/// Σ weight(k) cₖ wᵏ from k = 1: any linear functional of e, given by what it makes of β²ᵏ.
template <class Weight>
double functional(double w, const Weight& weight) {
  double sum = 0;
  for (int k = terms - 1; k >= 1; --k)
    sum = w * (weight(double(k)) * series[static_cast<std::size_t>(k)] + sum);
  return sum;
}

double error_of_square(double square) {
  return functional(0.25 * square, [](double) { return 1.0; });
}

/// Where ∂e/∂(β²) is that slope, in β² from 0 to `end`; e is convex in β².
double square_of_slope(double slope, double end) {
  const auto rate = [](double square) {
    return square > 0 ? functional(0.25 * square, [](double k) { return k; }) / square : 1.0 / 24;
  };
  if (!(rate(0) < slope)) return 0;
  if (!(rate(end) > slope)) return end;
  double low = 0, high = end;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (rate(middle) < slope ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Convex in β² too, so it is largest at an end or where it turns.
double largest_miss(double coefficient, double constant, double end) {
  double most = 0;
  for (const double square : {0.0, end, square_of_slope(coefficient, end)})
    most = std::max(most, std::abs(error_of_square(square) - coefficient * square - constant));
  return most;
}

/// The c whose parabola is as far above e inside as below it at the end.
double minimax_coefficient(double end) {
  double low = 1.0 / 24, high = error_of_square(end) / end;
  for (int i = 0; i < 60; ++i) {
    const double c = 0.5 * (low + high), turn = square_of_slope(c, end);
    const double above = c * turn - error_of_square(turn), below = error_of_square(end) - c * end;
    (above < below ? low : high) = c;
  }
  return 0.5 * (low + high);
}

}  // namespace

double chord_error(double bend) {
  const double loss = kernel::chord_loss(0.25 * bend * bend);
  return -loss / (1 + loss);
}

ChordErrors chord_errors(double range) {
  SINEW_EXPECTS(range >= 0 && range <= std::numbers::pi);
  return {chord_error(range), functional(0.25 * range * range, [](double k) { return 1 / (2 * k + 1); })};
}

Quadratic fit_chord_error(QuadraticFit fit, double range) {
  SINEW_EXPECTS(range > 0 && range <= std::numbers::pi);
  const double end = range * range, w = 0.25 * end;
  Quadratic out{1.0 / 24, 0, 0};
  switch (fit) {
    case QuadraticFit::least_squares:  // ∫ e β² / ∫ β⁴
      out.coefficient = functional(w, [](double k) { return 5 / (2 * k + 3); }) / end;
      break;
    case QuadraticFit::with_constant:  // the part of e along the second Legendre polynomial; means are equal
      out.coefficient = functional(w, [](double k) { return 15 * k / ((2 * k + 1) * (2 * k + 3)); }) / end;
      out.constant = chord_errors(range).mean - out.coefficient * end / 3;
      break;
    case QuadraticFit::minimax:
      out.coefficient = minimax_coefficient(end);
      break;
    case QuadraticFit::taylor:
      break;
    case QuadraticFit::endpoint:
      out.coefficient = error_of_square(end) / end;
      break;
  }
  out.largest_miss = largest_miss(out.coefficient, out.constant, end);
  return out;
}

TendonLengths lengths_at_equal_bends(const SerialRobot& robot, double bend, double direction) {
  const kernel::Bend<double> both{bend, bend};
  const auto at = kernel::direction<double>(direction);
  double straight = 0;
  kernel::Pull<double> exact{}, linear{};
  for (const Section& section : robot.sections) {
    straight += section.arc_length();
    exact = exact + kernel::exact_pull(section.map(), both);
    linear = linear + kernel::linear_pull(section.map(), both);
  }
  return {straight + kernel::tendon_change(exact, at), straight + kernel::tendon_change(linear, at)};
}

// ---------------------------------------------------------------- random poses

namespace {

/// Of distances, which are sorted for it.
Distances spread_of(std::vector<double>& all) {
  if (all.empty()) return {};
  Distances out;
  std::ranges::sort(all);
  for (const double distance : all) out.mean += distance;
  out.mean /= static_cast<double>(all.size());
  out.p95 = all[static_cast<std::size_t>(0.95 * static_cast<double>(all.size() - 1))];
  out.largest = all.back();
  return out;
}

/// Evenly from −1 to 1; the library's distributions differ from one implementation to the next.
double share(std::mt19937& random) { return 2 * (static_cast<double>(random()) + 0.5) * 0x1p-32 - 1; }

Bend random_bend(const Section& section, std::mt19937& random) {
  double x = share(random), y = share(random);
  while (!section.is_twin() && x * x + y * y > 1) {
    x = share(random);
    y = share(random);
  }
  return {section.limit * x, section.limit * y};
}

Vec<double, 3> tip(const std::vector<Bend>& bends, SerialWorkspace& work) {
  section_ends(bends, work);
  return work.ends.back().p;
}

/// How far the two tips are from where a pose has its own [m].
struct LinearPose {
  bool has_arcs;
  double commanded, read_back;
};

LinearPose linear_pose(const SerialRobot& robot, const std::vector<Bend>& meant, SerialWorkspace& work) {
  const Vec<double, 3> there = tip(meant, work);
  tendon_changes(meant, kernel::Model::linear, work);
  std::vector<double> changes = work.changes;
  LinearPose out{};
  out.has_arcs = bends_of_changes(robot, changes, kernel::Model::exact, work).status != Status::unreachable;
  out.commanded = (tip(work.bends, work) - there).norm();
  tendon_changes(meant, kernel::Model::exact, work);
  changes = work.changes;
  bends_of_changes(robot, changes, kernel::Model::linear, work);
  out.read_back = (tip(work.bends, work) - there).norm();
  return out;
}

/// What LSK forgets of the tendons of each section: the length that chords lack.
void add_slack(const SerialRobot& robot, const std::vector<Bend>& bends,
               std::vector<std::vector<double>>& slack) {
  double sum = 0;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    sum -= kernel::exact_pull(robot.sections[m].map(), {bends[m].x(), bends[m].y()}).common;
    slack[m].push_back(sum);
  }
}

}  // namespace

LinearConsequences linear_consequences(const SerialRobot& robot, int poses, std::uint32_t seed) {
  SINEW_EXPECTS(!robot.is_extensible());
  SINEW_EXPECTS(std::ranges::all_of(robot.sections, [](const Section& s) { return std::isfinite(s.limit); }));
  std::mt19937 random(seed);
  SerialWorkspace work(robot);
  std::vector<Bend> bends(robot.sections.size());
  std::vector<double> commanded, read_back;
  std::vector<std::vector<double>> slack(robot.sections.size());
  LinearConsequences out;
  for (int i = 0; i < poses; ++i) {
    for (std::size_t m = 0; m < bends.size(); ++m) bends[m] = random_bend(robot.sections[m], random);
    const LinearPose pose = linear_pose(robot, bends, work);
    if (!pose.has_arcs) {
      ++out.left_out;
      continue;
    }
    commanded.push_back(pose.commanded);
    read_back.push_back(pose.read_back);
    add_slack(robot, bends, slack);
  }
  out.commanded = spread_of(commanded);
  out.read_back = spread_of(read_back);
  for (std::vector<double>& of_section : slack) out.slack.push_back(spread_of(of_section));
  return out;
}

std::vector<LinearSlack> largest_linear_slack(const SerialRobot& robot) {
  SINEW_EXPECTS(!robot.is_extensible());
  std::vector<LinearSlack> all;
  double sum = 0;
  for (const Section& section : robot.sections) {
    const double limit = section.limit;
    sum -= kernel::exact_pull(section.map(), {limit, section.is_twin() ? limit : 0}).common;
    all.push_back({sum, sum / section.tendon_radius});
  }
  return all;
}

double linear_freedom(const Section& section, const Bend& bend) {
  const auto map = section.map();
  const auto pull = kernel::linear_pull(map, {bend.x(), bend.y()});
  std::vector<kernel::Direction<double>> at;
  std::vector<double> changes;
  for (int i = 0; i < section.tendons; ++i) {
    at.push_back(section.direction(i));
    changes.push_back(kernel::tendon_change(pull, at.back()));
  }
  const bool twin = section.is_twin();
  const double wide = 0.49 * std::numbers::pi * (twin ? 1 : 2 * section.segments);
  DiagramQuestion question{map, {at, changes}, {twin ? Envelope::Kind::square : Envelope::Kind::disc, wide}};
  question.model = kernel::Model::exact;
  question.deviation = 1e-6;
  const SectionDiagram diagram = section_diagram(question);
  if (!diagram.report.ok()) return std::numeric_limits<double>::quiet_NaN();
  double farthest = 0;
  for (const Vec2<double>& corner : diagram.boundary) farthest = std::max(farthest, (corner - bend).norm());
  return farthest;
}

}  // namespace sinew::inline v1
