#include "study/file/read_fits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "study/file/column_name.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v0 {
namespace {

/// Names of columns.
using Names = std::vector<std::string_view>;

/// The number of the column, or that of none.
std::size_t read_column(const Reader& place, std::string_view name, const Names& names) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    place.fail("unknown_column",
               fmt::format("{} is no axis, derived value or output; name it under outputs", in_quotes(name)));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<Monomial> read_sum(const Reader& place, const Names& names, std::string_view nouns) {
  auto sum = parse_term(place.node()->text, names, nouns);
  if (!sum) place.fail(sum.error().front().code, sum.error().front().message);
  return sum ? std::move(*sum) : std::vector<Monomial>{};
}

/// `{of: x, terms: [1, e1]}`
void read_terms(Reader& place, const Names& names, StudyFit& fit) {
  const auto of = place.optional("of");
  fit.column = read_column(place, of ? of->text() : fit.name, names);
  for (const Reader& term : place.required("terms", "what it is a sum of: [1, e1, e1^2]").items()) {
    fit.texts.push_back(term.node()->text);
    fit.terms.push_back(read_sum(term, names, "axis, derived value or output of this study"));
  }
  if (fit.terms.empty()) place.fail("empty_list", "has no terms; give at least one: terms: [1]");
}

}  // namespace

void read_fits(const Reader& place, Study& study) {
  if (!study.reductions.empty())
    place.fail("not_available", "are of samples, and reduce keeps none; make two studies");
  Names names;
  for (std::size_t c = 0; c < study.column_count(); ++c) names.push_back(study.column_name(c));
  for (auto& [name, one] : place.members()) {
    check_name(one, name);
    StudyFit fit{.name = name, .texts = {}, .terms = {}};
    read_terms(one, names, fit);
    one.close();
    study.fits.push_back(std::move(fit));
  }
}

}  // namespace sinew::inline v0
