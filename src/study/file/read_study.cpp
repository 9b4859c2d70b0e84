/// Study files into Study.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "query/batch/placeholders.hpp"
#include "sinew/analysis/singularity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/study/study.hpp"
#include "study/builtin.hpp"
#include "study/file/column_name.hpp"
#include "study/file/column_values.hpp"
#include "study/file/read_derived.hpp"
#include "study/file/read_fits.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

constexpr double max_samples = 1e12, max_values = 1e7;

/// What may stand in a heading.
std::string read_unit(const Reader& place) {
  std::string unit = place.text();
  if (unit.find_first_of(",[]\"\n\r#") != std::string::npos)
    place.fail("bad_unit", "has a character that a heading cannot hold; give a symbol like N/m");
  return unit;
}

/// `{from: -60 mm, to: 60 mm, count: 121}`, as an axis of a map has it.
void read_steps(Reader& place, ColumnValues& values, StudyAxis& axis) {
  const double from = values.value(place.required("from", "first value"));
  const double to = values.value(place.required("to", "last value"));
  const int count =
      place.required("count", "how many values, both ends included").integer(Range::between(1, max_values));
  const MapAxis steps{.from = from, .to = to, .count = count};
  for (int k = 0; k < count; ++k) axis.values.push_back(steps.at(k));
}

void read_distribution(Reader& place, ColumnValues& values, StudyAxis& axis) {
  if (place.has("mean") || place.has("deviation")) {
    axis.kind = StudyAxis::Kind::normal;
    axis.low = values.value(place.required("mean", "of the random values"));
    axis.high = values.value(place.required("deviation", "standard deviation of the random values"));
    if (axis.high < 0) place.fail("out_of_range", "the standard deviation must not be negative");
  } else {
    axis.kind = StudyAxis::Kind::uniform;
    axis.low = values.value(place.required("from", "lowest random value"));
    axis.high = values.value(place.required("to", "highest random value"));
  }
}

/// `[rod, cc]`: texts that begin with a letter, which no quantity does.
bool are_words(const Reader& place) {
  return std::ranges::all_of(place.node()->items, [](const Node& item) {
    return item.kind == Node::Kind::string && !item.text.empty() &&
           std::isalpha(static_cast<unsigned char>(item.text.front())) != 0;
  });
}

/// Values are their numbers.
void read_words(const Reader& place, StudyAxis& axis) {
  for (const Reader& item : place.items()) {
    const std::string word = item.text();
    if (word.find_first_of(", \t\n\r") != std::string::npos)
      item.fail("bad_word", "has a blank or a comma, which the heading of results cannot hold");
    if (std::ranges::find(axis.words, word) != axis.words.end())
      item.fail("duplicate_word", "stands in the list twice");
    axis.values.push_back(static_cast<double>(axis.words.size()));
    axis.words.push_back(word);
  }
}

StudyAxis read_axis(const std::string& name, Reader place, bool is_random) {
  StudyAxis axis{.name = name, .unit = {}, .values = {}, .words = {}};
  check_name(place, name);
  if (place.is(Node::Kind::list)) {
    ColumnValues values(axis.unit, {}, "axis");
    if (!place.node()->items.empty() && are_words(place))
      read_words(place, axis);
    else
      for (const Reader& item : place.items()) axis.values.push_back(values.value(item));
    if (axis.values.empty()) place.fail("empty_list", "has no values; give at least one");
    if (is_random) place.fail("not_random", "is a list; a random axis is {from, to} or {mean, deviation}");
    return axis;
  }
  const auto unit = place.optional("unit");
  ColumnValues values(axis.unit, unit ? unit->text() : std::string(), "axis");
  if (is_random)
    read_distribution(place, values, axis);
  else
    read_steps(place, values, axis);
  if (place.is(Node::Kind::map)) place.close();
  return axis;
}

/// One study file being read.
class StudyReader {
 public:
  StudyReader(const Document& document, const std::string& path, Study& study, std::span<const Member> set)
      : root_(document, errors_),
        folder_(fs::path(path).parent_path()),
        study_(study),
        set_(set) {}

  Errors read() {
    const Reader version = root_.required("sinew", "version of the format: 1");
    if (version.node() && version.integer() != 1)
      version.refuse("wrong_version", "this sinew reads version 1");
    if (const auto title = root_.optional("title")) study_.title = title->text();
    read_robot();
    read_samples();
    if (const auto derived = root_.optional("derived")) read_derived(*derived, study_);
    read_query();
    read_outputs();
    read_reduction();
    if (const auto fits = root_.optional("fits")) read_fits(*fits, study_);
    root_.close();
    return std::move(errors_);
  }

 private:
  void take(const Errors& errors) { errors_.insert(errors_.end(), errors.begin(), errors.end()); }

  /// Beside the study, unless it is the name of a robot of the library.
  std::string beside(const std::string& name) const {
    const auto known = builtin_robot_names();
    if (std::ranges::find(known, name) != known.end() || fs::path(name).is_absolute()) return name;
    return (folder_ / name).string();
  }

  void read_robot() {
    const Reader name = root_.required("robot", "a built-in robot or a file beside the study");
    const auto set = root_.optional("set");
    if (set) set->members();  // notes it where this is no map
    study_.robot = name.text();
    if (!name.is(Node::Kind::string)) return;
    const auto text = read_robot_text(beside(study_.robot));
    if (!text) {
      const bool is_word = study_.robot.find_first_of("./") == std::string::npos;
      name.fail(text.error().front().code,
                is_word
                    ? fmt::format("{} is no built-in robot, and no file beside the study; built in are {}",
                                  in_quotes(study_.robot), fmt::join(builtin_robot_names(), ", "))
                    : text.error().front().message);
      return;
    }
    study_.robot_text = *text;
    auto document = parse_yaml(*text, study_.robot);
    if (set && set->is(Node::Kind::map) && document)
      document = with(*document, std::span<const Member>(set->node()->members));
    if (document) document = with(*document, set_);
    if (document)
      study_.robot_document = std::move(*document);
    else
      take(document.error());
  }

  void read_samples() {
    auto random = root_.optional("random");
    const auto list = root_.optional("listed");
    if (random && list) root_.fail("ambiguous", "random and listed both say where the samples are; keep one");
    if (list) return read_list(*list);
    if (random) {
      study_.sampling = Study::Sampling::random;
      study_.is_path = false;
      study_.samples = static_cast<std::size_t>(
          std::max(1.0, random->required("count", "how many samples")
                            .quantity(Dimension::count, {.low = 1, .high = max_samples})));
      if (const auto seed = random->optional("seed"))
        study_.seed = static_cast<std::uint64_t>(seed->quantity(Dimension::count, Range::between(0, 9e15)));
      random->close();
    }
    const Reader axes = root_.required("axes", "what varies: {x: {from: -60 mm, to: 60 mm, count: 121}}");
    for (auto& [name, place] : axes.members())
      study_.axes.push_back(read_axis(name, std::move(place), random.has_value()));
    if (study_.axes.empty()) axes.fail("empty_map", "names no axis; give at least one");
    if (random) return;
    double product = 1;
    for (const StudyAxis& axis : study_.axes)
      product *= static_cast<double>(std::max<std::size_t>(axis.values.size(), 1));
    if (product > max_samples)
      axes.fail("too_large", fmt::format("span {:.3g} samples; {:.0e} at most", product, max_samples));
    else
      study_.samples = static_cast<std::size_t>(product);
  }

  void read_list(const Reader& list) {
    study_.sampling = Study::Sampling::listed;
    study_.is_path = false;
    if (const auto axes = root_.optional("axes"))
      axes->fail("no_effect", "has no effect: the columns of the list are the axes; remove it");
    const std::string file = (folder_ / list.text()).string();
    const auto table = read_csv(file);
    if (!table) return take(table.error());
    study_.list_text = to_csv(*table);
    for (const Column& column : table->columns) {
      check_name(list, column.name);
      const auto scale = parse_any_quantity(column.unit.empty() ? "1" : "1 " + column.unit);
      if (!scale) {
        list.fail("unknown_unit", fmt::format("column {} has the unit {}, which is not known",
                                              in_quotes(column.name), in_quotes(column.unit)));
        continue;
      }
      StudyAxis axis{.name = column.name,
                     .unit = std::string(unit(scale->dimension)),
                     .values = column.values,
                     .words = {}};
      for (double& value : axis.values) {
        if (scale->value != 1) value *= scale->value;
        if (!std::isfinite(value)) {
          list.fail("missing_value", fmt::format("column {} has an empty cell; every sample needs a value",
                                                 in_quotes(column.name)));
          break;
        }
      }
      study_.axes.push_back(std::move(axis));
    }
    study_.samples = table->row_count();
    if (study_.samples == 0) list.fail("empty_list", "has no rows; give at least one sample");
  }

  void read_query() {
    if (const auto path = root_.optional("path"))
      study_.is_path = path->choice({"continue", "anew"}) == "continue";
    const Reader query =
        root_.required("query", "what is asked: {query: inverse, pose: {x: $x, y: 0, phi: 0}}");
    if (!query.is(Node::Kind::map)) {
      if (query.node()) query.refuse("wrong_type", "give the fields of a query as a map");
      return;
    }
    if (study_.axes.empty()) return;                // said already
    study_.query = {study_.source, *query.node()};  // errors then name its place
    std::vector<bool> is_used(study_.variable_count(), false);
    for (const Placeholder& place : placeholders(study_.query.root, study_.variable_names()))
      if (place.input)
        is_used[*place.input] = true;
      else
        query.fail("unknown_axis", fmt::format("${} is no axis; there are {}", place.name,
                                               fmt::join(study_.variable_names(), ", ")));
    for (const StudyDerived& derived : study_.derived)  // an axis may stand in one of them alone
      for (const Monomial& monomial : derived.is)
        for (const std::size_t column : monomial.columns) is_used[column] = true;
    for (std::size_t a = 0; a < study_.axes.size(); ++a)
      if (!is_used[a])
        query.fail("unused_axis", fmt::format("the axis {} is not in it; write ${} where its values go",
                                              study_.axes[a].name, study_.axes[a].name));
  }

  std::vector<std::string_view> axis_names() const {
    std::vector<std::string_view> names;
    for (const StudyAxis& axis : study_.axes) names.push_back(axis.name);
    return names;
  }

  void read_outputs() {
    const auto outputs = root_.optional("outputs");
    if (!outputs) return;
    for (auto& [name, place] : outputs->members()) {
      check_name(place, name);
      if (study_.find_variable(name))
        place.fail("duplicate_column", "is the name of an axis or derived value; give the output another");
      StudyOutput output{.name = name, .path = {}, .unit = {}};
      if (place.is(Node::Kind::map)) {
        output.path = place.required("path", "a place in the answer: pose.x").text();
        if (const auto unit = place.optional("unit")) output.unit = read_unit(*unit);
        if (const auto sometimes = place.optional("sometimes")) output.is_sometimes = sometimes->boolean();
        place.close();
      } else {
        output.path = place.text();
      }
      study_.outputs.push_back(std::move(output));
    }
    if (study_.outputs.empty())
      outputs->fail("empty_map", "names no output; leave it out for the usual ones");
  }

  void read_reduction() {
    auto reduce = root_.optional("reduce");
    if (!reduce) return;
    if (study_.sampling != Study::Sampling::grid) {
      reduce->fail("not_a_grid", "leaves out axes of a grid; random and listed samples have none");
      return;
    }
    std::vector<StudyAxis> kept = study_.axes, left_out;
    const Reader over = reduce->required("over", "axes to leave out: [phi]");
    if (over.is(Node::Kind::list) && over.node()->items.empty())
      over.fail("empty_list", "names no axis; give at least one, or remove reduce");
    for (const Reader& word : over.items()) {
      const std::string name = word.text();
      const auto axis = std::ranges::find(kept, name, &StudyAxis::name);
      if (axis == kept.end()) {
        word.fail("unknown_axis", fmt::format("is no axis; there are {}", fmt::join(axis_names(), ", ")));
        continue;
      }
      left_out.push_back(*axis);
      kept.erase(axis);
    }
    const Reader columns = reduce->required("columns", "what is kept: {worst: {max: condition}}");
    for (auto& [name, place] : columns.members()) {
      if (std::ranges::find(kept, name, &StudyAxis::name) != kept.end())
        place.fail("duplicate_column", "is the name of an axis that is kept; give the column another");
      read_reduced(name, place);
    }
    if (columns.node() && study_.reductions.empty())
      columns.fail("empty_map", "names no column; give at least one");
    reduce->close();
    study_.reduced_axes = left_out.size();
    kept.insert(kept.end(), left_out.begin(), left_out.end());
    order_axes(std::move(kept));  // the last run fastest: what becomes one value is computed together
  }

  /// The axes in another order; derived values know them by number.
  void order_axes(std::vector<StudyAxis> axes) {
    for (StudyDerived& derived : study_.derived)
      for (Monomial& monomial : derived.is)
        for (std::size_t& column : monomial.columns)
          if (column < axes.size())
            column = static_cast<std::size_t>(
                std::ranges::find(axes, study_.axes[column].name, &StudyAxis::name) - axes.begin());
    study_.axes = std::move(axes);
  }

  void read_reduced(const std::string& name, Reader& place) {
    check_name(place, name);
    StudyReduction reduction{.name = name};
    if (place.is(Node::Kind::string)) {
      place.choice({"part"});
      reduction.kind = StudyReduction::Kind::part;
    } else {
      using Kind = StudyReduction::Kind;
      int found = 0;
      for (const auto& [key, kind] :
           {std::pair{"max", Kind::max}, {"min", Kind::min}, {"mean", Kind::mean}, {"rms", Kind::rms}})
        if (const auto of = place.optional(key)) {
          ++found;
          reduction.kind = kind;
          const std::string column = of->text();
          const auto output = std::ranges::find(study_.outputs, column, &StudyOutput::name);
          if (output == study_.outputs.end())
            of->fail("unknown_column", study_.find_variable(of->text())
                                           ? "is an axis or a derived value; reductions are of outputs"
                                           : "is no output of this study; name it under outputs");
          reduction.output = static_cast<std::size_t>(output - study_.outputs.begin());
        }
      if (found != 1)
        place.fail("bad_reduction",
                   "is one of {max: COLUMN}, {min: COLUMN}, {mean: COLUMN}, {rms: COLUMN}, or part");
      if (place.is(Node::Kind::map)) place.close();
    }
    study_.reductions.push_back(std::move(reduction));
  }

  Errors errors_;
  Reader root_;
  fs::path folder_;
  Study& study_;
  std::span<const Member> set_;
};

}  // namespace

std::vector<std::string_view> builtin_study_names() {
  std::vector<std::string_view> names;
  for (const BuiltinFile& study : builtin_studies()) names.push_back(study.name);
  return names;
}

std::string_view builtin_study(std::string_view name) {
  const auto found = std::ranges::find(builtin_studies(), name, &BuiltinFile::name);
  return found == builtin_studies().end() ? std::string_view() : found->text;
}

Expected<Study> read_study(const std::string& path, std::span<const Member> set) {
  const std::string_view builtin = builtin_study(path);
  auto text = builtin.empty() ? read_text(path) : Expected<std::string>(builtin);
  if (!text) {
    Errors errors = std::move(text.error());
    if (path.find_first_of("./") == std::string::npos)  // looks like a name, not a file
      errors.front().message +=
          fmt::format(" Studies that come with sinew: {}.", fmt::join(builtin_study_names(), ", "));
    return tl::unexpected(std::move(errors));
  }
  const auto document = parse_yaml(*text, path);
  if (!document) return tl::unexpected(document.error());
  Study study;
  study.source = path;
  study.text = std::move(*text);
  if (Errors errors = StudyReader(*document, path, study, set).read(); !errors.empty())
    return tl::unexpected(std::move(errors));
  return study;
}

}  // namespace sinew::inline v1
