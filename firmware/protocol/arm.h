/// @file arm.h
/// What the firmware knows of its robot. The one place that uses the generated table, `robot_table.h`:
/// another robot is another table. Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_ARM_H
#define SINEW_FIRMWARE_ARM_H

#include "protocol/number.h"
#include "robot_table.h"
#include "sinew/kernel/exact_table.h"
#include "sinew/kernel/tendon_state.h"

/// Linear stages that move the robot's base along: 0 or 1, whose drive comes after those of the tendons.
#ifndef STAGES
#define STAGES 0
#endif
/// [counts] up to which it may go from 0.
#ifndef STAGE_LIMIT
#define STAGE_LIMIT 8388607
#endif
/// 1: drives of tendons measure how strongly these pull.
#ifndef TENSIONS
#define TENSIONS 0
#endif
/// [1/256 N] above which nothing is taken in; 0: none.
#ifndef TENSION_LIMIT
#define TENSION_LIMIT 5120
#endif
/// 1: drives do not know after a reset where zero is; poses wait until each has been told.
#ifndef HOMING
#define HOMING 0
#endif

namespace sinew {
namespace firmware {

constexpr Uint8 section_count = robot::sections, tendon_count = robot::tendons;
constexpr Uint8 bend_count = 2 * section_count, tendon_drives = section_count * tendon_count;
constexpr Uint8 stage_count = STAGES, drive_count = tendon_drives + stage_count;
constexpr Int32 stage_limit = STAGE_LIMIT;
constexpr bool has_tensions = TENSIONS, has_homing = HOMING;
constexpr Uint16 tension_limit = has_tensions ? TENSION_LIMIT : 0;
static_assert(TENSION_LIMIT >= 0 && TENSION_LIMIT <= 0xFFFF, "a tension has two bytes");
static_assert((TENSIONS == 0 || TENSIONS == 1) && (HOMING == 0 || HOMING == 1), "options are on or off");
static_assert(STAGES == 0 || STAGES == 1, "at most one stage");
static_assert(STAGE_LIMIT >= 0, "a stage goes from 0 to its limit");
static_assert(robot::sections * robot::tendons + STAGES < 256 && 2 * robot::sections < 256,
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

/// What a host asks for.
struct Pose {
  Bends bends;
  Int32 stage = 0;      ///< [counts]
  Uint16 duration = 0;  ///< [ms] until the drives are told of it; 0 and 1 are at once
};

inline bool is_within_limits(const Pose& pose) {
  return robot::limits.hold(pose.bends) && pose.stage >= 0 && pose.stage <= stage_limit;
}

/// What a pose within limits asks of the drives.
inline void plan(const Pose& pose, Changes& changes, Counts& counts) {
  robot::model.changes(pose.bends, changes);
  Int32* count = counts;
  for (const auto& section : changes)
    for (const Length change : section) *count++ = robot::motor.of(change);
  if (stage_count > 0) *count = pose.stage;
}

/// Counts of the longest change that a tendon can be asked for.
inline Int32 longest_change() { return robot::motor.of(Length::from_raw(Length::largest)); }

/// Whether a drive may be sent there: a tendon as far as changes go, the stage from 0 to its limit.
inline bool is_allowed(Uint8 drive, Int32 count) {
  if (drive >= tendon_drives) return count >= 0 && count <= stage_limit;
  const Int32 most = longest_change();
  return count <= most && count >= -most;
}

/// Whether these can be counts of drives: within what changes and the stage can be, and not all -1, which is
/// what a wire that is off reads by its pull-up.
inline bool is_plausible(const Counts& counts) {
  const Int32 of_tendons = longest_change();
  bool all_ones = true;
  for (Uint8 i = 0; i < drive_count; ++i) {
    const Int32 most = i < tendon_drives ? of_tendons : stage_limit;
    if (counts[i] > most || counts[i] < -most) return false;
    all_ones = all_ones && counts[i] == -1;
  }
  return !all_ones;
}

/// Exact PCC is solved by steps, each of which leaves 1 - cos(b/2) < b^2/8 of what lacks: so many for 16 bits
/// up to the limit, and one for what is measured beyond it.
constexpr int exact_steps() {
  double widest = 0;
  for (Uint8 m = 0; m < section_count; ++m) {
    const double limit = static_cast<double>(robot::limits.limit[m]) / (1l << Angle::fraction);
    if (limit > widest) widest = limit;
  }
  int steps = 1;
  for (double left = widest; left > 1.0 / (1l << 15) && steps < 12; ++steps) left *= widest * widest / 8;
  return steps;
}

/// What the drives say of the shape; `pause` is called now and then, for no drive hears of anything
/// meanwhile.
template <class Model, class Pause>
void measure(const Model& model, const Changes& changes, Bends& bends, States& states, Pause pause) {
  model.bends(changes, bends);
  pause();
  model.states(changes, robot::tolerance, states);
}
template <kernel::Count S, kernel::Count T, class Format, bool Alike, kernel::Count Terms, class Pause>
void measure(const kernel::ExactTable<S, T, Format, Alike, Terms>& model, const Changes& changes,
             Bends& bends, States& states, Pause pause) {
  constexpr int steps = exact_steps();
  model.bends(changes, bends, steps, pause);
  model.states(changes, bends, robot::tolerance, states);
}
template <class Pause>
void measure(const Counts& counts, Bends& bends, States& states, Pause pause) {
  Changes changes;
  for (Uint8 i = 0; i < tendon_drives; ++i) change_at(changes, i) = robot::motor.change(counts[i]);
  measure(robot::model, changes, bends, states, pause);
}

inline char letter_of(kernel::TendonState state) {
  return state == kernel::TendonState::exact ? 'e' : state == kernel::TendonState::slack ? 's' : 'o';
}
inline char letter_at(const States& states, Uint8 i) {
  return letter_of(states[i / tendon_count][i % tendon_count]);
}

}  // namespace firmware
}  // namespace sinew

#endif
