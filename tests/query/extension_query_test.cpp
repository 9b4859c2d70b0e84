/// Sections of variable length through `sinew query`: the template of serial robots has one.
#include <gtest/gtest.h>

#include "paths.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace extension_query_test {

const std::string robot = std::string(source_folder) + "/examples/robots/serial.yaml";

TEST(ExtensionQuery, GoesFromConfigurationToChangesAndBack) {
  const Json shape = {{0.1, -0.2}, {0.8, 0.5, 0.004}};
  for (const char* model : {"pcc", "lsk"}) {
    const Json there = ask(robot, {{{"query", "forward"}, {"configuration", shape}, {"model", model}}})[0];
    ASSERT_EQ(there["status"], "converged") << there;
    EXPECT_EQ(there["configuration"][0].size(), 2U);
    EXPECT_EQ(there["configuration"][1].size(), 3U);
    const Json back =
        ask(robot, {{{"query", "forward"}, {"changes", there["changes"]}, {"model", model}}})[0];
    ASSERT_EQ(back["status"], "converged") << back;
    for (std::size_t m = 0; m < 2; ++m)
      for (std::size_t j = 0; j < shape[m].size(); ++j)
        EXPECT_NEAR(back["configuration"][m][j].get<double>(), shape[m][j].get<double>(), 1e-12);
    for (const Json& section : back["slack"])
      for (const Json& slack : section) EXPECT_NEAR(slack.get<double>(), 0, 1e-15);
  }
}

TEST(ExtensionQuery, LeftOutItIsTheLengthAtRest) {  // whatever was asked before in the same session
  const auto answers = ask(robot, {{{"query", "forward"}, {"configuration", {{0, 0}, {0, 0, "4 mm"}}}},
                                   {{"query", "forward"}, {"configuration", {{0, 0}, {0, 0}}}},
                                   {{"query", "forward"}, {"configuration", {{0, 0}, {0, 0, 0.02}}}},
                                   {{"query", "inverse"}, {"position", {0, 0, 0.0865}}}});
  EXPECT_NEAR(answers[0]["tip"]["position"][2].get<double>(), 0.079, 1e-15);
  EXPECT_NEAR(answers[1]["tip"]["position"][2].get<double>(), 0.075, 1e-15);
  EXPECT_EQ(answers[2]["status"], "left_domain");
  EXPECT_EQ(answers[3]["status"], "unreachable");  // 75 mm and the 10 it can grow by
}

TEST(ExtensionQuery, ColumnsOfItsRateAreDifferences) {
  const double step = 1e-3;
  const auto shape = [&](double extension) { return Json{{0.1, -0.2}, {0.8, 0.5, extension}}; };
  const auto answers = ask(robot, {{{"query", "velocity"}, {"configuration", shape(0.003)}},
                                   {{"query", "forward"}, {"configuration", shape(0.003 + step)}},
                                   {{"query", "forward"}, {"configuration", shape(0.003 - step)}}});
  const Json& velocity = answers[0];
  ASSERT_EQ(velocity["J"][0].size(), 5U);
  for (std::size_t i = 0; i < 3; ++i) {
    const double slope =
        (answers[1]["tip"]["position"][i].get<double>() - answers[2]["tip"]["position"][i].get<double>()) /
        (2 * step);
    EXPECT_NEAR(velocity["J"][i][4].get<double>(), slope, 1e-12);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const double slope = (answers[1]["changes"][i / 3][i % 3].get<double>() -
                          answers[2]["changes"][i / 3][i % 3].get<double>()) /
                         (2 * step);
    EXPECT_NEAR(velocity["K"][i][4].get<double>(), slope, 1e-12);
  }
}

TEST(ExtensionQuery, TwelveSectionsHaveIndices) {
  const Json set = {{"sections.count", 12}, {"sections.extension", {"-1 mm", "5 mm"}}};
  const Json answer = ask("nottingham-neutral", {{{"query", "velocity"},
                                                  {"set", set},
                                                  {"configuration", {{0.3, 0.2, 0.001}, {0.1, 1}}},
                                                  {"twist", {0, 0.001, 0, 0, 0, 0.1}}}})[0];
  ASSERT_EQ(answer["status"], "converged") << answer;
  EXPECT_EQ(answer["J"][0].size(), 36U);
  EXPECT_GE(answer["indices"]["condition"].get<double>(), 1);
}

TEST(ExtensionQuery, ADiagramTakesItForLengthWithinItsLimits) {
  const auto answers =
      ask(robot, {{{"query", "diagram"}, {"section", 1}, {"changes", {0.004, 0.005, 0.006}}},
                  {{"query", "diagram"}, {"section", 1}, {"changes", {0.014, 0.015, 0.016}}},
                  {{"query", "diagram"}, {"section", 1}, {"changes", {-0.004, -0.005, -0.006}}}});
  EXPECT_EQ(answers[0]["class"], "exact");
  EXPECT_EQ(answers[1]["class"], "indeterminate");
  EXPECT_NEAR(answers[1]["slack"][0].get<double>(), 0.005, 1e-15);  // 15 mm of which 10 are length
  EXPECT_EQ(answers[2]["class"], "inconsistent");
  EXPECT_NEAR(answers[2]["over_tension"].get<double>(), 0.003, 1e-15);
}

TEST(ExtensionQuery, OutlinesAreOfWhatIsNotLength) {
  const Json set = {{"sections[0].extension", {"-5 mm", "20 mm"}}};
  const auto outline = [&](double longer) {
    Json changes = {{0, 0, 0}, {0, 0, 0, 0.002}, {0, 0, 0}};
    for (Json& section : changes)
      for (Json& change : section) change = change.get<double>() + longer;
    return ask("four-tendon-neutral",
               {{{"query", "diagram"},
                 {"set", {{"sections[0].tendons.count", 3}, {"sections[0].extension", {"-5 mm", "20 mm"}}}},
                 {"section", 1},
                 {"changes", {changes[0], changes[1]}}}})[0];
  };
  const Json rest = outline(0), longer = outline(0.01);
  EXPECT_EQ(rest["class"], longer["class"]);
  EXPECT_NEAR(rest["area"].get<double>(), longer["area"].get<double>(), 1e-12);
}

TEST(ExtensionQuery, AllArcsAreOfFixedLength) {
  const Json set = {{"sections[0].extension", {"-1 mm", "1 mm"}}};
  const Json pose = {{"position", {0, 0, 2.9}}, {"quaternion", {1, 0, 0, 0}}};
  const Json answer =
      ask("three-arcs", {{{"query", "inverse"}, {"set", set}, {"pose", pose}, {"all", true}}})[0];
  EXPECT_EQ(answer["status"], "unsupported") << answer;
}

}  // namespace extension_query_test
}  // namespace sinew::test
