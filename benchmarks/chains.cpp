/// Robots on pseudo-rigid chains: equilibria, velocity equations and motions. Run: build/dev/bin/bench_chains
/// The baselines are what one writes first: all equations of [TDPCR] section 3 with closures and multipliers
/// at once, derivatives by central differences, one dense solve.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <memory>

#include "analysis/chain_velocity.hpp"
#include "kinematics/chains/chain_motion.hpp"
#include "report.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/session.hpp"

namespace sinew::bench {
namespace {

using std::numbers::pi;
using Unknowns = Eigen::VectorXd;

ChainLegs<Planar> three_rfr() {
  return chains_of<Planar>(*load("3-rfr")->as(Model::prb, PrbDiscretisation::weighted));
}

/// The robot under a load that wanders by some 2 % a step, its tendon lengths held.
struct Walk {
  ChainLegs<Planar> robot = three_rfr();
  ChainWork work;
  ChainState<Planar> state;
  std::vector<TendonConstraint> hold;
  std::vector<Vec<double, 3>> wrenches;
  std::size_t step = 0;
  int iterations = 0, solves = 0, failures = 0;
  double residual = 0;

  explicit Walk(bool holds_lengths) {
    const std::array<double, 3> towards_plus{1, 1, 1};
    if (!unloaded_equilibrium(robot, PlanarPose{0.01, 0, 0.35}, towards_plus, holds_lengths, state).ok())
      std::abort();
    hold = state.hold;
    for (int i = 0; i < 256; ++i) {
      const double t = 2 * pi * i / 256;
      wrenches.emplace_back(0.02 * std::cos(t), 0.02 * std::sin(t), 3e-4 * std::sin(2 * t));
    }
    if (!equilibrium(robot, hold, wrenches[0], state, work).ok()) std::abort();
  }
  const Vec<double, 3>& next() { return wrenches[step = (step + 1) % wrenches.size()]; }
  void solve() {
    const Report report = equilibrium(robot, hold, next(), state, work);
    iterations += report.iterations;
    ++solves;
    failures += report.ok() ? 0 : 1;
    residual = std::max(residual, report.residual);
  }
};

/// Everything at once: pose, angles, chord forces, tensions; Newton on differences.
struct Dense {
  const ChainLegs<Planar>& robot;
  const std::vector<TendonConstraint>& hold;
  Vec<double, 3> wrench;
  bool holds_lengths;

  int legs() const { return static_cast<int>(robot.legs.size()); }
  int joints() const { return robot.legs[0].chain.joints(); }
  int size() const { return 3 + legs() * (joints() + (holds_lengths ? 2 : 1)); }

  Unknowns residual(const Unknowns& z) const {
    Unknowns r = Unknowns::Zero(size());
    const int n = joints(), each = n + (holds_lengths ? 2 : 1);
    r.head<3>() = -wrench;
    for (int i = 0; i < legs(); ++i) {
      const auto& leg = robot.legs[static_cast<std::size_t>(i)];
      const int at = 3 + i * each;
      const std::vector<double> angles(z.data() + at, z.data() + at + n);
      const double force = z[at + n];
      const double c = std::cos(z[2]), s = std::sin(z[2]);
      const Eigen::Vector2d b(c * leg.platform_point[0] - s * leg.platform_point[1],
                              s * leg.platform_point[0] + c * leg.platform_point[1]);
      const Eigen::Vector2d chord = z.head<2>() + b - Eigen::Vector2d(leg.base.p);
      const auto tip = leg.chain.tip<double>(angles);
      const double rho = tip.position.norm();
      double length = leg.chain.length;
      for (int j = 0; j < n; ++j) {
        const auto bend = leg.chain.tendon_bend(j, angles[static_cast<std::size_t>(j)], leg.tendon_offset, 1);
        const double tension = holds_lengths ? z[at + n + 1] : hold[static_cast<std::size_t>(i)].tension[0];
        r[at + j] = leg.spring(j) * angles[static_cast<std::size_t>(j)] + tension * bend.rate -
                    force * tip.position.dot(tip.rate[static_cast<std::size_t>(j)]) / rho;
        length += bend.change;
      }
      r[at + n] = chord.norm() - rho;
      if (holds_lengths) r[at + n + 1] = length - hold[static_cast<std::size_t>(i)].length;
      const Eigen::Vector2d e = chord.normalized();
      r.head<2>() += force * e;
      r[2] += force * (b[0] * e[1] - b[1] * e[0]);
    }
    return r;
  }

  int solve(Unknowns& z) const {
    for (int round = 1; round <= 20; ++round) {
      Eigen::MatrixXd J(size(), size());
      for (int k = 0; k < size(); ++k) {
        Unknowns plus = z, minus = z;
        plus[k] += 1e-6, minus[k] -= 1e-6;
        J.col(k) = (residual(plus) - residual(minus)) / 2e-6;
      }
      const Unknowns step = J.partialPivLu().solve(residual(z));
      z -= step;
      if (step.cwiseAbs().maxCoeff() < 1e-9) return round;
    }
    return 20;
  }
};

Unknowns unknowns_of(const ChainState<Planar>& state, const ChainLegs<Planar>& robot, bool holds_lengths) {
  std::vector<double> z{state.pose.x, state.pose.y, state.pose.phi};
  for (std::size_t i = 0; i < state.legs.size(); ++i) {
    const auto angles = state.legs[i].of(robot.legs[i].chain);
    z.insert(z.end(), angles.begin(), angles.end());
    z.push_back(state.legs[i].force);
    if (holds_lengths) z.push_back(state.legs[i].tension[0]);
  }
  return Eigen::Map<Unknowns>(z.data(), static_cast<Eigen::Index>(z.size()));
}

void compare_statics(bool holds_lengths) {
  auto ours = std::make_shared<Walk>(holds_lengths);
  auto theirs = std::make_shared<Walk>(holds_lengths);
  auto z = std::make_shared<Unknowns>(unknowns_of(theirs->state, theirs->robot, holds_lengths));
  const auto baseline = [theirs, z, holds_lengths] {
    Dense{theirs->robot, theirs->hold, theirs->next(), holds_lengths}.solve(*z);
  };
  double gap = 0;
  for (int k = 0; k < 512; ++k) {
    ours->solve();
    baseline();
    gap = std::max({gap, std::abs(ours->state.pose.x - (*z)[0]), std::abs(ours->state.pose.y - (*z)[1]),
                    0.05 * std::abs(ours->state.pose.phi - (*z)[2])});  // at the platform's points
  }
  compare({fmt::format("3-RFR, n = 6: statics, {} held, warm", holds_lengths ? "lengths" : "tensions"),
           "all equations at once, by differences", [ours] { ours->solve(); }, baseline,
           fmt::format("{:.1f} iterations to {:.0e} m, {} failures of {}; poses agree to {:.0e} m",
                       static_cast<double>(ours->iterations) / ours->solves, ours->residual, ours->failures,
                       ours->solves, gap)});
}

void compare_inverse() {
  auto ours = std::make_shared<Walk>(true);
  auto state = std::make_shared<ChainState<Planar>>(ours->state);
  auto theirs = std::make_shared<Walk>(true);
  auto z = std::make_shared<Unknowns>(unknowns_of(theirs->state, theirs->robot, true));
  auto residual = std::make_shared<double>(0);
  const auto run = [ours, state, residual] {
    const Report report = inverse_statics(ours->robot, ours->next(), *state, ours->work);
    *residual = std::max(*residual, report.residual);
  };
  for (int k = 0; k < 512; ++k) run();
  compare({"3-RFR, n = 6: tensions that hold a pose, warm", "forward statics by differences", run,
           [theirs, z] {
             Dense{theirs->robot, theirs->hold, theirs->next(), true}.solve(*z);
           },
           fmt::format("to {:.0e} m", *residual)});
}

void compare_rates() {
  struct Case {
    ChainLegs<Planar> robot = three_rfr();
    ChainState<Planar> state;
    ChainRates<Planar> rates;
    double gap = 0;
  };
  auto one = std::make_shared<Case>();
  const std::array<double, 3> towards_plus{1, 1, 1};
  if (!unloaded_equilibrium(one->robot, PlanarPose{0.01, 0, 0.35}, towards_plus, false, one->state).ok())
    std::abort();
  const auto differences = [one] {
    std::array<std::array<double, 5>, 3> K;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        double half[2];
        for (const int side : {0, 1}) {
          ChainLegState moved = one->state.legs[i];
          moved.angles[j] += side ? 1e-6 : -1e-6;
          half[side] =
              one->robot.legs[i].chain.tip(moved.of(one->robot.legs[i].chain)).position.squaredNorm() / 2;
        }
        K[i][j] = (half[1] - half[0]) / 2e-6;
      }
    benchmark::DoNotOptimize(K);
    return K;
  };
  const auto run = [one] {
    one->rates = chain_rates(one->robot, one->state.pose, one->state.legs);
    benchmark::DoNotOptimize(one->rates);
  };
  run();
  const auto theirs = differences();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      one->gap = std::max(one->gap, std::abs(theirs[i][j] - one->rates.K[i][j]));
  compare({"3-RFR, n = 6: J + K_theta", "K_theta by central differences", run,
           [differences] { differences(); }, fmt::format("differences are off by {:.0e} m", one->gap)});
  compare({"3-RFR, n = 6: least-norm motion, 1 mm", "differences of 16 Runge-Kutta steps",
           [one, legs = one->state.legs]() mutable {
             legs = one->state.legs;
             const PlanarPose to{one->state.pose.x + 0.001, one->state.pose.y, one->state.pose.phi};
             benchmark::DoNotOptimize(follow_least_norm(one->robot, one->state.pose, to, legs));
           },
           [differences] {
             for (int evaluation = 0; evaluation < 64; ++evaluation) differences();
           },
           "the flow to rounding, closed to 1e-16 m"});
}

void compare_six_legs() {
  struct Case {
    ChainLegs<Spatial> robot =
        chains_of<Spatial>(*load("6-ufs")->as(Model::prb, PrbDiscretisation::weighted));
    ChainState<Spatial> state;
    ChainWork work;
    std::vector<TendonConstraint> hold;
    int step = 0;
    double residual = 0;
    void solve() {
      const double t = 2 * pi * (++step % 256) / 256;
      Vec<double, 6> wrench = Vec<double, 6>::Zero();
      wrench[0] = 0.02 * std::cos(t), wrench[1] = 0.02 * std::sin(t), wrench[5] = 1e-4 * std::sin(2 * t);
      residual = std::max(residual, equilibrium(robot, hold, wrench, state, work).residual);
    }
  };
  auto one = std::make_shared<Case>();
  SpatialPose home;
  home.position = {0, 0, 0.18};
  const std::array<double, 6> towards_plus{1, 1, 1, 1, 1, 1};
  if (!unloaded_equilibrium(one->robot, home, towards_plus, true, one->state).ok()) std::abort();
  one->hold = one->state.hold;
  for (int k = 0; k < 512; ++k) one->solve();
  auto theirs = std::make_shared<Walk>(true);
  auto z = std::make_shared<Unknowns>(unknowns_of(theirs->state, theirs->robot, true));
  compare({"6-UFS, n = 6: statics, lengths held, warm", "half as many legs, all equations at once",
           [one] { one->solve(); },
           [theirs, z] {
             Dense{theirs->robot, theirs->hold, theirs->next(), true}.solve(*z);
           },
           fmt::format("to {:.0e} m", one->residual)});
}

/// Typed questions to a robot by the model prb, each beside the same one put to a session in JSON.
void compare_typed() {
  struct Case {
    Robot robot = *load("3-rfr")->as(Model::prb);
    Workspace work{robot};
    Session session = *Session::open("3-rfr");
    EquilibriumOptions options;
    std::vector<double> inputs;
    std::string fields;  ///< of the session's questions
    double gap = 0;

    Case() {
      options.wrench << 0.02, -0.01, 0, 0, 0, 3e-4;
      SpatialPose pose;
      pose.position = {0.01, 0, 0};
      pose.quaternion = {std::cos(0.05), 0, 0, std::sin(0.05)};
      const Equilibrium held = inverse_equilibrium(robot, pose, {}, work);
      if (!held.is_solved()) std::abort();
      inputs.assign(held.inputs.begin(), held.inputs.end());
      options.start = pose;
      fields = fmt::format(
          R"("model":"prb","inputs":[{}],"wrench":[0.02,-0.01,3e-4],"start":{{"x":0.01,"y":0,"phi":0.1}})",
          fmt::join(inputs, ","));
    }
    std::string forward(std::string_view wanted) const {
      return fmt::format(R"({{"query":"forward",{},"want":[{}]}})", fields, wanted);
    }
  };
  auto one = std::make_shared<Case>();
  const auto add = [one](const char* what, auto&& typed, std::string question) {
    const std::string answer = one->session.answer(question);
    if (answer.find("\"error\"") != std::string::npos) std::abort();
    compare(
        {fmt::format("3-RFR, n = 6: {}", what), "the same asked of a session, in JSON", typed,
         [one, question = std::move(question)] { benchmark::DoNotOptimize(one->session.answer(question)); },
         fmt::format("an answer of {} bytes in JSON", answer.size())});
  };
  const auto solve = [one] {
    benchmark::DoNotOptimize(equilibrium(one->robot, one->inputs, one->options, one->work));
  };
  add("typed equilibrium from a start", solve, one->forward(R"("pose")"));
  add(
      "the same with analyse_equilibrium",
      [one, solve] {
        solve();
        benchmark::DoNotOptimize(analyse_equilibrium(one->robot, one->work));
      },
      one->forward(R"("pose","legs","stiffness","stability","margins","sensitivity")"));
  const EquilibriumOptions loaded{.wrench = one->options.wrench};
  add(
      "typed inverse_equilibria, 8 branches",
      [one, loaded] {
        benchmark::DoNotOptimize(inverse_equilibria(one->robot, *one->options.start, loaded, one->work));
      },
      R"({"query":"inverse","model":"prb","pose":{"x":0.01,"y":0,"phi":0.1},"wrench":[0.02,-0.01,3e-4],"all":true})");
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew;
  bench::compare_statics(false);
  bench::compare_statics(true);
  bench::compare_inverse();
  bench::compare_rates();
  bench::compare_six_legs();
  bench::compare_typed();
  return bench::main(argc, argv);
}
