/// @file study.hpp
/// Study files: one query put at many samples. Axes name what varies, outputs what is kept of the answers;
/// reductions and fits say what is made of them; and files of results as tables: a line a sample, the axes
/// written out. Format: docs/studies.md
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {

/// What varies from sample to sample; it stands in the query as `$name`.
struct StudyAxis {
  /// Where its values come from.
  enum class Kind {
    values,   ///< of a grid, or a column of a list
    uniform,  ///< random, from `low` to `high`
    normal,   ///< random, of mean `low` and standard deviation `high`
  };
  std::string name;
  std::string unit;  ///< SI; empty for a plain number
  Kind kind = Kind::values;
  std::vector<double> values;      ///< in `unit`; of words 0, 1, ...
  std::vector<std::string> words;  ///< what `values` count, where texts go into the query
  double low = 0;                  ///< least value, or mean, in `unit`
  double high = 0;                 ///< largest value, or standard deviation, in `unit`
};

/// A column of the results: a number of the answer.
struct StudyOutput {
  std::string name;
  std::string path;           ///< in the answer: `pose.position[2]`; of a list `type_1.count` is its length
  std::string unit;           ///< SI; empty for a plain number
  bool is_sometimes = false;  ///< there in few answers only, so that none of a trial needs to have it
};

/// What becomes of a column when axes are left out.
struct StudyReduction {
  /// `part`: the share of those not left out that converged; it has no column.
  enum class Kind { max, min, mean, rms, part };
  std::string name;
  Kind kind = Kind::max;
  std::size_t output = 0;  ///< index of the column
};

/// A product of powers of columns, with a factor.
struct Monomial {
  double factor = 1;                 ///< in SI
  std::vector<std::size_t> columns;  ///< one entry a power; numbers of columns, see Study
};

/// A polynomial of the axes, which stands in the query as `$name` like one of them.
struct StudyDerived {
  std::string name;
  std::string unit;                                       ///< SI; empty for a plain number
  std::vector<Monomial> is;                               ///< of axes and of derived values above
  double low = -std::numeric_limits<double>::infinity();  ///< in `unit`; below it a sample is left out
  double high = std::numeric_limits<double>::infinity();  ///< in `unit`; above it as well
};

/// A column as a sum of terms, each with a coefficient of its fit.
struct FitEquation {
  std::size_t column = 0;
  std::string text;                          ///< as written; empty where the coefficients say all
  std::vector<std::vector<Monomial>> terms;  ///< one a coefficient; empty where that is not in it
};

/// One column or several by least squares, with the same coefficients.
struct StudyFit {
  std::string name;
  std::vector<std::string> coefficients;  ///< names, or where there is one column its terms: `e1^2 - e2^2`
  std::vector<double> known;  ///< their values in SI where they are given; empty where they are fitted
  std::vector<FitEquation> equations;  ///< one a column
};

/// A study file, read.
struct Study {
  /// How samples are chosen: all of a grid, at random, or those of a table.
  enum class Sampling { grid, random, listed };

  std::string title;
  std::string source;       ///< the file
  std::string text;         ///< what it says
  std::string robot;        ///< built-in name or file
  std::string robot_text;   ///< its file
  std::string list_text;    ///< the table of the samples, if there is one
  Document robot_document;  ///< with the study's `set`
  Document query;           ///< with `$name` where axes go
  Sampling sampling = Sampling::grid;
  std::vector<StudyAxis> axes;  ///< the last runs fastest
  std::vector<StudyDerived> derived;
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  bool is_path = true;  ///< neighbours continue each other's solution
  std::vector<StudyOutput> outputs;
  std::vector<StudyReduction> reductions;
  std::size_t reduced_axes = 0;  ///< the last so many axes are left out by the reductions
  std::vector<StudyFit> fits;

  /// Samples that become one value of each reduction.
  SINEW_API std::size_t reduced_samples() const;

  /// @name Columns by their numbers: axes, then derived values, then outputs
  /// @{

  /// Axes and derived values: what `$name` may stand for.
  std::size_t variable_count() const { return axes.size() + derived.size(); }
  SINEW_API std::vector<std::string> variable_names() const;  ///< theirs, in order
  /// All columns.
  std::size_t column_count() const { return variable_count() + outputs.size(); }
  SINEW_API const std::string& column_name(std::size_t column) const;  ///< column < column_count()
  SINEW_API const std::string& column_unit(std::size_t column) const;  ///< SI; empty for a plain number
  /// The axis or derived value of this name.
  SINEW_API std::optional<std::size_t> find_variable(std::string_view name) const;
  /// @}
};

/// Names and texts of the studies that are part of the library: those of studies/*.yaml.
SINEW_API std::vector<std::string_view> builtin_study_names();
SINEW_API std::string_view builtin_study(std::string_view name);  ///< empty where there is none

/// A study file, or one of that name, with its robot and its table of samples. Everything wrong with it at
/// once. Codes: those of `read_file` and of robot files, `unknown_axis`, `unused_axis`, `unknown_column`,
/// `bad_term`, `later_column`, `unused_coefficient`, ...
/// @param set changes of the robot, `{path: value}`, over the study's own
SINEW_API Expected<Study> read_study(const std::string& path_or_name, std::span<const Member> set = {});

/// An HDF5 file as `sweep` writes it, or any whose root has columns of numbers of one shape, with dimension
/// scales or without: axes first, then columns in the order of their creation; `status` is its code. Codes:
/// `file_missing`, `file_unreadable`, `no_columns`.
SINEW_API Expected<Table> read_hdf5(const std::filesystem::path& path);

/// A file of results by its ending: `.h5` or `.csv`.
SINEW_API Expected<Table> read_result(const std::filesystem::path& path);

/// Writes one, by its ending: `.h5` or `.csv`. The first comment of the table is its title, others like
/// `seed: 3` are facts of its provenance. Codes: `unknown_format`, `file_unwritable`, `write_failed`.
SINEW_API Expected<void> write_result(const Table& table, const std::filesystem::path& path);

}  // namespace sinew::inline v1
