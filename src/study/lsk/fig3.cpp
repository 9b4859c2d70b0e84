/// LSK Fig. 3: length of a tendon past one joint, exact (6) and linear (7), over the bends of Table 2. The
/// curves lie on one another at the paper's scale; their distance is drawn beside them.
/// Theory: docs/theory/model_error.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/chord_error.hpp"
#include "sinew/io/robot_file.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;

/// One joint of a section, tendon in its bending plane. [rad], [m]
struct Lengths {
  double bend, exact, linear;
};

/// By the maps of a section of two twin pivots, of which one stays straight.
Lengths lengths(Section section, double bend) {
  section.segments = 2;
  const auto map = section.map();
  const auto at = kernel::direction<double>(0);
  const kernel::Bend<double> b{bend, 0};
  return {bend, section.joint + kernel::tendon_change(kernel::exact_pull(map, b), at),
          section.joint + kernel::tendon_change(kernel::linear_pull(map, b), at)};
}

std::vector<Lengths> curve(const Section& section) {
  std::vector<Lengths> all;
  for (int k = -96; k <= 96; ++k) all.push_back(lengths(section, k * section.limit / 96));
  return all;
}

Table table_of(const std::vector<Lengths>& all) {
  Table table{"beta[deg]", "exact[mm]", "linear[mm]", "error[%]"};
  table.comments = lsk::provenance("lsk/fig3", "length of a tendon past one joint, (6) and (7), delta = 0");
  for (const Lengths& l : all)
    table.add_row({l.bend / degree, l.exact * 1e3, l.linear * 1e3, 100 * (l.linear / l.exact - 1)});
  return table;
}

std::vector<Finding> findings(const Section& section, const std::vector<Lengths>& all) {
  const double L = section.joint, r = section.tendon_radius;
  double most = 0, off_error = 0, off_naive = 0, longest = 0;
  for (const Lengths& l : all) {
    const double error = l.linear / l.exact - 1;
    most = std::max(most, error);
    longest = std::max(longest, l.linear - l.exact);
    off_error = std::max(off_error, std::abs(error - chord_error(l.bend)));
    if (l.bend != 0)
      off_naive = std::max(off_naive, std::abs(l.exact - 2 * (L / l.bend - r) * std::sin(l.bend / 2)));
  }
  const Lengths straight = lengths(section, 0);
  const double h = 1e-6, slope = (lengths(section, h).exact - lengths(section, -h).exact) / (2 * h);
  return {
      compare::claimed("largest error", "0.7 %", fmt::format("{:.4f} %", 100 * most),
                       std::abs(100 * most - 0.7), 0.05, "%"),
      compare::given("the error is (17), whatever L and r_c", "β/(2 sin(β/2)) − 1",
                     fmt::format("{} bends", all.size()), off_error, 1e-15, ""),
      compare::given("exact length, (6) as printed, β ≠ 0", "2 (L/β − r_c) sin(β/2)",
                     fmt::format("{} bends", all.size() - 1), off_naive, 1e-17, "m"),
      compare::given("its limit at β = 0, where (6) divides by 0", "L",
                     fmt::format("{} mm", compare::number(straight.exact * 1e3)),
                     std::abs(straight.exact - L), 0, "m"),
      compare::claimed("slope at 0, of the Maclaurin series (7)", "−r_c",
                       fmt::format("{:.6f} mm/rad", slope * 1e3), std::abs(slope + r), 1e-12, "m/rad"),
      {"linear minus exact length, never below 0", "not printed",
       fmt::format("{:.4g} µm at most, at β = {:.0f}°", longest * 1e6, all.front().bend / degree), "",
       "for information"},
  };
}

Figure figure_of(const std::vector<Lengths>& all) {
  Series exact{"constant curvature, (6)", {}, {}, Mark::line, Colour::blue, 4};
  Series linear{"linearised, (7)", {}, {}, Mark::dashed, Colour::vermillion, 2};
  Series beyond{"", {}, {}, Mark::line, Colour::black, 2};
  for (const Lengths& l : all) {
    for (Series* series : {&exact, &linear, &beyond}) series->x.push_back(l.bend / degree);
    exact.y.push_back(l.exact * 1e3);
    linear.y.push_back(l.linear * 1e3);
    beyond.y.push_back((l.linear - l.exact) * 1e6);
  }
  const Axis bend{.label = "β", .unit = "deg", .low = -24, .high = 24, .step = 8};
  Panel lengths{"(a) length of a tendon past one joint", bend, {"length", "mm"}, {exact, linear}};
  lengths.legend = Legend::top_right;
  Panel error{"(b) linear minus exact", bend, {"difference", "µm"}, {beyond}};
  error.legend = Legend::none;
  return {.title = "",
          .panels = {lengths, error},
          .columns = 2,
          .width = 1100,
          .height = 440,
          .comments = lsk::provenance("lsk/fig3", "Fig. 3")};
}

}  // namespace

Expected<ItemResult> lsk_fig3(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load_serial("nottingham-tpcj");
  if (!robot) return tl::unexpected(robot.error());
  const Section& section = robot->sections.front();
  const std::vector<Lengths> all = curve(section);
  return ItemResult{findings(section, all), {}, {{"fig3", table_of(all)}}, {{"fig3", figure_of(all)}}};
}

}  // namespace sinew::inline v1
