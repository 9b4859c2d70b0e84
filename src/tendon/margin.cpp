#include "tendon/margin.hpp"
#include "math/polygon.hpp"

#include <limits>
#include <numbers>

namespace sinew::inline v1 {
namespace {

/// The best of what is offered.
class Best {
 public:
  explicit Best(const SectionCase& c) : c_(c) {}

  void offer(const Vec2<double>& bend) {
    if (!c_.allows(bend)) return;
    const double slack = c_.min_slack(bend);
    if (!(slack > found.slack + c_.rounding)) return;
    found = {bend, slack};
  }

  Margin found{{0, 0}, -std::numeric_limits<double>::infinity()};

 private:
  const SectionCase& c_;
};

/// Pulls at which tendons i and j have the same slack: a straight line in both models, as the length lost is
/// shared.
HalfPlane bisector(const SectionCase& c, std::size_t i, std::size_t j) {
  const Vec2<double> apart = c.direction(i) - c.direction(j);
  const double length = apart.norm();
  return {apart / length, (c.own[j] - c.own[i]) / length};
}

/// Bends at which three tendons have the same slack.
void offer_threes(const SectionCase& c, Best& best) {
  for (std::size_t i = 0; i < c.tendons(); ++i)
    for (std::size_t j = i + 1; j < c.tendons(); ++j)
      for (std::size_t k = j + 1; k < c.tendons(); ++k)
        if (const auto pull = crossing(bisector(c, i, j), bisector(c, i, k))) best.offer(c.bend(*pull));
}

/// Bends on the rim at which two tendons have the same slack, in the linear model.
void offer_twos(const SectionCase& c, Best& best) {
  for (std::size_t i = 0; i < c.tendons(); ++i)
    for (std::size_t j = i + 1; j < c.tendons(); ++j) {
      HalfPlane line = bisector(c, i, j);
      line.offset /= c.question.section.gain;
      for (const HalfPlane& side : c.sides)
        if (const auto bend = crossing(line, side)) best.offer(*bend);
      const double limit = c.question.envelope.limit;
      if (!c.is_disc() || !(std::abs(line.offset) <= limit)) continue;
      const double half = std::sqrt((limit - line.offset) * (limit + line.offset));
      for (const double along : {half, -half})
        best.offer(line.offset * line.normal + along * perp(line.normal));
    }
}

/// Bends on the rim that are best for one tendon, in the linear model.
void offer_ones(const SectionCase& c, Best& best) {
  for (const Vec2<double>& corner : c.corners) best.offer(corner);
  if (c.is_disc())
    for (std::size_t i = 0; i < c.tendons(); ++i) best.offer(c.question.envelope.limit * c.direction(i));
}

/// The largest least slack between two fractions of a piece of the rim, of which there is one.
double climb(const SectionCase& c, std::size_t piece, double low, double high) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  const auto value = [&](double t) { return c.min_slack(rim(c, piece, t)); };
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = value(left), at_right = value(right);
  while (high - low > 1e-16 && left < right) {
    if (at_left < at_right) {
      low = left, left = right, at_left = at_right;
      right = low + golden * (high - low), at_right = value(right);
    } else {
      high = right, right = left, at_right = at_left;
      left = high - golden * (high - low), at_left = value(left);
    }
  }
  return at_left < at_right ? right : left;
}

/// The rim in the exact model, whose slack is a smooth curve there for each tendon.
void offer_rim(const SectionCase& c, Best& best) {
  constexpr int samples = 64;
  std::vector<double> value(samples + 1);
  for (std::size_t piece = 0; piece < rim_pieces(c); ++piece) {
    for (int k = 0; k <= samples; ++k)
      value[std::size_t(k)] = c.min_slack(rim(c, piece, k / double(samples)));
    for (int k = 0; k <= samples; ++k) {
      const int before = std::max(k - 1, 0), after = std::min(k + 1, samples);
      if (value[std::size_t(k)] < std::max(value[std::size_t(before)], value[std::size_t(after)])) continue;
      best.offer(rim(c, piece, climb(c, piece, before / double(samples), after / double(samples))));
      best.offer(rim(c, piece, k / double(samples)));
    }
  }
}

}  // namespace

std::size_t rim_pieces(const SectionCase& c) { return c.is_disc() ? 4 : c.corners.size(); }

Vec2<double> rim(const SectionCase& c, std::size_t piece, double t) {
  if (!c.is_disc()) return (1 - t) * c.corners[piece] + t * c.corners[(piece + 1) % c.corners.size()];
  const double angle = (static_cast<double>(piece) + t) * std::numbers::pi / 2;
  return c.question.envelope.limit * Vec2<double>(std::cos(angle), std::sin(angle));
}

// Linear: the margin is a linear program in (x, slack), or one with a disc, and best where three of its
// constraints hold: slacks of three tendons, of two and the rim, of one and a corner of the rim or the point
// of a circle farthest its way. All are tried; none is trusted to be feasible before it is evaluated, so
// degenerate ones do no harm.
//
// Exact: where tendon i is the shortest, its slack is convex in the pulls, and that part of the plane has
// straight frontiers. A convex function is largest at a corner: three equal slacks, or the rim.
Margin largest_margin(const SectionCase& c, const Vec2<double>& first) {
  Best best(c);
  best.offer(first);
  offer_threes(c, best);
  if (c.is_exact()) {
    offer_rim(c, best);
  } else {
    offer_twos(c, best);
    offer_ones(c, best);
  }
  return best.found;
}

}  // namespace sinew::inline v1
