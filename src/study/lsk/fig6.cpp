/// LSK Fig. 6: the diagram of a section with a neutral backbone, θ and φ as polar coordinates. The paper
/// draws no numbers; ours are section 1 of Table 2 with a neutral backbone, θ = 120°, φ = 35°, and for the
/// envelope of the actuators a travel of 6 mm either way. Theory: docs/theory/section_diagram.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/analysis/tendon_limits.hpp"
#include "sinew/io/robot_file.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

using lsk::degree;

constexpr double theta = 120 * degree, phi = 35 * degree;
constexpr double travel = 6e-3;      ///< of a tendon either way [m]
constexpr double polar_reach = 240;  ///< of the panels [deg]

Bend example() { return {theta * std::cos(phi), theta * std::sin(phi)}; }

/// What a travel of all tendons allows: tendons so slack that they do not count.
Polygon actuator_polygon(Section section, int tendons) {
  section.tendons = tendons;
  const std::vector<double> slack(static_cast<std::size_t>(tendons), 1.0);
  return lsk::diagram_of(section, slack, {Envelope::Kind::actuator, travel}).boundary;
}

Table polar_table(const SectionDiagram& diagram, const std::vector<double>& changes, const Section& section) {
  Table table{"tendon", "delta[deg]", "change[mm]", "foot_theta[deg]", "foot_phi[deg]"};
  table.comments = lsk::provenance("lsk/fig6", "neutral backbone: vector of each tendon of section 1, polar");
  table.comments.push_back("theta = 120 deg, phi = 35 deg");
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const HalfPlane& f = diagram.frontiers[i];
    const Vec2<double> foot = f.offset * f.normal;
    const auto at = section.direction(static_cast<int>(i));
    table.add_row({static_cast<double>(i + 1), std::atan2(at.sine, at.cosine) / degree, changes[i] * 1e3,
                   foot.norm() / degree, std::atan2(foot.y(), foot.x()) / degree});
  }
  return table;
}

void add_point(std::vector<Finding>& findings, const Section& section, const SectionDiagram& diagram,
               const std::vector<double>& changes) {
  const Vec2<double>& p = diagram.point;
  const double off = std::max(std::abs(p.norm() - theta), std::abs(std::atan2(p.y(), p.x()) - phi));
  findings.push_back(
      compare::claimed("three frontiers meet at polar coordinates (θ, φ)", "match (θ, φ)",
                       fmt::format("({:.6g}°, {:.6g}°), {}", p.norm() / degree,
                                   std::atan2(p.y(), p.x()) / degree, lsk::text(diagram.agree)),
                       off, 1e-14, "rad"));
  double worst = 0;
  for (std::size_t i = 0; i < changes.size(); ++i)
    worst = std::max(worst, std::abs(diagram.frontiers[i].offset + changes[i] / section.tendon_radius));
  findings.push_back(
      compare::given("scaling factor of a neutral backbone", "−1/r_c", "3 tendons", worst, 1e-15, "rad"));
}

void add_envelopes(std::vector<Finding>& findings, const Section& section) {
  const double contact = contact_bend(section), N = section.segments;
  findings.push_back(
      {"radius of the envelope by contact of discs", "θ_max, and θ_max/N = L/r_disc",
       fmt::format("L/r_disc = {:.4f}° a joint, {:.2f}° the section: the diagram's radius is that of "
                   "the section",
                   contact / degree, N * contact / degree),
       "", "differs"});
  findings.push_back({"what limits Table 2 to 24° a joint", "collision, strain, or any others",
                      fmt::format("not contact of discs; the strain of 0.44 mm wire is then {:.2f} %",
                                  100 * backbone_strain(section, {section.limit, 0}, 0.44e-3)),
                      "", "for information"});
  const Polygon three = actuator_polygon(section, 3), four = actuator_polygon(section, 4);
  findings.push_back(compare::claimed("envelope by the actuators, 3 tendons", "a hexagon",
                                      fmt::format("{} corners", three.size()),
                                      std::abs(double(three.size()) - 6), 0, ""));
  findings.push_back(
      {"the same of 4 tendons", "not said", fmt::format("{} corners", four.size()), "", "for information"});
  double off = 0, worst = 0;
  for (std::size_t k = 0; k < three.size(); ++k) {
    const Vec2<double> middle = 0.5 * (three[k] + three[(k + 1) % three.size()]);
    off = std::max(off, std::abs(middle.norm() - travel / section.tendon_radius));
    std::vector<double> changes = lsk::changes_of(section, three[k], 0);
    std::ranges::sort(changes);
    worst =
        std::max({worst, std::abs(changes[0] + travel), std::abs(changes[1]), std::abs(changes[2] - travel)});
  }
  const double edge = travel / section.tendon_radius;
  findings.push_back({"distance of its edges from the centre",
                      fmt::format("Δl_max·r_c = {:.3g} mm²", travel * section.tendon_radius * 1e6),
                      fmt::format("Δl_max/r_c = {:.2f}°", edge / degree), "", "differs"});
  findings.push_back(
      compare::claimed("derived: edges at Δl_max/r_c", "not printed", "6 edges", off, 1e-14, "rad"));
  findings.push_back(
      compare::claimed("it is the cube of [20] cut across its diagonal: corners at (Δl_max, 0, −Δl_max)",
                       "equivalent", "6 corners", worst, 1e-16, "m"));
}

/// Rings of θ and rays of φ below everything else.
void add_polar_grid(Panel& panel, double limit) {
  for (const double ring : {60 * degree, 120 * degree})
    panel.series.push_back(lsk::closed(lsk::circle(ring), Mark::outline, Colour::grey, "", 0.7));
  for (int k = 0; k < 12; ++k) {
    const Vec2<double> ray(std::cos(30 * k * degree), std::sin(30 * k * degree));
    panel.series.push_back(lsk::line({0, 0}, limit * ray, Mark::line, Colour::grey, "", 0.7));
  }
}

Panel empty(const char* title, double limit, const char* label) {
  Panel out = lsk::plane(title, polar_reach, "θ cos φ", "θ sin φ", 60);
  add_polar_grid(out, limit);
  out.series.push_back(lsk::closed(lsk::circle(limit), Mark::outline, Colour::black, label));
  out.legend = Legend::below;
  return out;
}

Figure figure_of(const Section& section, const SectionDiagram& diagram) {
  Panel disc = empty("(a) neutral backbone: radius θ, direction φ", section.limit, "θ ≤ 192°");
  lsk::add_frontiers(disc, diagram, polar_reach * degree);
  disc.series.push_back(lsk::dot(example(), Mark::circles, Colour::black, "θ = 120°, φ = 35°", 2));
  for (Series& series : disc.series)
    if (series.label.plain().starts_with("tendon")) series.label.clear();
  disc.notes = {{"tendon 1", 32, 222, Note::Side::right, Colour::vermillion},
                {"tendon 2", -112, -222, Note::Side::right, Colour::blue},
                {"tendon 3", -240, 128, Note::Side::right, Colour::purple}};
  Panel actuators = empty("(b) envelopes by the travel of the tendons", section.limit, "");
  actuators.series.push_back(
      lsk::closed(actuator_polygon(section, 3), Mark::polygon, Colour::green, "3 tendons, ±6 mm"));
  actuators.series.push_back(
      lsk::closed(actuator_polygon(section, 4), Mark::outline, Colour::vermillion, "4 tendons, ±6 mm"));
  return {.title = "",
          .panels = {disc, actuators},
          .columns = 2,
          .width = 1100,
          .height = 600,
          .comments = lsk::provenance("lsk/fig6", "Fig. 6")};
}

}  // namespace

Expected<ItemResult> lsk_fig6(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load_serial("nottingham-neutral");
  if (!robot) return tl::unexpected(robot.error());
  const Section& section = robot->sections.front();
  const std::vector<double> changes = lsk::changes_of(section, example(), 0);
  const SectionDiagram diagram = lsk::diagram_of(section, changes);
  ItemResult result;
  add_point(result.findings, section, diagram, changes);
  add_envelopes(result.findings, section);
  result.tables.emplace_back("fig6", polar_table(diagram, changes, section));
  result.figures.emplace_back("fig6", figure_of(section, diagram));
  return result;
}

}  // namespace sinew::inline v1
