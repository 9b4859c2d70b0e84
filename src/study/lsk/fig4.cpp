/// LSK Fig. 4: how the diagram of a section is built. The change of one tendon, scaled, is a vector along its
/// direction; the perpendicular through its tip, the frontier, parts the square of bends. The paper draws no
/// numbers; ours are section 1 of Table 2 and a tendon drawn in by 3 mm. Theory:
/// docs/theory/section_diagram.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/polygon.hpp"
#include "sinew/io/robot_file.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;

constexpr double drawn_in = -3e-3;   ///< Δl of tendon 1 [m]
constexpr double single_reach = 30;  ///< of the panels [deg]

/// The bend on the frontier of tendon 1 that has β₁ = 18°.
Bend example(const Section& section) {
  const auto at = section.direction(0);
  const double x = 18 * degree, along = -drawn_in / section.map().gain;
  return {x, (along - x * at.cosine) / at.sine};
}

/// What the frontier leaves of the square on either side.
struct Sides {
  Polygon free, barred;
};

Sides sides_of(const HalfPlane& frontier, double limit) {
  const auto part = [limit](const HalfPlane& plane) {
    const HalfPlane all[] = {plane, {{1, 0}, -limit}, {{-1, 0}, -limit}, {{0, 1}, -limit}, {{0, -1}, -limit}};
    return intersection(all).value_or(Polygon{});
  };
  return {part(frontier), part({-frontier.normal, -frontier.offset})};
}

/// Slack of a tendon at a bend, by the kernel [m].
double slack(const Section& section, int tendon, double change, const Bend& bend) {
  const auto pull = kernel::linear_pull(section.map(), {bend.x(), bend.y()});
  return change - kernel::tendon_change(pull, section.direction(tendon));
}

Table table_of(const SectionDiagram& diagram, const std::vector<double>& changes, const Section& section) {
  Table table{"tendon",       "delta[deg]",   "change[mm]",   "foot_1[deg]", "foot_2[deg]",
              "end_a_1[deg]", "end_a_2[deg]", "end_b_1[deg]", "end_b_2[deg]"};
  table.comments = lsk::provenance("lsk/fig4", "vector and frontier of each tendon of section 1");
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const HalfPlane& f = diagram.frontiers[i];
    const Polygon ends = lsk::visible(f, section.limit);
    const double none = std::nan("");
    const auto end = [&](std::size_t k, int j) { return ends.size() == 2 ? ends[k][j] / degree : none; };
    table.add_row({double(i + 1),
                   std::atan2(section.direction(int(i)).sine, section.direction(int(i)).cosine) / degree,
                   changes[i] * 1e3, f.offset * f.normal.x() / degree, f.offset * f.normal.y() / degree,
                   end(0, 0), end(0, 1), end(1, 0), end(1, 1)});
  }
  return table;
}

std::vector<Finding> findings(const Section& section, const SectionDiagram& diagram, const Bend& meant) {
  const HalfPlane& frontier = diagram.frontiers.front();
  const Sides sides = sides_of(frontier, section.limit);
  const Polygon ends = lsk::visible(frontier, section.limit);
  const double N = section.segments, r = section.tendon_radius;
  const Bend corner(section.limit, section.limit), centre(0, 0);
  double off = 0, worst_free = 1, best_barred = -1;
  for (const Bend& end : ends) off = std::max(off, std::abs(slack(section, 0, drawn_in, end)));
  for (const Bend& at : sides.free) worst_free = std::min(worst_free, slack(section, 0, drawn_in, at));
  for (const Bend& at : sides.barred) best_barred = std::max(best_barred, slack(section, 0, drawn_in, at));
  const double whole = 4 * section.limit * section.limit;
  return {
      compare::given("modulus of the vector", "2 Δl/(N r_c), the factor of (10)",
                     fmt::format("{:.4f}°", frontier.offset / degree),
                     std::abs(frontier.offset + 2 * drawn_in / (N * r)), 1e-15, "rad"),
      compare::claimed("on AB the tendon is fully tense", "slack 0",
                       fmt::format("A {}, B {}", lsk::text(ends[1]), lsk::text(ends[0])), off, 1e-17, "m"),
      compare::claimed("beyond AB, the surface ABC, it can be slack: feasible", "the inequality is met",
                       fmt::format("C = {}: {:.3f} mm slack", lsk::text(corner),
                                   slack(section, 0, drawn_in, corner) * 1e3),
                       std::max(0.0, -worst_free), 1e-17, "m"),
      compare::claimed("before AB, with the centre, it is too short: not reachable",
                       "the tendon would stretch",
                       fmt::format("centre: {:.3f} mm too short", -slack(section, 0, drawn_in, centre) * 1e3),
                       std::max(0.0, best_barred), 1e-17, "m"),
      {"colours of the two regions in the text", "green for both",
       "feasible is the one beyond the frontier only", "", "differs"},
      compare::claimed("the two regions make up the square", "square",
                       fmt::format("{:.2f} + {:.2f} deg²", area(sides.free) / (degree * degree),
                                   area(sides.barred) / (degree * degree)),
                       std::abs(area(sides.free) + area(sides.barred) - whole), 1e-15, "rad²"),
      compare::claimed("three frontiers meet in the bend that was asked for", "a single point",
                       lsk::text(diagram.point) + ", " + lsk::text(diagram.agree),
                       (diagram.point - meant).norm(), 1e-15, "rad"),
  };
}

/// (10) as it is printed, without 2/n.
Finding factor(const Section& section, const std::vector<double>& changes, const Bend& meant) {
  Bend sum(0, 0);
  for (int i = 0; i < section.tendons; ++i) {
    const auto at = section.direction(i);
    sum += changes[static_cast<std::size_t>(i)] * Bend(at.cosine, at.sine);
  }
  const Bend without = sum * (-2 / (section.segments * section.tendon_radius));
  return compare::given("the same by (10) as printed, without the factor 2/3", lsk::text(without),
                        lsk::text(meant), (without - meant).norm(), 1e-12, "rad");
}

/// The frontier of tendon 1 and what it leaves.
Panel one_tendon(const Section& section, const HalfPlane& frontier) {
  const Vec2<double> foot = frontier.offset * frontier.normal;
  const Polygon ends = lsk::visible(frontier, section.limit);
  Panel out = lsk::plane("(a) tendon 1, drawn in by 3 mm", single_reach, "β₁", "β₂", 12);
  out.series = {lsk::closed(sides_of(frontier, section.limit).free, Mark::polygon, Colour::green, ""),
                lsk::closed(lsk::square(section.limit), Mark::outline, Colour::black, ""),
                lsk::line({0, 0}, foot, Mark::line, Colour::blue, "", 2.5),
                lsk::dot(foot, Mark::points, Colour::blue, "", 4),
                lsk::line(ends[1], ends[0], Mark::line, Colour::vermillion, "", 2.5)};
  const double edge = section.limit / degree;
  out.notes = {{"A", ends[1].x() / degree, edge + 1.6, Note::Side::centre},
               {"B", edge, ends[0].y() / degree},
               {"C", edge, edge + 1.6},
               {"feasible", 18.7, 15, Note::Side::centre, Colour::green},
               {"taut: the frontier", 21.5, -6, Note::Side::left, Colour::vermillion},
               {"scaled change", 9.5, 5.8, Note::Side::left, Colour::blue},
               {"too short", -12, -12, Note::Side::centre},
               {"limits of the bend", 0, -edge - 2.2, Note::Side::centre}};
  return out;
}

Panel three_tendons(const Section& section, const SectionDiagram& diagram, const Bend& meant) {
  Panel out = lsk::plane("(b) all three: they meet in the bend asked for", single_reach, "β₁", "β₂", 12);
  out.series = {lsk::closed(lsk::square(section.limit), Mark::outline, Colour::black, "")};
  lsk::add_frontiers(out, diagram, section.limit);
  out.series.push_back(lsk::dot(meant, Mark::circles, Colour::black, "", 2));
  out.notes = {{"tendon 1", 8.5, 25.8, Note::Side::centre, Colour::vermillion},
               {"tendon 2", -1.5, -26.2, Note::Side::centre, Colour::blue},
               {"tendon 3", -16, 8.2, Note::Side::centre, Colour::purple}};
  return out;
}

Figure figure_of(const Section& section, const SectionDiagram& diagram, const Bend& meant) {
  return {.title = "",
          .panels = {one_tendon(section, diagram.frontiers.front()), three_tendons(section, diagram, meant)},
          .columns = 2,
          .width = 1100,
          .height = 560,
          .comments = lsk::provenance("lsk/fig4", "Fig. 4")};
}

}  // namespace

Expected<ItemResult> lsk_fig4(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load_serial("nottingham-tpcj");
  if (!robot) return tl::unexpected(robot.error());
  const Section& section = robot->sections.front();
  const Bend meant = example(section);
  const std::vector<double> changes = lsk::changes_of(section, meant, 0);
  const SectionDiagram diagram = lsk::diagram_of(section, changes);
  std::vector<Finding> all = findings(section, diagram, meant);
  all.push_back(factor(section, changes, meant));
  return ItemResult{std::move(all),
                    {},
                    {{"fig4", table_of(diagram, changes, section)}},
                    {{"fig4", figure_of(section, diagram, meant)}}};
}

}  // namespace sinew::inline v1
