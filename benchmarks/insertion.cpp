/// Ways into the stand-in for a compressor by five seeds, into ten that are drawn at random, and through
/// plates with holes, easier and harder. Each way is checked by FCL. Run: build/dev/bin/bench_insertion
/// [SCENES]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "plan/compressor.hpp"
#include "scenes.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/plan/insertion.hpp"

namespace sinew::bench {
namespace {

InsertionScene scene_of(const Compressor& compressor) {
  return compressor_scene(compressor, load_serial(compressor.robot).value());
}

/// Seconds; negative where no way was found.
double run(const std::string& name, const InsertionScene& scene, std::uint64_t seed) {
  InsertionOptions options;
  options.seed = seed;
  const InsertionPlan plan = plan_insertion(scene, options);
  if (plan.report.ok())
    fmt::print(
        "{:<12} seed {}  {:<18} clearance {:.3f} mm, tip off {:.4f} mm, {:3} steps, {:4} starts, {} ways, "
        "{:5.2f} s\n",
        name, seed, to_string(plan.check.verdict), 1e3 * plan.check.clearance, 1e3 * plan.tip_error,
        plan.steps.size(), plan.starts, plan.ways, plan.seconds);
  else
    fmt::print("{:<12} seed {}  {:<18} {} ({:.2f} s)\n", name, seed, to_string(plan.report.status),
               plan.report.message.view(), plan.seconds);
  std::fflush(stdout);
  return plan.report.ok() ? plan.seconds : -1;
}

void summary(const char* what, std::vector<double> seconds) {
  const std::size_t tried = seconds.size();
  std::erase_if(seconds, [](double s) { return s < 0; });
  std::sort(seconds.begin(), seconds.end());
  if (seconds.empty()) return fmt::print("{}: none of {} found\n", what, tried);
  fmt::print("{}: {} of {} found; median {:.2f} s, slowest {:.2f} s\n", what, seconds.size(), tried,
             seconds[seconds.size() / 2], seconds.back());
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew;
  std::vector<double> seconds;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    seconds.push_back(bench::run("stand-in", bench::scene_of(Compressor{}), seed));
  bench::summary("stand-in, 5 seeds", seconds);
  seconds.clear();
  const int scenes = argc > 1 ? std::atoi(argv[1]) : 10;
  for (int scene = 1; scene <= scenes; ++scene)
    seconds.push_back(bench::run(fmt::format("drawn {}", scene),
                                 bench::scene_of(drawn_compressor(static_cast<std::uint64_t>(scene))), 1));
  bench::summary(fmt::format("{} drawn scenes", scenes).c_str(), seconds);
  for (const auto& [name, slalom] : {std::pair{"4 holes of 10 mm", test::Slalom{}},
                                     {"5 holes of 11 mm", {5, 11e-3, 10e-3, 28e-3}},
                                     {"4 holes of 10 mm, farther off", {4, 10e-3, 14e-3, 30e-3}}}) {
    seconds.clear();
    for (int scene = 1; scene <= scenes; ++scene)
      seconds.push_back(bench::run(fmt::format("holes {}", scene),
                                   test::slalom_of(slalom, static_cast<std::uint64_t>(scene)), 1));
    bench::summary(name, seconds);
  }
}
