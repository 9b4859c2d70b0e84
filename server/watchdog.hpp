/// @file watchdog.hpp
/// Ends queries that take too long, or that nobody waits for any more.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>

#include "sinew/solve/report.hpp"

namespace sinew::server {

/// Asks of all that is watched, some fifty times a second, whether it is over.
class Watchdog {
 public:
  using IsOver = std::function<bool()>;  ///< from a thread of its own, while it is watched

  /// Watched while it lives.
  class Watched {
   public:
    Watched(Watchdog& dog, IsOver is_over);
    ~Watched();
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
    StopToken token() const { return StopToken(is_over_); }
    bool is_over() const { return is_over_.load(std::memory_order_relaxed); }
    /// Not over any more, whatever was found before: something new begins, after `prepare`.
    void renew(const std::function<void()>& prepare);

   private:
    friend class Watchdog;
    Watchdog* dog_;
    IsOver asks_;
    std::atomic<bool> is_over_ = false;
    std::list<Watched*>::iterator place_;
  };

  Watchdog();
  /// Everything is over, now and later.
  void stop();

 private:
  void look(const std::stop_token& end);

  std::mutex mutex_;  // of all that follows
  std::condition_variable_any changed_;
  std::list<Watched*> watched_;
  bool is_asleep_ =
      false;  // until something is watched: whoever comes while it looks anyway need not wake it
  bool is_stopped_ = false, has_come_ = false;
  std::jthread thread_;  // the last: ends first
};

}  // namespace sinew::server
