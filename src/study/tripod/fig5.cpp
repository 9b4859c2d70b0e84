/// 3PFS Fig. 5: the loci (19) where the inverse kinematics of the 3PRS is singular, in the plane of e₁ and
/// e₂. Beyond the paper: the locus of the forward kinematics, det = 0 of the left matrix of (17), which comes
/// first in nearly every direction. Theory: docs/theory/tripod_figures.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sinew/analysis/velocity.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/example.hpp"

namespace sinew::inline v1 {
namespace {

using std::numbers::pi, std::numbers::sqrt3;

constexpr double degree = pi / 180;

/// Both loci in every direction of a whole degree.
struct Locus {
  double direction;         ///< [deg]
  double inverse, forward;  ///< |(e₁, e₂)|; NaN where the direction has none
};

std::vector<Locus> loci_of(const TripodSize& size) {
  std::vector<Locus> loci;
  for (int k = 0; k < 360; ++k)
    loci.push_back({static_cast<double>(k), inverse_locus(size, k * degree).value_or(not_a_number),
                    forward_locus(size, k * degree).value_or(not_a_number)});
  return loci;
}

Table table_of(const std::vector<Locus>& loci) {
  Table table{"direction[deg]", "inverse", "inverse_tilt[deg]", "forward", "forward_tilt[deg]"};
  table.comments = compare::provenance(
      "3pfs/fig5", "loci by the direction from e1 towards e2, as |(e1, e2)| and as tilt", tripod::as_printed);
  table.comments.push_back("forward is empty where the inverse locus comes first");
  for (const Locus& at : loci)
    table.add_row({at.direction, at.inverse, tripod::tilt(at.inverse), at.forward, tripod::tilt(at.forward)});
  return table;
}

/// The larger of two; NaN stays.
double worse(double most, double here) { return here <= most ? most : here; }

// ---------------------------------------------------------------- findings

void add_size(std::vector<Finding>& findings, const TripodSize& size) {
  using tripod::printed;
  findings.push_back(
      compare::printed("circumradius of the rails r_A", printed.base_radius, size.base_radius, "m"));
  findings.push_back(compare::printed("struts L", printed.strut_length, size.strut_length, "m"));
  findings.push_back(
      compare::printed("platform's circumradius r", printed.platform_radius, size.platform_radius, "m"));
}

/// The left sides of (19) are 1 − ρ² (1 + 2 cos 2α), so between −2 and 2 in the disc.
Finding plus_sign(const TripodSize& size) {
  double least = 2, most = -2;
  for (int k = 0; k < 3600; ++k)
    for (const double left : radial_positions(std::cos(k * 0.1 * degree), std::sin(k * 0.1 * degree))) {
      least = std::min(least, left);
      most = std::max(most, left);
    }
  const double plus = radial_limits(size)[1];
  return {"(19) with the sign +", "three loci with ±",
          fmt::format("left sides from {:.4g} to {:.4g}, (r_A + L)/r = {:.4g}: no locus", least, most, plus),
          "", plus > most ? "for information" : "fails"};
}

void add_inverse(std::vector<Finding>& findings, const TripodSize& size, const std::vector<Locus>& loci) {
  double off = 0, least = 1, most = 0;
  for (const Locus& at : loci) {
    off = worse(off, std::abs(at.inverse - tripod::inverse_radius(size, at.direction * degree)));
    least = std::min(least, at.inverse);
    most = std::max(most, at.inverse);
  }
  findings.push_back(compare::claimed("(19) solved, derived ρ² = (r − r_A + L)/(r (4 cos² α − 1))",
                                      "drawn, not printed", fmt::format("{} directions", loci.size()), off,
                                      1e-14, "of |(e_1, e_2)|"));
  const auto row = [&](const char* where, double ours, double derived) {
    findings.push_back(compare::claimed(fmt::format("|(e_1, e_2)| at {}, derived {:.6f}", where, derived),
                                        "drawn, not printed",
                                        fmt::format("{:.6f}, a tilt of {:.2f}°", ours, tripod::tilt(ours)),
                                        std::abs(ours - derived), 1e-14, ""));
  };
  row("0°, 60°, 120° …, the nearest", least, std::sqrt(0.6));
  row("30°, 90°, 150° …, the farthest", most, std::sqrt(0.9));
}

/// The same through the robot: poses just inside have slides, those just outside have none.
Finding reach(const Robot& robot, const std::vector<Locus>& loci, Workspace& work) {
  std::size_t inside = 0, outside = 0;
  const auto is_reached = [&](const Locus& at, double factor) {
    const double radius = factor * at.inverse, direction = at.direction * degree;
    const ConstrainedPose place =
        constrained_pose(robot, {tripod::height, radius * std::cos(direction), radius * std::sin(direction)});
    return place.ok() && inverse(robot, place.pose, {}, work).ok();
  };
  for (const Locus& at : loci) {
    inside += is_reached(at, 1 - 1e-9);
    outside += is_reached(at, 1 + 1e-9);
  }
  return {"inverse kinematics 1e-9 inside and outside (19)", "its limit",
          fmt::format("{} and {} of {} poses solved", inside, outside, loci.size()), "",
          inside == loci.size() && outside == 0 ? "holds" : "fails"};
}

/// The forward locus by the velocity analysis of the robot: its determinant there over that at home.
Finding singular_there(const Robot& robot, const TripodSize& size, const std::vector<Locus>& loci,
                       Workspace& work) {
  std::size_t places = 0, found = 0;
  double most = 0;
  for (const Locus& at : loci) {
    if (std::isnan(at.forward)) continue;
    ++places;
    const double direction = at.direction * degree;
    const ConstrainedPose place = constrained_pose(
        robot, {tripod::height, at.forward * std::cos(direction), at.forward * std::sin(direction)});
    const Inverse legs = inverse(robot, place.pose, {}, work);
    if (!legs.ok()) continue;
    const Velocity rates = velocity(robot, place.pose, legs.coordinates, work);
    found += rates.type_2.singular;
    most = worse(most, std::abs(rates.determinant / tripod_determinant(size, 0, 0)));
  }
  if (found < places) most = std::numeric_limits<double>::infinity();
  return compare::claimed("J of the robot on the FK locus", "not stated",
                          fmt::format("type II at {} of {} places", found, places), most, 1e-12,
                          "of the determinant at home");
}

/// On e₂ = 0 the mechanism is symmetric and det = 0 falls apart; what is left of the factor that vanishes.
double on_the_axis(const TripodSize& size, double e1) {
  const double f = size.platform_radius * (1 - 3 * e1 * e1) - size.base_radius;
  return (1 - 2 * e1 * e1) / std::sqrt(1 - e1 * e1) -
         2 * e1 * f / std::sqrt((size.strut_length - f) * (size.strut_length + f));
}

void add_forward(std::vector<Finding>& findings, const Robot& robot, const TripodSize& size,
                 const std::vector<Locus>& loci, Workspace& work) {
  const double gap = tripod::gap(size) / degree, end = tripod::inverse_radius(size, gap * degree);
  const auto found = std::ranges::count_if(loci, [](const Locus& at) { return !std::isnan(at.forward); });
  findings.push_back({"what limits the tilt, going out from home", "the loci of IK, (19)",
                      fmt::format("FK singular first in {} of {} directions", found, loci.size()), "",
                      found == 0 ? "holds" : "fails"});
  const double at_180 = loci[180].forward, at_30 = loci[30].forward;
  findings.push_back(compare::claimed(
      "FK singular at 60°, 180°, 300°, derived (1 − 2e_1²)/e_0 = 2 e_1 f/√(L² − f²), f = r (1 − 3e_1²) − r_A",
      "not stated", fmt::format("{:.6f}, a tilt of {:.2f}°", at_180, tripod::tilt(at_180)),
      std::abs(on_the_axis(size, -at_180)), 1e-13, ""));
  findings.push_back({"FK singular at 30°, 90°, 150° …", "not stated",
                      fmt::format("{:.6f}, a tilt of {:.2f}°", at_30, tripod::tilt(at_30)), "",
                      at_30 < loci[30].inverse ? "for information" : "fails"});
  const bool none =
      std::isnan(loci[0].forward) && std::isnan(loci[120].forward) && std::isnan(loci[240].forward);
  findings.push_back({"FK singular about 0°, 120°, 240°", "not stated",
                      fmt::format("none within {:.2f}°; the arcs end on (19), at {:.4f}, a tilt of {:.2f}°",
                                  gap, end, tripod::tilt(end)),
                      "", none ? "for information" : "fails"});
  findings.push_back(singular_there(robot, size, loci, work));
}

void add_areas(std::vector<Finding>& findings, const TripodSize& size) {
  const tripod::Areas areas = tripod::areas(size);
  const double derived = 1.8 * sqrt3 * std::numbers::ln2;
  findings.push_back(compare::claimed(fmt::format("area inside (19), derived 1.8 √3 ln 2 = {:.6f}", derived),
                                      "drawn, not printed", fmt::format("{:.6f}", areas.inverse),
                                      std::abs(areas.inverse - derived), 1e-14, ""));
  findings.push_back({"of it reached from home before FK is singular", "all of it",
                      fmt::format("{:.4f}, {:.1f} %", areas.first, 100 * areas.first / areas.inverse), "",
                      areas.first < areas.inverse ? "fails" : "holds"});
}

// ---------------------------------------------------------------- figure

/// One line of (19): 3u² − v² = 3ρ₀², u along the leg's radial tilt, within the disc.
Series hyperbola(const TripodSize& size, int leg) {
  Series series{.label = fmt::format("(19), leg {}", leg + 1),
                .x = {},
                .y = {},
                .mark = Mark::line,
                .colour = leg == 0   ? Colour::blue
                          : leg == 1 ? Colour::orange
                                     : Colour::purple,
                .width = 2};
  // leg 1 along e₁; those of legs 2 and 3 turned with the legs
  const double turn = 2 * pi / 3 * leg, nearest = tripod::inverse_radius(size, 0);
  const double most = std::sqrt((1 - nearest * nearest) * 0.75);  // v where u² + v² = 1
  for (const double side : {1.0, -1.0}) {
    for (int k = -100; k <= 100; ++k) {
      const double v = most * k / 100, u = side * std::sqrt(nearest * nearest + v * v / 3);
      series.x.push_back(u * std::cos(turn) - v * std::sin(turn));
      series.y.push_back(u * std::sin(turn) + v * std::cos(turn));
    }
    series.x.push_back(not_a_number);
    series.y.push_back(not_a_number);
  }
  return series;
}

Figure figure_of(const TripodSize& size, const std::vector<Locus>& loci) {
  Panel panel = tripod::plane("circles: tilt of the platform");
  panel.x.low = panel.y.low = -1.05;
  panel.x.high = panel.y.high = 1.05;
  panel.legend = Legend::below;
  panel.series = {tripod::inverse_curve(size, Mark::polygon, 0.5), tripod::first_curve(size)};
  panel.series.front().colour = Colour::sky;
  for (const int angle : {30, 60, 90, 120, 150, 180}) {
    const double radius = std::sin(0.5 * angle * degree), beside = radius + 0.04;
    panel.series.push_back(tripod::circle(radius, Mark::line, Colour::grey, angle == 180 ? 1.5 : 0.75));
    if (angle != 150)  // too near the rim
      panel.notes.push_back({fmt::format("{}°", angle), beside * std::cos(pi / 3), beside * std::sin(pi / 3),
                             Note::Side::centre, Colour::black});
  }
  panel.notes.push_back({"reached from home", 0.06, -0.1, Note::Side::centre, Colour::black});
  panel.notes.push_back({"beyond", -0.62, 0.03, Note::Side::centre, Colour::black});
  panel.notes.push_back({"FK", -0.62, -0.03, Note::Side::centre, Colour::black});
  for (int leg = 0; leg < 3; ++leg) panel.series.push_back(hyperbola(size, leg));
  panel.series.push_back(tripod::forward_curve(size, 3));
  panel.series.back().label = "FK singular";
  const auto mark = [&](double radius, double direction, Note::Side side) {
    const double x = radius * std::cos(direction * degree), y = radius * std::sin(direction * degree);
    panel.series.push_back(
        {.label = {}, .x = {x}, .y = {y}, .mark = Mark::points, .colour = Colour::black, .width = 4});
    panel.notes.push_back({fmt::format("{:.4f}", radius), x, y, side, Colour::black});
  };
  mark(loci[0].inverse, 0, Note::Side::left);
  mark(loci[330].inverse, 330, Note::Side::right);
  mark(loci[180].forward, 180, Note::Side::right);
  mark(loci[330].forward, 330, Note::Side::left);
  return {.title = "",
          .panels = {panel},
          .width = 760,
          .height = 820,
          .comments = compare::provenance("3pfs/fig5", "Fig. 5", tripod::as_printed)};
}

}  // namespace

Expected<ItemResult> tripod_fig5(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3prs");
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  const TripodSize size = tripod::size_of(*robot);
  const std::vector<Locus> loci = loci_of(size);

  ItemResult result;
  add_size(result.findings, size);
  result.findings.push_back(plus_sign(size));
  add_inverse(result.findings, size, loci);
  result.findings.push_back(reach(*robot, loci, work));
  add_forward(result.findings, *robot, size, loci, work);
  add_areas(result.findings, size);

  result.tables.emplace_back("fig5", table_of(loci));
  result.figures.emplace_back("fig5", figure_of(size, loci));
  return result;
}

}  // namespace sinew::inline v1
