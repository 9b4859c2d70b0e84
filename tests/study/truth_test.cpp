/// `sinew reproduce truth`: every number beside that of others, within its tolerance.
#include <gtest/gtest.h>

#include <string_view>

#include "sanitizers.hpp"
#include "study/reproduce.hpp"
#include "study_folder.hpp"

namespace sinew::test {
namespace truth_test {

class Truth : public testing::TestWithParam<const char*> {};

TEST_P(Truth, AgreesWithinItsTolerances) {
  if (is_instrumented && std::string_view(GetParam()) == "truth/arms")
    GTEST_SKIP() << "a dozen fits; analysis.identify looks at some";
  const Folder folder;
  FigureOptions scripts_only;
  scripts_only.formats.clear();
  const auto made = reproduce(GetParam(), folder.path, scripts_only);
  ASSERT_TRUE(made) << to_string(made.error());
  EXPECT_GE(made->findings.size(), 6u);
  for (const Finding& finding : made->findings)
    EXPECT_TRUE(finding.verdict == "agrees" || finding.verdict == "holds" ||
                finding.verdict == "for information")
        << finding.quantity << ": " << finding.ours << ", " << finding.difference;
}

INSTANTIATE_TEST_SUITE_P(Study, Truth,
                         testing::Values("truth/tables", "truth/rods", "truth/arms", "truth/models"),
                         [](const auto& item) { return std::string(item.param).substr(6); });

}  // namespace truth_test
}  // namespace sinew::test
