/// @file answer_fields.hpp
/// Numbers of answers, written down once: how each lies, in what unit, and what it is.
#pragma once
#include <span>
#include <string_view>

namespace sinew::inline v1 {

/// How many numbers a field of an answer has, in terms of the robot.
enum class AnswerShape {
  number,
  pair,
  triple,
  quaternion,
  vector,          ///< two in the plane, three in space
  direction,       ///< an angle in the plane, a unit vector in space
  inputs,          ///< one per input
  freedoms,        ///< one per freedom of the platform, twist order
  square,          ///< freedoms by freedoms
  by_inputs,       ///< freedoms by inputs; in `statics` by what is held there, which a place does not tell
  jacobian,        ///< J: a row per constraint, of a serial robot of the tip's twist
  input_jacobian,  ///< K: a column per input, of chains per joint, of a serial robot per coordinate
  rates,           ///< as many as K has columns, in the lists that inputs, joints or coordinates have
  sensitivities,   ///< U: freedoms by columns of K
  joints,          ///< of one leg on chains
  bends,           ///< a serial robot's coordinates, a list per section
  tendons,         ///< a number per tendon of a serial robot, a list per section
  two_by_two,
  list,  ///< as many as there are: the robot alone does not tell
};

struct AnswerField {
  std::string_view name;  ///< last word of its place, or as many as are needed; without indices
  AnswerShape shape;
  std::string_view unit;  ///< SI; empty for plain numbers. All that numbers of it have, ", " between: then 1
                          ///< is that of plain ones, and radians are left out of denominators
  std::string_view meaning;
};

/// Of all questions but `describe`, which says a file again, and `identify`, which has its own page; of these
/// what would be taken for a field of another question.
std::span<const AnswerField> answer_fields();
/// By a place such as `legs[0].tendon_lengths[1]`; null where nothing is known of it.
const AnswerField* find_answer_field(std::string_view place);

}  // namespace sinew::inline v1
