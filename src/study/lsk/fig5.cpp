/// LSK Fig. 5: three tendons that agree on one bend, on many, on none, and, which the paper leaves out, on
/// bends beyond the limits only. The paper draws no numbers; ours are section 1 of Table 2.
/// Theory: docs/theory/section_diagram.md
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "math/polygon.hpp"
#include "sinew/io/robot_file.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;

constexpr double state_reach = 36;  ///< of the panels [deg]

/// A bend, how much more its three tendons are paid out, and what that makes of them.
struct Situation {
  const char* name;
  Bend meant;
  double more;  ///< [m]
  TendonConsistency expected;
  SectionDiagram diagram;
  std::vector<double> changes;
};

std::vector<Situation> situations(const Section& section) {
  std::vector<Situation> all{
      {"(a) exact: one bend", lsk::in_degrees(10, -5), 0, TendonConsistency::exact, {}, {}},
      {"(b) indeterminate, 0.8 mm too long: any in green",
       lsk::in_degrees(10, -5),
       0.8e-3,
       TendonConsistency::indeterminate,
       {},
       {}},
      {"(c) inconsistent, 0.8 mm too short: no bend",
       lsk::in_degrees(10, -5),
       -0.8e-3,
       TendonConsistency::inconsistent,
       {},
       {}},
      {"(d) unreachable: one bend, beyond the limits",
       lsk::in_degrees(30, 0),
       0,
       TendonConsistency::unreachable,
       {},
       {}}};
  for (Situation& s : all) {
    s.changes = lsk::changes_of(section, s.meant, s.more);
    s.diagram = lsk::diagram_of(section, s.changes);
  }
  return all;
}

Table table_of(const std::vector<Situation>& all) {
  Table table{"situation",    "change_1[mm]", "change_2[mm]", "change_3[mm]", "point_1[deg]",
              "point_2[deg]", "margin[mm]",   "area[deg^2]",  "class",        "over_tension[mm]"};
  table.comments = lsk::provenance("lsk/fig5", "tendons of section 1 in four situations");
  table.comments.push_back("class: 0 exact, 1 indeterminate, 2 inconsistent, 3 unreachable");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Situation& s = all[k];
    table.add_row({double(k + 1), s.changes[0] * 1e3, s.changes[1] * 1e3, s.changes[2] * 1e3,
                   s.diagram.point.x() / degree, s.diagram.point.y() / degree, s.diagram.margin * 1e3,
                   s.diagram.area / (degree * degree), double(s.diagram.agree),
                   s.diagram.over_tension * 1e3});
  }
  return table;
}

/// Corners of the triangle between three frontiers.
Polygon between(const SectionDiagram& diagram) {
  Polygon out;
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto corner = crossing(diagram.frontiers[i], diagram.frontiers[(i + 1) % 3]))
      out.push_back(*corner);
  return out;
}

Finding situation(const char* claim, const Situation& s) {
  return {claim, lsk::text(s.expected), lsk::text(s.diagram.agree), "",
          s.diagram.agree == s.expected ? "holds" : "fails"};
}

std::vector<Finding> findings(const Section& section, const std::vector<Situation>& all) {
  const double g = section.map().gain, root = std::sqrt(3.0);
  const SectionDiagram &exact = all[0].diagram, &loose = all[1].diagram, &tight = all[2].diagram,
                       &beyond = all[3].diagram;
  double apart = 0;
  for (const Vec2<double>& corner : between(exact)) apart = std::max(apart, (corner - all[0].meant).norm());
  const double rho = all[1].more / g;
  return {
      situation("(a) all frontiers meet in one point", all[0]),
      compare::claimed("that point is the bend asked for", "the desired bending angles",
                       lsk::text(exact.point), apart, 1e-14, "rad"),
      situation("(b) tendons not completely tensioned", all[1]),
      compare::claimed(
          "the bends left are a triangle, area 3√3 (Δl/g)² derived", "a darker triangle",
          fmt::format("{} corners, {:.2f} deg²", loose.boundary.size(), loose.area / (degree * degree)),
          std::abs(loose.area - 3 * root * rho * rho) + (loose.boundary.size() == 3 ? 0 : 1), 1e-16, "rad²"),
      {"how far the bend can be from its middle", "not printed",
       fmt::format("{:.3f}° to {:.3f}° a joint", rho / degree, 2 * rho / degree), "", "for information"},
      situation("(c) lengths that contradict one another", all[2]),
      compare::claimed(
          "no bend is left: an empty area between the frontiers", "an empty triangle",
          fmt::format("area {:g}; the least stretch is {:.3f} mm", tight.area, tight.over_tension * 1e3),
          tight.area + std::abs(tight.over_tension + all[2].more), 1e-16, "m"),
      situation("(d) frontiers that meet in one point outside the square", all[3]),
      {"situations that there are", "3", "4: the last is none of the paper's", "", "differs"},
      {"(d): least stretch of the worst tendon within the limits", "not printed",
       fmt::format("{:.5f} mm at {}", beyond.over_tension * 1e3, lsk::text(beyond.margin_point)), "",
       "for information"},
  };
}

Panel panel(const Section& section, const Situation& s) {
  Panel out = lsk::plane(s.name, state_reach, "β₁", "β₂", 12);
  out.series.push_back(lsk::closed(lsk::square(section.limit), Mark::outline, Colour::black, ""));
  if (s.diagram.boundary.size() > 2)
    out.series.push_back(lsk::closed(s.diagram.boundary, Mark::polygon, Colour::green, ""));
  if (s.expected == TendonConsistency::inconsistent)
    out.series.push_back(lsk::closed(between(s.diagram), Mark::polygon, Colour::grey, ""));
  lsk::add_frontiers(out, s.diagram, state_reach * degree);
  out.series.push_back(lsk::dot(s.meant, Mark::circles, Colour::black, "", 2));
  return out;
}

Figure figure_of(const Section& section, const std::vector<Situation>& all) {
  std::vector<Panel> panels;
  for (const Situation& s : all) panels.push_back(panel(section, s));
  panels.front().notes = {{"tendon 1", -6.5, 33, Note::Side::right, Colour::vermillion},
                          {"tendon 2", 31, 28, Note::Side::left, Colour::blue},
                          {"tendon 3", -23, 1.5, Note::Side::right, Colour::purple}};
  return {.title = "",
          .panels = panels,
          .columns = 2,
          .width = 1000,
          .height = 1000,
          .comments = lsk::provenance("lsk/fig5", "Fig. 5")};
}

}  // namespace

Expected<ItemResult> lsk_fig5(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load_serial("nottingham-tpcj");
  if (!robot) return tl::unexpected(robot.error());
  const Section& section = robot->sections.front();
  const std::vector<Situation> all = situations(section);
  return ItemResult{
      findings(section, all), {}, {{"fig5", table_of(all)}}, {{"fig5", figure_of(section, all)}}};
}

}  // namespace sinew::inline v1
