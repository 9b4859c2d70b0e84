/// 250 shapes each of a steel rod and one of TPU under gravity and wrenches, by another code: data/rods/.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/io/table.hpp"
#include "study/builtin.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/truth/cantilever.hpp"

namespace sinew::inline v1 {
namespace {

struct Rod {
  const char *name, *file;
  double young, poisson, density, radius, length;
  Colour colour;
};
constexpr std::array rods{Rod{"steel", "rods/steel.csv", 2e11, 0.33, 7870, 0.0008, 0.6, Colour::blue},
                          Rod{"TPU", "rods/tpu.csv", 7e7, 0.4, 1200, 0.005, 0.4, Colour::vermillion}};

/// Distances of a shape from the other code's [m]; NaN: no equilibrium was found.
struct ShapeError {
  double middle = std::numeric_limits<double>::quiet_NaN(), tip = middle;
  double larger() const { return std::max(middle, tip); }
};

std::array<double, 3> three(const Table& table, std::string_view first, std::size_t row) {
  const Column* column = table.find(first);
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) values[i] = (column + i)->values[row];
  return values;
}

/// Their rod lies along x, ours along z: x → z, y → y, z → −x.
std::array<double, 3> turned(const std::array<double, 3>& v) { return {-v[2], v[1], v[0]}; }

std::array<double, 6> wrench(const Table& table, const std::string& at, std::size_t row) {
  const auto force = turned(three(table, at + "_fx", row)), moment = turned(three(table, at + "_mx", row));
  return {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
}

std::vector<ShapeError> errors_of(const Rod& rod, const Table& table) {
  const Material material{rod.young, rod.young / 2 / (1 + rod.poisson), rod.density};
  const Arm arm = cantilever(rod.length, round_section(material, 2 * rod.radius));
  std::vector<ShapeError> errors;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    ArmLoad load{.wrench = wrench(table, "tip", row)};
    load.gravity = turned(three(table, "gravity_x", row));
    load.points = {PointLoad{.place = rod.length / 2, .wrench = wrench(table, "middle", row)}};
    ArmWorkspace work(arm);
    ShapeError& error = errors.emplace_back();
    if (!arm_forward(arm, {}, load, {.model = ArmModel::rod}, work).report.ok()) continue;
    const auto frames = arm_frames(arm, std::array{rod.length / 2, rod.length}, work);
    const auto distance = [&](const SE3<double>& frame, std::string_view first) {
      const auto there = turned(three(table, first, row));
      return (frame.p - Vec3<double>(there[0], there[1], there[2])).norm();
    };
    error = {distance(frames[0], "middle_x"), distance(frames[1], "tip_x")};
  }
  return errors;
}

/// Shares of the shapes that are nearer than a distance.
Series shares(const Rod& rod, std::vector<double> errors) {
  Series series{.label = rod.name, .x = {}, .y = {}, .colour = rod.colour};
  std::ranges::sort(errors);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    series.x.push_back(1e3 * errors[k]);
    series.y.push_back(100 * static_cast<double>(k + 1) / static_cast<double>(errors.size()));
  }
  return series;
}

}  // namespace

Expected<ItemResult> truth_rods(const StudyItem& item, const std::filesystem::path&) {
  ItemResult result;
  const std::vector<std::string> comments =
      compare::provenance(item.id, "rods under gravity and wrenches beside SoroSim's",
                          "data: ContinuumRoboticsLab/opencr-mujoco (MIT)");
  Panel panel{.title = "",
              .x = {.label = "distance of middle or tip, whichever is larger", .unit = "mm", .low = 0},
              .y = {.label = "shapes that are nearer", .unit = "%", .low = 0, .high = 100},
              .series = {},
              .legend = Legend::bottom_right};
  Table out{"rod", "row", "middle[m]", "tip[m]"};
  out.comments = comments;
  out.comments.push_back("rod 0: steel, 1: TPU");
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const Rod& rod = rods[r];
    const auto table = parse_csv(builtin_data(rod.file), rod.file);
    if (!table) return tl::unexpected(table.error());
    const std::vector<ShapeError> errors = errors_of(rod, *table);
    std::vector<double> larger;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      out.add_row(
          std::array{static_cast<double>(r), static_cast<double>(k), errors[k].middle, errors[k].tip});
      if (std::isfinite(errors[k].tip)) larger.push_back(errors[k].larger());
    }
    panel.series.push_back(shares(rod, larger));
    std::ranges::sort(larger);
    const std::string name = fmt::format("{} shapes of {}", errors.size(), rod.name);
    const auto failed = errors.size() - larger.size();
    result.findings.push_back(compare::within(name + ": equilibria found", fmt::format("{}", errors.size()),
                                              fmt::format("{}", larger.size()), static_cast<double>(failed),
                                              0, ""));
    if (larger.empty()) continue;
    const auto judged = [&](const char* which, double error, double bound) {
      result.findings.push_back(compare::within(name + ", " + which, "rounded to 0.1 mm",
                                                fmt::format("{:.3f} mm", 1e3 * error), error, bound, "m"));
    };
    judged("median of the larger distance of middle and tip", larger[larger.size() / 2], 0.15e-3);
    judged("its maximum", larger.back(), 0.6e-3);
  }
  result.tables.emplace_back("rods", out);
  result.figures.emplace_back(
      "rods", Figure{.title = "Rods under gravity and two wrenches beside SoroSim's shapes",
                     .panels = {std::move(panel)},
                     .comments = comments,
                     .remark = "their places are rounded to 0.1 mm, their moments to 0.1 N mm"});
  return result;
}

}  // namespace sinew::inline v1
