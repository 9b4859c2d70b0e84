/// @file job.hpp
/// Long work that one thread does and others listen to: how far it is, its answers so far, how it ended.
#pragma once
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/server.hpp"

namespace sinew::server {

/// How work ended.
struct Outcome {
  enum class Kind { done, cancelled, failed };
  Kind kind = Kind::done;
  std::string said = "{}";  ///< about it, JSON: what its last event carries
  std::string table;        ///< CSV, of a study that is done
};

/// What there is to tell a listener who has the answers before a position.
struct News {
  std::size_t done = 0, total = 0;         ///< samples or queries
  double seconds = 0;                      ///< since the first of them
  std::string question;                    ///< how far the one asked now is, JSON; empty: it has not said
  std::size_t told = 0;                    ///< how often questions have said it
  std::size_t answers = 0;                 ///< how many come now
  std::string text;                        ///< they, with commas between
  bool has_more = false;                   ///< there are answers after them already
  std::shared_ptr<const Outcome> outcome;  ///< null: it runs
};

class Job {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Job(const JobLimits& limits) : limits_(limits) {}

  /// @name For the thread that works
  /// @{
  void show(std::size_t done, std::size_t total);
  /// How far the question is that is answered now, JSON; until its answer is added.
  void tell(std::string question);
  /// The next answer; false: there is no room for it.
  bool add(std::string answer);
  /// Nobody wants it any more: it was cancelled, or left alone for too long.
  bool is_over() const;
  void end(Outcome outcome);
  /// @}

  /// @name For those that listen, or only ask now and then
  /// @{
  void come();
  void leave();
  void cancel();
  /// Waits until a time, but not for a job that has ended.
  News news(std::size_t position, Clock::time_point until) const;
  std::size_t answered() const;
  std::shared_ptr<const Outcome> outcome() const;  ///< null: it runs
  std::size_t bytes() const;                       ///< of answers and table
  /// @}

  /// The server stops: what listens is to go.
  void abandon();
  bool is_abandoned() const;

 private:
  const JobLimits limits_;
  mutable std::mutex mutex_;  // of all that follows
  mutable std::condition_variable ended_;
  std::size_t done_ = 0, total_ = 0, bytes_ = 0;
  std::vector<std::string> answers_;
  std::string question_;
  std::size_t told_ = 0;
  std::shared_ptr<const Outcome> outcome_;
  bool is_cancelled_ = false, is_abandoned_ = false;
  int listeners_ = 0;
  Clock::time_point begun_ = Clock::now(), heard_ = begun_;  // begun_: with its first sample or query
};

}  // namespace sinew::server
