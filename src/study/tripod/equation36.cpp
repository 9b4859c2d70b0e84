/// 3PFS (36): parasitic motion as polynomials of the tilt, the paper's and ours. The paper prints seven
/// coefficients "with low error"; the poses are those of preset G1 at 0.2 m, which was found by them.
#include "study/tripod/equation36.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/swept.hpp"

namespace sinew::inline v1 {
namespace tripod {

Parasitic36 equation_36(const Coefficients36& c, double e1, double e2, bool as_printed) {
  const double sign = as_printed ? 1 : -1, s1 = e1 * e1, s2 = e2 * e2;
  const double x = c[3] * s1 * s1 * e2 + 2 * c[2] * s1 * e1 * e2 - 4 * c[4] * s1 * s2 * e2 + c[3] * s1 * e2 +
                   2 * c[2] * e1 * e2 - c[4] * e1 * s2 * e2 + c[1] * e2 + c[3] * s2 * e2 -
                   c[5] * s2 * s2 * e2;
  const double y = 2 * c[2] * s1 * s1 * e1 + sign * c[6] / 5 * s1 * s1 - 2 * c[4] * s1 * e1 * s2 +
                   sign * c[3] * s1 * e1 + c[6] * s1 * s2 + c[2] * s1 + 2 * c[4] * e1 * s2 * s2 +
                   sign * c[3] * e1 * s2 - c[1] * e1 - c[5] * s2 * s2 - c[2] * s2;
  return {-3 * c[0] * s1 * e2 + c[0] * s2 * e2, x, y};
}

}  // namespace tripod

namespace {

using tripod::Coefficients36, tripod::Parasitic36, tripod::Swept;

/// Ours, and a formula at the same tilts.
struct Compared {
  std::vector<double> ours_e3, ours_shift, e3, shift;  ///< shift: x of all, then y of all [m]

  Compared(const Swept& study, const Coefficients36& c, bool as_printed) {
    std::vector<double> y;
    for (std::size_t k = 0; k < study.size(); ++k) {
      const Parasitic36 at = tripod::equation_36(c, study["e1"][k], study["e2"][k], as_printed);
      e3.push_back(at.e3), shift.push_back(at.x), y.push_back(at.y);
    }
    shift.insert(shift.end(), y.begin(), y.end());
    ours_e3 = study["e3"], ours_shift = study["x"];
    ours_shift.insert(ours_shift.end(), study["y"].begin(), study["y"].end());
  }
};

/// Root mean square of the difference over that of the first.
double apart(const std::vector<double>& first, const std::vector<double>& other) {
  std::vector<double> off;
  for (std::size_t k = 0; k < first.size(); ++k) off.push_back(first[k] - other[k]);
  return tripod::root_mean_square(off) / tripod::root_mean_square(first);
}

Finding low_error(std::string quantity, double of_formula, double of_ours, double bound) {
  return compare::given(
      std::move(quantity), "fits with low error",
      fmt::format("{:.1f} % of the formula, {:.1f} % of ours", 100 * of_formula, 100 * of_ours),
      std::max(of_formula, of_ours), bound, "");
}

void add_errors(std::vector<Finding>& findings, const Swept& study) {
  const Compared right(study, tripod::printed_36, false), literal(study, tripod::printed_36, true);
  findings.push_back(low_error("(36), corrected signs, x_p and y_p", apart(right.shift, right.ours_shift),
                               apart(right.ours_shift, right.shift), 0.12));
  findings.push_back(
      low_error("(36), e_3", apart(right.e3, right.ours_e3), apart(right.ours_e3, right.e3), 0.05));
  findings.push_back(low_error("(36) as printed, x_p and y_p", apart(literal.shift, literal.ours_shift),
                               apart(literal.ours_shift, literal.shift), 0.12));
}

const FittedTerms& fit_of(const Swept& study, std::string_view name) {
  return *std::ranges::find(study.summary.fits, name, &FittedTerms::name);
}

void add_coefficients(std::vector<Finding>& findings, const Swept& study) {
  for (const char* name : {"ours_turn", "ours"}) {
    const FittedTerms& fit = fit_of(study, name);
    const bool is_turn = fit.terms.size() == 1;
    for (std::size_t k = 0; k < fit.terms.size(); ++k) {
      const double printed = tripod::printed_36[is_turn ? 0 : k + 1], c = fit.coefficients[k],
                   deviation = fit.deviations[k];
      findings.push_back({fmt::format("{}, least squares", fit.terms[k]), fmt::format("{:g}", printed),
                          fmt::format("{:.4f} ± {:.4f}", c, deviation), fmt::format("{:+.4f}", c - printed),
                          "for information"});
    }
    for (const FittedColumn& column : fit.columns)
      findings.push_back({fmt::format("what is left of {}", column.name), "not printed",
                          fmt::format("{:.1f} % of its rms", 100 * column.relative), "", "for information"});
  }
  const FittedTerms& lowest = fit_of(study, "lowest");
  findings.push_back({"what is left of x and y by the terms up to the third power alone", "not printed",
                      fmt::format("{:.1f} %, {:.1f} %: c_4 to c_6 are hardly determined, their functions are "
                                  "small and c_1 and c_3 trade",
                                  100 * lowest.columns[0].relative, 100 * lowest.columns[1].relative),
                      "", "for information"});
}

/// Turned by a third, a tilt has its shift turned by a third and the same e₃.
double asymmetry(bool as_printed) {
  const double c = -0.5, s = std::sqrt(0.75);
  double off = 0;
  for (int k = 0; k < 24; ++k) {
    const double e1 = 0.25 * std::cos(0.1 + k), e2 = 0.25 * std::sin(0.1 + k);
    const auto one = tripod::equation_36(tripod::printed_36, e1, e2, as_printed);
    const auto other = tripod::equation_36(tripod::printed_36, c * e1 - s * e2, s * e1 + c * e2, as_printed);
    off = std::max({off, std::hypot(other.x - c * one.x + s * one.y, other.y - s * one.x - c * one.y) /
                             std::hypot(one.x, one.y)});
  }
  return off;
}

void add_reasons(std::vector<Finding>& findings) {
  findings.push_back(
      {"radii, pairs, inputs", "not printed",
       "G1, 0.2 m high, and its inputs were found by these coefficients and the root mean squares "
       "of e_3: that (36) fits shows that one geometry explains both. The bounds, 12 % and 5 %, are ours",
       "", "for information"});
  findings.push_back(
      {"± of the coefficients", "not printed",
       "standard deviations as if what is left were noise; it is terms left out. Functions can "
       "be compared, coefficients hardly",
       "", "for information"});
}

void add_signs(std::vector<Finding>& findings) {
  findings.push_back(
      {"signs of c_3 e_1³, c_3 e_1 e_2², c_6/5 e_1⁴ in y_p", "+",
       "−: as x_p and the symmetry by thirds ask for",
       fmt::format(
           "tilts turned by 120°: the shift turns with them to {:.0e} of itself with −, to {:.1f} with +",
           asymmetry(false), asymmetry(true)),
       asymmetry(false) < 0.01 * asymmetry(true) ? "differs" : "fails"});
  findings.push_back({"last row of (36)", "0", "1: it is the norm of a quaternion", "", "differs"});
}

/// How far polynomials are from equilibria.
Panel panel_of(std::string title, const char* unit, double scale, const std::vector<double>& ours,
               const std::vector<double>& formula, const std::vector<double>& fitted, double reach,
               double off) {
  const auto scaled = [&](std::vector<double> values) {
    for (double& value : values) value *= scale;
    return values;
  };
  const auto beyond = [&](std::vector<double> values) {
    for (std::size_t k = 0; k < values.size(); ++k) values[k] -= ours[k];
    return scaled(std::move(values));
  };
  return {.title = std::move(title),
          .x = {.label = "in equilibrium", .unit = unit, .low = -reach, .high = reach},
          .y = {.label = "polynomial, less that", .unit = unit, .low = -off, .high = off},
          .series = {{.label = "",
                      .x = {-reach, reach},
                      .y = {0, 0},
                      .mark = Mark::line,
                      .colour = Colour::grey,
                      .width = 1},
                     {.label = "(36), corrected signs",
                      .x = scaled(ours),
                      .y = beyond(formula),
                      .mark = Mark::points,
                      .colour = Colour::vermillion,
                      .width = 5},
                     {.label = "same form, fitted",
                      .x = scaled(ours),
                      .y = beyond(fitted),
                      .mark = Mark::points,
                      .colour = Colour::blue,
                      .width = 3.5}},
          .legend = Legend::top_left};
}

Figure figure_of(const Swept& study) {
  Coefficients36 fitted{fit_of(study, "ours_turn").coefficients[0]};
  std::ranges::copy(fit_of(study, "ours").coefficients, fitted.begin() + 1);
  const Compared paper(study, tripod::printed_36, false), ours(study, fitted, false);
  const auto half = [&](const std::vector<double>& both, bool second) {
    const auto n = static_cast<std::ptrdiff_t>(study.size());
    return second ? std::vector<double>(both.begin() + n, both.end())
                  : std::vector<double>(both.begin(), both.begin() + n);
  };
  return {.title = "",
          .panels = {panel_of("e₃", "", 1, paper.ours_e3, paper.e3, ours.e3, 0.035, 0.002),
                     panel_of("x_p", "mm", 1e3, study["x"], half(paper.shift, false), half(ours.shift, false),
                              45, 10),
                     panel_of("y_p", "mm", 1e3, study["y"], half(paper.shift, true), half(ours.shift, true),
                              45, 10)},
          .columns = 3,
          .width = 1500,
          .height = 500,
          .comments = {fmt::format("sinew {}: [3PFS] (36) beside equilibria", version())}};
}

}  // namespace

Expected<ItemResult> tripod_equation36(const StudyItem&, const std::filesystem::path& folder) {
  const auto study = tripod::swept("3pfs-equation-36", folder);
  if (!study) return tl::unexpected(study.error());
  ItemResult result{{}, {study->file}, {}, {}};
  add_errors(result.findings, *study);
  add_coefficients(result.findings, *study);
  add_signs(result.findings);
  add_reasons(result.findings);
  result.figures.emplace_back("equation36", figure_of(*study));
  return result;
}

}  // namespace sinew::inline v1
