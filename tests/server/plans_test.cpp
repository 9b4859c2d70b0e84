/// Plans over HTTP: what is told of them, before their check and after it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace plans_test {

#ifdef SINEW_WITH_PLAN

constexpr const char* scene_text = R"(sinew: 1
kind: scene
name: wall
robot: nottingham-tpcj
base: {position: [0, 0, -180 mm], quaternion: [1, 0, 0, 1]}
stage: {limit: 60 mm}
port: {position: [0, 0, 0], radius: 6 mm}
target: {tip: [0, 0, 50 mm]}
obstacles:
  - {name: left, box: [60 mm, 80 mm, 8 mm], position: [-38 mm, 0, 4 mm]}
  - {name: right, box: [60 mm, 80 mm, 8 mm], position: [38 mm, 0, 4 mm]}
)";

/// A plan that goes straight in; at one step it is bent into the wall, at the last it is too far in.
std::string plan_text() {
  std::string text = "step,stage[m]";
  for (int m = 0; m < 5; ++m)
    text += ",S" + std::to_string(m) + "_beta_1[rad],S" + std::to_string(m) + "_beta_2[rad]";
  text += '\n';
  for (int k = 0; k < 8; ++k)
    text += std::to_string(k) + ',' + std::to_string(0.01 * k) + (k == 5 ? ",0,0.08" : ",0,0") +
            ",0,0,0,0,0,0,0,0\n";
  return text;
}

class Plans : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder / name).string();
    std::ofstream(path) << text;
    return path;
  }
  Options options(const std::string& plan) const {
    Options made;
    made.scene = write("wall.yaml", scene_text);
    made.plans = {write("plan.csv", plan)};
    return made;
  }
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("sinew_plans_" + std::to_string(getpid()));
};

/// The plan once it is checked.
json checked(Desk& desk, const std::string& path) {
  for (int i = 0; i < 3000; ++i) {
    json plan = json::parse(desk.get(path));
    if (!plan["check"].is_null()) return plan;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST_F(Plans, AreToldWithTheirCheck) {
  Desk desk(options(plan_text()));
  const json list = json::parse(desk.get("/api/plans"));
  ASSERT_EQ(list["plans"].size(), 1U);
  EXPECT_EQ(list["plans"][0]["name"], "plan");
  EXPECT_EQ(list["plans"][0]["steps"], 8);
  const std::string path = "/api/plans/" + list["plans"][0]["plan"].get<std::string>();
  const json plan = checked(desk, path), &scene = plan["scene"], &check = plan["check"];
  EXPECT_EQ(scene["stage_limit"], 0.06);
  EXPECT_EQ(scene["solids"][1]["name"], "right");
  EXPECT_NEAR(scene["base"]["quaternion"][3], std::sqrt(0.5), 1e-12);
  ASSERT_EQ(plan["steps"].size(), 8U);
  EXPECT_EQ(plan["steps"][5]["configuration"][0], json({0.0, 0.08}));
  EXPECT_TRUE(plan["steps"][6]["limit"].is_null());
  EXPECT_EQ(plan["steps"][7]["limit"], "the stage is at 70.000 mm, its limits are 0 and 60.000 mm");
  EXPECT_EQ(check["verdict"], "touches");
  EXPECT_EQ(check["steps"].size(), 8U);
  EXPECT_EQ(check["steps"][5]["verdict"], "touches");
  EXPECT_LT(check["steps"][5]["clearance"], 0);
  EXPECT_NE(check["steps"][2]["verdict"], "touches");
  // The robot is one that queries may be put to.
  const std::string robot = plan["robot"]["robot"];
  const json shape = json::parse(
      desk.post("/api/query?robot=" + robot,
                json{{"query", "shape"}, {"configuration", plan["steps"][5]["configuration"]}}.dump()));
  EXPECT_EQ(shape["status"], "converged");
}

TEST_F(Plans, SolidsAreBinary) {
  Desk desk(options(plan_text()));
  const json list = json::parse(desk.get("/api/plans"));
  const std::string bytes = desk.get("/api/plans/" + list["plans"][0]["plan"].get<std::string>() + "/meshes");
  ASSERT_EQ(bytes.size(), 2U * (8U * 12U + 12U * 12U));  // two boxes
  float x = 0;
  std::memcpy(&x, bytes.data(), sizeof x);
  EXPECT_NEAR(std::abs(x + 0.038F), 0.03F, 1e-6F);
  std::uint32_t most = 0, corner = 0;
  for (std::size_t at = 16U * 12U; at < bytes.size(); at += sizeof corner) {
    std::memcpy(&corner, bytes.data() + at, sizeof corner);
    most = std::max(most, corner);
  }
  EXPECT_EQ(most, 15U);
}

TEST_F(Plans, HandlesAreOfTheContent) {
  const auto handle = [](Desk& desk) { return json::parse(desk.get("/api/plans"))["plans"][0]["plan"]; };
  Desk first(options(plan_text()));
  const json one = handle(first);
  Desk again(options(plan_text()));
  EXPECT_EQ(handle(again), one);
  std::string other = plan_text();
  other.replace(other.find("0.08"), 4, "0.07");
  Desk another(options(other));
  EXPECT_NE(handle(another), one);
  for (const char* path : {"/api/plans/0", "/api/plans/0/meshes", "/api/plans/..%2f..%2fetc%2fpasswd"})
    EXPECT_NE(another.get(path).find("error"), std::string::npos) << path;
  EXPECT_EQ(another.status, 404);
  another.get("/api/plans/" + handle(another).get<std::string>(), {{"Origin", "http://evil.example"}});
  EXPECT_EQ(another.status, 403);
}

TEST_F(Plans, OfAnotherRobotAreRefused) {
  std::string other = plan_text();
  other.replace(other.find("S4_beta_2"), 9, "S4_phi");
  const auto server = Server::open(options(other));
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error()[0].code, "missing_column");
  Options none = options(plan_text());
  none.scene += "x";
  EXPECT_FALSE(Server::open(none));
}

/// A server that ends while it checks does not wait for the check.
TEST_F(Plans, ACheckEndsWithItsServer) {
  std::string many = plan_text();
  const std::string rows = many.substr(many.find('\n') + 1);
  for (int i = 0; i < 5000; ++i) many += rows;  // to check them all takes some ten seconds
  auto desk = std::make_unique<Desk>(options(many));
  const auto begin = std::chrono::steady_clock::now();
  desk.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

#endif

TEST(NoPlans, WithoutAnyThereAreNone) {
  Desk desk;
  const json list = json::parse(desk.get("/api/plans"));
  EXPECT_TRUE(list["plans"].empty());
  EXPECT_TRUE(list["is_built"].is_boolean());
  desk.get("/api/plans/0");
  EXPECT_EQ(desk.status, 404);
}

#ifndef SINEW_WITH_PLAN
TEST(NoPlans, NeedPlanning) {
  Options options;
  options.plans = {"plan.csv"};
  const auto server = Server::open(options);
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error()[0].code, "not_built");
}
#endif

}  // namespace plans_test
}  // namespace sinew::server
