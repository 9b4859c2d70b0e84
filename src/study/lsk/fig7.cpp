/// LSK Fig. 7: relative error (17) of the linearised length over ±45° and the parabola (18), and what other
/// ways of fitting a parabola give. Theory: docs/theory/model_error.md
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/chord_error.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;

constexpr double range = 45 * degree;
constexpr double printed = 1.289e-3;            ///< of (18) [%/deg²]
constexpr double unit = 100 * degree * degree;  ///< 1/rad² in %/deg²

struct Way {
  QuadraticFit fit;
  const char* name;
  Mark mark;
  Colour colour;
};
constexpr std::array ways{
    Way{QuadraticFit::least_squares, "least squares of c β²", Mark::line, Colour::blue},
    Way{QuadraticFit::with_constant, "least squares of c β² + c₀", Mark::dashed, Colour::vermillion},
    Way{QuadraticFit::minimax, "least largest miss", Mark::line, Colour::green},
    Way{QuadraticFit::endpoint, "through the ends", Mark::dotted, Colour::purple}};

double percent(double bend) { return 100 * chord_error(bend); }

/// [%] at a bend [rad].
double value(const Quadratic& q, double bend) { return 100 * (q.coefficient * bend * bend + q.constant); }

Table table_of() {
  Table table{"beta[deg]",        "error[%]",   "printed[%]",  "least_squares[%]",
              "with_constant[%]", "minimax[%]", "endpoint[%]", "taylor[%]"};
  table.comments = lsk::provenance("lsk/fig7", "error (17) and parabolas through it over +-45 deg");
  const Quadratic taylor = fit_chord_error(QuadraticFit::taylor, range);
  std::array<Quadratic, ways.size()> fits;
  std::ranges::transform(ways, fits.begin(), [](const Way& way) { return fit_chord_error(way.fit, range); });
  for (int k = -90; k <= 90; ++k) {
    const double bend = 0.5 * k * degree;
    table.add_row({0.5 * k, percent(bend), printed * 0.25 * k * k, value(fits[0], bend), value(fits[1], bend),
                   value(fits[2], bend), value(fits[3], bend), value(taylor, bend)});
  }
  return table;
}

/// Largest miss of the printed parabola on a fine grid [%].
double printed_miss() {
  double most = 0;
  for (int k = 0; k <= 4500; ++k)
    most = std::max(most, std::abs(percent(0.01 * k * degree) - printed * 1e-4 * k * k));
  return most;
}

void add_fits(std::vector<Finding>& findings) {
  const auto coefficient = [](QuadraticFit fit) { return fit_chord_error(fit, range).coefficient * unit; };
  const auto row = [&](const char* name, QuadraticFit fit, double within = range) {
    const Quadratic q = fit_chord_error(fit, within);
    Finding finding = compare::given(name, "1.289e-3", fmt::format("{:.4e} %/deg²", q.coefficient * unit),
                                     std::abs(q.coefficient * unit - printed), 0.0005e-3, "%/deg²");
    finding.ours += fmt::format(", off by {:.4f} % at most", 100 * q.largest_miss);
    findings.push_back(finding);
  };
  row("(18), pure quadratic by least squares", QuadraticFit::least_squares);
  row("(18), least squares with a constant, which is then dropped", QuadraticFit::with_constant);
  row("(18), least largest miss", QuadraticFit::minimax);
  row("(18), first term of the series, β²/24", QuadraticFit::taylor);
  row("(18), through the error at 45°", QuadraticFit::endpoint);
  row("(18), pure quadratic by least squares over ±24°", QuadraticFit::least_squares, 24 * degree);
  const Quadratic constant = fit_chord_error(QuadraticFit::with_constant, range);
  findings.push_back({"the constant that goes with 1.289e-3", "none",
                      fmt::format("{:.3e} %", 100 * constant.constant), "", "for information"});
  findings.push_back(
      compare::claimed("(18) fits very accurately", "shown",
                       fmt::format("off by {:.4f} % at most; the best c β² by {:.4f} %", printed_miss(),
                                   100 * fit_chord_error(QuadraticFit::minimax, range).largest_miss),
                       printed_miss() / percent(range), 0.01, "of the largest error"));
  findings.push_back(compare::claimed(
      "derived: Taylor < least squares < minimax < with constant < endpoint", "not stated", "over ±45°",
      coefficient(QuadraticFit::taylor) < coefficient(QuadraticFit::least_squares) &&
              coefficient(QuadraticFit::least_squares) < coefficient(QuadraticFit::minimax) &&
              coefficient(QuadraticFit::minimax) < coefficient(QuadraticFit::with_constant) &&
              coefficient(QuadraticFit::with_constant) < coefficient(QuadraticFit::endpoint)
          ? 0.0
          : 1.0,
      0, ""));
}

void add_errors(std::vector<Finding>& findings) {
  const ChordErrors table2 = chord_errors(24 * degree), wide = chord_errors(range);
  double off = 0;
  for (int k = 1; k <= 450; ++k) {
    const double bend = 0.1 * k * degree;
    off = std::max(off, std::abs(chord_error(bend) - (bend / (2 * std::sin(bend / 2)) - 1)));
  }
  findings.push_back(
      compare::given("e(β), (17) as printed, β ≠ 0", "|β/(2 sin(β/2)) − 1|", "450 bends", off, 1e-15, ""));
  findings.push_back(compare::claimed("(19) at 24°", "0.7 %", fmt::format("{:.6f} %", 100 * table2.largest),
                                      std::abs(100 * table2.largest - 0.7), 0.05, "%"));
  findings.push_back({"(19) at 45°", "drawn, not printed", fmt::format("{:.5f} %", 100 * wide.largest), "",
                      "for information"});
  findings.push_back(compare::given("(20) over ±24°: mean a third of the largest",
                                    fmt::format("{:.6f} %", 100 * table2.largest / 3),
                                    fmt::format("{:.6f} %", 100 * table2.mean),
                                    100 * std::abs(table2.mean - table2.largest / 3), 1e-6, "%"));
  findings.push_back(compare::given("(20) over ±45°", fmt::format("{:.5f} %", 100 * wide.largest / 3),
                                    fmt::format("{:.5f} %", 100 * wide.mean),
                                    100 * std::abs(wide.mean - wide.largest / 3), 1e-6, "%"));
}

Figure figure_of() {
  Series error{"error (17)", {}, {}, Mark::line, Colour::blue, 4};
  Series fit{"(18): 1.289e-3 β²", {}, {}, Mark::dashed, Colour::vermillion, 2};
  std::vector<Series> misses;
  misses.push_back({"(18) as printed", {}, {}, Mark::line, Colour::black, 2.5});
  for (const Way& way : ways) misses.push_back({way.name, {}, {}, way.mark, way.colour, 2});
  for (int k = -90; k <= 90; ++k) {
    const double bend = 0.5 * k * degree;
    for (Series* series : {&error, &fit}) series->x.push_back(0.5 * k);
    error.y.push_back(percent(bend));
    fit.y.push_back(printed * 0.25 * k * k);
    for (std::size_t i = 0; i < misses.size(); ++i) {
      misses[i].x.push_back(0.5 * k);
      misses[i].y.push_back((i == 0 ? fit.y.back() : value(fit_chord_error(ways[i - 1].fit, range), bend)) -
                            percent(bend));
    }
  }
  const Axis bend{.label = "β", .unit = "deg", .low = -45, .high = 45, .step = 15};
  Panel left{"(a) error of a linearised length",
             bend,
             {.label = "error", .unit = "%", .low = 0, .high = 3.5},
             {error, fit}};
  left.legend = Legend::top_left;
  Panel right{"(b) parabolas minus the error",
              bend,
              {.label = "difference", .unit = "%", .low = -0.04, .high = 0.015},
              misses};
  right.legend = Legend::bottom_left;
  return {.title = "",
          .panels = {left, right},
          .columns = 2,
          .width = 1200,
          .height = 500,
          .comments = lsk::provenance("lsk/fig7", "Fig. 7")};
}

}  // namespace

Expected<ItemResult> lsk_fig7(const StudyItem&, const std::filesystem::path&) {
  ItemResult result;
  add_errors(result.findings);
  add_fits(result.findings);
  result.tables.emplace_back("fig7", table_of());
  result.figures.emplace_back("fig7", figure_of());
  return result;
}

}  // namespace sinew::inline v1
