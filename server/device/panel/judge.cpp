#include "judge.hpp"

#include <fmt/format.h>

#include <utility>

#include "tendon/state.hpp"

namespace sinew::server::device {
namespace {

using Json = nlohmann::ordered_json;

constexpr double slack_tension = 0.02;  // [N]; a tendon that pulls less than that hangs

Word word_of(const std::string& agreement) {
  if (agreement == "indeterminate") return Word::slack;
  if (agreement == "inconsistent") return Word::over_tensioned;
  return agreement == "unreachable" ? Word::unreachable : Word::exact;
}

}  // namespace

std::string_view name_of(Word word, bool is_partial) {
  switch (word) {
    case Word::exact:
      return state_word(TendonConsistency::exact, false);
    case Word::slack:
      return state_word(TendonConsistency::indeterminate, is_partial);
    case Word::unreachable:
      return state_word(TendonConsistency::unreachable, false);
    case Word::over_tensioned:
      return state_word(TendonConsistency::inconsistent, false);
    case Word::no_data:
      break;
  }
  return "NO DATA";
}

std::string_view kind_of(Word word) {
  constexpr std::string_view kinds[] = {"exact", "slack", "unreachable", "no_data", "over"};
  return kinds[static_cast<std::size_t>(word)];
}

Judge::Judge(Session session, const Arm& arm) : session_(std::move(session)), tendons_(arm.tendons()) {}

SectionState Judge::state(std::size_t section, kernel::Model model, std::span<const double> lengths,
                          const Tensions& tensions, bool is_homed) {
  SectionState state;
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
  state.is_near_limit = state.diagram["near_limit"];
  state.amount = state.diagram.value("amount", 0.0);
  state.advice = state.diagram["advice"];
}

void Judge::look_at_tensions(SectionState& state, std::size_t section, const Tensions& tensions) const {
  std::vector<std::size_t> hanging, over;
  for (std::size_t i = 0; i < tendons_; ++i) {
    const double pull = tensions.of_tendons[section * tendons_ + i];
    if (pull < slack_tension) hanging.push_back(i);
    if (tensions.limit > 0 && pull > tensions.limit) over.push_back(i);
  }
  if (!over.empty()) {
    if (state.word != Word::over_tensioned) state.amount = 0;  // it was how slack it is
    state.word = Word::over_tensioned;
    state.advice = fmt::format("Pay out {}: over {:.0f} N", tendon_names(over), tensions.limit);
  } else if (state.word == Word::exact && !hanging.empty()) {
    // Encoders do not see a tendon that is cut.
    state.word = Word::slack;
    state.is_partial = hanging.size() < tendons_;
    state.advice = fmt::format("Look at {}: no tension", tendon_names(hanging));
  }
}

}  // namespace sinew::server::device
