/// Sweeps as people run them, into files: a million equilibria of the 3PFS, ten million poses of the 3-RFR
/// into maps of them, and the same kept whole. Computing and writing apart, beside named baselines of the
/// same run: queries one by one, one thread, and the disc. Run: build/dev/bin/bench_sweep [folder]
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sinew/study/study.hpp"
#include "sinew/study/sweep.hpp"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

constexpr int runs = 5;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

std::string rods(int count, const char* more = "") {
  std::string text = fmt::format(
      "sinew: 1\nrobot: 3pfs-g2\nquery: {{query: forward, inputs: [$a, $b, $c]{}}}\naxes:\n", more);
  for (const char* name : {"a", "b", "c"})
    text += fmt::format("  {}: {{from: 400 mm, to: 460 mm, count: {}}}\n", name, count);
  return text;
}

/// Poses that can nearly all be reached, or few of them are worth the name of a throughput.
std::string poses(int count, int turns, const char* more = "") {
  return fmt::format(R"(sinew: 1
robot: 3-rfr
query: {{query: velocity, pose: {{x: $x, y: $y, phi: $phi}}{}}}
axes:
  y: {{from: -30 mm, to: 30 mm, count: {}}}
  x: {{from: -30 mm, to: 30 mm, count: {}}}
  phi: {{from: -20 deg, to: 40 deg, count: {}}}
outputs: {{determinant: determinant, raw: indices.condition, condition: indices.condition_homogenised, position: indices.position, rotation: indices.rotation}}
)",
                     more, count, count, turns);
}
constexpr const char* maps = R"(reduce:
  over: [phi]
  columns: {worst: {max: condition}, raw: {max: raw}, least: {min: determinant}, fastest: {max: position}, turns: {max: rotation}, reached: part}
)";

SweepSummary run(const std::string& text, const fs::path& output, int threads) {
  const fs::path file = output.parent_path() / "study.yaml";
  std::ofstream(file) << text;
  auto done = sweep(read_study(file.string()).value(), {.output = output, .threads = threads});
  if (!done) {
    fmt::print("{}\n", to_string(done.error()));
    std::exit(1);
  }
  return *done;
}

/// Writing bytes and having them on the disc [B/s].
double disc_rate(const fs::path& folder, std::size_t size) {
  const fs::path path = folder / "disc.tmp";
  const std::vector<char> block(1 << 20, 'x');
  const auto begin = std::chrono::steady_clock::now();
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::size_t written = 0;
  while (written < size) {
    const ssize_t done = ::write(file, block.data(), block.size());
    if (done <= 0) break;
    written += static_cast<std::size_t>(done);
  }
  ::fsync(file);
  ::close(file);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fs::remove(path);
  return static_cast<double>(written) / seconds;
}

/// Samples a second of computing on one thread and on all cores, alternating; the efficiency of the latter.
void throughput(const char* what, const std::string& text, const std::string& by_query,
                const fs::path& folder) {
  std::vector<double> one, all, efficiency;
  SweepSummary last;
  for (int k = 0; k < runs; ++k) {
    const SweepSummary single = run(text, folder / "out.h5", 1);
    last = run(text, folder / "out.h5", 0);
    const auto rate = [](const SweepSummary& of) { return static_cast<double>(of.samples) / of.computing; };
    one.push_back(rate(single));
    all.push_back(rate(last));
    efficiency.push_back(rate(last) / rate(single) / last.threads);
  }
  const SweepSummary slow = run(by_query, folder / "out.h5", 1);
  const double base = static_cast<double>(slow.samples) / slow.computing;
  fmt::print("{:<36} {:>10.3g} {:>10.3g} {:>10.2f} {:>12.3g} {:>8.0f}  {}\n", what, median(one), median(all),
             median(efficiency), base, median(one) / base, last.instruction_set);
}

/// Data a second into the file of results, beside the disc.
void writing(const std::string& text, const fs::path& folder) {
  std::vector<double> rates, discs;
  std::size_t size = 0;
  for (int k = 0; k < 3; ++k) {
    const SweepSummary done = run(text, folder / "out.h5", 0);
    size = done.written_bytes;
    rates.push_back(static_cast<double>(size) / (done.logging + done.writing));
    discs.push_back(disc_rate(folder, size));
  }
  fmt::print(
      "\nwriting {:.0f} MB of results, until they are on the disc: {:.0f} MB/s; the disc {:.0f} MB/s, ratio "
      "{:.2f}\n",
      static_cast<double>(size) / 1e6, median(rates) / 1e6, median(discs) / 1e6,
      median(rates) / median(discs));
}

/// Peak memory grows once, whatever the number of samples.
double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// What a column of one file misses of that of another.
double worst_difference(const fs::path& a, const fs::path& b) {
  const Table one = read_result(a).value(), other = read_result(b).value();
  double worst = 0;
  for (std::size_t c = 0; c < one.columns.size(); ++c)
    for (std::size_t k = 0; k < one.row_count(); ++k) {
      const double x = one.columns[c].values[k], y = other.columns[c].values[k];
      if (std::isfinite(x) && std::isfinite(y))
        worst = std::max(worst, std::abs(x - y) / std::max(1.0, std::abs(y)));
    }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  const fs::path folder =
      (argc > 1 ? fs::path(argv[1]) : fs::temp_directory_path()) / fmt::format("bench_sweep_{}", getpid());
  fs::create_directories(folder);
  constexpr const char* one_by_one = ", max_iterations: 4000";  // more than the quick samplers read
  fmt::print("{:<36} {:>10} {:>10} {:>10} {:>12} {:>8}\n", "samples/s of computing, into a file", "1 thread",
             "all", "efficiency", "query [1/s]", "ratio");
  run(rods(31), folder / "small.h5", 0);
  const double before = peak_megabytes();
  throughput("3PFS, 1.03e6 equilibria", rods(101), rods(15, one_by_one), folder);
  throughput("3-RFR, 1.00e7 poses into maps", poses(200, 251) + maps, poses(30, 31, one_by_one) + maps,
             folder);
  const double after = peak_megabytes();
  writing(poses(200, 251), folder);
  fmt::print("memory: {:.0f} MB after 3e4 samples, {:.0f} MB after 1e6 and 1e7\n", before, after);
  run(rods(15), folder / "lanes.h5", 0);
  run(rods(15, one_by_one), folder / "queries.h5", 0);
  fmt::print("accuracy: lanes and queries differ by {:.1e} (3PFS)",
             worst_difference(folder / "lanes.h5", folder / "queries.h5"));
  run(poses(20, 21), folder / "lanes.h5", 0);
  run(poses(20, 21, one_by_one), folder / "queries.h5", 0);
  fmt::print(", {:.1e} (3-RFR, relative)\n", worst_difference(folder / "lanes.h5", folder / "queries.h5"));
  fs::remove_all(folder);
}
