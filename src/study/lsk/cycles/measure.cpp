#include "study/lsk/cycles/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include "io/export/export.hpp"
#include "io/file/process.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/builtin.hpp"

namespace sinew::inline v1::lsk {
namespace {

namespace fs = std::filesystem;

constexpr double millimetres = 1e3;
constexpr int samples = 48;
constexpr const char* max_cycles = "100000000000";  // the program ends by itself

/// Table 2 with so many sections.
SerialRobot robot_of(const std::string& name, int sections) {
  SerialRobot robot = load_serial(name).value();
  const Section first = robot.sections[0];
  const double turn = first.tendon_angle;
  robot.sections.assign(static_cast<std::size_t>(sections), first);
  for (int m = 0; m < sections; ++m)
    robot.sections[static_cast<std::size_t>(m)].tendon_angle = (m + 1) * turn;
  return robot;
}

/// The two robots of a program, and how its integers are read.
struct Robots {
  SerialRobot twin, neutral;
  ControllerTable twin_table, neutral_table;

  explicit Robots(int sections)
      : twin(robot_of("nottingham-tpcj", sections)),
        neutral(robot_of("nottingham-neutral", sections)),
        twin_table(make_controller_table(twin).value()),
        neutral_table(make_controller_table(neutral).value()) {}
};

/// A sample: bends of both robots, in doubles.
struct Sample {
  std::vector<Bend> twin, neutral;
};

Sample read_sample(std::istringstream& words, const Robots& robots) {
  Sample sample;
  const double twin = robots.twin_table.angle_step(), neutral = robots.neutral_table.angle_step();
  for (double x, y, theta, phi; words >> x >> y >> theta >> phi;) {
    sample.twin.push_back({x * twin, y * twin});
    sample.neutral.push_back(
        {theta * neutral * std::cos(phi * neutral), theta * neutral * std::sin(phi * neutral)});
  }
  return sample;
}

/// Changes of all tendons in doubles [mm].
std::vector<double> expected_changes(const SerialRobot& robot, kernel::Model model,
                                     const std::vector<Bend>& bends) {
  std::vector<double> changes;
  kernel::Pull<double> sum{0, 0, 0};
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Section& section = robot.sections[m];
    sum = sum + kernel::pull(model, section.map(), kernel::Bend<double>{bends[m].x(), bends[m].y()});
    for (int i = 0; i < section.tendons; ++i)
      changes.push_back(kernel::tendon_change(sum, section.direction(i)) * millimetres);
  }
  return changes;
}

/// A result as the program writes it: bits of a float, or steps [mm].
double decoded(const std::string& kernel, std::int64_t value, const Robots& robots) {
  if (kernel.find("float") != std::string::npos)
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
  if (kernel.find("q15_16") != std::string::npos) return std::ldexp(static_cast<double>(value), -16);
  if (kernel.find("paper_int16") != std::string::npos) return std::ldexp(static_cast<double>(value), -7);
  const bool is_polar = kernel.find("polar") != std::string::npos;
  return static_cast<double>(value) * (is_polar ? robots.neutral_table : robots.twin_table).length_step();
}

void add_run(std::istringstream& words, const Robots& robots, const Sample& sample, CyclesRun& run) {
  std::string name;
  int index = 0;
  long cycles = 0;
  words >> name >> index >> cycles;
  auto found = std::ranges::find(run.kernels, name, &KernelCycles::kernel);
  if (found == run.kernels.end()) {
    run.kernels.push_back({.kernel = name, .least = cycles, .most = cycles});
    found = run.kernels.end() - 1;
  }
  const bool is_polar = name.find("polar") != std::string::npos;
  const std::vector<double> expected =
      expected_changes(is_polar ? robots.neutral : robots.twin,
                       name.starts_with("pcc") ? kernel::Model::exact : kernel::Model::linear,
                       is_polar ? sample.neutral : sample.twin);
  for (const double change : expected) {
    std::int64_t value = 0;
    words >> value;
    found->error = std::max(found->error, std::abs(decoded(name, value, robots) - change));
  }
  found->mean += (static_cast<double>(cycles) - found->mean) / ++found->samples;
  found->least = std::min(found->least, cycles);
  found->most = std::max(found->most, cycles);
}

Expected<CyclesRun> read_run(const std::string& text, const Robots& robots) {
  CyclesRun run;
  Sample sample;
  std::istringstream lines(text);
  bool is_whole = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "sections") words >> run.sections;
    if (what == "bends") words >> what, sample = read_sample(words, robots);
    if (what == "run") add_run(words, robots, sample, run);
    is_whole = what == "end";
  }
  if (!is_whole) return failure("simulator_failed", "firmware/cycles", "the program did not come to its end");
  return run;
}

Expected<void> write_sources(const Robots& robots, const fs::path& folder) {
  for (const BuiltinFile& file : builtin_firmware())
    if (auto written = write_text(file.text, folder / file.name); !written) return written;
  if (auto written = write_text(controller_header(robots.twin_table, "tpcj"), folder / "tpcj.h"); !written)
    return written;
  return write_text(controller_header(robots.neutral_table, "neutral"), folder / "neutral.h");
}

/// The simulator of this build: beside the command, which lies in bin or in libexec/sinew; or on PATH.
std::string simulator_path() {
  if (const char* named = std::getenv("SINEW_SIMULATE"))
    return fs::path(named).has_parent_path() ? fs::absolute(named).string()
                                             : named;  // it runs in another folder
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& place : {beside / "sinew-simulate", beside.parent_path() / "bin" / "sinew-simulate",
                                beside.parent_path().parent_path() / "bin" / "sinew-simulate"})
    if (fs::exists(place, ignored)) return place.string();
  return "sinew-simulate";
}

}  // namespace

const KernelCycles* CyclesRun::find(std::string_view kernel) const {
  const auto found = std::ranges::find(kernels, kernel, &KernelCycles::kernel);
  return found == kernels.end() ? nullptr : &*found;
}

Expected<CyclesTools> find_cycles_tools() {
  CyclesTools tools;
  const ProcessResult compiler = run_process({tools.compiler, "--version"}, ".");
  if (!compiler.succeeded())
    return failure("compiler_missing", tools.compiler,
                   "the cross compiler is not installed: apt-get install gcc-avr avr-libc");
  tools.compiler_version = compiler.output.substr(0, compiler.output.find('\n'));
  tools.simulator = simulator_path();
  if (!run_process({tools.simulator, "--help"}, ".").succeeded())
    return failure("simulator_missing", tools.simulator,
                   "the simulator was not built: apt-get install libsimavr-dev, and build sinew again");
  return tools;
}

Expected<CyclesRun> measure_cycles(int sections, const CyclesTools& tools, const fs::path& folder) {
  const Robots robots(sections);
  const fs::path place = fs::absolute(folder) / fmt::format("sections_{}", sections);
  if (auto written = write_sources(robots, place); !written) return tl::unexpected(written.error());
  const ProcessResult compiled =
      run_process({tools.compiler, "-mmcu=atmega2560", "-O2", "-std=c++14",
                   fmt::format("-DSINEW_SAMPLES={}", samples), "-I.", "main.cpp", "-o", "cycles.elf"},
                  place);
  if (!compiled.succeeded()) return failure("compiler_failed", tools.compiler, compiled.complaint());
  const ProcessResult ran = run_process({tools.simulator, "cycles.elf", "--cycles", max_cycles}, place);
  if (!ran.succeeded()) return failure("simulator_failed", tools.simulator, ran.complaint());
  return read_run(ran.output, robots);
}

}  // namespace sinew::inline v1::lsk
