// A program of a user that runs sweeps.
#include <cstdio>

#include "sinew/study/study.hpp"
#include "sinew/study/sweep.hpp"

int main() {
  auto study = sinew::read_study("3pfs-tilt");
  if (!study) return 1;
  const auto done = sinew::sweep(std::move(*study), {.output = "tilt.h5"});
  if (!done || !done->is_complete || done->statuses.at(7) != 31 * 31 * 31) return 2;
  const auto table = sinew::read_result("tilt.h5");
  if (!table || table->row_count() != 31 * 31 * 31) return 3;
  std::printf("%zu samples on %d threads\n", done->samples, done->threads);
}
