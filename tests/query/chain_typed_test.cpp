/// Typed questions to a robot by the model prb answer what a session does.
#include <gtest/gtest.h>

#include "sinew/batch.hpp"
#include "sinew/robot.hpp"
#include "sinew/solve.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace chain_typed_test {

struct Case {
  const char* name;
  Json pose;                 ///< whose inputs are asked about
  Json branch;               ///< of these inputs
  std::vector<double> load;  ///< as a session takes it
};
const Case cases[] = {
    {"3-rfr", {{"x", 0.01}, {"y", 0}, {"phi", 0.1}}, Json::object(), {0.02, -0.01, 3e-4}},
    {"3-rfrr", {{"x", 0.01}, {"y", 0}, {"phi", 0.1}}, {{"curvature", {3, 4, 5}}}, {0.02, -0.01, 3e-4}},
    {"6-ufs",
     {{"position", {0.01, 0, 0.18}}, {"quaternion", {1, 0, 0, 0}}},
     Json::object(),
     {0.02, -0.01, -0.05, 1e-4, 0, 2e-4}}};

std::vector<double> inputs_of(const Case& one) {
  Json question{{"query", "inverse"}, {"model", "prb"}, {"pose", one.pose}};
  question.update(one.branch);
  return ask(one.name, {question})[0]["inputs"].get<std::vector<double>>();
}

SpatialPose pose_of(const Case& one) {
  SpatialPose pose;
  if (one.load.size() == 3) {
    const double half = one.pose["phi"].get<double>() / 2;
    pose.position = {one.pose["x"].get<double>(), one.pose["y"].get<double>(), 0};
    pose.quaternion = {std::cos(half), 0, 0, std::sin(half)};
  } else {
    for (std::size_t k = 0; k < 3; ++k)
      pose.position[static_cast<Eigen::Index>(k)] = one.pose["position"][k].get<double>();
  }
  return pose;
}

Json forward_of(const Case& one, const std::vector<double>& inputs) {
  return {
      {"query", "forward"}, {"model", "prb"}, {"inputs", inputs}, {"wrench", one.load}, {"start", one.pose}};
}

SpatialWrench in_space(const std::vector<double>& load) {
  SpatialWrench wrench = SpatialWrench::Zero();
  for (std::size_t k = 0; k < load.size(); ++k)
    wrench[load.size() == 3 && k == 2 ? 5 : static_cast<Eigen::Index>(k)] = load[k];
  return wrench;
}

/// Position, and quaternion or angle, of both answers.
double apart(const Json& session, const SpatialPose& pose) {
  const auto& q = pose.quaternion;
  double most = 0;
  const auto look = [&](const Json& number, double ours) {
    most = std::max(most, std::abs(number.get<double>() - ours));
  };
  if (session.contains("phi")) {
    look(session["x"], pose.position[0]);
    look(session["y"], pose.position[1]);
    look(session["phi"], 2 * std::atan2(q[3], q[0]));
    return most + std::abs(pose.position[2]) + std::abs(q[1]) + std::abs(q[2]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    look(session["position"][k], pose.position[static_cast<Eigen::Index>(k)]);
  for (std::size_t k = 0; k < 4; ++k) look(session["quaternion"][k], q[k]);
  return most;
}

struct Chains {
  Robot robot;
  Workspace work;
  explicit Chains(const char* name) : robot(load(name)->as(Model::prb).value()), work(robot) {}
};

TEST(ChainTyped, EquilibriaAreThoseOfASession) {
  for (const Case& one : cases) {
    const std::vector<double> inputs = inputs_of(one);
    const Json question = forward_of(one, inputs);
    Json until = question;
    until["until"] = {{"wrench", one.load}, {"limit", 2}};
    const auto session = ask(one.name, {question, until});
    Chains chains(one.name);
    const EquilibriumOptions options{.wrench = in_space(one.load), .start = pose_of(one)};
    const Equilibrium found = equilibrium(chains.robot, inputs, options, chains.work);
    EXPECT_EQ(session[0]["status"], std::string(to_string(found.report.status)))
        << one.name << to_string(found.report) << session[0];
    EXPECT_LT(apart(session[0]["pose"], found.pose), 1e-14) << one.name;
    EXPECT_TRUE(std::ranges::equal(found.inputs, inputs));
    const Equilibrium again = held_equilibrium(chains.robot, chains.work);
    EXPECT_EQ(again.report.status, found.report.status);
    EXPECT_EQ(again.pose.position, found.pose.position);

    const LoadPath path = follow_load(chains.robot, in_space(one.load), 2, chains.work);
    EXPECT_EQ(session[1]["why"], std::string(to_string(path.end))) << session[1];
    EXPECT_NEAR(session[1]["load"].get<double>(), path.load, 1e-12);
    EXPECT_LT(apart(session[1]["pose"], path.pose), 1e-13);

    const Equilibrium warm =
        equilibrium(chains.robot, inputs,
                    {.wrench = options.wrench, .start = options.start, .warm_start = true}, chains.work);
    EXPECT_LT(apart(session[0]["pose"], warm.pose), 1e-9) << one.name;
  }
}

TEST(ChainTyped, InputsHoldThePoseThatASessionHolds) {
  for (const Case& one : {cases[0], cases[2]}) {
    Chains chains(one.name);
    const EquilibriumOptions options{.wrench = in_space(one.load), .start = pose_of(one)};
    const Json session = ask(
        one.name, {{{"query", "inverse"}, {"model", "prb"}, {"pose", one.pose}, {"wrench", one.load}}})[0];
    const Equilibrium held = inverse_equilibrium(chains.robot, pose_of(one), options, chains.work);
    EXPECT_EQ(session["status"], std::string(to_string(held.report.status))) << session;
    const std::vector<double> inputs(held.inputs.begin(), held.inputs.end());
    ASSERT_EQ(session["inputs"].size(), inputs.size());
    for (std::size_t k = 0; k < inputs.size(); ++k)
      EXPECT_NEAR(session["inputs"][k].get<double>(), inputs[k], 1e-12) << one.name;
    // and they lead back there
    const Equilibrium back = equilibrium(chains.robot, inputs, options, chains.work);
    EXPECT_LT((back.pose.position - pose_of(one).position).norm(), 1e-9) << to_string(back.report);
  }
}

TEST(ChainTyped, TensionsTellTheLoadAsInASession) {
  for (const Case& one : {cases[0], cases[2]}) {
    Chains chains(one.name);
    const std::size_t count = one.load.size();
    const std::vector<double> inputs = inputs_of(one), deviations(count, 0.01);
    const Json loaded = ask(one.name, {forward_of(one, inputs)})[0];
    std::vector<double> tensions;
    for (std::size_t k = 0; k < count; ++k) {
      const Json& leg = loaded["legs"][k];
      const bool is_first = leg["tendon_lengths"][0].get<double>() <= leg["tendon_lengths"][1].get<double>();
      tensions.push_back(leg["tensions"][is_first ? 0 : 1].get<double>());
    }
    const Json session = ask(one.name, {{{"query", "statics"},
                                         {"model", "prb"},
                                         {"inputs", inputs},
                                         {"start", one.pose},
                                         {"measured_tensions", tensions},
                                         {"deviation", 0.01}}})[0];
    const SensedWrench sensed =
        sense_wrench(chains.robot, inputs, tensions, deviations, {.start = pose_of(one)}, chains.work);
    EXPECT_EQ(session["status"], std::string(to_string(sensed.report.status))) << session;
    EXPECT_LT((sensed.wrench - in_space(one.load)).norm(), 1e-8) << to_string(sensed.report);
    const auto axis = [&](std::size_t k) { return count == 3 && k == 2 ? std::size_t{5} : k; };
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t c = 0; c < count; ++c) {
        EXPECT_NEAR(sensed.sensitivity[6 * axis(r) + c], session["wrench_sensitivity"][r][c].get<double>(),
                    1e-12);
        EXPECT_NEAR(sensed.covariance[6 * axis(r) + axis(c)], session["covariance"][r][c].get<double>(),
                    1e-15);
      }
  }
}

TEST(ChainTyped, AllEquilibriaAndManyRowsAreThoseOfASession) {
  const Case& one = cases[0];
  const std::vector<double> inputs = inputs_of(one);
  Chains chains(one.name);
  const EquilibriumOptions options{.wrench = in_space(one.load)};
  const Json session = ask(
      one.name,
      {{{"query", "forward"}, {"model", "prb"}, {"inputs", inputs}, {"wrench", one.load}, {"all", true}}})[0];
  const auto all = equilibria(chains.robot, inputs, options, chains.work);
  ASSERT_EQ(all.size(), session["solutions"].size()) << session;
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_LT(apart(session["solutions"][k]["pose"], all[k].pose), 1e-12);
    EXPECT_EQ(session["solutions"][k]["unstable_directions"], all[k].unstable_directions);
  }
  std::vector<double> rows = inputs;
  rows.insert(rows.end(), inputs.begin(), inputs.end());
  rows.back() = std::nan("");
  std::vector<SpatialPose> poses(2);
  std::vector<Status> statuses(2);
  std::vector<double> residuals(2);
  equilibrium_batch(chains.robot, rows, options.wrench, poses, statuses, chains.work, true, residuals,
                    RowStart::home);
  const Equilibrium first = equilibrium(chains.robot, inputs, options, chains.work);
  EXPECT_EQ(statuses[0], first.report.status);
  EXPECT_EQ(poses[0].position, first.pose.position);
  EXPECT_NE(statuses[1], Status::converged);
  EXPECT_TRUE(std::isnan(residuals[1]));
}

TEST(ChainTyped, WhatIsWrongIsSaid) {
  Chains plane("3-rfr");
  const std::vector<double> good = inputs_of(cases[0]), few{0.19, 0.19}, none{0.19, std::nan(""), 0.19};
  const auto status = [&](Numbers inputs, const EquilibriumOptions& options) {
    const Equilibrium found = equilibrium(plane.robot, inputs, options, plane.work);
    EXPECT_FALSE(found.report.message.empty());
    return found.report.status;
  };
  EXPECT_EQ(status(few, {}), Status::bad_input);
  EXPECT_FALSE(equilibrium(plane.robot, none, {}, plane.work).is_solved());
  SpatialWrench lifted = SpatialWrench::Zero(), endless = lifted;
  lifted[2] = 1;
  endless[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(status(good, {.wrench = lifted}), Status::bad_input);
  EXPECT_EQ(status(good, {.wrench = endless}), Status::bad_input);
  EXPECT_EQ(status(good, {.gravity = Vec3<double>(0, 0, -9.81)}), Status::unsupported);
  SpatialPose tilted;
  tilted.quaternion = {0.8, 0.6, 0, 0};
  EXPECT_EQ(status(good, {.start = tilted}), Status::bad_input);
  EXPECT_EQ(inverse_equilibrium(plane.robot, tilted, {}, plane.work).report.status, Status::bad_input);
  EXPECT_EQ(inverse_equilibrium(plane.robot, IndependentPose{}, {}, plane.work).report.status,
            Status::unsupported);
  EXPECT_FALSE(held_equilibrium(plane.robot, plane.work).is_solved());
  EXPECT_EQ(follow_load(plane.robot, in_space(cases[0].load), 1, plane.work).end, LoadEnd::stalled);
  Chains other("6-ufs");
  EXPECT_EQ(equilibrium(plane.robot, good, {}, other.work).report.status, Status::bad_input);
  EXPECT_EQ(sense_wrench(plane.robot, good, few, few, {}, plane.work).report.status, Status::bad_input);
  Chains motors("3-rfrr");  // three legs: their tensions tell
  EXPECT_NE(sense_wrench(motors.robot, good, good, good, {}, motors.work).report.status, Status::converged);
  plane.work.stop = StopToken();
  ASSERT_TRUE(equilibrium(plane.robot, good, {}, plane.work).is_solved());  // and nothing of all this stays
}

}  // namespace chain_typed_test
}  // namespace sinew::test
