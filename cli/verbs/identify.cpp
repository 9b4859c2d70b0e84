/// identify: parameters of an arm's file, fitted to measured rows.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "query/identify/identification.hpp"
#include "request.hpp"
#include "show_identified.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "terminal.hpp"
#include "verbs.hpp"
#include "waiting.hpp"

namespace sinew::cli {
namespace {

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
  for (const auto& [name, model] : arm_model_words()) {
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

/// In how many parts rows are held out in turn; 0: none are.
int read_folds(const Arguments& arguments, const MeasuredRows& rows, Errors& errors) {
  const bool is_asked = arguments.has("hold-out");
  const int folds = whole_option(arguments, "hold-out", 0, max_folds, usual_folds, errors);
  if (folds == 1) {
    errors.push_back({"out_of_range", "--hold-out",
                      "one part is all rows, and leaves none to fit; give 2 or more, or 0 for none"});
    return 0;
  }
  const int possible = possible_folds(rows, folds);
  if (is_asked && possible != folds)
    errors.push_back({"too_few", "--hold-out",
                      fmt::format("there are {} blocks of rows, too few for {} parts; give fewer parts",
                                  rows.blocks.empty() ? rows.size() : block_count(rows), folds)});
  return possible;
}

/// What is likely not meant, before the fit is waited for.
void warn(const Identification& begun, const MeasuredArm& arm, const Arguments& arguments) {
  const TendonMap& map = begun.agrees_best;
  if (arguments.has("map") && !begun.is_mapped)
    message(fmt::format("--map: the rows agree with tendons and counts as they are ({:.2f})", map.as_given));
  if (is_clear(map) && !begun.is_mapped)
    message(
        fmt::format("warning: the rows agree best with {} ({:.2f}, as they are {:.2f}); --map takes them so",
                    words_of(map), map.agreement, map.as_given));
  for (const std::string& remark : remarks_of(arm, begun.rows, begun.parameters.size()))
    message("warning: " + remark);
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
    const auto text = fitted_file(done, arguments.operands[1]);
    if (!text) return tl::unexpected(text.error());
    if (auto written = write_text(*text, *output); !written) return written;
  }
  const std::string* errors = arguments.text("errors");
  if (!errors) return {};
  const auto computed = predict_markers(done.found.arm, done.rows, model);
  if (!computed) return tl::unexpected(computed.error());
  return write_csv(error_table(done, *computed, arguments), *errors);
}

/// Fits as long as nobody interrupts it, and shows how far it is.
Expected<Identification> fit(const MeasuredArm& arm, MeasuredRows rows, IdentificationRequest request,
                             bool is_quiet) {
  Waiting waiting(is_quiet);
  request.stop = stop_token();
  request.progress = [&](const std::string& part, int steps, double rms) {
    waiting.say(fmt::format("{}, step {}, error {:.3g} mm", part, steps, 1e3 * rms));
  };
  return run_identification(arm, std::move(rows), request);
}

/// Fields of the question as options of the command line.
Errors at_options(Errors errors) {
  for (Error& error : errors)
    if (error.where.starts_with("fit")) error.where = "--" + error.where;
  return errors;
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
  const std::string why = why_incomplete(done);
  if (why.empty()) return solved;
  if (report.ok()) {  // of what comes after the fit
    message("sinew identify: " + why);
    return stopped;
  }
  message(fmt::format("sinew identify: {}: {}", to_string(report.status), why));
  return report.status == Status::stopped || report.status == Status::iteration_limit ? stopped : no_solution;
}

}  // namespace

int run_identify(const Arguments& arguments) {
  if (arguments.operands.size() < 2)
    return refuse("identify", {{"missing_rows", "",
                                fmt::format("which rows? Give a .csv file of what was measured: {}",
                                            find_verb("identify")->example)}});
  Errors errors;
  const ArmModel model = read_arm_model(arguments, errors);
  IdentificationRequest request{
      .model = model, .noise = read_noise(arguments, errors), .take_map = arguments.has("map")};
  if (!errors.empty()) return refuse("identify", errors);
  const auto arm = read_arm_to_fit(arguments);
  if (!arm) return refuse("identify", arm.error());
  const std::string& file = arguments.operands[1];
  auto rows =
      read_csv(file).and_then([&](const Table& table) { return read_measured_rows(table, arm->arm, file); });
  if (!rows) return refuse("identify", rows.error());
  request.folds = read_folds(arguments, *rows, errors);
  if (const std::string* names = arguments.text("fit")) {
    request.fit_names = *names;
    if (names->find_first_not_of(" ,") == std::string::npos)
      errors.push_back({"missing_value", "--fit", "names nothing; see sinew identify --help"});
  }
  if (!errors.empty()) return refuse("identify", errors);

  finish_what_is_begun();
  const bool is_quiet = arguments.has("quiet");
  if (!is_quiet) request.begun = [&](const Identification& begun) { warn(begun, *arm, arguments); };
  const auto fitted = fit(*arm, std::move(*rows), request, is_quiet);
  if (!fitted) return refuse("identify", at_options(fitted.error()));
  const Identification& done = *fitted;

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
