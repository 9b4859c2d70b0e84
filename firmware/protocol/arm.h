/// @file arm.h
/// What the firmware knows of its robot. The one place that uses the generated table, `robot_table.h`:
/// another robot is another table. Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_ARM_H
#define SINEW_FIRMWARE_ARM_H

#include "protocol/number.h"
#include "robot_table.h"
#include "sinew/kernel/tendon_state.h"

namespace sinew {
namespace firmware {

constexpr Uint8 section_count = robot::sections, tendon_count = robot::tendons;
constexpr Uint8 bend_count = 2 * section_count, drive_count = section_count * tendon_count;
static_assert(robot::sections * robot::tendons < 256 && 2 * robot::sections < 256,
              "drives are counted in a byte");
constexpr Uint32 table_hash = robot::hash;

using Angle = robot::Angle;
using Length = robot::Length;
using Bends = kernel::Bend<Angle>[section_count];
using Changes = Length[section_count][tendon_count];
using Counts = Int32[drive_count];
using States = kernel::TendonState[section_count][tendon_count];

/// x and y of section after section.
inline Angle& bend_at(Bends& bends, Uint8 i) { return i & 1 ? bends[i / 2].y : bends[i / 2].x; }
inline Length& change_at(Changes& changes, Uint8 i) { return changes[i / tendon_count][i % tendon_count]; }

/// What bends ask of the drives; false, and nothing to be used, beyond the robot's limits.
inline bool plan(const Bends& bends, Changes& changes, Counts& counts) {
  if (!robot::limits.hold(bends)) return false;
  robot::model.changes(bends, changes);
  for (Uint8 i = 0; i < drive_count; ++i) counts[i] = robot::motor.of(change_at(changes, i));
  return true;
}

/// Whether these can be counts of drives: within what changes can be, and not all -1, which is what a wire
/// that is off reads by its pull-up.
inline bool is_plausible(const Counts& counts) {
  const Int32 most = robot::motor.of(Length::from_raw(Length::largest));
  bool all_ones = true;
  for (const Int32 count : counts) {
    if (count > most || count < -most) return false;
    all_ones = all_ones && count == -1;
  }
  return !all_ones;
}

/// What the drives say of the shape.
inline void measure(const Counts& counts, Bends& bends, States& states) {
  Changes changes;
  for (Uint8 i = 0; i < drive_count; ++i) change_at(changes, i) = robot::motor.change(counts[i]);
  robot::model.bends(changes, bends);
  robot::model.states(changes, robot::tolerance, states);
}

inline char letter_of(kernel::TendonState state) {
  return state == kernel::TendonState::exact ? 'e' : state == kernel::TendonState::slack ? 's' : 'o';
}

}  // namespace firmware
}  // namespace sinew

#endif
