#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/friction/friction_rod.hpp"

namespace sinew::inline v1::strain {

/// What lies where once all that slips has slipped.
void FrictionRod::commit(PathStep& result, bool turned) {
  double stored = work_.energy;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    Chain& chain = chains_[i];
    Memory& memory = now_.tendons[i];
    const TendonInput& input = inputs_[i];
    const std::size_t count = chain.units.size(), outer = chain.has_outer ? 1 : 0;
    const std::vector<double>& tension = chain.tensions.tension;
    const bool slack = !(tension.back() > 0);
    const std::vector<double> before = memory.tension;
    const double end_before = memory.end;
    double free = 0;  // what a slack tendon has too much of
    if (slack && !input.by_tension)
      for (double e : chain.spans.stretch) free -= e;
    std::vector<double> moved(count, 0.0);  // outward at every guide
    double sum = 0, whole = 0;
    for (double x : chain.rest) whole += x;
    for (std::size_t k = count; k-- > 0;) {
      const Unit& unit = chain.units[k];
      const bool alone = (k + outer == 0 || chain.tensions.grips[k + outer - 1] == Grip::sticks) &&
                         (k + 1 == count || chain.tensions.grips[k + outer] == Grip::sticks);
      double content = memory.content[k];
      if (slack)
        content = unit.length + free * chain.rest[k] / whole;
      else if (!alone || k == 0)
        content = unit.length + chain.offset[k] - chain.compliance[k] * tension[k + outer];
      sum += memory.content[k] - content;
      moved[k] = sum;
      memory.content[k] = content;
      memory.tension[k + 1] = tension[k + outer];
      stored += 0.5 * (chain.tendon.compliance > 0 ? chain.compliance[k] : 0) * tension[k + outer] *
                tension[k + outer];
    }
    memory.outer += moved[0];
    if (input.by_tension) {
      memory.tension[0] = input.value;
      memory.end = memory.outer + chain.tendon.outside * input.value;
    } else {
      memory.end = input.value;
      if (chain.has_outer) {
        memory.tension[0] = tension[0];
      } else {  // between motor and rod nothing stretches: how it moves says what friction does there
        const double f = std::exp(chain.tendon.friction * chain.angle[0]), T = tension[0],
                     by = memory.end - end_before;
        memory.tension[0] = by > 0 ? T * f : by < 0 ? T / f : std::clamp(memory.tension[0], T / f, T * f);
      }
    }
    stored += 0.5 * chain.tendon.outside * memory.tension[0] * memory.tension[0];
    memory.slack = slack;
    result.motors += 0.5 * (before[0] + memory.tension[0]) * (memory.end - end_before);
    for (std::size_t k = 0; k < count; ++k) {
      const double drop = memory.tension[k] - memory.tension[k + 1];
      result.friction += (turned ? drop : 0.5 * (before[k] - before[k + 1] + drop)) * moved[k];
    }
  }
  now_.y = work_.y;
  std::copy(work_.loads.begin(), work_.loads.end(), now_.loads.begin());
  now_.stored = stored;
}

PathStep FrictionRod::step(std::span<const TendonInput> inputs, std::span<const NodeLoad> loads,
                           const RelaxOptions& options) {
  PathStep result;
  const std::vector<NodeLoad> first_loads = now_.loads, last_loads(loads.begin(), loads.end());
  std::vector<TendonInput> first(inputs.begin(), inputs.end()), here(inputs.begin(), inputs.end());
  for (std::size_t i = 0; i < first.size(); ++i)
    first[i].value = first[i].by_tension ? now_.tendons[i].tension[0] : now_.tendons[i].end;
  std::vector<NodeLoad> mixed = last_loads;
  RelaxOptions quick = options;
  quick.max_iterations = std::min(options.max_iterations, 25);
  // Longer parts than this are cut before they are damped: shorter ones tell better in which order guides
  // slip.
  constexpr double damped_from = 1.0 / 4, least = 1.0 / 256;
  double done = 0, part = 1;
  result.found.reached = 0;
  const int budget = 10 * std::max(options.max_iterations, 1);
  bool spent = false;
  while (done < 1) {
    spent = result.found.iterations >= budget;  // inch by inch it would take minutes
    if (spent) break;
    const double share = std::min(1.0, done + part);
    for (std::size_t i = 0; i < here.size(); ++i)
      here[i].value =
          share == 1 ? inputs[i].value : first[i].value + share * (inputs[i].value - first[i].value);
    for (std::size_t k = 0; k < mixed.size(); ++k)
      mixed[k] = share == 1 ? last_loads[k] : mix(first_loads[k], last_loads[k], share);
    set(here, mixed);
    work_.y = now_.y;
    Relaxed one = equilibrium(quick, false);
    int iterations = one.iterations, evaluations = one.evaluations;
    const bool refused = one.status != Status::converged && one.status != Status::stopped;
    if (refused && part <= damped_from) {  // it moves on by itself
      RelaxOptions damped = options;
      if (part > least) damped.max_iterations = std::min(options.max_iterations, 50);
      one = equilibrium(damped, true);
      iterations += one.iterations;
      evaluations += one.evaluations;
    }
    result.found.iterations += iterations;
    result.found.evaluations += evaluations;
    result.found.status = one.status;
    result.found.residual = one.residual;
    result.found.negative = one.negative;
    if (one.status == Status::converged) {
      const State before = now_;
      PathStep sums = result;
      commit(sums, false);
      const double lost = sums.friction - result.friction, put_in = std::abs(sums.motors - result.motors),
                   taken_up = std::abs(now_.stored - before.stored);
      if (lost < -1e-6 * (put_in + taken_up)) {
        // friction gave energy: the path turned within, too coarse for trapezoids and for what slips first
        now_ = before;
        if (part > least) {
          part = std::max(least, 0.5 * part);
          continue;
        }
        sums = result;
        commit(sums, true);
      }
      result = sums;
      ++result.parts;
      done = share;
      part *= first_iterations_ < 8 ? 2 : 1;
    } else {
      if (one.status == Status::stopped || part <= least) break;
      part = std::max(least, 0.5 * part);
    }
  }
  result.found.reached = done;
  if (done < 1) {  // back to the last equilibrium
    for (std::size_t i = 0; i < here.size(); ++i)
      here[i].value = first[i].value + done * (inputs[i].value - first[i].value);
    for (std::size_t k = 0; k < mixed.size(); ++k) mixed[k] = mix(first_loads[k], last_loads[k], done);
    set(here, mixed);
    work_.y = now_.y;
    evaluate();
    if (spent)
      result.found.status = Status::iteration_limit;
    else if (result.found.status != Status::stopped)
      result.found.status = Status::stalled;
  }
  return result;
}

}  // namespace sinew::inline v1::strain
