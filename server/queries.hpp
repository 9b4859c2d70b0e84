/// @file queries.hpp
/// The queries in a body, as they stand there: a session is given the text itself.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace sinew::server {

/// Without the blanks of JSON around it.
std::string_view trimmed(std::string_view text);

/// Where the text stands that begins at `at` in quotes; past its end if it does not close.
std::size_t end_of_quotes(std::string_view text, std::size_t at);

/// What stands between the commas of an array or an object, given without its own brackets. Nothing where
/// brackets and quotes do not close. Of more than `most` only so many that there are more.
std::vector<std::string_view> elements_of(std::string_view inside, std::size_t most);

/// The queries of a body: itself, or the elements of the array that it is. Nothing where it is neither, or
/// where brackets and quotes do not close, and one more than `most` where there are more; whether an element
/// is a query is for a session to say.
std::vector<std::string_view> queries_of(std::string_view body, std::size_t most);

}  // namespace sinew::server
