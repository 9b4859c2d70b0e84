/// Study files into Study.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "sinew/analysis/singularity_map.hpp"
#include "sinew/io/parse.hpp"
#include "sinew/io/quantity.hpp"
#include "sinew/io/reader.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/study/study.hpp"
#include "study/builtin.hpp"
#include "study/samplers/placeholders.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v0 {
namespace {

namespace fs = std::filesystem;

constexpr double most_samples = 1e12, most_values = 1e7;

bool is_name(std::string_view text) {
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && !(text[0] >= '0' && text[0] <= '9') && std::ranges::all_of(text, is_part);
}

void check_name(const Reader& place, std::string_view name) {
  for (const std::string_view taken : {"status", "provenance", "fits"})
    if (name == taken)
      place.fail("bad_name", fmt::format("{} has its own place in the results; choose another name", name));
  if (!is_name(name))
    place.fail("bad_name", fmt::format("{} names no column; give letters, digits and _", in_quotes(name)));
}

/// What may stand in a heading.
std::string read_unit(const Reader& place) {
  std::string unit = place.text();
  if (unit.find_first_of(",[]\"\n\r#") != std::string::npos)
    place.fail("bad_unit", "has a character that a heading cannot hold; give a symbol like N/m");
  return unit;
}

/// Values of one axis, whose units must agree.
class AxisReader {
 public:
  AxisReader(StudyAxis& axis, std::string unit) : axis_(axis), unit_(std::move(unit)) {}

  double value(const Reader& place) {
    if (!place.node()) return 0;
    if (!place.is(Node::Kind::number) && !place.is(Node::Kind::string)) {
      place.refuse("wrong_type", "give a number or a text with a unit (60 mm, 30 deg)");
      return 0;
    }
    const bool is_bare = place.is(Node::Kind::number) && !unit_.empty();
    const auto read = parse_any_quantity(is_bare ? place.node()->text + ' ' + unit_ : place.node()->text);
    if (!read) {
      place.fail(read.error().front().code, read.error().front().message);
      return 0;
    }
    const std::string unit(v0::unit(read->dimension));
    if (axis_.unit.empty()) axis_.unit = unit;
    if (!unit.empty() && unit != axis_.unit)
      place.fail("wrong_dimension",
                 fmt::format("is in {}, but the axis is in {}; give one unit", unit, axis_.unit));
    return read->value;
  }

 private:
  StudyAxis& axis_;
  std::string unit_;
};

/// `{from: -60 mm, to: 60 mm, count: 121}`, as an axis of a map has it.
void read_steps(Reader& place, AxisReader& values, StudyAxis& axis) {
  const double from = values.value(place.required("from", "first value"));
  const double to = values.value(place.required("to", "last value"));
  const int count =
      place.required("count", "how many values, both ends included").integer(Range::between(1, most_values));
  const MapAxis steps{.from = from, .to = to, .count = count};
  for (int k = 0; k < count; ++k) axis.values.push_back(steps.at(k));
}

void read_distribution(Reader& place, AxisReader& values, StudyAxis& axis) {
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

StudyAxis read_axis(const std::string& name, Reader place, bool is_random) {
  StudyAxis axis{.name = name, .unit = {}, .values = {}};
  check_name(place, name);
  if (place.is(Node::Kind::list)) {
    AxisReader values(axis, {});
    for (const Reader& item : place.items()) axis.values.push_back(values.value(item));
    if (axis.values.empty()) place.fail("empty_list", "has no values; give at least one");
    if (is_random) place.fail("not_random", "is a list; a random axis is {from, to} or {mean, deviation}");
    return axis;
  }
  const auto unit = place.optional("unit");
  AxisReader values(axis, unit ? unit->text() : std::string());
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
    read_query();
    read_outputs();
    read_reduction();
    read_fits();
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
                            .quantity(Dimension::count, {.low = 1, .high = most_samples})));
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
    if (product > most_samples)
      axes.fail("too_large", fmt::format("span {:.3g} samples; {:.0e} at most", product, most_samples));
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
      StudyAxis axis{
          .name = column.name, .unit = std::string(unit(scale->dimension)), .values = column.values};
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
    std::vector<bool> is_used(study_.axes.size(), false);
    for (const Placeholder& place : placeholders(study_.query.root, study_.axes))
      if (place.axis)
        is_used[*place.axis] = true;
      else
        query.fail("unknown_axis",
                   fmt::format("${} is no axis; there are {}", place.name, fmt::join(axis_names(), ", ")));
    for (std::size_t a = 0; a < is_used.size(); ++a)
      if (!is_used[a])
        query.fail("unused_axis", fmt::format("the axis {} is not in it; write ${} where its values go",
                                              study_.axes[a].name, study_.axes[a].name));
  }

  std::vector<std::string_view> axis_names() const {
    std::vector<std::string_view> names;
    for (const StudyAxis& axis : study_.axes) names.push_back(axis.name);
    return names;
  }

  std::vector<std::string_view> column_names() const {
    std::vector<std::string_view> names = axis_names();
    for (const StudyOutput& output : study_.outputs) names.push_back(output.name);
    return names;
  }

  void read_outputs() {
    const auto outputs = root_.optional("outputs");
    if (!outputs) return;
    for (auto& [name, place] : outputs->members()) {
      check_name(place, name);
      if (std::ranges::find(study_.axes, name, &StudyAxis::name) != study_.axes.end())
        place.fail("duplicate_column", "is the name of an axis; give the output another");
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
    study_.axes = std::move(kept);  // the last run fastest: what becomes one value is computed together
    study_.axes.insert(study_.axes.end(), left_out.begin(), left_out.end());
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
            of->fail("unknown_column", "is no output of this study; name it under outputs");
          reduction.output = static_cast<std::size_t>(output - study_.outputs.begin());
        }
      if (found != 1)
        place.fail("bad_reduction",
                   "is one of {max: COLUMN}, {min: COLUMN}, {mean: COLUMN}, {rms: COLUMN}, or part");
      if (place.is(Node::Kind::map)) place.close();
    }
    study_.reductions.push_back(std::move(reduction));
  }

  void read_fits() {
    const auto fits = root_.optional("fits");
    if (!fits) return;
    if (!study_.reductions.empty())
      fits->fail("not_available", "are of samples, and reduce keeps none; make two studies");
    const auto names = column_names();
    for (auto& [name, place] : fits->members()) {
      check_name(place, name);
      StudyFit fit{.name = name, .texts = {}, .terms = {}};
      const auto of = place.optional("of");
      const std::string column = of ? of->text() : name;
      const auto found = std::ranges::find(names, std::string_view(column));
      if (found == names.end())
        place.fail("unknown_column",
                   fmt::format("{} is no axis or output; name it under outputs", in_quotes(column)));
      fit.column = static_cast<std::size_t>(found - names.begin());
      for (const Reader& term : place.required("terms", "what it is a sum of: [1, e1, e1^2]").items()) {
        const std::string text = term.node()->text;
        auto monomials = parse_term(text, names);
        if (!monomials) term.fail(monomials.error().front().code, monomials.error().front().message);
        fit.texts.push_back(text);
        fit.terms.push_back(monomials ? std::move(*monomials) : std::vector<Monomial>{});
      }
      if (fit.terms.empty()) place.fail("empty_list", "has no terms; give at least one: terms: [1]");
      place.close();
      study_.fits.push_back(std::move(fit));
    }
  }

  Errors errors_;
  Reader root_;
  fs::path folder_;
  Study& study_;
  std::span<const Member> set_;
};

}  // namespace

std::size_t Study::reduced_samples() const {
  std::size_t product = 1;
  for (std::size_t a = axes.size() - reduced_axes; a < axes.size(); ++a) product *= axes[a].values.size();
  return product;
}

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

}  // namespace sinew::inline v0
