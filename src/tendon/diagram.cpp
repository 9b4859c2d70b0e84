#include "sinew/tendon/diagram.hpp"

#include <algorithm>

#include "math/polygon.hpp"
#include "tendon/exact_region.hpp"

namespace sinew::inline v1 {
namespace {

struct Cut {
  Polygon boundary;
  double area;
};

/// What a polygon has in common with the envelope.
/// @param lines whose common part it is
Cut cut_with_envelope(const SectionCase& c, const Polygon& polygon, std::vector<HalfPlane> lines) {
  if (c.is_disc()) {
    const DiscCut cut = cut_with_disc(polygon, c.question.envelope.limit);
    return {boundary(cut, c.question.deviation), area(cut)};
  }
  if (polygon.empty()) return {{}, 0};
  lines.insert(lines.end(), c.sides.begin(), c.sides.end());
  Polygon cut = *intersection(lines);
  const double size = area(cut);
  return {std::move(cut), size};
}

/// The lines a polygon lies between; of a segment those beside it and across its ends, of a point four.
std::vector<HalfPlane> lines_around(const Polygon& polygon) {
  std::vector<HalfPlane> lines;
  const auto add = [&](const Vec2<double>& normal, const Vec2<double>& x) {
    lines.push_back({normal, dot(normal, x)});
  };
  if (polygon.size() > 2) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2<double> way = polygon[(k + 1) % polygon.size()] - polygon[k];
      add(perp(way / way.norm()), polygon[k]);
    }
  } else if (!polygon.empty()) {
    const Vec2<double> way = polygon.back() - polygon.front();
    const double length = way.norm();
    const Vec2<double> along = length > 0 ? Vec2<double>(way / length) : Vec2<double>(1, 0),
                       across = perp(along);
    add(along, polygon.front());
    add(-along, polygon.back());
    add(across, polygon.front());
    add(-across, polygon.front());
  }
  return lines;
}

void find_point(const SectionCase& c, SectionDiagram& diagram) {
  const int tendons = static_cast<int>(c.tendons());
  const kernel::Pull<double> nearest = kernel::nearest_pull(c.own.data(), c.at.data(), tendons);
  diagram.point = c.bend({nearest.x, nearest.y});
  diagram.point_is_allowed = c.allows(diagram.point);
  const kernel::Pull<double> asked = c.pull(diagram.point);
  for (std::size_t i = 0; i < c.tendons(); ++i) diagram.slack.push_back(c.slack(i, asked));
}

/// Whether some bend, allowed or not, leaves no tendon too short; of curved frontiers the nearest is asked.
bool agree_somewhere(const SectionCase& c, const SectionDiagram& diagram) {
  const double tolerance = c.question.tolerance;
  if (c.is_exact()) return *std::ranges::min_element(diagram.slack) >= -tolerance;
  std::vector<double> longer = c.own;
  for (double& change : longer) change += tolerance;
  return !intersection(frontiers(c.at, longer, c.question.section.gain))->empty();
}

/// By the margin where it can: in the exact model, and of 5 and more tendons in either, a tendon that is too
/// short where they are met best need not be so elsewhere.
void classify(const SectionCase& c, SectionDiagram& diagram) {
  const auto [least, most] = std::minmax_element(diagram.slack.begin(), diagram.slack.end());
  const double tolerance = c.question.tolerance;
  if (diagram.margin < -tolerance)
    diagram.agree =
        agree_somewhere(c, diagram) ? TendonConsistency::unreachable : TendonConsistency::inconsistent;
  else
    diagram.agree = std::max(*most, diagram.margin) <= tolerance ? TendonConsistency::exact
                                                                 : TendonConsistency::indeterminate;
  diagram.partial = diagram.agree == TendonConsistency::indeterminate && *least <= tolerance;
}

void find_linear_region(const SectionCase& c, SectionDiagram& diagram) {
  diagram.frontiers = frontiers(c.at, c.own, c.question.section.gain);
  diagram.free = intersection(diagram.frontiers);
  diagram.free_area = area(*diagram.free);
  Cut cut = cut_with_envelope(c, *diagram.free, diagram.frontiers);
  diagram.boundary = std::move(cut.boundary);
  diagram.area = cut.area;
}

void find_exact_region(const SectionCase& c, SectionDiagram& diagram, const Margin& margin) {
  for (std::size_t i = 0; i < c.tendons(); ++i) diagram.curves.push_back(exact_frontier(c, i));
  ExactRegion region = exact_region(c, margin);
  diagram.boundary = std::move(region.boundary);
  diagram.area = region.area;
  if (region.parts < 2 && region.closed) return;
  diagram.report.status = Status::stalled;
  diagram.report.message.append(region.closed
                                    ? "the free bends have several parts; the boundary is the largest one's"
                                    : "the boundary of the free bends was not found all around");
}

template <class Answer>
bool refuse(Answer& answer, std::string_view text) {
  if (text.empty()) return false;
  answer.report.status = Status::left_domain;
  answer.report.message.append(text);
  return true;
}

}  // namespace

SectionDiagram section_diagram(const DiagramQuestion& question) {
  SectionDiagram diagram;
  if (refuse(diagram, complaint(question))) return diagram;
  const SectionCase c(question);
  find_point(c, diagram);
  const Margin margin = largest_margin(c, diagram.point);
  diagram.margin = margin.slack;
  diagram.margin_point = margin.point;
  diagram.over_tension = std::max(0.0, -margin.slack);
  classify(c, diagram);
  if (c.is_exact()) {
    find_exact_region(c, diagram, margin);
  } else {
    find_linear_region(c, diagram);
  }
  return diagram;
}

SectionOutline section_outline(const DiagramQuestion& asked, const SectionTendons& previous) {
  SectionOutline outline;
  DiagramQuestion question = asked;  // pulls of whole tendons, and no curve
  question.earlier = {0, 0, 0};
  question.model = kernel::Model::linear;
  if (refuse(outline, complaint(question)) || refuse(outline, complaint(previous, question.section.gain)))
    return outline;
  const SectionCase c(question);
  const double gain = question.section.gain;
  const Polygon own = *intersection(frontiers(c.at, c.own, gain));
  const Polygon others = *intersection(frontiers(previous.at, previous.changes, gain));
  const Polygon all = difference(own, others);
  Cut cut = cut_with_envelope(c, all, lines_around(all));
  outline.boundary = std::move(cut.boundary);
  outline.area = cut.area;
  using Missing = SectionOutline::Missing;
  if (others.empty())
    outline.missing = Missing::previous_over_tensioned;
  else if (own.empty())
    outline.missing = Missing::over_tensioned;
  else if (outline.boundary.empty())
    outline.missing = Missing::beyond_envelope;
  return outline;
}

}  // namespace sinew::inline v1
