/// @file desk.hpp
/// A server on a free port, and a client of it. To be included last: httplib defines _res, which Eigen uses.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "server/server.hpp"
#include "sinew/io/robot_file.hpp"
// It defines _res, which Eigen uses: last.
#include <httplib.h>

namespace sinew::server {

using nlohmann::json;

inline constexpr const char* as_json = "application/json";
inline constexpr const char* as_yaml = "text/yaml";

struct Desk {
  explicit Desk(Options options = {}) : server(open(options)), thread([this] { server.run(); }) {
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
  }
  ~Desk() {
    client.stop();  // the server waits for connections to end
    server.stop();
    thread.join();
  }
  static Server open(Options& options) {
    options.port = 0;
    return Server::open(options).value();
  }
  static int port_of(const std::string& url) { return std::stoi(url.substr(url.rfind(':') + 1)); }

  std::string post(const std::string& path, const std::string& body, const char* type = as_json) {
    const auto answer = client.Post(path, body, type);
    status = answer ? answer->status : -1;
    return answer ? answer->body : "";
  }
  std::string get(const std::string& path, const httplib::Headers& headers = {}) {
    const auto answer = client.Get(path, headers);
    status = answer ? answer->status : -1;
    return answer ? answer->body : "";
  }
  std::string opened(const std::string& name) {
    return json::parse(post("/api/robot", read_robot_text(name).value(), as_yaml))["robot"];
  }

  Server server;
  int port = port_of(server.url());
  std::thread thread;
  httplib::Client client{"127.0.0.1", port};
  int status = 0;
};

}  // namespace sinew::server
