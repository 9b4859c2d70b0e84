// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "analysis/velocity_lanes.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "analysis/chord_lanes-inl.hpp"
#include "analysis/hinged_lanes-inl.hpp"
#include "analysis/velocity_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::velocity_lanes {
namespace HWY_NAMESPACE {

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

/// The robot at one pack of poses.
template <class Legs>
class Poses {
 public:
  static constexpr std::size_t D = Legs::D, N = Legs::N, inputs = Legs::inputs;

  HWY_INLINE Poses(const typename Legs::Robot& robot, const VelocityBatch& out, const Place& place)
      : robot_(robot),
        out_(out),
        wanted_(out),
        place_(place) {}

  /// Bit k: lane k is left.
  HWY_INLINE std::uint64_t evaluate() {
    const Certain certain = Legs(robot_, out_, place_).solve(rows_);
    Mask regular = certain.reached;
    if (wanted_.lines) regular = hn::And(regular, judge_lines(certain));
    if (wanted_.raw || wanted_.homogenised) regular = hn::And(regular, indices(certain));
    return settle(certain, regular);
  }

 private:
  /// det J, and whether the lines are for certain not dependent: with F² = Σσ² the product of all σ but the
  /// last, the first once more, is at most `most`·Fᴺ, so that σmin/σmax ≥ |det|/(most·Fᴺ).
  HWY_INLINE Mask judge_lines(const Certain& certain) const {
    constexpr double most = N == 3 ? 0.384900179459750510 : 1.0 / 108;
    const Pack volume = determinant(rows_.line);
    Pack square = dot<N>(rows_.line[0], rows_.line[0]);
    for (std::size_t i = 1; i < N; ++i) square = square + dot<N>(rows_.line[i], rows_.line[i]);
    Pack scale = all(N == 3 ? robot_.radius : robot_.radius * robot_.radius * robot_.radius);
    Pack least = all(type_2_margin * type_2_margin * most * most);
    for (std::size_t i = 0; i < N; ++i) {
      scale = scale * rows_.size[i];
      least = least * square;
    }
    if (!out_.determinant.empty()) place_.store(volume * scale, certain.unreachable, out_.determinant);
    return hn::Gt(volume * volume, least);
  }

  HWY_INLINE Mask indices(const Certain& certain) const {
    if (wanted_.norms)
      return wanted_.raw ? indices<true, N + inputs>(certain) : indices<false, N + inputs>(certain);
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
      place_.store(hn::Sqrt(lengths.most / lengths.least), certain.unreachable, out_.condition_homogenised);
    }
    if constexpr (columns > N) norms(unit, certain);
    if constexpr (!raw) return certain.reached;
    const Extremes lengths = squares<N, N>(as_printed);
    place_.store(hn::Sqrt(lengths.most / lengths.least), certain.unreachable, out_.condition);
    return hn::Gt(lengths.least, all(condition_margin * condition_margin) * lengths.most);
  }

  HWY_INLINE void put_raw(Pack (&rows)[N][N]) const {
    for (std::size_t i = 0; i < N; ++i) {
      const Pack arm = rows_.size[i] * all(robot_.radius);
      for (std::size_t k = 0; k < N; ++k) rows[i][k] = rows_.line[i][k] * (k < D ? rows_.size[i] : arm);
    }
  }

  template <std::size_t columns>
  HWY_INLINE void put_unit(Pack (&rows)[N][columns]) const {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        rows[i][k] = k < N ? rows_.line[i][k] : k - N == i ? rows_.drive[i] : hn::Zero(tag);
  }

  /// Of the blocks of U = Σ zᵀh/z² over the rows (z | h), which are orthogonal in z.
  HWY_INLINE void norms(const Pack (&rows)[N][N + inputs], const Certain& certain) const {
    Pack scaled[N][N];
    for (std::size_t k = 0; k < N; ++k) {
      const Pack scale = all(1) / dot<N>(rows[k], rows[k]);
      for (std::size_t i = 0; i < N; ++i) scaled[k][i] = rows[k][i] * scale;
    }
    if (!out_.position.empty()) place_.store(norm<0, D>(rows, scaled), certain.unreachable, out_.position);
    if (!out_.rotation.empty())
      place_.store(norm<D, N - D>(rows, scaled) * all(1 / robot_.radius), certain.unreachable, out_.rotation);
  }

  /// 2-norm of rows of U.
  template <std::size_t First, std::size_t Count>
  static HWY_INLINE Pack norm(const Pack (&rows)[N][N + inputs], const Pack (&scaled)[N][N]) {
    Pack block[Count][inputs];
    for (std::size_t i = 0; i < Count; ++i)
      for (std::size_t j = 0; j < inputs; ++j) {
        block[i][j] = scaled[0][First + i] * rows[0][N + j];
        for (std::size_t k = 1; k < N; ++k)
          block[i][j] = plus(block[i][j], scaled[k][First + i], rows[k][N + j]);
      }
    orthogonalise<Count, inputs>(block);
    return hn::Sqrt(squares<Count, inputs>(block).most);
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

  const typename Legs::Robot& robot_;
  const VelocityBatch& out_;
  Wanted wanted_;
  Place place_;
  Rows<N> rows_;
};

template <class Legs>
HWY_FLATTEN void sweep(const typename Legs::Robot& robot, const Part& part, const VelocityBatch& out,
                       std::uint8_t* doubtful) {
  for (std::size_t done = 0; done < part.count; done += hn::Lanes(tag)) {
    const std::size_t count = std::min(hn::Lanes(tag), part.count - done);
    const std::uint64_t left = Poses<Legs>(robot, out, Place{&part, part.first + done, count}).evaluate();
    for (std::size_t k = 0; k < count; ++k) doubtful[done + k] = left >> k & 1;
  }
}

void Evaluate(const LaneRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful) {
  if (const auto* hinged = std::get_if<HingedRobot>(&robot))
    sweep<HingedLegs>(*hinged, part, out, doubtful);
  else if (const auto* chords = std::get_if<ChordRobot>(&robot); chords && chords->dof == 3)
    sweep<ChordLegs<2, 3>>(*chords, part, out, doubtful);
  else if (chords)
    sweep<ChordLegs<3, 6>>(*chords, part, out, doubtful);
}

const char* InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::velocity_lanes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::velocity_lanes {

HWY_EXPORT(Evaluate);
HWY_EXPORT(InstructionSet);

void evaluate(const LaneRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful) {
  HWY_DYNAMIC_DISPATCH(Evaluate)(robot, part, out, doubtful);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

}  // namespace sinew::inline v1::velocity_lanes
#endif
