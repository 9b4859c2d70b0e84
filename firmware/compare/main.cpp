/// Results of every kernel in fixed point, for random inputs: of each block of inputs and each kernel a line,
/// INPUTS KERNEL CHECKSUM, over all its results so far. The text is the same on every machine:
/// firmware/compare/README.md
#include "kernels.h"

#ifndef SINEW_INPUTS
#define SINEW_INPUTS 100000
#endif
#ifndef SINEW_BLOCK
#define SINEW_BLOCK 5000
#endif
#ifndef SINEW_FROM  // no lines before that input: with blocks of 1 it finds the first whose results differ
#define SINEW_FROM 1
#endif
#ifndef SINEW_DEAR_EVERY  // kernels that take long have only one input of so many
#define SINEW_DEAR_EVERY 1
#endif

namespace {

constexpr Uint32 inputs = SINEW_INPUTS, block = SINEW_BLOCK, from = SINEW_FROM, dear_every = SINEW_DEAR_EVERY;

Inputs in;
Sum sums[kernel_count];
Uint32 done[kernel_count];

void put_line(Uint32 count, const char* name, Uint32 sum) {
  put_number(count);
  put(' ');
  put_text(name);
  put(' ');
  put_hex(sum);
  put('\n');
}

void put_head() {
  put_text("table ");
  put_hex(robot::hash);
  put_text(", inputs ");
  put_number(inputs);
  put_text(", dear kernels 1 of ");
  put_number(dear_every);
  put('\n');
}

}  // namespace

int main() {
  start();
  put_head();
  for (Uint32 count = 1; count <= inputs; ++count) {
    in.draw();
    for (unsigned char k = 0; k < kernel_count; ++k) {
      if (kernel(k).is_dear && count % dear_every != 0) continue;
      kernel(k).run(in, sums[k]);
      ++done[k];
    }
    if (count % block != 0) continue;
    for (unsigned char k = 0; k < kernel_count; ++k) {
      sums[k].close_block();
      if (count >= from) put_line(count, kernel(k).name, sums[k].value());
    }
  }
  put_text("all\n");
  for (unsigned char k = 0; k < kernel_count; ++k) put_line(done[k], kernel(k).name, sums[k].value());
  finish();
  return 0;
}
