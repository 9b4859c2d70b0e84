/// sweep: a study run on all cores or a cluster, into a file of results.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "progress.hpp"
#include "request.hpp"
#include "study/cluster.hpp"
#include "terminal.hpp"
#include "text_table.hpp"
#include "verbs/study.hpp"

namespace sinew::cli {
namespace {

constexpr int max_threads = 1024;

/// The studies that come with sinew.
int list_studies() {
  TextTable table({"study", "title"});
  for (const std::string_view name : builtin_study_names())
    if (const auto study = read_study(std::string(name))) table.add({std::string(name), study->title});
  print(table.text(line_width()));
  return solved;
}

/// What a study will do.
int list(const Study& study) {
  const auto columns = sweep_columns(study);
  if (!columns) return refuse("sweep", columns.error());
  print(show_study(study, *columns));
  if (!columns->warning.empty()) message(fmt::format("sinew sweep: {}", columns->warning));
  return solved;
}

/// The command that gives the same data: without how many computed them, or where to.
std::string command_of(const Arguments& arguments) {
  const std::string name = arguments.operand();
  std::string text = "sinew sweep " + (name.find(' ') == std::string::npos ? name : in_quotes(name));
  if (const std::string* isa = arguments.text("isa"); isa && *isa != "native") text += " --isa " + *isa;
  if (const auto set = arguments.options.find("set"); set != arguments.options.end())
    for (const std::string& change : set->second) text += fmt::format(" --set {}", in_quotes(change));
  return text;
}

std::string counts(const SweepSummary& summary) {
  std::string text;
  const auto add = [&](std::size_t count, std::string_view what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  const std::size_t last = summary.statuses.size() - 1;  // left out: no way that a sample ends
  for (std::size_t s = last; s-- > 0;) add(summary.statuses[s], sample_status_name(s));
  add(summary.statuses[last], "left out");
  return text;
}

std::string rate_of(std::uint64_t bytes, double seconds) {
  return seconds > 0 ? short_number(static_cast<double>(bytes) / seconds) + "B/s" : "-";
}

std::string report(const SweepSummary& summary) {
  const auto fresh = static_cast<double>(summary.samples - summary.resumed -
                                         (summary.counts_all ? summary.statuses[10] : 0));
  std::string who = fmt::format("{} thread{}", summary.threads, summary.threads == 1 ? "" : "s");
  if (summary.ranks > 1) who = fmt::format("{} ranks of {}", summary.ranks, who);
  const auto line = [](const char* what, double seconds, const std::string& rate) {
    return fmt::format("{:<9} {:>8.2f} s  {}\n", what, seconds, rate);
  };
  return fmt::format("{}{}\n{}, {}, {}\n", summary.counts_all ? "" : "since resumed: ", counts(summary),
                     summary.sampler, who, summary.instruction_set) +
         line("computing", summary.computing,
              short_number(fresh / std::max(summary.computing, 1e-9)) + " samples/s") +
         (summary.logged_bytes > 0
              ? line("log", summary.logging, rate_of(summary.logged_bytes, summary.logging))
              : std::string()) +
         line("file", summary.writing, rate_of(summary.written_bytes, summary.writing));
}

/// As JSON has it; what is not finite is null.
std::string json_number(double value) { return std::isfinite(value) ? si_text(value) : "null"; }

std::string json_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + json_number(value);
  return '[' + text + ']';
}

std::string json_fit(const FittedTerms& fit) {
  std::string terms, columns;
  for (const std::string& term : fit.terms) terms += (terms.empty() ? "" : ",") + json_text(term);
  for (const FittedColumn& column : fit.columns)
    columns += fmt::format(
        "{}{{\"name\":{},\"unit\":{},\"formula\":{},\"rms\":{},\"largest\":{},\"relative\":{}}}",
        columns.empty() ? "" : ",", json_text(column.name), json_text(column.unit), json_text(column.text),
        json_number(column.rms), json_number(column.largest), json_number(column.relative));
  return fmt::format(
      "{{\"name\":{},\"unit\":{},\"terms\":[{}],\"coefficients\":{},\"deviations\":{},\"given\":{},\"rms\":{}"
      ","
      "\"largest\":{},\"samples\":{},\"columns\":[{}]}}",
      json_text(fit.name), json_text(fit.unit), terms, json_list(fit.coefficients), json_list(fit.deviations),
      fit.is_given, json_number(fit.rms), json_number(fit.largest), fit.samples, columns);
}

std::string json_report(const SweepSummary& summary, const std::string& file) {
  std::string statuses, fits;
  for (std::size_t s = 0; s < summary.statuses.size(); ++s)
    if (summary.statuses[s] > 0)
      statuses +=
          fmt::format("{}\"{}\":{}", statuses.empty() ? "" : ",", sample_status_name(s), summary.statuses[s]);
  for (const FittedTerms& fit : summary.fits) fits += (fits.empty() ? "" : ",") + json_fit(fit);
  return fmt::format(
      "{{\"output\":{},\"complete\":{},\"samples\":{},\"resumed\":{},\"statuses\":{{{}}},\"sampler\":{},"
      "\"threads\":{},\"ranks\":{},"
      "\"instruction_set\":{},\"seconds\":{{\"computing\":{},\"log\":{},\"file\":{},\"total\":{}}},\"fits\":["
      "{}]}}\n",
      json_text(file), summary.is_complete, summary.samples, summary.resumed, statuses,
      json_text(summary.sampler), summary.threads, summary.ranks, json_text(summary.instruction_set),
      si_text(summary.computing), si_text(summary.logging), si_text(summary.writing), si_text(summary.total),
      fits);
}

std::string residuals(const FittedColumn& column) {
  return fmt::format("rms {:.4g}, largest {:.4g}, relative {:.4g}", column.rms, column.largest,
                     column.relative);
}

void print_fit(const FittedTerms& fit) {
  const bool is_sum = fit.columns.front().text.empty();  // of terms, to one column
  TextTable table({is_sum ? "term" : "coefficient",
                   is_sum ? fmt::format("coefficient of {}", heading({fit.name, fit.unit})) : fit.name,
                   "deviation"});
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    table.add({fit.terms[t], fmt::format("{:.6g}", fit.coefficients[t]),
               fit.is_given ? "given" : fmt::format("{:.1e}", fit.deviations[t])});
  std::string text = table.text();
  if (is_sum) {
    text += fmt::format("{}, {} samples\n", residuals(fit.columns.front()), fit.samples);
  } else {
    for (const FittedColumn& column : fit.columns)
      text +=
          fmt::format("{} = {}\n  {}\n", heading({column.name, column.unit}), column.text, residuals(column));
    text += fmt::format("{} samples\n", fit.samples);
  }
  print(text + '\n');
  if (fit.is_given || !std::isnan(fit.coefficients.front())) return;
  message(fmt::format("sinew sweep: fit {}: the samples do not tell {} apart; remove one, or vary more axes",
                      fit.name, fmt::join(fit.terms, ", ")));
}

}  // namespace

int run_sweep(const Arguments& arguments) {
  if (arguments.operands.empty() && arguments.has("list")) return list_studies();
  if (arguments.operands.empty())
    return refuse("sweep",
                  {{"missing_study", "",
                    fmt::format("which study? Give a study file: {}", find_verb("sweep")->example)}});
  auto changes = settings(arguments);
  if (!changes) return refuse("sweep", changes.error());
  auto study = read_study(arguments.operand(), *changes);
  if (!study) return refuse("sweep", study.error());
  if (arguments.has("list")) return list(*study);

  Errors errors;
  SweepOptions options;
  options.output = arguments.has("output") ? std::filesystem::path(*arguments.text("output"))
                                           : std::filesystem::path(arguments.operand()).stem().concat(".h5");
  options.resume = arguments.has("resume");
  options.replaces_results = arguments.has("force");
  options.threads = whole_option(arguments, "threads", 1, max_threads, 0, errors);
  options.compression = whole_option(arguments, "compress", 0, 9, 0, errors);
  options.command = command_of(arguments);
  const std::string isa = arguments.has("isa") ? *arguments.text("isa") : "native";
  // The mathematical library chooses by the machine too; it is told when the process starts.
  if (isa == "baseline") restart_with("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4");
  if (!use_instruction_set(isa))
    errors.push_back({"no_instruction_set", "--isa",
                      fmt::format("{} is none this machine has; there are baseline, avx2, avx512 and native.",
                                  in_quotes(isa))});
  if (!errors.empty()) return refuse("sweep", errors);

  auto ranks = join_ranks();
  if (!ranks) return refuse("sweep", ranks.error());
  options.ranks = ranks->get();
  finish_what_is_begun();
  const bool speaks = !options.ranks || options.ranks->rank() == 0;  // one for all
  const bool is_quiet = arguments.has("quiet") || !speaks;
  auto line = std::make_unique<ProgressLine>(is_quiet, "samples");
  options.progress = [&](const SweepProgress& progress) {
    line->show(progress.done, progress.total, progress.done - progress.resumed, progress.seconds);
    return !interrupted();
  };
  const auto summary = sweep(std::move(*study), options);
  line.reset();
  if (!summary) {
    return speaks || summary.error().front().code != "other_rank" ? refuse("sweep", summary.error())
                                                                  : bad_input;
  }
  if (!speaks) return solved;
  if (!summary->warning.empty()) message(fmt::format("sinew sweep: {}", summary->warning));
  if (!summary->is_complete) {
    message(
        fmt::format("sinew sweep: stopped; {}.log is kept, go on with --resume", options.output.string()));
    return stopped;
  }
  if (arguments.has("json")) {
    print(json_report(*summary, options.output.string()));
    return solved;
  }
  if (summary->was_complete) {
    if (!is_quiet) message(fmt::format("{} is complete already", options.output.string()));
    return solved;
  }
  if (!is_quiet) print(visible_line(options.output.string()) + '\n' + report(*summary));
  for (const FittedTerms& fit : summary->fits) print_fit(fit);
  return solved;
}

}  // namespace sinew::cli
