/// A controller of a serial arm, as it runs on a microcontroller: tendon lengths and motor counts by integers
/// of 16 bits, from the table that the command exports, compared with the library.
///
///     sinew export nottingham-tpcj --to c-header --set 'motor={"lead": "2 mm", "counts": 4096}' -o
///     robot_table.h
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "robot_table.h"  // constants, and templates that need no library: C++14, no heap, no floating point
#include "sinew/sinew.hpp"

using robot::sections, robot::tendons;
using Angle = robot::Angle;    // Q2.13 [rad]
using Length = robot::Length;  // Q7.8 [mm]
using Bends = sinew::kernel::Bend<Angle>[sections];
using Changes = Length[sections][tendons];

/// What the controller does each tick. False: a bend is beyond its limit, and nothing was set.
static bool tick(const Bends& bends, int (&counts)[sections][tendons]) {
  if (!robot::limits.hold(bends)) return false;
  Changes changes;
  robot::exact_short.changes(bends, changes);
  for (int m = 0; m < sections; ++m)
    for (int i = 0; i < tendons; ++i) counts[m][i] = robot::motor.of(changes[m][i]);
  return true;
}

int main() {
  std::printf("table %08lx of %d sections\n", static_cast<unsigned long>(robot::hash), sections);

  // A second of a motion, a tick each millisecond, beside the library's lengths in doubles.
  const sinew::SerialRobot arm = sinew::load_serial("nottingham-tpcj").value();
  sinew::SerialWorkspace work(arm);
  std::vector<sinew::Bend> wanted(sections);
  int counts[sections][tendons];
  double largest = 0;  // [m]
  for (int k = 0; k < 1000; ++k) {
    Bends bends;
    for (int m = 0; m < sections; ++m) {
      wanted[std::size_t(m)] = {0.3 * std::sin(0.00628 * k + m), 0.3 * std::cos(0.00628 * k - m)};
      bends[m] = {Angle(wanted[std::size_t(m)].x()), Angle(wanted[std::size_t(m)].y())};
    }
    if (!tick(bends, counts)) return std::puts("beyond a limit"), 3;
    sinew::tendon_changes(wanted, sinew::kernel::Model::exact, work);
    for (int m = 0; m < sections; ++m)
      for (int i = 0; i < tendons; ++i) {
        const double driven = counts[m][i] * 2e-3 / 4096;  // a screw of 2 mm, 4096 counts a turn
        largest = std::max(largest, std::abs(driven - work.changes[std::size_t(m * tendons + i)]));
      }
  }
  std::printf("1000 ticks, lengths at most %.1f um from those in doubles\n", 1e6 * largest);

  // Beyond its limit of 24 degrees nothing moves.
  Bends beyond = {};
  beyond[2].x = Angle(0.5);
  std::printf("0.5 rad in section 2 is %s\n", tick(beyond, counts) ? "driven" : "refused");
}

// Prints:
//   table 77911e6e of 5 sections
//   1000 ticks, lengths at most 8.4 um from those in doubles
//   0.5 rad in section 2 is refused
