/// @file study_support.hpp
/// Studies written in tests, and sweeps of them.
#pragma once
#include <fstream>
#include <stdexcept>
#include <string>

#include "sinew/study/study.hpp"
#include "sinew/study/sweep.hpp"
#include "study_folder.hpp"

namespace sinew::test {

inline Expected<Study> study_of(const Folder& folder, const std::string& text,
                                const std::string& name = "study.yaml") {
  const auto path = folder.path / name;
  std::ofstream(path, std::ios::binary) << text;
  return read_study(path.string());
}

inline Expected<SweepSummary> sweep_to(const Folder& folder, const std::string& text,
                                       const std::string& output, SweepOptions options = {}) {
  auto study = study_of(folder, text);
  if (!study) return tl::unexpected(study.error());
  options.output = folder.path / output;
  return sweep(std::move(*study), options);
}

/// The column of that name, which there must be.
inline const Column& column(const Table& table, std::string_view name) {
  const Column* found = table.find(name);
  if (!found) throw std::runtime_error("no column " + std::string(name));
  return *found;
}

}  // namespace sinew::test
