// The quick samplers say what queries say, one by one.
#include "query/batch/sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "query/batch/answer_path.hpp"
#include "query/fields/answer_places.hpp"
#include "study/sweep/plan.hpp"
#include "study/sweep/prepare.hpp"
#include "study/sweep/samples.hpp"
#include "study_support.hpp"

namespace samplers_test {

using namespace sinew;
using test::Folder;

struct Computed {
  std::vector<double> outputs;
  std::vector<SampleStatus> statuses;
};

Computed compute(const SamplerKind& kind, const Study& study) {
  const Chunk all{0, study.samples};
  Computed done{std::vector<double>(study.outputs.size() * all.count), std::vector<SampleStatus>(all.count)};
  std::vector<double> axes(study.variable_count() * all.count);
  axis_values(study, all, study.is_path, axes);
  std::atomic<std::size_t> count{0};
  const std::atomic<bool> stop{false};
  InputColumns inputs;
  OutputColumns outputs;
  place_columns<const double>(axes, all.count, inputs);
  place_columns<double>(done.outputs, all.count, outputs);
  kind.make()({all.count, inputs, outputs, done.statuses, &count, &stop});
  EXPECT_EQ(count, all.count);
  return done;
}

/// Largest difference of both ways, relative where values are beyond 1; statuses and missing values alike.
double difference(const std::string& text, const char* expected_kind) {
  const Folder folder;
  auto study = test::study_of(folder, text);
  if (!study) {
    ADD_FAILURE() << to_string(study.error());
    return 0;
  }
  const auto ready = prepare(*study);
  EXPECT_TRUE(ready) << to_string(ready.error());
  const SamplerKind quick = choose_sampler(question_of(*study));
  EXPECT_EQ(quick.name, expected_kind);
  const Computed one = compute(quick, *study), other = compute(query_sampler(question_of(*study)), *study);
  EXPECT_EQ(one.statuses, other.statuses);
  double worst = 0;
  for (std::size_t i = 0; i < one.outputs.size(); ++i) {
    EXPECT_EQ(std::isnan(one.outputs[i]), std::isnan(other.outputs[i])) << i;
    if (std::isnan(one.outputs[i])) continue;
    worst = std::max(worst,
                     std::abs(one.outputs[i] - other.outputs[i]) / std::max(1.0, std::abs(other.outputs[i])));
  }
  return worst;
}

TEST(Samplers, PlanarPosesInLanesAgreeWithQueries) {
  const std::string axes = R"(axes:
  y: {from: -110 mm, to: 110 mm, count: 12}
  x: {from: -110 mm, to: 110 mm, count: 11}
  phi: {from: -80 deg, to: 80 deg, count: 9}
)";
  EXPECT_LT(difference("sinew: 1\nrobot: 3-rfr\nquery: {query: velocity, pose: {x: $x, y: $y, phi: $phi}}\n" +
                           axes + R"(outputs:
  condition: indices.condition
  homogenised: indices.condition_homogenised
  position: indices.position
  rotation: indices.rotation
  determinant: determinant
  curvature: legs[1].curvature
  type_1: type_1.count
  type_2: type_2.singular
)",
                       "poses in lanes"),
            1e-9);
  EXPECT_LT(difference("sinew: 1\nrobot: 3-rfr\nquery: {query: inverse, pose: {x: $x, y: $y, phi: $phi}, "
                       "bending: [1, -1, 1]}\n" +
                           axes,
                       "poses in lanes"),
            1e-13);
}

TEST(Samplers, SpatialPosesInLanesAgreeWithQueries) {
  EXPECT_LT(difference(R"(sinew: 1
robot: 6-ufs
query: {query: velocity, pose: {position: [$x, 0.01, $z], quaternion: [1, $e1, 0.1, 0]}}
axes:
  x: {from: -80 mm, to: 80 mm, count: 5}
  z: {from: 120 mm, to: 240 mm, count: 6}
  e1: {from: -0.2, to: 0.2, count: 5}
)",
                       "poses in lanes"),
            1e-9);
}

TEST(Samplers, IndependentCoordinatesInLanesAgreeWithQueries) {  // some beyond reach, some no quaternion's
  const std::string z = "\n  z: {from: 400 mm, to: 600 mm, count: 3}", tilts = R"(
  e1: {from: -0.9, to: 0.9, count: 13}
  e2: {from: -0.8, to: 0.9, count: 12}
)";
  for (const auto& [place, more] :
       {std::pair{"{z: $z, e1: $e1, e2: $e2}", z.c_str()}, {"{z: 510 mm, e1: $e1, e2: $e2, mode: tilt}", ""}})
    EXPECT_LT(difference(std::string("sinew: 1\nrobot: 3prs\nquery: {query: velocity, independent: ") +
                             place + ", elbow: [1, -1, 1]}\naxes:" + more + tilts + R"(outputs:
  x: "pose.position[0]"
  e0: "pose.quaternion[0]"
  e3: "pose.quaternion[3]"
  condition: indices.condition
  homogenised: indices.condition_homogenised
  rotation: indices.rotation
  determinant: determinant
  type_1: type_1.count
  type_2: type_2.singular
)",
                         "poses in lanes"),
              1e-9);
  EXPECT_LT(difference("sinew: 1\nrobot: 3prs\nset: {\"legs[0].closure.length\": 0.7, "
                       "\"legs[1].closure.length\": 0.7, \"legs[2].closure.length\": 0.7}\n"
                       "query: {query: inverse, independent: {z: $z, e1: $e1, e2: $e2, mode: half_turn}}\n"
                       "axes:" +
                           z + tilts,
                       "poses in lanes"),
            1e-13);
}

/// What a plan takes from the question that was read: a changed robot, angles for a quaternion; of what is
/// wanted it leaves alone what it does not know.
TEST(Samplers, PlansAreOfTheQuestionAsItIsRead) {
  const std::string axes = "\naxes: {x: {from: -40 mm, to: 40 mm, count: 9}}\n";
  EXPECT_LT(difference("sinew: 1\nrobot: 3-rfr\nquery: {query: inverse, set: {platform.radius: 40 mm}, "
                       "model: cc, pose: {x: $x, y: 10 mm, phi: 5 deg}}" +
                           axes,
                       "poses in lanes"),
            1e-13);
  EXPECT_LT(difference("sinew: 1\nrobot: 6-ufs\nquery: {query: inverse, pose: {position: [$x, 0, 200 mm], "
                       "tilt: 0.1, azimuth: 20 deg, torsion: -5 deg}}" +
                           axes,
                       "poses in lanes"),
            1e-13);
  EXPECT_LT(difference("sinew: 1\nrobot: 3pfs-g2\nquery: {query: forward, set: {platform.radius: 0.11}, "
                       "inputs: [$x, 0.43, 430 mm]}\naxes: {x: {from: 0.4, to: 0.46, count: 9, unit: m}}\n",
                       "rods in lanes"),
            1e-9);
  for (const char* more :
       {"set: {platform.radius: $x}, pose: {x: 0, y: 0, phi: 0}", "pose: {x: $x, y: 0, phi: 0}, want: [pose]",
        "pose: {x: $x, y: 0, phi: 0}, all: true", "pose: {x: $x, y: 0, phi: 0}, model: prb"})
    difference(std::string("sinew: 1\nrobot: 3-rfr\nquery: {query: inverse, ") + more +
                   "}\naxes: {x: {from: 42 mm, to: 50 mm, count: 3}}\n"
                   "outputs: {residual: residual}\n",
               "query by query");
}

TEST(Samplers, TendonsInLanesAgreeWithQueries) {
  for (const char* robot : {"nottingham-tpcj", "nottingham-neutral", "four-tendon-tpcj"})
    for (const char* model : {"pcc", "lsk"})  // some bends are beyond the limit
      EXPECT_LT(
          difference(std::string("sinew: 1\nrobot: ") + robot +
                         "\nquery: {query: forward, configuration: [[$a, $b], [0.1, 0.2], [$b, 0]], model: " +
                         model + R"(}
axes:
  a: {from: -30 deg, to: 30 deg, count: 13}
  b: {from: -30 deg, to: 30 deg, count: 11}
outputs: {first: "changes[0][0]", other: "changes[2][1]", last: "changes[4][2]"}
)",
                     "tendons in lanes"),
          1e-15);
}

TEST(Samplers, EndsOfSectionsAgreeWithQueries) {
  for (const char* robot : {"nottingham-tpcj", "four-tendon-neutral"})
    EXPECT_LT(difference(std::string("sinew: 1\nrobot: ") + robot +
                             R"(
query: {query: forward, configuration: [[$a, $b], [0.1, 0.2], [$b, "5 deg"]]}
axes:
  a: {from: -30 deg, to: 30 deg, count: 13}
  b: {from: -30 deg, to: 30 deg, count: 11}
outputs: {x: "tip.position[0]", w: "tip.quaternion[0]", y: "sections[1].position[1]",
          e: "sections[0].quaternion[2]", pull: "changes[1][1]"}
)",
                         "ends of sections"),
              1e-14);
}

TEST(Samplers, RodsInLanesAgreeWithQueries) {
  for (const char* more : {"", ", wrench: [1, -0.5, -60, 0, 0.1, 0]"})
    EXPECT_LT(
        difference(std::string("sinew: 1\nrobot: 3pfs-g2\nquery: {query: forward, inputs: [$a, $b, 0.43]") +
                       more + R"(}
axes:
  a: {from: 380 mm, to: 480 mm, count: 9}
  b: {from: 400 mm, to: 460 mm, count: 13}
)",
                   "rods in lanes"),
        1e-9);
}

TEST(Samplers, DerivedValuesAgreeWithQueries) {
  EXPECT_LT(difference(R"(sinew: 1
robot: 3pfs-g2
query: {query: forward, inputs: [$a, $b, $c]}
axes: {a: {from: 400 mm, to: 440 mm, count: 9}, b: {from: 410 mm, to: 450 mm, count: 13}}
derived: {c: 1.28 - a - b}
)",
                       "rods in lanes"),
            1e-9);
  EXPECT_LT(difference(R"(sinew: 1
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: $y, phi: $phi}}
axes: {x: {from: -50 mm, to: 50 mm, count: 9}, phi: {from: -0.5, to: 0.5, count: 7, unit: rad}}
derived: {y: 0.03 - 0.5*x}
outputs: {condition: indices.condition, determinant: determinant}
)",
                       "poses in lanes"),
            1e-9);
}

TEST(Samplers, OthersAreAskedQueryByQuery) {
  const Folder folder;
  for (const auto& [robot, query] :
       {std::pair{"3-rfr", "{query: velocity, model: prb, pose: {x: $x, y: 0, phi: 0}}"},
        {"3-frr", "{query: inverse, pose: {x: $x, y: 0, phi: 0}}"},
        {"3pfs-g2", "{query: forward, inputs: [0.43, 0.43, 0.43], wrench: [$x, 0, 0, 0, 0, 0]}"},
        {"3pfs-g2", "{query: forward, inputs: [0.43, 0.44, 0.43], tilt: true, wrench: [0, 0, -1, $x, 0, 0]}"},
        {"hexapod", "{query: inverse, pose: {position: [0, 0, 0.4], tilt: 0.1, torsion: $x}}"},
        {"6-ufs", "{query: velocity, pose: {position: [0, 0, 0.18], tilt: $x}}"},
        {"3pfs-g2", "{query: forward, inputs: [0.43, 0.43, 0.43], set: {\"legs[0].link.diameter\": $d}}"},
        {"nottingham-tpcj", "{query: inverse, position: [0.06, $x, 0.15]}"}}) {
    const std::string text = std::string("sinew: 1\nrobot: ") + robot + "\nquery: " + query +
                             (std::string(query).find("$d") == std::string::npos
                                  ? "\naxes: {x: {from: 0, to: 0.01, count: 3}}\n"
                                  : "\naxes: {d: {from: 1.9 mm, to: 2.1 mm, count: 3}}\n");
    auto study = test::study_of(folder, text);
    ASSERT_TRUE(study) << text << to_string(study.error());
    const auto ready = prepare(*study);
    ASSERT_TRUE(ready) << text << to_string(ready.error());
    EXPECT_EQ(*ready, "") << text;
    const SamplerKind kind = choose_sampler(question_of(*study));
    EXPECT_EQ(kind.name, "query by query") << text;
    const Computed done = compute(kind, *study);
    for (const double value : done.outputs) EXPECT_TRUE(std::isfinite(value)) << text;
    for (const SampleStatus status : done.statuses) EXPECT_EQ(name_of(status), "converged") << text;
  }
}

TEST(Samplers, APathFollowsItsBranch) {  // home's branch is found anew where samples are asked alone
  const Folder folder;
  for (const char* path : {"continue", "anew"}) {
    auto study = test::study_of(folder, std::string(R"(sinew: 1
robot: 3pfs-g2
path: )") + path + R"(
query: {query: forward, inputs: [0.4347, 0.4347, 0.4347], wrench: [$f, 0, -50, 0, 0, 0]}
axes: {f: {from: 0, to: 2 N, count: 5}}
outputs: {x: "pose.position[0]", iterations: iterations}
)");
    ASSERT_TRUE(study) << to_string(study.error());
    ASSERT_TRUE(prepare(*study));
    const Computed done = compute(choose_sampler(question_of(*study)), *study);
    for (std::size_t k = 1; k < 5; ++k) {
      EXPECT_GT(done.outputs[k], done.outputs[k - 1]);
      const double iterations = done.outputs[5 + k];
      EXPECT_TRUE(!study->is_path || iterations < done.outputs[5]) << "not resumed";
    }
  }
}

/// A load beyond which long rods snap: neighbours of a row may stand on other branches.
const char* const snapping = R"(
query: {query: forward, inputs: [$a, $b, $c], wrench: [0, 0, 0, 0, 1, 0]}
set: {"platform.home.position[2]": 0.48, "legs[0].base.point.angle": 67 deg,
      "legs[1].base.point.angle": 113 deg, "legs[2].base.point.angle": 187 deg,
      "legs[3].base.point.angle": 233 deg, "legs[4].base.point.angle": 307 deg,
      "legs[5].base.point.angle": 353 deg}
axes:
  a: {from: 428 mm, to: 582 mm, count: 9}
  b: {from: 428 mm, to: 582 mm, count: 9}
  c: {from: 428 mm, to: 582 mm, count: 9}
outputs: {x: "pose.position[0]", y: "pose.position[1]", e2: "pose.quaternion[2]")";

TEST(Samplers, APathDoesNotStayOnABranchThatDoesNotHold) {
  const Folder folder;
  for (const char* end : {"}\n", ", r: residual}\n"}) {  // the second is nothing that lanes say
    auto study = test::study_of(folder, std::string("sinew: 1\nrobot: 3pfs-g2") + snapping + end);
    ASSERT_TRUE(study) << to_string(study.error());
    ASSERT_TRUE(prepare(*study));
    const Computed done = compute(choose_sampler(question_of(*study)), *study);
    for (std::size_t k = 0; k < 729; ++k) EXPECT_EQ(name_of(done.statuses[k]), "converged") << k;
  }
}

TEST(Samplers, ASampleThatIsNoGoodQueryEndsNothing) {
  const Folder folder;
  auto study = test::study_of(folder, R"(sinew: 1
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: 0, phi: 0}, set: {"legs[0].link.length": $l}}
axes: {x: {from: 0, to: 10 mm, count: 2}, l: [-0.1, 0.2, 0.21]}
)");
  ASSERT_TRUE(study) << to_string(study.error());
  ASSERT_TRUE(prepare(*study));
  const Computed done = compute(choose_sampler(question_of(*study)), *study);
  EXPECT_EQ(name_of(done.statuses[0]), "refused");
  EXPECT_EQ(name_of(done.statuses[1]), "converged");
  EXPECT_TRUE(std::isnan(done.outputs[0]));
}

TEST(AnswerPath, FindsNumbersAndLengths) {
  const std::array numbers{1.0, 2.0, 3.0, 4.5};
  Value answer{{"a", {{"b", Value(numbers, 2)}}}, {"c", true}, {"d", {1, 2, 3}}, {"e", "x"}, {"f", Value()}};
  answer["g"] = Value::list({{{"h", 7}}, numbers});
  EXPECT_EQ(AnswerPath("a.b[1][1]").number(answer), 4.5);
  EXPECT_EQ(AnswerPath("c").number(answer), 1.0);
  EXPECT_EQ(AnswerPath("d[2]").number(answer), 3.0);
  EXPECT_EQ(AnswerPath("d.count").number(answer), 3.0);
  EXPECT_EQ(AnswerPath("a.b.count").number(answer), 2.0);
  EXPECT_EQ(AnswerPath("a.b[0].count").number(answer), 2.0);
  EXPECT_EQ(AnswerPath("g[0].h").number(answer), 7.0);
  EXPECT_EQ(AnswerPath("g[1][3]").number(answer), 4.5);
  for (const char* path : {"a", "a.b", "a.b[2]", "a.b[1]", "a.b[1][7]", "a.b[1][0][0]", "a.b.x", "e", "f",
                           "d[9x]", "", "c.count", "d[1].x", "d[1].count", "..", "[0]", "g[2]", "g[0].i"})
    EXPECT_FALSE(AnswerPath(path).number(answer)) << path;
}

TEST(AnswerPlaces, KnowUnitsWhoeverAnswers) {
  const AnswerPlaces places(Ask::forward);
  const auto unit = [&](std::string_view place) { return places.unit(place); };
  EXPECT_EQ(unit("pose.position[2]"), "m");
  EXPECT_EQ(unit("pose.quaternion[2]"), "");
  EXPECT_EQ(unit("pose.phi"), "rad");
  EXPECT_EQ(unit("pose.torsion"), "rad");
  EXPECT_EQ(unit("legs[0].tendon_lengths[1]"), "m");
  EXPECT_EQ(unit("legs[0].base_tangent"), "rad");
  EXPECT_EQ(unit("legs[0].base_tangent[1]"), "");
  EXPECT_EQ(unit("legs[3].force[1]"), "N");
  EXPECT_EQ(unit("indices.position"), "");
  EXPECT_EQ(unit("configuration[0][1]"), "rad");
  EXPECT_EQ(unit("type_1.count"), "");
}

}  // namespace samplers_test
