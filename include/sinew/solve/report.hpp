/// @file report.hpp
/// What a solver says of its answer, and how it is asked to stop. A solver that does not converge is an
/// answer, never an exception.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <string>
#include <string_view>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// How a solve ended. Of the first eight the first that holds is reported. The numbers stand in result files:
/// new statuses are appended.
enum class Status {
  unreachable = 0,  ///< no solution exists; the message names what cannot be met
  left_domain,      ///< an input or iterate lies outside the model's domain
  slack,            ///< a tendon would have to push
  singular,         ///< the linear system has no unique answer here
  stalled,          ///< no step lowers the residual any more, and it is not zero
  iteration_limit,  ///< the bound on iterations was met
  unstable,         ///< an equilibrium that does not hold by itself
  converged,
  stopped = 8,  ///< the caller asked it to stop (StopToken); the best iterate so far is returned
  bad_input =
      9,  ///< the arguments do not fit the robot, e.g. a planar pose and a spatial robot; nothing was solved
  unsupported = 10,  ///< this question is not for this kind of robot, or not for this model of its links
};

/// Its name: `iteration_limit`.
SINEW_API std::string_view to_string(Status status) noexcept;

/// At most so many bytes of UTF-8 text, without the heap: a solver in a hot loop can say why it failed. What
/// does not fit is cut off.
template <std::size_t Capacity>
class FixedText {
 public:
  using value_type = char;

  FixedText() = default;
  /// As much of the text as fits.
  FixedText(std::string_view text) { append(text); }  // NOLINT(google-explicit-constructor): a text is a text

  /// Only what there is, mostly nothing, is copied: every answer of a solver carries a text.
  FixedText(const FixedText& other) : size_(other.size_) { copy(other); }
  FixedText& operator=(const FixedText& other) {
    size_ = other.size_;
    copy(other);
    return *this;
  }

  /// Appends what fits; the rest is cut off.
  void append(std::string_view text) {
    for (const char c : text) push_back(c);
  }
  /// One more byte, if it fits; formatters can so write through a back inserter.
  void push_back(char c) {
    if (size_ < Capacity) text_[size_++] = c;
  }

  bool empty() const { return size_ == 0; }  ///< without text
  /// The text; not ended by 0. It holds as long as this.
  std::string_view view() const { return {text_.data(), size_}; }

 private:
  void copy(const FixedText& other) {
    if (this != &other) std::copy_n(other.text_.begin(), size_, text_.begin());
  }

  std::size_t size_ = 0;
  std::array<char, Capacity> text_;  // not initialised: only the first size_ characters are ever read
};

/// Status with its evidence. `residual` is that of the best iterate, which is always handed back.
struct Report {
  Status status = Status::converged;
  int iterations = 0;
  double residual =
      0;  ///< largest closure error of a leg [m]; of rods, chains and arms an error over their size, no unit
  FixedText<240> message;  ///< why not converged, in words; empty otherwise

  /// Solved; of loaded robots also stable, where that was asked.
  bool ok() const noexcept { return status == Status::converged; }
  /// Of loaded robots: whether there is an equilibrium, which may be unstable.
  bool is_solved() const noexcept { return ok() || status == Status::unstable; }
};

/// One line: `converged in 4 iterations, residual 5e-14`.
SINEW_API std::string to_string(const Report& report);

/// One iterate of a solver, recorded on request.
struct TraceStep {
  int iteration;
  double residual;  ///< largest closure error [m]
  double step;      ///< fraction of the Newton step taken to get here; 0 for the start
};

/// A request to stop: view of a flag that another thread or a signal handler may set. Long solves look at it
/// now and then and answer `Status::stopped`; what they return is the best they have. The default token is
/// never asked to stop.
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
