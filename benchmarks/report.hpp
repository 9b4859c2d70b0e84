/// @file report.hpp
/// Benchmarks as ratios: every row beside its named baseline of the same run, with the accuracy reached.
/// Machines are noisy; medians of repetitions are shown and the ratio is what to compare between machines.
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace sinew::bench {

struct Row {
  std::string what, baseline;               ///< names; the baseline says what it is
  std::function<void()> run, run_baseline;  ///< one operation each
  std::string accuracy;                     ///< what was reached, in words and numbers
  double items = 1;                         ///< in one operation of ours; times are of one of them
  std::string published = {};               ///< what a public code takes for it, of docs/performance.md
  double baseline_items = 1;                ///< in one operation of the baseline
  bool has_threads = false;                 ///< then times are those of the clock, not of the processor
};

inline std::vector<Row>& rows() {
  static std::vector<Row> all;
  return all;
}

/// Registers an operation and its baseline.
inline void compare(Row row) { rows().push_back(std::move(row)); }

/// Keeps the medians of all repetitions by name.
class Medians : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.aggregate_name == "median")
        nanoseconds[run.run_name.function_name] =
            run.run_name.time_type == "real_time" ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime();
  }
  std::map<std::string, double> nanoseconds;
};

/// 99.9th percentile of single operations [ns]; includes the clock's own 20 to 30 ns. 0 where a thousand
/// operations of so many ns would take too long.
inline double slowest_of_1000(const std::function<void()>& run, double typical) {
  constexpr double patience = 8e9;  // ns
  const auto count = static_cast<std::size_t>(std::min(20000.0, patience / typical));
  if (count < 1000) return 0;
  std::vector<double> times(count);
  for (double& time : times) {
    const auto start = std::chrono::steady_clock::now();
    run();
    time = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }
  const auto slow = times.end() - static_cast<std::ptrdiff_t>(count / 1000);
  std::nth_element(times.begin(), slow, times.end());
  return *slow;
}

/// Runs all and prints the table.
inline int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const auto add = [](const Row& row, const std::string& name, const std::function<void()>& run) {
    auto* added = benchmark::RegisterBenchmark(name.c_str(),
                                               [&run](benchmark::State& state) {
                                                 for (auto _ : state) run();
                                               })
                      ->MinTime(0.05)
                      ->Repetitions(9)
                      ->ReportAggregatesOnly(true);
    if (row.has_threads) added->UseRealTime();
  };
  for (const Row& row : rows()) {
    add(row, row.what, row.run);
    add(row, row.what + " / " + row.baseline, row.run_baseline);
  }
  Medians medians;
  benchmark::RunSpecifiedBenchmarks(&medians);
  std::printf("%-44s %10s %10s %12s %7s  %s\n", "operation", "median[ns]", "p99.9[ns]", "baseline[ns]",
              "ratio", "baseline; accuracy");
  for (const Row& row : rows()) {
    const double operation = medians.nanoseconds[row.what], ours = operation / row.items,
                 theirs = medians.nanoseconds[row.what + " / " + row.baseline] / row.baseline_items;
    if (ours == 0) continue;  // filtered out
    const double slow = slowest_of_1000(row.run, operation);
    const double ratio = theirs / ours;
    std::printf("%-44s %10.0f %10s %12.0f %7.*f  %s; %s%s%s\n", row.what.c_str(), ours,
                slow > 0 ? std::to_string(std::lround(slow / row.items)).c_str() : "-", theirs,
                ratio < 2 ? 2 : 1, ratio, row.baseline.c_str(), row.accuracy.c_str(),
                row.published.empty() ? "" : "; ", row.published.c_str());
  }
  std::printf("Baselines are what one writes first from a paper. Public codes: docs/performance.md\n");
  return 0;
}

}  // namespace sinew::bench
