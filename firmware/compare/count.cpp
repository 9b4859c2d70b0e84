/// Instructions of the kernels on a Cortex-M, under qemu with `-icount shift=0`, where the system timer
/// counts them: KERNEL INSTRUCTIONS, the mean of random bends, with the call and the return.
#include "inputs.h"
#include "target.h"

namespace {

using namespace sinew::kernel;

constexpr Uint32 samples = 48, repeats = 256;

// What kernels read and write: global, so that the compiler knows nothing of it.
Bends<Angle> bends;
Bends<Long> long_bends;
Bends<float> float_bends;
Changes<Length> changes;
Changes<Long> long_changes;
Changes<float> float_changes;

/// The system timer, which counts down in 24 bits.
struct SysTick {
  volatile Uint32 control, reload, current;
};
constexpr Uint32 processor_clock = 5;  ///< and enabled
SysTick& timer() { return *reinterpret_cast<SysTick*>(0xE000E010); }

/// Ticks of so many calls.
Uint32 __attribute__((noinline, noclone)) ticks_of(void (*kernel)(), Uint32 calls) {
  timer().control = 0;
  timer().reload = 0xffffff;
  timer().current = 0;
  timer().control = processor_clock;
  for (Uint32 i = 0; i < calls; ++i) {
    asm volatile("" ::: "memory");
    kernel();
  }
  return 0xffffff - timer().current;
}

void __attribute__((noinline)) nothing() { asm volatile(""); }
void __attribute__((noinline)) known_number() { asm volatile(".rept 200\n\tnop\n\t.endr"); }

void __attribute__((noinline)) int16_changes() { robot::table.changes(bends, changes); }
void __attribute__((noinline)) int16_exact() { robot::exact_short.changes(bends, changes); }
void __attribute__((noinline)) long_linear() { robot::table_q15_16.changes(long_bends, long_changes); }
void __attribute__((noinline)) long_exact() { robot::exact_q15_16.changes(long_bends, long_changes); }
void __attribute__((noinline)) float_linear() { robot::table_float.changes(float_bends, float_changes); }
void __attribute__((noinline)) float_exact() { robot::exact_float.changes(float_bends, float_changes); }

struct Counted {
  const char* name;
  void (*run)();
  Uint32 ticks;
};
Counted counted[] = {{"int16_changes", int16_changes, 0}, {"int16_exact", int16_exact, 0},
                     {"q15_16_changes", long_linear, 0},  {"q15_16_exact", long_exact, 0},
                     {"float_changes", float_linear, 0},  {"float_exact", float_exact, 0}};

void draw(Random& random) {
  constexpr float step = 1.0f / (Uint32{1} << Angle::fraction);
  for (unsigned char m = 0; m < sections; ++m) {
    const Int16 x = scaled(random.any(), robot::limits.limit[m]),
                y = scaled(random.any(), robot::limits.limit[m]);
    bends[m] = {Angle::from_raw(x), Angle::from_raw(y)};
    long_bends[m] = {Long(bends[m].x), Long(bends[m].y)};
    float_bends[m] = {step * x, step * y};
  }
}

}  // namespace

int main() {
  start();
  // How long a tick is depends on the machine: 200 instructions more tell it.
  constexpr Uint32 known = 200, calls = samples * repeats, call_and_return = 2;
  const Uint32 empty = ticks_of(nothing, calls), more = ticks_of(known_number, calls) - empty;
  Random random;
  for (Uint32 sample = 0; sample < samples; ++sample) {
    draw(random);
    for (Counted& kernel : counted) kernel.ticks += ticks_of(kernel.run, repeats);
  }
  for (const Counted& kernel : counted) {
    put_text(kernel.name);
    put(' ');
    put_number(((kernel.ticks - empty) * known + more / 2) / more + call_and_return);
    put('\n');
  }
  finish();
  return 0;
}
