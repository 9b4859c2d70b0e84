#include "study/file/read_derived.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/io/quantity.hpp"
#include "study/file/column_name.hpp"
#include "study/file/column_values.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v0 {
namespace {

/// The unit of a sum of single columns that have one unit; empty of anything else.
std::string unit_of(std::span<const Monomial> sum, const Study& study) {
  const std::string* unit = nullptr;
  for (const Monomial& monomial : sum) {
    if (monomial.columns.empty()) continue;  // a constant is in the unit of the others
    const std::string& own = study.column_unit(monomial.columns.front());
    if (monomial.columns.size() > 1 || (unit && *unit != own)) return {};
    unit = &own;
  }
  return unit ? *unit : std::string();
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

/// What `unit: mm` says of the SI unit.
std::string si_unit(const Reader& place, const std::string& text) {
  const auto one = parse_any_quantity("1 " + text);
  if (!one) place.fail(one.error().front().code, one.error().front().message);
  return one ? std::string(unit(one->dimension)) : std::string();
}

StudyDerived read_one(const std::string& name, Reader& place, std::span<const std::string_view> names,
                      const Study& study) {
  StudyDerived derived{.name = name, .unit = {}, .is = {}};
  const std::size_t number = study.variable_count();
  if (!place.is(Node::Kind::map)) {
    derived.is = read_polynomial(place, names, number);
    derived.unit = unit_of(derived.is, study);
    return derived;
  }
  const Reader sum = place.required("is", "a polynomial of axes: \"1.29 - L1 - L2\"");
  derived.is = read_polynomial(sum, names, number);
  const auto unit = place.optional("unit");
  const std::string bare = unit ? unit->text() : std::string();
  derived.unit = bare.empty() ? unit_of(derived.is, study) : si_unit(*unit, bare);
  ColumnValues limits(derived.unit, bare, "derived value");
  if (const auto from = place.optional("from")) derived.low = limits.value(*from);
  if (const auto to = place.optional("to")) derived.high = limits.value(*to);
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

}  // namespace sinew::inline v0
