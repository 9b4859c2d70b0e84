#include "device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <ctime>
#include <utility>

#include "io/document/parse.hpp"
#include "io/robots/serial_file.hpp"
#include "server/robots.hpp"

namespace sinew::server::device {
namespace {

using Json = nlohmann::json;

constexpr double longest_wait = 2e-3;  // [s] for bytes, before time is looked at again
constexpr const char* demo_motor = "\nmotor: {lead: 2 mm, counts: 4096}\n";  // that of the firmware

std::string text_of(const auto& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string time_text(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &local);
  return text.data();
}

/// For the name of a file, whatever a robot is called.
std::string plain(std::string name) {
  const auto is_plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '-' || c == '_'); };
  for (char& c : name)
    if (!is_plain(static_cast<unsigned char>(c))) c = '-';
  return name.substr(0, 80);
}

Panel::Clock system_clock(const std::string& robot) {
  // A second one in the same second has a name of its own.
  const auto named = [robot, last = std::string(), count = 1]() mutable {
    std::string name = time_text("%Y-%m-%d-%H%M%S-") + robot;
    count = name == last ? count + 1 : 1;
    last = name;
    return count > 1 ? fmt::format("{}-{}", name, count) : name;
  };
  return {[] { return time_text("%H:%M:%S"); }, named, [] { return time_text("%Y-%m-%d %H:%M:%S"); }};
}

Reply told(const Refused& no) { return refused(409, no.code, "device", no.message); }

/// Fields of a body, which may be of any type.
std::string text_at(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_string() ? found->get<std::string>() : std::string();
}
bool is_true(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_boolean() && found->get<bool>();
}
std::optional<double> number_at(const Json& body, const char* key) {
  const auto found = body.find(key);
  return found != body.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// `[[b1, b2], ...]`
std::optional<Bends> bends_at(const Json& body) {
  const auto list = body.find("bends");
  if (list == body.end() || !list->is_array()) return {};
  Bends bends;
  for (const Json& pair : *list) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) return Bends();
    bends.emplace_back(pair[0].get<double>(), pair[1].get<double>());
  }
  return bends;
}

std::optional<Activity> button_of(std::string_view call) {
  constexpr std::pair<std::string_view, Activity> buttons[] = {
      {"move", Activity::moving},     {"straighten", Activity::straighten}, {"retract", Activity::retract},
      {"advance", Activity::advance}, {"relax", Activity::relax},           {"home", Activity::homing},
      {"follow", Activity::follow}};
  for (const auto& [name, activity] : buttons)
    if (name == call) return activity;
  return {};
}

/// The robot as text and document; a demonstration gives it the firmware's motor where it has none.
struct RobotFile {
  std::string text, file_text;  ///< with that motor, and as it was read
  Document document;
};
Expected<RobotFile> read_file(const std::string& robot, std::span<const Member> settings, bool is_demo) {
  if (robot.empty())
    return failure("missing_robot", "", "name the robot of the device: sinew serve nottingham-tpcj --demo");
  auto text = changed_text(robot, settings);
  if (!text) return tl::unexpected(text.error());
  auto document = parse_yaml(*text, robot);
  if (!document) return tl::unexpected(document.error());
  std::string file_text = *text;
  if (is_demo && is_serial(*document) && !document->root.find("motor")) {
    *text += demo_motor;
    document = parse_yaml(*text, robot);
    if (!document) return tl::unexpected(document.error());
  }
  return RobotFile{std::move(*text), std::move(file_text), std::move(*document)};
}

}  // namespace

Device::Device(std::string text, std::string file_text, const DeviceOptions& options, Arm arm, Judge judge)
    : text_(std::move(text)),
      handle_(handle_of(text_)),
      file_handle_(handle_of(file_text)),
      options_(options),
      recording_(options.folder, text_),
      link_([this]() -> std::unique_ptr<Wire> {
        auto port = open_port(options_.port, options_.baud);
        return port ? std::move(*port) : nullptr;
      }),
      panel_(arm, std::move(judge), link_, recording_, system_clock(plain(arm.robot().name))) {}

Expected<std::unique_ptr<Device>> Device::open(const std::string& robot, const DeviceOptions& options) {
  auto file = read_file(robot, options.settings, options.is_demo);
  if (!file) return tl::unexpected(file.error());
  auto arm = Arm::read(file->document, options.stage_motor);
  if (!arm) return tl::unexpected(arm.error());
  auto session = Session::open(file->document);
  if (!session) return tl::unexpected(session.error());
  DeviceOptions chosen = options;
  std::unique_ptr<Simulated> simulated;
  if (options.is_demo) {
    auto started = Simulated::start(file->text);
    if (!started) return tl::unexpected(started.error());
    simulated = std::move(*started);
    chosen.port = simulated->port();
  } else if (const auto port = open_port(options.port, options.baud); !port) {
    return tl::unexpected(port.error());  // later it may come and go
  }
  Judge judge(std::move(*session), *arm);
  std::unique_ptr<Device> device(new Device(std::move(file->text), std::move(file->file_text), chosen,
                                            std::move(*arm), std::move(judge)));
  device->simulated_ = std::move(simulated);
  device->thread_ = std::jthread([self = device.get()](const std::stop_token& over) { self->run(over); });
  return device;
}

Device::~Device() { stop(); }

void Device::stop() {
  feed_->stop();
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  recording_.end();
  recording_.wait(std::chrono::seconds(1));  // the process may end without more ado
  simulated_.reset();
}

double Device::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

/// Clients only ever hold the lock for as long as a command takes, which waits for nothing.
void Device::run(const std::stop_token& over) {
  while (!over.stop_requested()) {
    {
      const std::lock_guard lock(mutex_);
      panel_.tick(now());
      publish(now());
    }
    link_.wait(longest_wait);
  }
  const std::lock_guard lock(mutex_);
  const double end = now() + times::frame;
  panel_.shut_down();
  while (now() < end) {  // for the controller to let go
    panel_.tick(now());
    link_.wait(longest_wait);
  }
}

void Device::publish(double now) {
  for (const LogEntry& entry : panel_.take_log())
    feed_->log(text_of(
        Json{{"time", entry.time}, {"clock", entry.clock}, {"kind", entry.kind}, {"text", entry.text}}));
  if (now < published_ + times::frame) return;
  published_ = std::max(published_ + times::frame, now - times::frame);
  feed_->publish(text_of(panel_.frame(now)));
}

Reply Device::describe(const HandleOf& handle_of) {
  const std::string handle = handle_of(text_);
  const std::lock_guard lock(mutex_);
  const Hello* hello = panel_.hello();
  const Arm& arm = panel_.robot();
  const nlohmann::ordered_json json{{"source", options_.is_demo ? "demo" : "port"},
                                    {"name", options_.port},
                                    {"robot", handle},
                                    {"file", file_handle_},
                                    {"sections", arm.sections()},
                                    {"tendons", arm.tendons()},
                                    {"has_tension", hello && hello->has_tension},
                                    {"tension_limit", hello ? hello->tension_limit : 0},
                                    {"has_stage", hello && hello->stages > 0},
                                    {"stage_limit", panel_.stage_limit()},
                                    {"faults", options_.is_demo}};
  return {200, text_of(nlohmann::ordered_json{{"device", json}})};
}

tl::expected<std::shared_ptr<FeedStream>, Reply> Device::listen() {
  auto place = streams_.wait(std::chrono::seconds(0));
  if (!place) return tl::unexpected(refused(503, "busy", "device", "16 pages listen; close another one"));
  return std::make_shared<FeedStream>(feed_, std::move(place));
}

Reply Device::post(std::string_view call, const std::string& body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return refused(400, "json_syntax", "body", "give an object, {...}");
  if (call == "fault") return fault(json);
  if (call == "plan") return plan(json);
  const std::lock_guard lock(mutex_);
  if (call == "lease") return lease(json, now());
  if (call == "target") return target(json, text_at(json, "lease"), now());
  const bool is_known = call == "release" || call == "arm" || call == "disarm" || call == "hold" ||
                        call == "speed" || call == "acknowledge" || button_of(call);
  if (!is_known) return refused(404, "not_found", "path", "nothing is here");
  if (const auto no = obey(call, json, text_at(json, "lease"), now())) return told(*no);
  return {200, text_of(nlohmann::ordered_json{{"state", name_of(panel_.mode())},
                                              {"activity", name_of(panel_.activity())}})};
}

Outcome Device::obey(std::string_view call, const Json& body, std::string_view secret, double now) {
  if (call == "hold") return panel_.hold(now);
  if (call == "release") return panel_.release(secret, now);
  if (call == "arm") return panel_.arm(secret, now);
  if (call == "disarm") return panel_.disarm(secret, now);
  if (call == "speed") return panel_.set_speed(secret, number_at(body, "tendon").value_or(-1), now);
  if (call == "acknowledge") {
    panel_.acknowledge();
    return {};
  }
  const double section = number_at(body, "section").value_or(-1);
  const auto index = section >= 0 && section < 256 ? static_cast<std::size_t>(section) : std::size_t{256};
  Activity activity = *button_of(call);
  const bool is_held = is_true(body, "held");
  // A release is one, whichever way it went.
  const bool is_back = is_held ? is_true(body, "back") : panel_.activity() == Activity::follow_back;
  if (activity == Activity::follow && is_back) activity = Activity::follow_back;
  const double press = std::clamp(number_at(body, "press").value_or(0), 0.0, 1e9);
  return panel_.press(activity, secret, is_held, now, index, std::lround(press));
}

Reply Device::lease(const Json& body, double now) {
  std::string secret = text_at(body, "lease");
  int number = 0;
  if (const auto no = panel_.lease(secret, number, now)) return told(*no);
  return {200, text_of(nlohmann::ordered_json{{"lease", secret}, {"number", number}})};
}

Reply Device::target(const Json& body, std::string_view secret, double now) {
  const auto bends = bends_at(body);
  const auto stage = number_at(body, "stage");
  if (!bends && !stage)
    return refused(400, "missing_key", "body",
                   R"(give "bends", [[b1, b2], ...] of each section, or "stage", or both)");
  if (const auto no = panel_.set_target(secret, bends, stage, now)) return told(*no);
  return {200, "{}"};
}

Reply Device::snapshot(bool is_jpeg, const std::string& text, std::string picture) {
  constexpr std::string_view jpeg = "\xFF\xD8\xFF", png = "\x89PNG\r\n\x1A\n";
  constexpr std::size_t longest = 500;
  if (!picture.starts_with(is_jpeg ? jpeg : png))
    return refused(
        400, "bad_picture", "body",
        fmt::format("this is no {0}: send the bytes of one, as they are", is_jpeg ? "JPEG" : "PNG"));
  if (text.size() > longest)
    return refused(400, "too_long", "text", fmt::format("give at most {} bytes", longest));
  const std::string words = Json::parse(text_of(Json(text))).get<std::string>();  // as UTF-8, whatever came
  const std::lock_guard lock(mutex_);
  std::string name;
  if (const auto no = panel_.keep_picture(std::move(picture), is_jpeg ? "jpg" : "png", words, name))
    return told(*no);
  return {200, text_of(nlohmann::ordered_json{{"name", name}})};
}

Reply Device::plan() {
  const std::lock_guard lock(mutex_);
  return {200, text_of(nlohmann::ordered_json{{"plan", panel_.plan()}})};
}

/// What is in the body is looked at before the lock is taken.
Reply Device::plan(const Json& body) {
  auto read = read_plan(body);
  if (!read) return refused(400, read.error().code, read.error().where, read.error().message);
  const std::lock_guard lock(mutex_);
  const double now = this->now();
  if (!read->plan) {
    if (const auto no = panel_.drop_plan(read->lease, now)) return told(*no);
    return {200, "{}"};
  }
  if (read->robot != handle_ && read->robot != file_handle_)
    return refused(409, "another_robot", "robot",
                   "the plan is of another robot than the device: plan with its file, as sinew serve was "
                   "started with, or start it with the robot of the scene");
  if (const auto no = panel_.load_plan(read->lease, std::move(*read->plan), now)) return told(*no);
  return {200, text_of(nlohmann::ordered_json{{"plan", panel_.frame(now)["plan"]}})};
}

/// Not under the lock: the simulator may take its time.
Reply Device::fault(const Json& body) {
  if (!simulated_) return refused(409, "no_demo", "device", "only the device of --demo can be given faults");
  const std::string line = text_at(body, "line");
  if (line.empty() || line.find_first_of("\r\n") != std::string::npos)
    return refused(400, "missing_key", "line", R"(give one line, as "cut 3 1")");
  if (const std::string no = simulated_->tell(line); !no.empty())
    return refused(409, "fault", "line", "the simulated device refuses it: " + no);
  return {200, "{}"};
}

}  // namespace sinew::server::device
