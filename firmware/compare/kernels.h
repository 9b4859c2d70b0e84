/// @file kernels.h
/// Every kernel in fixed point that a robot's header offers, with checksums of what it gives.
#ifndef SINEW_FIRMWARE_KERNELS_H
#define SINEW_FIRMWARE_KERNELS_H

#include "inputs.h"
#include "sinew/kernel/polar.h"
#include "sum.h"

constexpr auto portable_table = robot::short_table<sinew::kernel::Portable>();
constexpr auto portable_exact = robot::exact_short_table<sinew::kernel::Portable>();

template <class Table, class S>
void add_changes(const Table& table, const sinew::kernel::Bend<S> (&bends)[sections], Sum& sum) {
  Changes<typename Table::Length> changes;
  table.changes(bends, changes);
  sum.add(changes);
}
template <class Table, class S>
void add_changes_by_sum(const Table& table, const sinew::kernel::Bend<S> (&bends)[sections], Sum& sum) {
  Changes<typename Table::Length> changes;
  table.changes_by_sum(bends, changes);
  sum.add(changes);
}

template <class Table, class S>
void add_bends(const Table& table, const S (&changes)[sections][tendons], Sum& sum) {
  Bends<typename Table::Angle> bends;
  table.bends(changes, bends);
  sum.add(bends);
}

template <class Table, class S>
void add_states(const Table& table, const S (&changes)[sections][tendons], Sum& sum) {
  sinew::kernel::TendonState states[sections][tendons];
  table.states(changes, S(robot::tolerance), states);
  sum.add(states);
}

/// The kernels in float, of the same bends. Their bits agree only where products and sums are rounded alike.
template <class Table>
void add_float_changes(const Table& table, const Bends<Angle>& bends, Sum& sum) {
  constexpr float step = 1.0f / static_cast<float>(Uint32{1} << Angle::fraction);
  Bends<float> floats;
  for (unsigned char m = 0; m < sections; ++m)
    floats[m] = {step * static_cast<float>(bends[m].x.raw), step * static_cast<float>(bends[m].y.raw)};
  add_changes(table, floats, sum);
}

template <int FromBits, int From, int ToBits, int To>
void add_conversion(typename sinew::kernel::Integer<FromBits>::type raw, Sum& sum) {
  using namespace sinew::kernel;
  sum.add(Fixed<ToBits, To>(Fixed<FromBits, From>::from_raw(raw)));
}
inline void add_conversions(const Inputs& in, Sum& sum) {
  const Int16 word = in.change.raw;
  add_conversion<16, 13, 16, 12>(word, sum);
  add_conversion<16, 12, 16, 13>(word, sum);
  add_conversion<16, 15, 16, 0>(word, sum);
  add_conversion<16, 0, 16, 15>(word, sum);
  add_conversion<16, 13, 32, 16>(word, sum);
  add_conversion<32, 16, 16, 13>(in.counts, sum);
  add_conversion<32, 13, 16, 12>(in.counts, sum);
  add_conversion<32, 17, 32, 16>(in.counts, sum);
  add_conversion<32, 16, 32, 17>(in.counts, sum);
  add_conversion<32, 0, 32, 31>(in.counts, sum);
}

template <class S>
void add_arithmetic(S a, S b, Sum& sum) {
  sum.add(a + b);
  sum.add(a - b);
  sum.add(-a);
  sum.add(S(a * b));
  sum.add(a / b);
  sum.add(sinew::kernel::wrapped_sum(a, b));
  sum.add(sinew::kernel::wrapped_difference(a, b));
}
inline void add_arithmetic(const Inputs& in, Sum& sum) {
  add_arithmetic(in.polar.x, in.polar.y, sum);
  add_arithmetic(in.long_polar.x, in.long_polar.y, sum);
}

struct Kernel {
  const char* name;
  bool is_dear;  ///< takes an ATmega2560 more than 11000 cycles
  void (*run)(const Inputs& in, Sum& sum);
};

constexpr unsigned char kernel_count = 28;

/// In a function, since a constructor before `main` would need more of a target.
inline const Kernel& kernel(unsigned char index) {
  using In = const Inputs&;
  static const Kernel kernels[kernel_count] = {
      {"int16_changes_native", false, [](In in, Sum& sum) { add_changes(robot::table, in.bends, sum); }},
      {"int16_changes", false, [](In in, Sum& sum) { add_changes(portable_table, in.bends, sum); }},
      {"int16_changes_by_sum_native", false,
       [](In in, Sum& sum) { add_changes_by_sum(robot::table, in.bends, sum); }},
      {"int16_changes_by_sum", false,
       [](In in, Sum& sum) { add_changes_by_sum(portable_table, in.bends, sum); }},
      {"int16_bends", false, [](In in, Sum& sum) { add_bends(robot::table, in.changes, sum); }},
      {"int16_states_native", false, [](In in, Sum& sum) { add_states(robot::table, in.changes, sum); }},
      {"int16_states", false, [](In in, Sum& sum) { add_states(portable_table, in.changes, sum); }},
      {"int16_exact_native", true, [](In in, Sum& sum) { add_changes(robot::exact_short, in.bends, sum); }},
      {"int16_exact", true, [](In in, Sum& sum) { add_changes(portable_exact, in.bends, sum); }},
      {"int16_exact_bends", true, [](In in, Sum& sum) { add_bends(robot::exact_short, in.changes, sum); }},
      {"int16_exact_states_native", true,
       [](In in, Sum& sum) { add_states(robot::exact_short, in.changes, sum); }},
      {"int16_exact_states", true, [](In in, Sum& sum) { add_states(portable_exact, in.changes, sum); }},
      {"int16_polar_bend", false,
       [](In in, Sum& sum) { sum.add(sinew::kernel::polar_bend(in.polar.x, in.polar.y)); }},
      {"q15_16_changes", false,
       [](In in, Sum& sum) { add_changes(robot::table_q15_16, in.long_bends, sum); }},
      {"q15_16_changes_by_sum", false,
       [](In in, Sum& sum) { add_changes_by_sum(robot::table_q15_16, in.long_bends, sum); }},
      {"q15_16_bends", true, [](In in, Sum& sum) { add_bends(robot::table_q15_16, in.long_changes, sum); }},
      {"q15_16_states", true, [](In in, Sum& sum) { add_states(robot::table_q15_16, in.long_changes, sum); }},
      {"q15_16_exact", true, [](In in, Sum& sum) { add_changes(robot::exact_q15_16, in.long_bends, sum); }},
      {"q15_16_exact_bends", true,
       [](In in, Sum& sum) { add_bends(robot::exact_q15_16, in.long_changes, sum); }},
      {"q15_16_exact_states", true,
       [](In in, Sum& sum) { add_states(robot::exact_q15_16, in.long_changes, sum); }},
      {"q15_16_polar_bend", false,
       [](In in, Sum& sum) { sum.add(sinew::kernel::polar_bend(in.long_polar.x, in.long_polar.y)); }},
      {"limits_hold", false, [](In in, Sum& sum) { sum.add(robot::limits.hold(in.bends)); }},
      {"motor_of", false,
       [](In in, Sum& sum) { sum.add(robot::motor.of(in.change)), sum.add(in.motor.of(in.change)); }},
      {"motor_change", false,
       [](In in, Sum& sum) { sum.add(robot::motor.change(in.counts)), sum.add(in.motor.change(in.counts)); }},
      {"conversions", false, add_conversions},
      {"arithmetic", false, add_arithmetic},
      {"float_changes", true, [](In in, Sum& sum) { add_float_changes(robot::table_float, in.bends, sum); }},
      {"float_exact", true, [](In in, Sum& sum) { add_float_changes(robot::exact_float, in.bends, sum); }},
  };
  return kernels[index];
}

#endif
