// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "analysis/chord_lanes.cpp"
// SSSE3 is what every x86-64 of the last fifteen years has; what lies between is not worth its compile time.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "analysis/chord_lanes.hpp"
#include "math/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v0::chord_lanes {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace lanes::HWY_NAMESPACE;

using Mask = hn::Mask<Tag>;

/// The poses of one pack within a part; the last pack may be of fewer than its lanes.
struct Place {
  const Part* part;
  std::size_t at, count;

  HWY_INLINE bool is_full() const { return count == hn::Lanes(tag); }

  /// Coordinate `axis` of the poses. Lanes without one repeat nothing: they are 0.
  HWY_INLINE Pack load(std::size_t axis) const {
    const double* from = part->poses + axis * part->total + at;
    if (is_full()) return hn::LoadU(tag, from);
    HWY_ALIGN double padded[hn::MaxLanes(tag)] = {};
    std::copy_n(from, count, padded);
    return hn::Load(tag, padded);
  }

  HWY_INLINE void store(Pack values, std::span<double> to, std::size_t row = 0) const {
    double* into = to.data() + row * part->total + at;
    if (is_full()) return hn::StoreU(values, tag, into);
    HWY_ALIGN double lanes[hn::MaxLanes(tag)];
    hn::Store(values, tag, lanes);
    std::copy_n(lanes, count, into);
  }
};

/// What is asked for, and what that needs.
struct Wanted {
  bool norms, homogenised, raw, lines;

  explicit Wanted(const VelocityBatch& out)
      : norms(!out.position.empty() || !out.rotation.empty()),
        homogenised(norms || !out.condition_homogenised.empty()),
        raw(!out.condition.empty()),
        lines(homogenised || raw || !out.determinant.empty() || !out.status.empty() ||
              !out.is_type_2.empty()) {}
};

/// Points of the plane and of space, in lanes.
template <std::size_t D>
struct Point {
  Pack at[D];
};

struct Turn2 {
  Pack x, y, c, s;
  Mask is_fit;

  HWY_INLINE explicit Turn2(const Place& place) : x(place.load(0)), y(place.load(1)), c(x), s(y), is_fit() {
    const Pack angle = place.load(2);
    is_fit = hn::Lt(hn::Abs(angle), all(1e4));  // beyond it Highway's own reduction loses digits
    c = hn::Cos(tag, angle);
    s = hn::Sin(tag, angle);
  }
  /// b of a leg in base axes, and from its base point there.
  HWY_INLINE void reach(const ChordLeg& leg, Point<2>& b, Point<2>& r) const {
    const Pack u = all(leg.point[0]), v = all(leg.point[1]);
    b.at[0] = minus(c * u, s, v);
    b.at[1] = plus(c * v, s, u);
    r.at[0] = x + b.at[0] - all(leg.base[0]);
    r.at[1] = y + b.at[1] - all(leg.base[1]);
  }
};

struct Turn3 {
  Pack p[3], w, v[3];
  Mask is_fit;

  HWY_INLINE explicit Turn3(const Place& place)
      : p{place.load(0), place.load(1), place.load(2)},
        w(place.load(3)),
        v{place.load(4), place.load(5), place.load(6)},
        is_fit() {
    const Pack square = plus(dot<3>(v, v), w, w);
    is_fit = hn::And(hn::Gt(square, all(1e-100)), hn::Lt(square, all(1e100)));
    const Pack scale = all(1) / hn::Sqrt(square);
    w = w * scale;
    for (Pack& number : v) number = number * scale;
  }
  HWY_INLINE void reach(const ChordLeg& leg, Point<3>& b, Point<3>& r) const {
    const Pack u[3] = {all(leg.point[0]), all(leg.point[1]), all(leg.point[2])};
    Pack side[3];  // 2 v × u
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      side[i] = all(2) * minus(v[j] * u[k], v[k], u[j]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      b.at[i] = plus(u[i], side[i], w) + minus(v[j] * side[k], v[k], side[j]);
      r.at[i] = p[i] + b.at[i] - all(leg.base[i]);
    }
  }
};

HWY_INLINE void moment(const Point<2>& b, const Pack* f, Pack* out) {
  out[0] = minus(b.at[0] * f[1], b.at[1], f[0]);
}
HWY_INLINE void moment(const Point<3>& b, const Pack* f, Pack* out) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = minus(b.at[j] * f[k], b.at[k], f[j]);
  }
}

/// Where lanes are for certain.
struct Certain {
  Mask reached, unreachable;
};

/// The robot at one pack of poses. In the plane D = 2 and N = 3, in space 3 and 6.
template <std::size_t D, std::size_t N>
class Poses {
 public:
  HWY_INLINE Poses(const ChordRobot& robot, const VelocityBatch& out, const Place& place)
      : robot_(robot),
        out_(out),
        wanted_(out),
        place_(place) {}

  /// Bit k: lane k is left.
  HWY_INLINE std::uint64_t evaluate() {
    const Certain certain = solve_legs();
    Mask regular = certain.reached;
    if (wanted_.lines) regular = hn::And(regular, judge_lines(certain));
    if (wanted_.raw || wanted_.homogenised) regular = hn::And(regular, indices(certain));
    return settle(certain, regular);
  }

 private:
  /// NaN where there is no solution.
  HWY_INLINE void store(Pack values, Mask unreachable, std::span<double> to, std::size_t row = 0) const {
    const Pack absent = all(std::numeric_limits<double>::quiet_NaN());
    place_.store(hn::IfThenElse(unreachable, absent, values), to, row);
  }

  /// Chords, curvatures, unit lines and what the inputs do to them.
  HWY_INLINE Certain solve_legs() {
    using Turn = std::conditional_t<D == 2, Turn2, Turn3>;
    const Turn turn(place_);
    Certain certain{turn.is_fit, hn::Not(hn::FirstN(tag, hn::Lanes(tag)))};
    Pack curvature[N];
    for (std::size_t i = 0; i < N; ++i) {
      const ChordLeg& leg = robot_.legs[i];
      Point<D> b, r;
      turn.reach(leg, b, r);
      chord_[i] = hn::Sqrt(dot<D>(r.at, r.at));
      const Pack loss = minus(all(1), chord_[i], all(1 / leg.length));
      const Pack bend = inverse_sinc_of_loss(hn::Min(hn::Max(loss, all(straight_margin)), all(1)));
      const Pack size = bend * all(2 / leg.length);
      judge_leg(leg, loss, size, certain);
      curvature[i] = size * all(leg.bending);
      const Pack rate = bend * sinc_slope_of_square(bend * bend);  // −sinc′
      drive_[i] = rate * all(leg.bending * 0.5 * leg.length / leg.offset);
      const Pack scale = all(1) / chord_[i];
      for (std::size_t k = 0; k < D; ++k) line_[i][k] = r.at[k] * scale;
      moment(b, line_[i], line_[i] + D);
      for (std::size_t k = D; k < N; ++k) line_[i][k] = line_[i][k] * all(1 / robot_.radius);
    }
    certain.unreachable = hn::And(certain.unreachable, turn.is_fit);
    for (std::size_t i = 0; i < N; ++i) put_leg(i, curvature[i], certain.unreachable);
    return certain;
  }

  /// A chord that is for certain shorter than the backbone, or longer; a curvature that is short of its
  /// domain, or beyond. All comparisons are false for NaN, which makes it doubtful.
  static HWY_INLINE void judge_leg(const ChordLeg& leg, Pack loss, Pack curvature, Certain& certain) {
    const Mask shorter = hn::Gt(loss, all(straight_margin));
    const Mask longer = hn::And(hn::Lt(loss, all(-straight_margin)), hn::Gt(loss, all(-1e100)));
    const Mask within = hn::Lt(curvature, all(leg.domain * (1 - domain_margin)));
    const Mask beyond = hn::And(hn::Gt(curvature, all(leg.domain * (1 + domain_margin))), shorter);
    certain.reached = hn::And(certain.reached, hn::And(shorter, within));
    certain.unreachable = hn::Or(certain.unreachable, hn::Or(longer, beyond));
  }

  HWY_INLINE void put_leg(std::size_t i, Pack curvature, Mask unreachable) const {
    const ChordLeg& leg = robot_.legs[i];
    if (!out_.curvatures.empty()) store(curvature, unreachable, out_.curvatures, i);
    if (!out_.inputs.empty())
      store(all(leg.length) * minus(all(1), all(leg.offset), curvature), unreachable, out_.inputs, i);
  }

  /// det J, and whether the lines are for certain not dependent: with F² = Σσ² the product of all σ but the
  /// last, the first once more, is at most `most`·Fᴺ, so that σmin/σmax ≥ |det|/(most·Fᴺ).
  HWY_INLINE Mask judge_lines(const Certain& certain) const {
    constexpr double most = N == 3 ? 0.384900179459750510 : 1.0 / 108;
    const Pack volume = determinant(line_);
    Pack square = dot<N>(line_[0], line_[0]);
    for (std::size_t i = 1; i < N; ++i) square = square + dot<N>(line_[i], line_[i]);
    Pack scale = all(N == 3 ? robot_.radius : robot_.radius * robot_.radius * robot_.radius);
    Pack least = all(type_2_margin * type_2_margin * most * most);
    for (std::size_t i = 0; i < N; ++i) {
      scale = scale * chord_[i];
      least = least * square;
    }
    if (!out_.determinant.empty()) store(volume * scale, certain.unreachable, out_.determinant);
    return hn::Gt(volume * volume, least);
  }

  HWY_INLINE Mask indices(const Certain& certain) const {
    if (wanted_.norms) return wanted_.raw ? indices<true, 2 * N>(certain) : indices<false, 2 * N>(certain);
    if (wanted_.homogenised) return wanted_.raw ? indices<true, N>(certain) : indices<false, N>(certain);
    return indices<true, 0>(certain);
  }

  /// From J as the paper has it if `raw`, and from so many columns of the homogenised (J | K). Both go
  /// through one loop, as each alone would wait for its square roots. Whether J is for certain not beyond all
  /// measure.
  template <bool raw, std::size_t columns>
  HWY_INLINE Mask indices(const Certain& certain) const {
    Pack as_printed[N][N], unit[N][columns > 0 ? columns : N];
    if constexpr (raw) put_raw(as_printed);
    if constexpr (columns > 0) put_unit(unit);
    if constexpr (raw && columns > 0)
      orthogonalise<N, N>(as_printed, unit);
    else if constexpr (raw)
      orthogonalise<N, N>(as_printed);
    else
      orthogonalise<N, N>(unit);
    if (columns > 0 && !out_.condition_homogenised.empty()) {
      const Extremes lengths = squares<N, N>(unit);
      store(hn::Sqrt(lengths.most / lengths.least), certain.unreachable, out_.condition_homogenised);
    }
    if constexpr (columns > N) norms(unit, certain);
    if constexpr (!raw) return certain.reached;
    const Extremes lengths = squares<N, N>(as_printed);
    store(hn::Sqrt(lengths.most / lengths.least), certain.unreachable, out_.condition);
    return hn::Gt(lengths.least, all(condition_margin * condition_margin) * lengths.most);
  }

  HWY_INLINE void put_raw(Pack (&rows)[N][N]) const {
    for (std::size_t i = 0; i < N; ++i) {
      const Pack arm = chord_[i] * all(robot_.radius);
      for (std::size_t k = 0; k < N; ++k) rows[i][k] = line_[i][k] * (k < D ? chord_[i] : arm);
    }
  }

  template <std::size_t columns>
  HWY_INLINE void put_unit(Pack (&rows)[N][columns]) const {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        rows[i][k] = k < N ? line_[i][k] : k - N == i ? drive_[i] : hn::Zero(tag);
  }

  /// Of the blocks of U = Σ zᵀh/z² over the rows (z | h), which are orthogonal in z.
  HWY_INLINE void norms(const Pack (&rows)[N][2 * N], const Certain& certain) const {
    Pack scaled[N][N];
    for (std::size_t k = 0; k < N; ++k) {
      const Pack scale = all(1) / dot<N>(rows[k], rows[k]);
      for (std::size_t i = 0; i < N; ++i) scaled[k][i] = rows[k][i] * scale;
    }
    if (!out_.position.empty()) store(norm<0, D>(rows, scaled), certain.unreachable, out_.position);
    if (!out_.rotation.empty())
      store(norm<D, N - D>(rows, scaled) * all(1 / robot_.radius), certain.unreachable, out_.rotation);
  }

  /// 2-norm of rows of U.
  template <std::size_t First, std::size_t Count>
  static HWY_INLINE Pack norm(const Pack (&rows)[N][2 * N], const Pack (&scaled)[N][N]) {
    Pack block[Count][N];
    for (std::size_t i = 0; i < Count; ++i)
      for (std::size_t j = 0; j < N; ++j) {
        block[i][j] = scaled[0][First + i] * rows[0][N + j];
        for (std::size_t k = 1; k < N; ++k)
          block[i][j] = plus(block[i][j], scaled[k][First + i], rows[k][N + j]);
      }
    orthogonalise<Count, N>(block);
    return hn::Sqrt(squares<Count, N>(block).most);
  }

  /// Statuses of the lanes that are certain; the others, a bit a lane.
  HWY_INLINE std::uint64_t settle(const Certain& certain, Mask regular) const {
    const std::uint64_t beyond = bits(certain.unreachable), left = ~(beyond | bits(regular));
    for (std::size_t k = 0; k < place_.count && !out_.status.empty(); ++k)
      out_.status[place_.at + k] = beyond >> k & 1 ? Status::unreachable : Status::converged;
    if (!out_.type_1.empty()) std::fill_n(out_.type_1.begin() + offset(), place_.count, std::uint8_t{0});
    if (!out_.is_type_2.empty())
      std::fill_n(out_.is_type_2.begin() + offset(), place_.count, std::uint8_t{0});
    return left;
  }

  std::ptrdiff_t offset() const { return static_cast<std::ptrdiff_t>(place_.at); }

  static HWY_INLINE std::uint64_t bits(Mask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < 8; ++k) word |= std::uint64_t{bytes[k]} << 8 * k;
    return word;
  }

  const ChordRobot& robot_;
  const VelocityBatch& out_;
  Wanted wanted_;
  Place place_;
  Pack chord_[N], drive_[N];  ///< ρ and the entry of the homogenised K of each leg
  Pack line_[N][N];           ///< homogenised rows of J
};

template <std::size_t D, std::size_t N>
HWY_FLATTEN void sweep(const ChordRobot& robot, const Part& part, const VelocityBatch& out,
                       std::uint8_t* doubtful) {
  for (std::size_t done = 0; done < part.count; done += hn::Lanes(tag)) {
    const std::size_t count = std::min(hn::Lanes(tag), part.count - done);
    const std::uint64_t left = Poses<D, N>(robot, out, Place{&part, part.first + done, count}).evaluate();
    for (std::size_t k = 0; k < count; ++k) doubtful[done + k] = left >> k & 1;
  }
}

void Evaluate(const ChordRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful) {
  if (robot.dof == 3)
    sweep<2, 3>(robot, part, out, doubtful);
  else
    sweep<3, 6>(robot, part, out, doubtful);
}

const char* InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v0::chord_lanes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v0::chord_lanes {

HWY_EXPORT(Evaluate);
HWY_EXPORT(InstructionSet);

void evaluate(const ChordRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful) {
  HWY_DYNAMIC_DISPATCH(Evaluate)(robot, part, out, doubtful);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

}  // namespace sinew::inline v0::chord_lanes
#endif
