/// @file answer_fields.hpp
/// The fields of answers, written down once, as a tree: their names, of which robots and questions they are,
/// which word of `want` gives them, and of what holds numbers how it lies, in what unit, and what it is.
/// A test holds the table and the answers together.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "query/fields/fields.hpp"
#include "query/kinds.hpp"
#include "query/wants.hpp"

namespace sinew::inline v1 {

/// What stands at a place: of numbers how many there are, in terms of the robot.
enum class AnswerShape {
  map,
  maps,  ///< a list of them
  flag,
  number,
  pair,
  pairs,  ///< one for each leg
  triple,
  quaternion,
  vector,             ///< two in the plane, three in space
  direction,          ///< an angle in the plane, a unit vector in space
  inputs,             ///< one per input
  freedoms,           ///< one per freedom of the platform, twist order
  square,             ///< freedoms by freedoms
  by_inputs,          ///< freedoms by inputs; in `statics` by what is held there, which a place does not tell
  jacobian,           ///< J: a row per constraint, of a serial robot of the tip's twist
  input_jacobian,     ///< K: a column per input, of chains per joint, of a serial robot per coordinate
  rates,              ///< as many as K has columns, in the lists that inputs, joints or coordinates have
  sensitivities,      ///< U: freedoms by columns of K
  joints,             ///< of one leg on chains
  bends,              ///< a serial robot's coordinates, a list per section
  tendons,            ///< a number per tendon of a serial robot or an arm, a list per section
  tendons_by_inputs,  ///< of an arm tendons by what holds each
  tendons_by_wrench,  ///< of an arm tendons by freedoms
  two_by_two,
  list,       ///< as many as there are: the robot alone does not tell
  points,     ///< a list of lists, such as points, with coordinates
  polylines,  ///< a list of lists of lists, or deeper
};
/// How many indices lead to a number of a list; 0 of what is none.
constexpr std::size_t depth_of(AnswerShape shape) {
  return shape == AnswerShape::list        ? 1
         : shape == AnswerShape::points    ? 2
         : shape == AnswerShape::polylines ? 3
                                           : 0;
}

struct AnswerField {
  std::string_view name;  ///< last word of its place, or as many as tell it from others; without indices
  AnswerShape shape;
  std::string_view unit = {};     ///< SI; empty for plain numbers. All that numbers of it have, ", " between:
                                  ///< then 1 is that of plain ones, and radians are left out of denominators
  std::string_view meaning = {};  ///< empty of maps alone
};

struct AnswerWord;

/// The words of one level.
struct AnswerGroup {
  constexpr AnswerGroup() = default;
  template <std::size_t words>
  constexpr AnswerGroup(const AnswerWord (&group)[words]) : first(group),
                                                            count(words) {}
  constexpr const AnswerWord* begin() const { return first; }
  constexpr const AnswerWord* end() const;

  const AnswerWord* first = nullptr;
  std::size_t count = 0;
};

/// A word of a place.
struct AnswerWord {
  constexpr AnswerWord(const AnswerField& what, unsigned robots, std::optional<Want> given_by = {})
      : field(what),
        of(robots),
        want(given_by) {}
  constexpr AnswerWord(std::string_view map_name, AnswerShape map, AnswerGroup words, unsigned robots,
                       std::optional<Want> given_by = {})
      : field{map_name, map},
        of(robots),
        below(words),
        want(given_by) {}
  constexpr std::string_view name() const { return field.name.substr(field.name.rfind('.') + 1); }
  /// No map, and of its numbers the robot tells how many there are.
  constexpr bool is_value() const { return below.count == 0 && depth_of(field.shape) == 0; }

  AnswerField field;
  unsigned of;  ///< robots and questions, as bits
  AnswerGroup below = {};
  std::optional<Want> want;    ///< the word that it goes with
  bool is_always = false;      ///< it is there without that word, too
  std::string_view with = {};  ///< the field of the question without which it is not there
  bool is_rare = false;        ///< few answers have it
};

constexpr const AnswerWord* AnswerGroup::end() const { return first + count; }

/// Bits in groups: who answers, in which space, what a leg has, what is asked. A word that names none of a
/// group is of all of it. `of_arms` is one arm here.
namespace answer_bits {

inline constexpr unsigned of_arm_legs = 32, in_plane = 64, in_space = 128, on_tendons = 256, on_rails = 512,
                          on_rods = 1024;
inline constexpr unsigned may_move = 2048, may_not = 4096;  ///< at a pose; of chains by a motor
constexpr unsigned asking(std::initializer_list<Ask> asks) {
  unsigned bits = 0;
  for (const Ask ask : asks) bits |= 0x10000U << static_cast<unsigned>(ask);
  return bits;
}

}  // namespace answer_bits

/// The words with which places begin.
AnswerGroup answer_words();
/// Each field once, in the order of the table.
std::vector<AnswerField> answer_fields();

}  // namespace sinew::inline v1
