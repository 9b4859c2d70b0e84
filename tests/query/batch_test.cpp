/// Rows of numbers against the same questions one by one.
#include "sinew/batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "io/document/parse.hpp"
#include "query/fields/answer_places.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"
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

std::size_t width(std::span<const Batch::Field> fields) {
  std::size_t numbers = 0;
  for (const Batch::Field& field : fields) numbers += field.size();
  return numbers;
}

/// Rows as they lie in an array of n × k, all numbers of all fields side by side.
template <class Number>
std::vector<Batch::Strided<Number>> side_by_side(std::span<const Batch::Field> fields, Number* data) {
  const auto stride = static_cast<std::ptrdiff_t>(width(fields) * sizeof(double));
  std::vector<Batch::Strided<Number>> all;
  for (const Batch::Field& field : fields) {
    all.push_back({data, stride});
    data += field.size();
  }
  return all;
}

Rows run(const Batch& batch, const std::vector<double>& numbers, Batch::Options options = {}) {
  const std::size_t in = width(batch.inputs()), out = width(batch.outputs()), rows = numbers.size() / in;
  Rows done{std::vector<double>(rows * out, -1), std::vector<std::uint8_t>(rows, 99)};
  batch.run(rows, side_by_side(batch.inputs(), numbers.data()),
            side_by_side(batch.outputs(), done.outputs.data()), done.statuses, options);
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

/// All numbers of an answer's number, list or lists.
std::vector<double> flat(const Json& value) {
  if (!value.is_array()) return {value.get<double>()};
  std::vector<double> numbers;
  for (const Json& one : value)
    for (const double x : flat(one)) numbers.push_back(x);
  return numbers;
}
/// `legs[0].force` as `/legs/0/force`.
Json::json_pointer pointer(std::string place) {
  std::erase(place, ']');
  for (char& c : place)
    if (c == '.' || c == '[') c = '/';
  return Json::json_pointer('/' + place);
}

class BatchOf : public testing::TestWithParam<Case> {};

TEST_P(BatchOf, SaysWhatQuestionsSay) {
  const Case& one = GetParam();
  const Batch batch = prepared(one.robot, one.question).value();
  EXPECT_EQ(batch.method(), one.method);
  const std::vector<double> numbers = around(one.middle, one.reach, 40);
  const Rows found = run(batch, numbers);
  const std::size_t in = width(batch.inputs()), out = width(batch.outputs());
  std::size_t solved = 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const Json answer = Json::parse(batch.answer(std::span(numbers).subspan(k * in, in)));
    ASSERT_TRUE(answer.contains("status")) << answer.dump();
    EXPECT_EQ(to_string(static_cast<Status>(found.statuses[k])), answer["status"]) << k;
    if (answer["status"] != "converged") continue;
    ++solved;
    const Json outputs = Json::parse(one.question)["outputs"];
    std::size_t column = k * out;
    for (const Batch::Field& field : batch.outputs()) {
      const auto place = outputs[field.name].get<std::string>();
      const auto expected = flat(answer.at(pointer(place)));
      ASSERT_EQ(expected.size(), field.size()) << place;
      for (const double x : expected)
        EXPECT_NEAR(found.outputs[column++], x, 1e-9 * std::max(1.0, std::abs(x))) << place;
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

TEST_P(BatchOf, RemembersNothingOfRowsBefore) {
  const Case& one = GetParam();
  const std::vector<double> numbers = around(one.middle, one.reach, 20, 3),
                            others = around(one.middle, 2 * one.reach, 50, 4);
  const Batch fresh = prepared(one.robot, one.question).value(),
              used = prepared(one.robot, one.question).value();
  run(used, others);
  run(used, std::vector(others.size(), std::nan("")));
  const Rows first = run(fresh, numbers), second = run(used, numbers);
  EXPECT_EQ(first.statuses, second.statuses);
  EXPECT_EQ(0,
            std::memcmp(first.outputs.data(), second.outputs.data(), first.outputs.size() * sizeof(double)));
}

INSTANTIATE_TEST_SUITE_P(
    Questions, BatchOf,
    testing::Values(
        Case{
            "two-segment",
            R"({"query":"forward","tensions":"$t","outputs":{"p":"tip.position","q":"tip.quaternion","c":"changes","s":"slack","e":"potential","r":"resolution"}})",
            {1.5, 1, 1, 1, 1.5, 1},
            0.8,
            "arms in lanes"},
        Case{
            "two-segment",
            R"({"query":"forward","tensions":[["$a",0.5,null]],"wrench":["$x",0,-0.01,0,0,0],"accuracy":1e-5,"outputs":{"p":"tip.position","t":"tensions"}})",
            {1, 0.01},
            0.01,
            "arms in lanes"},
        Case{
            "tendon-rod",
            R"({"query":"forward","model":"rod","tensions":[["$a",0,"2 N",0]],"outputs":{"x":"tip.position[0]"}})",
            {2},
            1.5,
            "arms in lanes"},
        Case{"two-segment",
             R"({"query":"forward","tensions":"$t","want":["pose"],"outputs":{"x":"tip.position[0]"}})",
             {1.5, 1, 1, 1, 1.5, 1},
             0.5,
             "query by query"},
        Case{
            "3pfs-g2",
            R"({"query":"forward","inputs":["$a","$b","$c"],"path":"continue","outputs":{"x":"pose.position[0]","e1":"pose.quaternion[1]"}})",
            {0.43, 0.43, 0.43},
            0.005,
            "rods in lanes"},
        Case{"3pfs-g2",
             R"({"query":"forward","inputs":"$l","outputs":{"p":"pose.position","q":"pose.quaternion"}})",
             {0.43, 0.43, 0.43},
             0.03,
             "rods in lanes"},
        Case{
            "3pfs-g2",
            R"({"query":"forward","inputs":["$a",0.45,"$b"],"wrench":[0.5,-1,-8,0.1,0,0.05],"outputs":{"p":"pose.position"}})",
            {0.43, 0.43},
            0.02,
            "rods in lanes"},
        Case{"3pfs-g1",
             R"({"query":"forward","inputs":"$l","outputs":{"z":"pose.position[2]"}})",
             {0.2, 0.2, 0.2},
             0.06,
             "rods in lanes"},
        Case{
            "3pfs-g2",
            R"({"query":"forward","inputs":"$l","path":"continue","outputs":{"p":"pose.position","q":"pose.quaternion"}})",
            {0.43, 0.43, 0.43},
            0.005,
            "rods in lanes"},
        Case{
            "3pfs-g2",
            R"({"query":"velocity","inputs":"$l","wrench":"$w","outputs":{"J":"J","K":"K","U":"U","force":"legs[1].force","d":"J[1]"}})",
            {0.43, 0.43, 0.43, 0, 0, -1, 0, 0, 0},
            0.005,
            "query by query"},
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
        Case{"3-rfr",
             R"({"query":"inverse","pose":{"x":"$x","y":"$y","phi":0.1},"outputs":{"l":"inputs"}})",
             {0, 0},
             0.02,
             "poses in lanes"},
        Case{
            "3-rfr",
            R"({"query":"velocity","model":"prb","pose":{"x":"$x","y":0,"phi":0.1},"twist":"$v","outputs":{"J":"J","K":"K","U":"U","a":"legs[2].angles","rates":"rates"}})",
            {0, 0, 0, 0},
            0.01,
            "query by query"},
        Case{
            "3-rfr",
            R"({"query":"statics","tensions":"$t","wrench":"$w","outputs":{"C":"compliance","T":"legs[0].tensions","w":"legs[0].tip_wrench"}})",
            {0.6, 0.02, 0.6, 0.02, 0.6, 0.02, 0, 0, 0},
            0.001,
            "query by query"},
        Case{
            "6-ufs",
            R"({"query":"inverse","pose":{"position":"$p","quaternion":"$q"},"outputs":{"l":"inputs","e":"legs[3].base_tangent"}})",
            {0, 0, 0.2, 1, 0, 0, 0},
            0.005,
            "query by query"},
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
            "ends of sections"},
        Case{
            "nottingham-tpcj",
            R"({"query":"forward","configuration":"$c","outputs":{"l":"changes","p":"tip.position","q":"sections[1].quaternion"}})",
            std::vector<double>(10, 0.05), 0.05, "ends of sections"},
        Case{
            "two-segment",
            R"({"query":"forward","model":"lsk","configuration":"$c","outputs":{"l":"changes","p":"tip.position"}})",
            {0.3, 0.1, 0.2, 0.4},
            0.1,
            "ends of sections"},
        Case{
            "two-segment",
            R"({"query":"forward","model":"pcc","changes":"$l","outputs":{"c":"configuration","p":"tip.position"}})",
            {-0.002, 0.001, 0.001, -0.002, 0.001, 0.001},
            0.0002,
            "query by query"},
        Case{
            "nottingham-neutral",
            R"({"query":"velocity","configuration":"$c","twist":"$v","outputs":{"J":"J","K":"K","rates":"rates","c":"configuration"}})",
            {0.3, 0.1, 0.2, 0.4, 0.2, 0.1, 0.3, 0.2, 0.2, 0.3, 0, 0, 0, 0, 0, 0},
            0.01,
            "query by query"}));

TEST(Batch, ChoosesUsualOutputsAndUnits) {
  const auto names = [](const Batch& batch) {
    std::string all;
    for (const auto& [name, unit, shape] : batch.outputs()) {
      all += name + "[" + unit + "]";
      for (const std::size_t length : shape) all += std::to_string(length) + ",";
      all += " ";
    }
    return all;
  };
  EXPECT_EQ(names(prepared("3-rfr", R"({"query":"forward","inputs":["$a","$b","$c"]})").value()),
            "x[m] y[m] phi[rad] residual[] ");
  EXPECT_EQ(names(prepared("3pfs-g2", R"({"query":"forward","inputs":["$a","$a","$a"]})").value()),
            "position[m]3, quaternion[]4, residual[] ");
  const Batch inverse =
      prepared("3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":"$phi"}})").value();
  EXPECT_EQ(names(inverse), "inputs[m]3, residual[] ");
  EXPECT_EQ(inverse.method(), "poses in lanes");
  EXPECT_EQ(inverse.inputs()[0].unit, "m");
  EXPECT_EQ(inverse.inputs()[1].unit, "rad");
  EXPECT_EQ(names(prepared("nottingham-tpcj", R"({"query":"forward","changes":"$c"})").value()),
            "position[m]3, quaternion[]4, changes[m]15, ");
  const auto shape = [](const char* robot, const char* question) {
    return prepared(robot, question).value().inputs()[0].shape;
  };
  using Shape = std::vector<std::size_t>;
  EXPECT_EQ(shape("3-rfrr", R"({"query":"forward","inputs":"$a"})"), Shape{6});
  EXPECT_EQ(prepared("3-rfrr", R"({"query":"forward","inputs":"$a"})").value().inputs()[0].unit, "rad, m");
  EXPECT_EQ(shape("nottingham-tpcj", R"({"query":"forward","configuration":"$c"})"), (Shape{5, 2}));
  EXPECT_EQ(shape("3-rfr", R"({"query":"statics","tensions":"$t"})"), (Shape{3, 2}));
  EXPECT_EQ(
      shape("3-rfr", R"({"query":"velocity","model":"prb","pose":{"x":0,"y":0,"phi":0},"angles":"$t"})"),
      (Shape{3, 5}));
  EXPECT_EQ(
      shape(
          "3-rfr",
          R"({"query":"velocity","model":"prb","set":{"defaults.link.joints":8},"pose":{"x":0,"y":0,"phi":0},"angles":"$t"})"),
      (Shape{3, 7}));
}

/// Rows are told how well they are solved, as one by one, whichever way they are computed.
TEST(Batch, UsualOutputsAreThereAndHaveTheResidual) {
  struct Usual {
    const char *robot, *question, *method;
    std::vector<double> middle;
    double reach;
  };
  for (const auto& [robot, question, method, middle, reach] :
       {Usual{"3-rfr", R"({"query":"forward","inputs":"$l"})", "query by query", {0.19, 0.19, 0.19}, 1e-3},
        Usual{"3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":0}})", "poses in lanes", {0}, 0.01},
        Usual{
            "3-rfr", R"({"query":"velocity","pose":{"x":"$x","y":0,"phi":0}})", "poses in lanes", {0}, 0.01},
        Usual{"3-rfr",
              R"({"query":"inverse","model":"prb","pose":{"x":"$x","y":0,"phi":-0.55}})",
              "query by query",
              {0},
              1e-3},
        Usual{"6-ufs",
              R"({"query":"inverse","pose":{"position":["$x",0,0.2],"quaternion":[1,0,0,0]}})",
              "poses in lanes",
              {0},
              0.01},
        Usual{"3prs",
              R"({"query":"inverse","independent":{"z":"$z","e1":0,"e2":0.01}})",
              "poses in lanes",
              {0.35},
              0.01},
        Usual{"3pfs-g2",
              R"({"query":"forward","inputs":"$l","path":"continue"})",
              "rods in lanes",
              {0.43, 0.43, 0.43},
              0.005},
        Usual{
            "3pfs-g2", R"({"query":"velocity","inputs":"$l"})", "query by query", {0.43, 0.43, 0.43}, 0.005},
        Usual{"nottingham-tpcj",
              R"({"query":"inverse","position":["$x",0.01,0.17]})",
              "query by query",
              {0},
              0.001},
        Usual{"tendon-rod", R"({"query":"forward","tensions":[["$t",0,0,0]]})", "arms in lanes", {1}, 0.1}}) {
    const Batch batch = prepared(robot, question).value();
    EXPECT_EQ(batch.method(), method) << question;
    EXPECT_EQ(batch.outputs().back().name, "residual") << question;
    const std::vector<double> numbers = around(middle, reach, 20, 5);
    const Rows found = run(batch, numbers);
    const std::size_t in = middle.size(), out = width(batch.outputs());
    std::size_t solved = 0;
    for (std::size_t k = 0; k < 20; ++k) {
      if (found.statuses[k] != static_cast<std::uint8_t>(Status::converged)) continue;
      ++solved;
      for (std::size_t c = 0; c < out; ++c)
        EXPECT_TRUE(std::isfinite(found.outputs[k * out + c])) << question;
      const Json alone = Json::parse(batch.answer(std::span(numbers).subspan(k * in, in)));
      EXPECT_NEAR(found.outputs[(k + 1) * out - 1], alone["residual"].get<double>(), 1e-9) << question;
    }
    EXPECT_GT(solved, 5U) << robot << question;
  }
}

TEST(Batch, ArmsHeldByTensionsAndChangesAreAsAsked) {
  const Batch batch = prepared("two-segment",
                               R"({"query":"forward","tensions":[["$a",0.5,0],null],
                                   "changes":[null,["$c","$c",0.001]],
                                   "outputs":{"p":"tip.position","t":"tensions","c":"changes"}})")
                          .value();
  EXPECT_EQ(batch.method(), "arms row by row");
  const std::vector<double> numbers{1, -0.0003, 0.7, 0.0002, 1.2, 0, -1, 0, 1, 2e9};
  const Rows found = run(batch, numbers);
  for (std::size_t k = 0; k < 5; ++k) {
    const Json answer = Json::parse(batch.answer(std::span(numbers).subspan(2 * k, 2)));
    if (k > 2) {
      EXPECT_TRUE(answer.contains("error")) << k;
      EXPECT_EQ(found.statuses[k], static_cast<std::uint8_t>(Status::bad_input)) << k;
      continue;
    }
    EXPECT_EQ(to_string(static_cast<Status>(found.statuses[k])), answer["status"]) << k;
    std::vector<double> expected = flat(answer.at(pointer("tip.position")));
    for (const char* place : {"tensions", "changes"})
      for (const double x : flat(answer[place])) expected.push_back(x);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found.outputs[15 * k + i], expected[i], 1e-9) << k << ' ' << i;
  }
}

TEST(Batch, ArmsTakeAllLoadsOfASingleQuestion) {
  const Batch batch =
      prepared("two-segment",
               R"({"query":"forward","tensions":[["$a",0.5,0],[0.2,0,0]],"model":"cc","gravity":[0,-9.81,0],
                   "set":{"sections.discs":{"count":10,"mass":0.001}},
                   "following":[0.01,0,0,0,0,0],"loads":[{"place":0.1,"wrench":[0,0.02,0,0,0,0]}],
                   "wrench":[0,0,"$f",0,0,0],"max_iterations":200,"outputs":{"p":"tip.position"}})")
          .value();
  EXPECT_EQ(batch.method(), "arms row by row");
  const std::vector<double> numbers{1, -0.01, 0.7, 0.02, 1.2, 0};
  const Rows found = run(batch, numbers);
  for (std::size_t k = 0; k < 3; ++k) {
    const Json answer = Json::parse(batch.answer(std::span(numbers).subspan(2 * k, 2)));
    EXPECT_EQ(to_string(static_cast<Status>(found.statuses[k])), answer["status"]) << answer;
    const std::vector<double> expected = flat(answer.at(pointer("tip.position")));
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found.outputs[3 * k + i], expected[i], 1e-9) << k << ' ' << i;
  }
}

/// On a path rows begin where the one before ended: the same equilibria as far as they are resolved, and
/// after a row that is refused from the straight arm again.
TEST(Batch, ArmsOnAPathAreWhereTheyAreAnew) {
  const char* question = R"({"query":"forward","tensions":"$t","path":"%s","outputs":{"p":"tip.position"}})";
  const auto batch = [&](const char* path) {
    std::string text = question;
    return prepared("two-segment", text.replace(text.find("%s"), 2, path)).value();
  };
  std::vector<double> numbers;
  for (int k = 0; k < 300; ++k)
    for (int i = 0; i < 6; ++i) numbers.push_back(1.5 + 1.4 * std::sin(0.02 * (i + 1) * k + i));
  numbers[6 * 20] = -1;
  numbers[6 * 30 + 2] = std::nan("");
  numbers[6 * 40 + 3] = 2e9;
  const Batch path = batch("continue"), anew = batch("anew");
  EXPECT_EQ(path.method(), "arms in lanes");
  const Rows warm = run(path, numbers), cold = run(anew, numbers);
  const auto has = [&](const Rows& rows, std::size_t k) { return static_cast<Status>(rows.statuses[k]); };
  for (std::size_t k = 0; k < 300; ++k) {
    const bool is_bad = k == 20 || k == 30 || k == 40;
    EXPECT_EQ(has(warm, k), is_bad ? Status::bad_input : Status::converged) << k;
    EXPECT_EQ(has(warm, k), has(cold, k)) << k;
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = warm.outputs[3 * k + i], b = cold.outputs[3 * k + i];
      EXPECT_TRUE(is_bad ? std::isnan(a) && std::isnan(b) : std::abs(a - b) < 8e-7) << k << ' ' << a - b;
    }
  }
  const Rows shared = run(path, numbers, {.threads = 3});
  EXPECT_EQ(0, std::memcmp(warm.outputs.data(), shared.outputs.data(), warm.outputs.size() * sizeof(double)));
  const auto stopped = [&] {
    const std::atomic<bool> stop{true};
    return run(path, numbers, {.stop = &stop});
  }();
  EXPECT_EQ(has(stopped, 7), Status::stopped);
}

/// Chunks, and in them stretches of a path, come from the number of rows alone, so that threads do not show.
TEST(Batch, ArmsInLanesHaveTheSameBytesForAnyNumberOfThreads) {
  std::vector<double> numbers;
  for (int k = 0; k < 4200; ++k) numbers.push_back(1.5 + 1.4 * std::sin(0.01 * k));
  numbers[3000] = -1;
  for (const char* path : {"continue", "anew"}) {
    std::string question =
        R"({"query":"forward","model":"cc","tensions":[["$t",0.5,0]],"path":"%s","outputs":{"p":"tip.position"}})";
    const Batch batch = prepared("two-segment", question.replace(question.find("%s"), 2, path)).value();
    EXPECT_EQ(batch.method(), "arms in lanes");
    const Rows one = run(batch, numbers, {.threads = 1}), three = run(batch, numbers, {.threads = 3});
    EXPECT_EQ(one.statuses, three.statuses);
    EXPECT_EQ(one.statuses[3000], static_cast<std::uint8_t>(Status::bad_input));
    EXPECT_EQ(std::ranges::count(one.statuses, static_cast<std::uint8_t>(Status::converged)), 4199);
    EXPECT_EQ(0, std::memcmp(one.outputs.data(), three.outputs.data(), one.outputs.size() * sizeof(double)))
        << path;
  }
}

TEST(Batch, SaysWhatIsWrong) {
  const auto code = [](std::string_view question) {
    const auto batch = prepared("3-rfr", question);
    return batch ? std::string() : batch.error().front().code;
  };
  EXPECT_EQ(code(R"({"query":"forward","inputs":[0.2,0.2,0.2]})"), "no_inputs");
  EXPECT_EQ(code(R"({"query":"forward","inputs":"$a","wrench":["$a",0,0]})"), "ambiguous");
  EXPECT_EQ(code(R"({"query":"forward","inputs":"$a","max_iterations":"$a[1]"})"), "ambiguous");
  EXPECT_EQ(code(R"([1])"), "wrong_type");
  EXPECT_EQ(code(R"({"query":"forward","inputs":["$a"],"path":"home"})"), "unknown_choice");
  EXPECT_EQ(code(R"({"query":"forward","inputs":["$",0.2,0.2]})"), "missing_key");
  EXPECT_EQ(code(R"({"query":"forward","id":"$i","inputs":"$a"})"), "no_effect");
  EXPECT_EQ(code(R"({"query":"inverse","pose":{"x":"$a","y":0,"phi":"$a"}})"), "ambiguous");  // m and rad
  EXPECT_EQ(code(R"({"query":"forward","inputs":"$a","start":"last"})"), "no_effect");
  EXPECT_EQ(code(R"({"query":"inverse","pose":{"x":"$a","y":"$a","phi":0}})"), "");
  for (const char* place : {"", "$a", "inputs[x]", "inputs[-1]", "inputs[]", "inputs[0", "inputs..a", ".x",
                            "x.", "inputs[0]x", "inputs[9999999999]", "a b"})
    EXPECT_EQ(code(Json{{"query", "forward"}, {"inputs", "$a"}, {"outputs", {{"z", place}}}}.dump()),
              "unknown_path")
        << place;
  EXPECT_FALSE(Batch::prepare(parse_yaml("legs: 3", "robot").value(), parse_json("{}", "query").value()));
}

/// What no row would be answered is said when the question is prepared, as a session says it of one row.
TEST(Batch, RefusesQuestionsAsSessionsDo) {
  struct Wrong {
    const char *robot, *question;  ///< $ where the number of a row goes
  };
  for (const auto& [robot, question] :
       {Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2,0.2]})"},
        Wrong{"3-rfr", R"({"query":"forward","input":["$",0.2,0.2],"inputs":[0.2,0.2,0.2]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":[0.2,0.2,0.2],"foo":"$"})"},
        Wrong{"3-rfr", R"({"query":"forwards","inputs":["$",0.2,0.2]})"},
        Wrong{"3-rfr", R"({"inputs":["$",0.2,0.2]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"configuration":[[0,0]]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$","0.2 kg",0.2]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"want":["posture"]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"want":["stiffness"]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"wrench":[0,0,1]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"model":"rod"})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"max_iterations":-3})"},
        Wrong{"3-rfr", R"({"query":"inverse","pose":{"x":"$","y":0}})"},
        Wrong{"3-rfr", R"({"query":"inverse","pose":{"x":"$","y":0,"phi":0},"bending":[1,1]})"},
        Wrong{"3-rfr", R"({"query":"inverse","pose":{"x":"$","y":0,"phi":0},"elbow":[1,1,1]})"},
        Wrong{"3-rfr", R"({"query":"diagram","section":0,"changes":["$",0,0]})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":["$",0.2,0.2],"set":{"defaults.link.no":1}})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":[0.2,0.2,0.2],"set":{"legs[7].link.length":"$"}})"},
        Wrong{"3-rfr", R"({"query":"forward","inputs":[0.2,0.2,0.2],"set":{"defaults.link.no":"$"}})"},
        Wrong{"3-rfr", R"({"query":"statics","tensions":[["$",0],[0,0]]})"},
        Wrong{"3pfs-g2", R"({"query":"inverse","pose":{"position":["$",0,0.4],"quaternion":[1,0,0,0]}})"},
        Wrong{"3pfs-g2", R"({"query":"forward","inputs":["$",0.4,0.4],"wrench":[0,0,1]})"},
        Wrong{"3pfs-g2", R"({"query":"forward","inputs":["$",0.4,0.4],"law":"M0"})"},
        Wrong{"nottingham-tpcj", R"({"query":"statics","configuration":[["$",0]]})"},
        Wrong{"nottingham-tpcj", R"({"query":"forward","configuration":[["$",0,0]]})"},
        Wrong{"nottingham-tpcj", R"({"query":"forward","configuration":[["$",0]],"wrench":[0,0,1,0,0,0]})"},
        Wrong{"tendon-rod", R"({"query":"diagram","section":0,"changes":["$",0,0]})"},
        Wrong{"tendon-rod", R"({"query":"forward","tensions":["$",0,0,0,0,0,0]})"},
        Wrong{"tendon-rod", R"({"query":"forward","tension":[["$",0]]})"}}) {
    const auto with = [asked = std::string(question)](std::string_view number) {
      std::string text = asked;
      const auto place = text.find("\"$\"");
      return text.replace(place, 3, number);
    };
    const Json alone = Json::parse(Session::open(robot).value().answer(with("0.1")));
    const auto batch = prepared(robot, with("\"$q\""));
    if (!alone.contains("error")) {  // a status, of rows too
      ASSERT_TRUE(batch) << question << to_string(batch.error());
      EXPECT_EQ(alone["status"], "unsupported") << question;
      EXPECT_EQ(run(*batch, {0.1}).statuses[0], static_cast<std::uint8_t>(Status::unsupported)) << question;
      continue;
    }
    ASSERT_FALSE(batch) << question;
    std::string said;
    for (const Error& error : batch.error())
      said += (said.empty() ? "" : said.ends_with('.') ? " " : "; ") + error.message;
    if (const auto name = said.find("$q"); name != std::string::npos) said.replace(name, 2, "0.1");
    EXPECT_EQ(said, alone["error"]["message"]) << question;
    EXPECT_EQ(batch.error().front().where, alone["error"]["where"]) << question;
  }
}

/// What one number decides is a row's: a question that some row answers is prepared.
TEST(Batch, LeavesToRowsWhatTheirNumbersDecide) {
  struct Right {
    const char *robot, *question;
    std::vector<double> numbers;
  };
  for (const auto& [robot, question, numbers] :
       {Right{"3-rfr",
              R"({"query":"inverse","pose":{"x":0,"y":0,"phi":0},"bending":"$b","max_iterations":"$n"})",
              {1, -1, 1, 50}},
        Right{"3-rfr",
              R"({"query":"inverse","pose":{"x":0,"y":0,"phi":0},"set":{"defaults.link.length":"$l"}})",
              {0.25}},
        Right{
            "3-rfr", R"({"query":"forward","inputs":[0.2,0.2,0.2],"set":{"platform.radius":"$l"}})", {0.05}},
        Right{"3-rfr",
              R"({"query":"forward","inputs":[0.2,0.2,0.2],"set":{"legs[0].base.point.radius":"$x"}})",
              {0.19}},
        Right{"6-ufs",
              R"({"query":"inverse","pose":{"position":[0,0,0.2],"quaternion":["$w","$x","$y","$z"]}})",
              {1, 0, 0, 0}},
        Right{"nottingham-tpcj",
              R"({"query":"diagram","section":"$s","changes":[["$a",0,0],[0,0,0],[0,0,0]]})",
              {2, 0.0001}},
        Right{"nottingham-tpcj",
              R"({"query":"inverse","position":[0,0,"$z"],"direction":"$d"})",
              {0.18, 0, 0, 1}},
        Right{"3pfs-g2",
              R"({"query":"forward","inputs":[0.43,0.43,0.43],"gravity":"$g","set":{"platform.mass":"$m"}})",
              {0, 0, -9.81, 0.1}}}) {
    const auto batch = prepared(robot, question);
    ASSERT_TRUE(batch) << question << to_string(batch.error());
    const Json answer = Json::parse(batch->answer(numbers));
    EXPECT_FALSE(answer.contains("error")) << question << answer.dump();
    EXPECT_EQ(to_string(static_cast<Status>(run(*batch, numbers).statuses[0])),
              answer.value("status", "converged"))
        << question;
  }
}

/// Names and shapes of what comes out.
std::string columns(const Batch& batch) {
  std::string all;
  for (const Batch::Field& field : batch.outputs()) {
    all += (all.empty() ? "" : " ") + field.name;
    for (const std::size_t length : field.shape) all += "," + std::to_string(length);
  }
  return all;
}

/// What `want` names comes out, as one row by itself has it.
TEST(Batch, HasColumnsOfWhatIsWanted) {
  const Batch stiff =
      prepared("3pfs-g2", R"({"query":"forward","inputs":"$l","want":["stiffness","margins"]})").value();
  EXPECT_EQ(columns(stiff), "position,3 quaternion,4 stiffness,6,6 margins_fold margins_strain residual");
  const std::vector<double> lengths{0.44, 0.42, 0.41};
  const Rows found = run(stiff, lengths);
  const Json alone = Json::parse(Session::open("3pfs-g2").value().answer(
      R"({"query":"forward","inputs":[0.44,0.42,0.41],"want":["stiffness","margins"]})"));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(found.outputs[7 + 6 * i + k], alone["stiffness"][i][k].get<double>(), 1e-6);
  EXPECT_NEAR(found.outputs[43], alone["margins"]["fold"].get<double>(), 1e-9);
  const auto of = [](const char* robot, const char* question) {
    const auto batch = prepared(robot, question);
    return batch ? columns(*batch) : to_string(batch.error());
  };
  EXPECT_EQ(of("3-rfr", R"({"query":"forward","inputs":"$l","want":["velocity"],"twist":[0,0,1]})"),
            "x y phi J,3,3 K,3,3 U,3,3 determinant indices_condition indices_condition_homogenised "
            "indices_position indices_rotation type_2_singular type_2_rank rates,3 residual");
  EXPECT_EQ(
      of("3pfs-g2", R"({"query":"inverse","independent":{"z":"$z","e1":0,"e2":0},"want":["stability"]})"),
      "inputs,3 stable unstable_directions residual");
  EXPECT_EQ(of("3-rfr", R"({"query":"forward","inputs":"$l","want":["sensitivity","pose"]})"),
            "x y phi sensitivity,3,3 residual");
  EXPECT_EQ(of("3prs", R"({"query":"forward","inputs":"$l","want":["legs"],"outputs":{}})").substr(0, 66),
            "position,3 quaternion,4 legs_0_elbow legs_0_slide legs_0_carriage,");
  EXPECT_EQ(
      of("3-rfr", R"({"query":"forward","inputs":"$l","want":["shape"]})"),
      "want: what shape answers is as long as it is, which is no column; name outputs, such as one number "
      "of its lists, or ask such rows one by one [no_effect]");
  EXPECT_EQ(
      of("3-rfr", R"({"query":"forward","inputs":"$l","all":true})"),
      "all: rows have more and fewer solutions, which are no column; name outputs, such as count, or ask "
      "such rows one by one [no_effect]");
  EXPECT_EQ(of("3-rfr", R"({"query":"forward","inputs":"$l","all":true,"outputs":{"n":"count"}})"), "n");
}

/// Units of matrices are those of their blocks.
TEST(Batch, TellsUnitsOfBlocks) {
  const auto unit = [](const char* robot, const char* question, const char* place) {
    const auto batch = prepared(robot, question + std::string(R"(,"outputs":{"n":")") + place + "\"}}");
    if (!batch) return to_string(batch.error());
    std::string told = batch->outputs()[0].unit;
    const AnswerPlaces places(
        ask_of(Json::parse(question + std::string("}"))["query"].get<std::string>()).value());
    const std::string table = ", " + std::string(places.field(place)->unit) + ", ";
    for (std::size_t at = 0; at < told.size(); at = std::min(told.find(", ", at), told.size() - 2) + 2)
      EXPECT_NE(table.find(", " + told.substr(at, told.find(", ", at) - at) + ", "), std::string::npos)
          << place << ": " << told << " of " << table;
    return told;
  };
  const char *lengths = R"({"query":"forward","inputs":"$l")",
             *tensions = R"({"query":"statics","tensions":"$t")",
             *bends = R"({"query":"forward","configuration":"$c")",
             *pulled = R"({"query":"forward","tensions":"$t")",
             *paid_out = R"({"query":"forward","changes":"$c")";
  EXPECT_EQ(unit("3pfs-g2", lengths, "stiffness"), "N/m, N, N m");
  EXPECT_EQ(unit("3pfs-g2", lengths, "stiffness[0]"), "N/m, N");
  EXPECT_EQ(unit("3pfs-g2", lengths, "stiffness[4][1]"), "N");
  EXPECT_EQ(unit("3pfs-g2", lengths, "sensitivity"), "1, rad/m");
  EXPECT_EQ(unit("3pfs-g2", lengths, "J"), "N/m, N, N m");
  EXPECT_EQ(unit("3pfs-g2", lengths, "K"), "N/m, N");
  EXPECT_EQ(unit("3pfs-g2", lengths, "margins.strain"), "");
  EXPECT_EQ(unit("3-rfr", lengths, "J"), "m, m^2");
  EXPECT_EQ(unit("3-rfr", lengths, "K"), "m");
  EXPECT_EQ(unit("3-rfr", lengths, "U"), "1, rad/m");
  EXPECT_EQ(unit("3-rfrr", lengths, "K"), "m^2, m");
  EXPECT_EQ(unit("3-rfrr", lengths, "sensitivity"), "m, 1, rad/m");
  EXPECT_EQ(unit("3prs", lengths, "J"), "m, m^2, 1");
  EXPECT_EQ(unit("3-rfr", tensions, "compliance"), "m/N, 1/N, rad/N, rad/(N m)");
  EXPECT_EQ(unit("3-rfr", tensions, "wrench"), "N, N m");
  EXPECT_EQ(unit("nottingham-tpcj", bends, "J"), "m, 1");
  EXPECT_EQ(unit("nottingham-tpcj", bends, "K"), "m");
  const char* sensed =
      R"({"query":"statics","inputs":[0.43,0.43,0.43,0.43,0.43,0.43],"axial_forces":"$f","deviation":0.1)";
  EXPECT_EQ(
      prepared("6pfs", sensed + std::string(R"(,"outputs":{"n":"covariance"}})")).value().outputs()[0].unit,
      "N^2, N^2 m, N^2 m^2");
  EXPECT_EQ(unit("6pfs", sensed, "wrench_sensitivity"), "1, m");
  const auto unit_of_determinant = [](const char* robot, const char* question) {
    return prepared(robot, question + std::string(R"(,"outputs":{"n":"determinant"}})"))
        .value()
        .outputs()[0]
        .unit;
  };
  EXPECT_EQ(unit_of_determinant("3-rfr", lengths), "m^4");
  EXPECT_EQ(unit_of_determinant("3prs", lengths), "m^6");
  EXPECT_EQ(unit_of_determinant("6-ufs", lengths), "m^9");
  EXPECT_EQ(unit("two-segment", pulled, "U"), "m/N, rad/N");
  EXPECT_EQ(unit("two-segment", paid_out, "U"), "1, rad/m");
  EXPECT_EQ(unit("two-segment", pulled, "answers_by_wrench"), "m/N, 1/N");
}

/// A word of `want` that changes nothing of what comes out is a slip.
TEST(Batch, RefusesWantsThatNoOutputIsOf) {
  const auto of = [](const char* robot, const std::string& question, const std::string& words,
                     const std::string& places) {
    const auto batch = prepared(
        robot, R"({"query":")" + question + R"(,"want":[)" + words + R"(],"outputs":{)" + places + "}}");
    return batch ? "" : to_string(batch.error());
  };
  const std::string rods = R"(forward","inputs":"$l")", arm = R"(forward","tensions":"$t")";
  EXPECT_EQ(
      of("3pfs-g2", rods, R"("stiffness")", R"("n":"pose.position")"),
      "want: no output is of what stiffness answers; name one, such as stiffness, or leave the word out "
      "[no_effect]");
  EXPECT_EQ(
      of("3pfs-g2", rods, R"("stiffness","margins")", R"("n":"margins.fold")"),
      "want: no output is of what stiffness answers; name one, such as stiffness, or leave the word out "
      "[no_effect]");
  EXPECT_EQ(of("3-rfr", rods, R"("shape")", R"("n":"pose.x")"),
            "want: no output is of what shape answers; name one, or leave the word out [no_effect]");
  EXPECT_EQ(of("3pfs-g2", rods, R"("stiffness","margins")", R"("n":"margins.fold","m":"stiffness[0][0]")"),
            "");
  EXPECT_EQ(of("3-rfr", rods, R"("shape")", R"("n":"lines[0][0][0]")"), "");
  EXPECT_EQ(of("two-segment", arm, R"("stability")", R"("n":"buckling_margin")"), "");
  EXPECT_EQ(of("two-segment", arm, R"("margins")", R"("n":"buckling_margin")"), "");
  // there by themselves; looked at by the status
  EXPECT_EQ(of("3-rfr", rods, R"("pose","legs")", R"("n":"residual")"), "");
  EXPECT_EQ(of("3-rfr", rods, R"("velocity","sensitivity")", R"("n":"pose.x")"), "");
  const Batch singular = prepared("3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":"$phi"},)"
                                           R"("want":["velocity"],"outputs":{"l":"inputs"}})")
                             .value();
  EXPECT_EQ(run(singular, {0.04, std::numbers::pi / 3}).statuses[0],
            static_cast<std::uint8_t>(Status::singular));
}

/// A place that goes with a word of `want` needs no more than its name.
TEST(Batch, WantsWhatItsOutputsGoWith) {
  struct Named {
    const char *robot, *question, *place;
    std::vector<double> numbers;
  };
  for (const auto& [robot, question, place, numbers] :
       {Named{"3pfs-g2", R"({"query":"forward","inputs":"$l")", "stiffness[0][0]", {0.44, 0.42, 0.41}},
        Named{"3pfs-g2",
              R"({"query":"forward","inputs":"$l","want":["legs"])",
              "margins.fold",
              {0.44, 0.42, 0.41}},
        Named{"3pfs-g2", R"({"query":"forward","inputs":"$l")", "legs[1].force[2]", {0.44, 0.42, 0.41}},
        Named{"3pfs-g2",
              R"({"query":"forward","inputs":"$l","want":["legs"])",
              "pose.position[2]",
              {0.44, 0.42, 0.41}},
        Named{"3pfs-g2",
              R"({"query":"forward","inputs":"$l","path":"continue")",
              "unstable_directions",
              {0.44, 0.42, 0.41}},
        Named{"3-rfr", R"({"query":"forward","inputs":"$l")", "indices.position", {0.19, 0.19, 0.188}},
        Named{"3-rfr", R"({"query":"forward","inputs":"$l")", "backbones[0][7][1]", {0.19, 0.19, 0.188}},
        Named{"3-rfr", R"({"query":"forward","inputs":"$l")", "type_1.count", {0.19, 0.19, 0.188}},
        Named{"3-rfr", R"({"query":"statics","tensions":[["$a",0],[1,0],[1,0]])", "margins.strain", {1}},
        Named{"two-segment", R"({"query":"forward","tensions":"$t")", "buckling_margin", {}},
        Named{"nottingham-tpcj", R"({"query":"forward","configuration":"$c")", "J[0][1]",
              std::vector<double>(10, 0.1)}}) {
    const auto batch = prepared(robot, question + std::string(R"(,"outputs":{"n":")") + place + "\"}}");
    ASSERT_TRUE(batch) << place << to_string(batch.error());
    std::vector<double> row = numbers;
    row.resize(width(batch->inputs()), 1);
    const Rows found = run(*batch, row);
    EXPECT_TRUE(std::isfinite(found.outputs.back())) << robot << ' ' << place;
  }
}

TEST(Batch, RefusesOutputsThatNoAnswerHas) {
  const auto said = [](const char* robot, const char* question, const char* place) {
    const auto batch = prepared(robot, question + std::string(R"(,"outputs":{"n":")") + place + "\"}}");
    return batch ? std::string() : to_string(batch.error());
  };
  const char* forward = R"({"query":"forward","inputs":"$l")";
  const auto starts = [](const std::string& text, std::string_view with) {
    EXPECT_TRUE(text.starts_with(with)) << text;
  };
  starts(said("3-rfr", forward, "poze.x"),
         "outputs.n: no answer to forward has \"poze.x\" by this robot and model; did you mean \"pose.x\"? "
         "There are: pose, inputs, legs, ");
  starts(said("3-rfr", forward, "x"),
         "outputs.n: no answer to forward has \"x\" by this robot and model; did you mean \"pose.x\"?");
  starts(said("3-rfr", forward, "pose"),
         "outputs.n: pose is no number; name one of its fields, such as pose.x");
  starts(said("3-rfr", forward, "pose.position"),
         "outputs.n: no answer to forward has \"pose.position\" by this robot and model. There are in pose: "
         "x, y, phi.");
  starts(said("3-rfr", forward, "legs[99].curvature"),
         "outputs.n: there is no legs[99]; give a leg from 0 to 2");
  starts(said("3-rfr", forward, "legs[0].force"),
         "outputs.n: no answer to forward has \"legs[0].force\" by this robot and model; did you mean");
  starts(said("3-rfr", forward, "legs"),
         "outputs.n: legs is a list; name one of them, such as legs[0].curvature");
  starts(said("3-rfr", forward, "legs[0]"),
         "outputs.n: legs[0] is no number; name one of its fields, such as legs[0].curvature");
  starts(said("3-rfr", forward, "stiffness"), "outputs.n: no answer to forward has \"stiffness\"");
  starts(said("3-rfr", forward, "pose.x[0]"), "outputs.n: pose.x is one number; leave the index out");
  starts(said("3-rfr", forward, "J[3]"), "outputs.n: J has no [3]; give an index from 0 to 2");
  starts(said("3-rfr", forward, "J[0][3]"), "outputs.n: J[0] has no [3]; give an index from 0 to 2");
  starts(said("3-rfr", forward, "backbones"),
         "outputs.n: backbones is as long as it is, which is no column; name one of its numbers, such as "
         "backbones[0][0][0], or backbones.count");
  starts(said("3-rfr", forward, "base[0]"),
         "outputs.n: base[0] is as long as it is, which is no column; name one of its numbers, such as "
         "base[0][0], or base[0].count");
  EXPECT_EQ(said("3-rfr", forward, "base[0][1]"), "");
  starts(said("3-rfr", forward, "count"), "outputs.n: count goes with all; add that to the question");
  starts(said("3-rfr", R"({"query":"forward","inputs":"$l","all":false)", "count"),
         "outputs.n: count goes with");
  starts(said("3pfs-g2", forward, "pose.position[3]"),
         "outputs.n: pose.position has no [3]; give an index from 0 to 2");
  starts(said("3-rfr", R"({"query":"statics","tensions":"$t")", "sensitivity"),
         "outputs.n: sensitivity is as long as it is, which is no column; name one of its numbers");
  EXPECT_EQ(said("3-rfr", R"({"query":"statics","tensions":"$t")", "sensitivity[0][1]"), "");
}

/// A name stands for numbers, which no pose is: names go into it.
TEST(Batch, RefusesNamesForMaps) {
  const auto said = [](const char* robot, const char* question) {
    const auto batch = prepared(robot, question);
    return batch ? std::string() : to_string(batch.error());
  };
  EXPECT_EQ(said("3-rfr", R"({"query":"inverse","pose":"$pose"})"),
            R"(pose: a pose is a map; give names in it, {"x": "$x", "y": "$y", "phi": "$phi"} [wrong_type])");
  EXPECT_EQ(said("3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":"$y","phi":"$phi"}})"), "");
  EXPECT_EQ(
      said("6-ufs", R"({"query":"inverse","pose":"$pose"})"),
      R"(pose: a pose is a map; give names in it, {"position": "$position", "quaternion": "$quaternion"} [wrong_type])");
  for (const char* robot : {"3pfs-g2", "3prs"})
    EXPECT_EQ(
        said(robot, R"({"query":"inverse","pose":"$pose"})"),
        R"(pose: of this robot give "independent": {"z": "$z", "e1": "$e1", "e2": "$e2"} [wrong_type])");
}

TEST(Batch, RefusesRowsWhoseNumbersAreNone) {
  const double nan = std::nan(""), infinite = INFINITY;
  for (const auto& [robot, question] :
       {std::pair{"3-rfr", R"({"query":"inverse","pose":{"x":"$x","y":0,"phi":0}})"},
        std::pair{"3-rfr", R"({"query":"forward","inputs":["$x",0.2,0.2]})"},
        std::pair{"3pfs-g2", R"({"query":"forward","inputs":["$x",0.43,0.43]})"}}) {
    const Batch batch = prepared(robot, question).value();
    const Rows found = run(batch, {nan, infinite, -infinite, 1e300, -1, 0});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(found.statuses[k] == static_cast<std::uint8_t>(Status::bad_input) ||
                  (k > 0 && found.statuses[k] == static_cast<std::uint8_t>(Status::left_domain)))
          << question << k;
      EXPECT_TRUE(std::isnan(found.outputs[k * width(batch.outputs())]));
    }
    EXPECT_TRUE(Json::parse(batch.answer(std::vector{nan})).contains("error"));
  }
}

TEST(Batch, Stops) {
  const Batch batch =
      prepared(
          "hexapod-torsion",
          R"({"query":"forward","inputs":["$a",0.5,0.5,0.5,0.5,0.5],"all":true,"outputs":{"n":"count"}})")
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
  const Batch::Strided<double> out{found, 24};
  batch.run(2, {&in, 1}, {&out, 1}, statuses, {});  // statuses of three rows
  EXPECT_EQ(statuses, std::vector<std::uint8_t>(3, 99));
  EXPECT_EQ(found[0], -1);
}

TEST(Batch, TakesArraysAsTheyLie) {
  const Batch batch =
      prepared(
          "nottingham-tpcj",
          R"({"query":"forward","configuration":"$c","outputs":{"p":"tip.position","l":"changes","z":"tip.position[2]"}})")
          .value();
  constexpr std::ptrdiff_t number = sizeof(double);
  constexpr std::size_t rows = 7;
  const std::vector<double> side_by_side = around(std::vector<double>(10, 0.05), 0.05, rows);
  const Rows expected = run(batch, side_by_side);
  std::vector<double> transposed(10 * rows), positions(3 * rows), changes(15 * rows), z(rows);
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t i = 0; i < 10; ++i) transposed[i * rows + k] = side_by_side[k * 10 + i];
  const Batch::Strided<const double> in{transposed.data(), number, rows * number};
  const std::vector<Batch::Strided<double>> out{
      {positions.data(), number, rows * number},                // column after column
      {changes.data() + 15 * rows - 1, -15 * number, -number},  // all backwards
      {z.data(), number, 0}};
  batch.run(rows, {&in, 1}, out, {}, {});
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(positions[i * rows + k], expected.outputs[19 * k + i]);
    for (std::size_t i = 0; i < 15; ++i)
      EXPECT_EQ(changes[15 * rows - 1 - 15 * k - i], expected.outputs[19 * k + 3 + i]);
    EXPECT_EQ(z[k], positions[2 * rows + k]);
  }
}

/// Each row is a path: from the straight arm, or from where the row before it ended, with what friction
/// remembers.
TEST(Batch, FollowsAnArmWhoseTendonsRubFromRowToRow) {
  const std::string question =
      R"({"query": "track", "points": [{"tensions": "$T"}], "steps": 3, "elements": 2,
          "set": {"sections[0].tendons.friction": 0.3},
          "outputs": {"x": "tip.position[0]", "loss": "friction_loss"}, "path": ")";
  const std::vector<double> pulled{3, 0, 0, 0, 1, 0, 0, 0};
  const auto after = [&](const char* path) {
    const auto batch = prepared("tendon-rod", question + path + "\"}");
    EXPECT_TRUE(batch) << batch.error().front().message;
    EXPECT_EQ(batch->inputs()[0].size(), 4U);
    const Rows rows = run(*batch, pulled);
    EXPECT_EQ(rows.statuses, std::vector<std::uint8_t>(2, static_cast<std::uint8_t>(Status::converged)));
    return rows.outputs;
  };
  const auto one = after("continue"), anew = after("anew");
  EXPECT_NEAR(one[0], anew[0], 1e-12);
  EXPECT_GT(std::abs(one[2] - anew[2]), 1e-4);  // let go from 3 N it is bent more than pulled to 1 N
  EXPECT_GT(one[3], 0);
  auto session = Session::open("tendon-rod").value();
  const Json path = Json::parse(session.answer(
      R"({"query": "track", "points": [{"tensions": [[3, 0, 0, 0]]}, {"tensions": [[1, 0, 0, 0]]}], "steps": 3,
          "elements": 2, "set": {"sections[0].tendons.friction": 0.3}})"));
  EXPECT_NEAR(one[2], path["tip"]["position"][0].get<double>(), 1e-10);
}

/// Rows are refused where the question by itself is, at either side of the ranges of all numbers that vary.
TEST(Batch, RowsAreRefusedWhereQuestionsAre) {
  struct Case {
    std::string robot;
    std::string_view question;
    std::vector<double> usual;
    std::size_t varied;
    std::vector<double> values;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::string_view
      planar = R"({"query": "inverse", "pose": {"x": "$a", "y": "$b", "phi": "$c"}})",
      spatial =
          R"({"query": "inverse", "pose": {"position": [0, 0, "$a"], "quaternion": ["$b", 0, 0, "$c"]}})",
      free = R"({"query": "inverse", "independent": {"z": "$a", "e1": "$b", "e2": "$c"}})",
      bends = R"({"query": "forward", "configuration": [["$a", "$b"], ["$c", 0]]})";
  const Case cases[] = {{"3-rfr", planar, {0, -0.01, 0}, 0, {0.9e9, 1.1e9, none}},
                        {"3-rfr", planar, {0, -0.01, 0}, 2, {0.9e6, 1.1e6, -1.1e6, none}},
                        {"6-ufs", spatial, {0.2, 1, 0}, 0, {0.9e9, -1.1e9, none}},
                        {"6-ufs", spatial, {0.2, 1, 0}, 1, {1e-7, 2e-6, 0.9e9, 1.1e9}},
                        {"3prs", free, {0.3, 0, 0}, 0, {0.9e9, 1.1e9, none}},
                        {"3prs", free, {0.3, 0, 0}, 1, {0.99, 1.01, -1.01, none}},
                        {"four-tendon-tpcj", bends, {0.1, 0.1, 0.1}, 1, {0.9e6, 1.1e6, -1.1e6, none}}};
  for (const Case& one : cases) {
    const auto batch = prepared(one.robot, one.question);
    ASSERT_TRUE(batch) << one.robot << ": " << to_string(batch.error());
    for (const double value : one.values) {
      std::vector<double> row = one.usual;
      row[one.varied] = value;
      std::string text(one.question);
      for (std::size_t k = 0; k < row.size(); ++k) {
        const std::string name = std::string("\"$") + static_cast<char>('a' + k) + '"';
        text.replace(text.find(name), name.size(), std::isfinite(row[k]) ? Json(row[k]).dump() : "null");
      }
      const bool is_error = Json::parse(Session::open(one.robot).value().answer(text)).contains("error");
      const auto status = run(*batch, row).statuses[0];
      EXPECT_EQ(status == static_cast<std::uint8_t>(Status::bad_input), is_error)
          << one.robot << ' ' << text << ' ' << int{status};
    }
  }
}

}  // namespace batch_test
}  // namespace sinew
