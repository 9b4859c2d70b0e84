#include "query/identify/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "sinew/analysis/identify.hpp"
#include "sinew/base/export.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

using Clock = std::chrono::steady_clock;
using Named = std::pair<std::string_view, ArmModel>;
constexpr std::array model_words{
    Named{"cc", ArmModel::cc}, Named{"rod", ArmModel::rod}, Named{"subsegment_rod", ArmModel::subsegment_rod},
    Named{"subsegment_cc", ArmModel::subsegment_cc}, Named{"prb", ArmModel::prb}};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Rows that belong together: blocks, or where the table has none stretches, for neighbours err alike.
MeasuredRows in_stretches(const MeasuredRows& rows, int folds) {
  MeasuredRows grouped = rows;
  if (!rows.blocks.empty()) return grouped;
  const std::size_t count = rows.size(), stretches = std::min(count, static_cast<std::size_t>(4 * folds));
  for (std::size_t k = 0; k < count; ++k) grouped.blocks.push_back(static_cast<int>(k * stretches / count));
  return grouped;
}

}  // namespace

std::string_view word_of(ArmModel model) {
  return std::ranges::find(model_words, model, &Named::second)->first;
}
std::span<const Named> arm_model_words() { return model_words; }

std::size_t block_count(const MeasuredRows& rows) {
  return std::set<int>(rows.blocks.begin(), rows.blocks.end()).size();
}

int possible_folds(const MeasuredRows& rows, int asked) {
  if (asked == 0) return 0;
  const auto blocks = static_cast<int>(block_count(in_stretches(rows, asked)));
  if (blocks >= asked) return asked;
  return blocks >= 2 ? blocks : 0;
}

std::string words_of(const TendonMap& map) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (map.sign < 0) add("counts positive where tendons are paid out");
  if (map.mirrored) add("tendons the other way around the arm");
  if (std::abs(map.turn) > far_turn)
    add(fmt::format("tendons turned by {:.0f} deg", map.turn * 180 / std::numbers::pi));
  return text;
}

bool is_clear(const TendonMap& map) {
  constexpr double clear = 0.02;  // of agreement
  return !words_of(map).empty() && map.agreement >= map.as_given + clear;
}

std::vector<std::string> remarks_of(const MeasuredArm& arm, const MeasuredRows& rows,
                                    std::size_t parameters) {
  std::vector<std::string> remarks;
  if (3 * rows.size() < parameters)
    remarks.push_back(fmt::format(
        "{}, {} coordinates for {} parameters: most of what is printed is what was assumed",
        rows.size() == 1 ? "one row" : fmt::format("{} rows", rows.size()), 3 * rows.size(), parameters));
  if (std::ranges::any_of(arm.arm.tendons, [](const ArmTendon& tendon) { return tendon.friction > 0; }))
    remarks.emplace_back("the tendons' friction is left aside: rows are compared as if they slid freely");
  return remarks;
}

Expected<Identification> run_identification(MeasuredArm arm, MeasuredRows rows,
                                            const IdentificationRequest& request) {
  Identification done;
  done.model = word_of(request.model);
  done.blocks = rows.blocks.empty() ? 0 : block_count(rows);
  auto map = map_tendons(arm, rows, request.model, request.stop);
  if (!map) return tl::unexpected(map.error());
  if (std::abs(map->turn) <= far_turn) map->turn = 0;  // the fit finds what is left
  done.agrees_best = *map;
  done.is_mapped = request.take_map && is_clear(*map) && !request.stop.stop_requested();
  if (done.is_mapped) {
    for (double& pull : rows.pulls) pull *= map->sign;
    arm = mapped(arm, *map);
  }
  done.fit_names = request.fit_names.empty() ? usual_fit(arm, rows, request.model) : request.fit_names;
  auto parameters = fit_parameters(arm, done.fit_names);
  if (!parameters) {
    for (Error& error : parameters.error()) error.where = error.where.empty() ? "fit" : "fit " + error.where;
    return tl::unexpected(parameters.error());
  }
  done.parameters = std::move(*parameters);
  if (done.parameters.empty())
    return failure("missing_value", "fit", "names nothing; give bending, or leave it out");
  done.rows = std::move(rows);

  if (request.begun) request.begun(done);
  auto begin = Clock::now();
  std::string part = "fitting";
  IdentifyOptions options{.model = request.model, .noise = request.noise, .stop = request.stop};
  if (request.max_iterations) options.max_iterations = *request.max_iterations;
  int steps_before = 0, last_steps = 0;  // of fits of this part that have ended, each of which counts from 1
  if (request.progress)
    options.progress = [&](int steps, double rms) {
      if (steps <= last_steps) steps_before += last_steps;
      last_steps = steps;
      request.progress(part, steps_before + steps, rms);
    };
  auto found = identify(arm, done.parameters, done.rows, options);
  if (!found) return tl::unexpected(found.error());
  done.found = std::move(*found);
  done.seconds = seconds_since(begin);
  done.folds = request.folds;
  if (done.folds == 0 || request.stop.stop_requested() || !is_worth_keeping(done)) return done;
  begin = Clock::now();
  part = fmt::format("holding out {} parts", done.folds);
  steps_before = last_steps = 0;
  const std::vector<int> folds = folds_of(in_stretches(done.rows, done.folds), done.folds);
  auto held_out = hold_out(arm, done.parameters, done.rows, folds, options);
  if (!held_out) return tl::unexpected(held_out.error());
  if (held_out->is_complete) done.held_out = std::move(*held_out);
  done.held_out_seconds = seconds_since(begin);
  return done;
}

bool is_worth_keeping(const Identification& done) { return done.found.report.status != Status::unreachable; }

std::string why_incomplete(const Identification& done) {
  const Report& report = done.found.report;
  if (!report.message.empty()) return std::string(report.message.view());
  if (report.status == Status::stopped) return "this is what it has so far";
  if (!report.ok()) return "the parameters still change; fit fewer, or start closer";
  if (done.folds > 0 && !done.held_out) return "stopped while rows were held out; the fit itself is complete";
  return {};
}

std::string combination(const FlatDirection& flat, const std::vector<FitParameter>& parameters) {
  std::vector<std::size_t> order(flat.coefficients.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto size = [&](std::size_t p) { return -std::abs(flat.coefficients[p]); };
  std::ranges::stable_sort(order, {}, size);
  const double sign = flat.coefficients[order.front()] < 0 ? -1 : 1;
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 5); ++k) {
    const double part = sign * flat.coefficients[order[k]];
    if (std::abs(part) < 0.2) break;
    text += fmt::format("{}{:.1f} {}",
                        text.empty() ? ""
                        : part < 0   ? " - "
                                     : " + ",
                        std::abs(part), parameters[order[k]].name);
  }
  return text;
}

Expected<std::string> fitted_file(const Identification& done, std::string_view rows_name) {
  const auto mm = [](double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); };
  std::vector<std::string> lines{fmt::format(
      "{} as sinew {} identify fitted it to {}: {} rows, root mean square of the errors {} (before {}{}).",
      done.found.arm.arm.name, version(), rows_name, done.rows.size(), mm(done.found.train.rms),
      mm(done.found.before.rms),
      done.held_out ? fmt::format(", of rows that a fit has not seen {}", mm(done.held_out->errors.rms))
                    : "")};
  lines.push_back(
      fmt::format("Fitted: {}; model {}. Numbers are in SI and radians.", done.fit_names, done.model));
  if (done.is_mapped && done.agrees_best.sign < 0)
    lines.emplace_back("Counts of these rows are positive where tendons are paid out.");
  if (!done.found.report.ok())
    lines.push_back(fmt::format("The fit did not end: {}.", to_string(done.found.report.status)));
  return arm_text(as_file(done.found.arm), lines);
}

}  // namespace sinew::inline v1
