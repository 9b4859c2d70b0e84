/// TDPCR Fig. 12: the last pose of the trajectory of section 5.1 on pseudo-rigid chains, with the lines of
/// the legs, which are those of constant curvature: a chord is a chord.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tdpcr/example51_chains.hpp"
#include "study/tdpcr/robot_drawing.hpp"

namespace sinew::inline v1 {
namespace {

using drawing::Point;
using example51::ChainSample;
using std::numbers::pi;

std::vector<Polyline> chains_of(const ChainLegs<Planar>& robot, const ChainSample& sample) {
  std::vector<Polyline> chains;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    chains.push_back(
        chain_points(robot.legs[i], sample.legs[i].of(robot.legs[i].chain), SE2<double>::from(sample.pose)));
  return chains;
}

Table table_of(const std::vector<Polyline>& chains) {
  Table table{"leg", "joint", "x[m]", "y[m]"};
  table.comments = compare::provenance("tdpcr/fig12", "base points, joints and tips in the last pose",
                                       example51::six_links);
  for (std::size_t i = 0; i < chains.size(); ++i)
    for (std::size_t j = 0; j < chains[i].size(); ++j)
      table.add_row(std::array{static_cast<double>(i + 1), static_cast<double>(j + 1), chains[i][j].x(),
                               chains[i][j].y()});
  return table;
}

Figure figure_of(const ChainSample& last, const std::vector<Polyline>& chains, const Point& met) {
  Panel panel = drawing::plane(
      fmt::format("x = {:g} mm, y = 0, φ = {:g}°", 1e3 * last.pose.x, last.pose.phi * 180 / pi),
      Point(-0.215, -0.15), Point(0.215, 0.22), 0.1);
  panel.legend = Legend::below;
  PlanarShape picture;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    picture.base.push_back(chains[i].front());
    picture.platform.push_back(chains[i].back());
    picture.lines.push_back({chains[i].front(), chains[i].back()});
  }
  drawing::add_base(panel, picture, "base");
  drawing::add_platform(panel, picture, "platform");
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const Point from = chains[i].front(), beyond = met + 0.015 * (met - from).normalized();
    panel.series.push_back(
        drawing::curve(i ? "" : "Plücker lines", {from, beyond}, Mark::dashed, Colour::vermillion, 1.8));
    panel.series.push_back(
        drawing::curve(i ? "" : "pseudo-rigid links", chains[i], Mark::line, Colour::blue, 3));
    const Polyline inner(chains[i].begin() + 1, chains[i].end() - 1);
    panel.series.push_back(drawing::curve(i ? "" : "pseudo joints", inner, Mark::circles, Colour::blue, 1.5));
  }
  drawing::add_joints(panel, picture, "revolute joints");
  drawing::add_base_names(panel, picture, 0.014);
  drawing::add_platform_names(panel, picture, Point(last.pose.x, last.pose.y), 0.014, 60);
  const Point words(0.1, 0.075);
  drawing::add_leader(panel, met, words);
  panel.series.push_back(drawing::curve("common point C", {met}, Mark::points, Colour::vermillion, 5));
  panel.notes.push_back(drawing::text(
      fmt::format("C = ({:.3f}, {:.3g}) mm", 1e3 * met.x(), std::abs(met.y()) < 1e-12 ? 0.0 : 1e3 * met.y()),
      words, Note::Side::right));
  return {.title = "",
          .panels = {panel},
          .width = 760,
          .height = 740,
          .comments = compare::provenance("tdpcr/fig12", "Fig. 12", example51::six_links)};
}

}  // namespace

Expected<ItemResult> tdpcr_fig12(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3-rfr");
  if (!robot) return tl::unexpected(robot.error());
  const auto on_chains = example51::chains(*robot);
  if (!on_chains) return tl::unexpected(on_chains.error());
  const auto samples = example51::trajectory(*on_chains, 0);
  if (!samples) return tl::unexpected(samples.error());
  const ChainSample& last = samples->back();
  const std::vector<Polyline> chains = chains_of(*on_chains, last);
  const TypeTwo& type = last.velocity.type_2;
  const Point met =
      type.point.value_or(Vec3<double>::Constant(std::numeric_limits<double>::quiet_NaN())).head<2>();

  ItemResult result;
  auto& findings = result.findings;
  const bool as_claimed = type.singular && type.rank == 2 && type.kind == LineClass::concurrent;
  findings.push_back(
      {"last pose", "type II, three lines meet in one point",
       fmt::format("{}, rank {}, {}", type.singular ? "type II" : "regular", type.rank, to_string(type.kind)),
       "", as_claimed ? "holds" : "fails"});
  const Point derived = example51::meeting_point();
  findings.push_back(compare::claimed(
      "meeting point, derived p/(1 − R_p/R_b), that of constant curvature", "drawn, not printed",
      fmt::format("({:.7f}, {:g}) m", met.x(), std::abs(met.y()) < 1e-12 ? 0.0 : met.y()),
      (met - derived).norm(), 1e-12, "m"));
  findings.push_back(compare::claimed("legs closed after 59 least-norm motions", "not given",
                                      compare::small(last.velocity.rates.closure_error) + " m",
                                      last.velocity.rates.closure_error, 1e-14, "m"));
  double least = 1, most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::ranges::minmax(last.legs[i].of(on_chains->legs[i].chain));
    least = std::min(least, high / low);  // angles are negative
    most = std::max(most, std::abs(low));
  }
  findings.push_back({"joints of a leg bend alike", "drawn nearly so",
                      fmt::format("at most {:.1f}°, in a leg the least is {:.0f} % of the largest or more",
                                  most * 180 / pi, 100 * least),
                      "", "for information"});

  result.tables.emplace_back("fig12", table_of(chains));
  result.figures.emplace_back("fig12", figure_of(last, chains, met));
  return result;
}

}  // namespace sinew::inline v1
