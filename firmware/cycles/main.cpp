/// Cycles of the kernels on an ATmega2560, with interrupts off: random bends of two robots of Sections
/// sections each, and of every kernel a line a sample, `run KERNEL SAMPLE CYCLES RESULT...`. The headers are
/// made by `sinew export`.
///
/// Integers are in steps of their format, floats as their bits. UART 0 at 1 Mbaud; it ends asleep.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "neutral.h"
#include "paper.h"
#include "sinew/kernel/polar.h"
#include "timer.h"
#include "tpcj.h"

namespace {

using namespace sinew::kernel;

constexpr unsigned M = tpcj::sections;
constexpr unsigned samples = SINEW_SAMPLES;

// What kernels read and write: global, so that the compiler knows nothing of it.
template <class Angle, class Length = Angle>
struct Data {
  Bend<Angle> bends[M];
  Length changes[M][3];
};
Data<float> floats;
Data<Fixed<32, 16>> longs;
Data<tpcj::Angle, tpcj::Length> twin;
Data<neutral::Angle, neutral::Length> round;
Bend<float> polar_floats[M];
Bend<Fixed<32, 16>> polar_longs[M];
Bend<neutral::Angle> polar_round[M];
paper::Robot<float, M> paper_floats;
paper::Robot<Fixed<32, 16>, M> paper_longs;
// The paper's program in 16 bits needs one format for everything: up to 256 mm, and steps of 1/128.
using Coarse = Fixed<16, 7>;
paper::Robot<Coarse, M> paper_shorts;
Data<Coarse> shorts;
Bend<Coarse> polar_shorts[M];

void put(char c) {
  while (!(UCSR0A & (1 << UDRE0))) {
  }
  UDR0 = static_cast<unsigned char>(c);
}
void put(const char* text) {
  while (*text) put(*text++);
}
void put(unsigned long value) {
  char digits[11];
  unsigned char count = 0;
  do digits[count++] = static_cast<char>('0' + value % 10);
  while (value /= 10);
  while (count > 0) put(digits[--count]);
}
void put(long value) {
  if (value < 0) put('-');
  put(value < 0 ? 0 - static_cast<unsigned long>(value) : static_cast<unsigned long>(value));
}
void put(float value) {
  unsigned long bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  put(bits);
}
template <int Bits, int Fraction>
void put(Fixed<Bits, Fraction> value) {
  put(static_cast<long>(value.raw));
}

/// Numerical Recipes' generator; the upper half of its state.
int draw() {
  static unsigned long state = 20170;
  state = state * 1664525UL + 1013904223UL;
  return static_cast<int>(state >> 16);
}
/// Between ± limit, both of 16 bits; never 0, where the paper's program has no value.
int within(int limit) {
  const int value = static_cast<int>((static_cast<long>(draw()) * limit) >> 15);
  return value == 0 ? 1 : value;
}

constexpr int half_turn = static_cast<int>(3.14159 * (1L << neutral::Angle::fraction));

void draw_bends(unsigned sample) {
  put("bends ");
  put(static_cast<unsigned long>(sample));
  for (unsigned m = 0; m < M; ++m) {
    const int x = within(tpcj::limits.limit[m]), y = within(tpcj::limits.limit[m]);
    const int drawn = within(neutral::limits.limit[m]), theta = drawn < 0 ? -drawn : drawn,
              phi = within(half_turn);
    twin.bends[m] = {tpcj::Angle::from_raw(x), tpcj::Angle::from_raw(y)};
    polar_round[m] = {neutral::Angle::from_raw(theta), neutral::Angle::from_raw(phi)};
    longs.bends[m] = {Fixed<32, 16>(twin.bends[m].x), Fixed<32, 16>(twin.bends[m].y)};
    polar_longs[m] = {Fixed<32, 16>(polar_round[m].x), Fixed<32, 16>(polar_round[m].y)};
    shorts.bends[m] = {Coarse(twin.bends[m].x), Coarse(twin.bends[m].y)};
    polar_shorts[m] = {Coarse(polar_round[m].x), Coarse(polar_round[m].y)};
    floats.bends[m] = {static_cast<float>(x) / (1L << tpcj::Angle::fraction),
                       static_cast<float>(y) / (1L << tpcj::Angle::fraction)};
    polar_floats[m] = {static_cast<float>(theta) / (1L << neutral::Angle::fraction),
                       static_cast<float>(phi) / (1L << neutral::Angle::fraction)};
    const int drawn_values[] = {x, y, theta, phi};
    for (const int value : drawn_values) {
      put(' ');
      put(static_cast<long>(value));
    }
  }
  put("\n");
}

template <class S>
void make_paper(paper::Robot<S, M>& robot) {
  robot.joints = S(8.0);
  robot.length = S(2.375);
  robot.radius = S(2.45);
  for (unsigned m = 0; m < M; ++m)
    for (unsigned i = 0; i < 3; ++i) {
      const double angle = 0.41887902 * (m + 1) + 2.0943951 * i;
      robot.angles[m][i] = S(angle > 3.1415927 ? angle - 6.2831853 : angle);
      robot.arms[m][i][0] = S(2.45 * __builtin_cos(angle));
      robot.arms[m][i][1] = S(2.45 * __builtin_sin(angle));
    }
}

unsigned long overhead = 0;

void __attribute__((noinline)) nothing() { asm volatile("" ::: "memory"); }

/// Cycles of a call, with the call and the return.
unsigned long cycles_of(void (*kernel)()) {
  timer::start();
  asm volatile("" ::: "memory");
  kernel();
  asm volatile("" ::: "memory");
  return timer::stop() - overhead;
}

template <class S>
void report(const char* name, unsigned sample, unsigned long cycles, const S (&changes)[M][3]) {
  put("run ");
  put(name);
  put(' ');
  put(static_cast<unsigned long>(sample));
  put(' ');
  put(cycles);
  for (const auto& section : changes)
    for (const S change : section) {
      put(' ');
      put(change);
    }
  put("\n");
}

/// Bends (theta, phi) by way of their components.
template <class Table, class Angle, class Length>
void by_polar(const Table& table, const Bend<Angle> (&polar)[M], Data<Angle, Length>& data) {
  for (unsigned m = 0; m < M; ++m) data.bends[m] = polar_bend(polar[m].x, polar[m].y);
  table.changes(data.bends, data.changes);
}

#define KERNEL(name, data, expression)                  \
  void __attribute__((noinline)) name() { expression; } \
  void run_##name(unsigned sample) { report(#name, sample, cycles_of(name), data.changes); }

constexpr auto portable = tpcj::short_table<Portable>();

KERNEL(pcc_polar_paper_float, floats, paper_floats.polar_changes(polar_floats, floats.changes))
KERNEL(pcc_polar_paper_q15_16, longs, paper_longs.polar_changes(polar_longs, longs.changes))
KERNEL(pcc_twin_paper_float, floats, paper_floats.twin_changes(floats.bends, floats.changes))
KERNEL(pcc_twin_paper_q15_16, longs, paper_longs.twin_changes(longs.bends, longs.changes))
KERNEL(pcc_polar_paper_int16, shorts, paper_shorts.polar_changes(polar_shorts, shorts.changes))
KERNEL(pcc_twin_paper_int16, shorts, paper_shorts.twin_changes(shorts.bends, shorts.changes))
KERNEL(pcc_twin_float, floats, tpcj::exact_float.changes(floats.bends, floats.changes))
KERNEL(pcc_twin_q15_16, longs, tpcj::exact_q15_16.changes(longs.bends, longs.changes))
KERNEL(pcc_twin_int16, twin, tpcj::exact_short.changes(twin.bends, twin.changes))
KERNEL(lsk_twin_float, floats, tpcj::table_float.changes(floats.bends, floats.changes))
KERNEL(lsk_twin_float_sum, floats, tpcj::table_float.changes_by_sum(floats.bends, floats.changes))
KERNEL(lsk_twin_q15_16, longs, tpcj::table_q15_16.changes(longs.bends, longs.changes))
KERNEL(lsk_twin_int16, twin, portable.changes(twin.bends, twin.changes))
KERNEL(lsk_twin_int16_mac, twin, tpcj::table.changes(twin.bends, twin.changes))
KERNEL(lsk_twin_int16_mac_sum, twin, tpcj::table.changes_by_sum(twin.bends, twin.changes))
// These change the bends they share with the kernels above, and so come last.
KERNEL(pcc_polar_float, floats, by_polar(neutral::exact_float, polar_floats, floats))
KERNEL(pcc_polar_q15_16, longs, by_polar(neutral::exact_q15_16, polar_longs, longs))
KERNEL(pcc_polar_int16, round, by_polar(neutral::exact_short, polar_round, round))
KERNEL(lsk_polar_float, floats, by_polar(neutral::table_float, polar_floats, floats))
KERNEL(lsk_polar_q15_16, longs, by_polar(neutral::table_q15_16, polar_longs, longs))
KERNEL(lsk_polar_int16, round, by_polar(neutral::table, polar_round, round))

/// Those that take long: of every fourth sample.
constexpr void (*dear[])(unsigned) = {run_pcc_polar_paper_float, run_pcc_polar_paper_q15_16,
                                      run_pcc_twin_paper_float,  run_pcc_twin_paper_q15_16,
                                      run_pcc_polar_paper_int16, run_pcc_twin_paper_int16};
constexpr void (*kernels[])(unsigned) = {
    run_pcc_twin_float,         run_pcc_twin_q15_16,  run_pcc_twin_int16,   run_lsk_twin_float,
    run_lsk_twin_float_sum,     run_lsk_twin_q15_16,  run_lsk_twin_int16,   run_lsk_twin_int16_mac,
    run_lsk_twin_int16_mac_sum, run_pcc_polar_float,  run_pcc_polar_q15_16, run_pcc_polar_int16,
    run_lsk_polar_float,        run_lsk_polar_q15_16, run_lsk_polar_int16};

}  // namespace

int main() {
  UCSR0A = 1 << U2X0;
  UBRR0 = 1;  // 1 Mbaud
  UCSR0B = 1 << TXEN0;
  overhead = cycles_of(nothing) - 10;  // a call and a return of a 22-bit program counter
  make_paper(paper_floats);
  make_paper(paper_longs);
  make_paper(paper_shorts);
  put("sections ");
  put(static_cast<unsigned long>(M));
  put("\n");
  for (unsigned sample = 0; sample < samples; ++sample) {
    draw_bends(sample);
    if (sample % 4 == 0)
      for (const auto run : dear) run(sample);
    for (const auto run : kernels) run(sample);
  }
  put("end\n");
  while (!(UCSR0A & (1 << TXC0))) {
  }
  cli();
  sleep_enable();
  sleep_cpu();
}
