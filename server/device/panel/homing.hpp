/// @file homing.hpp
/// Zeros of the tendons at a stated pretension. All are paid out until they hang. Then, a section after the
/// other from the base on, each tendon alone is taken in until it pulls, and let out again; those of the
/// section are taken in together until each has the pretension, and where they are then is zero.
/// Why, and whence the numbers: docs/theory/pretension.md
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arm.hpp"

namespace sinew::server::device {

/// A tendon as homing has found it.
struct HomedTendon {
  std::int32_t count = 0;  ///< of its zero, by the zero that it had before
  double taken_in = 0;     ///< from where it began to pull by itself to its zero [m]
  double tension = 0;      ///< there [N]
};

class Homing {
 public:
  /// Begins with the first section that is not homed; anew where all are.
  Homing(const Arm& arm, const Hello& hello, const std::vector<bool>& homed);

  /// After an interruption: what was found counts, as drives that are disabled stay where they are.
  void resume();

  /// What to do now: set-points of all drives, or a zero for one.
  struct Step {
    std::vector<std::int32_t> counts;  ///< empty: a zero
    int milliseconds = 0;              ///< in which drives go there
    std::size_t drive = 0;
    std::int32_t count = 0;  ///< where this drive is now is that
  };
  /// Asked after each measurement, when the last set-points have been accepted.
  std::optional<Step> next(const DriveState& state, const std::vector<std::int32_t>& setpoints);
  /// The zero was taken.
  void zero_is_set();

  bool is_done() const { return phase_ == Phase::done; }
  /// Tendons that were found, and those of sections that are homed.
  std::size_t found() const { return first() + (phase_ < Phase::gather ? own_ : arm_.tendons()); }
  std::size_t tendon() const { return first() + std::min(own_, arm_.tendons() - 1); }
  std::string_view step() const;
  /// Why it cannot go on; empty: it can.
  const std::string& failure() const { return failure_; }
  double pretension() const { return pretension_; }  ///< [N]
  const std::vector<HomedTendon>& tendons() const { return tendons_; }

 private:
  enum class Phase { loosen, seek, feel, let_out, gather, tighten, zero, stage, done };
  using Counts = std::vector<std::int32_t>;

  std::size_t first() const { return section_ * arm_.tendons(); }
  void enter(Phase phase);
  void fail(std::size_t tendon, std::string_view what);
  Step go(Counts counts, int milliseconds);
  std::optional<Step> loosen(const DriveState& state, Counts counts);
  std::optional<Step> seek(const DriveState& state, Counts counts);
  std::optional<Step> feel(const DriveState& state, Counts counts);
  std::optional<Step> let_out(Counts counts);
  std::optional<Step> gather(Counts counts);
  std::optional<Step> tighten(const DriveState& state, Counts counts);
  std::optional<Step> zero(const DriveState& state);
  bool approach(std::int32_t& count, std::int32_t goal) const;
  std::int32_t begin_of_pull() const;

  const Arm& arm_;
  Hello hello_;
  double pretension_;
  Phase phase_ = Phase::loosen;
  std::size_t section_ = 0, own_ = 0;  ///< tendon of the section
  double gone_ = 0;                    ///< [m] in this phase
  double way_ = 0, before_ = 0;  ///< of the last step that tightened [m], and the least tension then [N]
  struct Sample {
    double count, tension;
  };
  std::vector<Sample> samples_;
  Counts pulls_from_;  ///< where each tendon begins to pull
  std::vector<HomedTendon> tendons_;
  std::string failure_;
};

}  // namespace sinew::server::device
