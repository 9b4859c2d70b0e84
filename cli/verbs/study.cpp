/// check and new, of studies: what a sweep would do, without doing it, and a file to start from.
#include "verbs/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "answer.hpp"
#include "io/document/quantity.hpp"
#include "sinew/io/robot_file.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

/// `{"name","unit"}`, of an axis of a grid with its number of values.
std::string as_json(const std::pair<std::string, std::string>& column, std::size_t count = 0) {
  return fmt::format("{{\"name\":{},\"unit\":{}{}}}", json_text(column.first), json_text(column.second),
                     count > 0 ? fmt::format(",\"count\":{}", count) : "");
}

std::string as_json(const Study& study, const SweepColumns& columns) {
  const bool is_grid = study.sampling == Study::Sampling::grid;
  std::string axes, names;
  for (std::size_t a = 0; a < columns.axes.size(); ++a)
    axes += (a ? "," : "") + as_json(columns.axes[a], is_grid ? columns.dimensions[a] : 0);
  for (const auto& column : columns.columns) names += (names.empty() ? "" : ",") + as_json(column);
  return fmt::format(
      "{{\"study\":{},\"title\":{},\"robot\":{},\"samples\":{},\"axes\":[{}],\"columns\":[{}],\"sampler\":{},"
      "\"chunks\":{},\"chunk\":{}}}\n",
      json_text(study.source), json_text(study.title), json_text(study.robot), study.samples, axes, names,
      json_text(columns.sampler), columns.chunks, columns.chunk);
}

/// A name that is neither a robot's nor a study's.
Errors unknown(const std::string& name) {
  Errors errors = read_robot_text(name).error();
  std::vector<std::string_view> names = builtin_robot_names();
  const auto studies = builtin_study_names();
  names.insert(names.end(), studies.begin(), studies.end());
  const std::string_view hint = closest(name, names);
  errors.front().message += fmt::format(" Studies: sinew list studies.{}",
                                        hint.empty() ? "" : fmt::format(" Did you mean {}?", hint));
  return errors;
}

}  // namespace

std::string heading(const std::pair<std::string, std::string>& column) {
  return column.second.empty() ? column.first : fmt::format("{}[{}]", column.first, column.second);
}

std::string show_study(const Study& study, const SweepColumns& columns) {
  std::vector<std::string> axes, names;
  for (std::size_t a = 0; a < columns.axes.size(); ++a) {
    const bool is_grid = study.sampling == Study::Sampling::grid;
    axes.push_back(heading(columns.axes[a]) + (is_grid ? fmt::format(" ({})", columns.dimensions[a]) : ""));
  }
  for (const auto& column : columns.columns) names.push_back(heading(column));
  return fmt::format(
      "{}robot    {}\nsamples  {}\naxes     {}\ncolumns  {}\nsampler  {}, {} chunks of up to {}\n",
      study.title.empty() ? "" : fmt::format("title    {}\n", study.title), study.robot, study.samples,
      fmt::join(axes, ", "), fmt::join(names, ", "), columns.sampler, columns.chunks, columns.chunk);
}

int check_study(const Arguments& arguments) {
  const bool is_json = arguments.has("json");
  const auto refused = [&](const Errors& errors) {
    if (is_json) print(json_error(errors) + '\n');
    return refuse(arguments.verb, errors);
  };
  const std::string name = arguments.operand();
  const bool is_name = name.find_first_of("./") == std::string::npos;
  if (is_name && builtin_study(name).empty() && !read_robot_text(name)) return refused(unknown(name));
  const auto study = read_study(name);
  if (!study) return refused(study.error());
  const auto columns = sweep_columns(*study);
  if (!columns) return refused(columns.error());
  print(is_json ? as_json(*study, *columns)
                : fmt::format("study    {}\n{}", name, show_study(*study, *columns)));
  if (!columns->warning.empty() && !arguments.has("quiet")) message("warning: " + columns->warning);
  return solved;
}

int new_study(const Arguments&) {
  print(builtin_study("3-rfr-workspace"));
  return solved;
}

}  // namespace sinew::cli
