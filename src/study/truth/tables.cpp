/// Rods whose shapes are published: a cantilever under a tip force, under a load along it that keeps its
/// direction or follows, and a bend of 45 degrees bent out of its plane. Theory: docs/theory/strain_rod.md
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/truth/cantilever.hpp"

namespace sinew::inline v1 {
namespace {

/// EI = 1, L = 1, neither stretch nor shear: the elastica.
Arm unit_cantilever() {
  CrossSection section;
  section.bending_x = section.bending_y = section.torsion = 1;
  return cantilever(1, section);
}

/// Bathe and Bolourchi's: radius 100, a square of side 1, E = 1e7, Poisson's ratio 0.
Arm bend_of_45_degrees() {
  constexpr double E = 1e7, G = E / 2;
  Arm arm = cantilever(100 * std::numbers::pi / 4, {E / 12, E / 12, G / 6, E, G * 5 / 6, 0});
  arm.sections[0].curvature = {0, 0.01, 0};  // from z towards x
  return arm;
}

std::string with_unit(double value, const char* unit) {
  return fmt::format("{:.8f}{}{}", value, *unit ? " " : "", unit);
}

/// A tip's number beside the table's, which has so many digits.
class Compared {
 public:
  explicit Compared(ItemResult& result) : result_(result) {}
  void number(const std::string& what, double table, double ours, double tolerance, const char* unit = "") {
    result_.findings.push_back(compare::within(what, with_unit(table, unit), with_unit(ours, unit),
                                               std::abs(ours - table), tolerance, unit));
  }
  void failed(const std::string& what, const ArmState& state) {
    result_.findings.push_back({what, "", to_string(state.report), "", "fails"});
  }

 private:
  ItemResult& result_;
};

ArmState solve(const Arm& arm, const ArmLoad& load) {
  ArmWorkspace work(arm);
  return arm_forward(arm, {}, load, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
}

void tip_force(Compared& compared) {
  constexpr double table[][4] = {{1, 0.46135195, 0.30172077, 0.05643324},
                                 {5, 1.21536812, 0.71379152, 0.38762836}};
  const Arm arm = unit_cantilever();
  for (const auto& [size, slope, deflection, shortening] : table) {
    const std::string name = fmt::format("tip force F L²/EI = {:.0f}", size);
    const ArmState state = solve(arm, {.wrench = {size}});
    if (!state.report.ok()) {
      compared.failed(name, state);
      continue;
    }
    compared.number(name + ": slope of the tip", slope, state.tip.R.log().norm(), 1e-7, "rad");
    compared.number(name + ": deflection / L", deflection, state.tip.p.x(), 1e-7);
    compared.number(name + ": shortening / L", shortening, 1 - state.tip.p.z(), 1e-7);
  }
}

void uniform_load(Compared& compared) {
  const Arm arm = unit_cantilever();
  const auto check = [&](const char* name, const ArmLoad& load, double along, double across) {
    const ArmState state = solve(arm, load);
    if (!state.report.ok()) return compared.failed(name, state);
    compared.number(std::string(name) + ": tip along / L", along, state.tip.p.z(), 1e-5);
    compared.number(std::string(name) + ": tip across / L", across, state.tip.p.x(), 1e-5);
  };
  check("load along it, q L³/EI = 5", {.along = {5}}, 0.84666, 0.49591);
  check("load that follows, q L³/EI = 5", {.following_along = {5}}, 0.79552, 0.56042);
}

void bend(Compared& compared) {
  const ArmState state = solve(bend_of_45_degrees(), {.wrench = {0, 300}});
  if (!state.report.ok()) return compared.failed("bend of 45°", state);
  compared.number("bend of 45° under 300 out of its plane: along", 58.778897, state.tip.p.z(), 1e-5);
  compared.number("the same: in its plane", 22.244679, state.tip.p.x(), 1e-5);
  compared.number("the same: out of its plane", 40.192392, state.tip.p.y(), 1e-5);
}

Series points_of(const char* label, std::vector<double> x, std::vector<double> y, Colour colour) {
  return {.label = label,
          .x = std::move(x),
          .y = std::move(y),
          .mark = Mark::circles,
          .colour = colour,
          .width = 4};
}

/// What the tip does while the force grows, and what the table has.
Panel tip_panel(Table& table) {
  Panel panel{.title = "cantilever under a tip force",
              .x = {.label = "F L²/EI", .unit = ""},
              .y = {.label = "tip", .unit = "", .low = 0, .high = 2},
              .series = {}};
  const Arm arm = unit_cantilever();
  ArmWorkspace work(arm);
  Series slope{.label = "slope (rad)", .x = {}, .y = {}, .colour = Colour::blue},
      deflection{.label = "deflection / L", .x = {}, .y = {}, .colour = Colour::vermillion},
      shortening{.label = "shortening / L", .x = {}, .y = {}, .colour = Colour::green};
  for (int k = 0; k <= 40; ++k) {
    const double size = 0.25 * k;
    const ArmState& state =
        arm_forward(arm, {}, {.wrench = {size}}, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
    if (!state.report.ok()) continue;
    const std::array row{size, state.tip.R.log().norm(), state.tip.p.x(), 1 - state.tip.p.z()};
    table.add_row(row);
    for (Series* series : {&slope, &deflection, &shortening}) series->x.push_back(size);
    slope.y.push_back(row[1]), deflection.y.push_back(row[2]), shortening.y.push_back(row[3]);
  }
  panel.series = {
      slope, deflection, shortening,
      points_of("table", {1, 5, 1, 5, 1, 5},
                {0.46135195, 1.21536812, 0.30172077, 0.71379152, 0.05643324, 0.38762836}, Colour::black)};
  return panel;
}

Series shape_of(const char* label, const Arm& arm, const ArmLoad& load, Mark mark, Colour colour) {
  Series series{.label = label, .x = {}, .y = {}, .mark = mark, .colour = colour};
  ArmWorkspace work(arm);
  if (!arm_forward(arm, {}, load, {.model = ArmModel::rod}, work).report.ok()) return series;
  std::vector<double> places;
  for (int k = 0; k <= 60; ++k) places.push_back(arm.length() * k / 60);
  for (const SE3<double>& frame : arm_frames(arm, places, work)) {
    series.x.push_back(frame.p.z());
    series.y.push_back(frame.p.x());
  }
  return series;
}

Panel shapes_panel() {
  const Arm arm = unit_cantilever();
  return {
      .title = "loads along it, q L³/EI = 5",
      .x = {.label = "along / L", .unit = "", .low = 0},
      .y = {.label = "across / L", .unit = "", .low = 0, .high = 0.8},
      .series = {shape_of("keeps its direction", arm, {.along = {5}}, Mark::line, Colour::blue),
                 shape_of("follows", arm, {.following_along = {5}}, Mark::line, Colour::vermillion),
                 points_of("tips of the tables", {0.84666, 0.79552}, {0.49591, 0.56042}, Colour::black)},
  };
}

Panel bend_panel() {
  Panel panel{.title = "bend of 45° under a force out of its plane",
              .x = {.label = "force", .unit = ""},
              .y = {.label = "place of the tip", .unit = "", .low = 0, .high = 110},
              .series = {}};
  const Arm arm = bend_of_45_degrees();
  ArmWorkspace work(arm);
  Series along{.label = "along", .x = {}, .y = {}, .colour = Colour::blue},
      in{.label = "in its plane", .x = {}, .y = {}, .colour = Colour::green},
      out{.label = "out of its plane", .x = {}, .y = {}, .colour = Colour::vermillion};
  for (int k = 0; k <= 30; ++k) {
    const double size = 20 * k;
    const ArmState& state =
        arm_forward(arm, {}, {.wrench = {0, size}}, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
    if (!state.report.ok()) continue;
    for (Series* series : {&along, &in, &out}) series->x.push_back(size);
    along.y.push_back(state.tip.p.z()), in.y.push_back(state.tip.p.x()), out.y.push_back(state.tip.p.y());
  }
  panel.series = {along, in, out,
                  points_of("table", {300, 300, 300}, {58.778897, 22.244679, 40.192392}, Colour::black)};
  panel.legend = Legend::top_right;
  return panel;
}

}  // namespace

Expected<ItemResult> truth_tables(const StudyItem& item, const std::filesystem::path&) {
  ItemResult result;
  Compared compared(result);
  tip_force(compared);
  uniform_load(compared);
  bend(compared);
  Table table{"force", "slope[rad]", "deflection", "shortening"};
  const std::vector<std::string> comments = compare::provenance(item.id, "rods whose shapes are published",
                                                                "EI = L = 1; bend: radius 100, E = 1e7");
  table.comments = comments;
  Panel tips = tip_panel(table);
  result.tables.emplace_back("tables", table);
  result.figures.emplace_back("tables",
                              Figure{.title = "Rods whose shapes are published: tables beside the strain rod",
                                     .panels = {std::move(tips), shapes_panel(), bend_panel()},
                                     .columns = 3,
                                     .width = 1500,
                                     .height = 520,
                                     .comments = comments});
  return result;
}

}  // namespace sinew::inline v1
