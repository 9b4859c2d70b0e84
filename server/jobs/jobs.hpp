/// @file jobs.hpp
/// Jobs under ids that nobody can guess: those that run, and the last ones that ended.
#pragma once
#include <deque>
#include <functional>
#include <list>
#include <optional>
#include <string_view>
#include <thread>

#include "job.hpp"

namespace sinew::server {

/// What a job does: on a thread of its own until it is done, or the job over.
using Work = std::function<Outcome(Job&)>;

/// For any number of threads.
class Jobs {
 public:
  explicit Jobs(const JobLimits& limits);
  ~Jobs();  ///< waits for what runs to end
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// The id of a new job; none where as many run as may.
  std::optional<std::string> start(Work work);
  /// Null where there is none (any more). Who asks for a job wants it: its patience begins anew.
  std::shared_ptr<Job> find(std::string_view id);
  /// Forgets a job that has ended.
  void forget(std::string_view id);
  /// All jobs are to end, and none begins any more.
  void stop();

 private:
  struct Task {
    std::shared_ptr<Job> job;
    Work work;
  };
  struct Entry {
    std::string id;
    std::shared_ptr<Job> job;
  };

  void run_tasks();
  void finish(const std::shared_ptr<Job>& job, Outcome outcome);
  void forget_oldest();

  const JobLimits limits_;
  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::list<Entry> entries_;  // the last that ended, or begun, first
  int running_ = 0;
  bool is_stopped_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace sinew::server
