/// @file stream.hpp
/// The events of a job for one listener, as the text of an event stream. Ids say how many answers he has, so
/// that one who comes back goes on there; the last event's is `end`.
#pragma once
#include <optional>

#include "job.hpp"
#include "server/limiter.hpp"

namespace sinew::server {

class Stream {
 public:
  /// @param position answers that he has already
  Stream(std::shared_ptr<Job> job, std::size_t position, double heart_beat, Places::Place place);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// What is to be sent now, after a tenth of a second at most; empty: nothing new.
  std::string next();
  /// The last event has been given.
  bool has_ended() const { return has_ended_; }
  /// The server stops: what is left will not come.
  bool is_broken() const { return job_->is_abandoned(); }

 private:
  using Clock = Job::Clock;

  std::string answers(const News& news);
  std::string progress(const News& news);
  std::string last(const Outcome& outcome);

  std::shared_ptr<Job> job_;
  std::size_t position_;
  std::chrono::duration<double> heart_beat_;
  Places::Place place_;  // of a listener
  Clock::time_point said_{}, due_{};
  std::optional<std::size_t> shown_;  // of what is done
  std::size_t heard_ = 0;             // of what questions say
  bool has_begun_ = false, has_more_ = false, has_ended_ = false;
};

}  // namespace sinew::server
