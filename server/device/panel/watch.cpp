#include "watch.hpp"

#include <fmt/format.h>

#include <numbers>

namespace sinew::server::device {
namespace {

constexpr double to_show = 0.1, to_clear = 0.5;  // [s]

std::string amount_text(Word word, double amount) {
  if (word == Word::unreachable) return fmt::format(" {:.1f}°", amount * 180 / std::numbers::pi);
  return amount > 0 ? fmt::format(" {:.2f} mm", 1e3 * amount) : "";
}

std::string_view verb_of(Word word) {
  switch (word) {
    case Word::over_tensioned:
      return "is over-tensioned";
    case Word::slack:
      return "is slack";
    case Word::unreachable:
      return "is beyond its limit";
    default:
      return "gives no data";
  }
}

std::string sentence_of(std::size_t section, Word word, double amount, double lasts) {
  if (word == Word::no_data) return fmt::format("No data for {:.1f} s", lasts);
  return fmt::format("Section {} {}{}{} for {:.1f} s", section + 1, verb_of(word),
                     amount > 0 ? (word == Word::unreachable ? " at" : " by") : "", amount_text(word, amount),
                     lasts);
}

std::string next_of(std::size_t section, Word word, const std::string& advice) {
  if (word == Word::over_tensioned) return fmt::format("Hold Relax S{} for 1 s.", section + 1);
  if (word == Word::no_data) return "Check the cable.";
  return advice.empty() ? "" : advice + ".";
}

}  // namespace

bool ShownState::look(Word word, bool is_partial, double now) {
  if (word == word_ && is_partial == is_partial_) {
    next_ = word;
    next_is_partial_ = is_partial;
    next_since_ = now;
    return false;
  }
  if (word != next_ || is_partial != next_is_partial_) {
    next_ = word;
    next_is_partial_ = is_partial;
    next_since_ = now;
  }
  if (now - next_since_ < (word > word_ ? to_show : to_clear)) return false;
  word_ = word;
  is_partial_ = is_partial;
  since_ = next_since_;
  return true;
}

std::optional<Alarm> find_alarm(const std::vector<ShownState>& shown, const std::vector<SectionState>& states,
                                const std::optional<Alarm>& before, double now) {
  Alarm alarm;
  int unwell = 0;
  for (std::size_t m = 0; m < shown.size(); ++m) {
    unwell += shown[m].word() != Word::exact;
    if (shown[m].word() <= alarm.word) continue;
    alarm.section = m;
    alarm.word = shown[m].word();
    alarm.since = shown[m].since();
  }
  if (unwell == 0) return {};
  const SectionState& state = states[alarm.section];
  const bool is_current = state.word == alarm.word;
  alarm.more = alarm.word == Word::no_data ? 0 : unwell - 1;
  alarm.sentence = sentence_of(alarm.section, alarm.word, is_current ? state.amount : 0, now - alarm.since);
  if (alarm.word >= Word::no_data) alarm.did = "Motion is held.";
  alarm.next = next_of(alarm.section, alarm.word, is_current ? state.advice : "");
  if (before && before->section == alarm.section && before->word == alarm.word)
    alarm.is_acknowledged = before->is_acknowledged;
  return alarm;
}

std::string log_line(std::size_t section, const ShownState& shown, const SectionState& state) {
  std::string line = fmt::format("S{} {}", section + 1, name_of(shown.word(), shown.is_partial()));
  if (state.word != shown.word()) return line;
  line += amount_text(state.word, state.amount);
  return state.advice.empty() ? line : line + ": " + state.advice;
}

}  // namespace sinew::server::device
