/// LSK Fig. 9: mean error of a tendon's length past one joint when the data type is downgraded, by (6) as it
/// is printed, by (7), and by the kernel's chord factor. The text names no fixed-point formats; these are
/// ours. Theory: docs/theory/model_error.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/number_formats.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;
using Formats = std::vector<FormatErrors>;

constexpr int samples = 48001;  ///< a thousandth of a degree apart, 0 among them
constexpr double under = 0.01;  ///< what the paper says of LSK

Formats formats() {
  return format_errors({lsk::printed.joint, lsk::printed.tendon_radius, lsk::printed.limit * degree},
                       samples);
}

// ---------------------------------------------------------------- table

Table table_of(const Formats& all) {
  Table table{"bits",           "integer_bits",      "pcc_mean[%]",   "pcc_largest[%]",
              "lsk_mean[%]",    "lsk_largest[%]",    "chord_mean[%]", "chord_largest[%]",
              "inputs_mean[%]", "inputs_largest[%]", "pcc_down[%]",   "lsk_down[%]",
              "chord_down[%]",  "pcc_wrapping[%]",   "pcc_plain[%]",  "overflows_below[deg]"};
  table.comments = lsk::provenance("lsk/fig9", "errors of a tendon's length over +-24 deg, delta = 0, in mm");
  std::string rows;
  for (const FormatErrors& f : all) rows += (rows.empty() ? "rows: " : ", ") + std::string(f.name);
  table.comments.push_back(rows);
  table.comments.push_back(fmt::format(
      "{} bends; down: rounded down, saturating; wrapping: rounded to nearest; plain: both", samples));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const FormatErrors& f : all) {
    std::vector<double> row{double(f.bits), f.integer_bits ? double(*f.integer_bits) : none};
    for (const LengthError& error : {f.nearest.quotient, f.nearest.linear, f.nearest.chord, f.inputs}) {
      row.push_back(100 * error.mean);
      row.push_back(100 * error.largest);
    }
    if (f.coded) {
      for (const LengthError& error : {f.coded->down.quotient, f.coded->down.linear, f.coded->down.chord,
                                       f.coded->wrapping.quotient, f.coded->plain.quotient})
        row.push_back(100 * error.mean);
      row.push_back(f.coded->overflows_below / degree);
    }
    row.resize(table.columns.size(), none);
    table.add_row(row);
  }
  return table;
}

// ---------------------------------------------------------------- findings

std::string in_percent(double error) { return fmt::format("{:.3g} %", 100 * error); }
std::string in_percent(const LengthError& error) {
  return in_percent(error.mean) + " (" + in_percent(error.largest) + ")";
}

Finding derived(std::string quantity, std::string ours, bool holds) {
  return {std::move(quantity), "not stated", std::move(ours), "", holds ? "holds" : "fails"};
}

std::string where_it_overflows(const FormatErrors::Coded& coded) {
  const double below = coded.overflows_below / degree;
  return below < lsk::printed.limit ? fmt::format("below {:.2g}°", below) : "at every bend";
}

/// What the paper claims of every data type: LSK under 1 %, and in fixed point PCC larger.
Finding finding_of(const FormatErrors& f) {
  const bool small = f.nearest.linear.mean<under, larger = f.nearest.quotient.mean> f.nearest.linear.mean;
  std::string ours = fmt::format("(6) {}; (7) {}; by the chord factor {}; rounded inputs alone {}",
                                 in_percent(f.nearest.quotient), in_percent(f.nearest.linear),
                                 in_percent(f.nearest.chord), in_percent(f.inputs.mean));
  if (f.coded) ours += fmt::format("; L/β overflows {}", where_it_overflows(*f.coded));
  return {fmt::format("{}: mean error (largest)", f.name),
          f.coded ? "(7) under 1 %, (6) larger" : "(7) under 1 %", ours, "",
          small && (larger || !f.coded) ? "holds" : "fails"};
}

const FormatErrors& format_named(const Formats& all, std::string_view name) {
  return *std::ranges::find(all, name, &FormatErrors::name);
}

/// Of so many bits, from many before the point to few.
std::vector<const FormatErrors*> fixed_of(const Formats& all, int min_bits, int max_bits) {
  std::vector<const FormatErrors*> some;
  for (const FormatErrors& f : all)
    if (f.coded && f.bits >= min_bits && f.bits <= max_bits) some.push_back(&f);
  return some;
}

Finding overflow_finding(const Formats& all) {
  const auto some = fixed_of(all, 16, 16);
  std::string ours;
  for (const FormatErrors* f : some)
    ours += fmt::format("{}{} {}", ours.empty() ? "" : ", ", f->name, in_percent(f->nearest.quotient.mean));
  return derived(
      "16 bits: the fewer before the point, the worse is (6), by overflow of L/β", ours,
      std::ranges::is_sorted(some, {}, [](const FormatErrors* f) { return f->nearest.quotient.mean; }));
}

Finding chord_finding(const Formats& all) {
  double least = std::numeric_limits<double>::infinity();
  std::string_view where;
  for (const FormatErrors& f : all) {
    const double ratio = f.nearest.linear.mean / f.nearest.chord.mean;
    if (f.bits < 16 || !(ratio < least)) continue;
    least = ratio;
    where = f.name;
  }
  return derived("from 16 bits on the chord factor is nearer than (7) in every format",
                 fmt::format("{:.2g} times at least, in {}", least, where), least > 1);
}

Finding wrapping_finding(const Formats& all) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const FormatErrors* f : fixed_of(all, 16, 32)) {
    const double ratio = f->coded->wrapping.quotient.mean / f->nearest.quotient.mean;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return derived("overflow that wraps around makes (6) worse still",
                 fmt::format("{:.2g} to {:.2g} times; (7) never overflows", least, most), least > 1);
}

Finding rounding_finding(const Formats& all) {
  double most = 0;
  for (const FormatErrors* f : fixed_of(all, 16, 32)) most = std::max(most, f->coded->down.linear.mean);
  const LengthErrors& down = format_named(all, "Q7.8").coded->down;
  return {
      "16 bits and more, every result rounded down by a shift", "(7) under 1 %",
      fmt::format("(7) {} at most; Q7.8: (6) {}, (7) {}, by the chord factor {}", in_percent(most),
                  in_percent(down.quotient.mean), in_percent(down.linear.mean), in_percent(down.chord.mean)),
      "", most < under ? "holds" : "fails"};
}

Finding short_finding(const Formats& all) {
  std::string ours;
  bool breaks = true;
  for (const FormatErrors* f : fixed_of(all, 8, 8)) {
    const double down = f->coded->down.linear.mean;
    ours +=
        fmt::format("{}{} {}, rounded down {}, rounded inputs alone {}", ours.empty() ? "" : "; ", f->name,
                    in_percent(f->nearest.linear.mean), in_percent(down), in_percent(f->inputs.mean));
    breaks = breaks && down > under;
  }
  return derived("8 bits rounded down are too few for (7) too: they hardly hold L, r and β", ours, breaks);
}

std::vector<Finding> findings(const Formats& all) {
  std::vector<Finding> rows;
  for (const FormatErrors& f : all) rows.push_back(finding_of(f));
  rows.push_back(overflow_finding(all));
  rows.push_back(chord_finding(all));
  rows.push_back(wrapping_finding(all));
  rows.push_back(rounding_finding(all));
  rows.push_back(short_finding(all));
  rows.push_back({"a column for double", "drawn",
                  "avr-g++ has double of 4 bytes: on the ATmega2560 of 6.1 it is the column of float", "",
                  "differs"});
  return rows;
}

// ---------------------------------------------------------------- figure

struct Curve {
  const char* label;
  Mark mark;
  Colour colour;
  double width;
  LengthError (*of)(const FormatErrors&);
  double aside = 0;  ///< of its format's place in panel (a): equal errors do not hide one another
};
/// Blue and red as in the paper.
constexpr Curve quotient{"constant curvature, (6) as printed",
                         Mark::points,
                         Colour::blue,
                         5,
                         [](const FormatErrors& f) { return f.nearest.quotient; },
                         -0.2};
constexpr Curve linearised{"linearised, (7)", Mark::points, Colour::vermillion, 5,
                           [](const FormatErrors& f) { return f.nearest.linear; }};
constexpr Curve chord{"constant curvature by the chord factor",
                      Mark::points,
                      Colour::green,
                      5,
                      [](const FormatErrors& f) { return f.nearest.chord; },
                      0.2};
constexpr Curve inputs{"rounding L, r, β alone",
                       Mark::circles,
                       Colour::grey,
                       3,
                       [](const FormatErrors& f) { return f.inputs; },
                       0.2};
constexpr Curve wrapping{"(6), overflow wraps around", Mark::circles, Colour::blue, 3,
                         [](const FormatErrors& f) { return f.coded->wrapping.quotient; }};

Series series_of(const Curve& curve) { return {curve.label, {}, {}, curve.mark, curve.colour, curve.width}; }

constexpr double lowest = 1e-8, highest = 300;  ///< [%]

/// A curve at every format; what lies below the panel is written at its foot.
void add_curve(Panel& panel, const Curve& curve, const Formats& all, double foot) {
  Series series = series_of(curve);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double mean = 100 * curve.of(all[k]).mean, place = double(k + 1);
    const bool is_below = !(mean > lowest);
    series.x.push_back(place + curve.aside);
    series.y.push_back(is_below ? std::numeric_limits<double>::quiet_NaN() : mean);
    if (is_below && mean > 0)
      panel.notes.push_back({fmt::format("{:.0e}", mean), place, foot, Note::Side::centre, curve.colour});
  }
  panel.series.push_back(series);
}

/// All formats, one beside the other.
Panel formats_panel(const Formats& all) {
  const double end = double(all.size()) + 0.6;
  Panel panel{"(a) mean error by data type",
              {.label = "", .unit = "", .low = 0.4, .high = end, .step = 100},
              {.label = "mean error", .unit = "%", .log = true, .low = lowest, .high = highest},
              {}};
  add_curve(panel, inputs, all, lowest);
  add_curve(panel, quotient, all, 80 * lowest);
  add_curve(panel, linearised, all, lowest);
  add_curve(panel, chord, all, 16 * lowest);
  panel.series.push_back({"1 %", {0.4, end}, {1, 1}, Mark::dashed, Colour::black, 1.5});
  for (std::size_t k = 0; k < all.size(); ++k)
    panel.notes.push_back(
        {std::string(all[k].name), double(k + 1), 2.5 * lowest, Note::Side::centre, Colour::black});
  panel.legend = Legend::below;
  return panel;
}

/// 16 bits: what the point's place does.
Panel point_panel(const Formats& all) {
  Panel panel{"(b) 16 bits: where the point is",
              {.label = "bits before the point", .unit = "", .low = 1.5, .high = 7.5, .step = 1},
              {.label = "mean error", .unit = "%", .log = true, .low = 1e-3, .high = highest},
              {}};
  for (const Curve* curve : {&wrapping, &quotient, &linearised, &chord, &inputs}) {
    Series series = series_of(*curve);
    for (const FormatErrors* f : fixed_of(all, 16, 16)) {
      series.x.push_back(*f->integer_bits);
      series.y.push_back(100 * curve->of(*f).mean);
    }
    panel.series.push_back(series);
  }
  panel.legend = Legend::below;
  return panel;
}

Figure figure_of(const Formats& all) {
  return {.title = "",
          .panels = {formats_panel(all), point_panel(all)},
          .columns = 1,
          .width = 1100,
          .height = 1000,
          .comments = lsk::provenance("lsk/fig9", "Fig. 9")};
}

}  // namespace

Expected<ItemResult> lsk_fig9(const StudyItem&, const std::filesystem::path&) {
  const Formats all = formats();
  return ItemResult{findings(all), {}, {{"fig9", table_of(all)}}, {{"fig9", figure_of(all)}}};
}

}  // namespace sinew::inline v1
