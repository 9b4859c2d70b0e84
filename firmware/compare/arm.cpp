/// A Cortex-M0 or M4F that starts at address 0, under a debugger or simulator that offers semihosting. With
/// cortex_m.ld this is all that runs: no library but the compiler's own.
#include "target.h"

extern "C" {

// Of cortex_m.ld.
extern Uint32 data_in_flash[], data_start[], data_end[], bss_end[], stack_top[];

int main();
[[noreturn]] void reset();

// What the compiler calls by itself. Not optimised into calls of themselves.
__attribute__((optimize("no-tree-loop-distribute-patterns"))) void* memcpy(void* to, const void* from,
                                                                           decltype(sizeof(0)) size) {
  for (decltype(size) i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<const char*>(from)[i];
  return to;
}
__attribute__((optimize("no-tree-loop-distribute-patterns"))) void* memset(void* to, int value,
                                                                           decltype(sizeof(0)) size) {
  for (decltype(size) i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<char>(value);
  return to;
}
}

namespace {

/// ARM's "Semihosting for AArch32 and AArch64": the breakpoint that a debugger knows.
void call_host(Uint32 operation, Uint32 argument) {
  register Uint32 r0 asm("r0") = operation;
  register Uint32 r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}
constexpr Uint32 write_character = 0x03, exit_program = 0x18, finished = 0x20026;

[[noreturn]] void fail() {
  call_host(exit_program, 0x20023);  // a run-time error: a fault of the processor
  for (;;) {
  }
}

}  // namespace

void start() {}
void put(char c) { call_host(write_character, reinterpret_cast<Uint32>(&c)); }
void finish() { call_host(exit_program, finished); }

extern "C" void reset() {
#ifdef __ARM_FP
  *reinterpret_cast<volatile Uint32*>(0xE000ED88) = 0xF << 20;  // CPACR: the floating-point unit is off
  asm volatile("dsb\n\tisb");
#endif
  Uint32* from = data_in_flash;
  for (Uint32* to = data_start; to < data_end; ++to, ++from) *to = *from;
  for (Uint32* to = data_end; to < bss_end; ++to) *to = 0;
  main();
  fail();
}

/// The stack, the start, and the two faults.
__attribute__((section(".vectors"), used))
const void* const vectors[4] = {stack_top, reinterpret_cast<const void*>(reset),
                                reinterpret_cast<const void*>(fail), reinterpret_cast<const void*>(fail)};
