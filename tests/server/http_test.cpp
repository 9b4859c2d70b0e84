/// The server on a socket: what a page gets, what others do not, and what nobody can break.
#include "server/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "io/document/parse.hpp"
#include "sanitizers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"
#include "thorough.hpp"
#include "wire.hpp"
// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace http_test {

constexpr const char* inverse = R"({"id": 7, "query": "inverse", "pose": {"x": 0.01, "y": 0, "phi": 0}})";

TEST(Http, AnswersAreThoseOfASession) {
  Desk desk;
  for (const std::string_view name : builtin_robot_names()) {
    const std::string path = "/api/query?robot=" + desk.opened(std::string(name)),
                      query = R"({"query": "describe"})";
    auto session = Session::open(std::string(name)).value();
    EXPECT_EQ(desk.post(path, query), session.answer(query)) << name;
    EXPECT_EQ(desk.status, 200);
  }
  const std::string path = "/api/query?robot=" + desk.opened("3-rfr");
  auto session = Session::open("3-rfr").value();
  const std::string one = session.answer(inverse), bad = session.answer("5");
  EXPECT_EQ(desk.post(path, std::string("[") + inverse + ", 5, " + inverse + "]"),
            "[" + one + "," + bad + "," + one + "]");
}

TEST(Http, RobotsAndTheirTextsAreListed) {
  Options options;
  options.robot = "3-frr";
  Desk desk(options);
  const json list = json::parse(desk.get("/api/robots"));
  EXPECT_EQ(list["robots"].size(), builtin_robot_names().size());
  EXPECT_EQ(list["opened"]["name"], "3-frr");
  for (const json& robot : list["robots"]) {
    EXPECT_FALSE(robot["title"].get<std::string>().empty());
    EXPECT_EQ(desk.get("/api/robots/" + robot["name"].get<std::string>()),
              read_robot_text(robot["name"].get<std::string>()).value());
  }
  EXPECT_EQ(json::parse(desk.get("/api/version"))["protocol"], 1);
}

/// The page opens with the text that settings change, and is told what they are.
TEST(Http, TheRobotOfTheCommandLineMayBeChanged) {
  Options options;
  options.robot = "3-rfr";
  options.settings = {{.key = "legs[0].link.length", .value = make_node("180 mm")},
                      {.key = "legs[0].base.point", .value = parse_yaml("[-0.1, 0]", "").value().root}};
  Desk desk(options);
  const json opened = json::parse(desk.get("/api/robots"))["opened"];
  EXPECT_EQ(opened["name"], "3-rfr");
  EXPECT_EQ(opened["text"], read_robot_text("3-rfr").value());
  EXPECT_EQ(opened["changed"]["set"],
            json::array({"legs[0].link.length=180 mm", "legs[0].base.point=[-0.1, 0]"}));
  const std::string handle =
      json::parse(desk.post("/api/robot", opened["changed"]["text"], as_yaml))["robot"];
  const json answer = json::parse(desk.post("/api/query?robot=" + handle, R"({"query": "describe"})"));
  EXPECT_EQ(answer["legs"][0]["link"]["length"], 0.18);
  Session session = Session::open("3-rfr").value();
  EXPECT_EQ(answer,
            json::parse(session.answer(R"({"query": "describe", "set": {"legs[0].link.length": "180 mm",)"
                                       R"( "legs[0].base.point": [-0.1, 0]}})")));
  EXPECT_TRUE(json::parse(Desk().get("/api/robots"))["opened"].is_null());
}

TEST(Http, SettingsThatMakeNoRobotAreRefused) {
  Options options;
  options.port = 0;
  options.robot = "3-rfr";
  options.settings = {{.key = "legs[0].link.length", .value = make_node("180 kg")}};
  const auto bad_unit = Server::open(options);
  ASSERT_FALSE(bad_unit);
  EXPECT_EQ(bad_unit.error().front().code, "wrong_dimension");
  options.settings = {{.key = "legs[0].link.lenght", .value = make_node(0.18)}};
  ASSERT_FALSE(Server::open(options));
  EXPECT_EQ(Server::open(options).error().front().where.find("yaml:"), std::string::npos);
}

TEST(Http, ErrorsOfAFileHaveTheirPlaces) {
  Desk desk;
  const json answer = json::parse(desk.post("/api/robot", "sinew: 1\nname: x\nspace: plane\n", as_yaml));
  EXPECT_EQ(desk.status, 422);
  bool has_place = false;
  for (const json& error : answer["errors"])
    has_place |= error.value("line", 0) == 3 && error.value("column", 0) == 8 && error.contains("message");
  EXPECT_TRUE(has_place) << answer;
}

TEST(Http, RefusesWithAReason) {
  Desk desk;
  const std::string path = "/api/query?robot=" + desk.opened("3-rfr");
  const auto code = [&](const std::string& text) {
    const json answer = json::parse(text, nullptr, false);
    return std::to_string(desk.status) + ' ' +
           (answer.contains("error") ? answer["error"]["code"].get<std::string>() : "");
  };
  EXPECT_EQ(code(desk.post("/api/query?robot=0", inverse)), "404 unknown_robot");
  EXPECT_EQ(code(desk.post("/api/query", inverse)), "404 unknown_robot");
  EXPECT_EQ(code(desk.post(path, "text")), "400 json_syntax");
  EXPECT_EQ(code(desk.post(path, "[]")), "400 json_syntax");
  EXPECT_EQ(code(desk.post(path, inverse, "text/plain")), "415 wrong_type");
  std::string many = "[5";
  for (int i = 0; i < 1000; ++i) many += ",5";
  EXPECT_EQ(code(desk.post(path, many + "]")), "413 too_large");
  EXPECT_EQ(code(desk.get("/api/robots/none")), "404 unknown_robot");
  EXPECT_EQ(code(desk.get("/api/robots/..%2f..%2fetc%2fpasswd")), "404 not_found");
  EXPECT_EQ(code(desk.get("/../../../etc/passwd")), "404 not_found");
  EXPECT_EQ(code(desk.get("/", {{"Host", "evil.example"}})), "403 foreign_host");
  EXPECT_EQ(code(desk.get("/api/version", {{"Origin", "http://evil.example"}})), "403 foreign_origin");
  const auto put = desk.client.Put("/api/query", "x", as_json);
  ASSERT_TRUE(put);
  EXPECT_EQ(put->status, 405);
}

TEST(Http, BodiesThatAreTooLargeAreRefused) {
  Options options;
  options.limits.body = 1000;
  Desk desk(options);
  desk.post("/api/robot", std::string(1001, ' '), as_yaml);
  EXPECT_EQ(desk.status, 413);
  const std::string zeros(1U << 24U, ' ');  // compressed it is small
  desk.client.set_compress(true);
  desk.post("/api/robot", zeros.substr(0, 500'000), as_yaml);
  EXPECT_EQ(desk.status, 413);
  desk.client.set_compress(false);
  EXPECT_NE(desk.get("/api/version"), "");
}

TEST(Http, PageAndPolicy) {
  Desk desk;
  const auto page = desk.client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'self'"), std::string::npos);
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_NE(page->get_header_value("Permissions-Policy").find("camera=(self)"), std::string::npos);
}

TEST(Http, FramesAreOfPagesOfThisMachineWhereTheyAreAskedFor) {
  const auto policy = [](Options options) {
    return Desk(std::move(options)).client.Get("/")->get_header_value("Content-Security-Policy");
  };
  EXPECT_NE(policy({}).find("; frame-ancestors 'none';"), std::string::npos);
  Options framed;
  framed.is_framed = true;
  EXPECT_NE(policy(framed).find("; frame-ancestors http://127.0.0.1:* http://localhost:*;"),
            std::string::npos);
  framed.address = "0.0.0.0";
  const auto open = Server::open(framed);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error()[0].code, "not_available");
}

TEST(Http, OtherAddressesNeedTheToken) {
  Options options;
  options.address = "0.0.0.0";
  options.port = 0;
  Server server = Server::open(options).value();
  std::thread thread([&] { server.run(); });
  const std::string& url = server.url();
  const std::string token = url.substr(url.find("token=") + 6);
  httplib::Client client("127.0.0.1", Desk::port_of(url.substr(0, url.find("/?"))));
  EXPECT_EQ(client.Get("/")->status, 403);
  EXPECT_EQ(client.Get("/api/version")->status, 403);
  EXPECT_EQ(client.Get("/?token=0")->status, 403);
  const auto entered = client.Get("/?token=" + token);
  EXPECT_EQ(entered->status, 302);
  const std::string cookie = entered->get_header_value("Set-Cookie");
  EXPECT_NE(cookie.find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(client.Get("/api/version", {{"Cookie", cookie.substr(0, cookie.find(';'))}})->status, 200);
  EXPECT_EQ(client.Get("/api/version", {{"Authorization", "Bearer " + token}})->status, 200);
  server.stop();
  thread.join();
}

TEST(Http, ATakenPortIsTold) {
  Desk desk;
  Options options;
  options.port = desk.port;
  const auto second = Server::open(options);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error()[0].code, "address_in_use");
}

TEST(Http, MoreQueriesThanAllowedAreTold) {
  Options options;
  options.limits.rate = 10;
  Desk desk(options);
  const std::string path = "/api/query?robot=" + desk.opened("3-rfr");
  desk.post(path, "[5,5,5,5,5,5]");
  EXPECT_EQ(desk.status, 200);
  desk.post(path, "[5,5,5,5,5,5]");
  EXPECT_EQ(desk.status, 429);
}

long resident_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmRSS:") {
      long kilobytes = 0;
      status >> kilobytes;
      return kilobytes;
    }
  return 0;
}

/// 20 clients at once, each its robot; answers that differ from the first one are errors.
int errors_of_clients(Desk& desk, int rounds) {
  std::atomic<int> errors = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 20; ++i)
    clients.emplace_back([&, i] {
      Desk* shared = &desk;
      httplib::Client client("127.0.0.1", shared->port);
      client.set_keep_alive(true);
      client.set_tcp_nodelay(true);
      const auto made =
          client.Post("/api/robot", read_robot_text(i % 2 ? "3-rfr" : "3-frr").value(), as_yaml);
      if (!made) {
        ++errors;
        return;
      }
      const std::string path = "/api/query?robot=" + json::parse(made->body)["robot"].get<std::string>();
      const auto asked = client.Post(path, inverse, as_json);
      const std::string first = asked ? asked->body : "none";
      for (int k = 0; k < rounds; ++k) {
        const auto answer = client.Post(path, inverse, as_json);
        if (!answer || answer->status != 200 || answer->body != first) ++errors;
      }
    });
  for (std::thread& client : clients) client.join();
  return errors;
}

const int many = test::is_instrumented ? 50 : test::count_of(2000, 5000);

TEST(Http, TwentyClientsGetTheirAnswersInFlatMemory) {
  Desk desk;
  EXPECT_EQ(errors_of_clients(desk, many / 5), 0);
  const long before = resident_kilobytes();
  EXPECT_EQ(errors_of_clients(desk, many), 0);
  EXPECT_GT(before, 0);
  if (!test::is_instrumented) {
    EXPECT_LT(resident_kilobytes() - before, 4096);
  }
}

/// A request with something wrong: a line, a header, a length, a body, or bytes out of place.
class Malformed {
 public:
  Malformed(int port, std::string handle, unsigned seed)
      : host_("127.0.0.1:" + std::to_string(port)),
        handle_(std::move(handle)),
        random_(seed) {}

  std::string next() {
    std::string text = line() + "Host: " + host_ + "\r\n" + header() + body();
    if (pick(3) == 0) text.resize(pick(text.size()));
    for (std::size_t i = pick(8); i > 0 && !text.empty() && pick(2) == 0; --i)
      text[pick(text.size())] = static_cast<char>(pick(256));
    return text;
  }

 private:
  std::size_t pick(std::size_t count) { return count ? random_() % count : 0; }
  std::string some(const std::vector<std::string>& of) { return of[pick(of.size())]; }
  std::string line() {
    return some({"GET", "POST", "PUT", "HEAD", "DELETE", "OPTIONS", "PRI", "get", "X", "", "TRACE"}) + ' ' +
           some({"/", "/api/query?robot=" + handle_, "/api/robot", "/api/robots/../../etc/passwd",
                 "/api/robots/%2e%2e%2f%2e%2e%2fetc%2fpasswd", "//etc/passwd", "/%00", "/%", "/%ff?%=&&=&",
                 std::string(9000, 'a'), "/api/robots/" + std::string(7000, '.'), "file:///etc/passwd",
                 "*"}) +
           ' ' + some({"HTTP/1.1", "HTTP/1.0", "HTTP/9.9", "", "HTTP/1.1 x"}) +
           some({"\r\n", "\n", "\r\n", "\r\n"});
  }
  std::string header() {
    return some({"", "Content-Type: application/json\r\n", "Content-Type: text/yaml\r\n",
                 "Content-Type: multipart/form-data; boundary=\r\n",
                 "Content-Type: multipart/form-data; boundary=x\r\n",
                 "Content-Type: application/x-www-form-urlencoded\r\n",
                 "Range: bytes=" + std::string(3000, '0') + "-\r\n", "Range: bytes=0-0,-1,5-2\r\n",
                 "Content-Encoding: gzip\r\n", "Content-Encoding: br\r\n", "Transfer-Encoding: chunked\r\n",
                 std::string(9000, 'h') + ": 1\r\n", "Expect: 100-continue\r\n", ": \r\n"}) +
           some({"", "Content-Type: application/json\r\n", "Content-Type: text/yaml\r\n"}) +
           some({"", "Content-Length: 3\r\n", "Content-Length: -1\r\n",
                 "Content-Length: 99999999999999999999\r\n", "Content-Length: x\r\n",
                 "Content-Length: 20\r\nContent-Length: 2\r\n"}) +
           "Connection: close\r\n\r\n";
  }
  std::string body() {
    return some(
        {"", "{}", "[[[[[[", std::string(2000, '['), std::string(2000, '{'), "3\r\nabc\r\n0\r\n\r\n",
         "ffffffffffffffff\r\n",
         "--x\r\nContent-Disposition: form-data; name=\"a\"; filename=\"/etc/passwd\"\r\n\r\nb\r\n--x--",
         R"({"query": "forward", "inputs": [1e999]})", R"({"query": "describe", "set": {"a": {"b": [)",
         "sinew: 1\nname: &a [*a, *a]\n", "sinew: 1\nlegs: /etc/passwd\n", std::string(5000, '\xff')});
  }

  std::string host_, handle_;
  std::mt19937 random_;
};

const int malformed = test::is_instrumented ? 2000 : test::count_of(3000, 10'000);

TEST(Http, NothingMalformedBreaksItOrReadsAFile) {
  Desk desk;
  const std::string handle = desk.opened("3-rfr"), path = "/api/query?robot=" + handle;
  const std::string expected = desk.post(path, inverse);
  std::atomic<int> answered = 0, files = 0, wrong = 0;
  std::vector<std::thread> clients;
  for (unsigned seed = 0; seed < 8; ++seed)
    clients.emplace_back([&, seed] {
      Malformed requests(desk.port, handle, seed);
      httplib::Client client("127.0.0.1", desk.port);
      for (int i = 0; i < malformed / 8; ++i) {
        const std::string answer = raw(desk.port, requests.next());
        answered += answer.starts_with("HTTP/1.1 ");
        files += answer.find("root:") != std::string::npos;
        if (i % 100 != 0) continue;
        const auto good = client.Post(path, inverse, as_json);
        wrong += !good || good->body != expected;
      }
    });
  for (std::thread& client : clients) client.join();
  EXPECT_GT(answered, malformed / 8);
  EXPECT_EQ(files, 0);
  EXPECT_EQ(wrong, 0);
}

TEST(Http, ABodyThatIsRefusedIsNotTheNextRequest) {
  Desk desk;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n";
  const std::string hidden = "GET /api/version HTTP/1.1\r\n" + host + "\r\n";
  for (const char* path : {"/api/query", "/", "/nothing"}) {
    const std::string answer =
        raw(desk.port,
            "POST " + std::string(path) + " HTTP/1.1\r\n" + host +
                "Origin: http://evil.example\r\nContent-Type: text/plain\r\nContent-Length: " +
                std::to_string(hidden.size()) + "\r\n\r\n" + hidden,
            5000);
    EXPECT_NE(answer.find("403"), std::string::npos) << path << ": " << answer;
    EXPECT_EQ(answer.find("\"protocol\""), std::string::npos) << answer;
  }
}

}  // namespace http_test
}  // namespace sinew::server
