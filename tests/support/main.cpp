/// Runs the tests of a program, or those of one of its source files: SINEW_TEST_FILE=rod_stop_test runs those
/// of rod_stop_test.cpp. GTEST_FILTER selects among them. What the tests of a file share (a sweep, a figure,
/// a long reference) is then computed once: shards of gtest would spread them over processes that each
/// compute it.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

/// The names of the tests in that file, or of all others, as a filter takes them.
std::string names(const std::string& stem, bool in_that_file) {
  std::string all;
  const testing::UnitTest& unit = *testing::UnitTest::GetInstance();
  for (int s = 0; s < unit.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *unit.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if ((std::filesystem::path(test.file()).stem() == stem) != in_that_file) continue;
      if (!all.empty()) all += ':';
      all += std::string(suite.name()) + '.' + test.name();
    }
  }
  return all;
}

/// Whether there are tests in that file.
bool select(const std::string& stem) {
  const std::string those = names(stem, true), others = names(stem, false);
  std::string filter = GTEST_FLAG_GET(filter);
  if (filter == "*" || filter.empty())
    filter = those;
  else if (!others.empty())
    filter += (filter.find('-') == std::string::npos ? "-" : ":") + others;
  GTEST_FLAG_SET(filter, filter);
  return !those.empty();
}

}  // namespace

int main(int count, char** words) {
  testing::InitGoogleTest(&count, words);
  if (const char* stem = std::getenv("SINEW_TEST_FILE"); stem && !select(stem)) {
    std::fprintf(stderr, "No test of this program is in %s.cpp\n", stem);
    return 1;
  }
  return RUN_ALL_TESTS();
}
