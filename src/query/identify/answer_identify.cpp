/// `identify`: parameters of an arm, fitted to measured rows.
#include <fmt/format.h>

#include <algorithm>

#include "io/document/reader.hpp"
#include "io/measured/measurement.hpp"
#include "query/arms/arms.hpp"
#include "query/identify/identification.hpp"
#include "query/questions.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

/// Of one question: a fit of this many takes minutes, its answer megabytes.
constexpr std::size_t most_rows = 20000;

/// Columns as a table, which is read as that of a file is.
class ColumnsReader {
 public:
  ColumnsReader(Reader& rows, const Arm& arm) : rows_(rows), names_(tendon_names(arm)) {}

  std::optional<Table> read() {
    const auto pulls = rows_.required("pulls", "of the tendons: a row each, drawn in where positive [m]"),
               markers = rows_.required("markers", "where the marker was: a row of three each [m]");
    const auto time = rows_.optional("time"), blocks = rows_.optional("blocks");
    read_rows(pulls, names_);
    count_ = table_.row_count();
    read_rows(markers, std::vector<std::string>{"x", "y", "z"});
    if (time) read_column(*time, "time", Dimension::time, "s");
    if (blocks) read_column(*blocks, "block", Dimension::number, "");
    rows_.close();
    return std::move(table_);
  }

 private:
  void expect_as_many(const Reader& place, std::size_t found) {
    if (count_ && found != *count_)
      place.fail("wrong_length", fmt::format("has {} rows, pulls {}; give one for each", found, *count_));
  }

  void read_rows(const Reader& list, const std::vector<std::string>& names) {
    std::vector<Column> columns;
    for (const std::string& name : names) columns.push_back({name, "m", {}});
    const auto items = list.items();
    expect_as_many(list, items.size());
    if (items.size() <= most_rows)  // else it is refused as a whole
      for (const Reader& item : items) {
        const std::vector<double> numbers = item.quantities(Dimension::length, Range::place(), names.size());
        for (std::size_t i = 0; i < names.size(); ++i) columns[i].values.push_back(numbers[i]);
      }
    else
      list.fail("too_many", too_many_rows(items.size()));
    for (Column& column : columns) table_.columns.push_back(std::move(column));
  }

  void read_column(const Reader& list, const char* name, Dimension dimension, const char* unit) {
    Column column{name, unit, list.quantities(dimension)};
    expect_as_many(list, column.values.size());
    table_.columns.push_back(std::move(column));
  }

 public:
  static std::string too_many_rows(std::size_t found) {
    return fmt::format("has {} rows; a question takes {} at most: leave out rows between, or ask in C++",
                       found, most_rows);
  }

 private:
  Reader& rows_;
  std::vector<std::string> names_;
  Table table_;
  std::optional<std::size_t> count_;
};

/// None where it was wrong, which is noted.
std::optional<MeasuredRows> read_rows(ArmContext& context) {
  auto given =
      context.query.required("rows", "what was measured: {pulls, markers, ...}, or the text of a table");
  const std::size_t errors = context.errors.size();
  std::optional<Table> table;
  if (given.is(Node::Kind::map)) {
    table = ColumnsReader(given, context.robot).read();
  } else if (given.is(Node::Kind::string)) {
    auto parsed = parse_csv(given.text(), "rows");
    if (parsed)
      table = std::move(*parsed);
    else
      context.errors.insert(context.errors.end(), parsed.error().begin(), parsed.error().end());
    if (table && table->row_count() > most_rows)
      given.fail("too_many", ColumnsReader::too_many_rows(table->row_count()));
  } else if (given.node()) {
    given.refuse("wrong_type",
                 "give a map, {pulls: [[0, 0, 0]], markers: [[0, 0, 0.2]]}, or the text of a table");
  }
  if (!table || context.errors.size() > errors) return {};
  auto rows = read_measured_rows(*table, context.robot, "rows");
  if (rows) return std::move(*rows);
  context.errors.insert(context.errors.end(), rows.error().begin(), rows.error().end());
  return {};
}

/// Names with commas between, or a list of them.
std::string read_fit(const Reader& fit) {
  if (!fit.is(Node::Kind::list)) return fit.text();
  std::string names;
  for (const Reader& item : fit.items()) names += (names.empty() ? "" : ",") + item.text();
  return names;
}

IdentificationRequest read_request(ArmContext& context, const std::optional<MeasuredRows>& rows) {
  IdentificationRequest request{.max_iterations = context.max_iterations, .stop = context.work.stop};
  if (context.progress && *context.progress)
    request.progress = [call = context.progress](const std::string& part, int steps, double rms) {
      (*call)({part, steps, rms});
    };
  Reader& query = context.query;
  if (const auto model = query.optional("model")) {
    std::vector<std::string_view> words;
    for (const auto& [word, one] : arm_model_words()) words.push_back(word);
    request.model = arm_model_words()[model->choice_index(words)].second;
  }
  if (const auto fit = query.optional("fit")) {
    request.fit_names = read_fit(*fit);
    if (request.fit_names.empty())
      fit->fail("missing_value",
                "names nothing; give bending, or leave it out for what rows can usually tell");
  }
  if (const auto noise = query.optional("noise"))
    request.noise = noise->quantity(Dimension::length, Range::between(1e-9, 1));
  const auto folds = query.optional("folds");
  request.folds = folds ? folds->integer(Range::between(0, max_folds)) : usual_folds;
  if (request.folds == 1)
    folds->fail("out_of_range",
                "one part is all rows, and leaves none to fit; give 2 or more, or 0 for none");
  else if (rows) {
    const int possible = possible_folds(*rows, request.folds);
    if (folds && possible != request.folds)
      folds->fail("too_few", fmt::format("there are fewer blocks of rows than {} parts; give fewer parts",
                                         request.folds));
    request.folds = possible;
  }
  if (const auto map = query.optional("map")) request.take_map = map->boolean();
  return request;
}

/// Of every row its error, and where the fitted arm would show the marker; what is not known is left out.
Value by_row(const Identification& done, const std::vector<double>& computed) {
  Value list = Value::list();
  for (std::size_t k = 0; k < done.rows.size(); ++k) {
    Value row = Value::map();
    put_number(row, "distance", done.found.errors[k]);
    if (done.held_out) put_number(row, "held_out_distance", done.held_out->by_row[k]);
    const std::span<const double> place = std::span(computed).subspan(3 * k, 3);
    if (std::ranges::all_of(place, [](double value) { return std::isfinite(value); }))
      row["computed"] = place;
    list.push_back(std::move(row));
  }
  return list;
}

/// A fit is found and told at once: what of it there is decides what is said.
struct ArmFit : ArmContext {
  using ArmContext::ArmContext;

  void read() {
    rows = read_rows(*this);
    request = read_request(*this, rows);
  }
  void tell();

  std::optional<MeasuredRows> rows = {};  ///< there are some, where nothing was wrong
  IdentificationRequest request = {};
};

void ArmFit::tell() {
  const MeasuredArm arm = measured(robot);
  const auto done = run_identification(arm, *rows, request);
  if (!done) {
    errors = done.error();
    return;
  }
  answer["status"] = to_string(done->found.report.status);
  std::string why = why_incomplete(*done);
  if (!why.empty() && done->found.report.ok()) answer["status"] = to_string(Status::stopped);
  add_message(why);
  if (is_clear(done->agrees_best) && !done->is_mapped)
    add_message(
        fmt::format("the rows agree best with {} ({:.2f}, as they are {:.2f}); map: true takes "
                    "them so",
                    words_of(done->agrees_best), done->agrees_best.agreement, done->agrees_best.as_given));
  for (const std::string& remark : remarks_of(arm, done->rows, done->parameters.size())) add_message(remark);
  put_identification(*done, answer);
  const auto computed = predict_markers(done->found.arm, done->rows, request.model, request.stop);
  if (computed) answer["by_row"] = by_row(*done, *computed);
  if (!is_worth_keeping(*done)) return;
  if (const auto file = fitted_file(*done, "rows of a question"))
    answer["file"] = *file;
  else
    add_message(file.error().front().message);
}

}  // namespace

void answer_arms_identify(Context& context) { answer_question<ArmFit>(context); }

}  // namespace sinew::inline v1
