/// @file show_identified.hpp
/// What sinew identify found, as people read it and as JSON.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/analysis/identify.hpp"

namespace sinew::cli {

/// Turns of tendons up to this one are left to the fit [rad].
inline constexpr double far_turn = 0.5;

struct Identification {
  std::string_view model;
  std::string fit_names;  ///< as --fit has them
  std::vector<FitParameter> parameters = {};
  MeasuredRows rows = {};
  std::size_t blocks = 0;             ///< 0: rows have none
  std::optional<TendonMap> map = {};  ///< taken
  Identified found = {};
  int folds = 0;
  std::optional<HeldOut> held_out = {};
  double seconds = 0, held_out_seconds = 0;
};

/// @param is_quiet without times
std::string show_identified(const Identification& done, bool is_quiet);
/// @param output the file that was written; null: none
std::string identified_json(const Identification& done, const std::string* output);

}  // namespace sinew::cli
