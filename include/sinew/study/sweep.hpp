/// @file sweep.hpp
/// A study run: its samples computed on all cores, or by the ranks of a cluster, into a file of results. The
/// data depend on the study and the instruction set alone, never on who computed them. docs/studies.md
#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

class Ranks;

/// How far a sweep is.
struct SweepProgress {
  std::size_t done = 0, total = 0;  ///< samples
  std::size_t resumed = 0;          ///< of them, those of an earlier run
  double seconds = 0;               ///< since this run began [s]
};

/// Where results go, and who computes.
struct SweepOptions {
  std::filesystem::path output = {};  ///< `.h5` or `.csv`; the chunks are in `output.log` until it is written
  bool resume = false;                ///< go on with the chunks of an earlier run; without any, begin
  bool replaces_results = true;       ///< else a sweep is not begun whose file is there; code `result_exists`
  int threads = 0;                    ///< of this process; 0: one a core
  int compression = 0;                ///< of HDF5, 0 (none) to 9
  std::string command = {};           ///< for the provenance
  Ranks* ranks = nullptr;             ///< of a cluster; null: this process alone
  /// Called twenty times a second, from a thread of its own; false stops the sweep.
  std::function<bool(const SweepProgress&)> progress = {};
};

/// What a fit leaves of one of its columns.
struct FittedColumn {
  std::string name, unit;
  std::string text;     ///< what it was taken for; empty where the terms say all
  double rms = 0;       ///< root mean square of the residuals, in `unit`
  double largest = 0;   ///< the largest of them, in `unit`
  double relative = 0;  ///< ratio: `rms` over the root mean square of the column itself
};

/// A fit, done.
struct FittedTerms {
  std::string name, unit;  ///< of the columns fitted; empty where they differ
  std::vector<std::string> terms;
  std::vector<double> coefficients;  ///< one a term, in SI
  std::vector<double> deviations;    ///< standard deviations, in SI; NaN where coefficients were given
  bool is_given = false;             ///< coefficients of the study, nothing fitted
  double rms = 0;                    ///< root mean square of the residuals of all columns, in `unit`
  double largest = 0;                ///< the largest of them, in `unit`
  std::size_t samples = 0;           ///< with all columns
  std::vector<FittedColumn> columns;
};

/// What a sweep did, and what its fits are.
struct SweepSummary {
  bool is_complete = false;   ///< else it was stopped; `resume` goes on
  bool was_complete = false;  ///< there was nothing left to do
  std::size_t samples = 0, resumed = 0;
  std::array<std::size_t, 12> statuses{};  ///< samples a status, see `sample_status_name`
  bool counts_all = true;                  ///< else they are of this run, without what was resumed
  std::vector<FittedTerms> fits;
  double computing = 0;  ///< [s] on the wall, the mean of the threads
  double logging = 0;  ///< [s] appending chunks to a log that the file is made from; none where rows go into
                       ///< the file at once
  double writing = 0;  ///< [s] making the file of results
  double total = 0;    ///< [s]
  std::uint64_t logged_bytes = 0, written_bytes = 0;
  int threads = 0, ranks = 1;
  std::string sampler, instruction_set;
  std::string warning;
};

/// `converged`, `unreachable`, ..., and `refused`, `failed`, `left_out`.
SINEW_API std::string_view sample_status_name(std::size_t status);

/// The columns a sweep of this study gives, with what the file leaves out filled in from a trial.
struct SweepColumns {
  std::vector<std::size_t> dimensions;  ///< of each column; samples of a list or at random: one
  std::vector<std::pair<std::string, std::string>> axes, columns;  ///< name and unit
  std::string sampler;
  std::size_t chunk = 0, chunks = 0;
  std::string warning;
};
/// What a sweep of this study will write, without running it but for a trial. Codes: those of `sweep`.
SINEW_API Expected<SweepColumns> sweep_columns(Study study);

/// Runs a study. Errors of the study, its file of results and its log; samples that fail are no errors but
/// have their status. Code `write_failed`: the disc is full, say; what was computed is kept, `resume` goes
/// on.
SINEW_API Expected<SweepSummary> sweep(Study study, const SweepOptions& options);

/// Chooses the instruction set of all that runs in lanes: `baseline` (SSSE3), `avx2`, `avx512` or `native`.
/// False where this machine has not got it. To be called before anything is computed.
SINEW_API bool use_instruction_set(std::string_view name);
/// Its name: `AVX2`, `AVX-512`, ...
SINEW_API std::string_view instruction_set_in_use();

}  // namespace sinew::inline v1
