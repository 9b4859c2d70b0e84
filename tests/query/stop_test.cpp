/// Long questions end soon after a stop is requested, with status `stopped` and what they have.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "cpu_time.hpp"
#include "sanitizers.hpp"
#include "sinew/session.hpp"

namespace sinew {
namespace stop_test {

using test::cpu_seconds;

struct Long {
  const char* robot;
  const char* query;
};

void PrintTo(const Long& one, std::ostream* out) {
  *out << one.robot << " " << std::string(one.query).substr(0, 60);
}

class StopOf : public testing::TestWithParam<Long> {
 protected:
  nlohmann::json asked(std::atomic<bool>& flag) {
    Session session = Session::open(GetParam().robot).value();
    session.stop_on(StopToken(flag));
    return nlohmann::json::parse(session.answer(GetParam().query));
  }
};

TEST_P(StopOf, ARequestBeforeTheStartIsAnsweredAtOnce) {
  std::atomic<bool> flag{true};
  const nlohmann::json answer = asked(flag);
  ASSERT_TRUE(answer.contains("status")) << answer.dump().substr(0, 300);
  EXPECT_EQ(answer["status"], "stopped") << answer.value("message", "");
  EXPECT_FALSE(answer.value("message", "").empty());
}

/// What is computed after the request. Solves look at the flag every millisecond or so; the solutions that
/// all six-leg robots start from, found once in a process, take longer.
const double max_seconds = test::is_instrumented ? 10 : 1;
TEST_P(StopOf, ARequestOnTheWayEndsIt) {
  std::atomic<bool> flag{false};
  double requested = 0;
  std::jthread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    requested = cpu_seconds();
    flag = true;
  });
  const nlohmann::json answer = asked(flag);
  const double ended = cpu_seconds();
  other.join();
  const double late = ended - requested;
  RecordProperty("milliseconds", static_cast<int>(1e3 * late));
  EXPECT_LT(late, max_seconds);  // negative where the question was answered before
  EXPECT_TRUE(late < 0 || answer["status"] == "stopped" || answer["status"] == "converged");
}

INSTANTIATE_TEST_SUITE_P(
    Stop, StopOf,
    testing::Values(
        Long{
            "3-rfr",
            R"({"query":"track","from":{"x":0,"y":0,"phi":0},"to":{"x":0.01,"y":0,"phi":0.2},"samples":99000})"},
        Long{
            "3-rfr",
            R"({"query":"track","model":"prb","from":{"x":0,"y":0,"phi":0.1},"to":{"x":0.01,"y":0,"phi":0.2},"samples":99000})"},
        Long{
            "3-rfrr",
            R"({"query":"track","objective":"singularity","from":{"x":0,"y":0,"phi":0},"to":{"x":0.01,"y":0,"phi":0.2},"samples":99000})"},
        Long{"6-ufs", R"({"query":"forward","all":true,"inputs":[0.239,0.24,0.238,0.241,0.24,0.239]})"},
        Long{"nottingham-tpcj", R"({"query":"inverse","position":[0.06,0.02,0.02],"direction":[0,0,-1]})"},
        Long{
            "three-arcs",
            R"({"query":"inverse","all":true,"pose":{"position":[0.8,0.3,1.7],"quaternion":[0.9,0.3,0.3,0.1]}})"},
        Long{
            "3-rfr",
            R"({"query":"statics","model":"prb","set_at":{"x":0.01,"y":0,"phi":0.3},"wrench":[0.03,-0.02,0.0005]})"}));

TEST(Stop, WithoutARequestNothingChanges) {
  const std::string query = R"({"query":"forward","all":true,"inputs":[0.239,0.24,0.238,0.241,0.24,0.239]})";
  std::atomic<bool> flag{false};
  Session plain = Session::open("6-ufs").value(), watched = Session::open("6-ufs").value();
  watched.stop_on(StopToken(flag));
  EXPECT_EQ(plain.answer(query), watched.answer(query));
}

}  // namespace stop_test
}  // namespace sinew
