/// A session keeps the robot that a query has changed by `set` or `theta_is`, for the next one that changes
/// it alike: what is answered must not depend on what was asked before.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sinew/session.hpp"

namespace sinew::test {
namespace set_again_test {

std::string fresh(const std::string& robot, const std::string& query) {
  return Session::open(robot).value().answer(query);
}

void expect_no_memory(const std::string& robot, const std::vector<std::string>& queries) {
  Session session = Session::open(robot).value();
  for (const std::size_t i : {0u, 0u, 1u, 0u, 2u, 2u, 1u, 3u, 3u, 2u, 0u, 3u, 1u, 1u})
    if (i < queries.size()) {
      EXPECT_EQ(session.answer(queries[i]), fresh(robot, queries[i])) << queries[i];
    }
}

TEST(SetAgain, ChangesNoAnswer) {
  const auto forward = [](const std::string& inputs, const std::string& more) {
    return R"({"query": "forward", "inputs": )" + inputs + more + "}";
  };
  const std::string rods = "[0.40, 0.41, 0.39]", set = R"(, "set": {"defaults.link.diameter": )";
  expect_no_memory("3pfs-g2", {forward(rods, set + "0.004}"), forward(rods, set + "0.003}"),
                               forward(rods, ""), forward(rods, set + "-1}")});
  expect_no_memory("3pfs-g2",
                   {forward(rods, set + "0.004}, \"wrench\": [0, 0, -5, 0, 0, 0]"),
                    forward("[0.42, 0.41, 0.39]", set + "0.004}"), forward(rods, set + "\"4 mm\"}"),
                    forward(rods, set + "0.004, \"platform.radius\": 0.05}")});
}

TEST(SetAgain, HeedsWhatThetaIs) {
  const auto velocity = [](const std::string& more) {
    return R"({"query": "forward", "inputs": [0.1, 0.12, 0.11], "want": ["velocity"])" + more + "}";
  };
  expect_no_memory("3-rfrr", {velocity(R"(, "theta_is": "chord")"), velocity(R"(, "theta_is": "tangent")"),
                              velocity(""), velocity(R"(, "theta_is": "neither")")});
  expect_no_memory("3-rfr", {velocity(R"(, "theta_is": "chord")"), velocity(""), velocity(R"(, "set": null)"),
                             velocity(R"(, "set": 3)")});
}

}  // namespace set_again_test
}  // namespace sinew::test
