/// @file job_calls.hpp
/// What the server does about jobs, without HTTP.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "jobs.hpp"
#include "server/limiter.hpp"
#include "server/reply.hpp"
#include "server/robots.hpp"
#include "server/watchdog.hpp"
#include "stream.hpp"

namespace sinew::server {

class JobCalls {
 public:
  JobCalls(const JobLimits& limits, Robots& robots, Rate& rate, Watchdog& dog);

  Reply start(std::string_view body, const std::string& address);
  Reply result(std::string_view id);
  Reply cancel(std::string_view id);
  /// @param last_event the id of the last event the listener had; empty: none
  tl::expected<std::shared_ptr<Stream>, Reply> listen(std::string_view id, std::string_view last_event);
  /// All jobs and streams are to end.
  void stop() { jobs_.stop(); }

 private:
  Reply start(Work work);
  Reply start_queries(const std::string& handle, const std::vector<std::string_view>& queries);

  JobLimits limits_;
  Robots& robots_;
  Rate& rate_;
  Watchdog& dog_;
  Places streams_;
  Jobs jobs_;
};

}  // namespace sinew::server
