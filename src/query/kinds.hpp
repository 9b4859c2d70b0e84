/// @file kinds.hpp
/// The kinds of questions. What tells them apart elsewhere is something for each of them.
#pragma once
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>

namespace sinew::inline v1 {

enum class Ask { forward, inverse, velocity, shape, statics, track, diagram, identify, describe };

/// In the order of Ask, as questions call them.
inline constexpr std::array<std::string_view, 9> ask_words{
    "forward", "inverse", "velocity", "shape", "statics", "track", "diagram", "identify", "describe"};

constexpr std::string_view word_of(Ask ask) { return ask_words[static_cast<std::size_t>(ask)]; }
/// Nothing of a word that is no kind of question.
constexpr std::optional<Ask> ask_of(std::string_view word) {
  for (std::size_t k = 0; k < ask_words.size(); ++k)
    if (ask_words[k] == word) return static_cast<Ask>(k);
  return {};
}
inline constexpr auto every_ask = [] {
  std::array<Ask, ask_words.size()> all = {};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<Ask>(k);
  return all;
}();

/// Something for each kind.
template <class T>
struct ByKind {
  T forward = {}, inverse = {}, velocity = {}, shape = {}, statics = {}, track = {}, diagram = {},
    identify = {}, describe = {};

  constexpr const T& of(Ask ask) const {
    constexpr T ByKind::*members[] = {&ByKind::forward, &ByKind::inverse,  &ByKind::velocity,
                                      &ByKind::shape,   &ByKind::statics,  &ByKind::track,
                                      &ByKind::diagram, &ByKind::identify, &ByKind::describe};
    static_assert(std::size(members) == ask_words.size());
    return this->*members[static_cast<std::size_t>(ask)];
  }
};

}  // namespace sinew::inline v1
