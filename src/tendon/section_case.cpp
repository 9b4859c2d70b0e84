#include "tendon/section_case.hpp"
#include "math/polygon.hpp"

#include <algorithm>

namespace sinew::inline v1 {
namespace {

constexpr double largest_bend = 1e6;  // [rad]; squares and products of bends stay far from infinity

std::vector<HalfPlane> envelope_sides(const DiagramQuestion& question) {
  const double limit = question.envelope.limit;
  std::vector<HalfPlane> sides;
  const auto strip = [&](const Vec2<double>& across, double half_width) {
    sides.push_back({across, -half_width});
    sides.push_back({-across, -half_width});
  };
  if (question.envelope.kind == Envelope::Kind::square) {
    strip({1, 0}, limit);
    strip({0, 1}, limit);
  } else if (question.envelope.kind == Envelope::Kind::actuator) {
    for (const auto& at : question.tendons.at) strip({at.cosine, at.sine}, limit / question.section.gain);
  }
  return sides;
}

/// Even spread is what least squares by (10) takes for granted: Σu = 0 and Σu uᵀ = n/2.
bool is_spread_evenly(std::span<const kernel::Direction<double>> at) {
  double x = 0, y = 0, double_x = 0, double_y = 0, off = 0;
  for (const auto& d : at) {
    x += d.cosine;
    y += d.sine;
    double_x += d.cosine * d.cosine - d.sine * d.sine;
    double_y += 2 * d.cosine * d.sine;
    off = std::max(off, std::abs(d.cosine * d.cosine + d.sine * d.sine - 1));
  }
  const double tolerance = 1e-9 * static_cast<double>(at.size());
  return off <= 1e-9 && std::hypot(x, y) <= tolerance && std::hypot(double_x, double_y) <= tolerance;
}

/// Whether the pulls of the exact model tell all bends of the envelope apart: half a turn of a joint with a
/// neutral backbone, a quarter about each axis of twin pivots, whose corners reach farther.
bool is_within_pulls(const SectionCase& c) {
  const kernel::Section<double>& section = c.question.section;
  double farthest = c.is_disc() ? c.question.envelope.limit : 0;
  for (const Vec2<double>& corner : c.corners)
    farthest = std::max(farthest, section.backbone == kernel::Backbone::neutral
                                      ? corner.norm()
                                      : std::max(std::abs(corner[0]), std::abs(corner[1])));
  return 2 * section.half * farthest < (section.backbone == kernel::Backbone::neutral ? 3.14 : 1.57);
}

}  // namespace

SectionCase::SectionCase(const DiagramQuestion& asked)
    : question(asked),
      at(asked.tendons.at),
      sides(envelope_sides(asked)) {
  double largest = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    own.push_back(kernel::tendon_slack(asked.tendons.changes[i], asked.earlier, at[i]));
    largest = std::max({largest, std::abs(own.back()), std::abs(asked.tendons.changes[i])});
  }
  if (!sides.empty()) corners = *intersection(sides);
  const double shared = is_exact() ? 0.01 * asked.section.length : 0;  // of the length joints lose by bending
  rounding = ulps * std::max({largest, asked.section.gain * 1e-3, shared});
}

kernel::Pull<double> SectionCase::pull(const Vec2<double>& bend) const {
  return kernel::pull(question.model, question.section, kernel::Bend<double>{bend[0], bend[1]});
}

Vec2<double> SectionCase::bend(const Vec2<double>& pull) const {
  const auto b = kernel::bend(question.model, question.section, pull[0], pull[1]);
  return {b.x, b.y};
}

double SectionCase::min_slack(const Vec2<double>& bend) const {
  const kernel::Pull<double> asked = pull(bend);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tendons(); ++i) least = std::min(least, slack(i, asked));
  return least;
}

double SectionCase::depth(const Vec2<double>& bend) const {
  if (is_disc()) return question.envelope.limit - bend.norm();
  double least = std::numeric_limits<double>::infinity();
  for (const HalfPlane& side : sides) least = std::min(least, side.depth(bend));
  return least;
}

std::vector<HalfPlane> frontiers(std::span<const kernel::Direction<double>> at, std::span<const double> own,
                                 double gain) {
  std::vector<HalfPlane> all;
  for (std::size_t i = 0; i < at.size(); ++i) all.push_back({{at[i].cosine, at[i].sine}, -own[i] / gain});
  return all;
}

std::string_view complaint(const SectionTendons& tendons, double gain) {
  if (tendons.at.size() < 3) return "a section needs at least 3 tendons";
  if (tendons.at.size() != tendons.changes.size()) return "each tendon needs one direction and one change";
  for (const double change : tendons.changes)
    if (!(std::abs(change) <= largest_bend * gain)) return "a change is not finite, or far beyond any bend";
  if (!is_spread_evenly(tendons.at)) return "tendons must be spread evenly around the discs";
  return {};
}

std::string_view complaint(const DiagramQuestion& question) {
  const kernel::Section<double>& section = question.section;
  const auto is_number = [](double x) { return x > 1e-100 && x < 1e100; };
  if (!is_number(section.length) || !is_number(section.gain) || !is_number(section.half) ||
      !(std::abs(section.per_gain * section.gain - 1) < 1e-9))
    return "length, gain and half of a section must be positive";
  if (const auto text = complaint(question.tendons, section.gain); !text.empty()) return text;
  for (const double pull : {question.earlier.x, question.earlier.y, question.earlier.common})
    if (!(std::abs(pull) <= largest_bend * section.gain))
      return "what earlier sections ask is not finite, or too much";
  if (!(question.tolerance >= 0)) return "the tolerance must not be negative";
  if (!(question.deviation > 0)) return "the deviation of sampled arcs must be positive";
  const double unit = question.envelope.kind == Envelope::Kind::actuator ? section.gain : 1;
  if (!(question.envelope.limit >= 0 && question.envelope.limit <= largest_bend * unit))
    return "the limit of the envelope must be in [0, 1e6 rad]";
  if (question.model == kernel::Model::exact && !is_within_pulls(SectionCase(question)))
    return "the exact model needs an envelope that bends no joint by half a turn, twin pivots by a quarter";
  return {};
}

}  // namespace sinew::inline v1
