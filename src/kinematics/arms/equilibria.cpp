#include <algorithm>
#include <cmath>
#include <random>

#include "kinematics/arms/arm_work.hpp"
#include "kinematics/arms/whole_potential.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int parts = 16;       ///< of the shape that is told of each
constexpr double still = 1e-6;  ///< a margin below which an equilibrium may move freely [1]
/// Equilibria are one where tips differ by less than these, over the arm's length and [rad]: far above what
/// two searches leave, far below what tells equilibria apart.
constexpr double same_tip = 1e-5, same_tip_angle = 1e-4;
/// Potentials of one continuum differ by less than this, and so many times the accuracy, over EI/L or
/// themselves [1]: each has an error of its own.
constexpr double same_potential = 1e-8, accuracies = 10;
/// How much a shape to begin at is bent [rad]: as much as a rod bends that is pushed hard.
constexpr double typical_bending = 2.5;

}  // namespace

std::vector<ArmEquilibrium> arm_equilibria(const Arm& arm, std::span<const TendonCommand> commands,
                                           const ArmLoad& load, const ArmOptions& options, int starts,
                                           ArmWorkspace& work) {
  std::vector<ArmEquilibrium> found;
  std::mt19937 gen(1);  // the same shapes for every question
  std::normal_distribution<double> normal;
  ArmOptions each = options;
  each.from_last = false;
  const double alike = std::max(same_potential, accuracies * options.accuracy);
  const auto is_known = [&](const ArmState& state, bool continuum) {
    const double potential = whole_potential(state, commands);
    return std::ranges::any_of(found, [&](const ArmEquilibrium& other) {
      if (continuum && other.continuum) {
        const double there = whole_potential(other.state, commands),
                     scale = work.impl().rod().model().energy_scale + std::abs(there);
        if (std::abs(there - potential) < alike * scale) return true;
      }
      return (other.state.tip.p - state.tip.p).norm() < same_tip * arm.length() &&
             other.state.tip.R.compose(state.tip.R.inverse()).log().norm() < same_tip_angle;
    });
  };
  work.impl().grew = false;
  for (int start = 0; start < starts; ++start) {
    // What grows from nothing is the same from wherever a search began.
    work.impl().may_grow = !work.impl().grew;
    const ArmState* state = &arm_forward(arm, commands, load, each, work);
    if (state->report.status == Status::bad_input || state->report.status == Status::unsupported ||
        state->report.status == Status::stopped) {
      found.push_back({*state});
      break;
    }
    if (state->report.ok()) {
      const ArmRates rates = arm_rates(arm, work);
      const bool continuum = state->stability_told && (!rates.regular || std::abs(rates.margin) < still);
      if (!is_known(*state, continuum))
        found.push_back({*state, arm_curvatures(arm, parts, work), continuum});
    } else if (start == 0) {
      found.push_back({*state});
    }
    // from another shape, bent at random
    strain::LoadedRod& rod = work.impl().rod();
    const double size = typical_bending * std::sqrt(rod.model().energy_scale);
    std::ranges::fill(rod.work().y, 0.0);  // what it was twisted by would lead it to the same side again
    for (const strain::Piece& piece : rod.model().pieces)
      for (std::size_t c = 3; c < 5; ++c)
        for (int a = 0; a < piece.modes[c]; ++a)
          rod.work().y[static_cast<std::size_t>(piece.first + piece.offset[c] + a)] =
              size * normal(gen) / std::sqrt(static_cast<double>(rod.model().pieces.size())) / (1 + 3 * a);
    each.from_last = true;
  }
  work.impl().may_grow = true;
  if (found.size() > 1 && !found.front().state.report.ok()) found.erase(found.begin());
  std::ranges::stable_sort(found, {},
                           [&](const ArmEquilibrium& one) { return whole_potential(one.state, commands); });
  return found;
}

}  // namespace sinew::inline v1
