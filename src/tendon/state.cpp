#include "tendon/state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v1 {
namespace {

constexpr double near_limit = 0.95;  // of the envelope
constexpr double millimetres = 1e3, degrees = 180 / std::numbers::pi;

/// What the point asks for, in the unit of the envelope's limit.
double asked_for(const DiagramQuestion& question, const Vec2<double>& point) {
  if (question.envelope.kind == Envelope::Kind::square)
    return std::max(std::abs(point[0]), std::abs(point[1]));
  if (question.envelope.kind == Envelope::Kind::disc) return point.norm();
  double travel = 0;
  for (const auto& at : question.tendons.at)
    travel = std::max(travel, question.section.gain * std::abs(at.cosine * point[0] + at.sine * point[1]));
  return travel;
}

/// Which tendons it is about, and by how much at most.
template <class Counts>
void advise(StateWords& state, std::string_view verb, std::span<const double> slack, Counts counts) {
  std::vector<std::size_t> tendons;
  for (std::size_t i = 0; i < slack.size(); ++i) {
    if (!counts(slack[i])) continue;
    tendons.push_back(i);
    state.amount = std::max(state.amount, std::abs(slack[i]));
  }
  if (tendons.empty()) return;
  state.advice = fmt::format("{} {} by {:.2f} mm", verb, tendon_names(tendons), millimetres * state.amount);
}

std::string limit_advice(const Envelope& envelope, double asked) {
  if (envelope.kind == Envelope::Kind::actuator)
    return fmt::format("Asked for {:.2f} mm of a tendon, limit {:.2f} mm", millimetres * asked,
                       millimetres * envelope.limit);
  return fmt::format("Asked for {:.1f}°, limit {:.1f}°", degrees * asked, degrees * envelope.limit);
}

}  // namespace

std::string_view state_word(TendonConsistency agree, bool is_partial) {
  switch (agree) {
    case TendonConsistency::exact:
      return "EXACT";
    case TendonConsistency::indeterminate:
      return is_partial ? "PARTLY SLACK" : "SLACK";
    case TendonConsistency::inconsistent:
      return "OVER-TENSIONED";
    case TendonConsistency::unreachable:
      break;
  }
  return "UNREACHABLE";
}

std::string tendon_names(std::span<const std::size_t> tendons) {
  std::string text = tendons.size() == 1 ? "tendon " : "tendons ";
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    const std::string_view before = i == 0 ? "" : i + 1 == tendons.size() ? " and " : ", ";
    text += fmt::format("{}{}", before, tendons[i] + 1);
  }
  return text;
}

StateWords state_words(const DiagramQuestion& question, const SectionDiagram& diagram) {
  StateWords state;
  state.word = state_word(diagram.agree, diagram.partial);
  const double asked = asked_for(question, diagram.point);
  state.is_near_limit = asked >= near_limit * question.envelope.limit;
  const double tolerance = question.tolerance;
  switch (diagram.agree) {
    case TendonConsistency::exact:
      break;
    case TendonConsistency::indeterminate:
      advise(state, "Take in", diagram.slack, [&](double slack) { return slack > tolerance; });
      break;
    case TendonConsistency::inconsistent:
      advise(state, "Pay out", diagram.slack, [](double slack) { return slack < 0; });
      break;
    case TendonConsistency::unreachable:
      state.amount = asked;
      state.advice = limit_advice(question.envelope, asked);
      break;
  }
  return state;
}

}  // namespace sinew::inline v1
