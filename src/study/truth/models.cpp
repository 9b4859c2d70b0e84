/// Five ways to take an arm's strain: how far their tips are from the finest of them over tensions, loads and
/// discs (studies/serial-models.yaml), and what each costs. Theory: docs/theory/arm_models.md
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kinematics/arm.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/swept.hpp"

namespace sinew::inline v1 {
namespace {

struct ModelOf {
  ArmModel model;
  const char* name;
  Colour colour;
};
/// In the order of the study; the first is what the others are measured by.
constexpr std::array models{ModelOf{ArmModel::subsegment_rod, "subsegment_rod", Colour::black},
                            ModelOf{ArmModel::rod, "rod", Colour::blue},
                            ModelOf{ArmModel::subsegment_cc, "subsegment_cc", Colour::green},
                            ModelOf{ArmModel::cc, "cc", Colour::vermillion},
                            ModelOf{ArmModel::prb, "prb", Colour::orange}};

/// Distances of tips over the arm's length, at one number of discs.
struct Distances {
  std::vector<double> discs;
  std::vector<double> rms, most;  ///< [1]
};

std::vector<Distances> distances_of(const tripod::Swept& study, double length) {
  std::vector<Distances> all(models.size());
  const auto &x = study["x"], &y = study["y"], &z = study["z"], &discs = study["discs"];
  for (std::size_t row = 0; row + models.size() <= study.size(); row += models.size())
    for (std::size_t m = 0; m < models.size(); ++m) {
      Distances& of = all[m];
      if (of.discs.empty() || of.discs.back() != discs[row]) {
        of.discs.push_back(discs[row]);
        of.rms.push_back(0), of.most.push_back(0);
      }
      const double off = std::hypot(x[row + m] - x[row], y[row + m] - y[row], z[row + m] - z[row]) / length;
      of.rms.back() += off * off;
      of.most.back() = std::max(of.most.back(), off);
    }
  for (Distances& of : all) {
    const double samples = static_cast<double>(study.size()) /
                           static_cast<double>(models.size() * std::max<std::size_t>(of.discs.size(), 1));
    for (double& sum : of.rms) sum = std::sqrt(sum / samples);
  }
  return all;
}

/// Of one equilibrium close to the last one [s]: the median of many, tensions a per cent apart.
double cost_of(const Arm& arm, ArmModel model) {
  ArmWorkspace work(arm);
  std::vector<TendonCommand> commands(arm.tendons.size());
  std::vector<double> times;
  for (int k = 0; k < 60; ++k) {
    for (std::size_t i = 0; i < commands.size(); ++i)
      commands[i] = {TendonHeld::tension, (i == 0   ? 3.0
                                           : i == 4 ? 1.5
                                                    : 0.2) *
                                              (1 + 0.005 * std::sin(0.7 * k + static_cast<double>(i)))};
    const auto begin = std::chrono::steady_clock::now();
    const ArmState& state =
        arm_forward(arm, commands, {.wrench = {0.1}}, {.model = model, .from_last = k > 0}, work);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    if (k >= 10 && state.report.ok()) times.push_back(took.count());
  }
  if (times.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(times);
  return times[times.size() / 2];
}

Arm with_discs(Arm arm, double count) {
  for (ArmSection& section : arm.sections) section.discs.count = static_cast<int>(count);
  return arm;
}

Series curve(const ModelOf& model, const std::vector<double>& x, std::vector<double> y, double factor) {
  for (double& value : y) value *= factor;
  return {.label = model.name, .x = x, .y = std::move(y), .mark = Mark::line_points, .colour = model.colour};
}

}  // namespace

Expected<ItemResult> truth_models(const StudyItem& item, const std::filesystem::path& folder) {
  const auto study = tripod::swept("serial-models", folder);
  if (!study) return tl::unexpected(study.error());
  const auto robot = load("two-segment");
  if (!robot) return tl::unexpected(robot.error());
  const Arm& arm = *robot->arm();
  ItemResult result{{}, {study->file}, {}, {}};
  result.findings.push_back(compare::claimed("equilibria found", fmt::format("all {}", study->size()),
                                             fmt::format("{}", study->converged()),
                                             static_cast<double>(study->size() - study->converged()), 0, ""));
  const auto comments = compare::provenance(item.id, "five models of the backbone of one arm", "two-segment");
  const std::vector<Distances> distances = distances_of(*study, arm.length());
  Table table{"model", "discs", "rms_distance", "largest_distance", "warm_solve[s]"};
  table.comments = comments;
  table.comments.push_back(
      "distances of the tip from that by subsegment_rod, over the arm's length; times of this run");
  table.comments.push_back("model: 0 subsegment_rod, 1 rod, 2 subsegment_cc, 3 cc, 4 prb");
  Panel accuracy{.title = "distance of the tip from subsegment_rod",
                 .x = {.label = "discs of a section", .unit = "", .log = true, .low = 4, .high = 50},
                 .y = {.label = "of the arm's length, rms", .unit = "%", .log = true},
                 .series = {},
                 .legend = Legend::below},
      cost{.title = "one equilibrium, warm, in this run",
           .x = accuracy.x,
           .y = {.label = "time", .unit = "µs", .log = true},
           .series = {},
           .legend = Legend::below};
  for (std::size_t m = 0; m < models.size(); ++m) {
    const Distances& of = distances[m];
    std::vector<double> times;
    for (std::size_t d = 0; d < of.discs.size(); ++d) {
      times.push_back(cost_of(with_discs(arm, of.discs[d]), models[m].model));
      table.add_row(std::array{static_cast<double>(m), of.discs[d], of.rms[d], of.most[d], times.back()});
      if (of.discs[d] != 10) continue;
      result.findings.push_back(
          {fmt::format("{}, ten discs: distance of the tip over the length, rms and largest", models[m].name),
           "by subsegment_rod", fmt::format("{:.2g} % and {:.2g} %", 100 * of.rms[d], 100 * of.most[d]),
           fmt::format("{:.0f} µs warm", 1e6 * times.back()), "for information"});
    }
    if (m > 0) accuracy.series.push_back(curve(models[m], of.discs, of.rms, 100));
    cost.series.push_back(curve(models[m], of.discs, times, 1e6));
  }
  result.tables.emplace_back("models", table);
  result.figures.emplace_back("models",
                              Figure{.title = "An arm of two sections by five models of its backbone",
                                     .panels = {std::move(accuracy), std::move(cost)},
                                     .columns = 2,
                                     .width = 1200,
                                     .height = 560,
                                     .comments = comments});
  return result;
}

}  // namespace sinew::inline v1
