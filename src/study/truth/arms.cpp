/// Two measured arms: data/measured/. Theory: docs/theory/identification.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/analysis/identify.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/builtin.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"

namespace sinew::inline v1 {
namespace {

/// A recording and how near its fit has to come.
struct Recording {
  const char* name;
  double tolerance;  ///< of the fit's root mean square [m]
  double floor;      ///< what no map of inputs explains: equal commands half a minute apart [m]
};
constexpr std::array recordings{Recording{"ftdcr-v4", 4e-3, 3.0e-3}, Recording{"ftdcr-v6", 7e-3, 5.1e-3}};

/// What such rows can tell: the numbers of docs/theory/identification.md.
constexpr const char* names =
    "sections.bending,sections.angle,sections.compliance,sections.curvature,tendons.offset,tendons.toe,"
    "gravity,marker,base,tilt.x,tilt.y,lag";

struct Judged {
  MeasuredRows rows;
  std::vector<bool> single;      ///< rows of one tendon drawn in, the others paid out
  std::vector<double> computed;  ///< rows × 3 [m]
  Identified fit;
  HeldOut held_out;
  MarkerErrors unseen_pulls;  ///< single pulls, of a fit that has seen none
};

/// By the labels of the recording's blocks: comments `block 4: rep1_tendon4_id2_pull`.
std::vector<bool> single_pulls(const Table& table, const MeasuredRows& rows) {
  std::vector<bool> blocks, of_rows;
  for (const std::string& comment : table.comments)
    if (comment.starts_with("block ")) blocks.push_back(comment.ends_with("_pull"));
  for (const int block : rows.blocks) {
    const auto k = static_cast<std::size_t>(block);
    of_rows.push_back(k < blocks.size() && blocks[k]);
  }
  return of_rows;
}

Expected<Judged> judge(const Recording& recording) {
  const std::string file = std::string("measured/") + recording.name + ".csv";
  const auto robot = load(recording.name);
  if (!robot) return tl::unexpected(robot.error());
  const MeasuredArm start = measured(*robot->arm());
  const auto table = parse_csv(builtin_data(file), file);
  if (!table) return tl::unexpected(table.error());
  auto rows = read_measured_rows(*table, start.arm, file);
  if (!rows) return tl::unexpected(rows.error());
  Judged judged;
  judged.rows = std::move(*rows);
  judged.single = single_pulls(*table, judged.rows);
  const auto parameters = fit_parameters(start, names);
  if (!parameters) return tl::unexpected(parameters.error());
  auto fit = identify(start, *parameters, judged.rows);
  if (!fit) return tl::unexpected(fit.error());
  auto held_out = hold_out(start, *parameters, judged.rows, folds_of(judged.rows, 5));
  if (!held_out) return tl::unexpected(held_out.error());
  auto without = identify(start, *parameters, judged.rows, {.held_out = judged.single});
  if (!without) return tl::unexpected(without.error());
  judged.unseen_pulls = without->held_out;
  auto computed = predict_markers(fit->arm, judged.rows);
  if (!computed) return tl::unexpected(computed.error());
  judged.fit = std::move(*fit), judged.held_out = std::move(*held_out),
  judged.computed = std::move(*computed);
  return judged;
}

double rms_of_single_pulls(const Judged& judged) {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < judged.single.size(); ++k)
    if (judged.single[k] && std::isfinite(judged.fit.errors[k]))
      sum += judged.fit.errors[k] * judged.fit.errors[k], count += 1;
  return std::sqrt(sum / count);
}

std::string in_mm(double metres) { return fmt::format("{:.2f} mm", 1e3 * metres); }

void add_findings(ItemResult& result, const Recording& recording, const Judged& judged) {
  const std::string name = recording.name;
  const Identified& fit = judged.fit;
  const auto told = [&](const std::string& what, const std::string& theirs, const std::string& ours) {
    result.findings.push_back({name + what, theirs, ours, "", "for information"});
  };
  result.findings.push_back(compare::within(fmt::format("{}, {} rows, {} parameters: root mean square", name,
                                                        fit.train.rows, fit.parameters.size()),
                                            fmt::format("no map of the inputs: {}", in_mm(recording.floor)),
                                            in_mm(fit.train.rms), fit.train.rms, recording.tolerance, "m"));
  result.findings.push_back(compare::within(name + ": rows without an equilibrium", "0",
                                            fmt::format("{}", fit.train.failed), fit.train.failed, 0, ""));
  told(": before the fit, root mean square", "by the arm's file", in_mm(fit.before.rms));
  told(": median and largest distance", "", in_mm(fit.train.median) + ", " + in_mm(fit.train.max));
  told(": rows of single pulls, which the fit has seen", "", in_mm(rms_of_single_pulls(judged)));
  told(": single pulls, of a fit that has seen none of them", "", in_mm(judged.unseen_pulls.rms));
  told(": blocks that the fit has not seen, root mean square of five folds", "",
       in_mm(judged.held_out.errors.rms));
  const auto bounded =
      std::ranges::count_if(fit.parameters, [](const FittedParameter& one) { return one.at_bound; });
  told(": parameters at a bound; directions that the rows do not tell", "",
       fmt::format("{}; {}", bounded, fit.flat.size()));
}

/// Shares of rows that are nearer than a distance.
Series shares(const char* label, const std::vector<double>& errors, Colour colour, Mark mark) {
  Series series{.label = label, .x = {}, .y = {}, .mark = mark, .colour = colour};
  std::vector<double> sorted;
  for (const double error : errors)
    if (std::isfinite(error)) sorted.push_back(error);
  std::ranges::sort(sorted);
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    series.x.push_back(1e3 * sorted[k]);
    series.y.push_back(100 * static_cast<double>(k + 1) / static_cast<double>(sorted.size()));
  }
  return series;
}

Panel error_panel(const Recording& recording, const Judged& judged) {
  return {.title = std::string(recording.name),
          .x = {.label = "distance of the marker", .unit = "mm", .low = 0},
          .y = {.label = "rows that are nearer", .unit = "%", .low = 0, .high = 100},
          .series = {shares("rows of the fit", judged.fit.errors, Colour::blue, Mark::line),
                     shares("rows that it has not seen", judged.held_out.by_row, Colour::vermillion,
                            Mark::dashed)},
          .legend = Legend::bottom_right};
}

/// The marker across the arm over some rows, measured and computed.
Panel path_panel(const Recording& recording, const Judged& judged) {
  const std::size_t first = judged.rows.size() / 2, last = std::min(first + 80, judged.rows.size());
  Series measured{
      .label = "measured x", .x = {}, .y = {}, .mark = Mark::points, .colour = Colour::black, .width = 3},
      computed{.label = "computed x", .x = {}, .y = {}, .colour = Colour::blue};
  for (std::size_t k = first; k < last; ++k) {
    for (Series* series : {&measured, &computed}) series->x.push_back(static_cast<double>(k));
    measured.y.push_back(1e3 * judged.rows.markers[3 * k]);
    computed.y.push_back(1e3 * judged.computed[3 * k]);
  }
  return {.title = std::string(recording.name) + ", 80 rows",
          .x = {.label = "row", .unit = ""},
          .y = {.label = "marker across the arm", .unit = "mm"},
          .series = {std::move(measured), std::move(computed)},
          .legend = Legend::below};
}

}  // namespace

Expected<ItemResult> truth_arms(const StudyItem& item, const std::filesystem::path&) {
  ItemResult result;
  Figure figure{.title = "Two measured arms, fitted: one curvature a section, tendons with slack",
                .panels = {},
                .columns = 2,
                .width = 1200,
                .height = 900,
                .comments = compare::provenance(item.id, "measured arms, identified",
                                                "data: ContinuumRoboticsLab/opencr-mujoco (MIT)")};
  for (const Recording& recording : recordings) {
    const auto judged = judge(recording);
    if (!judged) return tl::unexpected(judged.error());
    add_findings(result, recording, *judged);
    Table table{"row",           "x[m]",          "y[m]",        "z[m]",     "computed_x[m]",
                "computed_y[m]", "computed_z[m]", "distance[m]", "unseen[m]"};
    table.comments = figure.comments;
    for (std::size_t k = 0; k < judged->rows.size(); ++k) {
      const double *at = &judged->rows.markers[3 * k], *ours = &judged->computed[3 * k];
      table.add_row(std::array{static_cast<double>(k), at[0], at[1], at[2], ours[0], ours[1], ours[2],
                               judged->fit.errors[k], judged->held_out.by_row[k]});
    }
    result.tables.emplace_back(recording.name, table);
    figure.panels.push_back(error_panel(recording, *judged));
    figure.panels.push_back(path_panel(recording, *judged));
  }
  for (const char* what :
       {"friction of tendons in these arms (its direction turns faster than rows are taken)",
        "motion: rods let go, arms that swing", "hysteresis and plasticity of backbones, contact"})
    result.findings.push_back({what, "not validated", "", "", "for information"});
  result.figures.emplace_back("arms", figure);
  return result;
}

}  // namespace sinew::inline v1
