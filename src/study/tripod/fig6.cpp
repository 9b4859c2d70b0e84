/// 3PFS Fig. 6: "IK Jacobians' norm" over the tilts of the 3PRS. The paper prints neither a definition nor a
/// number; of (18) there are the Frobenius norm, the 2-norm, and how far it is from being singular.
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

Table index_table(const Samples& all) {
  Table table{"e1", "e2", "rise_1[m]", "rise_2[m]", "rise_3[m]", "frobenius[m]", "largest[m]", "smallest[m]"};
  table.comments = compare::provenance("3pfs/fig6", "J_IK, eq. (18), over the tilts inside the loci (19)",
                                       tripod::as_printed);
  table.comments.push_back(
      "rise_i: (b_i - c_i).k, the diagonal; largest: 2-norm; smallest: 1/2-norm of the inverse");
  for (const Sample& s : all)
    if (s.is_reached())
      table.add_row(
          {s.e1, s.e2, s.rises[0], s.rises[1], s.rises[2], s.frobenius(), s.largest(), s.smallest()});
  return table;
}

/// The largest over the reached places; NaN stays.
template <class F>
double worst(const Samples& all, const F& off) {
  double most = 0;
  for (const Sample& s : all) {
    if (!s.is_reached()) continue;
    const double here = std::abs(off(s));
    most = here <= most ? most : here;
  }
  return most;
}

/// ‖J_IK‖_F by hand: what is left of the three squares when (19) is put in is a function of ρ² = e₁² + e₂².
double frobenius_derived(const TripodSize& size, double e1, double e2) {
  const double r = size.platform_radius, square = e1 * e1 + e2 * e2;
  const double mean = r * (1 - square) - size.base_radius;
  return std::sqrt(3 * (size.strut_length - mean) * (size.strut_length + mean) - 6 * r * r * square * square);
}

void add_definition(std::vector<Finding>& findings, const TripodSize& size, const Samples& all) {
  const auto count = std::ranges::count_if(all, &Sample::is_reached);
  findings.push_back({"norm of J_IK, (18)", "not defined; numbers not printed",
                      "Frobenius, 2-norm, 1/‖J_IK⁻¹‖; all in m", "", "for information"});
  findings.push_back(
      compare::claimed("(b_i − c_i)·k, derived √(L² − (r q_i − r_A)²), q_i the left sides of (19)",
                       "not printed", fmt::format("K of {} poses", count),
                       worst(all,
                             [&](const Sample& s) {
                               const auto left = radial_positions(s.e1, s.e2);
                               double off = 0;
                               for (std::size_t i = 0; i < 3; ++i) {
                                 const double f = left[i] * size.platform_radius - size.base_radius;
                                 const double L = size.strut_length;
                                 off = std::max(off, std::abs(s.rises[i] * s.rises[i] - (L - f) * (L + f)));
                               }
                               return off;
                             }),
                       1e-15, "m² of the squares"));
}

Finding range(const char* name, double (Sample::*value)() const, const Samples& all) {
  const Sample *least = nullptr, *most = nullptr;
  for (const Sample& s : all) {
    if (!s.is_reached()) continue;
    if (!least || (s.*value)() < (least->*value)()) least = &s;
    if (!most || (s.*value)() > (most->*value)()) most = &s;
  }
  if (!most) return {name, "drawn; numbers not printed", "none", "", "fails"};
  return {name, "drawn; numbers not printed",
          fmt::format("{:.4g} m at ({:g}, {:g}) to {:.4g} m at ({:g}, {:g})", (least->*value)(), least->e1,
                      least->e2, (most->*value)(), most->e1, most->e2),
          "", "for information"};
}

/// A strut near its locus is √(2 L f′ δ) high: halving the distance δ divides it by √2.
Finding vanishing(const Robot& robot, const TripodSize& size, Workspace& work) {
  double most = 0, ratio = 0;
  for (int k = 0; k < 36; ++k) {
    const double direction = (10 * k + 2) * pi / 180, edge = tripod::inverse_radius(size, direction);
    const auto at = [&](double inside) {
      const double rho = edge * (1 - inside);
      return tripod::sample(robot, {tripod::height, rho * std::cos(direction), rho * std::sin(direction)},
                            work)
          .smallest();
    };
    const double off = std::abs(at(1e-8) / at(4e-8) - 0.5);
    ratio = off <= ratio ? ratio : off;
    most = at(1e-8) <= most ? most : at(1e-8);
  }
  return compare::claimed("1/‖J_IK⁻¹‖ on the loci (19), derived 0 as the root of the distance", "singular",
                          fmt::format("{:.1e} m at most, 1e-8 inside; half of what it is 4e-8 inside", most),
                          ratio, 1e-6, "of the ratio");
}

void add_values(std::vector<Finding>& findings, const Robot& robot, const TripodSize& size,
                const Samples& all, Workspace& work) {
  const Sample home = tripod::sample(robot, {tripod::height, 0, 0}, work);
  const double f = size.base_radius - size.platform_radius, L = size.strut_length;
  const double derived = std::sqrt((L - f) * (L + f));
  findings.push_back(compare::claimed(
      fmt::format("‖J_IK‖₂ at home, derived √(L² − (r_A − r)²) = {:.6f} m", derived), "not printed",
      fmt::format("{:.6f} m", home.largest()), std::abs(home.largest() - derived), 1e-15, "m"));
  findings.push_back(range("‖J_IK‖_F", &Sample::frobenius, all));
  const double least = worst(all, [&](const Sample& s) { return std::max(0.0, derived - s.largest()); });
  findings.push_back(compare::claimed(
      "‖J_IK‖₂ nowhere less: two struts keep it on the three axes of symmetry, derived", "not printed",
      fmt::format("up to {:.4g} m", worst(all, [](const Sample& s) { return s.largest(); })), least, 1e-15,
      "m"));
  findings.push_back(range("1/‖J_IK⁻¹‖₂", &Sample::smallest, all));
  findings.push_back(compare::claimed(
      "‖J_IK‖_F, derived √(3L² − 3(r(1 − ρ²) − r_A)² − 6r²ρ⁴): a function of the tilt alone, blind to (19)",
      "not stated", "everywhere on the grid",
      worst(all, [&](const Sample& s) { return s.frobenius() - frobenius_derived(size, s.e1, s.e2); }), 1e-14,
      "m"));
  findings.push_back(vanishing(robot, size, work));
  // the squares: the root itself takes half the digits where a strut is nearly level
  const double change = tripod::change_with_height(
      robot, all,
      [](const Sample& a, const Sample& b) {
        double off = 0;
        for (std::size_t i = 0; i < 3; ++i)
          off = std::max(off, std::abs(a.rises[i] * a.rises[i] - b.rises[i] * b.rises[i]));
        return off;
      },
      work);
  findings.push_back(compare::claimed("the same at every height", "drawn over e_1, e_2 only",
                                      fmt::format("z = {} m and {} m", tripod::height, tripod::other_height),
                                      change, 1e-15, "m² of the squares"));
}

Panel panel(const TripodSize& size, const Samples& all, double (Sample::*value)() const, std::string title,
            double low, double high, const std::vector<contour::Levels>& levels) {
  std::vector<double> values;
  for (const Sample& s : all) values.push_back((s.*value)());
  HeatMap map = tripod::map_of(std::move(values), "");
  map.low = low;
  map.high = high;
  return tripod::map_panel(size, std::move(title), std::move(map), levels);
}

Figure index_figure(const TripodSize& size, const Samples& all) {
  return {.title = "",
          .panels = {panel(size, all, &Sample::frobenius, "‖J_IK‖, Frobenius [m]", 0.35, 0.57,
                           {{{0.45, 0.55}, {90}}, {{0.5}, {150}}, {{0.4}, {}}}),
                     panel(size, all, &Sample::largest, "‖J_IK‖₂: the largest of its diagonal [m]", 0.325,
                           0.35, {{{0.335, 0.345}, {90}}, {{0.33}, {30}}, {{0.34}, {}}}),
                     panel(size, all, &Sample::smallest, "1/‖J_IK⁻¹‖₂: the smallest of its diagonal [m]", 0,
                           0.33, {{{0.2, 0.3}, {90}}, {{0.25}, {150}}, {{0.1, 0.15}, {}}})},
          .columns = 3,
          .width = 1500,
          .height = 480,
          .comments = compare::provenance("3pfs/fig6", "Fig. 6", tripod::as_printed)};
}

}  // namespace

Expected<ItemResult> tripod_fig6(const StudyItem&, const std::filesystem::path&) {
  const auto robot = load("3prs");
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  const TripodSize size = tripod::size_of(*robot);
  const Samples all = tripod::samples(*robot, work);

  ItemResult result;
  add_definition(result.findings, size, all);
  add_values(result.findings, *robot, size, all, work);

  result.tables.emplace_back("fig6", index_table(all));
  result.figures.emplace_back("fig6", index_figure(size, all));
  return result;
}

}  // namespace sinew::inline v1
