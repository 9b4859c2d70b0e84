/// @file calls.hpp
/// What the server does, without HTTP: a request's text in, a status and a text out.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "jobs/job_calls.hpp"
#include "limiter.hpp"
#include "plans.hpp"
#include "recordings.hpp"
#include "reply.hpp"
#include "robots.hpp"
#include "server.hpp"
#include "watchdog.hpp"

namespace sinew::server {

class Calls {
 public:
  explicit Calls(const Options& options);

  Reply version() const;
  Reply robots() const;  ///< those that ship, and the one the page opens with
  Reply robot_text(const std::string& name) const;
  Reply plans() const { return plans_.list(); }
  Reply plan(std::string_view handle);
  Reply meshes(std::string_view handle) const { return plans_.meshes(handle); }
  Reply open_robot(const std::string& text);
  /// @param is_gone whether the client has left; asked from another thread
  Reply query(
      std::string_view handle, std::string_view body, const std::string& address,
      const Watchdog::IsOver& is_gone = [] { return false; });
  JobCalls& jobs() { return jobs_; }
  Reply device();
  Reply device_plan();
  Reply device_post(std::string_view call, const std::string& body);
  Reply snapshot(bool is_jpeg, const std::string& text, const std::string& picture);
  tl::expected<std::shared_ptr<device::FeedStream>, Reply> device_events();
  Reply recordings();
  /// @param every of its measurements one in so many; 0: all
  Reply recording(std::string_view name, int every);
  Reply recorded_picture(std::string_view name, std::string_view number);
  void let_go();
  /// What computes is to end.
  void stop();

  /// The robot and the plans of the command line: read before anything listens.
  std::optional<Errors> read_opened();

 private:
  std::string answers(OpenRobot& robot, const std::vector<std::string_view>& queries, bool is_list,
                      const Watchdog::IsOver& is_gone);

  std::optional<Errors> open_device();
  template <class Read>
  Reply reading(Read&& read);

  Options options_;
  Robots robots_;
  Rate rate_;
  Places places_;
  Watchdog dog_;
  Plans plans_;
  Recordings recordings_;
  JobCalls jobs_;
  std::unique_ptr<device::Device> device_;
};

}  // namespace sinew::server
