// Sweeps as people run them: killed, out of room, on ranks, read by others.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "command.hpp"
#include "paths.hpp"
#include "sanitizers.hpp"
#include "thorough.hpp"

namespace sweep_test {

using namespace sinew::test;

const int values = addresses_are_checked ? 15 : count_of(31, 53);  // instrumented code is slow

const std::string rods =
    "sinew: 1\nrobot: 3pfs-g2\nquery: {query: forward, inputs: [$a, $b, $c]}\naxes:\n" + [] {
      std::string axes;
      for (const char* name : {"a", "b", "c"})
        axes += std::string("  ") + name + ": {from: 400 mm, to: 460 mm, count: " + std::to_string(values) +
                "}\n";
      return axes;
    }();
const std::string queries = R"(sinew: 1
robot: 3-frr
query: {query: inverse, pose: {x: $x, y: $y, phi: 0.1}}
axes:
  y: {from: -30 mm, to: 30 mm, count: 91}
  x: {from: -30 mm, to: 30 mm, count: 93}
)";

/// Starts the command, and kills it when it is time; whether it had ended before.
bool is_done_before(const std::function<bool()>& is_time, const std::vector<std::string>& words,
                    const std::filesystem::path& folder) {
  std::vector<std::string> all{command_path};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) == 0) execv(command_path, argv.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (is_time()) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return true;
}

TEST(SweepCommand, SurvivesKillsAtAnyMoment) {
  const int max_kills = count_of(10, 25);
  for (const std::string& study : {rods, queries}) {
    const Scratch here;
    write_text(here.path() / "study.yaml", study);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run_command({"sweep", "study.yaml", "-q", "-o", "whole.h5"}, here.path()).exit, 0);
    const auto whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::string expected = read_text(here.path() / "whole.h5");
    std::mt19937 random(11);
    std::uniform_real_distribution<double> part(0.02,
                                                1.1);  // of a run from nothing: starting is a large part
    int kills = 0, runs = 0, finished = 0;
    while (kills < max_kills || finished == 0) {
      ASSERT_LT(++runs, 500);
      const auto end = std::chrono::steady_clock::now() +
                       std::chrono::microseconds(static_cast<long>(1e6 * whole * part(random)));
      if (is_done_before([&] { return std::chrono::steady_clock::now() >= end; },
                         {"sweep", "study.yaml", "-q", "--resume", "-o", "parts.h5"}, here.path())) {
        EXPECT_EQ(read_text(here.path() / "parts.h5"), expected);
        std::filesystem::remove(here.path() / "parts.h5");  // and anew
        ++finished;
      } else {
        ++kills;
      }
    }
    ASSERT_EQ(run_command({"sweep", "study.yaml", "-q", "--resume", "-o", "parts.h5"}, here.path()).exit, 0);
    EXPECT_EQ(read_text(here.path() / "parts.h5"), expected);
    std::filesystem::remove(here.path() / "parts.h5");
  }
}

TEST(SweepCommand, OutOfRoomKeepsWhatThereWas) {  // a limit on files stands for a full disc
  const Scratch here;
  write_text(here.path() / "study.yaml", rods);
  ASSERT_EQ(run_command({"sweep", "study.yaml", "-q", "-o", "whole.csv"}, here.path()).exit, 0);
  const std::string start = std::string("trap '' XFSZ; ulimit -f ");
  const std::string run = std::string("; ") + command_path + " sweep study.yaml -q --resume -o parts.csv";
  const auto size = std::filesystem::file_size(here.path() / "whole.csv") / 1024;
  for (const auto room : {size / 8, size / 6, size - 8}) {  // in the log, in the log, in the file
    const Outcome full = run_shell(start + std::to_string(room) + run, here.path());
    EXPECT_EQ(full.exit, 4) << full.err;
    EXPECT_NE(full.err.find("--resume"), std::string::npos) << full.err;
    EXPECT_TRUE(std::filesystem::exists(here.path() / "parts.csv.log"));
    EXPECT_FALSE(std::filesystem::exists(here.path() / "parts.csv"));
  }
  ASSERT_EQ(run_command({"sweep", "study.yaml", "-q", "--resume", "-o", "parts.csv"}, here.path()).exit, 0);
  EXPECT_EQ(read_text(here.path() / "parts.csv"), read_text(here.path() / "whole.csv"));
}

/// Of a file that is made with room for all rows, before anything is computed.
TEST(SweepCommand, OutOfRoomIsToldBeforeItBegins) {
  const Scratch here;
  write_text(here.path() / "study.yaml", rods);
  const std::string run = std::string("trap '' XFSZ; ulimit -f 100; ") + command_path;
  const Outcome full = run_shell(run + " sweep study.yaml -q -o out.h5", here.path());
  EXPECT_EQ(full.exit, 4) << full.err;
  EXPECT_NE(full.err.find("File too large"), std::string::npos) << full.err;
  for (const char* name : {"out.h5", "out.h5.log", "out.h5.part"})
    EXPECT_FALSE(std::filesystem::exists(here.path() / name)) << name;
}

TEST(SweepCommand, BeginsNoSweepOverAnother) {
  const Scratch here;
  write_text(here.path() / "study.yaml", queries);
  bool has_begun = false;  // killed neither before the first chunks nor after the last
  for (int attempt = 0; !has_begun && attempt < 100; ++attempt) {
    for (const char* name : {"out.h5", "out.h5.log", "out.h5.part"})
      std::filesystem::remove(here.path() / name);
    std::error_code none;
    const auto has_chunks = [&] {
      const auto size = std::filesystem::file_size(here.path() / "out.h5.log", none);
      return !none && size > 1000;
    };
    has_begun = !is_done_before(has_chunks, {"sweep", "study.yaml", "-q", "-o", "out.h5"}, here.path());
  }
  ASSERT_TRUE(has_begun);
  const Outcome again = run_command({"sweep", "study.yaml", "-o", "out.h5"}, here.path());
  EXPECT_EQ(again.exit, 2);
  EXPECT_NE(again.err.find("[sweep_begun]"), std::string::npos) << again.err;
  EXPECT_EQ(run_command({"sweep", "study.yaml", "-q", "-o", "out.h5", "--resume"}, here.path()).exit, 0);
}

TEST(SweepCommand, ThreeRanksGiveTheSameBytes) {
  if (addresses_are_checked) GTEST_SKIP() << "MPI leaves memory behind, and takes over that of the process";
  if (std::system("command -v mpirun >/dev/null") != 0) GTEST_SKIP() << "no mpirun";
  for (const std::string& study : {rods, queries}) {
    const Scratch here;
    write_text(here.path() / "study.yaml", study);
    const Outcome alone = run_command({"sweep", "study.yaml", "-q", "-o", "alone.h5"}, here.path());
    ASSERT_EQ(alone.exit, 0) << alone.err;
    const Outcome together =
        run_shell(std::string("env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                              "mpirun --oversubscribe -n 3 ") +
                      command_path + " sweep study.yaml -o together.h5",
                  here.path());
    ASSERT_EQ(together.exit, 0) << together.err;
    EXPECT_NE(together.out.find("3 ranks"), std::string::npos) << together.out;
    EXPECT_EQ(read_text(here.path() / "together.h5"), read_text(here.path() / "alone.h5"));
    const Outcome refused =
        run_shell(std::string("env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                              "mpirun --oversubscribe -n 3 ") +
                      command_path + " sweep study.yaml -o /dev/null/all.h5",
                  here.path());
    EXPECT_EQ(refused.exit, 4) << refused.err;
    EXPECT_NE(refused.err.find("[file_unwritable]"), std::string::npos) << refused.err;
  }
}

TEST(SweepCommand, PythonReadsColumnsUnitsAndAxes) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "no h5py";
  const Scratch here;
  write_text(here.path() / "study.yaml", queries);
  ASSERT_EQ(run_command({"sweep", "study.yaml", "-q", "-o", "out.h5", "--compress", "4"}, here.path()).exit,
            0);
  write_text(here.path() / "read.py", R"(import h5py
with h5py.File("out.h5") as results:
    column = results["inputs_0"]
    assert column.shape == (91, 93) and column.attrs["units"] == b"m", column.attrs["units"]
    assert column.dims[1][0].name == "/x" and column.dims[0][0].attrs["units"] == b"m"
    meanings = results["status"].attrs["flag_meanings"].decode().split()
    assert meanings[results["status"][45, 46]] == "converged"
    assert "robot: 3-frr" in results["provenance/study"][()].decode()
    assert results["provenance/command"][()].decode() == "sinew sweep study.yaml"
    print(f"{results['x'][0]:.3f} {results['x'][-1]:.3f} {column[45, 46]:.6f}")
)");
  const Outcome read = run_shell("/usr/bin/python3 read.py", here.path());
  EXPECT_EQ(read.exit, 0) << read.err;
  EXPECT_TRUE(read.out.starts_with("-0.030 0.030 0.")) << read.out;
}

TEST(SweepCommand, TellsProgramsWhatItDid) {
  const Scratch here;
  write_text(here.path() / "study.yaml",
             queries + "outputs:\n  l: inputs[0]\nfits: {l: {terms: [x, 2 x]}}\n");
  const Outcome run = run_command({"sweep", "study.yaml", "--json", "-o", "out.csv"}, here.path());
  ASSERT_EQ(run.exit, 0) << run.err;
  const auto told = nlohmann::json::parse(run.out);
  EXPECT_EQ(told["samples"], 91 * 93);
  EXPECT_EQ(told["statuses"]["converged"], 91 * 93);
  EXPECT_EQ(told["complete"], true);
  EXPECT_TRUE(told["fits"][0]["coefficients"][0].is_null());  // not determined
  EXPECT_GT(told["seconds"]["computing"], 0);
}

TEST(SweepCommand, BaselineIsTheSameWhateverTheMachineHas) {
  const Scratch here;
  write_text(here.path() / "study.yaml", rods);
  ASSERT_EQ(
      run_command({"sweep", "study.yaml", "-q", "--isa", "baseline", "-o", "one.csv"}, here.path()).exit, 0);
  const Outcome other = run_shell(std::string("env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2 ") + command_path +
                                      " sweep study.yaml -q --isa baseline -o other.csv",
                                  here.path());
  ASSERT_EQ(other.exit, 0) << other.err;
  EXPECT_EQ(read_text(here.path() / "one.csv"), read_text(here.path() / "other.csv"));
}

}  // namespace sweep_test
