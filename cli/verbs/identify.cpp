/// identify: parameters of an arm's file, fitted to measured rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>

#include "io/quantity.hpp"
#include "io/visible.hpp"
#include "request.hpp"
#include "show_identified.hpp"
#include "sinew/io/arm_file.hpp"
#include "sinew/io/measured_arm.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/serial_file.hpp"
#include "terminal.hpp"
#include "verbs.hpp"
#include "waiting.hpp"

namespace sinew::cli {
namespace {

using Clock = std::chrono::steady_clock;

using Named = std::pair<std::string_view, ArmModel>;
constexpr std::array models{Named{"cc", ArmModel::cc}, Named{"rod", ArmModel::rod},
                            Named{"subsegment_rod", ArmModel::subsegment_rod},
                            Named{"subsegment_cc", ArmModel::subsegment_cc}, Named{"prb", ArmModel::prb}};
constexpr int usual_folds = 5, max_folds = 100;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The arm of the command line, as --set changes it, with how its file says that it is measured.
Expected<MeasuredArm> read_arm_to_fit(const Arguments& arguments) {
  auto document = read_robot_file(arguments.operand());
  if (!document) return tl::unexpected(document.error());
  if (!is_arm(*document))
    return failure(
        "not_available", "",
        fmt::format("{} is no arm that bears loads; give a robot with sections of type elastic: sinew "
                    "new arm prints one",
                    arguments.operand()));
  const auto changes = settings(arguments);
  if (!changes) return tl::unexpected(changes.error());
  document =
      expanded_sections(*document).and_then([&](const Document& listed) { return with(listed, *changes); });
  if (!document) return tl::unexpected(document.error());
  return read_arm(*document).map([](const Arm& arm) { return measured(arm); });
}

ArmModel read_arm_model(const Arguments& arguments, Errors& errors) {
  const std::string* word = arguments.text("model");
  if (!word) return ArmModel::cc;
  std::vector<std::string_view> names;
  for (const auto& [name, model] : models) {
    if (name == *word) return model;
    names.push_back(name);
  }
  const std::string_view hint = closest(*word, names);
  errors.push_back(
      {"unknown_choice", "--model",
       fmt::format("{} is no model of an arm{} There are: {}.", in_quotes(*word),
                   hint.empty() ? "." : fmt::format("; did you mean {}?", hint), fmt::join(names, ", "))});
  return ArmModel::cc;
}

/// Of a marker's coordinate [m]; 0: estimated.
double read_noise(const Arguments& arguments, Errors& errors) {
  const std::string* text = arguments.text("noise");
  if (!text) return 0;
  const auto value = parse_quantity(*text, Dimension::length);
  if (!value)
    errors.push_back({value.error().front().code, "--noise", value.error().front().message});
  else if (!(*value >= 1e-9 && *value <= 1))
    errors.push_back({"out_of_range", "--noise",
                      fmt::format("{} is no error of a marker: 1 nm to 1 m", in_quotes(*text))});
  else
    return *value;
  return 0;
}

/// Rows that belong together: blocks, or where the table has none stretches, for neighbours err alike.
MeasuredRows in_stretches(const MeasuredRows& rows, int folds) {
  MeasuredRows grouped = rows;
  if (!rows.blocks.empty()) return grouped;
  const std::size_t count = rows.size(), stretches = std::min(count, static_cast<std::size_t>(4 * folds));
  for (std::size_t k = 0; k < count; ++k) grouped.blocks.push_back(static_cast<int>(k * stretches / count));
  return grouped;
}

std::size_t block_count(const MeasuredRows& rows) {
  return std::set<int>(rows.blocks.begin(), rows.blocks.end()).size();
}

/// In how many parts rows are held out in turn; 0: none are.
int read_folds(const Arguments& arguments, const MeasuredRows& rows, Errors& errors) {
  const bool is_asked = arguments.has("hold-out");
  const int folds = whole_option(arguments, "hold-out", 0, max_folds, usual_folds, errors);
  if (folds == 1) {
    errors.push_back({"out_of_range", "--hold-out",
                      "one part is all rows, and leaves none to fit; give 2 or more, or 0 for none"});
    return 0;
  }
  if (folds == 0) return 0;
  const auto blocks = static_cast<int>(block_count(in_stretches(rows, folds)));
  if (blocks >= folds) return folds;
  if (is_asked)
    errors.push_back(
        {"too_few", "--hold-out",
         fmt::format("there are {} blocks of rows, too few for {} parts; give fewer parts", blocks, folds)});
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

/// Which way motors count and where tendons are, as rows have it: taken with --map, else only told.
Expected<std::optional<TendonMap>> find_map(const Arguments& arguments, ArmModel model, MeasuredArm& arm,
                                            MeasuredRows& rows) {
  constexpr double clear = 0.02;  // of agreement
  auto map = map_tendons(arm, rows, model, stop_token());
  if (!map) return tl::unexpected(map.error());
  if (interrupted()) return std::nullopt;
  if (std::abs(map->turn) <= far_turn) map->turn = 0;  // the fit finds what is left
  const std::string other = words_of(*map);
  if (other.empty() || map->agreement < map->as_given + clear) {
    if (arguments.has("map") && !arguments.has("quiet"))
      message(
          fmt::format("--map: the rows agree with tendons and counts as they are ({:.2f})", map->as_given));
    return std::nullopt;
  }
  if (!arguments.has("map")) {
    if (!arguments.has("quiet"))
      message(fmt::format(
          "warning: the rows agree best with {} ({:.2f}, as they are {:.2f}); --map takes them so", other,
          map->agreement, map->as_given));
    return std::nullopt;
  }
  for (double& pull : rows.pulls) pull *= map->sign;
  arm = mapped(arm, *map);
  return std::optional(*map);
}

/// What is computed, and likely not meant.
void warn(const MeasuredArm& arm, const MeasuredRows& rows, std::size_t parameters) {
  if (3 * rows.size() < parameters)
    message(fmt::format(
        "warning: {}, {} coordinates for {} parameters: most of what is printed is what was assumed",
        rows.size() == 1 ? "one row" : fmt::format("{} rows", rows.size()), 3 * rows.size(), parameters));
  if (std::ranges::any_of(arm.arm.tendons, [](const ArmTendon& tendon) { return tendon.friction > 0; }))
    message("warning: the tendons' friction is left aside: rows are compared as if they slid freely");
}

std::vector<std::string> comments_of(const Identification& done, const Arguments& arguments) {
  const auto mm = [](double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); };
  std::vector<std::string> lines{fmt::format(
      "{} as sinew {} identify fitted it to {}: {} rows, root mean square of the errors {} (before {}{}).",
      done.found.arm.arm.name, version(), arguments.operands[1], done.rows.size(), mm(done.found.train.rms),
      mm(done.found.before.rms),
      done.held_out ? fmt::format(", of rows that a fit has not seen {}", mm(done.held_out->errors.rms))
                    : "")};
  lines.push_back(
      fmt::format("Fitted: {}; model {}. Numbers are in SI and radians.", done.fit_names, done.model));
  if (done.map && done.map->sign < 0)
    lines.emplace_back("Counts of these rows are positive where tendons are paid out.");
  if (!done.found.report.ok())
    lines.push_back(fmt::format("The fit did not end: {}.", to_string(done.found.report.status)));
  return lines;
}

/// What was measured and what the fitted arm would show, a line a row.
Table error_table(const Identification& done, const std::vector<double>& computed,
                  const Arguments& arguments) {
  const MeasuredRows& rows = done.rows;
  Table table({"row", "error[m]"});
  table.comments = {
      fmt::format("sinew {}: identify {} by {}", version(), arguments.operand(), arguments.operands[1])};
  const auto add = [&](const char* name, const char* unit, std::size_t width, std::size_t offset,
                       const std::vector<double>& values) {
    Column column{name, unit, {}};
    for (std::size_t k = 0; k < rows.size(); ++k) column.values.push_back(values[width * k + offset]);
    table.columns.push_back(std::move(column));
  };
  for (std::size_t k = 0; k < rows.size(); ++k) {
    table.columns[0].values.push_back(static_cast<double>(k + 1));
    table.columns[1].values.push_back(done.found.errors[k]);
  }
  if (done.held_out) add("held_out_error", "m", 1, 0, done.held_out->by_row);
  if (!rows.time.empty()) add("time", "s", 1, 0, rows.time);
  if (!rows.blocks.empty()) {
    const std::vector<double> blocks(rows.blocks.begin(), rows.blocks.end());
    add("block", "", 1, 0, blocks);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    add(std::array{"x", "y", "z"}[i], "m", 3, i, rows.markers);
    add(std::array{"computed_x", "computed_y", "computed_z"}[i], "m", 3, i, computed);
  }
  return table;
}

Expected<void> write_files(const Identification& done, ArmModel model, const Arguments& arguments) {
  if (const std::string* output = arguments.text("output")) {
    const auto text = arm_text(as_file(done.found.arm), comments_of(done, arguments));
    if (!text) return tl::unexpected(text.error());
    if (auto written = write_text(*text, *output); !written) return written;
  }
  const std::string* errors = arguments.text("errors");
  if (!errors) return {};
  const auto computed = predict_markers(done.found.arm, done.rows, model);
  if (!computed) return tl::unexpected(computed.error());
  return write_csv(error_table(done, *computed, arguments), *errors);
}

/// Fits, and judges by parts that were held out, as long as nobody interrupts it.
Expected<void> fit(const MeasuredArm& arm, IdentifyOptions options, bool is_quiet, Identification& done) {
  const auto begin = Clock::now();
  Waiting waiting(is_quiet);
  std::string part = "fitting";
  options.stop = stop_token();
  options.progress = [&](int steps, double rms) {
    waiting.say(fmt::format("{}, step {}, error {:.3g} mm", part, steps, 1e3 * rms));
  };
  auto found = identify(arm, done.parameters, done.rows, options);
  if (!found) return tl::unexpected(found.error());
  done.found = std::move(*found);
  done.seconds = seconds_since(begin);
  if (done.folds == 0 || interrupted()) return {};
  part = fmt::format("holding out {} parts", done.folds);
  const std::vector<int> folds = folds_of(in_stretches(done.rows, done.folds), done.folds);
  auto held_out = hold_out(arm, done.parameters, done.rows, folds, options);
  if (!held_out) return tl::unexpected(held_out.error());
  if (held_out->is_complete) done.held_out = std::move(*held_out);
  done.held_out_seconds = seconds_since(begin) - done.seconds;
  return {};
}

/// Why it is no complete fit, if it is none. The answer is the exit code.
int say_how_it_ended(const Identification& done, bool is_quiet) {
  const Report& report = done.found.report;
  const MarkerErrors& fitted = done.found.train;
  if (fitted.failed > 0 && fitted.rows > 0 && !is_quiet)
    message(fmt::format(
        "warning: at {} of {} rows no equilibrium of the fitted arm was found; they count in no error "
        "and change no parameter",
        fitted.failed, fitted.failed + fitted.rows));
  if (!report.ok()) {
    std::string why = "the parameters still change; fit fewer, or start closer";
    if (report.status == Status::stopped) why = "this is what it has so far";
    if (!report.message.empty()) why = report.message.view();
    message(fmt::format("sinew identify: {}: {}", to_string(report.status), why));
    return report.status == Status::stopped || report.status == Status::iteration_limit ? stopped
                                                                                        : no_solution;
  }
  if (done.folds == 0 || done.held_out) return solved;
  message("sinew identify: stopped while rows were held out; the fit itself is complete");
  return stopped;
}

/// An arm that stands at no row is none to keep.
bool is_worth_keeping(const Identification& done) { return done.found.report.status != Status::unreachable; }

}  // namespace

int run_identify(const Arguments& arguments) {
  if (arguments.operands.size() < 2)
    return refuse("identify", {{"missing_rows", "",
                                fmt::format("which rows? Give a .csv file of what was measured: {}",
                                            find_verb("identify")->example)}});
  Errors errors;
  const ArmModel model = read_arm_model(arguments, errors);
  const IdentifyOptions options{.model = model, .noise = read_noise(arguments, errors)};
  if (!errors.empty()) return refuse("identify", errors);
  auto arm = read_arm_to_fit(arguments);
  if (!arm) return refuse("identify", arm.error());
  const std::string& file = arguments.operands[1];
  auto rows =
      read_csv(file).and_then([&](const Table& table) { return read_measured_rows(table, arm->arm, file); });
  if (!rows) return refuse("identify", rows.error());
  Identification done;
  done.folds = read_folds(arguments, *rows, errors);
  if (!errors.empty()) return refuse("identify", errors);

  finish_what_is_begun();
  done.model = std::ranges::find(models, model, &Named::second)->first;
  const auto map = find_map(arguments, model, *arm, *rows);
  if (!map) return refuse("identify", map.error());
  done.map = *map;
  done.fit_names = arguments.has("fit") ? *arguments.text("fit") : usual_fit(*arm, *rows, model);
  auto parameters = fit_parameters(*arm, done.fit_names);
  if (!parameters) {
    for (Error& error : parameters.error()) error.where = "--fit " + error.where;
    return refuse("identify", parameters.error());
  }
  done.parameters = std::move(*parameters);
  if (done.parameters.empty())
    return refuse("identify", {{"missing_value", "--fit", "names nothing; see sinew identify --help"}});
  const bool is_quiet = arguments.has("quiet");
  if (!is_quiet) warn(*arm, *rows, done.parameters.size());
  done.blocks = rows->blocks.empty() ? 0 : block_count(*rows);
  done.rows = std::move(*rows);
  if (const auto fitted = fit(*arm, options, is_quiet, done); !fitted)
    return refuse("identify", fitted.error());

  // what was waited for is shown, whether or not it can be written
  const auto written = is_worth_keeping(done) ? write_files(done, model, arguments) : Expected<void>();
  if (arguments.has("json"))
    print(identified_json(done, written && is_worth_keeping(done) ? arguments.text("output") : nullptr) +
          '\n');
  else
    print(show_identified(done, is_quiet));
  const int code = say_how_it_ended(done, is_quiet);
  return written ? code : refuse("identify", written.error());
}

}  // namespace sinew::cli
