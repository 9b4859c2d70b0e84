// What the command loads before it does anything, and what it becomes where a verb needs more.
#include <gtest/gtest.h>

#include <algorithm>

#include "command.hpp"
#include "paths.hpp"

namespace start_test {

namespace fs = std::filesystem;
using namespace sinew::test;

/// As ldd has them.
std::string libraries_of(const fs::path& program) {
  const Scratch here;
  return run_program({"/usr/bin/env", "LD_TRACE_LOADED_OBJECTS=1", program.string()}, here.path()).out;
}

/// The program of studies and of the server; none where there is but one.
fs::path whole_program() {
  const fs::path folder = fs::path(command_path).parent_path().parent_path();
  return folder / "libexec" / "sinew" / "sinew";
}

TEST(Start, LoadsNoLibraryThatMostVerbsNeverCall) {
  if (!fs::exists(whole_program())) GTEST_SKIP() << "one program";
  const std::string few = libraries_of(command_path), all = libraries_of(whole_program());
  for (const char* name : {"libhdf5", "libcurl", "libkrb5", "libcpp-httplib", "libtbb", "libmpi"})
    EXPECT_EQ(few.find(name), std::string::npos) << few;
  EXPECT_NE(all.find("libhdf5"), std::string::npos) << all;
  EXPECT_LE(lines_of(few).size() + 20, lines_of(all).size());
}

TEST(Start, AVerbOfTheOtherProgramIsFoundThroughALink) {
  const Scratch here;
  fs::create_symlink(command_path, here.path() / "arms");
  const Outcome outcome = run_program({(here.path() / "arms").string(), "sweep", "--list"}, here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("3-rfr-workspace"), std::string::npos);
}

TEST(Start, WithoutTheOtherProgramItSaysWhatIsMissing) {
  if (!fs::exists(whole_program())) GTEST_SKIP() << "one program";
  const Scratch here;
  fs::create_directory(here.path() / "bin");
  const fs::path alone = here.path() / "bin" / "sinew";
  fs::copy_file(command_path, alone);
  EXPECT_EQ(run_program({alone.string(), "check", "3-rfr"}, here.path()).exit, 0);
  const Outcome outcome = run_program({alone.string(), "sweep", "--list"}, here.path());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_NE(outcome.err.find((here.path() / "libexec/sinew/sinew").string()), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("cannot be started: No such file or directory"), std::string::npos)
      << outcome.err;
}

}  // namespace start_test
