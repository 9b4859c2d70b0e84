/// @file terms.hpp
/// Terms of fits and derived values as people write them: `e1^2 - e2^2`, `2 e1 * e2`, `1`.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// The monomials of a term, over columns of these names. Errors have no place: `bad_term`, `unknown_column`.
/// @param nouns what the names are, for messages: `axis or output of this study`
Expected<std::vector<Monomial>> parse_term(std::string_view text, std::span<const std::string_view> columns,
                                           std::string_view nouns);

/// Its value where the columns have these values.
double value_of(std::span<const Monomial> term, std::span<const double> columns);

/// The sum of its products' sizes: what its value is exact to, times a rounding.
double size_of(std::span<const Monomial> term, std::span<const double> columns);

}  // namespace sinew::inline v1
