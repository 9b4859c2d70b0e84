/// 3PFS Fig. 7: "FK Jacobians' norm" over the tilts of the 3PRS. The paper prints neither a definition nor a
/// number: there are the norm of the left matrix of (17), which mixes units and cannot show where it is
/// singular, and the norms of the map U from input rates to the platform's twist, which do.
/// Theory: docs/theory/tripod_figures.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/example.hpp"

namespace sinew::inline v1 {
namespace {

using std::numbers::pi;
using tripod::Sample;
using Samples = std::vector<Sample>;

Table forward_table(const Samples& all) {
  Table table{"e1", "e2", "frobenius", "determinant[m^6]", "position[m/m]", "rotation[rad/m]"};
  table.comments = compare::provenance(
      "3pfs/fig7", "the left matrix of eq. (17), and U, over the tilts inside the loci (19)",
      tripod::as_printed);
  table.comments.push_back(
      "frobenius: of the matrix, in SI; position, rotation: 2-norms of the blocks of U, t = U.rates");
  for (const Sample& s : all)
    if (s.is_reached()) table.add_row({s.e1, s.e2, s.forward_norm, s.determinant, s.position, s.rotation});
  return table;
}

double off_by(double ours, double derived) { return std::abs(ours - derived); }

void add_home(std::vector<Finding>& findings, const TripodSize& size, const Sample& home) {
  const double r = size.platform_radius;
  const auto row = [&](const char* name, double derived, double ours, const char* unit) {
    findings.push_back(compare::claimed(fmt::format("{} = {:.6f}", name, derived), "not printed",
                                        fmt::format("{:.6f}{}", ours, unit), off_by(ours, derived) / derived,
                                        1e-14, "relative"));
  };
  // A strut's row is (s, r × s) with r in the same plane as s: |r × s| is r times the strut's rise at home.
  const double f = r - size.base_radius, rise = std::sqrt((size.strut_length - f) * (size.strut_length + f));
  const double struts = size.strut_length * size.strut_length + r * r * rise * rise, planes = 1 + r * r;
  row("‖J_FK‖_F at home, derived √(3 (L² + r² d² + 1 + r²))", std::sqrt(3 * (struts + planes)),
      home.forward_norm, "");
  row("‖U_p‖ at home, derived 1/√3", 1 / std::numbers::sqrt3, home.position, " m/m");
  row("‖U_r‖ at home, derived √(2/3)/r", std::sqrt(2.0 / 3) / r, home.rotation, " rad/m");
}

Finding range(const char* name, double Sample::*value, const char* unit, const Samples& all) {
  const Sample *least = nullptr, *most = nullptr;
  for (const Sample& s : all) {
    if (std::isnan(s.*value)) continue;
    if (!least || s.*value < least->*value) least = &s;
    if (!most || s.*value > most->*value) most = &s;
  }
  if (!most) return {name, "drawn; numbers not printed", "none", "", "fails"};
  return {fmt::format("{} on the grid", name), "drawn; numbers not printed",
          fmt::format("{:.4g}{} at ({:g}, {:g}) to {:.4g}{} at ({:g}, {:g})", least->*value, unit, least->e1,
                      least->e2, most->*value, unit, most->e1, most->e2),
          "", "for information"};
}

/// The same place looked at from a little inside and a little beyond the forward locus.
Finding blind_norm(const Robot& robot, const TripodSize& size, Workspace& work) {
  double least = 1e9, most = 0;
  for (int k = 0; k < 24; ++k) {
    const double direction = (15 * k + 7) * pi / 180;
    const auto edge = forward_locus(size, direction);
    if (!edge) continue;
    const Sample on = tripod::sample(
        robot, {tripod::height, *edge * std::cos(direction), *edge * std::sin(direction)}, work);
    least = std::min(least, on.forward_norm);
    most = std::max(most, on.forward_norm);
  }
  return {"‖J_FK‖_F on the FK locus", "not stated",
          fmt::format("{:.4f} to {:.4f}: nothing to see", least, most), "", "for information"};
}

/// Near a simple zero of the determinant a norm of U grows as 1/distance: ten times nearer, ten times larger.
Finding growth(const char* name, double Sample::*value, const char* unit, const Robot& robot,
               const TripodSize& size, Workspace& work) {
  double off = 0, least = 1e300;
  for (int k = 0; k < 24; ++k) {
    const double direction = (15 * k + 7) * pi / 180;
    const auto edge = forward_locus(size, direction);
    if (!edge) continue;
    const auto at = [&](double distance) {
      const double rho = *edge - distance;
      return tripod::sample(robot, {tripod::height, rho * std::cos(direction), rho * std::sin(direction)},
                            work).*
             value;
    };
    const double here = std::abs(at(1e-7) / at(1e-6) / 10 - 1);
    off = here <= off ? off : here;
    least = std::min(least, at(1e-7));
  }
  return compare::claimed(fmt::format("{} on the FK locus, derived ∞ as 1/distance", name), "not stated",
                          fmt::format("at least {:.1e} {}, 1e-7 inside", least, unit), off, 2e-4,
                          "of ten times that 1e-6 inside");
}

Finding height(const Robot& robot, const Samples& all, double home_determinant, Workspace& work) {
  const double change = tripod::change_with_height(
      robot, all,
      [&](const Sample& a, const Sample& b) {
        return std::max(off_by(a.forward_norm, b.forward_norm),
                        off_by(a.determinant, b.determinant) / home_determinant);
      },
      work);
  return compare::claimed("‖J_FK‖_F and det, the same at every height", "drawn over e_1, e_2 only",
                          fmt::format("z = {} m and {} m", tripod::height, tripod::other_height), change,
                          1e-13, "relative to home");
}

/// A pose turned by 120° or mirrored is the same robot with its legs renamed.
Finding symmetry(const Robot& robot, Workspace& work) {
  const double c = std::cos(2 * pi / 3), s = std::sin(2 * pi / 3);
  double off = 0;
  int count = 0;
  for (const double rho : {0.15, 0.3, 0.44, 0.7})
    for (int k = 0; k < 24; ++k, ++count) {
      const double e1 = rho * std::cos(k * pi / 12 + 0.1), e2 = rho * std::sin(k * pi / 12 + 0.1);
      const Sample here = tripod::sample(robot, {tripod::height, e1, e2}, work);
      for (const Sample& image :
           {tripod::sample(robot, {tripod::height, e1, -e2}, work),
            tripod::sample(robot, {tripod::height, c * e1 - s * e2, s * e1 + c * e2}, work)})
        for (const auto value : {&Sample::forward_norm, &Sample::position, &Sample::rotation}) {
          const double differs = std::abs(image.*value / here.*value - 1);
          off = differs <= off ? off : differs;
        }
    }
  return compare::claimed("three-fold symmetry with mirrors", "drawn, not stated",
                          fmt::format("{} places, each turned and mirrored", count), off, 1e-11, "relative");
}

Panel panel(const TripodSize& size, const Samples& all, double Sample::*value, std::string title, double low,
            double high, bool log, const std::vector<contour::Levels>& levels) {
  std::vector<double> values;
  for (const Sample& s : all) values.push_back(s.*value);
  HeatMap map = tripod::map_of(std::move(values), "");
  map.low = low;
  map.high = high;
  map.log = log;
  return tripod::map_panel(size, std::move(title), std::move(map), levels);
}

Figure forward_figure(const TripodSize& size, const Samples& all) {
  return {.title = "",
          .panels = {panel(size, all, &Sample::forward_norm, "‖J_FK‖, Frobenius [SI]", 1.844, 1.8495, false,
                           {{{1.847, 1.849}, {90}}, {{1.845, 1.846, 1.848}, {}}}),
                     panel(size, all, &Sample::position, "‖Uₚ‖ [m/m]", 0.5, 20, true,
                           {{{0.6, 1, 2}, {0}}, {{5, 10}, {}}}),
                     panel(size, all, &Sample::rotation, "‖Uᵣ‖ [rad/m]", 5, 200, true,
                           {{{7, 10, 20}, {0}}, {{5, 50, 100}, {}}})},
          .columns = 3,
          .width = 1500,
          .height = 480,
          .comments = compare::provenance("3pfs/fig7", "Fig. 7", tripod::as_printed)};
}

}  // namespace

Expected<ItemResult> tripod_fig7(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3prs");
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  const TripodSize size = tripod::size_of(*robot);
  const Samples all = tripod::samples(*robot, work);
  const Sample home = tripod::sample(*robot, {tripod::height, 0, 0}, work);

  ItemResult result;
  std::vector<Finding>& findings = result.findings;
  findings.push_back({"norm of the FK Jacobian, (17)", "not defined; numbers not printed",
                      "Frobenius of the left matrix; 2-norms of the blocks of U = J_FK⁻¹ (J_IK; 0)", "",
                      "for information"});
  add_home(findings, size, home);
  findings.push_back(range("‖J_FK‖_F", &Sample::forward_norm, "", all));
  findings.push_back(range("‖U_p‖", &Sample::position, " m/m", all));
  findings.push_back(range("‖U_r‖", &Sample::rotation, " rad/m", all));
  findings.push_back(blind_norm(*robot, size, work));
  findings.push_back(growth("‖U_p‖", &Sample::position, "m/m", *robot, size, work));
  findings.push_back(growth("‖U_r‖", &Sample::rotation, "rad/m", *robot, size, work));
  findings.push_back(height(*robot, all, home.determinant, work));
  findings.push_back(symmetry(*robot, work));

  result.tables.emplace_back("fig7", forward_table(all));
  result.figures.emplace_back("fig7", forward_figure(size, all));
  return result;
}

}  // namespace sinew::inline v1
