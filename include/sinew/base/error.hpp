/// @file error.hpp
/// Bad input is a value, never an exception: the place, what was found, the rule, the way out.
/// (A solver that does not converge is not bad input: it answers with a Report, see solve/report.hpp.)
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// One thing wrong with an input.
struct Error {
  std::string code;     ///< stable, for programs: `unknown_key`, `wrong_dimension`, ...
  std::string where;    ///< `file.yaml:14:11`, or the path of the field in a query
  std::string message;  ///< for people: what was found, the rule, the way out
};

/// Everything wrong with an input, in the order of the input. Never empty inside an `Expected`.
using Errors = std::vector<Error>;

/// A value, or everything that was wrong with the input: `if (!x) … x.error()`, `x.value()`, `*x`.
template <class T>
using Expected = tl::expected<T, Errors>;

/// `Errors` of one, as the failed value of an `Expected`.
inline tl::unexpected<Errors> failure(std::string_view code, std::string_view where,
                                      std::string_view message) {
  return tl::unexpected<Errors>(Errors{{std::string(code), std::string(where), std::string(message)}});
}

/// One line an error: `where: message [code]`.
SINEW_API std::string to_string(const Errors& errors);

}  // namespace sinew::inline v1
