/// @file identification.hpp
/// The whole of an identification: motors and axes as rows have them, the fit, and its judgement by rows that
/// were held out. The question `identify` and the command share it.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "query/answer/value.hpp"
#include "sinew/analysis/identify.hpp"

namespace sinew::inline v1 {

/// Turns of tendons up to this one are left to the fit [rad].
inline constexpr double far_turn = 0.5;
inline constexpr int usual_folds = 5, max_folds = 100;

struct Identification;

/// What is asked of rows.
struct IdentificationRequest {
  ArmModel model = ArmModel::cc;
  std::string fit_names = {};  ///< empty: what rows can usually tell
  double noise = 0;            ///< of a marker's coordinate [m]; 0: estimated
  int folds = 0;               ///< parts that are held out in turn, see `possible_folds`; 0: none
  bool take_map = false;       ///< motors and axes are taken as rows say
  std::optional<int> max_iterations = {};
  StopToken stop = {};
  /// Told before the fit, with what rows say of motors and axes, and what will be fitted.
  std::function<void(const Identification&)> begun = {};
  /// Told after each step of what is being done, how many steps there were, and the error so far [m].
  std::function<void(const std::string& part, int steps, double rms)> progress = {};
};

struct Identification {
  std::string_view model;
  std::string fit_names;
  std::vector<FitParameter> parameters = {};
  MeasuredRows rows = {};      ///< as they were fitted: counts turned where the map says so
  std::size_t blocks = 0;      ///< 0: rows have none
  TendonMap agrees_best = {};  ///< what rows say of motors and axes, small turns left out
  bool is_mapped = false;      ///< they were taken so
  Identified found = {};
  int folds = 0;
  std::optional<HeldOut> held_out = {};  ///< none where it was not asked, or a stop came
  double seconds = 0, held_out_seconds = 0;
};

std::string_view word_of(ArmModel model);
/// Of `word_of`, in the order of help.
std::span<const std::pair<std::string_view, ArmModel>> arm_model_words();

/// In how many parts these rows can be held out in turn: as many as asked, or as there are blocks; 0: none.
int possible_folds(const MeasuredRows& rows, int asked);
std::size_t block_count(const MeasuredRows& rows);

/// Codes: those of `fit_parameters` and `identify`.
Expected<Identification> run_identification(MeasuredArm arm, MeasuredRows rows,
                                            const IdentificationRequest& request);

/// `counts positive where tendons are paid out, ...`; empty where they are as given.
std::string words_of(const TendonMap& map);
/// Whether rows agree clearly better with another map than as they are given.
bool is_clear(const TendonMap& map);
/// What was computed and is likely not meant, a sentence each.
std::vector<std::string> remarks_of(const MeasuredArm& arm, const MeasuredRows& rows, std::size_t parameters);

/// Whether the arm stands at some row at all.
bool is_worth_keeping(const Identification& done);
/// Why it is no complete fit; empty where it is one.
std::string why_incomplete(const Identification& done);
/// A combination, its largest parts first, the first of them positive: `0.8 bending - 0.6 compliance`.
std::string combination(const FlatDirection& flat, const std::vector<FitParameter>& parameters);

/// The arm's file as text, with comments that say whence it is.
/// @param rows_name where the rows are from
Expected<std::string> fitted_file(const Identification& done, std::string_view rows_name);

/// The answer, without `query`, `robot`, rows and file.
void put_identification(const Identification& done, Value& answer);

}  // namespace sinew::inline v1
