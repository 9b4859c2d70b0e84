#include "tendon/exact_region.hpp"

#include <algorithm>
#include <optional>

namespace sinew::inline v1 {
namespace {

/// Largest pull a bend of the envelope asks for [m].
double reach(const SectionCase& c) {
  double farthest = 0;
  for (std::size_t piece = 0; piece < rim_pieces(c); ++piece)
    for (int k = 0; k < 16; ++k) {
      const kernel::Pull<double> pull = c.pull(rim(c, piece, k / 16.0));
      farthest = std::max(farthest, std::hypot(pull.x, pull.y));
    }
  return farthest;
}

/// Zero of a function that is < 0 at `low` and not at `high`, between them, by false position (Illinois): on
/// the side where it is not negative.
template <class F>
bool find_zero(const F& f, double low, double high, double& zero) {
  double f_low = f(low), f_high = f(high);
  if (!(f_low < 0) || !(f_high >= 0)) return false;
  int side = 0;
  for (int k = 0; k < 200 && f_high > 0; ++k) {
    double x = high - f_high * ((high - low) / (f_high - f_low));
    if (k > 20 || !(x > low && x < high)) x = 0.5 * (low + high);
    if (x == low || x == high) break;
    const double value = f(x);
    if (value < 0) {
      low = x, f_low = value;
      if (side == -1) f_high *= 0.5;
      side = -1;
    } else {
      high = x, f_high = value;
      if (side == 1) f_low *= 0.5;
      side = 1;
    }
  }
  zero = high;
  return true;
}

/// The frontier of one tendon as a curve over its direction's normal, in the plane of pulls. There its slack
/// is convex: along uᵢ, from stretch to slack, it has one zero.
class Frontier {
 public:
  Frontier(const SectionCase& c, std::size_t i, double reach_of_c)
      : c_(c),
        tendon_(i),
        along_(c.direction(i)),
        far_(std::min(1.5 * reach_of_c, c.question.section.gain / c.question.section.half)) {}

  /// From t = 0 to 1 with slack to the left. False where it does not pass.
  bool at(double t, Vec2<double>& bend) const {
    const Line line = across(t);
    double zero = 0;
    if (!find_zero([&](double a) { return slack(line, a); }, -line.half, line.half, zero)) return false;
    bend = c_.bend(line.start + zero * along_);
    return true;
  }

  /// Whether a line along uᵢ leaves the slack, is stretched and slack again: bending takes more off the
  /// length than the tendon's pull gives back, and the frontier is no curve over the normal.
  bool folds(double t) const {
    const Line line = across(t);
    double low = -line.half, high = line.half;
    if (slack(line, low) < 0 || slack(line, low) <= slack(line, low + 1e-6 * (high - low))) return false;
    for (int k = 0; k < 60; ++k) {  // towards the least
      const double third = (high - low) / 3;
      if (slack(line, low + third) < slack(line, high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    return slack(line, low) < 0;
  }

 private:
  struct Line {
    Vec2<double> start;
    double half;  ///< as long as there are bends with such pulls
  };
  Line across(double t) const {
    const Vec2<double> start = far_ * (1 - 2 * t) * perp(along_);
    return {start, std::sqrt(std::max(0.0, far_ * far_ - start.squaredNorm()))};
  }
  double slack(const Line& line, double a) const {
    return c_.slack(tendon_, c_.pull(c_.bend(line.start + a * along_)));
  }

  const SectionCase& c_;
  std::size_t tendon_;
  Vec2<double> along_;
  double far_;
};

/// An arc of the boundary, interior to its left.
struct BoundaryArc {
  Polygon points;
  double area;  ///< swept from the middle, ½∮(x − middle) × dx
};

/// Arcs of the boundary that lie on one curve: where every other tendon is long enough and the envelope holds
/// it.
class Walk {
 public:
  /// @param curve 0 to n − 1: frontiers; then the pieces of the rim
  Walk(const SectionCase& c, std::size_t curve, double reach_of_c, const Vec2<double>& middle)
      : c_(c),
        curve_(curve),
        frontier_(c, std::min(curve, c.tendons() - 1), reach_of_c),
        middle_(middle),
        fine_(std::min(c.question.deviation, 1e-5 * reach_of_c / c.question.section.gain)) {}

  void append_arcs(std::vector<BoundaryArc>& arcs) const;

 private:
  struct Knot {
    double t, room;
  };

  bool at(double t, Vec2<double>& bend) const {
    if (curve_ < c_.tendons()) return frontier_.at(t, bend);
    bend = rim(c_, curve_ - c_.tendons(), t);
    return true;
  }
  double room(double t) const;
  Knot extreme(double low, double high, double sign) const;
  std::vector<Knot> knots() const;
  double end(double in, double out) const;
  void sample(BoundaryArc& arc, double from, const Vec2<double>& a, double to, const Vec2<double>& b,
              int depth) const;

  const SectionCase& c_;
  std::size_t curve_;
  Frontier frontier_;
  Vec2<double> middle_;
  double fine_;
};

/// Of what else must hold at a point of the curve: ≥ 0 where it does [m].
double Walk::room(double t) const {
  Vec2<double> bend;
  if (!at(t, bend)) return -1;
  if (curve_ >= c_.tendons()) return c_.min_slack(bend);
  double least = c_.question.section.gain * c_.depth(bend);
  const kernel::Pull<double> pull = c_.pull(bend);
  for (std::size_t j = 0; j < c_.tendons(); ++j)
    if (j != curve_) least = std::min(least, c_.slack(j, pull));
  return least;
}

/// Where sign · room is largest, by golden section, or as soon as it is > 0.
Walk::Knot Walk::extreme(double low, double high, double sign) const {
  constexpr double golden = 0.6180339887498949;
  Knot left{high - golden * (high - low), 0}, right{low + golden * (high - low), 0};
  left.room = room(left.t), right.room = room(right.t);
  for (int k = 0; k < 60; ++k) {
    if (sign * left.room > 0) return left;
    if (sign * right.room > 0) return right;
    if (sign * left.room < sign * right.room) {
      low = left.t, left = right;
      right.t = low + golden * (high - low), right.room = room(right.t);
    } else {
      high = right.t, right = left;
      left.t = high - golden * (high - low), left.room = room(left.t);
    }
  }
  return left;
}

/// Points between which the room changes its sign at most once: even samples, and where it turns back before
/// zero.
std::vector<Walk::Knot> Walk::knots() const {
  constexpr int samples = 128;
  std::vector<Knot> even, all;
  for (int k = 0; k <= samples; ++k) even.push_back({k / double(samples), room(k / double(samples))});
  for (std::size_t k = 0; k < even.size(); ++k) {
    all.push_back(even[k]);
    if (k == 0 || k + 1 == even.size()) continue;
    const double sign = even[k].room < 0 ? 1 : -1, here = sign * even[k].room;
    const double before = sign * even[k - 1].room, after = sign * even[k + 1].room;
    if (here >= before && here >= after && here > std::min(before, after) && std::max(before, after) <= 0)
      all.push_back(extreme(even[k - 1].t, even[k + 1].t, sign));
  }
  std::sort(all.begin(), all.end(), [](const Knot& a, const Knot& b) { return a.t < b.t; });
  return all;
}

/// The last point within.
double Walk::end(double in, double out) const {
  for (double middle = 0.5 * (in + out); middle != in && middle != out; middle = 0.5 * (in + out))
    (room(middle) >= 0 ? in : out) = middle;
  return in;
}

void Walk::sample(BoundaryArc& arc, double from, const Vec2<double>& a, double to, const Vec2<double>& b,
                  int depth) const {
  Vec2<double> middle;
  const double t = 0.5 * (from + to);
  if (!at(t, middle)) middle = 0.5 * (a + b);
  const Vec2<double> chord = b - a;
  const double bulge = cross(middle - a, b - middle);  // twice the triangle over the chord
  if (depth < 3 || (depth < 16 && std::abs(bulge) > fine_ * chord.norm())) {
    sample(arc, from, a, t, middle, depth + 1);
    sample(arc, t, middle, to, b, depth + 1);
    return;
  }
  arc.area +=
      0.5 * cross(a - middle_, b - middle_) + 2.0 / 3 * bulge;  // between chord and parabola: 4/3 triangles
  arc.points.push_back(b);
}

void Walk::append_arcs(std::vector<BoundaryArc>& arcs) const {
  const std::vector<Knot> all = knots();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].room < 0) continue;
    const double from = k == 0 ? all[k].t : end(all[k].t, all[k - 1].t);
    while (k + 1 < all.size() && all[k + 1].room >= 0) ++k;
    const double to = k + 1 == all.size() ? all[k].t : end(all[k].t, all[k + 1].t);
    Vec2<double> a, b;
    if (!(from < to) || !at(from, a) || !at(to, b)) continue;
    BoundaryArc arc{{a}, 0};
    sample(arc, from, a, to, b, 0);
    arcs.push_back(std::move(arc));
  }
}

/// Takes from the arcs those that make one closed curve.
BoundaryArc take_loop(std::vector<BoundaryArc>& arcs, double tolerance, bool& closed) {
  BoundaryArc loop = std::move(arcs.back());
  arcs.pop_back();
  for (;;) {
    const Vec2<double> end = loop.points.back();
    const auto apart = [&](const BoundaryArc& arc) { return (arc.points.front() - end).norm(); };
    const auto next =
        std::min_element(arcs.begin(), arcs.end(),
                         [&](const BoundaryArc& a, const BoundaryArc& b) { return apart(a) < apart(b); });
    const double to_start = (loop.points.front() - end).norm();
    if (next == arcs.end() || to_start <= apart(*next)) {
      closed = closed && to_start <= tolerance;
      loop.points.pop_back();
      return loop;
    }
    closed = closed && apart(*next) <= tolerance;
    loop.points.insert(loop.points.end(), next->points.begin() + 1, next->points.end());
    loop.area += next->area;
    arcs.erase(next);
  }
}

struct Sample {
  double t;
  std::optional<Vec2<double>> bend;  ///< none: it does not pass there
};
Sample sample(const Frontier& frontier, double t) {
  Vec2<double> bend;
  return frontier.at(t, bend) ? Sample{t, bend} : Sample{t, {}};
}

/// What a chord is to be divided at a half for: the arc leaves it, or its end lies within.
bool is_chord(const Sample& from, const Sample& middle, const Sample& to, double deviation) {
  if (!from.bend || !middle.bend || !to.bend) return false;
  const Vec2<double> chord = *to.bend - *from.bend, off = *middle.bend - *from.bend;
  return std::abs(perp(chord).dot(off)) <= deviation * chord.norm();
}

/// Points after the first up to the last, so that no chord is farther from the frontier than that.
void refine(const Frontier& frontier, const Sample& from, const Sample& to, double deviation, Curve& curve) {
  constexpr double finest = 1.0 / 256;
  if (to.t - from.t > finest) {
    const Sample middle = sample(frontier, (from.t + to.t) / 2);
    if (!is_chord(from, middle, to, deviation)) {
      refine(frontier, from, middle, deviation, curve);
      return refine(frontier, middle, to, deviation, curve);
    }
  }
  if (to.bend) curve.push_back(*to.bend);
}

}  // namespace

// Every curve that bounds the set is walked along, and what others leave of it is kept; no shape of the set
// is taken for granted. Along a frontier the slack of another tendon less its own is linear in the pulls, so
// there are few changes.
ExactRegion exact_region(const SectionCase& c, const Margin& margin) {
  if (margin.slack < -c.rounding) return {};
  if (margin.slack <= c.rounding || !(c.question.envelope.limit > 0)) return {{margin.point}, 0, 1, true};
  const double reach_of_c = reach(c);
  std::vector<BoundaryArc> arcs;
  for (std::size_t curve = 0; curve < c.tendons() + rim_pieces(c); ++curve)
    Walk(c, curve, reach_of_c, margin.point).append_arcs(arcs);
  ExactRegion region;
  for (std::size_t i = 0; i < c.tendons(); ++i)
    for (int k = 1; k < 64; ++k) region.closed = region.closed && !Frontier(c, i, reach_of_c).folds(k / 64.0);
  double largest = 0;
  while (!arcs.empty()) {
    BoundaryArc loop = take_loop(arcs, 1e-6 * reach_of_c / c.question.section.gain, region.closed);
    region.area += loop.area;
    ++region.parts;
    if (loop.area > largest) largest = loop.area, region.boundary = std::move(loop.points);
  }
  if (region.parts == 0) return {{margin.point}, 0, 1, true};  // too small to be met
  return region;
}

Curve exact_frontier(const SectionCase& c, std::size_t i) {
  const Frontier frontier(c, i, reach(c));
  Curve curve;
  constexpr int parts = 8;
  Sample from = sample(frontier, 0);
  if (from.bend) curve.push_back(*from.bend);
  for (int k = 1; k <= parts; ++k) {
    const Sample to = sample(frontier, k / double(parts));
    refine(frontier, from, to, c.question.deviation, curve);
    from = to;
  }
  return curve;
}

}  // namespace sinew::inline v1
