#include "study/file/column_name.hpp"
#include "io/document/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sinew::inline v1 {

bool is_name(std::string_view text) {
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && !(text[0] >= '0' && text[0] <= '9') && std::ranges::all_of(text, is_part);
}

void check_name(const Reader& place, std::string_view name) {
  for (const std::string_view taken : {"status", "provenance", "fits"})
    if (name == taken)
      place.fail("bad_name", fmt::format("{} has its own place in the results; choose another name", name));
  if (!is_name(name))
    place.fail("bad_name", fmt::format("{} names no column; give letters, digits and _", in_quotes(name)));
}

}  // namespace sinew::inline v1
