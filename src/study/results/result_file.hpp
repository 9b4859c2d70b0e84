/// @file result_file.hpp
/// Files of results: columns with units, what they were made from, and what was fitted to them.
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "query/batch/sampler.hpp"
#include "sinew/study/sweep.hpp"

namespace sinew::inline v1 {

/// A named text of the provenance.
struct Fact {
  std::string name, text;
};

/// What a file of results will hold.
struct ResultLayout {
  struct Axis {
    std::string name, unit;
    std::vector<double> values;  ///< of a grid; empty where the axis is a column
  };
  struct Column {
    std::string name, unit;
  };
  std::string title;
  std::vector<Axis> axes;  ///< of a grid the last runs fastest
  std::vector<Column> columns;
  bool is_grid = false;
  bool has_status = false;
  std::size_t rows = 0;
  int compression = 0;  ///< 0 to 9
  std::vector<Fact> provenance;
};

/// A stretch of rows.
struct ResultRows {
  std::size_t first = 0, count = 0;
  std::span<const double> axes, columns;   ///< column after column
  std::span<const SampleStatus> statuses;  ///< empty without
};

/// Written beside the final name and put there when it is complete.
class ResultFile {
 public:
  virtual ~ResultFile() = default;
  virtual Expected<void> begun() const = 0;  ///< whether it could be created
  virtual bool wants_axes() const = 0;       ///< of rows
  virtual Expected<void> write(const ResultRows& rows) = 0;
  /// Code `write_failed`; the file of an earlier run then is still there.
  virtual Expected<void> finish(std::span<const FittedTerms> fits) = 0;
};

/// By the file's ending: `.h5` or `.csv`. Codes: `unknown_format`, `file_unwritable`.
Expected<std::unique_ptr<ResultFile>> create_result(const std::filesystem::path& path, ResultLayout layout);
Errors refuse_result_name(const std::filesystem::path& path);

std::unique_ptr<ResultFile> create_csv(const std::filesystem::path& path, ResultLayout layout);
std::unique_ptr<ResultFile> create_hdf5(const std::filesystem::path& path, ResultLayout layout);

/// The fact of that name in a finished file; empty where there is none.
std::string recorded_fact(const std::filesystem::path& path, const std::string& name);
std::string recorded_hdf5_fact(const std::filesystem::path& path, const std::string& name);

}  // namespace sinew::inline v1
