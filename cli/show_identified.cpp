#include "show_identified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// Its largest parts first, the first of them positive: `0.8 bending - 0.6 compliance`.
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

std::string map_line(const std::optional<TendonMap>& map) {
  if (!map) return {};
  return fmt::format("tendons: {}{}, turned by {:.0f} deg; agreement {:.2f}, as they were {:.2f}\n",
                     map->sign < 0 ? "counts are paid out" : "counts are drawn in",
                     map->mirrored ? ", the other way around the arm" : "", map->turn * shown("rad").factor,
                     map->agreement, map->as_given);
}

Node number_node(double value) { return std::isfinite(value) ? make_node(value) : Node{}; }
Node count_node(std::size_t count) { return make_node(static_cast<double>(count)); }
Member entry(std::string_view key, Node value) {
  return {.key = std::string(key), .value = std::move(value)};
}

Node errors_node(const MarkerErrors& errors) {
  const bool has_any = errors.rows > 0;
  const auto of_any = [&](double value) { return has_any ? number_node(value) : Node{}; };
  return map_of({entry("rows", make_node(static_cast<double>(errors.rows))),
                 entry("failed", make_node(static_cast<double>(errors.failed))),
                 entry("rms", of_any(errors.rms)), entry("median", of_any(errors.median)),
                 entry("max", of_any(errors.max))});
}

Node parameters_node(const Identification& done) {
  std::vector<Node> list;
  for (std::size_t p = 0; p < done.parameters.size(); ++p) {
    const FitParameter& parameter = done.parameters[p];
    const FittedParameter& fitted = done.found.parameters[p];
    list.push_back(
        map_of({entry("name", make_node(parameter.name)), entry("unit", make_node(parameter.unit)),
                entry("start", number_node(fitted.start)), entry("value", number_node(fitted.value)),
                entry("deviation", number_node(fitted.deviation)),
                entry("is_factor", make_node(parameter.is_factor)),
                entry("coordinate", number_node(fitted.coordinate)),
                entry("coordinate_deviation", number_node(fitted.coordinate_deviation)),
                entry("at_bound", make_node(fitted.at_bound)), entry("prior", number_node(parameter.prior)),
                entry("prior_share", number_node(fitted.prior_share))}));
  }
  return list_of(std::move(list));
}

Node flat_node(const Identification& done) {
  std::vector<Node> list;
  for (const FlatDirection& flat : done.found.flat) {
    std::vector<Node> coefficients;
    for (const double one : flat.coefficients) coefficients.push_back(number_node(one));
    list.push_back(map_of({entry("deviation", number_node(flat.deviation)),
                           entry("along", make_node(combination(flat, done.parameters))),
                           entry("coefficients", list_of(std::move(coefficients)))}));
  }
  return list_of(std::move(list));
}

Node covariance_node(const Eigen::MatrixXd& covariance) {
  std::vector<Node> rows;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    std::vector<Node> row;
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) row.push_back(number_node(covariance(i, j)));
    rows.push_back(list_of(std::move(row)));
  }
  return list_of(std::move(rows));
}

}  // namespace

std::string show_identified(const Identification& done, bool is_quiet) {
  const Report& report = done.found.report;
  std::string text = fmt::format(
      "{}: {} row{}{}, {} parameter{}, model {}, noise {:.3g} mm\n", done.found.arm.arm.name,
      done.rows.size(), done.rows.size() == 1 ? "" : "s",
      done.blocks > 0 ? fmt::format(" in {} block{}", done.blocks, done.blocks == 1 ? "" : "s") : "",
      done.parameters.size(), done.parameters.size() == 1 ? "" : "s", done.model, 1e3 * done.found.noise);
  text += map_line(done.map) + '\n' + parameter_table(done) + direction_lines(done) + error_lines(done);
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
  std::vector<Member> members{entry("query", make_node("identify")),
                              entry("robot", make_node(done.found.arm.arm.name)),
                              entry("status", make_node(to_string(report.status)))};
  if (!report.message.empty()) members.push_back(entry("message", make_node(report.message.view())));
  members.push_back(entry("iterations", make_node(static_cast<double>(report.iterations))));
  members.push_back(entry("model", make_node(done.model)));
  members.push_back(entry("fit", make_node(done.fit_names)));
  members.push_back(entry("rows", count_node(done.rows.size())));
  if (done.blocks > 0) members.push_back(entry("blocks", count_node(done.blocks)));
  members.push_back(entry("noise", number_node(done.found.noise)));
  if (done.map)
    members.push_back(entry("map", map_of({entry("sign", make_node(static_cast<double>(done.map->sign))),
                                           entry("mirrored", make_node(done.map->mirrored)),
                                           entry("turn", number_node(done.map->turn)),
                                           entry("agreement", number_node(done.map->agreement)),
                                           entry("next", number_node(done.map->next)),
                                           entry("as_given", number_node(done.map->as_given))})));
  members.push_back(entry("parameters", parameters_node(done)));
  members.push_back(entry("flat", flat_node(done)));
  members.push_back(entry("covariance", covariance_node(done.found.covariance)));
  std::vector<Member> errors{entry("before", errors_node(done.found.before)),
                             entry("fitted", errors_node(done.found.train))};
  if (done.held_out) errors.push_back(entry("held_out", errors_node(done.held_out->errors)));
  members.push_back(entry("errors", map_of(std::move(errors))));
  if (done.held_out) members.push_back(entry("folds", make_node(static_cast<double>(done.folds))));
  if (output) members.push_back(entry("output", make_node(*output)));
  members.push_back(entry("seconds", number_node(done.seconds + done.held_out_seconds)));
  return as_json(map_of(std::move(members)));
}

}  // namespace sinew::cli
