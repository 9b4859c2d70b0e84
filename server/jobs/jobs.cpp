#include "jobs.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "server/reply.hpp"
#include "server/secret.hpp"

namespace sinew::server {
namespace {

/// This thread, and those it starts, come after the ones that answer a page: Linux has a priority a thread.
void give_way() {
  constexpr int nice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

Outcome outcome_of(const Work& work, Job& job) {
  try {
    return work(job);
  } catch (const std::exception& error) {
    return {Outcome::Kind::failed,
            error_text("internal", "job", fmt::format("this job failed inside sinew: {}", error.what())),
            {}};
  }
}

}  // namespace

Jobs::Jobs(const JobLimits& limits) : limits_(limits) {
  for (int i = 0; i < limits.running; ++i) threads_.emplace_back([this] { run_tasks(); });
}

Jobs::~Jobs() { stop(); }

std::optional<std::string> Jobs::start(Work work) {
  const std::lock_guard lock(mutex_);
  if (is_stopped_ || running_ >= limits_.running) return {};
  ++running_;
  entries_.push_front({make_secret(), std::make_shared<Job>(limits_)});
  waiting_.push_back({entries_.front().job, std::move(work)});
  changed_.notify_one();
  return entries_.front().id;
}

std::shared_ptr<Job> Jobs::find(std::string_view id) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, id, &Entry::id);
  if (found == entries_.end()) return nullptr;
  found->job->come();
  found->job->leave();
  return found->job;
}

void Jobs::forget(std::string_view id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) { return entry.id == id && entry.job->outcome(); });
}

void Jobs::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  for (const Entry& entry : entries_) entry.job->abandon();
  changed_.notify_all();
}

void Jobs::run_tasks() {
  give_way();
  for (;;) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_stopped_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      task = std::move(waiting_.front());
      waiting_.pop_front();
    }
    finish(task.job, outcome_of(task.work, *task.job));
  }
}

/// Its place is free before anyone learns that it has ended, and comes with another job.
void Jobs::finish(const std::shared_ptr<Job>& job, Outcome outcome) {
  const std::lock_guard lock(mutex_);
  --running_;
  const auto entry = std::ranges::find(entries_, job, &Entry::job);
  entries_.splice(entries_.begin(), entries_, entry);
  job->end(std::move(outcome));
  forget_oldest();
}

void Jobs::forget_oldest() {
  std::size_t count = 0, bytes = 0;
  std::erase_if(entries_, [&](const Entry& entry) {
    if (!entry.job->outcome()) return false;
    bytes += entry.job->bytes();
    return ++count > 1 && (count > limits_.kept || bytes > limits_.kept_bytes);
  });
}

}  // namespace sinew::server
