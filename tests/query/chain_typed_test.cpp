/// Typed questions to a robot by the model prb answer what a session does.
#include <gtest/gtest.h>

#include "sinew/analysis/singularity.hpp"
#include "sinew/batch.hpp"
#include "sinew/kinematics/inverse.hpp"
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
    {"3-frr", {{"x", 0.01}, {"y", 0}, {"phi", 0.1}}, Json::object(), {0.02, -0.01, 3e-4}},
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
  for (const Case& one : {cases[0], cases[1], cases[3]}) {
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
  for (const Case& one : {cases[0], cases[1], cases[3]}) {
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

/// Numbers of a session in a robot's own axes, ours in space.
std::size_t axis(const Case& one, std::size_t k) { return one.load.size() == 3 && k == 2 ? 5 : k; }

void expect_rows(const Case& one, const Json& session, std::span<const double> rows, bool is_square) {
  const std::size_t columns = rows.size() / 6;
  double most = 0, largest = 0, elsewhere = 0;
  ASSERT_EQ(session.size(), one.load.size());
  for (std::size_t r = 0; r < session.size(); ++r) {
    ASSERT_EQ(session[r].size(), is_square ? one.load.size() : columns) << one.name;
    for (std::size_t c = 0; c < session[r].size(); ++c) {
      const double theirs = session[r][c].get<double>(),
                   ours = rows[axis(one, r) * columns + (is_square ? axis(one, c) : c)];
      most = std::max(most, std::abs(ours - theirs));
      largest = std::max(largest, std::abs(theirs));
      elsewhere -= std::abs(ours);
    }
  }
  for (const double x : rows) elsewhere += std::abs(x);
  EXPECT_LT(most, 1e-12 * largest) << one.name << session;
  EXPECT_LT(std::abs(elsewhere), 1e-9 * largest) << "in the plane the other rows are 0";
}

TEST(ChainTyped, EveryShippedRobotWithChainsIsAskedHere) {
  for (const std::string_view name : builtin_robot_names()) {
    const auto loaded = load(std::string(name));
    ASSERT_TRUE(loaded);
    if (leg_count(*loaded) > 0 && loaded->as(Model::prb)) {
      EXPECT_TRUE(std::ranges::any_of(cases, [&](const Case& one) { return one.name == name; })) << name;
    }
  }
}

/// What is known of an equilibrium, beside what a session says of the same question.
TEST(ChainTyped, AnAnalysisIsThatOfASession) {
  for (const Case& one : cases) {
    Chains chains(one.name);
    const std::vector<double> inputs = inputs_of(one);
    Json question = forward_of(one, inputs);
    question["want"] = {"pose", "legs", "stiffness", "stability", "margins", "sensitivity"};
    const Json session = ask(one.name, {question})[0];
    const EquilibriumOptions options{.wrench = in_space(one.load), .start = pose_of(one)};
    ASSERT_TRUE(equilibrium(chains.robot, inputs, options, chains.work).is_solved());
    const RodAnalysis known = analyse_equilibrium(chains.robot, chains.work);
    expect_rows(one, session["stiffness"], known.stiffness, true);
    expect_rows(one, session["sensitivity"], known.sensitivity, false);
    EXPECT_EQ(session["unstable_directions"], known.unstable_directions);
    EXPECT_EQ(session["unstable"].size(), known.unstable.size());
    const double eigenvalue = session["smallest_eigenvalue"].get<double>();
    EXPECT_NEAR(known.smallest_eigenvalue, eigenvalue, 1e-12 * std::abs(eigenvalue));
    EXPECT_NEAR(known.smallest_pivot, session["margins"]["fold"].get<double>(), 1e-12);
    EXPECT_NEAR(known.largest_strain, session["margins"]["strain"].get<double>(), 1e-15);
    if (session.contains("potential"))
      EXPECT_NEAR(known.potential, session["potential"].get<double>(), 1e-14);
    else
      EXPECT_TRUE(std::isnan(known.potential));
    EXPECT_GT(known.energy, 0);
    EXPECT_TRUE(known.rods.empty());
    ASSERT_EQ(known.chains.size(), session["legs"].size());
    for (std::size_t i = 0; i < known.chains.size(); ++i) {
      const Json& leg = session["legs"][i];
      const ChainResult& chain = known.chains[i];
      std::vector<double> angles = chain.angles;
      if (leg.contains("motor_torque")) {
        angles.insert(angles.begin(), chain.base_angle);
        EXPECT_NEAR(chain.motor_torque, leg["motor_torque"].get<double>(), 1e-13);
      } else {
        EXPECT_TRUE(std::isnan(chain.base_angle) && std::isnan(chain.motor_torque));
      }
      ASSERT_EQ(leg["angles"].size(), angles.size()) << one.name;
      for (std::size_t j = 0; j < angles.size(); ++j)
        EXPECT_NEAR(leg["angles"][j].get<double>(), angles[j], 1e-13);
      EXPECT_NEAR(leg["chord_force"].get<double>(), chain.chord_force, 1e-12);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(leg["tensions"][k].get<double>(), chain.tension[k], 1e-11);
        EXPECT_NEAR(leg["tendon_lengths"][k].get<double>(), chain.tendon_length[k], 1e-14);
      }
      for (std::size_t k = 0; k < one.load.size(); ++k)
        EXPECT_NEAR(leg["tip_wrench"][k].get<double>(),
                    chain.tip_wrench[static_cast<Eigen::Index>(axis(one, k))], 1e-12);
    }
  }
}

/// Twist from one pose to another, in space.
SpatialWrench moved(const SpatialPose& from, const SpatialPose& to) {
  const auto a = SE3<double>::from(from), b = SE3<double>::from(to);
  SpatialWrench twist;
  twist << b.p - a.p, b.R.compose(a.R.inverse()).log();
  return twist;
}

/// Central differences of equilibria by an input: motors' angles, and lengths of tendons 1 or 2.
TEST(ChainTyped, SensitivityAndFeedAreDerivatives) {
  for (const Case& one : cases) {
    Chains chains(one.name);
    const std::vector<double> inputs = inputs_of(one);
    EquilibriumOptions options{.wrench = in_space(one.load), .start = pose_of(one)};
    const SpatialPose here = equilibrium(chains.robot, inputs, options, chains.work).pose;
    const RodAnalysis known = analyse_equilibrium(chains.robot, chains.work);
    const std::size_t count = inputs.size();
    ASSERT_EQ(known.feed.size(), 6 * count);
    options.start = here;
    for (std::size_t k = 0; k < count; ++k) {
      constexpr double h = 1e-6;
      std::vector<double> more = inputs, less = inputs;
      more[k] += h;
      less[k] -= h;
      const SpatialPose ahead = equilibrium(chains.robot, more, options, chains.work).pose,
                        behind = equilibrium(chains.robot, less, options, chains.work).pose;
      const SpatialWrench rate = moved(behind, ahead) / (2 * h);
      SpatialWrench said, fed = SpatialWrench::Zero(), needed;
      for (std::size_t r = 0; r < 6; ++r)
        said[static_cast<Eigen::Index>(r)] = known.sensitivity[r * count + k];
      EXPECT_LT((rate - said).norm(), 1e-6 * std::max(1.0, said.norm())) << one.name << " input " << k;
      for (std::size_t r = 0; r < 6; ++r) {
        needed[static_cast<Eigen::Index>(r)] = known.feed[r * count + k];
        for (std::size_t c = 0; c < 6; ++c)
          fed[static_cast<Eigen::Index>(r)] +=
              known.stiffness[6 * r + c] * said[static_cast<Eigen::Index>(c)];
      }
      EXPECT_LT((fed - needed).norm(), 1e-9 * needed.norm()) << one.name;
    }
    // rates of inputs and twists of the platform lead back to each other
    std::vector<double> rates(count, 0.0), back(count, 0.0);
    rates[0] = 0.01;
    rates[count - 1] = -0.02;
    std::array<double, 6> twist;
    ASSERT_TRUE(rod_twist(known, rates, twist).ok());
    ASSERT_TRUE(rod_rates(known, twist, back).ok()) << one.name;
    std::array<double, 6> again;
    ASSERT_TRUE(rod_twist(known, back, again).ok());
    for (std::size_t r = 0; r < 6; ++r) EXPECT_NEAR(again[r], twist[r], 1e-11) << one.name;
    if (one.load.size() > 3) continue;
    ASSERT_TRUE(rod_rates(known, std::array{twist[0], twist[1], twist[5]}, back).ok());
    ASSERT_TRUE(rod_twist(known, back, again).ok());
    for (std::size_t r = 0; r < 6; ++r) EXPECT_NEAR(again[r], twist[r], 1e-11) << one.name;
    twist[2] = 0.1;
    EXPECT_EQ(rod_rates(known, twist, back).status, Status::bad_input) << "out of the plane";
  }
}

TEST(ChainTyped, AllInversesAreThoseOfASession) {
  for (const Case& one : cases) {
    Chains chains(one.name);
    const EquilibriumOptions options{.wrench = in_space(one.load)};
    const Json session = ask(one.name, {{{"query", "inverse"},
                                         {"model", "prb"},
                                         {"pose", one.pose},
                                         {"wrench", one.load},
                                         {"all", true}}})[0];
    const auto all = inverse_equilibria(chains.robot, pose_of(one), options, chains.work);
    ASSERT_EQ(all.size(), session["solutions"].size()) << one.name;
    EXPECT_FALSE(all.empty());
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Json& theirs = session["solutions"][k];
      EXPECT_EQ(theirs["unstable_directions"], all[k].unstable_directions);
      ASSERT_EQ(theirs["inputs"].size(), all[k].inputs.size());
      for (std::size_t i = 0; i < all[k].inputs.size(); ++i)
        EXPECT_NEAR(theirs["inputs"][i].get<double>(), all[k].inputs[i], 1e-12) << one.name;
    }
    SpatialPose nowhere;
    nowhere.position[0] = std::nan("");
    EXPECT_TRUE(inverse_equilibria(chains.robot, nowhere, options, chains.work).empty());
    nowhere.position[0] = 10;
    EXPECT_TRUE(inverse_equilibria(chains.robot, nowhere, options, chains.work).empty());
  }
}

TEST(ChainTyped, CurvesAreThoseOfASession) {
  for (const Case& one : cases) {
    Chains chains(one.name);
    const std::vector<double> inputs = inputs_of(one);
    const EquilibriumOptions options{.wrench = in_space(one.load), .start = pose_of(one)};
    const bool has_motors = inputs.size() > one.load.size();
    ASSERT_TRUE(equilibrium(chains.robot, inputs, options, chains.work).is_solved());
    const RodAnalysis known = analyse_equilibrium(chains.robot, chains.work);
    Json held = Json::array(), target = Json::array();
    std::vector<double> to = inputs;
    for (std::size_t i = 0; i < known.chains.size(); ++i) {
      const auto& lengths = known.chains[i].tendon_length;
      const std::size_t inner = lengths[0] <= lengths[1] ? 0 : 1;
      Json pair{nullptr, nullptr}, there = pair;
      pair[inner] = lengths[inner];
      there[inner] = lengths[inner] - 1e-3;  // shorter, of tendon 1 as of 2
      held.push_back(pair);
      target.push_back(there);
      if (!has_motors) to[i] += inner == 0 ? -1e-3 : 1e-3;
    }
    std::vector<double> twice = one.load;
    for (double& part : twice) part *= 2;
    Json question{{"query", "track"},  {"model", "prb"},     {"lengths", held},
                  {"start", one.pose}, {"wrench", one.load}, {"to", {{"wrench", twice}}}};
    question.update(one.branch);
    CurveOptions how{.added_wrench = in_space(one.load)};
    if (!has_motors) {
      question["to"]["lengths"] = target;
      how.inputs = to;
    }
    const Json session = ask(one.name, {question})[0];
    const auto curves = equilibrium_curves(chains.robot, how, chains.work);
    ASSERT_EQ(curves.size(), session["curves"].size()) << one.name << session;
    ASSERT_FALSE(curves.empty());
    EXPECT_FALSE(held_equilibrium(chains.robot, chains.work).is_solved());
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const Json& theirs = session["curves"][k];
      EXPECT_EQ(theirs["why"], std::string(to_string(curves[k].end)));
      ASSERT_EQ(theirs["rows"].size(), curves[k].points.size()) << one.name;
      for (std::size_t j = 0; j < curves[k].points.size(); ++j) {
        const CurvePoint& point = curves[k].points[j];
        const Json& row = theirs["rows"][j];
        EXPECT_NEAR(row["parameter"].get<double>(), point.parameter, 1e-9);
        EXPECT_LT(apart(row["pose"], point.pose), 1e-9) << one.name;
        EXPECT_EQ(row.value("event", "none"), std::string(to_string(point.event)));
        EXPECT_EQ(row["unstable_directions"], point.unstable_directions);
        for (std::size_t i = 0; i < inputs.size(); ++i)
          EXPECT_NEAR(row["inputs"][i].get<double>(), point.inputs[i], 1e-9) << one.name;
      }
    }
    const CurvePoint& last = curves[0].points.back();
    if (last.event != CurveEvent::target) continue;
    // its end is an equilibrium of those inputs, found another way
    const Equilibrium there =
        equilibrium(chains.robot, last.inputs, {.wrench = in_space(twice), .start = last.pose}, chains.work);
    EXPECT_LT(moved(there.pose, last.pose).norm(), 1e-8) << one.name << to_string(there.report);
    if (!has_motors) {
      for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(last.inputs[i], to[i], 1e-10);
    }
  }
}

TEST(ChainTyped, CurvesThatLeadNowhereAreEmptyAndLeaveWhatIsHeld) {
  Chains chains("3-rfr");
  const Case& one = cases[0];
  const std::vector<double> inputs = inputs_of(one);
  EXPECT_TRUE(equilibrium_curves(chains.robot, {.added_wrench = in_space(one.load)}, chains.work).empty());
  EXPECT_TRUE(analyse_equilibrium(chains.robot, chains.work).chains.empty());
  ASSERT_TRUE(equilibrium(chains.robot, inputs, {.start = pose_of(one)}, chains.work).is_solved());
  SpatialWrench lifted = SpatialWrench::Zero();
  lifted[2] = 1;
  std::vector<double> other = inputs, beyond = inputs, none = inputs;
  other[0] = 0.4 - inputs[0];  // of the other side
  beyond[0] = 0.02;
  none[0] = std::nan("");
  for (const CurveOptions& how :
       {CurveOptions{}, CurveOptions{.added_wrench = lifted}, CurveOptions{.pose = pose_of(one)},
        CurveOptions{.inputs = {0.19}}, CurveOptions{.inputs = other}, CurveOptions{.inputs = beyond},
        CurveOptions{.inputs = none}, CurveOptions{.inputs = inputs},
        CurveOptions{.added_wrench = in_space(one.load), .lowest = 1},
        CurveOptions{.added_wrench = in_space(one.load), .max_points = 0}}) {
    EXPECT_TRUE(equilibrium_curves(chains.robot, how, chains.work).empty());
    EXPECT_TRUE(held_equilibrium(chains.robot, chains.work).is_solved());
  }
  Chains motors("3-rfrr");
  const std::vector<double> turned = inputs_of(cases[2]);
  ASSERT_TRUE(equilibrium(motors.robot, turned, {.start = pose_of(cases[2])}, motors.work).is_solved());
  EXPECT_TRUE(equilibrium_curves(motors.robot, {.inputs = turned}, motors.work).empty());
}

/// Of geometry alone nothing is answered by the arcs in the chains' place.
TEST(ChainTyped, OtherQuestionsAreAnsweredOrRefused) {
  for (const Case& one : cases) {
    Chains chains(one.name);
    const Robot& robot = chains.robot;
    const AnyPose at = home(robot);
    const std::vector<double> inputs = inputs_of(one),
                              coordinates(static_cast<std::size_t>(coordinate_count(robot)), 1.0);
    EXPECT_EQ(inverse(robot, at, {}, chains.work).report.status, Status::unsupported);
    EXPECT_EQ(working_modes(robot, at, {}, chains.work).report.status, Status::unsupported);
    EXPECT_EQ(assembly_modes(robot, inputs, chains.work).report.status, Status::unsupported);
    EXPECT_EQ(velocity(robot, at, coordinates, chains.work).report.status, Status::unsupported);
    EXPECT_FALSE(map_sample(robot, at, {}, chains.work).is_reachable);
    const std::vector<double> direction(one.load.size(), 1.0);
    EXPECT_EQ(type_2_distance(robot, at, direction, {}, chains.work).report.status, Status::unsupported);
    EXPECT_FALSE(has_velocity_batch(robot));
    std::vector<Status> statuses(1, Status::converged);
    std::vector<double> numbers(one.load.size() == 3 ? 3 : 7, 0.0);
    EXPECT_EQ(velocity_batch(robot, {.coordinates = numbers}, {.status = statuses}, chains.work), 0);
    EXPECT_NE(statuses[0], Status::converged);
    Track track(robot, {}, chains.work);
    EXPECT_EQ(track.advance(at).status, Status::unsupported);
    // forward is the equilibrium without load, in the robot's own space
    const SpatialPose start = pose_of(one);
    const Equilibrium rest = equilibrium(robot, inputs, {.start = start}, chains.work);
    AnyPose from = start;
    if (robot.planar())
      from =
          PlanarPose{one.pose["x"].get<double>(), one.pose["y"].get<double>(), one.pose["phi"].get<double>()};
    const Forward found = forward(robot, inputs, {.start = from}, chains.work);
    EXPECT_EQ(found.report.status, rest.report.status) << to_string(found.report);
    ASSERT_EQ(std::holds_alternative<PlanarPose>(found.pose), robot.planar() != nullptr);
    if (const auto* flat = std::get_if<PlanarPose>(&found.pose)) {
      EXPECT_LT(std::hypot(flat->x - rest.pose.position[0], flat->y - rest.pose.position[1]), 1e-14);
    }
  }
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
  EXPECT_TRUE(analyse_equilibrium(plane.robot, plane.work).sensitivity.empty());
  Chains other("6-ufs");
  EXPECT_TRUE(inverse_equilibria(plane.robot, pose_of(cases[0]), {}, other.work).empty());
  EXPECT_TRUE(analyse_equilibrium(plane.robot, other.work).chains.empty());
  EXPECT_EQ(equilibrium(plane.robot, good, {}, other.work).report.status, Status::bad_input);
  EXPECT_EQ(sense_wrench(plane.robot, good, few, few, {}, plane.work).report.status, Status::bad_input);
  Chains motors("3-rfrr");  // three legs: their tensions tell
  EXPECT_NE(sense_wrench(motors.robot, good, good, good, {}, motors.work).report.status, Status::converged);
  plane.work.stop = StopToken();
  ASSERT_TRUE(equilibrium(plane.robot, good, {}, plane.work).is_solved());  // and nothing of all this stays
}

}  // namespace chain_typed_test
}  // namespace sinew::test
