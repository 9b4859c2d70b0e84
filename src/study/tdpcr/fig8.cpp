/// TDPCR Fig. 8: the 3-RFR of section 5.1 in its initial configuration, η = 0, bending positive in every leg.
/// The paper prints the robot and says that both triangles are equilateral; of the legs it prints nothing, so
/// they are compared with what follows by hand. Theory: docs/theory/example51.md, section 5
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tdpcr/example51.hpp"
#include "study/tdpcr/robot_drawing.hpp"

namespace sinew::inline v1 {
namespace {

using example51::Printed, example51::Sample;
using std::numbers::pi, std::numbers::sqrt3;
using Values = std::vector<double>;

constexpr int samples = 2001;  // points of a curve in the picture

double polyline_length(const Polyline& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

// ---------------------------------------------------------------- what follows by hand

/// The home pose of the printed geometry. Base and platform points are 60° apart: the three legs are equal.
struct Derived {
  double chord, curvature, tendon_1, tendon_2;
};

Derived derived() {
  const Printed p;
  const double chord = std::sqrt(p.base_radius * p.base_radius + p.platform_radius * p.platform_radius -
                                 p.base_radius * p.platform_radius);
  // ρ = ℓ sin(t)/t with t = κℓ/2, by Newton from where it converges from one side.
  const double ratio = chord / p.backbone_length;
  double t = 1;
  for (int i = 0; i < 20; ++i) t -= (std::sin(t) - ratio * t) / (std::cos(t) - ratio);
  const double curvature = 2 * t / p.backbone_length, change = p.tendon_offset * curvature;
  return {chord, curvature, p.backbone_length * (1 - change), p.backbone_length * (1 + change)};
}

/// What we have of the legs. Chords are measured in the picture.
struct Legs {
  Values chord, curvature, tendon_1;
  Values drawn_1, drawn_2;  ///< lengths of the tendons' polylines [m]
};

Legs legs_of(const Sample& home, const PlanarShape& picture) {
  Legs legs{
      .chord = {}, .curvature = home.curvatures, .tendon_1 = home.tendons, .drawn_1 = {}, .drawn_2 = {}};
  for (std::size_t i = 0; i < picture.base.size(); ++i) {
    legs.chord.push_back((picture.platform[i] - picture.base[i]).norm());
    legs.drawn_1.push_back(polyline_length(picture.tendons[i][0]));
    legs.drawn_2.push_back(polyline_length(picture.tendons[i][1]));
  }
  return legs;
}

// ---------------------------------------------------------------- findings

double farthest(std::span<const double> values, double from) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value - from));
  return most;
}

Values sides(const Polyline& triangle) {
  Values lengths;
  for (std::size_t i = 0; i < triangle.size(); ++i)
    lengths.push_back((triangle[(i + 1) % triangle.size()] - triangle[i]).norm());
  return lengths;
}

/// Directions from the origin.
std::string angles(const Polyline& points) {
  std::string text;
  for (const Vec2<double>& point : points) {
    const double degrees = std::atan2(point.y(), point.x()) * 180 / pi;
    text += (text.empty() ? "at " : ", ") + fmt::format("{:.6g}°", degrees < 0 ? degrees + 360 : degrees);
  }
  return text;
}

std::string each(const Values& values, double factor, const char* unit) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + fmt::format("{:.6f}", factor * value);
  return text + ' ' + unit;
}

void add_geometry(std::vector<Finding>& findings, const Sample& home, const PlanarShape& picture) {
  const Printed paper;
  const double tendon = (picture.tendons[0][0][0] - picture.backbones[0][0]).norm();
  const double straight = home.tendons[0] / (1 - home.curvatures[0] * tendon);
  findings.push_back(
      compare::printed("base circumradius R_b", paper.base_radius, picture.base[0].norm(), "m"));
  findings.push_back(
      compare::printed("platform circumradius R_p", paper.platform_radius, picture.platform[0].norm(), "m"));
  findings.push_back(compare::printed("tendon offset d", paper.tendon_offset, tendon, "m"));
  findings.push_back(compare::printed("backbone length ℓ_i", paper.backbone_length, straight, "m"));
  findings.push_back(compare::given("base points a_1, a_2, a_3", "at 90°, 210°, 330°", angles(picture.base),
                                    example51::farthest(paper.base_points(), picture.base), 1e-15, "m"));
  findings.push_back(
      compare::given("platform points b_1, b_2, b_3", "at 30°, 150°, 270°", angles(picture.platform),
                     example51::farthest(paper.platform_points(), picture.platform), 1e-15, "m"));
  const auto triangle = [&](const char* quantity, const Polyline& corners, double radius) {
    const Values found = sides(corners);
    findings.push_back(compare::claimed(fmt::format("{} = {:.6f} mm", quantity, 1e3 * sqrt3 * radius),
                                        "equilateral", each(found, 1e3, "mm"),
                                        farthest(found, sqrt3 * radius), 1e-15, "m"));
  };
  triangle("base triangle, sides √3 R_b", picture.base, paper.base_radius);
  triangle("platform triangle, sides √3 R_p", picture.platform, paper.platform_radius);
}

void add_legs(std::vector<Finding>& findings, const Legs& legs) {
  const Derived by_hand = derived();
  const auto row = [&](const std::string& quantity, const Values& ours, double expected, double factor,
                       const char* shown, double bound, const char* unit) {
    findings.push_back(compare::claimed(fmt::format("{} = {:.6f} {}", quantity, factor * expected, shown),
                                        "drawn, not printed", each(ours, factor, shown),
                                        farthest(ours, expected), bound, unit));
  };
  row("chord ρ_i, derived √(R_b² + R_p² − R_b R_p)", legs.chord, by_hand.chord, 1e3, "mm", 1e-15, "m");
  row("curvature κ_i, derived root of ρ = (2/κ) sin(κℓ/2)", legs.curvature, by_hand.curvature, 1, "1/m",
      1e-12, "1/m");
  row("tendon 1, derived ℓ (1 − d κ)", legs.tendon_1, by_hand.tendon_1, 1e3, "mm", 1e-15, "m");
  // n chords of an arc that turns by θ are together shorter than the arc by at most θ²/24n² of it.
  const double turn = by_hand.curvature * Printed{}.backbone_length / (samples - 1), cut = turn * turn / 24;
  constexpr double rounding = 1e-14;  // of the sum
  row("tendon 1 measured in the drawing, derived ℓ (1 − d κ)", legs.drawn_1, by_hand.tendon_1, 1e3, "mm",
      cut * by_hand.tendon_1 + rounding, "m");
  row("tendon 2 measured in the drawing, derived ℓ (1 + d κ)", legs.drawn_2, by_hand.tendon_2, 1e3, "mm",
      cut * by_hand.tendon_2 + rounding, "m");
}

void add_state(std::vector<Finding>& findings, const Sample& home) {
  findings.push_back(compare::claimed("legs closed", "drawn", fmt::format("{} legs", home.curvatures.size()),
                                      home.closure_error, 1e-14, "m"));
  findings.push_back({"rank of J; its condition number, and homogenised", "not printed",
                      fmt::format("{}; {}, {}", home.type_2.rank, compare::number(home.indices.condition),
                                  compare::number(home.indices.condition_homogenised)),
                      "", "for information"});
}

Table table_of(const Legs& legs, const PlanarShape& picture) {
  Table table{"leg",      "base_x[m]",      "base_y[m]",       "platform_x[m]", "platform_y[m]",
              "chord[m]", "curvature[1/m]", "bend_angle[rad]", "tendon_1[m]",   "tendon_2[m]"};
  table.comments = compare::provenance("tdpcr/fig8", "the legs in the initial configuration",
                                       example51::all_bend_positive);
  for (std::size_t i = 0; i < picture.base.size(); ++i) {
    const double ell = Printed{}.backbone_length;
    table.add_row({static_cast<double>(i + 1), picture.base[i].x(), picture.base[i].y(),
                   picture.platform[i].x(), picture.platform[i].y(), legs.chord[i], legs.curvature[i],
                   ell * legs.curvature[i], legs.tendon_1[i], 2 * ell - legs.tendon_1[i]});
  }
  return table;
}

// ---------------------------------------------------------------- figure

using drawing::at_angle, drawing::Point;

void add_links(Panel& panel, const PlanarShape& picture, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    panel.series.push_back(drawing::curve("", picture.tendons[i][0], Mark::line, Colour::vermillion, 1.2));
    panel.series.push_back(drawing::curve("", picture.tendons[i][1], Mark::line, Colour::sky, 1.2));
    panel.series.push_back(drawing::curve("", picture.backbones[i], Mark::line, Colour::blue, 3));
  }
}

/// The whole robot with its axes and circumradii.
Panel robot_panel(const PlanarShape& picture) {
  const double base = picture.base[0].norm(), platform = picture.platform[0].norm();  // about O
  Panel panel = drawing::plane("(a) robot, x = y = 0, φ = 0: both frames coincide", Point(-0.22, -0.21),
                               Point(0.22, 0.23), 0.1);
  for (const double radius : {base, platform})
    panel.series.push_back(
        drawing::curve("", drawing::circle(Point(0, 0), radius), Mark::dotted, Colour::grey, 1.2));
  drawing::add_base(panel, picture, "");
  drawing::add_platform(panel, picture, "");
  const Point o(0, 0), x(0.068, 0), y(0, 0.068), to_base = at_angle(base, 250),
                                                 to_platform = at_angle(platform, -48);
  drawing::add_arrow(panel, o, x, 0.008);
  drawing::add_arrow(panel, o, y, 0.008);
  drawing::add_arrow(panel, o, to_base, 0.008);
  drawing::add_arrow(panel, o, to_platform, 0.008);
  add_links(panel, picture, 0, picture.backbones.size());
  drawing::add_joints(panel, picture, "");
  drawing::add_base_names(panel, picture, 0.016);
  drawing::add_platform_names(panel, picture, o, 0.014, -40);
  const auto words = [&](std::string text, const Point& at, Note::Side side = Note::Side::centre,
                         Colour colour = Colour::black) {
    panel.notes.push_back(drawing::text(std::move(text), at, side, colour));
  };
  words("x, x′", x, Note::Side::right);
  words("y, y′", y + Point(0, 0.010));
  words("O", o + Point(-0.002, 0.010), Note::Side::left);
  words(fmt::format("Rb = {:g} mm", 1e3 * base), 0.75 * to_base, Note::Side::right);
  words(fmt::format("Rp = {:g} mm", 1e3 * platform), to_platform, Note::Side::right);
  words("base", Point(-0.045, 0.115), Note::Side::left, Colour::grey);
  return panel;
}

/// A name with its value below, at the end of a leader.
void add_words(Panel& panel, const Point& named, const Point& shift, const char* name,
               const std::string& value, Colour colour) {
  constexpr double line = 0.0095;  // between lines of text
  const Point at = named + shift;
  const Note::Side side = shift.x() < 0 ? Note::Side::left : Note::Side::right;
  drawing::add_leader(panel, named, at);
  panel.notes.push_back(drawing::text(name, at, side, colour));
  panel.notes.push_back(drawing::text(value, at - Point(0, line), side, colour));
}

std::string millimetres(const char* symbol, double value) {
  return fmt::format("{} = {:.1f} mm", symbol, 1e3 * value);
}

/// One leg, large enough to tell its tendons apart.
Panel leg_panel(const PlanarShape& picture, const Legs& legs) {
  Panel panel = drawing::plane("(b) leg 1", Point(-0.08, -0.004), Point(0.15, 0.226), 0.05);
  drawing::add_platform(panel, picture, "");
  const Point a = picture.base[0], b = picture.platform[0];
  panel.series.push_back(drawing::curve("", {a, b}, Mark::dashed, Colour::black, 1.2));
  add_links(panel, picture, 0, 1);
  const Polyline &backbone = picture.backbones[0], &inner = picture.tendons[0][0],
                 &outer = picture.tendons[0][1];
  const auto at = [](const Polyline& points, double fraction) {
    return points[static_cast<std::size_t>(std::lround(fraction * static_cast<double>(points.size() - 1)))];
  };
  const auto inwards = [&](double s) { return Point((at(inner, s) - at(outer, s)).normalized()); };

  const double radius = 1 / legs.curvature[0];  // towards tendon 1
  const Point centre = at(backbone, 0.5) + radius * inwards(0.5), end = at(backbone, 0.66);
  panel.series.push_back(drawing::curve("", {centre}, Mark::points, Colour::black, 2));
  drawing::add_arrow(panel, centre, end, 0.004);
  panel.notes.push_back(
      drawing::text(millimetres("1/κ₁", radius), centre + Point(-0.01, -0.012), Note::Side::right));

  const double s = 0.8, reach = 0.014;  // the dimension of d
  drawing::add_arrow(panel, at(outer, s) - reach * inwards(s), at(outer, s), 0.004);
  drawing::add_arrow(panel, at(backbone, s) + reach * inwards(s), at(backbone, s), 0.004);
  panel.notes.push_back(drawing::text(millimetres("d", Printed{}.tendon_offset),
                                      at(outer, s) - reach * inwards(s), Note::Side::right));

  add_words(panel, Point(0.65 * a + 0.35 * b), Point(-0.016, 0.006), "chord",
            millimetres("ρ₁", legs.chord[0]), Colour::black);
  add_words(panel, at(inner, 0), Point(-0.014, -0.004), "tendon 1", millimetres("ℓ₁₁", legs.tendon_1[0]),
            Colour::vermillion);
  add_words(panel, at(backbone, 0.3), Point(0.028, 0.022), "backbone",
            millimetres("ℓ₁", Printed{}.backbone_length), Colour::blue);
  add_words(panel, at(outer, 0.5), Point(0.014, 0.006), "tendon 2", millimetres("ℓ₁₂", legs.drawn_2[0]),
            Colour::sky);
  panel.notes.push_back(drawing::text("A₁, revolute joint", a + Point(0, 0.014)));
  panel.notes.push_back(drawing::text("B₁, revolute joint", b + Point(0.004, -0.014), Note::Side::right));
  panel.notes.push_back(drawing::text("platform", Point(0, 0.012), Note::Side::centre, Colour::green));
  drawing::add_joints(panel, picture, "");
  return panel;
}

Figure figure_of(const PlanarShape& picture, const Legs& legs) {
  return {.title = "",
          .panels = {robot_panel(picture), leg_panel(picture, legs)},
          .columns = 2,
          .width = 1240,
          .height = 640,
          .comments = compare::provenance("tdpcr/fig8", "Fig. 8", example51::all_bend_positive)};
}

}  // namespace

Expected<ItemResult> tdpcr_fig8(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3-rfr");
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  const auto home = example51::sample(*robot, 0, work);
  if (!home) return tl::unexpected(home.error());
  const PlanarShape picture = shape(*robot, home->pose, home->curvatures, samples);
  const Legs legs = legs_of(*home, picture);

  ItemResult result;
  add_geometry(result.findings, *home, picture);
  add_legs(result.findings, legs);
  add_state(result.findings, *home);

  result.tables.emplace_back("fig8", table_of(legs, picture));
  result.figures.emplace_back("fig8", figure_of(shape(*robot, home->pose, home->curvatures, 101), legs));
  return result;
}

}  // namespace sinew::inline v1
