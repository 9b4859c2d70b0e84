/// @file device.hpp
/// The device of a server: a thread that talks to the controller fifty times a second whatever clients do,
/// and the calls by which they see and move it. Calls: docs/server.md, "A device".
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "feed.hpp"
#include "panel/panel.hpp"
#include "plan_body.hpp"
#include "recording.hpp"
#include "server/reply.hpp"
#include "simulated.hpp"
#include "sinew/io/node.hpp"
#include "wire/link.hpp"

namespace sinew::server::device {

struct DeviceOptions {
  bool is_demo = false;
  std::string port;  ///< of a real one
  int baud = 1'000'000;
  std::string folder = "sinew-recordings";
  std::optional<TendonMotor> stage_motor;  ///< none: the stage counts as the tendons do
  std::vector<Member> settings;            ///< what is changed in the robot, by the paths of its file
  bool is_wanted() const { return is_demo || !port.empty(); }
};

class Device {
 public:
  using HandleOf = std::function<std::string(const std::string& text)>;

  /// Errors: those of the robot's file; `not_serial`, `no_motor`; `no_device`, `in_use`; `not_built`.
  /// @param robot file or name
  static Expected<std::unique_ptr<Device>> open(const std::string& robot, const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Of its robot's file, with what settings change and the motor that a demonstration adds.
  const std::string& robot_text() const { return text_; }
  Reply describe(const HandleOf& handle_of);
  /// @param call the last part of the path: `arm`
  Reply post(std::string_view call, const std::string& body);
  /// Keeps a picture beside the recording.
  Reply snapshot(bool is_jpeg, const std::string& text, std::string picture);
  /// The plan that is loaded, as it was given, or null.
  Reply plan();
  tl::expected<std::shared_ptr<FeedStream>, Reply> listen();
  /// Disarms it; the thread ends.
  void stop();

 private:
  Device(std::string text, std::string file_text, const DeviceOptions& options, Arm arm, Judge judge);
  double now() const;
  void run(const std::stop_token& over);
  void publish(double now);
  Reply lease(const nlohmann::json& body, double now);
  Reply target(const nlohmann::json& body, std::string_view secret, double now);
  Reply fault(const nlohmann::json& body);
  Reply plan(const nlohmann::json& body);
  Outcome obey(std::string_view call, const nlohmann::json& body, std::string_view secret, double now);

  std::string text_, handle_, file_handle_;
  DeviceOptions options_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<Simulated> simulated_;
  Recording recording_;
  ControllerLink link_;
  std::mutex mutex_;  // of the panel, the link and the recording
  Panel panel_;
  double published_ = -1e9;
  std::shared_ptr<Feed> feed_ = std::make_shared<Feed>();
  Places streams_{16};
  std::jthread thread_;
};

}  // namespace sinew::server::device
