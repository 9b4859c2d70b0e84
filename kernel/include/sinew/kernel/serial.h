/// @file serial.h
/// A serial robot of a size known when it is compiled: all tendon changes from all bends and back, in one
/// pass. Freestanding C++14, no includes but its neighbours, no heap. Theory: docs/theory/section.md
///
///     constexpr auto snake = sinew::kernel::make_serial<5, 3, float>(
///         sinew::kernel::Backbone::twin_pivot, 8, 2.375, 2.45, 0.41887902);  // [mm], 24 deg a section
///     snake.changes<sinew::kernel::Model::exact>(bends, changes);
#ifndef SINEW_KERNEL_SERIAL_H
#define SINEW_KERNEL_SERIAL_H

#include "sinew/kernel/direction.h"
#include "sinew/kernel/section.h"

namespace sinew {
namespace kernel {

/// Number of sections, tendons, ...
using Count = decltype(sizeof(0));

/// Sections and directions of their tendons: bends and changes of tendons by either model.
template <Count Sections, Count Tendons, class Angle, class Length = Angle>
struct Serial {
  static_assert(Sections >= 1 && Tendons >= 3, "at least one section, and three tendons each");
  Section<Angle, Length> sections[Sections];
  Direction<Angle> directions[Sections][Tendons];

  /// @implements LSK (5), (12): 3 M evaluations for either model
  template <Model model>
  constexpr void changes(const Bend<Angle> (&bends)[Sections], Length (&changes)[Sections][Tendons]) const {
    Pull<Length> sum{Length(0.0), Length(0.0), Length(0.0)};
    for (Count m = 0; m < Sections; ++m) {
      sum = sum + pull<model>(sections[m], bends[m]);
      for (Count i = 0; i < Tendons; ++i) changes[m][i] = tendon_change(sum, directions[m][i]);
    }
  }

  /// The same of sections of variable length, longer than at rest by their extensions.
  template <Model model>
  constexpr void changes(const Bend<Angle> (&bends)[Sections], const Length (&extensions)[Sections],
                         Length (&changes)[Sections][Tendons]) const {
    Pull<Length> sum{Length(0.0), Length(0.0), Length(0.0)};
    for (Count m = 0; m < Sections; ++m) {
      sum = sum + pull<model>(sections[m], bends[m], extensions[m]);
      for (Count i = 0; i < Tendons; ++i) changes[m][i] = tendon_change(sum, directions[m][i]);
    }
  }

  /// The bends whose changes come nearest, in least squares for each section.
  template <Model model>
  constexpr void bends(const Length (&changes)[Sections][Tendons], Bend<Angle> (&bends)[Sections]) const {
    Length x = Length(0.0), y = Length(0.0);
    for (Count m = 0; m < Sections; ++m) {
      const Pull<Length> sum = nearest_pull(changes[m], directions[m], static_cast<int>(Tendons));
      bends[m] = bend<model>(sections[m], sum.x - x, sum.y - y);
      x = sum.x;
      y = sum.y;
    }
  }

  /// The same where all sections vary their length: what the tendons of each have in common.
  template <Model model>
  constexpr void bends(const Length (&changes)[Sections][Tendons], Bend<Angle> (&bends)[Sections],
                       Length (&extensions)[Sections]) const {
    this->bends<model>(changes, bends);
    Length common = Length(0.0);
    for (Count m = 0; m < Sections; ++m) {
      const Length sum = nearest_pull(changes[m], directions[m], static_cast<int>(Tendons)).common;
      extensions[m] = extension<model>(sections[m], bends[m], sum - common);
      common = sum;
    }
  }
};

/// Sections of one kind, each with its tendons turned by `turn` [rad] against the one before, the first by
/// `turn` too.
template <Count Sections, Count Tendons, class Angle, class Length = Angle>
constexpr Serial<Sections, Tendons, Angle, Length> make_serial(Backbone backbone, int joints,
                                                               double joint_length, double radius,
                                                               double turn) {
  Serial<Sections, Tendons, Angle, Length> serial{};
  for (Count m = 0; m < Sections; ++m) {
    serial.sections[m] = make_section<Angle, Length>(backbone, joints, joint_length, radius);
    for (Count i = 0; i < Tendons; ++i)
      serial.directions[m][i] =
          direction<Angle>(static_cast<double>(m + 1) * turn +
                           2 * detail::pi * static_cast<double>(i) / static_cast<double>(Tendons));
  }
  return serial;
}

}  // namespace kernel
}  // namespace sinew

#endif
