// A robot's exported core, verilated, against the kernel with the same robot's exported table: every bit of
// every result, and that results come in the clock in which docs/theory/controller.md says, and in no other.
// Streams have gaps, robots that are left half-way, sections too many, and resets. Arguments: how many robots
// each way.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <random>

#include "Vcore.h"
#include "robot_table.h"

using robot::Angle;
using robot::Length;

namespace {

constexpr int sections = robot::sections, tendons = robot::tendons;
constexpr int adder_levels(int terms) {
  return terms > 1 ? 1 + adder_levels((terms + 1) / 2) : 0;
}  // by pairs
template <sinew::kernel::Count M, sinew::kernel::Count n, class Format, bool Alike>
constexpr bool are_alike(const sinew::kernel::LinearTable<M, n, Format, Alike>&) {
  return Alike;
}
constexpr int forward_latency = are_alike(robot::table) ? 3 : 6, inverse_latency = 7 + adder_levels(tendons);

std::mt19937 generator(20);
int below(int end) { return static_cast<int>(generator() % static_cast<unsigned>(end)); }

// A bus of 16 bits a tendon, wider than a machine's word or not.
std::int16_t field(std::uint64_t bus, int i) { return static_cast<std::int16_t>(bus >> (16 * i)); }
template <std::size_t Words>
std::int16_t field(const VlWide<Words>& bus, int i) {
  return static_cast<std::int16_t>(bus.at(i / 2) >> (16 * (i % 2)));
}
void set_fields(QData& bus, const Length (&values)[tendons]) {
  bus = 0;
  for (int i = 0; i < tendons; ++i)
    bus |= static_cast<std::uint64_t>(static_cast<std::uint16_t>(values[i].raw)) << (16 * i);
}
template <std::size_t Words>
void set_fields(VlWide<Words>& bus, const Length (&values)[tendons]) {
  for (std::size_t word = 0; word < Words; ++word) bus.at(word) = 0;
  for (int i = 0; i < tendons; ++i)
    bus.at(i / 2) |= static_cast<std::uint32_t>(static_cast<std::uint16_t>(values[i].raw)) << (16 * (i % 2));
}

// What one robot asks, and what has to come of it.
struct Forward {
  sinew::kernel::Bend<Angle> bends[sections];
  Length changes[sections][tendons];
  bool in_limits[sections];
};
struct Inverse {
  Length measured[sections][tendons];
  sinew::kernel::Bend<Angle> bends[sections];
  sinew::kernel::TendonState states[sections][tendons];
};

// Kinds of robots: within limits, anything, and the ends of what there is.
std::int16_t draw(int kind, int most) {
  const int special[] = {-32768, 32767, most, -most, most + 1, -most - 1, 0};
  if (kind == 0) return static_cast<std::int16_t>(below(2 * most + 1) - most);
  return static_cast<std::int16_t>(kind == 1 ? below(65536) - 32768 : special[below(7)]);
}

Forward make_forward() {
  Forward result;
  const int kind = below(4);
  for (int m = 0; m < sections; ++m) {
    const int limit = robot::limits.limit[m];
    result.bends[m] = {Angle::from_raw(draw(kind % 3, limit)), Angle::from_raw(draw(kind % 3, limit))};
    // Bends up to a section and none beyond: limits of those so far.
    for (int other = m + 1; other < sections; ++other) result.bends[other] = {Angle(0.0), Angle(0.0)};
    result.in_limits[m] = robot::limits.hold(result.bends);
  }
  robot::table.changes(result.bends, result.changes);
  return result;
}

Inverse make_inverse(Length tolerance) {
  Inverse result;
  const int kind = below(4);
  const Forward asked = make_forward();
  for (int m = 0; m < sections; ++m)
    for (int i = 0; i < tendons; ++i)
      result.measured[m][i] = kind == 3
                                  ? asked.changes[m][i] + Length::from_raw(draw(0, robot::tolerance.raw))
                                  : Length::from_raw(draw(kind, robot::tolerance.raw));
  robot::table.bends(result.measured, result.bends);
  robot::table.states(result.measured, tolerance, result.states);
  return result;
}

// One of the two streams: which robot and section it is at, and results under way.
template <class Robot>
struct Stream {
  struct Awaited {
    long clock;
    int section;
    Robot robot;
  };
  int latency;
  Robot robot{};
  int section = sections;  // the next; beyond the last: none
  int robots = 0;          // whose last section was compared
  bool heard = false;      // a robot's beginning was taken
  std::deque<Awaited> awaited;
  bool valid = false, first = false;

  // Decides what this clock hands over.
  template <class Make>
  void choose(long clock, bool reset, bool more, int gap, Make make) {
    const bool leaves = heard && section < sections && below(500) == 0;
    valid = gap == 0 || below(gap) != 0;
    first = valid && more && (section >= sections || leaves) && below(200) != 0;
    if (first) robot = make(), section = 0, heard = true;
    if (valid && heard && section < sections && !reset) awaited.push_back({clock + latency, section, robot});
    if (reset) heard = false, awaited.clear();
    if (valid && section < sections) ++section;
  }
  // Whether a result is due now.
  bool is_due(long clock) const { return !awaited.empty() && awaited.front().clock == clock; }
};

struct Bench {
  Vcore core;
  long clock = 0, compared = 0, wrong = 0, in_limits = 0, resets = 0, of_state[3] = {};
  Stream<Forward> forward{forward_latency};
  Stream<Inverse> inverse{inverse_latency};

  void expect(bool holds, const char* what, int section) {
    if (holds) return;
    if (++wrong < 10) std::printf("clock %ld, section %d: %s\n", clock, section, what);
  }

  void check_forward() {
    expect(core.change_valid == forward.is_due(clock), "changes come in another clock", -1);
    if (!core.change_valid || !forward.is_due(clock)) return;
    const auto& due = forward.awaited.front();
    const int m = due.section;
    for (int i = 0; i < tendons; ++i)
      expect(field(core.changes, i) == due.robot.changes[m][i].raw, "a change differs", m);
    expect(core.in_limits == due.robot.in_limits[m], "in_limits differs", m);
    expect(core.change_last == (m == sections - 1), "change_last differs", m);
    forward.robots += core.change_last;
    in_limits += core.change_last && core.in_limits;
    ++compared;
    forward.awaited.pop_front();
  }

  void check_inverse() {
    expect(core.found_valid == inverse.is_due(clock), "bends come in another clock", -1);
    if (!core.found_valid || !inverse.is_due(clock)) return;
    const auto& due = inverse.awaited.front();
    const int m = due.section;
    expect(static_cast<std::int16_t>(core.found_x) == due.robot.bends[m].x.raw, "found_x differs", m);
    expect(static_cast<std::int16_t>(core.found_y) == due.robot.bends[m].y.raw, "found_y differs", m);
    for (int i = 0; i < tendons; ++i) {
      const int state = (core.states >> (2 * i)) & 3;
      expect(state == static_cast<int>(due.robot.states[m][i]), "a state differs", m);
      if (state < 3) ++of_state[state];
    }
    expect(core.found_last == (m == sections - 1), "found_last differs", m);
    inverse.robots += core.found_last;
    ++compared;
    inverse.awaited.pop_front();
  }

  void step(bool more, int gap, Length tolerance) {
    core.clock = 0;
    core.eval();
    check_forward();
    check_inverse();
    const bool reset = more && below(20000) == 0;
    resets += reset;
    // A result that comes with the edge of a reset does not come.
    forward.choose(clock, reset, more, gap, [] { return make_forward(); });
    inverse.choose(clock, reset, more, gap, [&] { return make_inverse(tolerance); });
    hand_over(reset, tolerance);
    core.clock = 1;
    core.eval();
    ++clock;
  }

  void hand_over(bool reset, Length tolerance) {
    const int bend = forward.section < 1 ? 0 : forward.section - 1,
              read = inverse.section < 1 ? 0 : inverse.section - 1;
    core.reset = reset;
    core.bend_valid = forward.valid;
    core.bend_first = forward.first;
    core.bend_x = static_cast<SData>(forward.robot.bends[bend].x.raw);
    core.bend_y = static_cast<SData>(forward.robot.bends[bend].y.raw);
    core.measured_valid = inverse.valid;
    core.measured_first = inverse.first;
    set_fields(core.measured, inverse.robot.measured[read]);
    core.tolerance = static_cast<SData>(tolerance.raw);
  }
};

}  // namespace

int main(int count, char** arguments) {
  const int robots = count > 1 ? std::atoi(arguments[1]) : 100000;
  const int tolerances[] = {robot::tolerance.raw, 0, 32767, -32768, -1, robot::tolerance.raw};
  const int gaps[] = {0, 3, 2, 5, 0, 10};  // one clock in so many has no section; 0: back to back
  Bench bench;
  bench.core.reset = 1;
  for (int i = 0; i < 2; ++i) bench.core.clock = i, bench.core.eval();
  for (int pass = 0; pass < 6; ++pass) {
    const Length tolerance = Length::from_raw(static_cast<std::int16_t>(tolerances[pass]));
    const int end = static_cast<int>(static_cast<long>(robots) * (pass + 1) / 6);
    while (bench.forward.robots < end || bench.inverse.robots < end) bench.step(true, gaps[pass], tolerance);
    for (int i = 0; i < sections + inverse_latency; ++i) bench.step(false, 0, tolerance);
  }
  std::printf(
      "%d robots of %d sections with %d tendons each way: %ld sections compared in %ld clocks, %ld "
      "differences\n"
      "  %ld robots within limits, %ld resets; tendons %ld exact, %ld slack, %ld over-tensioned\n"
      "  clocks from a section to its result: forward %d, inverse %d; from the first to the last of a robot "
      "%d, %d\n",
      std::min(bench.forward.robots, bench.inverse.robots), sections, tendons, bench.compared, bench.clock,
      bench.wrong, bench.in_limits, bench.resets, bench.of_state[0], bench.of_state[1], bench.of_state[2],
      forward_latency, inverse_latency, forward_latency + sections - 1, inverse_latency + sections - 1);
  const bool is_rich = bench.in_limits > robots / 20 && bench.resets > 0 && bench.of_state[0] > robots / 20 &&
                       bench.of_state[1] > robots / 20 && bench.of_state[2] > robots / 20;
  if (!is_rich) std::printf("some kind of input hardly came\n");
  return bench.wrong == 0 && is_rich ? 0 : 1;
}
