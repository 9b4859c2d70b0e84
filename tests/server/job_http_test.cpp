/// Jobs on a socket: what a page gets of them as they go on, and how they end.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "long_fit.hpp"
#include "sinew/session.hpp"
#include "sinew/study/sweep.hpp"
#include "study_folder.hpp"
// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace job_http_test {

using namespace std::chrono_literals;

struct Event {
  std::string id, name, data;
};

/// A listener. What a part of the stream leaves unfinished waits for the next one.
class Listener {
 public:
  Listener(int port, std::string job)
      : client_("127.0.0.1", port),
        path_("/api/jobs/" + std::move(job) + "/events") {}

  /// Until the stream ends, or for so many events of one name; then the connection is dropped.
  void listen(
      const std::string& name = "", std::size_t most = 1'000'000,
      const std::function<void(const Event&)>& hears = [](const Event&) {}) {
    httplib::Headers headers{{"Accept-Encoding", "gzip"}};
    if (!events.empty()) headers.emplace("Last-Event-ID", events.back().id);
    std::string text;
    std::size_t heard = 0;
    client_.Get(
        path_, headers,
        [&](const httplib::Response& response) {
          type = response.get_header_value("Content-Type") + response.get_header_value("Content-Encoding");
          return true;
        },
        [&](const char* bytes, std::size_t count) {
          text.append(bytes, count);
          for (std::size_t end; (end = text.find("\n\n")) != std::string::npos; text.erase(0, end + 2)) {
            if (!take(text.substr(0, end + 1))) continue;
            hears(events.back());
            if (events.back().name == name && ++heard == most) return false;
          }
          return true;
        });
    client_.stop();
  }

  std::string answers() const {
    std::string all;
    for (const Event& event : events) {
      if (event.name != "answers") continue;
      constexpr std::string_view before = R"("answers":[)";
      const std::size_t begin = event.data.find(before) + before.size();
      all += (all.empty() ? "" : ",") + event.data.substr(begin, event.data.size() - 2 - begin);
    }
    return all;
  }
  json last() const { return json::parse(events.back().data); }

  std::vector<Event> events;
  std::string type;

 private:
  bool take(const std::string& lines) {
    const auto field = [&](const std::string& name) {
      const std::size_t begin = lines.find(name + ": ");
      if (begin == std::string::npos) return std::string();
      const std::size_t from = begin + name.size() + 2;
      return lines.substr(from, lines.find('\n', from) - from);
    };
    if (!lines.starts_with("id: ")) return false;
    events.push_back({field("id"), field("event"), field("data")});
    return true;
  }

  httplib::Client client_;
  std::string path_;
};

/// Desk and what it does with jobs.
struct JobDesk : Desk {
  using Desk::Desk;
  std::string start(const std::string& body) {
    const json answer = json::parse(post("/api/jobs", body), nullptr, false);
    return answer.is_object() ? answer.value("job", "") : "";
  }
  std::string study(const std::string& name) { return start(R"({"study": ")" + name + "\"}"); }
  std::string queries(const std::string& robot, const std::string& list) {
    return start(R"({"robot": ")" + opened(robot) + R"(", "queries": [)" + list + "]}");
  }
  /// An hour of queries.
  std::string endless() {
    const std::string query =
        R"({"query": "forward", "inputs": [0.24,0.24,0.24,0.24,0.24,0.24], "all": true})";
    std::string list = query;
    for (int i = 1; i < 50'000; ++i) list += ',' + query;
    return queries("6-ufs", list);
  }
  std::string cancel(const std::string& job, const httplib::Headers& headers = {}) {
    const auto answer = client.Delete("/api/jobs/" + job, headers);
    status = answer ? answer->status : -1;
    return answer ? answer->body : "";
  }
  std::string code(const std::string& text) const {
    const json answer = json::parse(text, nullptr, false);
    return std::to_string(status) + ' ' +
           (answer.contains("error") ? answer["error"]["code"].get<std::string>() : "");
  }
};

TEST(JobHttp, AStudyTellsHowFarItIsAndGivesItsTable) {
  JobDesk desk;
  const std::string name = "3pfs-g1-height", job = desk.study(name);
  EXPECT_EQ(desk.status, 200);
  Listener listener(desk.port, job);
  listener.listen();
  EXPECT_EQ(listener.type, "text/event-stream");  // not compressed, though asked for
  ASSERT_GE(listener.events.size(), 1U);          // on a busy machine it has ended before this one listens
  EXPECT_EQ(listener.events.back().name, "done");
  for (std::size_t i = 0; i + 1 < listener.events.size(); ++i) {
    EXPECT_EQ(listener.events[i].name, "progress");
    EXPECT_EQ(json::parse(listener.events[i].data)["total"], 2883);
  }
  const test::Folder folder;
  const auto summary =
      sweep(read_study(name).value(), {.output = folder.path / "own.csv", .command = "sinew sweep " + name});
  ASSERT_TRUE(summary);
  const std::string table = desk.get("/api/jobs/" + job + "/result");
  EXPECT_EQ(table, test::bytes(folder.path / "own.csv"));
  const json done = listener.last();
  EXPECT_EQ(done["bytes"], table.size());
  EXPECT_EQ(done["samples"], 2883);
  EXPECT_EQ(done["statuses"]["converged"], summary->statuses[7]);
  desk.get("/api/jobs/" + job + "/events", {{"Last-Event-ID", "end"}});  // as a browser does by itself
  EXPECT_EQ(desk.status, 204);
  EXPECT_NE(desk.get("/api/version"), "");  // on the same connection
}

TEST(JobHttp, AFitTellsHowFarItIs) {
  JobDesk desk;
  const std::string job = desk.queries("ftdcr-v4", R"({"query": "describe"},)" + test::long_fit(200));
  Listener listener(desk.port, job);
  listener.listen();
  ASSERT_EQ(listener.events.back().name, "done");
  int told = 0, last = 0;
  std::string part;
  for (const Event& event : listener.events) {
    if (event.name != "progress") continue;
    const json data = json::parse(event.data);
    EXPECT_EQ(data["total"], 2);
    if (!data.contains("question")) continue;
    const json& now = data["question"];
    EXPECT_EQ(now["query"], "progress");
    EXPECT_EQ(now["busy"], true);
    EXPECT_EQ(data["done"], 1) << data;  // none is told of a question that is answered
    EXPECT_TRUE(now["part"] != part || now["steps"].get<int>() >= last) << now;
    EXPECT_GT(now["error"].get<double>(), 0);
    part = now["part"];
    last = now["steps"];
    ++told;
  }
  EXPECT_GT(told, 0);
  const json answers = json::parse("[" + listener.answers() + "]");
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[1]["query"], "identify") << answers[1];
  // The session goes on to serve others when the job is no more.
  desk.cancel(job);
  const std::string robot = desk.opened("ftdcr-v4");
  EXPECT_NE(desk.post("/api/query?robot=" + robot, test::long_fit(12)).find("parameters"), std::string::npos);
}

TEST(JobHttp, AFitThatIsCancelledEndsAmidItsSteps) {
  JobDesk desk;
  const std::string job = desk.queries("ftdcr-v4", test::long_fit(3000));  // seconds
  Listener listener(desk.port, job);
  listener.listen("", 0, [&](const Event& event) {
    if (event.name == "progress" && json::parse(event.data).contains("question")) desk.cancel(job);
  });
  EXPECT_EQ(listener.events.back().name, "cancelled");
  EXPECT_EQ(listener.last()["done"], 0);
}

/// Queries that differ, some of them no good.
std::vector<std::string> some_queries(int count) {
  std::vector<std::string> queries;
  for (int i = 0; i < count; ++i)
    queries.push_back(i % 100 == 7
                          ? R"({"id": "]}", "query": 5})"
                          : R"({"id": )" + std::to_string(i) + R"(, "query": "inverse", "pose": {"x": )" +
                                std::to_string(i * 1e-6) + R"(, "y": 0, "phi": 1e-1}})");
  return queries;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ",") + text;
  return all;
}

std::string answers_of_a_session(const std::string& robot, std::vector<std::string> queries) {
  auto session = Session::open(robot).value();
  for (std::string& query : queries) query = session.answer(query);
  return joined(queries);
}

TEST(JobHttp, AnswersAreThoseOfASession) {
  JobDesk desk;
  const auto queries = some_queries(2000);
  Listener listener(desk.port, desk.queries("3-rfr", joined(queries)));
  listener.listen();
  EXPECT_EQ(listener.answers(), answers_of_a_session("3-rfr", queries));
  EXPECT_EQ(listener.events.back().name, "done");
  EXPECT_EQ(listener.last()["answers"], 2000);
}

TEST(JobHttp, WhoComesBackMissesNothingAndGetsNothingTwice) {
  JobDesk desk;
  const auto queries = some_queries(5000);  // megabytes of answers: many events
  Listener listener(desk.port, desk.queries("3-rfr", joined(queries)));
  int times = 0;
  for (; listener.events.empty() || listener.events.back().name != "done"; ++times)
    listener.listen("answers", 1);
  EXPECT_GT(times, 3);
  EXPECT_EQ(listener.answers(), answers_of_a_session("3-rfr", queries));
  EXPECT_EQ(std::ranges::count(listener.events, "done", &Event::name), 1);
}

TEST(JobHttp, ASweepThatIsCancelledEndsAmidItsSamples) {
  JobDesk desk;
  const std::string job = desk.study("3pfs-g1-loads");
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/result")), "409 not_done");
  Listener listener(desk.port, job);
  listener.listen("", 0, [&](const Event& event) {
    if (event.name == "progress" && json::parse(event.data)["done"] > 0) desk.cancel(job);
  });
  EXPECT_EQ(desk.status, 200);
  EXPECT_EQ(listener.events.back().name, "cancelled");
  EXPECT_LT(listener.last()["done"], listener.last()["total"]);
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/result")), "404 no_result");
}

TEST(JobHttp, AJobThatEndedIsForgottenWhenCancelled) {
  JobDesk desk;
  const std::string job = desk.queries("3-rfr", "5");
  Listener(desk.port, job).listen();
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/result")), "404 no_result");
  desk.cancel(job);
  EXPECT_EQ(desk.status, 200);
  EXPECT_EQ(desk.code(desk.cancel(job)), "404 unknown_job");
}

TEST(JobHttp, AnswersThatWereGivenStayWhenCancelled) {
  JobDesk desk;
  const std::string job = desk.endless();
  ASSERT_EQ(desk.status, 200);
  Listener listener(desk.port, job);
  listener.listen("", 0, [&](const Event& event) {
    if (event.name == "answers") desk.cancel(job);
  });
  EXPECT_EQ(listener.events.back().name, "cancelled");
  std::size_t answers = 0;
  for (const Event& event : listener.events)
    if (event.name == "answers") answers += json::parse(event.data)["answers"].size();
  EXPECT_EQ(listener.last()["done"], answers);
}

TEST(JobHttp, NoMoreRunThanMay) {
  Options options;
  options.limits.jobs.running = 1;
  JobDesk desk(options);
  const std::string job = desk.endless(), small = R"({"study": "3pfs-g1-parasitic"})";
  EXPECT_EQ(desk.code(desk.post("/api/jobs", small)), "503 busy");
  desk.cancel(job);
  Listener(desk.port, job).listen();  // to its end
  Listener next(desk.port, desk.start(small));
  next.listen();
  EXPECT_EQ(next.events.back().name, "done");
}

TEST(JobHttp, RefusesWithAReason) {
  Options options;
  options.limits.body = 500;
  options.limits.jobs.body = 1000;
  options.limits.jobs.queries = 3;
  JobDesk desk(options);
  const auto refused = [&](const std::string& body, const char* type = as_json) {
    return desk.code(desk.post("/api/jobs", body, type));
  };
  EXPECT_EQ(refused("text"), "400 json_syntax");
  EXPECT_EQ(refused(R"({"study": "3-rfr-workspace", "threads": 9})"), "400 unknown_field");
  EXPECT_EQ(refused(R"({"study": "studies/3-rfr-workspace.yaml"})"), "404 unknown_study");
  EXPECT_EQ(refused(R"({"study": "/etc/passwd"})"), "404 unknown_study");
  EXPECT_EQ(refused(R"({"robot": "0", "queries": [5]})"), "404 unknown_robot");
  EXPECT_EQ(refused(R"({"robot": "0", "queries": [5,5,5,5]})"), "413 too_large");
  EXPECT_EQ(refused(std::string(600, ' ')), "400 json_syntax");
  EXPECT_EQ(refused(std::string(1001, ' ')), "413 too_large");
  EXPECT_EQ(refused(R"({"study": "3-rfr-workspace"})", "text/plain"), "415 wrong_type");
  desk.post("/api/robot", std::string(501, ' '), as_yaml);  // whose limit is not that of jobs
  EXPECT_EQ(desk.status, 413);
  for (const char* path : {"/api/jobs/0/events", "/api/jobs//events", "/api/jobs/0/result"})
    EXPECT_EQ(desk.code(desk.get(path)), "404 unknown_job") << path;
  EXPECT_EQ(desk.code(desk.cancel("0")), "404 unknown_job");
  const std::string job = desk.study("3pfs-g1-parasitic");
  for (const char* event : {"x", "-1", "7", "99999999999999999999", "0 "})
    EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/events", {{"Last-Event-ID", event}})),
              event == std::string("0 ") ? "200 " : "400 unknown_event")  // httplib trims
        << event;
}

TEST(JobHttp, MoreJobsThanAllowedInASecondAreTold) {
  Options options;
  options.limits.rate = 1;
  JobDesk desk(options);
  desk.study("3pfs-g1-parasitic");
  EXPECT_EQ(desk.status, 200);
  EXPECT_EQ(desk.code(desk.post("/api/jobs", R"({"study": "3pfs-g1-parasitic"})")), "429 too_many");
}

TEST(JobHttp, PagesOfOtherSitesStartAndCancelNothing) {
  JobDesk desk;
  const std::string job = desk.endless();
  const httplib::Headers foreign{{"Origin", "http://evil.example"}}, renamed{{"Host", "evil.example"}};
  const auto posted = desk.client.Post("/api/jobs", foreign, R"({"study": "3-rfr-workspace"})", as_json);
  ASSERT_TRUE(posted);
  EXPECT_EQ(posted->status, 403);
  EXPECT_EQ(desk.code(desk.cancel(job, foreign)), "403 foreign_origin");
  EXPECT_EQ(desk.code(desk.cancel(job, renamed)), "403 foreign_host");
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/events", foreign)), "403 foreign_origin");
  const auto preflight = desk.client.Options("/api/jobs/" + job, foreign);
  ASSERT_TRUE(preflight);
  EXPECT_EQ(preflight->status, 405);
  EXPECT_FALSE(preflight->has_header("Access-Control-Allow-Origin"));
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/result")), "409 not_done");  // it runs
}

TEST(JobHttp, OnlyJobsAreDeleted) {
  JobDesk desk;
  for (const char* path : {"/api/jobs", "/api/jobs/0/events", "/api/robot", "/", "/api/robots/3-rfr"}) {
    const auto answer = desk.client.Delete(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 405) << path;
  }
}

TEST(JobHttp, OfTheTokenTheSameHolds) {
  Options options;
  options.address = "0.0.0.0";
  JobDesk desk(options);
  httplib::Client stranger("127.0.0.1", desk.port);
  EXPECT_EQ(stranger.Post("/api/jobs", R"({"study": "3-rfr-workspace"})", as_json)->status, 403);
  EXPECT_EQ(stranger.Get("/api/jobs/0/events")->status, 403);
  EXPECT_EQ(stranger.Delete("/api/jobs/0")->status, 403);
}

TEST(JobHttp, AClientThatDisappearsKeepsNoJob) {
  Options options;
  options.limits.jobs.running = 1;
  options.limits.jobs.patience = 0.2;
  options.limits.jobs.heart_beat = 0.05;
  JobDesk desk(options);
  const std::string job = desk.endless();
  Listener listener(desk.port, job);
  listener.listen("answers", 3);                                                      // and away
  while (desk.study("3pfs-g1-parasitic").empty()) std::this_thread::sleep_for(20ms);  // its place is free
  listener.listen();
  EXPECT_EQ(listener.events.back().name, "cancelled");
}

TEST(JobHttp, TheServerEndsWhileAJobRunsAndIsListenedTo) {
  std::vector<std::thread> listeners;
  std::atomic<int> hearing = 0, left = 0;
  {
    JobDesk desk;
    const std::string job = desk.endless();
    desk.study("3pfs-g1-loads");
    for (int i = 0; i < 4; ++i)
      listeners.emplace_back([&, port = desk.port] {
        Listener listener(port, job);
        listener.listen("", 0, [&, is_first = true](const Event&) mutable {
          if (std::exchange(is_first, false)) ++hearing;
        });
        left += listener.events.back().name != "done";
      });
    while (hearing < 4) std::this_thread::sleep_for(1ms);
  }
  for (std::thread& listener : listeners) listener.join();
  EXPECT_EQ(left, 4);
}

TEST(JobHttp, QueriesAreAnsweredWhileJobsRunAndManyListen) {
  Options options;
  options.limits.threads = 8;
  options.limits.jobs.streams = 4;
  JobDesk desk(options);
  const std::string job = desk.endless();
  desk.study("3pfs-g1-loads");
  std::atomic<int> hearing = 0;
  std::vector<std::thread> listeners;
  for (int i = 0; i < 4; ++i)
    listeners.emplace_back([&] {
      Listener listener(desk.port, job);
      listener.listen("", 0, [&, is_first = true](const Event&) mutable {
        if (std::exchange(is_first, false)) ++hearing;
      });
      EXPECT_EQ(listener.events.back().name, "cancelled");
    });
  while (hearing < 4) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(desk.code(desk.get("/api/jobs/" + job + "/events")), "503 busy");
  const std::string path = "/api/query?robot=" + desk.opened("3-rfr");
  const auto queries = some_queries(500);
  EXPECT_EQ(desk.post(path, '[' + joined(queries) + ']'), '[' + answers_of_a_session("3-rfr", queries) + ']');
  desk.cancel(job);
  for (std::thread& listener : listeners) listener.join();
}

}  // namespace job_http_test
}  // namespace sinew::server
