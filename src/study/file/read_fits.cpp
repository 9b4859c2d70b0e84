#include "study/file/read_fits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/reader.hpp"
#include "study/file/column_name.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v1 {
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
  FitEquation equation{
      .column = read_column(place, of ? of->text() : fit.name, names), .text = {}, .terms = {}};
  for (const Reader& term : place.required("terms", "what it is a sum of: [1, e1, e1^2]").items()) {
    fit.coefficients.push_back(term.node()->text);
    equation.terms.push_back(read_sum(term, names, "axis, derived value or output of this study"));
  }
  if (equation.terms.empty()) place.fail("empty_list", "has no terms; give at least one: terms: [1]");
  fit.equations.push_back(std::move(equation));
}

void read_coefficient(const Reader& place, const std::string& name, const Names& names, StudyFit& fit) {
  if (!is_name(name))
    place.fail("bad_name",
               fmt::format("{} names no coefficient; give letters, digits and _", in_quotes(name)));
  if (std::ranges::find(names, name) != names.end())
    place.fail("duplicate_column", fmt::format("{} is a column; give the coefficient another name", name));
  if (std::ranges::find(fit.coefficients, name) != fit.coefficients.end())
    return place.fail("duplicate_column", fmt::format("{} stands there twice; remove one", name));
  fit.coefficients.push_back(name);
}

void read_coefficients(Reader& place, const Names& names, StudyFit& fit) {
  const auto wanted = place.optional("coefficients"), known = place.optional("known");
  if (wanted && known)
    place.fail("ambiguous", "coefficients are fitted, those known are not; keep one of the two");
  if (!wanted && !known)
    place.fail("missing_key",
               "which of its words are coefficients? Give coefficients: [c1, c2] to fit them, "
               "or known: {c1: 0.1, c2: 0.2}");
  if (wanted) {
    for (const Reader& item : wanted->items()) read_coefficient(item, item.text(), names, fit);
    if (fit.coefficients.empty()) wanted->fail("empty_list", "has no coefficients; give at least one: [c1]");
  } else if (known) {
    for (const auto& [name, value] : known->members()) {
      read_coefficient(value, name, names, fit);
      fit.known.push_back(value.number());
    }
    if (fit.coefficients.empty())
      known->fail("empty_map", "has no coefficients; give at least one: {c1: 0.1}");
  }
}

/// `c1*e2 + 2 c2*e1` sorted by coefficients, which are numbered behind the columns. Whether it could be read.
bool read_formula(const Reader& place, const Names& names, std::size_t columns, FitEquation& equation) {
  equation.text = place.text();
  equation.terms.resize(names.size() - columns);
  if (!place.is(Node::Kind::string)) return false;
  std::size_t number = 0, refused = 0;
  for (Monomial& monomial : read_sum(place, names, "column or coefficient")) {
    ++number;
    const auto is_coefficient = [&](std::size_t column) { return column >= columns; };
    const auto found = std::ranges::find_if(monomial.columns, is_coefficient);
    if (std::ranges::count_if(monomial.columns, is_coefficient) != 1) {
      place.fail("bad_term",
                 fmt::format("summand {} has {} coefficient; it must have exactly one of {}, to the "
                             "first power",
                             number, found == monomial.columns.end() ? "no" : "more than one",
                             fmt::join(std::span(names).subspan(columns), ", ")));
      ++refused;
      continue;
    }
    auto& term = equation.terms[*found - columns];
    monomial.columns.erase(found);
    term.push_back(std::move(monomial));
  }
  return number > 0 && refused == 0;
}

/// `{coefficients: [c1], of: {x: "c1*e2", y: "-c1*e1"}}`
void read_formulas(Reader& place, const Names& names, StudyFit& fit) {
  read_coefficients(place, names, fit);
  if (fit.coefficients.empty()) return void(place.has("of"));  // said already
  Names words = names;
  words.insert(words.end(), fit.coefficients.begin(), fit.coefficients.end());
  bool is_read = true;
  const Reader of = place.required("of", "columns and what each is: {x: \"c1*e2\"}");
  for (const auto& [name, formula] : of.members()) {
    FitEquation equation{.column = read_column(formula, name, names), .text = {}, .terms = {}};
    is_read = read_formula(formula, words, names.size(), equation) && is_read;
    fit.equations.push_back(std::move(equation));
  }
  if (of.is(Node::Kind::map) && fit.equations.empty())
    of.fail("empty_map", "names no column; give at least one: {x: \"c1*e2\"}");
  // a formula that could not be read uses nothing
  for (std::size_t c = 0; is_read && !fit.equations.empty() && c < fit.coefficients.size(); ++c)
    if (std::ranges::all_of(fit.equations, [c](const FitEquation& one) { return one.terms[c].empty(); }))
      place.fail("unused_coefficient", fmt::format("{} is in no formula; remove it", fit.coefficients[c]));
}

}  // namespace

void read_fits(const Reader& place, Study& study) {
  if (!study.reductions.empty())
    place.fail("not_available", "are of samples, and reduce keeps none; make two studies");
  Names names;
  for (std::size_t c = 0; c < study.column_count(); ++c) names.push_back(study.column_name(c));
  for (auto& [name, one] : place.members()) {
    check_name(one, name);
    StudyFit fit{.name = name, .coefficients = {}, .known = {}, .equations = {}};
    const Node* of = one.is(Node::Kind::map) ? one.node()->find("of") : nullptr;
    if (one.has("coefficients") || one.has("known") || (of && of->kind == Node::Kind::map))
      read_formulas(one, names, fit);
    else
      read_terms(one, names, fit);
    one.close();
    study.fits.push_back(std::move(fit));
  }
}

}  // namespace sinew::inline v1
