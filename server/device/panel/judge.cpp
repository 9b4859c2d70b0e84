#include "judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace sinew::server::device {
namespace {

using Json = nlohmann::ordered_json;

constexpr double near_limit = 0.95;     // of the envelope
constexpr double slack_tension = 0.02;  // [N]; a tendon that pulls less than that hangs
constexpr double millimetres = 1e3, degrees = 180 / std::numbers::pi;

std::string numbers_text(const std::vector<std::size_t>& tendons) {
  std::string text = tendons.size() == 1 ? "tendon " : "tendons ";
  for (std::size_t i = 0; i < tendons.size(); ++i)
    text += fmt::format("{}{}", i > 0 ? ", " : "", tendons[i] + 1);
  return text;
}

Word word_of(const std::string& agreement) {
  if (agreement == "indeterminate") return Word::slack;
  if (agreement == "inconsistent") return Word::over_tensioned;
  return agreement == "unreachable" ? Word::unreachable : Word::exact;
}

/// Of the largest slack, or of the most that a tendon lacks.
template <class Counts>
std::string slack_advice(std::string_view verb, const Json& slack, Counts counts, double& amount) {
  std::vector<std::size_t> tendons;
  for (std::size_t i = 0; i < slack.size(); ++i)
    if (const double value = slack[i].get<double>(); counts(value)) {
      tendons.push_back(i);
      amount = std::max(amount, std::abs(value));
    }
  if (tendons.empty()) return {};
  return fmt::format("{} {} by {:.2f} mm", verb, numbers_text(tendons), millimetres * amount);
}

}  // namespace

std::string_view name_of(Word word, bool is_partial) {
  switch (word) {
    case Word::exact:
      return "EXACT";
    case Word::slack:
      return is_partial ? "PARTLY SLACK" : "SLACK";
    case Word::unreachable:
      return "UNREACHABLE";
    case Word::over_tensioned:
      return "OVER-TENSIONED";
    case Word::no_data:
      break;
  }
  return "NO DATA";
}

std::string_view kind_of(Word word) {
  constexpr std::string_view kinds[] = {"exact", "slack", "unreachable", "no_data", "over"};
  return kinds[static_cast<std::size_t>(word)];
}

Judge::Judge(Session session, const Arm& arm)
    : session_(std::move(session)),
      tendons_(arm.tendons()),
      tolerance_(tendon_tolerance(arm.robot())) {
  for (const Section& section : arm.robot().sections) {
    limits_.push_back(section.limit);
    is_twin_.push_back(section.is_twin());
  }
}

SectionState Judge::state(std::size_t section, kernel::Model model, std::span<const double> lengths,
                          const Tensions& tensions, bool is_homed) {
  SectionState state;
  state.limit = limits_[section];
  if (is_homed) {
    look_at_changes(state, section, model, lengths);
  } else {
    state.word = Word::slack;
    state.advice = "Hold Home: its zeros are not set";
  }
  if (!tensions.of_tendons.empty()) look_at_tensions(state, section, tensions);
  return state;
}

void Judge::look_at_changes(SectionState& state, std::size_t section, kernel::Model model,
                            std::span<const double> lengths) {
  Json changes = Json::array();
  for (std::size_t m = 0; m <= section; ++m) {
    const auto own = lengths.subspan(m * tendons_, tendons_);
    changes.push_back(std::vector<double>(own.begin(), own.end()));
  }
  const Json query{{"query", "diagram"},
                   {"section", section},
                   {"changes", std::move(changes)},
                   {"model", model == kernel::Model::exact ? "pcc" : "lsk"}};
  state.diagram = Json::parse(session_.answer(query.dump()));
  if (!state.diagram.contains("class")) return;
  state.word = word_of(state.diagram["class"]);
  state.is_partial = state.diagram["partial"];
  const double x = state.diagram["point"][0], y = state.diagram["point"][1];
  const double bend = is_twin_[section] ? std::max(std::abs(x), std::abs(y)) : std::hypot(x, y);
  state.is_near_limit = bend >= near_limit * state.limit;
  const Json& slack = state.diagram["slack"];
  const auto is_slack = [&](double value) { return value > tolerance_; };
  const auto is_short = [](double value) { return value < 0; };
  if (state.word == Word::slack) state.advice = slack_advice("Take in", slack, is_slack, state.amount);
  if (state.word == Word::over_tensioned)
    state.advice = slack_advice("Pay out", slack, is_short, state.amount);
  if (state.word == Word::unreachable) {
    state.amount = bend;
    state.advice = fmt::format("Asked for {:.1f}°, limit {:.1f}°", degrees * bend, degrees * state.limit);
  }
}

void Judge::look_at_tensions(SectionState& state, std::size_t section, const Tensions& tensions) const {
  std::vector<std::size_t> hanging, over;
  for (std::size_t i = 0; i < tendons_; ++i) {
    const double pull = tensions.of_tendons[section * tendons_ + i];
    if (pull < slack_tension) hanging.push_back(i);
    if (tensions.limit > 0 && pull > tensions.limit) over.push_back(i);
  }
  if (!over.empty()) {
    state.word = Word::over_tensioned;
    state.advice = fmt::format("Pay out {}: over {:.0f} N", numbers_text(over), tensions.limit);
  } else if (state.word == Word::exact && !hanging.empty()) {
    // Encoders do not see a tendon that is cut.
    state.word = Word::slack;
    state.is_partial = hanging.size() < tendons_;
    state.advice = fmt::format("Look at {}: no tension", numbers_text(hanging));
  }
}

}  // namespace sinew::server::device
