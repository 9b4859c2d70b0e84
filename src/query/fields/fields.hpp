/// @file fields.hpp
/// Every field of questions, written down once: what the command takes and explains, the schema, the table of
/// the protocol page, unit hints and other languages' keywords are made of this. Handlers read them; a test
/// holds the two together.
#pragma once
#include <span>
#include <string_view>

#include "query/kinds.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// What the value of a field looks like, whatever it means.
enum class FieldShape {
  flag,            ///< true or false
  whole,           ///< a whole number
  quantity,        ///< a number
  word,            ///< one of some words
  words,           ///< a list of them
  point,           ///< three numbers
  numbers,         ///< a list of numbers
  inputs,          ///< one number an input, in their order
  per_leg,         ///< one number a leg
  signs,           ///< +1 or -1 a leg
  pairs,           ///< two numbers a leg
  lists,           ///< a list of numbers for each leg, or section
  pose,            ///< where the platform, or the tip, is
  independent,     ///< z, e1 and e2 of a platform that three constraints hold, or three inputs
  start,           ///< a pose, inputs, coordinates, a configuration, or `last`
  place,           ///< a pose, or those coordinates
  places,          ///< a list of them
  target,          ///< a place, or a map of what changes along a curve
  wrench,          ///< force, then moment
  twist,           ///< velocity, then angular velocity, or a direction of these
  growing_load,    ///< {wrench, limit}
  range,           ///< two numbers, the lower one first
  text_or_number,  ///< of `id`, returned as given
  settings,        ///< {path: value}
  point_loads,     ///< a list of {place, wrench, following}
  path_points,     ///< a list of {tensions, changes, wrench, ...}
  measured_rows,   ///< {pulls, markers, time, blocks}, or the text of a table
  names,           ///< names with commas between, or a list of them
};

/// Kinds of mechanics, as bits.
enum Mechanics : unsigned { of_kinematic = 1, of_chains = 2, of_rods = 4, of_serial = 8, of_arms = 16 };
inline constexpr unsigned of_platforms = of_kinematic | of_chains | of_rods,
                          of_all = of_platforms | of_serial;

/// Which mechanics take the field in a question of each kind.
using FieldUses = ByKind<unsigned>;

struct Field {
  std::string_view name;
  FieldShape shape;
  Dimension dimension;  ///< of its numbers; of inputs, poses and the like it is that of each
  FieldUses uses;
  std::string_view meaning;                      ///< one sentence; names of fields in backticks
  std::span<const std::string_view> words = {};  ///< that it may be, or its list may have
};

/// In the order of the protocol page.
std::span<const Field> question_fields();
/// Null where there is none of this name.
const Field* find_field(std::string_view name);

}  // namespace sinew::inline v1
