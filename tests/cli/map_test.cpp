// Maps as long as one likes: rows leave as they are computed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "command.hpp"
#include "paths.hpp"
#include "sanitizers.hpp"

namespace map_test {

using namespace sinew::test;

/// The most memory that a map of `side` by `side` poses takes [KiB].
long peak_of_map(int side, const std::string& output) {
  const std::string x = fmt::format("-30 mm : 30 mm : {}", side);
  std::vector<std::string> words{command_path, "map", "3-rfr", "--x", x, "--y", x, "-q"};
  if (!output.empty()) words.insert(words.end(), {"-o", output});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    dup2(open("/dev/null", O_WRONLY), 1);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  rusage used = {};
  wait4(child, &status, 0, &used);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  return used.ru_maxrss;
}

TEST(Map, TakesNoMoreMemoryForManyPosesThanForFew) {
  if (addresses_are_checked) GTEST_SKIP() << "the sanitizer keeps what was freed";
  const Scratch here;
  for (const std::string& output : {std::string(), (here.path() / "map.csv").string()}) {
    const long few = peak_of_map(100, output), many = peak_of_map(600, output);
    EXPECT_LT(many, few + 1024) << "350 000 rows more, in KiB";  // a row kept would be 340 bytes: 116 000
  }
}

TEST(Map, OfAnyLengthHasTheSameRowsOnStdoutAndInAFile) {
  const Scratch here;
  const std::vector<std::string> asked{"map", "3-rfr",
                                       "--x", "-30 mm : 30 mm : 37",
                                       "--y", "-30 mm : 30 mm : 23"};  // three blocks of rows and a part
  const Outcome out = run_command(asked, here.path());
  std::vector<std::string> into = asked;
  into.insert(into.end(), {"-o", "map.csv"});
  ASSERT_EQ(run_command(into, here.path()).exit, 0);
  EXPECT_EQ(out.out, read_text(here.path() / "map.csv"));
  EXPECT_EQ(lines_of(out.out).size(), 2U + 37U * 23U);
}

TEST(Map, AReaderThatLeavesEndsIt) {
  const Scratch here;
  const Outcome outcome =
      run_shell("sinew map 3-rfr --x '-30 mm : 30 mm : 3000' --y '0 : 1 mm : 3000' | head -3", here.path());
  EXPECT_EQ(lines_of(outcome.out).size(), 3U);
  EXPECT_EQ(outcome.err, "");
}

}  // namespace map_test
