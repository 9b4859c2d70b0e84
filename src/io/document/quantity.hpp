/// @file quantity.hpp
/// Numbers with units as people write them. A bare number is SI; a unit is checked against what is asked for.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// The text without the blanks and ends of lines around it.
std::string_view trimmed(std::string_view text);

/// `"175 mm"`, `"24 deg"`, `"1/2 in"`, `"0.175"` in SI. With a decimal unit the answer is the very double
/// that the SI spelling has: `"175 mm"` is `0.175`. Errors: `wrong_dimension`, `unknown_unit`,
/// `not_a_number`, `not_whole`; they have no place.
Expected<double> parse_quantity(std::string_view text, Dimension dimension);

/// A number and what it measures, which its unit tells.
struct Quantity {
  double value = 0;  ///< SI
  Dimension dimension = Dimension::number;
};

/// Any quantity. Errors: as `parse_quantity`.
Expected<Quantity> parse_any_quantity(std::string_view text);

/// The whole text as a finite decimal number, else nothing (`0x10`, `inf` and `nan` are no numbers here).
std::optional<double> parse_number(std::string_view text);

/// SI symbol: `m`, `rad`, `N m`; empty for numbers.
std::string_view unit(Dimension dimension);

/// `a length`, `an angle`, `a whole number`.
std::string_view noun(Dimension dimension);

/// What to write, for messages: `a length ("0.2 m", "200 mm", or 0.2 for metres)`.
std::string_view advice(Dimension dimension);

/// For people: lengths in mm, angles in deg, the rest in SI, six digits, with the unit.
std::string human(double si, Dimension dimension);

/// The shortest text that reads back as the same number.
std::string si_text(double value);

}  // namespace sinew::inline v1
