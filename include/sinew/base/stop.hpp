/// @file stop.hpp
/// A request to stop. Long solves look at it now and then and answer `Status::stopped`; what they return is
/// the best they have. Whoever asks (a signal handler, a server whose client has gone, a time limit) sets one
/// flag.
#pragma once
#include <atomic>

namespace sinew::inline v1 {

/// View of a flag that another thread or a signal handler may set. The default token is never asked to stop.
class StopToken {
 public:
  StopToken() = default;
  explicit StopToken(const std::atomic<bool>& flag) : flag_(&flag) {}  ///< the flag must outlive the token
  /// Whether the flag is set; from any thread.
  bool stop_requested() const noexcept { return flag_ && flag_->load(std::memory_order_relaxed); }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace sinew::inline v1
