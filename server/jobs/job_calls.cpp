#include "job_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "job_request.hpp"
#include "sinew/study/study.hpp"
#include "work.hpp"

namespace sinew::server {
namespace {

Reply unknown_job() {
  return refused(404, "unknown_job", "job", "no job has this id (any more): POST it to /api/jobs again");
}

Reply named(std::string_view id) { return {200, fmt::format(R"({{"job":"{}"}})", id)}; }

/// The answers that a listener had with this event.
std::optional<std::size_t> position_of(std::string_view event) {
  std::size_t position = 0;
  const char* end = event.data() + event.size();
  const auto read = std::from_chars(event.data(), end, position);
  if (event.empty() || (read.ec == std::errc() && read.ptr == end)) return position;
  return {};
}

}  // namespace

JobCalls::JobCalls(const JobLimits& limits, Robots& robots, Rate& rate, Watchdog& dog)
    : limits_(limits),
      robots_(robots),
      rate_(rate),
      dog_(dog),
      streams_(limits.streams),
      jobs_(limits) {}

Reply JobCalls::start(std::string_view body, const std::string& address) {
  const auto request = read_job(body, limits_.queries);
  if (!request) {
    const Error& error = request.error().front();
    return refused(400, error.code, error.where, error.message);
  }
  if (!rate_.allows(address, 1))
    return refused(429, "too_many", "job", "too many queries in this second; wait a second");
  if (request->study.empty()) return start_queries(request->robot, request->queries);
  const auto names = builtin_study_names();
  if (std::ranges::find(names, request->study) == names.end())  // never a path
    return refused(
        404, "unknown_study", "study",
        fmt::format("no study of this name ships with sinew; these do: {}", fmt::join(names, ", ")));
  return start(study_work(request->study, limits_));
}

Reply JobCalls::start_queries(const std::string& handle, const std::vector<std::string_view>& queries) {
  if (queries.size() > limits_.queries)
    return refused(
        413, "too_large", "queries",
        fmt::format("there are more queries than a job may have; give at most {}", limits_.queries));
  auto robot = robots_.find(handle);
  if (!robot)
    return refused(404, "unknown_robot", "robot",
                   "no robot has this handle (any more): POST its text to /api/robot and ask again");
  return start(query_work(std::move(robot), {queries.begin(), queries.end()}, dog_));
}

Reply JobCalls::start(Work work) {
  const auto id = jobs_.start(std::move(work));
  if (id) return named(*id);
  return refused(503, "busy", "job", fmt::format("{} jobs run; wait until one ends", limits_.running));
}

Reply JobCalls::result(std::string_view id) {
  const auto job = jobs_.find(id);
  if (!job) return unknown_job();
  const auto outcome = job->outcome();
  if (!outcome) return refused(409, "not_done", "job", "it runs; its events say when it is done");
  if (outcome->kind != Outcome::Kind::done)
    return refused(404, "no_result", "job", "it was cancelled or failed, as its last event says");
  if (outcome->table.empty())
    return refused(404, "no_result", "job", "answers to queries come as events; only a study has a table");
  return {200, {}, "text/csv; charset=utf-8", {outcome, &outcome->table}};
}

Reply JobCalls::cancel(std::string_view id) {
  const auto job = jobs_.find(id);
  if (!job) return unknown_job();
  job->cancel();
  jobs_.forget(id);  // if it has ended; what runs is kept, to tell its listeners
  return named(id);
}

tl::expected<std::shared_ptr<Stream>, Reply> JobCalls::listen(std::string_view id,
                                                              std::string_view last_event) {
  auto job = jobs_.find(id);
  if (!job) return tl::unexpected(unknown_job());
  // A browser comes back whenever a stream ends, until it is told that no more will come.
  if (last_event == "end") return tl::unexpected(Reply{204, ""});
  const auto position = position_of(last_event);
  if (!position || *position > job->answered())
    return tl::unexpected(
        refused(400, "unknown_event", "Last-Event-ID", "give the id of an event of this job, or none"));
  auto place = streams_.wait(std::chrono::seconds(0));
  if (!place)
    return tl::unexpected(
        refused(503, "busy", "job", fmt::format("{} listen to jobs; end another stream", limits_.streams)));
  return std::make_shared<Stream>(std::move(job), *position, limits_.heart_beat, std::move(place));
}

}  // namespace sinew::server
