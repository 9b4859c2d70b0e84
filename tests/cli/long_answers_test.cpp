// Our own answers are never refused by our own reader, however long they are.
#include <gtest/gtest.h>

#include <algorithm>

#include "command.hpp"
#include "thorough.hpp"

namespace long_answers_test {

using namespace sinew::test;

TEST(LongAnswers, APathOfManyPosesGoesIntoAFileAndIsReadAgain) {
  const Scratch here;
  const std::size_t poses = count_of<std::size_t>(20000, 100000);
  const Outcome outcome = run_command({"track", "3-rfr", "--from", "0, 0, 0", "--to", "10 mm, 5 mm, 20 deg",
                                       "--samples", std::to_string(poses), "-o", "path.csv"},
                                      here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const std::string path = read_text(here.path() / "path.csv");
  EXPECT_EQ(lines_of(path).size(), poses + 2);  // comment, heading
  const Outcome again =
      run_command({"track", "3-rfr", "--poses", "path.csv", "-o", "again.csv"}, here.path());
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(read_text(here.path() / "again.csv"), path);
}

TEST(LongAnswers, AFileOfAPathHasANumberForEachHeading) {
  const Scratch here;
  const std::pair<const char*, const char*> cases[] = {{"3-rfr", "0, 0, 0.1"},
                                                       {"3-frr", "0, 0, 0.1"},
                                                       {"3-rfrr", "0, 0, 0.1"},
                                                       {"3prs", "0, 0, 540 mm, 0, 0, 0"},
                                                       {"6-ufs", "0, 0, 190 mm, 0, 0, 0"}};
  for (const auto& [robot, pose] : cases) {
    const Outcome outcome = run_command(
        {"track", robot, "--from", pose, "--to", pose, "--samples", "2", "-o", "path.csv"}, here.path());
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    const auto lines = lines_of(read_text(here.path() / "path.csv"));
    ASSERT_EQ(lines.size(), 4U) << robot;
    EXPECT_EQ(std::ranges::count(lines[1], ','), std::ranges::count(lines[2], ',')) << lines[1] << lines[2];
    EXPECT_LT(std::stod(lines[2].substr(lines[2].rfind(',') + 1)), 1e-12) << lines[2];  // the closure error
  }
}

TEST(LongAnswers, AreTheSameAsAStreamPrintsThem) {
  const Scratch here;
  write_text(
      here.path() / "lines",
      R"({"query": "track", "from": {"position": [0, 0, 0.18]}, "to": {"position": [0.01, 0, 0.18]}, "samples": 20000})"
      "\n");
  const Outcome stream = run_command({"query", "6-ufs"}, here.path(), here.path() / "lines"),
                verb = run_command({"track", "6-ufs", "--from", "0, 0, 180 mm, 0, 0, 0", "--to",
                                    "10 mm, 0, 180 mm, 0, 0, 0", "--samples", "20000", "--json"},
                                   here.path());
  EXPECT_EQ(verb.exit, 0) << verb.err;
  EXPECT_GT(verb.out.size(), std::size_t{4} << 20U);  // more than a document of a stranger may have
  EXPECT_TRUE(verb.out == stream.out);
}

}  // namespace long_answers_test
