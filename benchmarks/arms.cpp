/// Arms under load: two sections of ten discs, three tendons each, tensions that walk by about 1 %.
/// Run: build/dev/bin/bench_arms
/// Baselines: the equations of the published models by a dense Newton whose Jacobian is made of differences;
/// a cold start. The last lines are the cost against the number of discs, and rows of a batch by each
/// instruction set, in seconds of the processor.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>
#include <random>

#include "instruction_sets.hpp"
#include "io/document/parse.hpp"
#include "io/robots/arm_file.hpp"
#include "report.hpp"
#include "sinew/batch.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::bench {
namespace {

Arm two_sections(int discs) {
  Arm arm;
  for (int m = 0; m < 2; ++m) {
    ArmSection section;
    section.length = 0.2;
    section.start = section.end = round_section({54e9, 54e9 / 2.6, 6450}, 0.0014);
    section.discs.count = discs;
    arm.sections.push_back(section);
    for (const double angle : {90.0, -30.0, 210.0}) {
      ArmTendon tendon;
      const double a = angle * std::numbers::pi / 180;
      tendon.routes.assign(static_cast<std::size_t>(m) + 1, {0.01, 0.01, a, a});
      tendon.compliance = 1e-4;
      arm.tendons.push_back(tendon);
    }
  }
  arm.gravity = {9.81, 0, 0};
  return arm;
}

/// An arm whose tensions go around a circle of 1 % of themselves.
struct Walk {
  Arm arm;
  ArmWorkspace work;
  ArmOptions options;
  ArmLoad load;
  int step = 0;
  std::vector<TendonCommand> commands = std::vector<TendonCommand>(6);

  Walk(int discs, const ArmOptions& by) : arm(two_sections(discs)), work(arm), options(by) {
    load.wrench = {0.02, 0.05, 0, 0, 0, 0};
  }
  const ArmState& next(bool warm) {
    const double usual[] = {4, 0.5, 0, 0, 2, 1}, around = 0.7 * step++;
    for (std::size_t i = 0; i < 6; ++i)
      commands[i] = {TendonHeld::tension, usual[i] * (1 + 0.005 * std::sin(around + static_cast<double>(i)))};
    options.from_last = warm;
    return arm_forward(arm, commands, load, options, work);
  }
};

double tip_difference(const ArmState& a, const ArmState& b) { return (a.tip.p - b.tip.p).norm(); }

void row(const std::string& name, const ArmOptions& options, const std::string& baseline,
         const ArmOptions& other, bool other_warm) {
  auto ours = std::make_shared<Walk>(10, options), theirs = std::make_shared<Walk>(10, other);
  ArmOptions fine = options;
  if (options.model == ArmModel::rod || options.model == ArmModel::subsegment_rod) {
    fine.order = 5, fine.elements = options.model == ArmModel::rod ? 48 : 24;
  }
  fine.accuracy = 0;
  Walk exact(10, fine);
  double off = 0;
  ours->next(false);
  exact.next(false);
  for (int k = 0; k < 10; ++k) {
    ours->step = exact.step = 10 * k;
    off = std::max(off, tip_difference(ours->next(true), exact.next(true)));
  }
  if (theirs->next(false).report.status != Status::converged)
    std::printf("%s: baseline fails\n", name.c_str());
  compare({name, baseline, [ours] { benchmark::DoNotOptimize(ours->next(true).energy); },
           [theirs, other_warm] { benchmark::DoNotOptimize(theirs->next(other_warm).energy); },
           fmt::format("tip to {:.1e} m of the finest", off)});
}

/// Time of a warm solve against discs: the exponent of a straight line through the logarithms.
void print_exponent() {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int n = 0;
  for (const int discs : {5, 10, 20, 40, 80}) {
    Walk walk(discs, {.order = 2, .elements = 2, .accuracy = 0});
    walk.next(false);
    double best = 1e300;
    for (int round = 0; round < 200; ++round) {
      const auto start = std::chrono::steady_clock::now();
      walk.next(true);
      best = std::min(
          best, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    std::printf("%3d discs a section: %8.1f us\n", discs, best);
    const double x = std::log(discs), y = std::log(best);
    sx += x, sy += y, sxx += x * x, sxy += x * y, ++n;
  }
  std::printf("cost grows with discs to the power of %.2f\n", (n * sxy - sx * sy) / (n * sxx - sx * sx));
}

/// Of the processor, which others on the machine do not lengthen as they do a clock's.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The same rows by `arm_forward`, one after the other.
double rows_alone(const Arm& arm, std::span<const double> tensions, std::size_t rows, bool is_path) {
  ArmWorkspace work(arm);
  ArmOptions options;
  std::vector<TendonCommand> commands(6);
  const double start = seconds();
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t i = 0; i < 6; ++i) commands[i] = {TendonHeld::tension, tensions[6 * k + i]};
    options.from_last = is_path && k > 0;
    benchmark::DoNotOptimize(arm_forward(arm, commands, {}, options, work).energy);
  }
  return static_cast<double>(rows) / (seconds() - start);
}

/// Rows of a batch on one thread: tensions of all tendons on closed walks about 2 N, 2048 rows around; or any
/// up to 4 N.
void print_batch(const char* path, bool walks) {
  const auto question = parse_json(
      fmt::format(R"({{"query":"forward","tensions":"$t","outputs":{{"p":"tip.position"}},"path":"{}"}})",
                  path),
      "query");
  const auto robot = read_robot_file("two-segment");
  if (!question || !robot) return;
  const auto batch = Batch::prepare(*robot, *question);
  const auto arm = read_arm(*robot);
  if (!batch || !arm) return;
  constexpr std::size_t rows = 4096;
  std::vector<double> in, out(3 * rows);
  std::mt19937 gen(1);
  std::uniform_real_distribution<double> any(0, 4);
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t i = 0; i < 6; ++i)
      in.push_back(walks ? 2 + 1.9 * std::sin(2 * std::numbers::pi * static_cast<double>((i + 1) * k) / 2048 +
                                              static_cast<double>(i))
                         : any(gen));
  std::vector<std::uint8_t> statuses(rows);
  constexpr std::ptrdiff_t number = sizeof(double);
  const Batch::Strided<const double> from[] = {{in.data(), 6 * number}};
  const Batch::Strided<double> to[] = {{out.data(), 3 * number}};
  double best = 0, alone = 0;
  for (int round = 0; round < 5; ++round) {
    const double start = seconds();
    batch->run(rows, from, to, statuses, {.threads = 1});
    best = std::max(best, static_cast<double>(rows) / (seconds() - start));
    alone = std::max(alone, rows_alone(*arm, in, rows / 2, path == std::string_view("continue")));
  }
  const auto solved = std::ranges::count(statuses, static_cast<std::uint8_t>(Status::converged));
  std::printf(
      "batch, %s, %s, path %s: %.0f rows a second, %td of %zu solved; one after the other %.0f, ratio %.1f\n",
      std::string(batch->method()).c_str(), walks ? "walk" : "any tensions", path, best, solved, rows, alone,
      best / alone);
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew;
  using namespace sinew::bench;
  const ArmOptions rod{}, cold = rod;
  row("two sections, rod between discs, to 1e-6 of its length, warm", rod, "cold", cold, false);
  row("... to 1e-8 m, warm", {.elements = 8, .accuracy = 0}, "cold", {.elements = 8, .accuracy = 0}, false);
  row("rod in channels, warm", {.model = ArmModel::rod}, "cold", {.model = ArmModel::rod}, false);
  row("constant between discs, warm", {.model = ArmModel::subsegment_cc}, "collocated, dense differences",
      {.model = ArmModel::subsegment_cc, .balance = ArmBalance::collocated}, true);
  row("pseudo-rigid, one joint, warm", {.model = ArmModel::prb}, "cold", {.model = ArmModel::prb}, false);
  row("pseudo-rigid, four joints, warm", {.model = ArmModel::prb, .elements = 4},
      "collocated, dense differences", {.model = ArmModel::prb, .balance = ArmBalance::collocated}, true);
  row("constant in a section, warm", {.model = ArmModel::cc}, "cold", {.model = ArmModel::cc}, false);
  const int status = sinew::bench::main(argc, argv);
  print_exponent();
  for (const InstructionSet& isa : instruction_sets) {
    hwy::SetSupportedTargetsForTest(0);
    if (!isa.is_there()) continue;
    hwy::SetSupportedTargetsForTest(isa.target);
    std::printf("%s\n", isa.name);
    print_batch("continue", true);
    print_batch("anew", true);
    print_batch("anew", false);
  }
  hwy::SetSupportedTargetsForTest(0);
  return status;
}
