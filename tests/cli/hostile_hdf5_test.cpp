// Files of results that claim more than they hold, or lead elsewhere: named errors, in little memory and
// time.
#include <gtest/gtest.h>

#include "command.hpp"
#include "sanitizers.hpp"

namespace hostile_hdf5_test {

using namespace sinew::test;

// Each a few kilobytes on the disc.
const char* const maker = R"(import h5py, numpy as np
def new(name): return h5py.File(name + ".h5", "w")
with new("large-fill") as f: f.create_dataset("a", shape=(19000, 19000), chunks=(100, 100), dtype="f8")
with new("large-unwritten") as f: f.create_dataset("a", shape=(19000, 19000), dtype="f8")
with new("large-bomb") as f: f.create_dataset("a", data=np.zeros((4000, 4000)), chunks=(1000, 1000), compression=9)
with new("large-block") as f: f.create_dataset("a", shape=(10,), maxshape=(None,), chunks=(2**28,), compression=9, dtype="f8")
with new("large-overflow") as f: f.create_dataset("a", shape=(2**40, 2**40), chunks=(2, 2), dtype="f8")
with new("elsewhere-link") as f: f["a"] = h5py.ExternalLink("plain.h5", "/x")
with new("elsewhere-loop") as f: f["a"] = h5py.SoftLink("/b"); f["b"] = h5py.SoftLink("/a")
with new("elsewhere-data") as f: f.create_dataset("a", shape=(10,), dtype="u1", external=[("/etc/passwd", 0, 10)])
with new("elsewhere-virtual") as f:
    layout = h5py.VirtualLayout(shape=(3,), dtype="f8")
    layout[:] = h5py.VirtualSource("plain.h5", "x", shape=(3,))
    f.create_virtual_dataset("a", layout)
with new("none-texts") as f:
    f["s"] = np.array([b"a", b"b"]); f["c"] = np.zeros(2, dtype=[("a", "f8")])
with new("good-nan") as f: f["x"] = np.array([0., 1, 2]); f["v"] = np.array([1., np.nan, np.inf])
with new("good-types") as f:
    f["i"] = np.array([1, 2], dtype="i2"); f["f"] = np.array([1, 2], dtype="f2"); f["s"] = np.array([b"a", b"b"])
with new("good-units") as f:  # a list of units, of which one was read into room for one
    f["x"] = np.arange(3.); f["y"] = np.arange(3.); f["x"].attrs["units"] = np.array([b"m"] * 1000, dtype="S60")
with new("plain") as f: f["x"] = np.arange(3.); f["y"] = np.arange(3.)
whole = open("plain.h5", "rb").read()
open("cut.h5", "wb").write(whole[:len(whole) // 2])
)";

TEST(HostileHdf5, EndsWithANamedErrorInLittleMemory) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "no h5py";
  const Scratch here;
  write_text(here.path() / "make.py", maker);
  const Outcome made = run_shell("/usr/bin/python3 make.py && mkfifo elsewhere-pipe.h5", here.path());
  ASSERT_EQ(made.exit, 0) << made.err;
  // AddressSanitizer reserves more.
  const std::string bound = addresses_are_checked ? "" : "ulimit -v 1000000; ";
  const auto plot = [&](const std::string& name) {
    return run_shell(bound + "timeout 20 sinew plot " + name + ".h5 -q -o out.svg", here.path());
  };
  for (const char* name :
       {"large-fill", "large-unwritten", "large-bomb", "large-block", "large-overflow", "elsewhere-link",
        "elsewhere-loop", "elsewhere-data", "elsewhere-virtual", "elsewhere-pipe", "none-texts", "cut"}) {
    const Outcome outcome = plot(name);
    EXPECT_EQ(outcome.exit, 2) << name << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
    const bool is_named = outcome.err.find("[file_unreadable]") != std::string::npos ||
                          outcome.err.find("[too_large]") != std::string::npos ||
                          outcome.err.find("[no_columns]") != std::string::npos;
    EXPECT_TRUE(is_named) << outcome.err;
  }
  for (const char* name : {"good-nan", "good-types", "good-units", "plain"})
    EXPECT_EQ(plot(name).exit, 0) << name;
}

}  // namespace hostile_hdf5_test
