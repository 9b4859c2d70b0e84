#include "study/file/read_derived.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "study/file/column_name.hpp"
#include "study/file/column_values.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v1 {
namespace {

/// What is known of the unit of a sum. A number may carry a unit: 20 x may be an angle.
struct SumUnit {
  bool is_known = false;
  bool is_certain = false;  ///< no number but 1 stands before a column
  bool is_product = false;  ///< of several units, for which there is no name
  std::string name;
};

/// That of all summands that have one, where they agree.
SumUnit unit_of(std::span<const Monomial> sum, const Study& study) {
  std::vector<std::string> first;
  bool is_certain = true;
  for (const Monomial& monomial : sum) {
    std::vector<std::string> units;
    for (const std::size_t column : monomial.columns)
      if (!study.column_unit(column).empty()) units.push_back(study.column_unit(column));
    std::ranges::sort(units);
    if (units.empty()) continue;
    is_certain = is_certain && std::abs(monomial.factor) == 1;
    if (!first.empty() && units != first) return {};
    first = units;
  }
  if (first.empty()) return {};
  return {.is_known = true,
          .is_certain = is_certain,
          .is_product = first.size() > 1,
          .name = fmt::format("{}", fmt::join(first, "*"))};
}

/// The polynomial: of the names that stand before this one.
std::vector<Monomial> read_polynomial(const Reader& place, std::span<const std::string_view> names,
                                      std::size_t number) {
  if (!place.is(Node::Kind::number) && !place.is(Node::Kind::string)) {
    if (place.node()) place.refuse("wrong_type", "give a polynomial of axes: \"1.29 - L1 - L2\"");
    return {};
  }
  auto sum = parse_term(place.node()->text, names, "axis or derived value of this study");
  if (!sum) {
    place.fail(sum.error().front().code, sum.error().front().message);
    return {};
  }
  for (const Monomial& monomial : *sum)
    for (const std::size_t column : monomial.columns)
      if (column >= number) {
        place.fail("later_column", fmt::format("{} is not known yet; a derived value is made of axes and of "
                                               "derived values above it",
                                               names[column]));
        return {};
      }
  return std::move(*sum);
}

/// What `unit: m` says: an SI unit, as numbers in the polynomial are in SI.
std::string si_unit(const Reader& place, const std::string& text) {
  const auto one = parse_any_quantity("1 " + text);
  if (one && one->value == 1) return std::string(unit(one->dimension));
  place.fail(
      "unknown_unit",
      fmt::format("{} is no SI unit that is known here, and a derived value is in SI; give m, rad, N, ...",
                  in_quotes(text)));
  return {};
}

/// The unit of the values: what is known of them, and what `unit` or the limits say.
std::string settle(const Reader& place, const SumUnit& known, const std::string& said,
                   const std::string& text) {
  if (!known.is_known || said == known.name) return said;
  if (!said.empty() && !known.is_certain) return said;
  if (!said.empty())
    place.fail("wrong_dimension",
               fmt::format("is in {} by its unit or its limits, but {} is in {}; give {}", said, text,
                           known.name, known.is_product ? "limits without a unit, in SI" : "that"));
  return known.is_product ? std::string() : known.name;
}

StudyDerived read_one(const std::string& name, Reader& place, std::span<const std::string_view> names,
                      const Study& study) {
  StudyDerived derived{.name = name, .unit = {}, .is = {}};
  const std::size_t number = study.variable_count();
  if (!place.is(Node::Kind::map)) {
    derived.is = read_polynomial(place, names, number);
    derived.unit = settle(place, unit_of(derived.is, study), {}, {});
    return derived;
  }
  const Reader sum = place.required("is", "a polynomial of axes: \"1.29 - L1 - L2\"");
  derived.is = read_polynomial(sum, names, number);
  const auto unit = place.optional("unit");
  const std::string text = sum.node() ? sum.node()->text : std::string();
  std::string said = unit ? si_unit(*unit, unit->text()) : std::string();
  ColumnValues limits(said, {}, "derived value");
  if (const auto from = place.optional("from")) derived.low = limits.value(*from);
  if (const auto to = place.optional("to")) derived.high = limits.value(*to);
  derived.unit = settle(place, unit_of(derived.is, study), said, text);
  if (derived.low > derived.high)
    place.fail("out_of_range", "from is above to, which leaves every sample out; exchange them");
  place.close();
  return derived;
}

}  // namespace

void read_derived(const Reader& place, Study& study) {
  auto members = place.members();
  std::vector<std::string_view> names;
  for (const StudyAxis& axis : study.axes) names.push_back(axis.name);
  for (const auto& [name, one] : members) names.push_back(name);
  study.derived.reserve(members.size());
  for (auto& [name, one] : members) {
    check_name(one, name);
    if (std::ranges::find(study.axes, name, &StudyAxis::name) != study.axes.end())
      one.fail("duplicate_column", "is the name of an axis; give the derived value another");
    study.derived.push_back(read_one(name, one, names, study));
  }
}

}  // namespace sinew::inline v1
