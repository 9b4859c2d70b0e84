/// Cold forward kinematics of the flexible 3PFS on random inputs, every answer judged from outside: its rods
/// integrated anew at order 8, and where it is not an equilibrium the paper's own system walked there from
/// home. Run: build/dev/bin/bench_tripod_campaign [inputs a preset]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <random>

#include "reference_3pfs.hpp"
#include "shooting_3pfs.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace {

using namespace sinew;
namespace paper = sinew::test::shooting;

struct Asked {
  std::array<double, 3> lengths;
  SpatialWrench wrench = SpatialWrench::Zero();
};

/// Lengths within 60 mm of home; every other one with a force of up to 5 N an axis and a moment of up to 0.5
/// N m.
Asked random_question(std::mt19937& random, double home, bool is_loaded) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Asked asked;
  for (double& length : asked.lengths) length = home + 0.06 * uniform(random);
  for (int k = 0; k < 6 && is_loaded; ++k) asked.wrench[k] = (k < 3 ? 5.0 : 0.5) * uniform(random);
  return asked;
}

paper::Wrench wrench_of(const SpatialWrench& wrench) {
  return {paper::Vector3d(wrench.head<3>()), paper::Vector3d(wrench.tail<3>())};
}

/// Largest error of an answer's rods and balances when its rods are integrated anew [m, N].
std::pair<double, double> judge(const paper::Tripod& tripod, const Asked& asked, const Robot& robot,
                                const Equilibrium& answer, Workspace& work) {
  const RodAnalysis rods = analyse_equilibrium(robot, work);
  paper::PerRod<paper::Vector3d> forces;
  for (std::size_t k = 0; k < 6; ++k) forces[k] = rods.rods[k].force;
  const auto& q = answer.pose.quaternion;
  const auto off = paper::reintegrate(
      tripod, paper::pairs({asked.lengths[0], asked.lengths[1], asked.lengths[2]}), wrench_of(asked.wrench),
      answer.pose.position, paper::rotation(q[0], q[1], q[2], q[3]), forces);
  return {off.closure, std::max(off.force, off.moment)};
}

void run(const char* set_name, const char* file, int count) {
  const paper::Json set = paper::reference(set_name);
  const paper::Tripod tripod = paper::tripod(set);
  const double home = set["L_home"].get<double>();
  const Robot robot = load(file).value();
  Workspace work(robot);
  std::mt19937 random(4);
  std::map<std::string, int> statuses;
  std::vector<double> times;
  double residual = 0, closure = 0, balance = 0, iterations = 0;
  int wrong = 0, missed = 0;
  const auto home_lengths = paper::pairs({home, home, home});
  const auto start = paper::solve(tripod, home_lengths, {}, paper::first_guess(tripod, home_lengths));
  for (int k = 0; k < count; ++k) {
    const Asked asked = random_question(random, home, k % 2 == 1);
    const auto begin = std::chrono::steady_clock::now();
    const Equilibrium answer = equilibrium(robot, asked.lengths, {.wrench = asked.wrench}, work);
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    ++statuses[std::string(to_string(answer.report.status))];
    if (answer.is_solved()) {
      const auto [gap, lost] = judge(tripod, asked, robot, answer, work);
      residual = std::max(residual, answer.report.residual);
      closure = std::max(closure, gap);
      balance = std::max(balance, lost);
      iterations += answer.report.iterations / static_cast<double>(count);
      wrong += !(gap <= 1e-9 && lost <= 1e-9 && answer.report.residual <= 1e-12);
    } else {
      const auto& l = asked.lengths;
      const auto found =
          paper::walk(tripod, {home_lengths, {}}, {paper::pairs({l[0], l[1], l[2]}), wrench_of(asked.wrench)},
                      start.v, 200);
      missed += found.converged;
    }
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) { return times[static_cast<std::size_t>(part * (count - 1))]; };
  fmt::print("{}: {} inputs", set_name, count);
  for (const auto& [status, number] : statuses) fmt::print(", {} {}", number, status);
  fmt::print("\n  wrong {}, missed where the paper's system walks there {}\n", wrong, missed);
  fmt::print("  largest residual {:.1e}; integrated anew: closure {:.1e} m, balance {:.1e} N or N m\n",
             residual, closure, balance);
  fmt::print("  cold: median {:.1f} us, p99 {:.1f} us, p99.9 {:.1f} us, {:.1f} iterations in the mean\n",
             at(0.5), at(0.99), at(0.999), iterations);
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100000;
  run("G1", "3pfs-g1", std::max(count, 1));
  run("G2", "3pfs-g2", std::max(count, 1));
}
