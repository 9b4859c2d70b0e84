/// TDPCR Fig. 9 (indices along the trajectory) and Fig. 10 (the last pose), constant curvature. The paper
/// prints no numbers for either, so its claims are checked instead, against what docs/theory/example51.md
/// derives.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/figure/figure.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tdpcr/example51.hpp"
#include "study/tdpcr/index_panel.hpp"

namespace sinew::inline v1 {
namespace {

using compare::number, compare::printed, compare::small;
using example51::Printed, example51::Sample;
using std::numbers::pi;
using Samples = std::vector<Sample>;
using Index = double Indices::*;

// ---------------------------------------------------------------- table

Table table_of(const Samples& samples) {
  Table table{"k",
              "eta",
              "x[m]",
              "y[m]",
              "phi[rad]",
              "condition",
              "condition_homogenised",
              "position[m/m]",
              "rotation[rad/m]",
              "determinant[m^4]",
              "tendon_1[m]",
              "tendon_2[m]",
              "tendon_3[m]",
              "curvature_1[1/m]",
              "curvature_2[1/m]",
              "curvature_3[1/m]"};
  table.comments =
      compare::provenance("tdpcr/fig9", "indices along the trajectory", example51::tendon_1_actuated);
  table.comments.push_back(
      "position, rotation: 2-norms of the blocks of U, eq. (39); empty where J is singular");
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Sample& s = samples[k];
    table.add_row({static_cast<double>(k), s.eta, s.pose.x, s.pose.y, s.pose.phi, s.indices.condition,
                   s.indices.condition_homogenised, s.indices.position, s.indices.rotation, s.determinant,
                   s.tendons[0], s.tendons[1], s.tendons[2], s.curvatures[0], s.curvatures[1],
                   s.curvatures[2]});
  }
  return table;
}

// ---------------------------------------------------------------- findings

void add_geometry(std::vector<Finding>& findings, const Robot& robot, const Samples& samples) {
  const Printed paper;
  // The picture of the home pose, x = y = φ = 0, shows the robot's points as section 5.1 prints them.
  const PlanarShape home = shape(robot, samples[0].pose, samples[0].curvatures, 2);
  const Vec2<double> tendon = home.tendons[0][0][0] - home.backbones[0][0];
  const double straight = samples[0].tendons[0] / (1 - samples[0].curvatures[0] * tendon.norm());
  findings.push_back(printed("base circumradius R_b", paper.base_radius, home.base[0].norm(), "m"));
  findings.push_back(
      printed("platform circumradius R_p", paper.platform_radius, home.platform[0].norm(), "m"));
  findings.push_back(printed("tendon offset d", paper.tendon_offset, tendon.norm(), "m"));
  findings.push_back(printed("backbone length ℓ_i", paper.backbone_length, straight, "m"));
  const double base = example51::farthest(paper.base_points(), home.base);
  const double platform = example51::farthest(paper.platform_points(), home.platform);
  const auto verdict = [](double off) { return off < 1e-15 ? "agrees" : "differs"; };
  findings.push_back({"base points a_1, a_2, a_3", "at 90°, 210°, 330°", "the same points",
                      small(base) + " m at most", verdict(base)});
  findings.push_back({"platform points b_1, b_2, b_3", "at 30°, 150°, 270°", "the same points",
                      small(platform) + " m at most", verdict(platform)});
  const auto worst = std::max_element(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.closure_error < b.closure_error;
  });
  findings.push_back({"configurations solved, (68)-(70)", fmt::format("{}", paper.configurations),
                      fmt::format("{}, legs closed to {} m", samples.size(), small(worst->closure_error)),
                      "0", worst->closure_error < 1e-14 ? "agrees" : "differs"});
}

Finding growth(const char* name, Index index, const char* unit, const Samples& samples) {
  const std::size_t last = samples.size() - 2;  // the last but one: the last is singular
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < last; ++k)
    least = std::min(least, samples[k + 1].indices.*index / samples[k].indices.*index - 1);
  const double first = samples[0].indices.*index, end = samples[last].indices.*index;
  return {fmt::format("{} at k = 0 → {}", name, last), "curve rises to infinity; numbers not printed",
          fmt::format("{} → {}{}", number(first), number(end), unit),
          fmt::format("× {:.1f}; smallest step {:+.2g} %", end / first, 100 * least),
          least > 0 ? "holds" : "fails"};
}

/// Not in the paper, whose own remark is that its condition number has no physical meaning: J mixes m and m².
Finding homogenised(const Samples& samples) {
  const auto value = [](const Sample& s) { return s.indices.condition_homogenised; };
  const std::size_t last = samples.size() - 2;
  const auto least = std::min_element(samples.begin(), samples.end() - 1,
                                      [&](const Sample& a, const Sample& b) { return value(a) < value(b); });
  return {fmt::format("the same homogenised (unit rows, moments over R_p), k = 0 → {}", last),
          "not given: the paper's mixes m and m²",
          fmt::format("{} → {}", number(value(samples[0])), number(value(samples[last]))),
          fmt::format("× {:.1f}; least {:.4g} at k = {}", value(samples[last]) / value(samples[0]),
                      value(*least), least - samples.begin()),
          "for information"};
}

void add_indices(std::vector<Finding>& findings, const Samples& samples) {
  findings.push_back(growth("condition number of J", &Indices::condition, "", samples));
  findings.push_back(growth("‖U_p‖", &Indices::position, " m/m", samples));
  findings.push_back(growth("‖U_r‖", &Indices::rotation, " rad/m", samples));
  findings.push_back(homogenised(samples));
}

void add_singularity(std::vector<Finding>& findings, const Samples& samples) {
  const TypeTwo& type = samples.back().type_2;
  const bool as_claimed = type.singular && type.rank == 2 && type.kind == LineClass::concurrent;
  findings.push_back(
      {"last pose (Fig. 10)", "type II, three lines meet in one point",
       fmt::format("{}, rank {}, {}", type.singular ? "type II" : "regular", type.rank, to_string(type.kind)),
       "", as_claimed ? "holds" : "fails"});
  const Vec2<double> derived = example51::meeting_point();
  const Vec2<double> point = type.point.value_or(Vec3<double>::Zero()).head<2>();
  const double off = (point - derived).norm();
  // Not −0: the sign of what rounding leaves of y means nothing.
  const double y = std::abs(point.y()) < 1e-12 ? 0.0 : point.y();
  findings.push_back({fmt::format("meeting point, derived p/(1 − R_p/R_b) = ({:.7f}, 0) m", derived.x()),
                      "drawn, not printed", fmt::format("({:.7f}, {:g}) m", point.x(), y), small(off) + " m",
                      off < 1e-12 ? "holds" : "fails"});
  double worst = 0;
  for (const Sample& s : samples)
    worst = std::max(worst, std::abs(s.determinant - example51::determinant(s.pose)));
  const double scale = std::abs(samples[0].determinant);
  findings.push_back({"det J, derived −(3√3/2) R_b R_p sin ψ (x² + y² − R_b² − R_p² + 2 R_b R_p cos ψ)",
                      "not printed", fmt::format("{} m⁴ at k = 0", number(samples[0].determinant)),
                      fmt::format("{} of that at most, all k", small(worst / scale)),
                      worst < 1e-14 * scale ? "holds" : "fails"});
}

void add_rates(std::vector<Finding>& findings, const Sample& last, const Sample& near_end) {
  const example51::Rates limit = example51::rates(last);
  const double angle = pi / 3 - near_end.pose.phi;
  const auto row = [&](const char* name, double index, double derived) {
    const double relative = index * angle / derived - 1;
    findings.push_back({fmt::format("{}·(π/3 − φ) at η = 1 − {:.0e}, derived limit {:.10g}", name,
                                    1 - near_end.eta, derived),
                        "to infinity; rate not printed", fmt::format("{:.10g}", index * angle),
                        small(relative) + " relative", std::abs(relative) < 5e-5 ? "holds" : "fails"});
  };
  row("condition", near_end.indices.condition, limit.condition);
  row("‖U_p‖", near_end.indices.position, limit.position);
  row("‖U_r‖", near_end.indices.rotation, limit.rotation);
}

// ---------------------------------------------------------------- figures

Series curve(std::string label, Index index, Colour colour, const Samples& samples) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = Mark::line_points, .colour = colour};
  for (const Sample& s : samples) {
    series.x.push_back(s.eta);
    series.y.push_back(s.indices.*index);
  }
  return series;
}

Figure indices_figure(const Samples& samples) {
  const example51::Rates limit = example51::rates(samples.back());
  Figure figure{.title = "3-RFR, constant curvature: towards a type II singularity",
                .panels = {},
                .width = 760,
                .height = 1000,
                .comments = compare::provenance("tdpcr/fig9", "Fig. 9", example51::tendon_1_actuated)};
  figure.panels.push_back(example51::index_panel(
      example51::log_axis("condition number of J", "", 1, 3000),
      {curve("as the paper has it (m and m²)", &Indices::condition, Colour::blue, samples),
       curve("homogenised", &Indices::condition_homogenised, Colour::orange, samples)},
      limit.condition));
  figure.panels.push_back(example51::index_panel(
      example51::log_axis("‖Uₚ‖", "m/m", 0.3, 300),
      {curve("position sensitivity", &Indices::position, Colour::blue, samples)}, limit.position));
  figure.panels.push_back(example51::index_panel(
      example51::log_axis("‖Uᵣ‖", "rad/m", 30, 30000),
      {curve("rotation sensitivity", &Indices::rotation, Colour::blue, samples)}, limit.rotation));
  figure.panels.back().x.label = "η, along the trajectory";
  return figure;
}

Series outline(std::string label, const Polyline& points, Mark mark, Colour colour, double width) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  for (const Vec2<double>& point : points) {
    series.x.push_back(1e3 * point.x());  // mm
    series.y.push_back(1e3 * point.y());
  }
  return series;
}

/// @param drawn length of the lines, in distances from base to platform point
Panel pose_panel(const Robot& robot, const Sample& sample, std::string title, double drawn) {
  const PlanarShape picture = shape(robot, sample.pose, sample.curvatures, 49);
  Panel panel{.title = std::move(title),
              .x = {.label = "x", .unit = "mm", .low = -270, .high = 220, .step = 100},
              .y = {.label = "y", .unit = "mm", .low = -160, .high = 220, .step = 100},
              .series = {outline("base", picture.base, Mark::outline, Colour::grey, 1.5),
                         outline("platform", picture.platform, Mark::polygon, Colour::green, 2)},
              .notes = {},
              .legend = Legend::top_left,
              .equal_aspect = true};
  const auto once = [](const char* label, std::size_t leg) { return leg == 0 ? label : ""; };
  for (std::size_t i = 0; i < picture.backbones.size(); ++i) {
    const Vec2<double> a = picture.base[i], b = picture.platform[i];
    const Polyline line{a, a + drawn * (b - a)};  // beyond the platform, to where the lines meet
    panel.series.push_back(outline(once("Plücker line", i), line, Mark::dashed, Colour::vermillion, 1.5));
    for (const Polyline& tendon : picture.tendons[i])
      panel.series.push_back(
          outline(&tendon == &picture.tendons[0][0] ? "tendons" : "", tendon, Mark::line, Colour::sky, 1));
    panel.series.push_back(outline(once("backbone", i), picture.backbones[i], Mark::line, Colour::blue, 3));
    const Vec2<double> outside = 1e3 * a + 14 * a.normalized();
    panel.notes.push_back({fmt::format("A{}", i + 1), outside.x(), outside.y(), Note::Side::centre});
  }
  panel.series.push_back(outline("", picture.base, Mark::circles, Colour::black, 1.5));
  panel.series.push_back(outline("revolute joint", picture.platform, Mark::circles, Colour::black, 1.5));
  return panel;
}

Figure poses_figure(const Robot& robot, const Samples& samples) {
  Figure figure{.title = "",
                .panels = {},
                .columns = 2,
                .width = 1200,
                .height = 500,
                .comments = compare::provenance("tdpcr/fig9", "the first pose and the last, Fig. 10",
                                                example51::tendon_1_actuated)};
  figure.panels.push_back(pose_panel(robot, samples.front(), "k = 0: x = 0, φ = 0", 1.9));
  Panel last = pose_panel(robot, samples.back(), "k = 59: x = 30 mm, φ = 60°, type II singular", 1.45);
  const Polyline meeting{samples.back().type_2.point.value_or(Vec3<double>::Zero()).head<2>()};
  last.series.push_back(outline("lines meet", meeting, Mark::points, Colour::vermillion, 5));
  figure.panels.push_back(std::move(last));
  return figure;
}

}  // namespace

Expected<ItemResult> tdpcr_fig9(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3-rfr");
  if (!robot) return tl::unexpected(robot.error());
  const auto samples = example51::trajectory(*robot);
  if (!samples) return tl::unexpected(samples.error());
  Workspace work(*robot);
  const auto near_end = example51::sample(*robot, 1 - 1e-5, work);
  if (!near_end) return tl::unexpected(near_end.error());

  ItemResult result;
  add_geometry(result.findings, *robot, *samples);
  add_indices(result.findings, *samples);
  add_singularity(result.findings, *samples);
  add_rates(result.findings, samples->back(), *near_end);

  result.tables.emplace_back("fig9", table_of(*samples));
  result.figures.emplace_back("fig9", indices_figure(*samples));
  result.figures.emplace_back("fig9-poses", poses_figure(*robot, *samples));
  return result;
}

}  // namespace sinew::inline v1
