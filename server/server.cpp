/// HTTP: which call answers which request.
#include "server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>

#include "assets.hpp"
#include "calls.hpp"
#include "guard.hpp"
// It has httplib: last.
#include "http/listener.hpp"

namespace sinew::server {
namespace {

using httplib::Request;
using httplib::Response;

/// @param is_framed by pages of this machine, at any port; else by none: what a page lies over could be
/// clicked unseen
std::string policy(bool is_framed) {
  return fmt::format(
      "default-src 'self'; img-src 'self' blob: data:; media-src 'self' blob:; style-src 'self'; "
      "base-uri 'none'; form-action 'none'; frame-ancestors {}; object-src 'none'",
      is_framed ? "http://127.0.0.1:* http://localhost:*" : "'none'");
}

/// As it is: httplib would compress what it is given as a text, each time.
void put_bytes(Response& response, std::string_view text, std::string_view type,
               std::shared_ptr<const void> owner = {}) {
  response.set_content_provider(
      text.size(), std::string(type).c_str(),
      [text, owner = std::move(owner)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(text.data() + offset, length);
      });
}

void put(Response& response, Reply reply) {
  response.status = reply.status;
  if (reply.status == 429 || reply.status == 503) response.set_header("Retry-After", "1");
  const auto text =
      reply.kept ? std::move(reply.kept) : std::make_shared<const std::string>(std::move(reply.text));
  if (!text->empty())
    put_bytes(response, *text, reply.type, text);  // httplib never ends a content of no length
}

/// False where it does not come whole, or does not fit. What is left of it closes the connection.
bool read_body(const httplib::ContentReader& reader, std::size_t most, std::string& body, bool& fits) {
  return reader([&](const char* bytes, std::size_t count) {
    fits = count <= most - body.size();
    if (fits) body.append(bytes, count);
    return fits;
  });
}

Reply full() { return refused(503, "busy", "server", "too much is under way; try again"); }

bool has_type(const Request& request, std::string_view type) {
  const std::string given = request.get_header_value("Content-Type");
  return given.substr(0, given.find(';')) == type;
}

/// A parameter that counts: 0 where there is none, −1 where it is no number from 1 on.
int whole_of(const Request& request, const char* name) {
  if (!request.has_param(name)) return 0;
  const std::string text = request.get_param_value(name);
  int number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && number > 0 ? number : -1;
}

Reply refusal(Refusal why) {
  switch (why) {
    case Refusal::foreign_host:
      return refused(403, "foreign_host", "Host", "open the address printed by sinew serve");
    case Refusal::foreign_origin:
      return refused(403, "foreign_origin", "Origin", "only the page of this server asks here");
    case Refusal::no_token:
      return {403, "open the address printed by sinew serve\n", "text/plain; charset=utf-8"};
    case Refusal::none:
      break;
  }
  return {};
}

/// The path of a job itself.
bool is_job(std::string_view path) {
  constexpr std::string_view jobs = "/api/jobs/";
  return path.starts_with(jobs) && path.find('/', jobs.size()) == std::string_view::npos;
}

/// A part of a stream; false ends the connection at once.
bool send_events(Stream& stream, httplib::DataSink& sink) {
  const std::string text = stream.next();
  if (stream.is_broken() || !sink.is_writable()) return false;  // not even a last line: the client is gone
  if (!text.empty() && !sink.write(text.data(), text.size())) return false;
  if (stream.has_ended()) sink.done();
  return true;
}

bool send_feed(device::FeedStream& stream, httplib::DataSink& sink) {
  const std::string text = stream.next();
  if (stream.is_broken() || !sink.is_writable()) return false;
  return text.empty() || sink.write(text.data(), text.size());
}

bool takes_gzip(const Request& request) {
  return request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
}

std::string bracketed(const std::string& address) {
  return address.find(':') == std::string::npos ? address : '[' + address + ']';
}

}  // namespace

struct Server::State {
  using Body = Reply (State::*)(const Request&, const std::string& body);
  using Plain = Reply (State::*)(const Request&);

  explicit State(const Options& chosen)
      : options(chosen),
        calls(chosen),
        room(chosen.limits.held),
        http(chosen.limits) {}

  Expected<int> bind();
  void route();
  void route_page();
  Reply kept(Reply reply);
  void get(const char* pattern, Plain call);
  void post(const char* pattern, std::vector<std::string_view> types, std::size_t most, Body call);
  void route_jobs();
  void route_device();
  void route_recordings();
  void show_device(Response& response);
  void show_events(const Request& request, Response& response);
  void limit();
  /// Whether the request may go on; else the response says why not. Before any of its body is read.
  bool lets_in(const Request& request, Response& response) const;
  bool brings_token(const Request& request) const;
  void show(const Asset& asset, const Request& request, Response& response) const;

  Reply on_version(const Request&) { return calls.version(); }
  Reply on_robots(const Request&) { return calls.robots(); }
  Reply on_robot_text(const Request& request) { return calls.robot_text(request.matches[1]); }
  Reply on_plans(const Request&) { return calls.plans(); }
  Reply on_plan(const Request& request) { return calls.plan(request.matches[1].str()); }
  Reply on_meshes(const Request& request) { return calls.meshes(request.matches[1].str()); }
  Reply on_robot(const Request&, const std::string& body) { return calls.open_robot(body); }
  Reply on_query(const Request& request, const std::string& body) {
    return calls.query(request.get_param_value("robot"), body, request.remote_addr,
                       [client = Listener::current()] { return client->is_gone(); });
  }
  Reply on_job(const Request& request, const std::string& body) {
    return calls.jobs().start(body, request.remote_addr);
  }
  Reply on_device(const Request&) { return calls.device(); }
  Reply on_device_plan(const Request&) { return calls.device_plan(); }
  Reply on_device_post(const Request& request, const std::string& body) {
    return calls.device_post(request.matches[1].str(), body);
  }
  Reply on_snapshot(const Request& request, const std::string& body) {
    return calls.snapshot(has_type(request, "image/jpeg"), request.get_param_value("text"), body);
  }
  Reply on_recordings(const Request&) { return calls.recordings(); }
  Reply on_recording(const Request& request) {
    return calls.recording(request.matches[1].str(), whole_of(request, "every"));
  }
  Reply on_recorded_picture(const Request& request) {
    return calls.recorded_picture(request.matches[1].str(), request.matches[2].str());
  }
  Reply on_result(const Request& request) { return calls.jobs().result(request.matches[1].str()); }
  Reply on_nothing(const Request&) { return refused(404, "not_found", "path", "nothing is here"); }

  Options options;
  Calls calls;
  std::optional<Guard> guard;
  std::string url;
  Room room;
  Listener http;
};

bool Server::State::lets_in(const Request& request, Response& response) const {
  const auto header = [&](const char* name) { return request.get_header_value(name); };
  const std::string host = header("Host"), origin = header("Origin"), cookie = header("Cookie"),
                    authorization = header("Authorization");
  const Refusal why =
      brings_token(request) ? Refusal::none : guard->judge({host, origin, cookie, authorization});
  if (why != Refusal::none) put(response, refusal(why));
  return why == Refusal::none;
}

/// In the address that was printed.
bool Server::State::brings_token(const Request& request) const {
  return request.path == "/" && request.method == "GET" && !guard->token().empty() &&
         request.has_param("token") && guard->accepts(request.get_param_value("token"));
}

void Server::State::get(const char* pattern, Plain call) {
  http.Get(pattern, [this, call](const Request& request, Response& response) {
    put(response, kept((this->*call)(request)));
  });
}

void Server::State::post(const char* pattern, std::vector<std::string_view> types, std::size_t most,
                         Body call) {
  http.Post(pattern, [this, types = std::move(types), most, call](const Request& request, Response& response,
                                                                  const httplib::ContentReader& reader) {
    if (std::ranges::none_of(types, [&](std::string_view type) { return has_type(request, type); }))
      return put(response, refused(415, "wrong_type", "Content-Type",
                                   fmt::format("it has to be {}", fmt::join(types, " or "))));
    const std::size_t sent = Listener::current()->left();
    const auto held = room.take(request.has_header("Content-Encoding") ? most : sent);
    if (!held) return put(response, full());
    std::string body;
    bool fits = sent <= most;
    const bool is_whole = fits && read_body(reader, most, body, fits);
    if (!fits)
      return put(response, refused(413, "too_large", "body", fmt::format("give at most {} bytes", most)));
    if (!is_whole)
      return put(response, refused(400, "bad_request", "body",
                                   fmt::format("send all of it within {} s, packed by gzip or not at all",
                                               options.limits.reading)));
    put(response, kept((this->*call)(request, body)));
  });
}

/// A large answer takes part of the room until its client has it.
Reply Server::State::kept(Reply reply) {
  constexpr std::size_t large = std::size_t{64} << 10U;
  if (reply.text.size() < large) return reply;
  auto held = room.take(reply.text.size());
  if (!held) return full();
  struct Kept {
    std::string text;
    std::shared_ptr<const void> held;
  };
  const auto owner = std::make_shared<const Kept>(Kept{std::move(reply.text), std::move(held)});
  return {reply.status, {}, reply.type, {owner, &owner->text}};
}

void Server::State::show(const Asset& asset, const Request& request, Response& response) const {
  const bool is_small = !asset.gzip.empty() && takes_gzip(request);
  if (!asset.gzip.empty()) response.set_header("Vary", "Accept-Encoding");
  if (is_small) response.set_header("Content-Encoding", "gzip");
  put_bytes(response, is_small ? asset.gzip : asset.bytes, asset.type);
}

/// The page's files. The address that was printed has the token; the page goes on with a cookie in its place.
void Server::State::route_page() {
  for (const Asset& asset : assets())
    http.Get(std::string(asset.path), [this, &asset](const Request& request, Response& response) {
      if (brings_token(request)) {
        response.set_header("Set-Cookie",
                            fmt::format("sinew_token={}; HttpOnly; SameSite=Strict; Path=/", guard->token()));
        return response.set_redirect("/");
      }
      show(asset, request, response);
    });
}

/// Not compressed by httplib, and nothing kept back: it knows this type.
void Server::State::show_events(const Request& request, Response& response) {
  const auto stream =
      calls.jobs().listen(request.matches[1].str(), request.get_header_value("Last-Event-ID"));
  if (!stream) return put(response, stream.error());
  response.status = 200;
  response.set_chunked_content_provider(
      "text/event-stream",
      [stream = *stream](std::size_t, httplib::DataSink& sink) { return send_events(*stream, sink); });
}

void Server::State::route_jobs() {
  post("/api/jobs", {"application/json"}, options.limits.jobs.body, &State::on_job);
  http.Get("/api/jobs/([^/]*)/events",
           [this](const Request& request, Response& response) { show_events(request, response); });
  get("/api/jobs/([^/]*)/result", &State::on_result);
  http.Delete("/api/jobs/([^/]*)",
              [this](const Request& request, Response& response, const httplib::ContentReader&) {
                put(response, calls.jobs().cancel(request.matches[1].str()));
              });
}

void Server::State::show_device(Response& response) {
  const auto stream = calls.device_events();
  if (!stream) return put(response, stream.error());
  response.status = 200;
  response.set_chunked_content_provider(
      "text/event-stream",
      [stream = *stream](std::size_t, httplib::DataSink& sink) { return send_feed(*stream, sink); });
}

void Server::State::route_device() {
  constexpr std::size_t most = std::size_t{16} << 10U;    // [bytes] of a command
  constexpr std::size_t picture = std::size_t{8} << 20U;  // [bytes] of a snapshot
  get("/api/device", &State::on_device);
  post("/api/device/snapshot", {"image/jpeg", "image/png"}, picture, &State::on_snapshot);
  http.Get("/api/device/events", [this](const Request&, Response& response) { show_device(response); });
  get("/api/device/plan", &State::on_device_plan);
  post("/api/device/(plan)", {"application/json"}, options.limits.body, &State::on_device_post);
  post("/api/device/([^/]*)", {"application/json"}, most, &State::on_device_post);
}

void Server::State::route_recordings() {
  get("/api/recordings", &State::on_recordings);
  get("/api/recordings/([^/]*)", &State::on_recording);
  get("/api/recordings/([^/]*)/snapshots/([^/]*)", &State::on_recorded_picture);
}

void Server::State::route() {
  get("/api/version", &State::on_version);
  get("/api/robots", &State::on_robots);
  get("/api/robots/([^/]*)", &State::on_robot_text);
  get("/api/plans", &State::on_plans);
  get("/api/plans/([^/]*)", &State::on_plan);
  get("/api/plans/([^/]*)/meshes", &State::on_meshes);
  post("/api/robot", {"text/yaml"}, options.limits.body, &State::on_robot);
  post("/api/query", {"application/json"}, options.limits.body, &State::on_query);
  route_jobs();
  route_device();
  route_recordings();
  route_page();
  get(".*", &State::on_nothing);
  http.Post(".*", [this](const Request& request, Response& response, const httplib::ContentReader&) {
    put(response, on_nothing(request));
  });
}

void Server::State::limit() {
  http.set_pre_routing_handler([this](const Request& request, Response& response) {
    using enum httplib::Server::HandlerResponse;
    const bool is_answered = request.method == "GET" || request.method == "HEAD" ||
                             request.method == "POST" || (request.method == "DELETE" && is_job(request.path));
    if (!is_answered)
      put(response,
          refused(405, "not_available", "method", "GET and POST are answered, and DELETE of a job"));
    return is_answered && lets_in(request, response) ? Unhandled : Handled;
  });
  http.set_default_headers({{"Content-Security-Policy", policy(options.is_framed)},
                            {"Permissions-Policy", "camera=(self), serial=()"},
                            {"X-Content-Type-Options", "nosniff"},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"Cross-Origin-Opener-Policy", "same-origin"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cache-Control", "no-store"}});
  http.set_payload_max_length(std::max(options.limits.body, options.limits.jobs.body));
  http.set_tcp_nodelay(true);
  http.set_socket_options([](socket_t socket) {  // not SO_REUSEPORT: a second server is to be told
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

Expected<int> Server::State::bind() {
  errno = 0;
  const bool is_any = options.port == 0;
  const int port = is_any ? http.bind_to_any_port(options.address)
                          : (http.bind_to_port(options.address, options.port) ? options.port : -1);
  if (port > 0) {
    http.widen();
    return port;
  }
  if (errno == EADDRINUSE)
    return failure(
        "address_in_use", "--port",
        fmt::format("port {} is taken; give another one, or 0 for any that is free", options.port));
  return failure("bad_address", "--host",
                 fmt::format("nothing can listen on {} port {}{}{}", options.address, options.port,
                             errno ? ": " : "", errno ? std::strerror(errno) : ""));
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;
Server::~Server() = default;

Expected<Server> Server::open(const Options& options) {
  if (options.is_framed && !is_loopback(options.address))
    return failure("not_available", "--frame",
                   "a frame shows the page of this machine's own address alone; leave --host or --frame out");
  auto state = std::make_unique<State>(options);
  if (const auto errors = state->calls.read_opened()) return tl::unexpected(*errors);
  state->limit();
  const auto port = state->bind();
  if (!port) return tl::unexpected(port.error());
  state->guard.emplace(options.address, *port);
  state->url = fmt::format("http://{}:{}/", bracketed(options.address), *port);
  if (!state->guard->token().empty()) state->url += "?token=" + state->guard->token();
  state->route();
  return Server(std::move(state));
}

const std::string& Server::url() const { return state_->url; }

void Server::run() { state_->http.run(); }

void Server::let_go() { state_->calls.let_go(); }

void Server::stop() {
  state_->calls.stop();
  state_->http.stop();
}

}  // namespace sinew::server
