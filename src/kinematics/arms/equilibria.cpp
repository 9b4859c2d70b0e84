#include <algorithm>
#include <cmath>
#include <random>

#include "kinematics/arms/arm_work.hpp"

namespace sinew::inline v1 {

std::vector<ArmState> arm_equilibria(const Arm& arm, std::span<const TendonCommand> commands,
                                     const ArmLoad& load, const ArmOptions& options, int starts,
                                     ArmWorkspace& work) {
  std::vector<ArmState> found;
  std::mt19937 gen(1);  // the same shapes for every question
  std::normal_distribution<double> normal;
  ArmOptions each = options;
  each.from_last = false;
  for (int start = 0; start < starts; ++start) {
    const ArmState* state = &arm_forward(arm, commands, load, each, work);
    if (state->report.status == Status::bad_input || state->report.status == Status::stopped) {
      found.push_back(*state);
      break;
    }
    if (state->report.ok()) {
      const bool is_new = std::ranges::none_of(found, [&](const ArmState& other) {
        return (other.tip.p - state->tip.p).norm() < 1e-5 * arm.length() &&
               other.tip.R.compose(state->tip.R.inverse()).log().norm() < 1e-4;
      });
      if (is_new) found.push_back(*state);
    } else if (start == 0) {
      found.push_back(*state);
    }
    // from another shape: bent at random, as much as a rod bends that is pushed hard
    strain::LoadedRod& rod = work.impl().rod();
    const double size = 2.5 * std::sqrt(rod.model().energy_scale);
    for (const strain::Piece& piece : rod.model().pieces)
      for (std::size_t c = 3; c < 5; ++c)
        for (int a = 0; a < piece.modes[c]; ++a)
          rod.work().y[static_cast<std::size_t>(piece.first + piece.offset[c] + a)] =
              size * normal(gen) / std::sqrt(static_cast<double>(rod.model().pieces.size())) / (1 + 3 * a);
    each.from_last = true;
  }
  if (found.size() > 1 && !found.front().report.ok()) found.erase(found.begin());
  // by what is least at an equilibrium that holds: with the motors that hold tensions
  std::ranges::stable_sort(found, {}, [&](const ArmState& one) {
    double sum = one.energy;
    for (std::size_t i = 0; i < std::min(commands.size(), one.changes.size()); ++i)
      if (commands[i].held == TendonHeld::tension) sum += one.tensions[i] * one.changes[i];
    return sum;
  });
  return found;
}

}  // namespace sinew::inline v1
