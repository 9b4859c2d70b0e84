/// Highway's shared library measures the resolution of the clock whenever it is loaded, for benchmarks that
/// nobody here runs: 3 ms, more than all else of a start. This definition is found before its own.
/// docs/adr/0011.
#include <cstdint>

namespace hwy::platform {

__attribute__((visibility("default"))) std::uint64_t TimerResolution() { return 1; }

}  // namespace hwy::platform
