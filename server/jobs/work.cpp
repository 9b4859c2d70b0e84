#include "work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "query/progress.hpp"
#include "scratch.hpp"
#include "server/reply.hpp"
#include "sinew/study/sweep.hpp"

namespace sinew::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Outcome failed(const Error& error) {
  return {Outcome::Kind::failed, error_text(error.code, error.where, error.message), {}};
}

Outcome cancelled(const Job& job) {
  const News news = job.news(job.answered(), Job::Clock::now());
  return {Outcome::Kind::cancelled, fmt::format(R"({{"done":{},"total":{}}})", news.done, news.total), {}};
}

int threads_of_study(const JobLimits& limits) {
  return limits.threads > 0 ? limits.threads
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / 2);
}

/// Where its files are is nothing to the client, who cannot go on with them.
Error without_path(Error error, const fs::path& folder) {
  if (error.where.starts_with(folder.native()))
    error = {error.code, "temporary files", "they cannot be written: is the disc full?"};
  return error;
}

std::string summary_text(const SweepSummary& summary, std::size_t bytes) {
  Json statuses = Json::object();
  for (std::size_t s = 0; s < summary.statuses.size(); ++s)
    if (summary.statuses[s] > 0) statuses[std::string(sample_status_name(s))] = summary.statuses[s];
  Json json{
      {"samples", summary.samples}, {"statuses", statuses}, {"bytes", bytes}, {"seconds", summary.total}};
  if (!summary.warning.empty()) json["warning"] = summary.warning;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Outcome table_of(const SweepSummary& summary, const fs::path& path, std::size_t most) {
  const std::size_t size = fs::file_size(path);
  if (size > most)
    return failed({"too_large", "study", fmt::format("its table has more than {} bytes", most)});
  std::string text(size, '\0');
  if (!std::ifstream(path, std::ios::binary).read(text.data(), static_cast<std::streamsize>(size)))
    return failed({"file_unreadable", "temporary files", "the table cannot be read back"});
  return {Outcome::Kind::done, summary_text(summary, size), std::move(text)};
}

Outcome run_study(const std::string& name, const JobLimits& limits, Job& job) {
  auto study = read_study(name);
  if (!study) return failed(study.error().front());
  const auto folder = Scratch::make();
  if (!folder) return failed(folder.error().front());
  const fs::path path = folder->path() / "table.csv";
  const auto progress = [&](const SweepProgress& so_far) {
    job.show(so_far.done, so_far.total);
    return !job.is_over();
  };
  const auto summary = sweep(std::move(*study), {.output = path,
                                                 .threads = threads_of_study(limits),
                                                 .command = "sinew sweep " + name,
                                                 .progress = progress});
  if (!summary) return failed(without_path(summary.error().front(), folder->path()));
  if (!summary->is_complete) return cancelled(job);
  job.show(summary->samples, summary->samples);
  return table_of(*summary, path, limits.result);
}

Outcome answer_all(OpenRobot& robot, const std::vector<std::string>& queries, Watchdog& dog, Job& job) {
  auto session = robot.take();
  if (!session) return failed({"internal", "robot", "the robot cannot be opened again"});
  const Watchdog::Watched watched(dog, [&] { return job.is_over(); });
  session->stop_on(watched.token());
  session->progress_to([&job](const QuestionProgress& now) {
    job.tell(progress_json(true, now).dump(-1, ' ', false, Json::error_handler_t::replace));
  });
  job.show(0, queries.size());
  const auto begin = Job::Clock::now();
  for (const std::string& query : queries) {
    if (job.is_over()) return cancelled(job);
    std::string answer = answer_of(*session, query);
    if (watched.is_over()) return cancelled(job);
    if (!job.add(std::move(answer)))
      return failed({"too_large", "queries", "the answers before fill a job; ask for fewer at once"});
  }
  session->progress_to({});  // it outlives this job
  robot.give_back(std::move(*session));
  const double seconds = std::chrono::duration<double>(Job::Clock::now() - begin).count();
  return {Outcome::Kind::done, Json{{"answers", queries.size()}, {"seconds", seconds}}.dump(), {}};
}

}  // namespace

Work study_work(std::string name, const JobLimits& limits) {
  return [name = std::move(name), limits](Job& job) { return run_study(name, limits, job); };
}

Work query_work(std::shared_ptr<OpenRobot> robot, std::vector<std::string> queries, Watchdog& dog) {
  return [robot = std::move(robot), queries = std::move(queries), &dog](Job& job) {
    return answer_all(*robot, queries, dog, job);
  };
}

}  // namespace sinew::server
