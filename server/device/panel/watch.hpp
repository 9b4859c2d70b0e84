/// @file watch.hpp
/// States as they are shown: a state has to last 100 ms to be shown, and be gone for 500 ms to be cleared.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "judge.hpp"

namespace sinew::server::device {

/// What one section shows.
class ShownState {
 public:
  /// True where what is shown changes.
  bool look(Word word, bool is_partial, double now);
  Word word() const { return word_; }
  bool is_partial() const { return is_partial_; }
  double since() const { return since_; }

 private:
  Word word_ = Word::no_data, next_ = Word::no_data;
  bool is_partial_ = false, next_is_partial_ = false;
  double since_ = 0, next_since_ = 0;
};

/// The worst of all sections, until all are well.
struct Alarm {
  std::size_t section = 0;
  Word word = Word::exact;
  double since = 0;
  std::string sentence, did, next;
  int more = 0;  ///< other sections that are not well
  bool is_acknowledged = false;
};

/// The alarm for what is shown; none where all is well.
/// @param before goes on, acknowledged or not, while it is of the same section and state
std::optional<Alarm> find_alarm(const std::vector<ShownState>& shown, const std::vector<SectionState>& states,
                                const std::optional<Alarm>& before, double now);

/// `S4 OVER-TENSIONED 0.12 mm: Pay out tendon 2 by 0.12 mm`.
std::string log_line(std::size_t section, const ShownState& shown, const SectionState& state);

}  // namespace sinew::server::device
