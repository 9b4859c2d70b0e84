/// @file exact_table.h
/// As table.h, for exact PCC: the pull of chords in the place of that of arcs, and what they take from all
/// tendons alike. Freestanding C++14, no includes but its neighbour, no heap. Theory:
/// docs/theory/controller.md
#ifndef SINEW_KERNEL_EXACT_TABLE_H
#define SINEW_KERNEL_EXACT_TABLE_H

#include "sinew/kernel/table.h"

namespace sinew {
namespace kernel {

/// What exact PCC needs of a section beside its rows.
template <class Format, Count Terms>
struct Chords {
  using Length = typename Format::Length;
  using Half = typename Format::Half;
  using Loss = typename Format::Loss;

  Backbone backbone;
  typename Stored<Half>::type half_length;    ///< N L/2
  typename Stored<Loss>::type series[Terms];  ///< of the chord's loss by the square of the bend

  /// What chords lack of their arcs, as shares.
  template <class Angle>
  constexpr void losses(const Bend<Angle>& bend, Loss& x, Loss& y) const {
    using Square = typename Format::Square;
    const Square xx = Square(bend.x * bend.x), yy = Square(bend.y * bend.y);
    if (backbone == Backbone::neutral) {
      x = y = loss(xx + yy);
    } else {
      x = loss(xx);
      y = loss(yy);
    }
  }
  /// What all tendons have in common.
  constexpr Length common(Loss x, Loss y) const { return Length(Stored<Half>::load(half_length) * (x + y)); }

  static constexpr int max_steps = 12;  ///< serve up to 120 degrees a joint

  /// The bend of these chords. Each step leaves a share 1 - cos(b/2) of what lacks; always as many, so that
  /// the time is always the same.
  template <class Angle>
  constexpr Bend<Angle> bend_of(const Bend<Angle>& chord, int steps = max_steps) const {
    Bend<Angle> bend = chord;
    for (int k = 0; k < steps; ++k) {
      Loss x{}, y{};
      losses(bend, x, y);
      bend = {chord.x - Angle(bend.x * x), chord.y - Angle(bend.y * y)};
    }
    return bend;
  }

 private:
  template <class Square>
  constexpr Loss loss(Square square) const {
    Loss sum = Stored<Loss>::load(series[Terms - 1]);
    for (Count k = Terms - 1; k-- > 0;) sum = Stored<Loss>::load(series[k]) + Loss(sum * square);
    return Loss(sum * square);
  }
};

/// Nothing to be done between sections.
struct NoPause {
  constexpr void operator()() const {}
};

/// PCC as far as its series goes: changes of tendons from bends, bends from changes, states of tendons.
template <Count Sections, Count Tendons, class Format, bool Alike = true, Count Terms = 2>
struct ExactTable {
  using Angle = typename Format::Angle;
  using Length = typename Format::Length;
  using Loss = typename Format::Loss;

  LinearTable<Sections, Tendons, Format, Alike> linear;
  Chords<Format, Terms> chords[Alike ? 1 : Sections];

  /// What every tendon has to do, Δl > 0 pays out.
  constexpr void changes(const Bend<Angle> (&bends)[Sections], Length (&changes)[Sections][Tendons]) const {
    Bend<Angle> sum{Angle(0.0), Angle(0.0)};
    Length common = Length(0.0);
    for (Count m = 0; m < Sections; ++m) {
      const Bend<Angle>& bend = bends[m];
      Loss x{}, y{};
      of(m).losses(bend, x, y);
      sum = linear.passed(m, sum,
                          {wrapped_sum(bend.x, Angle(bend.x * x)), wrapped_sum(bend.y, Angle(bend.y * y))});
      common = wrapped_sum(common, of(m).common(x, y));
      for (Count i = 0; i < Tendons; ++i)
        changes[m][i] = wrapped_sum(common, linear.change(linear.rows[m][i], sum));
    }
  }

  /// The bends that come nearest to the changes, in least squares for each section.
  constexpr void bends(const Length (&changes)[Sections][Tendons], Bend<Angle> (&bends)[Sections]) const {
    this->bends(changes, bends, Chords<Format, Terms>::max_steps, NoPause{});
  }
  /// @param pause called after each section: for what cannot wait
  template <class Pause>
  constexpr void bends(const Length (&changes)[Sections][Tendons], Bend<Angle> (&bends)[Sections], int steps,
                       Pause pause) const {
    linear.bends(changes, bends);  // of chords
    for (Count m = 0; m < Sections; ++m) {
      bends[m] = of(m).bend_of(bends[m], steps);
      pause();
    }
  }

  /// Whether tendons have more or less than the bends ask that come nearest.
  constexpr void states(const Length (&changes)[Sections][Tendons], Length tolerance,
                        TendonState (&states)[Sections][Tendons]) const {
    Bend<Angle> nearest[Sections] = {};
    bends(changes, nearest);
    this->states(changes, nearest, tolerance, states);
  }
  /// @param nearest what `bends` gives
  constexpr void states(const Length (&changes)[Sections][Tendons], const Bend<Angle> (&nearest)[Sections],
                        Length tolerance, TendonState (&states)[Sections][Tendons]) const {
    Length common = Length(0.0);
    for (Count m = 0; m < Sections; ++m) {
      Loss x{}, y{};
      of(m).losses(nearest[m], x, y);
      common = common + of(m).common(x, y);
      const Bend<Angle> sum = linear.nearest_sum(m, changes[m]);
      for (Count i = 0; i < Tendons; ++i)
        states[m][i] =
            tendon_state((changes[m][i] - linear.change(linear.rows[m][i], sum)) - common, tolerance);
    }
  }

 private:
  constexpr const Chords<Format, Terms>& of(Count m) const { return chords[Alike ? 0 : m]; }
};

}  // namespace kernel
}  // namespace sinew

#endif
