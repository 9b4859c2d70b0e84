/// TDPCR Fig. 10: the last pose of the trajectory of section 5.1, η = 1, bending positive in every leg. The
/// paper claims a type II singularity because the three lines meet in one point; where, it does not print.
/// Theory: docs/theory/example51.md, sections 1 and 6
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/linalg.hpp"
#include "math/polygon.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tdpcr/example51.hpp"
#include "study/tdpcr/robot_drawing.hpp"

namespace sinew::inline v1 {
namespace {

using drawing::Point;
using example51::Printed, example51::Sample;
using std::numbers::pi;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// One leg's line: a unit direction and the moment of that direction about the base's origin.
struct Line {
  Point direction;
  double moment;  ///< [m]
};

std::vector<Line> lines_of(const PlanarShape& picture) {
  std::vector<Line> lines;
  for (const auto& [from, to] : picture.lines) {
    const Point direction = (to - from).normalized();
    lines.push_back({direction, cross(to, direction)});
  }
  return lines;
}

/// Not finite where they are parallel.
Point crossing(const Line& a, const Line& b) {
  return (b.moment * a.direction - a.moment * b.direction) / cross(a.direction, b.direction);
}

/// Where the lines meet; NaN where they do not, so that every comparison with it fails.
Point meeting(const TypeTwo& type) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return type.point ? Point(type.point->x(), type.point->y()) : Point(none, none);
}

// ---------------------------------------------------------------- findings

std::string point_text(const Point& point) {
  // Not −0: the sign of what rounding leaves means nothing.
  const auto clean = [](double value) { return std::abs(value) < 1e-12 ? 0.0 : value; };
  return fmt::format("({:.7g}, {:.7g}) m", clean(point.x()), clean(point.y()));
}

/// Where the drawn platform is: its points' mean, and the turn of the first.
PlanarPose drawn_pose(const PlanarShape& picture) {
  Point centre(0, 0);
  for (const Point& point : picture.platform) centre += point / static_cast<double>(picture.platform.size());
  const Point arm = picture.platform[0] - centre, printed = Printed{}.platform_points()[0];
  return {centre.x(), centre.y(), std::atan2(cross(printed, arm), printed.dot(arm))};
}

void add_pose(std::vector<Finding>& findings, const Sample& last, const PlanarShape& picture) {
  const PlanarPose drawn = drawn_pose(picture);
  const Point centre(drawn.x, drawn.y), printed(Printed{}.last_x, 0);
  findings.push_back(compare::given("last pose, (68)-(70) with η = 1: p", point_text(printed),
                                    point_text(centre), (centre - printed).norm(), 1e-15, "m"));
  findings.push_back(compare::given("last pose, (68)-(70) with η = 1: φ", "π/3",
                                    fmt::format("{} π", compare::number(drawn.phi / pi)),
                                    std::abs(drawn.phi - pi / 3), 1e-14, "rad"));
  findings.push_back(compare::claimed("legs closed", "drawn", fmt::format("{} legs", last.curvatures.size()),
                                      last.closure_error, 1e-14, "m"));
}

/// Q b_i = (R_p/R_b) a_i: the platform is the base made smaller, and each line joins a point to its image.
Finding homothety(const PlanarShape& picture, const Point& centre) {
  const double ratio = Printed{}.platform_radius / Printed{}.base_radius;
  double off = 0;
  std::string found;
  for (std::size_t i = 0; i < picture.base.size(); ++i) {
    const Point arm = picture.platform[i] - centre;
    off = std::max(off, (arm - ratio * picture.base[i]).norm());
    found += (i ? ", " : "") + compare::number(arm.dot(picture.base[i]) / picture.base[i].squaredNorm());
  }
  return compare::claimed(fmt::format("derived: platform = base scaled, Q b_i = (R_p/R_b) a_i, R_p/R_b = {}",
                                      compare::number(ratio)),
                          "not stated", found, off, 1e-15, "m");
}

void add_lines(std::vector<Finding>& findings, const Sample& last, const PlanarShape& picture) {
  const TypeTwo& type = last.type_2;
  const bool as_claimed = type.singular && type.rank == 2 && type.kind == LineClass::concurrent;
  findings.push_back(
      {"last pose", "type II, three lines intersect at a common point",
       fmt::format("{}, rank {}, {}", type.singular ? "type II" : "regular", type.rank, to_string(type.kind)),
       "", as_claimed ? "holds" : "fails"});
  const Point derived = example51::meeting_point();
  findings.push_back(compare::claimed("common point, derived p/(1 − R_p/R_b) = " + point_text(derived),
                                      "drawn, not printed", point_text(meeting(type)),
                                      (meeting(type) - derived).norm(), 1e-12, "m"));
  const std::vector<Line> lines = lines_of(picture);
  double off = 0;
  std::string points;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Point met = crossing(lines[i], lines[(i + 1) % lines.size()]);
    off = std::max(off, (met - derived).norm());
    points += (i ? ", " : "") + point_text(met);
  }
  findings.push_back(compare::claimed("lines 1 and 2, 2 and 3, 3 and 1 cross there too", "drawn, not printed",
                                      points, off, 1e-14, "m"));
  findings.push_back(homothety(picture, Point(last.pose.x, last.pose.y)));
}

/// σ of the matrix with rows (direction, moment about the platform's centre over R_p).
std::array<double, 3> homogenised(const std::vector<Line>& lines, const Point& centre) {
  std::array<double, 9> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Line& line = lines[i];
    rows[3 * i] = line.direction.x();
    rows[3 * i + 1] = line.direction.y();
    rows[3 * i + 2] = (line.moment - cross(centre, line.direction)) / Printed{}.platform_radius;
  }
  std::array<double, 3> sigma{};
  singular_values(MatrixView(rows.data(), 3, 3), sigma);
  return sigma;
}

void add_rank(std::vector<Finding>& findings, const Sample& last, const PlanarShape& picture) {
  const auto sigma = homogenised(lines_of(picture), Point(last.pose.x, last.pose.y));
  findings.push_back(compare::claimed(
      "singular values of J homogenised (unit rows, moments over R_p), the third over the first",
      "not given: the paper's J mixes m and m²",
      fmt::format("{}, {}, {}", compare::number(sigma[0]), compare::number(sigma[1]),
                  sigma[2] <= type_2_tolerance * sigma[0] ? "0 to rounding" : compare::number(sigma[2])),
      sigma[2] / sigma[0], type_2_tolerance, ""));
  const double condition = last.indices.condition_homogenised;
  const bool none = std::isnan(condition);
  findings.push_back({"condition number of J homogenised", "increases to infinity",
                      none ? "none: J has no inverse" : compare::number(condition), "",
                      none || condition > 1 / type_2_tolerance ? "holds" : "fails"});
}

/// With the inputs held the platform turns about the common point: v = −E c, ω = 1.
Finding free_motion(const Robot& robot, const Sample& last, Workspace& work) {
  const Velocity at = velocity(robot, last.pose, last.curvatures, work);
  const Point c = example51::meeting_point() - Point(last.pose.x, last.pose.y);
  const Eigen::Vector3d twist(c.y(), -c.x(), 1);
  const double off = (at.J * twist).norm() / (at.J.norm() * twist.norm());
  return compare::claimed("free motion, derived a rotation about that point: J t = 0 for t = (−E c, 1)",
                          "not stated", fmt::format("‖J t‖ = {}", compare::small((at.J * twist).norm())), off,
                          1e-15, "of ‖J‖ ‖t‖");
}

/// The translation plays no part: everywhere at φ = 60° the lines meet, in p/(1 − R_p/R_b).
Expected<Finding> elsewhere(const Robot& robot, Workspace& work) {
  const double ratio = Printed{}.platform_radius / Printed{}.base_radius;
  const std::vector<int> bending(static_cast<std::size_t>(leg_count(robot)), 1);
  double off = 0;
  int concurrent = 0, all = 0;
  for (const double x : {-0.03, 0.0, 0.03})
    for (const double y : {-0.03, 0.0, 0.03}) {
      const PlanarPose pose{x, y, pi / 3};
      const Inverse there = inverse(robot, pose, {.bending = bending}, work);
      if (!there.ok()) return failure("no_solution", robot.name(), to_string(there.report));
      const std::vector<double> curvatures(there.coordinates.begin(), there.coordinates.end());
      const TypeTwo type = velocity(robot, pose, curvatures, work).type_2;
      ++all;
      concurrent += type.kind == LineClass::concurrent && type.point ? 1 : 0;
      off = std::max(off, (meeting(type) - Point(x, y) / (1 - ratio)).norm());
    }
  if (concurrent < all) off = std::numeric_limits<double>::infinity();
  return compare::claimed("φ = π/3 with x, y in {−0.03, 0, 0.03} m, derived: they meet in p/(1 − R_p/R_b)",
                          "not stated", fmt::format("concurrent in {} of {} poses", concurrent, all), off,
                          1e-12, "m");
}

Table table_of(const Sample& last, const PlanarShape& picture) {
  Table table{"leg",         "base_x[m]", "base_y[m]", "platform_x[m]",  "platform_y[m]", "direction_x",
              "direction_y", "moment[m]", "chord[m]",  "curvature[1/m]", "tendon_1[m]"};
  table.comments = compare::provenance("tdpcr/fig10", "the legs and their lines in the last pose",
                                       example51::all_bend_positive);
  table.comments.push_back("line: unit direction, moment of it about the base's origin");
  const std::vector<Line> lines = lines_of(picture);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Point a = picture.base[i], b = picture.platform[i];
    table.add_row({static_cast<double>(i + 1), a.x(), a.y(), b.x(), b.y(), lines[i].direction.x(),
                   lines[i].direction.y(), lines[i].moment, (b - a).norm(), last.curvatures[i],
                   last.tendons[i]});
  }
  return table;
}

// ---------------------------------------------------------------- figure

Figure figure_of(const Sample& last, const PlanarShape& picture) {
  const PlanarPose& at = last.pose;
  Panel panel = drawing::plane(
      fmt::format("x = {:g} mm, y = {:g}, φ = {:g}°", 1e3 * at.x, 1e3 * at.y, at.phi * 180 / pi),
      Point(-0.215, -0.15), Point(0.215, 0.22), 0.1);
  panel.legend = Legend::below;
  drawing::add_base(panel, picture, "base");
  drawing::add_platform(panel, picture, "platform");
  const Point met = meeting(last.type_2);
  for (std::size_t i = 0; i < picture.lines.size(); ++i) {
    const Point from = picture.lines[i][0], beyond = met + 0.015 * (met - from).normalized();
    panel.series.push_back(
        drawing::curve(i ? "" : "Plücker lines", {from, beyond}, Mark::dashed, Colour::vermillion, 1.8));
  }
  for (std::size_t i = 0; i < picture.backbones.size(); ++i)
    panel.series.push_back(
        drawing::curve(i ? "" : "backbones", picture.backbones[i], Mark::line, Colour::blue, 3));
  drawing::add_joints(panel, picture, "revolute joints");
  drawing::add_base_names(panel, picture, 0.014);
  drawing::add_platform_names(panel, picture, Point(at.x, at.y), 0.014, 60);
  const Point words(0.1, 0.075);
  drawing::add_leader(panel, met, words);
  panel.series.push_back(drawing::curve("common point C", {met}, Mark::points, Colour::vermillion, 5));
  const double y = std::abs(met.y()) < 1e-12 ? 0.0 : 1e3 * met.y();
  panel.notes.push_back(
      drawing::text(fmt::format("C = ({:.3f}, {:.3g}) mm", 1e3 * met.x(), y), words, Note::Side::right));
  return {.title = "",
          .panels = {panel},
          .width = 760,
          .height = 740,
          .comments = compare::provenance("tdpcr/fig10", "Fig. 10", example51::all_bend_positive)};
}

}  // namespace

Expected<ItemResult> tdpcr_fig10(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3-rfr");
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  const auto last = example51::sample(*robot, 1, work);
  if (!last) return tl::unexpected(last.error());
  const PlanarShape picture = shape(*robot, last->pose, last->curvatures, 101);

  ItemResult result;
  add_pose(result.findings, *last, picture);
  add_lines(result.findings, *last, picture);
  add_rank(result.findings, *last, picture);
  result.findings.push_back(free_motion(*robot, *last, work));
  auto others = elsewhere(*robot, work);
  if (!others) return tl::unexpected(std::move(others.error()));
  result.findings.push_back(std::move(*others));

  result.tables.emplace_back("fig10", table_of(*last, picture));
  result.figures.emplace_back("fig10", figure_of(*last, picture));
  return result;
}

}  // namespace sinew::inline v1
