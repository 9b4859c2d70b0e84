/// Rows of numbers against the same questions one by one.
#include "sinew/query/batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "io/parse.hpp"
#include "query/batch/answer_path.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/query/session.hpp"
#include "sinew/solve/report.hpp"

namespace sinew {
namespace batch_test {

using Json = nlohmann::ordered_json;

Expected<Batch> prepared(const std::string& robot, std::string_view question) {
  return Batch::prepare(read_robot_file(robot).value(), parse_json(question, "query").value());
}

struct Rows {
  std::vector<double> outputs;  ///< row after row
  std::vector<std::uint8_t> statuses;
};

/// Rows as they lie in an array of n × k.
Rows run(const Batch& batch, const std::vector<double>& numbers, Batch::Options options = {}) {
  const std::size_t in = batch.inputs().size(), out = batch.outputs().size(), rows = numbers.size() / in;
  Rows done{std::vector<double>(rows * out, -1), std::vector<std::uint8_t>(rows, 99)};
  std::vector<Batch::Strided<const double>> inputs;
  std::vector<Batch::Strided<double>> outputs;
  const auto stride = [](std::size_t columns) {
    return static_cast<std::ptrdiff_t>(columns * sizeof(double));
  };
  for (std::size_t i = 0; i < in; ++i) inputs.push_back({numbers.data() + i, stride(in)});
  for (std::size_t o = 0; o < out; ++o) outputs.push_back({done.outputs.data() + o, stride(out)});
  batch.run(rows, inputs, outputs, done.statuses, options);
  return done;
}

std::vector<double> around(std::vector<double> middle, double reach, std::size_t rows, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> by(-reach, reach);
  std::vector<double> numbers;
  for (std::size_t k = 0; k < rows; ++k)
    for (const double x : middle) numbers.push_back(x + by(random));
  return numbers;
}

struct Case {
  const char* robot;
  const char* question;
  std::vector<double> middle;
  double reach;
  const char* method;
};

/// The number at a place of an answer, `legs[0].force[1]`.
std::optional<double> number_at(const Json& answer, const std::string& place) {
  const auto document = parse_json(answer.dump(), "answer");
  const Node* found = document ? at(document->root, place) : nullptr;
  return found && found->kind == Node::Kind::number ? std::optional(found->number) : std::nullopt;
}

class BatchOf : public testing::TestWithParam<Case> {};

TEST_P(BatchOf, SaysWhatQuestionsSay) {
  const Case& one = GetParam();
  const Batch batch = prepared(one.robot, one.question).value();
  EXPECT_EQ(batch.method(), one.method);
  const std::vector<double> numbers = around(one.middle, one.reach, 40);
  const Rows found = run(batch, numbers);
  const std::size_t in = batch.inputs().size(), out = batch.outputs().size();
  std::size_t solved = 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const Json answer = Json::parse(batch.answer(std::span(numbers).subspan(k * in, in)));
    ASSERT_TRUE(answer.contains("status")) << answer.dump();
    EXPECT_EQ(to_string(static_cast<Status>(found.statuses[k])), answer["status"]) << k;
    if (answer["status"] != "converged") continue;
    ++solved;
    const Json asked = parse_json(one.question, "").has_value() ? Json::parse(one.question) : Json();
    for (std::size_t o = 0; o < out; ++o) {
      const std::string name = batch.outputs()[o].name;
      const std::string place = asked.contains("outputs") ? asked["outputs"][name].get<std::string>() : "";
      if (place.empty()) continue;
      const auto expected = number_at(answer, place);
      ASSERT_TRUE(expected) << place;
      EXPECT_NEAR(found.outputs[k * out + o], *expected, 1e-9 * std::max(1.0, std::abs(*expected))) << place;
    }
  }
  EXPECT_GT(solved, 20U);
}

TEST_P(BatchOf, HasTheSameBytesForAnyNumberOfThreads) {
  const Case& one = GetParam();
  const Batch batch = prepared(one.robot, one.question).value();
  const std::vector<double> numbers = around(one.middle, one.reach, 700, 2);
  const Rows alone = run(batch, numbers, {.threads = 1});
  for (const int threads : {2, 5, 0}) {
    const Rows shared = run(batch, numbers, {.threads = threads});
    EXPECT_EQ(alone.statuses, shared.statuses);
    EXPECT_EQ(
        0, std::memcmp(alone.outputs.data(), shared.outputs.data(), alone.outputs.size() * sizeof(double)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Questions, BatchOf,
    testing::Values(
        Case{
            "3pfs-g2",
            R"({"query":"forward","inputs":["$a","$b","$c"],"path":"continue","outputs":{"x":"pose.position[0]","e1":"pose.quaternion[1]"}})",
            {0.43, 0.43, 0.43},
            0.005,
            "rods in lanes"},
        Case{
            "3pfs-g2",
            R"({"query":"forward","inputs":["$a",0.43,"$a"],"wrench":[0,0,"$f",0,0,0],"outputs":{"z":"pose.position[2]","energy":"energy"}})",
            {0.43, -2},
            0.005,
            "query by query"},
        Case{"3-rfr",
             R"({"query":"inverse","pose":{"x":"$x","y":"$y","phi":0.1},"outputs":{"l":"inputs[1]"}})",
             {0, 0},
             0.02,
             "poses in lanes"},
        Case{
            "3-rfr",
            R"({"query":"statics","tensions":[["$t",0],["$t",0],["$t",0]],"outputs":{"phi":"pose.phi","T":"legs[0].tensions[0]"}})",
            {0.6},
            0.1,
            "query by query"},
        Case{
            "nottingham-tpcj",
            R"({"query":"forward","configuration":[["$a","$b"]],"outputs":{"l":"changes[0][1]","z":"tip.position[2]"}})",
            {0.1, 0.1},
            0.1,
            "ends of sections"}));

TEST(Batch, ChoosesUsualOutputsAndUnits) {
  const auto names = [](const Batch& batch) {
    std::string all;
    for (const auto& [name, unit] : batch.outputs()) all += name + "[" + unit + "] ";
    return all;
  };
  EXPECT_EQ(names(prepared("3-rfr", R"({"query":"forward","inputs":["$a","$b","$c"]})").value()),
            "x[m] y[m] phi[rad] ");
  EXPECT_EQ(names(prepared("3pfs-g2", R"({"query":"forward","inputs":["$a","$a","$a"]})").value()),
            "x[m] y[m] z[m] e0[] e1[] e2[] e3[] ");
  const Batch inverse =
      prepared("3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":"$phi"}})").value();
  EXPECT_EQ(names(inverse), "inputs_0[m] inputs_1[m] inputs_2[m] ");
  EXPECT_EQ(inverse.inputs()[0].unit, "m");
  EXPECT_EQ(inverse.inputs()[1].unit, "rad");
}

TEST(Batch, SaysWhatIsWrong) {
  const auto code = [](std::string_view question) {
    const auto batch = prepared("3-rfr", question);
    return batch ? std::string() : batch.error().front().code;
  };
  EXPECT_EQ(code(R"({"query":"forward","inputs":[0.2,0.2,0.2]})"), "no_inputs");
  EXPECT_EQ(code(R"([1])"), "wrong_type");
  EXPECT_EQ(code(R"({"query":"forward","inputs":["$a"],"path":"home"})"), "unknown_choice");
  EXPECT_FALSE(Batch::prepare(parse_yaml("legs: 3", "robot").value(), parse_json("{}", "query").value()));
}

TEST(Batch, RefusesRowsWhoseNumbersAreNone) {
  const double nan = std::nan(""), infinite = INFINITY;
  for (const auto& [robot, question] :
       {std::pair{"3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":0}})"},
        std::pair{"3-rfr", R"({"query":"forward","inputs":["$x",0.2,0.2]})"},
        std::pair{"3pfs-g2", R"({"query":"forward","inputs":["$x",0.43,0.43]})"},
        std::pair{"3-rfr", R"({"query":"no-such","x":"$x"})"}}) {
    const Batch batch = prepared(robot, question).value();
    const Rows found = run(batch, {nan, infinite, -infinite, 1e300, -1, 0});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(found.statuses[k] == static_cast<std::uint8_t>(Status::bad_input) ||
                  (k > 0 && found.statuses[k] == static_cast<std::uint8_t>(Status::left_domain)))
          << question << k;
      EXPECT_TRUE(std::isnan(found.outputs[k * batch.outputs().size()]));
    }
    EXPECT_TRUE(Json::parse(batch.answer(std::vector{nan})).contains("error"));
  }
}

TEST(Batch, Stops) {
  const Batch batch =
      prepared("hexapod-torsion", R"({"query":"forward","inputs":["$a",0.5,0.5,0.5,0.5,0.5],"all":true})")
          .value();
  std::atomic<bool> stop{false};
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop = true;
  });
  const Rows found = run(batch, around({0.5}, 0.01, 500), {.stop = &stop});  // an hour, else
  for (const std::uint8_t status : found.statuses)
    EXPECT_EQ(status, static_cast<std::uint8_t>(Status::stopped));
}

TEST(Batch, OfNoRowsOrOfOtherColumnsDoesNothing) {
  const Batch batch = prepared("3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":0}})").value();
  batch.run(0, {}, {}, {}, {});
  std::vector<std::uint8_t> statuses(3, 99);
  batch.run(3, {}, {}, statuses, {});
  const double x[] = {0, 0, 0};
  double found[9] = {-1};
  const Batch::Strided<const double> in{x};
  const std::vector<Batch::Strided<double>> out{{found}, {found + 3}, {found + 6}};
  batch.run(2, {&in, 1}, out, statuses, {});  // statuses of three rows
  EXPECT_EQ(statuses, std::vector<std::uint8_t>(3, 99));
  EXPECT_EQ(found[0], -1);
}

}  // namespace batch_test
}  // namespace sinew
