/// @file feed.hpp
/// Frames and log entries for any number of listeners, none of whom anybody waits for: of frames each gets
/// the newest, of the log all, and of what was before the last hundred.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "server/limiter.hpp"

namespace sinew::server::device {

class Feed {
 public:
  void publish(std::string frame);
  void log(std::string entry);
  void stop();

 private:
  friend class FeedStream;
  static constexpr std::size_t kept = 100;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string frame_;
  std::uint64_t frames_ = 0, entries_ = 0;  ///< that there were so far
  std::deque<std::string> log_;             ///< the last of them
  bool is_stopped_ = false;
};

/// For one listener, as the text of an event stream.
class FeedStream {
 public:
  FeedStream(std::shared_ptr<Feed> feed, Places::Place place)
      : feed_(std::move(feed)),
        place_(std::move(place)) {}
  /// What is new, after a tenth of a second at most; empty: nothing.
  std::string next();
  bool is_broken() const;

 private:
  std::shared_ptr<Feed> feed_;
  Places::Place place_;
  std::uint64_t frames_ = 0, entries_ = 0;  ///< that it has
  bool has_begun_ = false;
};

}  // namespace sinew::server::device
