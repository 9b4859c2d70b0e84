/// @file table.h
/// A serial robot with its constants multiplied out, for controllers. A pass over the sections is two running
/// sums, and two products and one rounding a tendon:  Δl = a X + b Y,  (a, b) = −g (cos d, sin d).
///
/// In integers every result has one meaning on every machine: products are exact, sums are of the integer's
/// own width modulo 2ⁿ, and one rounding (halves upwards) ends each. Within the limits of a robot nothing
/// wraps: `sinew export` chooses the formats so. The inverse takes whatever was measured and saturates.
/// Freestanding C++14, no includes but its neighbours, no heap. Theory: docs/theory/controller.md
#ifndef SINEW_KERNEL_TABLE_H
#define SINEW_KERNEL_TABLE_H

#include "sinew/kernel/products.h"
#include "sinew/kernel/section.h"
#include "sinew/kernel/serial.h"
#include "sinew/kernel/tendon_state.h"

namespace sinew {
namespace kernel {

/// One scalar for everything.
template <class S>
struct PlainFormat {
  using Angle = S;
  using Length = S;
  using Row = S;
  using Back = S;
  using Share = S;
  using Half = S;
  using Square = S;
  using Loss = S;
  using Multiply = Portable;
};

/// 16 bits with so many of them behind the point of angles, lengths, the inverse's rows and half lengths.
/// Those of the rows follow: the upper half of a product is a length, so that rounding costs no shift.
template <int AngleFraction, int LengthFraction, int BackFraction, class Multiplied = Native,
          int HalfFraction = LengthFraction>
struct ShortFormat {
  using Angle = Fixed<16, AngleFraction>;
  using Length = Fixed<16, LengthFraction>;
  using Row = Fixed<16, 16 + LengthFraction - AngleFraction>;
  using Back = Fixed<16, BackFraction>;
  using Share = Fixed<16, 13>;
  using Half = Fixed<16, HalfFraction>;
  using Square =
      Fixed<16, (AngleFraction > 7 ? 2 * AngleFraction - 15 : 0)>;  // of any angle of 8 to 15 of them
  using Loss = Fixed<16, 15>;
  using Multiply = Multiplied;
};

/// Gains of the sections as shares of the greatest, where they are not alike.
template <Count Sections, class Format, bool Alike>
struct Shares {
  /// A component of section m's bend as its share in the sums of the table.
  template <class Angle>
  static constexpr Angle shared(Count, Angle own) {
    return own;
  }
  /// And back.
  template <class Angle>
  static constexpr Angle own(Count, Angle shared) {
    return shared;
  }
};
template <Count Sections, class Format>
struct Shares<Sections, Format, false> {
  using Share = typename Format::Share;
  typename Stored<Share>::type share[Sections];    ///< g of a section over the greatest, ≤ 1
  typename Stored<Share>::type inverse[Sections];  ///< and its inverse

  template <class Angle>
  constexpr Angle shared(Count m, Angle own) const {
    return Angle(own * Stored<Share>::load(share[m]));
  }
  template <class Angle>
  constexpr Angle own(Count m, Angle shared) const {
    return Angle(shared * Stored<Share>::load(inverse[m]));
  }
};

/// LSK: changes of tendons from bends, bends from changes, states of tendons.
template <Count Sections, Count Tendons, class Format, bool Alike = true>
struct LinearTable {
  static_assert(Sections >= 1 && Tendons >= 3, "at least one section, and three tendons each");
  using Angle = typename Format::Angle;
  using Length = typename Format::Length;
  using Row = typename Format::Row;
  using Back = typename Format::Back;

  Shares<Sections, Format, Alike> shares;
  typename Stored<Row>::type rows[Sections][Tendons][2];   ///< −g (cos d, sin d), g the greatest
  typename Stored<Back>::type back[Sections][Tendons][2];  ///< −2/(n g) (cos d, sin d)

  /// What every tendon has to do, Δl > 0 pays out.
  constexpr void changes(const Bend<Angle> (&bends)[Sections], Length (&changes)[Sections][Tendons]) const {
    Bend<Angle> sum{Angle(0.0), Angle(0.0)};
    for (Count m = 0; m < Sections; ++m) {
      sum = passed(m, sum, bends[m]);
      Each<0, Tendons>::set(rows[m], sum, changes[m]);
    }
  }

  /// The same, the last tendon of each section by what they have together: evenly spread they sum up to 0.
  /// In integers it differs from its own rounding by as many halves of a step as there are others.
  constexpr void changes_by_sum(const Bend<Angle> (&bends)[Sections],
                                Length (&changes)[Sections][Tendons]) const {
    Bend<Angle> sum{Angle(0.0), Angle(0.0)};
    for (Count m = 0; m < Sections; ++m) {
      sum = passed(m, sum, bends[m]);
      Each<0, Tendons - 1>::set(rows[m], sum, changes[m]);
      Length last = changes[m][0];
      for (Count i = 1; i + 1 < Tendons; ++i) last = wrapped_sum(last, changes[m][i]);
      changes[m][Tendons - 1] = wrapped_difference(Length(0.0), last);
    }
  }

  /// The bends that come nearest to the changes, in least squares for each section.
  constexpr void bends(const Length (&changes)[Sections][Tendons], Bend<Angle> (&bends)[Sections]) const {
    Bend<Angle> before{Angle(0.0), Angle(0.0)};
    for (Count m = 0; m < Sections; ++m) {
      const Bend<Angle> sum = nearest_sum(m, changes[m]);
      bends[m] = {shares.own(m, sum.x - before.x), shares.own(m, sum.y - before.y)};
      before = sum;
    }
  }

  /// Whether tendons have more or less than the bend asks that comes nearest to those of their section.
  constexpr void states(const Length (&changes)[Sections][Tendons], Length tolerance,
                        TendonState (&states)[Sections][Tendons]) const {
    for (Count m = 0; m < Sections; ++m) {
      const Bend<Angle> sum = nearest_sum(m, changes[m]);
      for (Count i = 0; i < Tendons; ++i)
        states[m][i] = tendon_state(changes[m][i] - change(rows[m][i], sum), tolerance);
    }
  }

  /// @name Of what all sections up to one sum up to, as of the greatest gain
  /// @{
  using StoredRow = typename Stored<Row>::type;
  /// Change of a tendon there.
  static constexpr Length change(const StoredRow (&row)[2], const Bend<Angle>& sum) {
    return Format::Multiply::template rounded_sum<Length>(Stored<Row>::load(row[0]), sum.x,
                                                          Stored<Row>::load(row[1]), sum.y);
  }
  /// The sum past the next section.
  constexpr Bend<Angle> passed(Count m, const Bend<Angle>& sum, const Bend<Angle>& bend) const {
    return {wrapped_sum(sum.x, shares.shared(m, bend.x)), wrapped_sum(sum.y, shares.shared(m, bend.y))};
  }
  /// The sum that comes nearest to the changes of a section's tendons.
  constexpr Bend<Angle> nearest_sum(Count m, const Length (&changes)[Tendons]) const {
    Products<Back, Length> x, y;
    for (Count i = 0; i < Tendons; ++i) {
      x.add(Stored<Back>::load(back[m][i][0]), changes[i]);
      y.add(Stored<Back>::load(back[m][i][1]), changes[i]);
    }
    return {Angle(x.sum()), Angle(y.sum())};
  }

  /// @}

 private:
  /// A loop that is unrolled whatever the compiler thinks of it.
  template <Count I, Count End>
  struct Each {
    static constexpr void set(const StoredRow (&rows)[Tendons][2], const Bend<Angle>& sum,
                              Length (&changes)[Tendons]) {
      changes[I] = change(rows[I], sum);
      Each<I + 1, End>::set(rows, sum, changes);
    }
  };
  template <Count End>
  struct Each<End, End> {
    static constexpr void set(const StoredRow (&)[Tendons][2], const Bend<Angle>&, Length (&)[Tendons]) {}
  };
};

}  // namespace kernel
}  // namespace sinew

#endif
