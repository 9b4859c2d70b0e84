#include "calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/document/parse.hpp"
#include "io/robots/serial_file.hpp"
#include "queries.hpp"
#include "sinew/base/export.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"

namespace sinew::server {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

std::string written(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_of(std::string_view code, std::string_view where, std::string_view message) {
  return {{"code", code}, {"where", where}, {"message", message}};
}

int whole(std::string_view text) {
  int number = 0;
  for (const char c : text) {
    if (c < '0' || c > '9' || number > 100'000'000) return 0;
    number = 10 * number + (c - '0');
  }
  return number;
}

/// An error of a file with its place apart: `robot:14:11` is line 14, column 11.
Json error_of_file(const Error& error) {
  Json json = json_of(error.code, error.where, error.message);
  const std::size_t second = error.where.rfind(':');
  const std::size_t first = second == std::string::npos ? second : error.where.rfind(':', second - 1);
  if (first == std::string::npos) return json;
  const std::string_view where = error.where;
  const int line = whole(where.substr(first + 1, second - first - 1)),
            column = whole(where.substr(second + 1));
  if (line > 0) json["line"] = line;
  if (line > 0 && column > 0) json["column"] = column;
  return json;
}

/// What a query answers about the robot of a file that ships.
Json summary(std::string_view name) {
  Json row{{"name", name}};
  auto session = Session::open(std::string(name));
  if (!session) return row;
  const Json says = Json::parse(session->answer(R"({"query": "describe"})"));
  row["title"] = says.value("robot", std::string(name));
  row["kind"] = says.value("kind", "");
  row["space"] = says.value("space", "");
  return row;
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string why(const Limits& limits) {
  return fmt::format(
      "stopped: a query here may take {} s, and all of a request {} s; ask as a job (POST /api/jobs), which "
      "may go on",
      limits.query, limits.time);
}

/// The answer to a query that was stopped, told so whatever it had come to.
std::string stopped(const std::string& answer, const std::string& message) {
  Json json = Json::parse(answer, nullptr, false);
  if (!json.is_object() || json.contains("error")) return answer;
  json["status"] = "stopped";
  json["message"] = message;
  return written(json);
}

int working(const Limits& limits) {
  return limits.working > 0 ? limits.working
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

Calls::Calls(const Options& options)
    : options_(options),
      robots_(options.limits.robots, options.limits.robot_bytes),
      rate_(options.limits.rate),
      places_(working(options.limits)),
      recordings_(options.device.folder, options.limits.answers),
      jobs_(options.limits.jobs, robots_, rate_, dog_) {}

std::optional<Errors> Calls::read_opened() {
  if (!options_.robot.empty()) {
    const auto session =
        changed_robot(options_.robot, options_.settings).and_then([](const Document& document) {
          return Session::open(document);
        });
    if (!session) return session.error();
  }
  if (const auto read = plans_.read(options_.scene, options_.plans); !read) return read.error();
  return open_device();
}

std::optional<Errors> Calls::open_device() {
  const DeviceChoice& choice = options_.device;
  device::DeviceOptions chosen{choice.is_demo, choice.port, choice.baud,
                               choice.folder,  {},          options_.settings};
  if (!chosen.is_wanted()) return {};
  if (!choice.stage_motor.empty()) {
    const auto motor = parse_yaml(choice.stage_motor, "--stage-motor").and_then([](const Document& document) {
      return read_motor(document);
    });
    if (!motor) return motor.error();
    chosen.stage_motor = *motor;
  }
  auto opened = device::Device::open(options_.robot, chosen);
  if (!opened) return opened.error();
  device_ = std::move(*opened);
  return {};
}

Reply Calls::device() {
  if (!device_) return {200, R"({"device":null})"};
  return device_->describe([this](const std::string& text) { return robots_.open(text).value_or(""); });
}

Reply Calls::device_plan() {
  if (device_) return device_->plan();
  return refused(404, "no_device", "device", "this server has none: start it with --device or --demo");
}

Reply Calls::device_post(std::string_view call, const std::string& body) {
  if (!device_)
    return refused(404, "no_device", "device", "this server has none: start it with --device or --demo");
  return device_->post(call, body);
}

Reply Calls::snapshot(bool is_jpeg, const std::string& text, const std::string& picture) {
  if (!device_)
    return refused(404, "no_device", "device", "this server has none: start it with --device or --demo");
  return device_->snapshot(is_jpeg, text, picture);
}

/// Files are read through, and may be large.
template <class Read>
Reply Calls::reading(Read&& read) {
  const auto place = places_.wait(std::chrono::duration<double>(options_.limits.patience));
  if (!place) return refused(503, "busy", "recordings", "all places to compute are taken; try again");
  return read();
}

Reply Calls::recordings() {
  return reading([&] { return recordings_.list(); });
}
Reply Calls::recording(std::string_view name, int every) {
  return reading([&] { return recordings_.text(name, every); });
}
Reply Calls::recorded_picture(std::string_view name, std::string_view number) {
  return reading([&] { return recordings_.picture(name, number); });
}

tl::expected<std::shared_ptr<device::FeedStream>, Reply> Calls::device_events() {
  if (device_) return device_->listen();
  return tl::unexpected(
      refused(404, "no_device", "device", "this server has none: start it with --device or --demo"));
}

void Calls::let_go() {
  if (device_) device_->stop();
}

Reply Calls::plan(std::string_view handle) {
  return plans_.plan(handle, [this](const std::string& text) { return robots_.open(text).value_or(""); });
}

Reply Calls::version() const { return {200, written({{"sinew", sinew::version()}, {"protocol", 1}})}; }

Reply Calls::robots() const {
  static const Json shipped = [] {
    Json rows = Json::array();
    for (const std::string_view name : builtin_robot_names()) rows.push_back(summary(name));
    return rows;
  }();
  Json opened;  // read again each time, so that a page sees what an editor has saved
  // Of a device the file as it was when it was opened: it is what the device's numbers are of.
  const auto changed = [&]() -> Expected<std::string> {
    if (options_.robot.empty()) return {};
    if (device_) return device_->robot_text();
    return changed_text(options_.robot, options_.settings);
  }();
  const auto text = options_.settings.empty() ? changed : read_robot_text(options_.robot);
  if (text && changed && !text->empty()) opened = {{"name", options_.robot}, {"text", *text}};
  if (!opened.is_null() && !options_.settings.empty()) {
    Json set = Json::array();
    for (const Member& setting : options_.settings) set.push_back(setting_text(setting));
    opened["changed"] = {{"text", *changed}, {"set", set}};
  }
  return {200, written({{"robots", shipped}, {"opened", opened}})};
}

Reply Calls::robot_text(const std::string& name) const {
  const auto names = builtin_robot_names();
  if (std::ranges::find(names, name) == names.end())  // never a path
    return refused(404, "unknown_robot", "robot", "no robot of this name ships; GET /api/robots lists them");
  return {200, read_robot_text(name).value(), "text/yaml; charset=utf-8"};
}

Reply Calls::open_robot(const std::string& text) {
  const auto place = places_.wait(std::chrono::duration<double>(options_.limits.patience));
  if (!place) return refused(503, "busy", "robot", "all places to compute are taken; try again");
  const auto handle = robots_.open(text);
  if (handle) return {200, written({{"robot", *handle}})};
  Json errors = Json::array();
  for (const Error& error : handle.error()) errors.push_back(error_of_file(error));
  return {422, written({{"errors", errors}})};
}

std::string Calls::answers(OpenRobot& robot, const std::vector<std::string_view>& queries, bool is_list,
                           const Watchdog::IsOver& is_gone) {
  auto session = robot.take();
  if (!session) return error_text("internal", "robot", "the robot cannot be opened again");
  const auto end = after(options_.limits.time);
  auto due = end;
  Watchdog::Watched watched(dog_, [&] { return Clock::now() > due || is_gone(); });
  session->stop_on(watched.token());
  std::string text = is_list ? "[" : "";
  for (const std::string_view query : queries) {
    if (text.size() > 1) text += ',';
    if (text.size() > options_.limits.answers)
      text += error_text("too_large", "query", "the answers before fill a reply; ask for fewer at once");
    else if (Clock::now() > end || (watched.is_over() && is_gone()))
      text += error_text("too_slow", "query", "the time of a request is over; ask for fewer at once");
    else {
      watched.renew([&] { due = std::min(end, after(options_.limits.query)); });
      const std::string answer = answer_of(*session, query);
      text += watched.is_over() ? stopped(answer, why(options_.limits)) : answer;
    }
  }
  robot.give_back(std::move(*session));
  return is_list ? text + ']' : text;
}

Reply Calls::query(std::string_view handle, std::string_view body, const std::string& address,
                   const Watchdog::IsOver& is_gone) {
  const std::vector<std::string_view> queries = queries_of(body, options_.limits.queries);
  if (queries.empty())
    return refused(400, "json_syntax", "body", "give one query, {...}, or an array of queries, [{...}, ...]");
  if (queries.size() > options_.limits.queries)
    return refused(413, "too_large", "body",
                   fmt::format("there are more queries than may be asked at once; give at most {}",
                               options_.limits.queries));
  const auto robot = robots_.find(handle);
  if (!robot)
    return refused(404, "unknown_robot", "robot",
                   "no robot has this handle (any more): POST its text to /api/robot and ask again");
  if (!rate_.allows(address, queries.size()))
    return refused(429, "too_many", "query",
                   fmt::format("more than {} queries a second; wait a second", options_.limits.rate));
  const auto place = places_.wait(std::chrono::duration<double>(options_.limits.patience));
  if (!place) return refused(503, "busy", "query", "all places to compute are taken; try again");
  return {200, answers(*robot, queries, body.find('[') < body.find('{'), is_gone)};
}

void Calls::stop() {
  let_go();
  plans_.stop();
  dog_.stop();
  jobs_.stop();
}

}  // namespace sinew::server
