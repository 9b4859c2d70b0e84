/// 3PFS Fig. 4: the parasitic motions x_p, y_p and e₀ of the 3PRS over the disc e₁² + e₂² ≤ 1, for r = 1. The
/// paper draws three surfaces and prints (10); here the poses come from Newton's method on the planes of the
/// hinges, and (10) is what they are compared with. Theory: docs/theory/tripod_figures.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/contour.hpp"
#include "study/tripod/example.hpp"

namespace sinew::inline v1 {
namespace {

using std::numbers::pi;

constexpr double radius = 1;  ///< r [m], as the figure has it

/// A place of the grid and the pose there; NaN outside the disc.
struct Parasitic {
  double e1, e2;
  double x = not_a_number, y = not_a_number, e0 = not_a_number, e3 = not_a_number;
  double beside = not_a_number;  ///< largest distance of a platform point from its plane [m]
};

Parasitic parasitic(const Robot& robot, const IndependentPose& at) {
  Parasitic out{at.e1, at.e2};
  if (at.e1 * at.e1 + at.e2 * at.e2 > 1) return out;
  const ConstrainedPose found = constrained_pose(robot, at);
  if (!found.ok()) return out;
  const auto& [e0, e1, e2, e3] = found.pose.quaternion;
  out.x = found.pose.position.x();
  out.y = found.pose.position.y();
  out.e0 = e0;
  out.e3 = e3;
  out.beside = found.report.residual;
  return out;
}

std::vector<Parasitic> everywhere(const Robot& robot) {
  std::vector<Parasitic> all;
  for (const double e2 : tripod::places())
    for (const double e1 : tripod::places()) all.push_back(parasitic(robot, {tripod::height, e1, e2}));
  return all;
}

Table table_of(const std::vector<Parasitic>& all) {
  Table table{"e1", "e2", "x[m]", "y[m]", "e0", "tilt[deg]"};
  table.comments =
      compare::provenance("3pfs/fig4", "parasitic motions over the unit disc", tripod::of_unit_radius);
  for (const Parasitic& p : all)
    if (!std::isnan(p.e0))
      table.add_row({p.e1, p.e2, p.x, p.y, p.e0, tripod::tilt(std::min(1.0, std::hypot(p.e1, p.e2)))});
  return table;
}

// ---------------------------------------------------------------- findings

/// The largest of something over the places in the disc; infinite where one of those has no pose.
template <class F>
double worst(const std::vector<Parasitic>& all, const F& off) {
  double most = 0;
  for (const Parasitic& p : all) {
    if (p.e1 * p.e1 + p.e2 * p.e2 > 1) continue;
    const double here = std::abs(off(p));
    most = std::isnan(here) ? std::numeric_limits<double>::infinity() : std::max(most, here);
  }
  return most;
}

void add_equations(std::vector<Finding>& findings, const std::vector<Parasitic>& all) {
  const auto count = std::ranges::count_if(all, [](const Parasitic& p) { return !std::isnan(p.e0); });
  const std::string poses = fmt::format("{} poses in the disc", count);
  const auto add = [&](const char* name, const char* formula, const char* unit, const auto& off) {
    findings.push_back(compare::given(name, formula, poses, worst(all, off), 1e-14, unit));
  };
  add("x_p, (10)", "−2 r e_1 e_2", "m", [](const Parasitic& p) { return p.x + 2 * radius * p.e1 * p.e2; });
  add("y_p, (10)", "−r (e_1² − e_2²)", "m",
      [](const Parasitic& p) { return p.y + radius * (p.e1 * p.e1 - p.e2 * p.e2); });
  add("e_0² + e_1² + e_2², (10)", "1", "",
      [](const Parasitic& p) { return p.e0 * p.e0 + p.e1 * p.e1 + p.e2 * p.e2 - 1; });
  add("e_3, (10)", "0", "", [](const Parasitic& p) { return p.e3; });
  findings.push_back(compare::claimed("platform points in the planes of their hinges, (2)", "0", poses,
                                      worst(all, [](const Parasitic& p) { return p.beside; }), 1e-14, "m"));
}

/// Largest and smallest value on the grid, and where.
Finding extremes(const char* quantity, double Parasitic::*value, const std::vector<Parasitic>& all,
                 double low, double high) {
  const Parasitic *least = nullptr, *most = nullptr;
  for (const Parasitic& p : all) {
    if (std::isnan(p.*value)) continue;
    if (!least || p.*value < least->*value) least = &p;
    if (!most || p.*value > most->*value) most = &p;
  }
  if (!most) return {quantity, "drawn, not printed", "none", "", "fails"};
  // Not −0: the sign of what rounding leaves of e₀ means nothing.
  const double lowest = std::abs(least->*value) < 1e-12 ? 0.0 : least->*value;
  return compare::claimed(quantity, "drawn, not printed",
                          fmt::format("{:.4g} at ({:g}, {:g}), {:.4g} at ({:g}, {:g})", lowest, least->e1,
                                      least->e2, most->*value, most->e1, most->e2),
                          std::max(std::abs(least->*value - low), std::abs(most->*value - high)), 1e-14, "");
}

/// x_p has its ends at 45° on the rim, between the places of the grid: at (1, ∓1)/√2.
Finding extremes_of_x(const Robot& robot) {
  const double half = std::sqrt(0.5) * (1 - 1e-15);  // not beyond the rim by rounding
  const double low = parasitic(robot, {tripod::height, half, half}).x,
               high = parasitic(robot, {tripod::height, half, -half}).x;
  return compare::claimed("x_p from −1 to 1 m, derived at (1, ±1)/√2", "drawn, not printed",
                          fmt::format("{:.10g}, {:.10g} m", low, high),
                          std::max(std::abs(low + 1), std::abs(high - 1)), 1e-14, "m");
}

/// The place turned by 120° about the robot's axis has its pose turned by 120°; the mirrored one mirrored.
Finding symmetry(const Robot& robot) {
  const double c = std::cos(2 * pi / 3), s = std::sin(2 * pi / 3);
  double off = 0;
  int count = 0;
  for (const double rho : {0.2, 0.5, 0.8, 0.95})
    for (int k = 0; k < 24; ++k, ++count) {
      const double e1 = rho * std::cos(k * pi / 12 + 0.1), e2 = rho * std::sin(k * pi / 12 + 0.1);
      const Parasitic here = parasitic(robot, {tripod::height, e1, e2}),
                      mirrored = parasitic(robot, {tripod::height, e1, -e2}),
                      turned = parasitic(robot, {tripod::height, c * e1 - s * e2, s * e1 + c * e2});
      const double turn = std::hypot(turned.x - c * here.x + s * here.y, turned.y - s * here.x - c * here.y);
      const double mirror = std::hypot(mirrored.x + here.x, mirrored.y - here.y);
      off = turn + mirror <= off ? off : turn + mirror;  // NaN stays
    }
  return compare::claimed("three-fold symmetry with mirrors", "drawn, not stated",
                          fmt::format("{} places, each turned and mirrored", count), off, 1e-14, "m");
}

void add_shape(std::vector<Finding>& findings, const Robot& robot, const std::vector<Parasitic>& all) {
  findings.push_back(extremes_of_x(robot));
  findings.push_back(extremes("y_p from −1 to 1 m, derived at (±1, 0), (0, ±1)", &Parasitic::y, all, -1, 1));
  findings.push_back(extremes("e_0 from 0 on the rim to 1 at home, derived", &Parasitic::e0, all, 0, 1));
  findings.push_back(compare::claimed(
      "derived: P leaves the axis by r (e_1² + e_2²) = r sin²(φ/2), whatever the direction of the tilt",
      "not stated", "everywhere on the grid",
      worst(all,
            [](const Parasitic& p) { return std::hypot(p.x, p.y) - radius * (p.e1 * p.e1 + p.e2 * p.e2); }),
      1e-14, "m"));
  findings.push_back(symmetry(robot));
  double off = 0;
  for (std::size_t k = 0; k < all.size(); k += 7)
    if (!std::isnan(all[k].e0)) {
      const Parasitic other = parasitic(robot, {tripod::other_height, all[k].e1, all[k].e2});
      const double here = std::hypot(all[k].x - other.x, all[k].y - other.y, all[k].e0 - other.e0);
      off = here <= off ? off : here;  // NaN stays
    }
  findings.push_back(compare::claimed("the same at every height", "solely e_1, e_2",
                                      fmt::format("z = {} m and {} m", tripod::height, tripod::other_height),
                                      off, 1e-14, ""));
}

/// Below (9) the paper drops e₀ = 0 because it "is only null when there is no output rotation".
Finding null_of_e0(const Robot& robot) {
  const double unturned = parasitic(robot, {tripod::height, 0, 0}).e0,
               rim = parasitic(robot, {tripod::height, 0, 1}).e0;
  return {"where e_0 = cos(φ/2) is null", "only without output rotation (φ = 0)",
          fmt::format("e_0 = {:g} at φ = 0, {:g} at φ = 180°, the rim", unturned, rim), "",
          unturned == 0 && rim != 0 ? "holds" : "fails"};
}

// ---------------------------------------------------------------- figure

Panel panel(const std::vector<Parasitic>& all, double Parasitic::*value, std::string title, double low,
            const std::vector<contour::Levels>& levels) {
  std::vector<double> values;
  for (const Parasitic& p : all) values.push_back(p.*value);
  HeatMap map = tripod::map_of(std::move(values), "");
  map.low = low;
  map.high = 1;
  Panel out = tripod::plane(std::move(title));
  out.map = contour::spread(std::move(map));
  contour::add(out, levels);
  out.series.push_back(tripod::circle(1, Mark::outside, Colour::white, 1));
  out.series.push_back(tripod::circle(1, Mark::line, Colour::black, 1.5));
  return out;
}

Figure figure_of(const std::vector<Parasitic>& all) {
  const auto xs =
      panel(all, &Parasitic::x, "(a) xₚ [m] for r = 1 m", -1,
            {{{-0.8, -0.4}, {45}}, {{-0.6, -0.2}, {225}}, {{0.4, 0.8}, {-45}}, {{0, 0.2, 0.6}, {135}}});
  const auto ys =
      panel(all, &Parasitic::y, "(b) yₚ [m] for r = 1 m", -1,
            {{{-0.6, -0.2}, {0}}, {{-0.4}, {180}}, {{-0.8}, {}}, {{0, 0.2, 0.4, 0.6, 0.8}, {90}}});
  return {.title = "",
          .panels = {xs, ys,
                     panel(all, &Parasitic::e0, "(c) e₀ = cos(φ/2)", 0,
                           {{{0.4, 0.6, 0.8, 0.9, 0.95}, {90}}, {{0.2, 0.5, 0.7}, {}}})},
          .columns = 3,
          .width = 1500,
          .height = 440,
          .comments = compare::provenance("3pfs/fig4", "Fig. 4", tripod::of_unit_radius)};
}

}  // namespace

Expected<ItemResult> tripod_fig4(const StudyItem&, const std::filesystem::path&) {
  auto file = load("3prs");
  if (!file) return tl::unexpected(file.error());
  const Robot robot = tripod::with_platform_radius(*file, radius);
  const std::vector<Parasitic> all = everywhere(robot);

  ItemResult result;
  result.findings.push_back(
      compare::printed("platform radius r", radius, tripod::size_of(robot).platform_radius, "m"));
  add_equations(result.findings, all);
  add_shape(result.findings, robot, all);
  result.findings.push_back(null_of_e0(robot));

  result.tables.emplace_back("fig4", table_of(all));
  result.figures.emplace_back("fig4", figure_of(all));
  return result;
}

}  // namespace sinew::inline v1
