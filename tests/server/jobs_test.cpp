/// Jobs without a socket: their work is a function of the test where it has to be.
#include "server/jobs/jobs.hpp"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "server/jobs/job_request.hpp"
#include "server/jobs/scratch.hpp"
#include "server/jobs/stream.hpp"
#include "server/jobs/work.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::server {
namespace jobs_test {

using namespace std::chrono_literals;
using nlohmann::json;

Outcome nothing(Job&) { return {}; }

Outcome until_over(Job& job) {
  while (!job.is_over()) std::this_thread::sleep_for(1ms);
  return {Outcome::Kind::cancelled, "{}", {}};
}

std::shared_ptr<const Outcome> outcome_of(const Job& job) {
  while (!job.outcome()) std::this_thread::sleep_for(1ms);
  return job.outcome();
}

std::string code_of(std::string_view body) {
  const auto request = read_job(body, 9);
  return request ? "" : request.error().front().code;
}

/// All that a stream gives, or as much as a listener has before he leaves.
std::string all_of(Stream& stream) {
  std::string text;
  while (!stream.has_ended()) text += stream.next();
  return text;
}

TEST(JobRequest, IsAStudyOrQueriesAsTheyStandThere) {
  EXPECT_EQ(read_job(R"( {"study": "a\u0062c"} )", 9)->study, "abc");
  const auto request = read_job(R"({"queries" : [ {"x": 1.0, "x": 2}, 5,"]" ], "robot":"7"})", 9);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->robot, "7");
  EXPECT_EQ(request->queries, (std::vector<std::string_view>{R"({"x": 1.0, "x": 2})", "5", R"("]")"}));
}

TEST(JobRequest, SaysWhatIsWrong) {
  for (const char* body : {"", "[]", "5", "{", "{{}", R"({"study"})", R"({"study":})", R"({study: "a"})",
                           R"({"study": "a",})", R"({"study": "a)", R"({"robot": "a", "queries": [}]})"})
    EXPECT_EQ(code_of(body), "json_syntax") << body;
  for (const char* body :
       {"{}", R"({"robot": "a"})", R"({"queries": [1]})", R"({"study": "a", "robot": "b"})",
        R"({"study": "a", "robot": "b", "queries": [1]})"})
    EXPECT_EQ(code_of(body), "missing_field") << body;
  for (const char* body : {R"({"study": 5})", R"({"study": ""})", R"({"robot": "a", "queries": []})",
                           R"({"robot": "a", "queries": {}})"})
    EXPECT_EQ(code_of(body), "wrong_type") << body;
  EXPECT_EQ(code_of(R"({"study": "a", "set": {}})"), "unknown_field");
}

TEST(Jobs, NoMoreRunThanMay) {
  JobLimits limits;
  limits.running = 2;
  Jobs jobs(limits);
  const auto a = jobs.start(until_over), b = jobs.start(until_over);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->size(), 32U);
  EXPECT_NE(*a, *b);
  EXPECT_FALSE(jobs.start(nothing));
  jobs.find(*a)->cancel();
  EXPECT_EQ(outcome_of(*jobs.find(*a))->kind, Outcome::Kind::cancelled);
  EXPECT_TRUE(jobs.start(nothing));  // at once: who knows that one ended may begin another
}

TEST(Jobs, TheLastThatEndedAreKept) {
  JobLimits limits;
  limits.running = 1;
  limits.kept = 2;
  Jobs jobs(limits);
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back(jobs.start(nothing).value());
    outcome_of(*jobs.find(ids.back()));
  }
  const std::string running = jobs.start(until_over).value();
  EXPECT_FALSE(jobs.find(ids[0]));
  EXPECT_TRUE(jobs.find(ids[1]));
  EXPECT_TRUE(jobs.find(ids[2]));
  jobs.forget(ids[2]);
  EXPECT_FALSE(jobs.find(ids[2]));
  jobs.forget(running);
  EXPECT_TRUE(jobs.find(running));
}

TEST(Jobs, TheLastThatEndedIsKeptWhateverItsSize) {
  JobLimits limits;
  limits.running = 1;
  limits.kept_bytes = 10;
  Jobs jobs(limits);
  const auto large = [](Job&) { return Outcome{Outcome::Kind::done, "{}", std::string(8, 'x')}; };
  const std::string first = jobs.start(large).value();
  outcome_of(*jobs.find(first));
  const std::string second = jobs.start(large).value();
  outcome_of(*jobs.find(second));
  EXPECT_TRUE(jobs.find(second));
  EXPECT_FALSE(jobs.find(first));
}

TEST(Jobs, WorkThatThrowsHasFailed) {
  Jobs jobs({});
  const std::string id =
      jobs.start([](Job&) -> Outcome { throw std::runtime_error("a \"reason\""); }).value();
  const auto outcome = outcome_of(*jobs.find(id));
  EXPECT_EQ(outcome->kind, Outcome::Kind::failed);
  EXPECT_EQ(json::parse(outcome->said)["error"]["code"], "internal");
}

TEST(Jobs, EndWithoutListeners) {
  JobLimits limits;
  limits.patience = 0.02;
  Jobs jobs(limits);
  const auto job = jobs.find(jobs.start(until_over).value());
  EXPECT_EQ(outcome_of(*job)->kind, Outcome::Kind::cancelled);
}

TEST(Jobs, GoOnWhileAnyoneListens) {
  JobLimits limits;
  limits.patience = 0.02;
  Job job(limits);
  Places places(1);
  {
    const Stream stream(std::shared_ptr<Job>(&job, [](Job*) {}), 0, 1, places.wait(0s));
    std::this_thread::sleep_for(100ms);
    EXPECT_FALSE(job.is_over());
  }
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(job.is_over());
}

TEST(Jobs, EndWithTheirServer) {
  std::atomic<int> ended = 0;
  {
    Jobs jobs({});
    for (int i = 0; i < 2; ++i)
      jobs.start([&](Job& job) {
        ++ended;
        return until_over(job);
      });
    while (ended < 2) std::this_thread::sleep_for(1ms);
  }
  Jobs stopped({});
  stopped.stop();
  EXPECT_FALSE(stopped.start(nothing));
}

std::shared_ptr<OpenRobot> robot_of(const char* name) {
  Robots robots(1, 1'000'000);
  return robots.find(robots.open(read_robot_text(name).value()).value());
}

TEST(QueryWork, HasNoMoreAnswersThanFit) {
  JobLimits limits;
  limits.result = 3000;
  Watchdog dog;
  Jobs jobs(limits);
  const std::vector<std::string> queries(100, R"({"query": "describe"})");
  const auto job = jobs.find(jobs.start(query_work(robot_of("3-rfr"), queries, dog)).value());
  EXPECT_EQ(json::parse(outcome_of(*job)->said)["error"]["code"], "too_large");
  EXPECT_GT(job->answered(), 0U);
  EXPECT_LE(job->bytes(), limits.result);
}

TEST(QueryWork, BeginsWhereNobodyHasAsked) {  // another client's walk is not gone on with
  const auto robot = robot_of("3-rfr");
  const std::string walk = R"({"query": "forward", "inputs": [0.19, 0.19, 0.188], "start": "last"})";
  auto other = robot->take().value();
  other.answer(
      R"({"query": "forward", "inputs": [0.185, 0.19, 0.188], "start": {"x": 0, "y": 0, "phi": 0}})");
  robot->give_back(std::move(other));
  Watchdog dog;
  Jobs jobs({});
  const auto job = jobs.find(jobs.start(query_work(robot, {walk}, dog)).value());
  outcome_of(*job);
  EXPECT_EQ(job->news(0, Job::Clock::now()).text, Session::open("3-rfr")->answer(walk));
}

/// A job that has ended with so many answers, each its own number.
std::shared_ptr<Job> numbers(std::size_t count) {
  auto job = std::make_shared<Job>(JobLimits{});
  job->show(0, count);
  for (std::size_t i = 0; i < count; ++i) job->add(std::to_string(i));
  job->end({});
  return job;
}

TEST(Stream, GoesOnWhereAListenerLeft) {
  constexpr std::size_t count = 200'000;  // several events
  const auto job = numbers(count);
  Places places(1);
  std::size_t position = 0, events = 0;
  for (bool has_ended = false; !has_ended;) {
    Stream stream(job, position, 1, places.wait(0s));
    std::string text = stream.next();  // one event, and he leaves
    has_ended = stream.has_ended();
    const std::size_t data = text.find("data: ") + 6;
    const json answers = json::parse(text.substr(data, text.find('\n', data) - data));
    ASSERT_EQ(answers["first"], position);
    for (const json& answer : answers["answers"]) ASSERT_EQ(answer, position++);
    EXPECT_NE(text.find("id: " + std::to_string(position) + "\nevent: answers\n"), std::string::npos);
    ++events;
  }
  EXPECT_EQ(position, count);
  EXPECT_GT(events, 3U);
}

TEST(Stream, GivesASignWhereThereIsNothingNew) {
  const auto job = std::make_shared<Job>(JobLimits{});
  Places places(1);
  Stream stream(job, 0, 0, places.wait(0s));
  EXPECT_EQ(stream.next(), "retry: 1000\n\n");
  EXPECT_EQ(stream.next(), ":\n\n");
  job->show(3, 10);
  EXPECT_NE(stream.next().find("event: progress\ndata: {\"done\":3,\"total\":10,"), std::string::npos);
  EXPECT_EQ(stream.next(), ":\n\n");
  job->end({Outcome::Kind::failed, "5", {}});
  EXPECT_EQ(stream.next(), "id: end\nevent: failed\ndata: 5\n\n");
  EXPECT_TRUE(stream.has_ended());
}

TEST(Stream, IsBrokenWhereTheServerStops) {
  const auto job = std::make_shared<Job>(JobLimits{});
  Places places(1);
  Stream stream(job, 0, 1, places.wait(0s));
  EXPECT_FALSE(stream.is_broken());
  job->abandon();
  stream.next();
  EXPECT_TRUE(stream.is_broken());
  EXPECT_TRUE(job->is_over());
}

TEST(Stream, OfAJobThatEndedHasItsLastEventOnce) {
  Places places(1);
  Stream stream(numbers(3), 3, 1, places.wait(0s));
  EXPECT_EQ(all_of(stream), "retry: 1000\n\nid: end\nevent: done\ndata: {}\n\n");
}

/// Makes a folder that looks as if it had been left long ago.
std::filesystem::path left_over() {
  std::string path = (std::filesystem::temp_directory_path() / "sinew-serve-XXXXXX").string();
  EXPECT_TRUE(mkdtemp(path.data()));
  std::ofstream(path + "/table.csv.log") << "x";
  const timespec hours[2] = {{1'000'000'000, 0}, {1'000'000'000, 0}};
  utimensat(AT_FDCWD, path.c_str(), hours, 0);
  return path;
}

TEST(Scratch, GoesWithItsJobAndWithWhatOthersLeft) {
  const auto left = left_over(), used = left_over();
  const int lock = open(used.c_str(), O_RDONLY | O_DIRECTORY);
  flock(lock, LOCK_EX);
  std::filesystem::path path;
  {
    const auto scratch = Scratch::make();
    ASSERT_TRUE(scratch);
    path = scratch->path();
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_TRUE(std::filesystem::exists(used));  // of a server that runs
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  close(lock);
  std::filesystem::remove_all(used);
}

}  // namespace jobs_test
}  // namespace sinew::server
