#include "study/lsk/example.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "study/compare.hpp"

namespace sinew::inline v1::lsk {

std::vector<std::string> provenance(const std::string& id, const std::string& what) {
  return compare::provenance(
      id, what,
      "Barrientos-Diez et al. 2020, Table 2: 5 sections, 8 segments, 3 tendons, L = 2.375 mm, h = 2 mm, "
      "r_c = 2.45 mm, delta_m = m 24 deg");
}

std::vector<double> changes_of(const Section& section, const Bend& bend, double slack) {
  const auto pull = kernel::linear_pull(section.map(), {bend.x(), bend.y()});
  std::vector<double> changes;
  for (int i = 0; i < section.tendons; ++i)
    changes.push_back(kernel::tendon_change(pull, section.direction(i)) + slack);
  return changes;
}

SectionDiagram diagram_of(const Section& section, const std::vector<double>& changes) {
  return diagram_of(section, changes,
                    {section.is_twin() ? Envelope::Kind::square : Envelope::Kind::disc, section.limit});
}

SectionDiagram diagram_of(const Section& section, const std::vector<double>& changes,
                          const Envelope& envelope) {
  std::vector<kernel::Direction<double>> at;
  for (int i = 0; i < section.tendons; ++i) at.push_back(section.direction(i));
  DiagramQuestion question{section.map(), {at, changes}, envelope};
  question.tolerance = 1e-9;
  question.deviation = 1e-3;
  return section_diagram(question);
}

std::string text(TendonConsistency agree) {
  switch (agree) {
    case TendonConsistency::exact:
      return "exact";
    case TendonConsistency::indeterminate:
      return "indeterminate";
    case TendonConsistency::inconsistent:
      return "inconsistent";
    case TendonConsistency::unreachable:
      return "unreachable";
  }
  return "?";
}

std::string text(const Bend& bend) {
  return fmt::format("({:.4g}°, {:.4g}°)", bend.x() / degree, bend.y() / degree);
}

Panel plane(std::string title, double reach, const char* x, const char* y, double step) {
  Panel out;
  out.title = std::move(title);
  out.x = {.label = x, .unit = "deg", .low = -reach, .high = reach, .step = step};
  out.y = {.label = y, .unit = "deg", .low = -reach, .high = reach, .step = step};
  out.legend = Legend::none;
  out.equal_aspect = true;
  return out;
}

Series closed(const Polygon& corners, Mark mark, Colour colour, std::string label, double width) {
  Series out;
  out.label = std::move(label);
  for (const Vec2<double>& corner : corners) {
    out.x.push_back(corner.x() / degree);
    out.y.push_back(corner.y() / degree);
  }
  out.mark = mark;
  out.colour = colour;
  out.width = width;
  return out;
}

Series line(const Vec2<double>& from, const Vec2<double>& to, Mark mark, Colour colour, std::string label,
            double width) {
  return {std::move(label),
          {from.x() / degree, to.x() / degree},
          {from.y() / degree, to.y() / degree},
          mark,
          colour,
          width};
}

Series dot(const Vec2<double>& at, Mark mark, Colour colour, std::string label, double width) {
  return {std::move(label), {at.x() / degree}, {at.y() / degree}, mark, colour, width};
}

Polygon square(double limit) { return {{limit, limit}, {-limit, limit}, {-limit, -limit}, {limit, -limit}}; }

Polygon circle(double radius) {
  Polygon out;
  for (int k = 0; k < 180; ++k)
    out.emplace_back(radius * std::cos(2 * k * degree), radius * std::sin(2 * k * degree));
  return out;
}

Polygon visible(const HalfPlane& frontier, double reach) {
  const Vec2<double> foot = frontier.offset * frontier.normal,
                     along(-frontier.normal.y(), frontier.normal.x());
  double from = -1e9, to = 1e9;
  for (int k = 0; k < 2; ++k) {
    if (std::abs(along[k]) < 1e-12) {
      if (std::abs(foot[k]) > reach) return {};
      continue;
    }
    const double a = (-reach - foot[k]) / along[k], b = (reach - foot[k]) / along[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (!(from < to)) return {};
  return {foot + from * along, foot + to * along};
}

void add_frontiers(Panel& panel, const SectionDiagram& diagram, double reach) {
  constexpr std::array colours{Colour::vermillion, Colour::blue, Colour::purple, Colour::orange};
  for (std::size_t i = 0; i < diagram.frontiers.size(); ++i) {
    const HalfPlane& frontier = diagram.frontiers[i];
    const Colour colour = colours[i % colours.size()];
    const Polygon ends = visible(frontier, reach);
    if (ends.size() == 2)
      panel.series.push_back(
          line(ends[0], ends[1], Mark::line, colour, fmt::format("tendon {} taut", i + 1), 2));
    const Vec2<double> foot = frontier.offset * frontier.normal;
    panel.series.push_back(line({0, 0}, foot, Mark::dashed, colour, "", 1.5));
    panel.series.push_back(dot(foot, Mark::points, colour, "", 3));
  }
}

}  // namespace sinew::inline v1::lsk
