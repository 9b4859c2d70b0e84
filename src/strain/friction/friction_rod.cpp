#include "strain/friction/friction_rod.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/norm.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Of a tendon that does not stretch, while it is looked for: of what it gives way by on the straight rod.
constexpr double give = 5e-3;

}  // namespace

FrictionRod::FrictionRod(const RodModel& model, std::span<const RubbingTendon> tendons)
    : model_(&model),
      work_(model),
      side_(at(model.size * row)),
      start_(at(model.size)) {
  build(tendons);
  forget();
}

void FrictionRod::build(std::span<const RubbingTendon> tendons) {
  chains_.resize(tendons.size());
  for (std::size_t i = 0; i < tendons.size(); ++i) chains_[i].tendon = tendons[i];
  const auto enter = [&](int tendon, const Unit& unit, const Vector& along) {
    Chain& chain = chains_[at(tendon)];
    if (chain.units.empty()) chain.entry = along.normalized();
    chain.units.push_back(unit);
  };
  for (std::size_t p = 0; p < model_->pieces.size(); ++p) {
    const Piece& piece = model_->pieces[p];
    for (int s = piece.first_span; s < piece.first_span + piece.spans; ++s) {
      const Span& span = model_->spans[at(s)];
      if (span.holes > 0) {
        double length = 0;
        for (int e = 0; e < span.elements; ++e) length += model_->elements[at(span.first_element + e)].length;
        for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
          const Hole& hole = model_->holes[at(i)];
          Unit unit;
          unit.segment = static_cast<int>(segments_.size());
          unit.entry = i;
          unit.start = hole.start;
          unit.end = hole.end;
          enter(hole.tendon, unit, {hole.end[0] - hole.start[0], hole.end[1] - hole.start[1], length});
        }
        segments_.push_back({span.first_element, span.elements, static_cast<int>(p), {}});
        continue;
      }
      for (int e = span.first_element; e < span.first_element + span.elements; ++e) {
        const Element& element = model_->elements[at(e)];
        if (element.guides == 0) continue;
        for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
          const Guide& guide = model_->guides[at(i)];
          Unit unit;
          unit.segment = static_cast<int>(segments_.size());
          unit.entry = i;
          unit.hole = false;
          for (std::size_t j = 0; j < 3; ++j) {  // from the Gauss points to the ends
            const double by = 0.5 * (std::sqrt(3.0) - 1) * (guide.place[1][j] - guide.place[0][j]);
            unit.start[j] = guide.place[0][j] - by;
            unit.end[j] = guide.place[1][j] + by;
          }
          enter(guide.tendon, unit, {guide.slope[0][0], guide.slope[0][1], 1});
        }
        segments_.push_back({e, 1, static_cast<int>(p), {}});
      }
    }
  }
  for (Segment& segment : segments_) segment.twist.resize(6, model_->pieces[at(segment.piece)].size);
  std::fill(work_.y.begin(), work_.y.end(), 0.0);
  int columns = 0;
  for (Chain& chain : chains_) {
    const std::size_t count = chain.units.size();
    chain.angle.assign(count, 0.0);
    chain.turns.resize(count);
    chain.first.assign(count, 0);
    chain.offset.assign(count, 0.0);
    columns += static_cast<int>(count);
  }
  stride_ = std::max(1, (columns + row - 1) / row) * row;
  fed_.resize(at(model_->size * stride_));
}

void FrictionRod::forget() {
  std::fill(work_.y.begin(), work_.y.end(), 0.0);
  now_.y = work_.y;
  now_.loads.assign(work_.loads.size(), {});
  now_.tendons.assign(chains_.size(), {});
  now_.stored = 0;
  inputs_.assign(chains_.size(), {});
  sweep_out(*model_, work_);
  lengths();
  gradients();
  std::vector<double> whole_gradient(work_.y.size());
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    Chain& chain = chains_[i];
    Memory& memory = now_.tendons[i];
    const std::size_t count = chain.units.size();
    chain.rest.resize(count);
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += chain.rest[k] = chain.units[k].length;
    chain.compliance.resize(count);
    chain.give.resize(count);
    std::ranges::fill(whole_gradient, 0.0);
    for (const Unit& unit : chain.units)
      for (std::size_t j = 0; j < unit.gradient.size(); ++j)
        whole_gradient[at(model_->pieces[at(segments_[at(unit.segment)].piece)].first) + j] +=
            unit.gradient[j];
    const double yields = norm(whole_gradient),
                 whole = chain.tendon.compliance > 0 ? chain.tendon.compliance
                         : yields > 0                ? give * yields * yields
                                                     : 1e-5,
                 pulled = chain.tendon.compliance + chain.tendon.outside > 0 ? chain.tendon.pretension : 0;
    memory.content.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      chain.compliance[k] = whole * chain.rest[k] / sum;
      if (chain.tendon.compliance <= 0) chain.give[k] = chain.compliance[k];
      memory.content[k] = chain.rest[k] - (chain.tendon.compliance > 0 ? chain.compliance[k] * pulled : 0);
      chain.offset[k] = chain.tendon.compliance > 0 ? 0 : chain.compliance[k] * pulled;
    }
    memory.outer = -chain.tendon.outside * pulled;
    memory.tension.assign(count + 1, pulled);
    now_.stored += 0.5 * (chain.tendon.compliance + chain.tendon.outside) * pulled * pulled;
  }
}

bool FrictionRod::remember(const FrictionRod& other, std::span<const NodeLoad> loads,
                           std::span<const double> y) {
  if (other.chains_.size() != chains_.size()) return false;
  for (std::size_t i = 0; i < chains_.size(); ++i)
    if (chains_[i].units.size() != other.chains_[i].units.size()) return false;
  now_.loads.assign(loads.begin(), loads.end());
  now_.y.assign(y.begin(), y.end());
  now_.tendons = other.now_.tendons;
  now_.stored = other.now_.stored;
  for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].offset = other.chains_[i].offset;
  work_.y = now_.y;
  return true;
}

void FrictionRod::set(std::span<const TendonInput> inputs, std::span<const NodeLoad> loads) {
  std::copy(inputs.begin(), inputs.end(), inputs_.begin());
  std::copy(loads.begin(), loads.end(), work_.loads.begin());
  potential_ = true;
  for (const NodeLoad& load : work_.loads) {
    for (double x : load.moment) potential_ = potential_ && x == 0;
    for (double x : load.following) potential_ = potential_ && x == 0;
  }
  work_.symmetric = potential_;
  for (std::size_t i = 0; i < chains_.size(); ++i)
    chains_[i].has_outer = inputs_[i].by_tension || chains_[i].tendon.outside > 0;
}

/// Frames, lengths, tensions.
void FrictionRod::evaluate() {
  sweep_out(*model_, work_);
  lengths();
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    Chain& chain = chains_[i];
    const Memory& memory = now_.tendons[i];
    const TendonInput& input = inputs_[i];
    CapstanSpans& spans = chain.spans;
    const std::size_t count = chain.units.size(), outer = chain.has_outer ? 1 : 0;
    spans.stretch.assign(count + outer, 0.0);
    spans.compliance.assign(count + outer, 1.0);
    spans.grip.resize(count + outer - 1);
    spans.held = input.by_tension;
    spans.tension = input.by_tension ? input.value : 0;
    for (std::size_t k = 0; k < count; ++k) {
      spans.stretch[k + outer] = chain.units[k].length - memory.content[k] + chain.offset[k];
      spans.compliance[k + outer] = chain.compliance[k];
      if (k + outer > 0) spans.grip[k + outer - 1] = chain.tendon.friction * chain.angle[k];
    }
    if (!input.by_tension) {
      if (outer > 0) {
        spans.stretch[0] = input.value - memory.outer;
        spans.compliance[0] = chain.tendon.outside;
      } else {
        spans.stretch[0] += input.value - memory.end;  // all that is pulled in comes from the first span
      }
    }
    chain.tensions.find(spans);
    chain.taut = chain.tensions.tension.back() > 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Unit& unit = chain.units[k];
      (unit.hole ? work_.hole_tension : work_.guide_tension)[at(unit.entry)] =
          chain.tensions.tension[k + outer];
    }
  }
}

void FrictionRod::put(std::span<const double> y, std::span<const TendonInput> inputs,
                      std::span<const NodeLoad> loads) {
  set(inputs, loads);
  std::copy(y.begin(), y.end(), work_.y.begin());
  evaluate();
  linearise();
}

bool FrictionRod::solve_newton(std::span<double> side) {
  if (!factor_all(0)) return false;
  std::fill(side_.begin(), side_.end(), 0.0);
  for (std::size_t i = 0; i < side.size(); ++i) side_[i * row] = side[i];
  solve_all(side_);
  for (std::size_t i = 0; i < side.size(); ++i) side[i] = side_[i * row];
  return true;
}

double FrictionRod::slack(std::size_t i) const {
  const Memory& memory = now_.tendons[i];
  if (!memory.slack) return 0;
  double sum = memory.outer - memory.end;
  for (std::size_t k = 0; k < memory.content.size(); ++k)
    sum += memory.content[k] - chains_[i].units[k].length;
  return std::max(0.0, sum);
}

}  // namespace sinew::inline v1::strain
