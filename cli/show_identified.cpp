#include "show_identified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "answer.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr std::size_t most_directions = 12;
constexpr double untold = 1e3;  ///< of a prior: along it the rows say nothing

/// Four digits in the unit of tables; zero is 0.
std::string short_cell(double si, std::string_view unit) {
  const double value = si * shown(unit).factor;
  return std::isfinite(value) ? fmt::format("{:.4g}", value == 0 ? 0.0 : value) : "-";
}

std::string note_of(const FittedParameter& fitted) {
  if (fitted.at_bound) return "at its bound";
  return fitted.prior_share > 0.9 ? "as assumed" : "-";
}

std::string parameter_table(const Identification& done) {
  TextTable table({"parameter", "unit", "start", "fitted", "deviation", "from_rows[%]", "note"});
  for (std::size_t p = 0; p < done.parameters.size(); ++p) {
    const FitParameter& parameter = done.parameters[p];
    const FittedParameter& fitted = done.found.parameters[p];
    const std::string_view unit = shown(parameter.unit).unit;
    table.add({parameter.name, unit.empty() ? "1" : std::string(unit),
               short_cell(fitted.start, parameter.unit), short_cell(fitted.value, parameter.unit),
               std::isfinite(fitted.deviation)
                   ? fmt::format("{:.2g}", fitted.deviation * shown(parameter.unit).factor)
                   : "-",
               fmt::format("{:.0f}", 100 * (1 - fitted.prior_share)), note_of(fitted)});
  }
  return table.text();
}

std::string direction_lines(const Identification& done) {
  if (done.found.flat.empty()) return {};
  std::string text = "\nflat directions: what the rows alone leave open, in assumed deviations\n";
  const std::size_t shown_ones = std::min(done.found.flat.size(), most_directions);
  for (std::size_t k = 0; k < shown_ones; ++k) {
    const FlatDirection& flat = done.found.flat[k];
    text +=
        fmt::format("{:>7}  {}\n", flat.deviation < untold ? fmt::format("{:.1f}", flat.deviation) : "all",
                    combination(flat, done.parameters));
  }
  if (done.found.flat.size() > shown_ones)
    text += fmt::format("and {} more, which --json has\n", done.found.flat.size() - shown_ones);
  return text;
}

std::string error_lines(const Identification& done) {
  TextTable table({"errors", "rows", "rms[mm]", "median[mm]", "max[mm]", "failed"});
  const auto add = [&](std::string name, const MarkerErrors& errors) {
    const auto mm = [&](double metres) {
      return errors.rows > 0 ? fmt::format("{:.3f}", 1e3 * metres) : "-";
    };
    table.add({std::move(name), fmt::format("{}", errors.rows), mm(errors.rms), mm(errors.median),
               mm(errors.max), fmt::format("{}", errors.failed)});
  };
  add("before", done.found.before);
  add("fitted", done.found.train);
  if (done.held_out) add("held_out", done.held_out->errors);
  return '\n' + table.text();
}

/// What was waited for; less than a second is nothing to tell.
std::string time_text(double seconds, bool is_quiet) {
  return is_quiet || seconds < 1 ? std::string() : fmt::format(", {:.1f} s", seconds);
}

std::string map_line(const Identification& done) {
  if (!done.is_mapped) return {};
  const TendonMap& map = done.agrees_best;
  return fmt::format("tendons: {}{}, turned by {:.0f} deg; agreement {:.2f}, as they were {:.2f}\n",
                     map.sign < 0 ? "counts are paid out" : "counts are drawn in",
                     map.mirrored ? ", the other way around the arm" : "", map.turn * shown("rad").factor,
                     map.agreement, map.as_given);
}

}  // namespace

std::string show_identified(const Identification& done, bool is_quiet) {
  const Report& report = done.found.report;
  std::string text = fmt::format(
      "{}: {} row{}{}, {} parameter{}, model {}, noise {:.3g} mm\n", done.found.arm.arm.name,
      done.rows.size(), done.rows.size() == 1 ? "" : "s",
      done.blocks > 0 ? fmt::format(" in {} block{}", done.blocks, done.blocks == 1 ? "" : "s") : "",
      done.parameters.size(), done.parameters.size() == 1 ? "" : "s", done.model, 1e3 * done.found.noise);
  text += map_line(done) + '\n' + parameter_table(done) + direction_lines(done) + error_lines(done);
  text += fmt::format("{} in {} steps", to_string(report.status), report.iterations);
  text += time_text(done.seconds, is_quiet);
  if (done.held_out) {
    text += fmt::format("; {} parts held out in turn", done.folds);
    text += time_text(done.held_out_seconds, is_quiet);
  }
  return text + '\n';
}

std::string identified_json(const Identification& done, const std::string* output) {
  const Report& report = done.found.report;
  Value answer{
      {"query", "identify"}, {"robot", done.found.arm.arm.name}, {"status", to_string(report.status)}};
  if (!report.message.empty()) answer["message"] = report.message.view();
  put_identification(done, answer);
  if (output) answer["output"] = *output;
  answer["seconds"] = done.seconds + done.held_out_seconds;
  return answer.json();
}

}  // namespace sinew::cli
