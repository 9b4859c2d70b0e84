#include "study/file/column_values.hpp"

#include <fmt/format.h>

#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"

namespace sinew::inline v1 {

double ColumnValues::value(const Reader& place) {
  if (!place.node()) return 0;
  if (!place.is(Node::Kind::number) && !place.is(Node::Kind::string)) {
    place.refuse("wrong_type", "give a number or a text with a unit (60 mm, 30 deg)");
    return 0;
  }
  const bool is_bare = place.is(Node::Kind::number) && !bare_.empty();
  const auto read = parse_any_quantity(is_bare ? place.node()->text + ' ' + bare_ : place.node()->text);
  if (!read) {
    place.fail(read.error().front().code, read.error().front().message);
    return 0;
  }
  const std::string unit(v1::unit(read->dimension));
  if (unit_.empty()) unit_ = unit;
  if (!unit.empty() && unit != unit_)
    place.fail("wrong_dimension",
               fmt::format("is in {}, but the {} is in {}; give one unit", unit, noun_, unit_));
  return read->value;
}

}  // namespace sinew::inline v1
