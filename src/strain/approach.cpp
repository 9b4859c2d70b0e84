#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Of a piece one component and stretch: where its coordinates are in a rod and in another.
struct Modes {
  int from, to;      ///< the first of them
  int shared, more;  ///< of the rod; of the finer one beyond those
};

template <typename Visit>
void each_mode(const RodModel& from, const RodModel& to, Visit visit) {
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    const Piece &a = from.pieces[k], &b = to.pieces[k];
    for (std::size_t c = 0; c < 6; ++c)
      for (int s = 0; s < a.stretches; ++s) {
        const int shared = a.modes[c] / a.stretches, all = b.modes[c] / b.stretches;
        visit(Modes{a.first + a.offset[c] + s * shared, b.first + b.offset[c] + s * all,
                    std::min(shared, all), all - shared});
      }
  }
}

double start_of(const RodModel& model, const Piece& piece) {
  return model.places[at(model.spans[at(piece.first_span)].first_element)];
}

Three tip_of(const RodWork& work) {
  const RodFrame& tip = work.frames.back();
  return {tip.p[0], tip.p[1], tip.p[2]};
}
double distance(const Three& a, const Three& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace

bool is_within(const RodModel& from, const RodModel& to) {
  if (from.pieces.size() != to.pieces.size()) return false;
  for (std::size_t k = 0; k < from.pieces.size(); ++k) {
    const Piece &a = from.pieces[k], &b = to.pieces[k];
    if (a.stretches != b.stretches || a.scale != b.scale) return false;
    if (std::abs(start_of(from, a) - start_of(to, b)) > 1e-12) return false;
    for (std::size_t c = 0; c < 6; ++c)
      if (a.modes[c] > b.modes[c]) return false;
  }
  return true;
}

void take_shared(const RodModel& from, std::span<const double> y, const RodModel& to, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  each_mode(from, to, [&](const Modes& modes) {
    for (int a = 0; a < modes.shared; ++a) out[at(modes.to + a)] = y[at(modes.from + a)];
  });
}

Approach LoadedRod::approach(LoadedRod& coarse, double enough) {
  Approach found;
  const bool gives = std::ranges::all_of(
      holds, [](const TendonHold& hold) { return hold.by_tension || hold.compliance > 0; });
  if (!gives || !coarse.potential_ || coarse.factors_ == nullptr || !is_within(*coarse.model_, *model_))
    return found;
  take_holds();
  work_.symmetric = potential_ = true;
  work_.finds_length_gradients = false;
  const Three from = tip_of(coarse.work_);
  Three last = from;
  double before = 0, residual_before = 0;
  take_shared(*coarse.model_, coarse.work_.y, *model_, work_.y);
  evaluate();
  while (found.iterations < 5) {
    linearise(false);
    const double residual = gradient_norm();
    if (!std::isfinite(residual) || !pulls_like(coarse)) break;
    each_mode(*coarse.model_, *model_, [&](const Modes& modes) {
      const double* g = work_.gradient.data() + modes.to;
      for (int a = 0; a < modes.shared; ++a) coarse.sides_[at((modes.from + a) * coarse.stride_)] = -g[a];
    });
    coarse.solve_all(coarse.sides_, 1, coarse.stride_);
    each_mode(*coarse.model_, *model_, [&](const Modes& modes) {
      double* y = work_.y.data() + modes.to;
      const double* g = work_.gradient.data() + modes.to;
      for (int a = 0; a < modes.shared; ++a) y[a] += coarse.sides_[at((modes.from + a) * coarse.stride_)];
      for (int a = modes.shared; a < modes.shared + modes.more; ++a) y[a] -= g[a];
    });
    evaluate();
    ++found.iterations;
    const Three tip = tip_of(work_);
    const double step = distance(tip, last), moved = distance(tip, from);
    if (found.iterations > 1) {
      const double rate = std::max(step / before, residual / residual_before);
      if (!(rate < 0.5) && step > enough) break;
      const double rest = rate < 0.5 ? step * rate / (1 - rate) : step;
      if (rest <= std::max(0.05 * moved, enough)) {
        found.close = true;
        found.tip = tip;
        found.rest = rest;
        found.moved = moved + rest;
        break;
      }
    }
    last = tip;
    before = step;
    residual_before = residual;
  }
  work_.finds_length_gradients = true;
  return found;
}

bool LoadedRod::pulls_like(const LoadedRod& other) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (holds[i].by_tension || tensions_[i] <= 0) continue;
    if (next == other.active_.size() || other.active_[next] != static_cast<int>(i)) return false;
    ++next;
  }
  return next == other.active_.size();
}

std::vector<std::vector<double>> elastic_difference(const RodModel& model, const RodModel& fewer) {
  std::vector<std::vector<double>> squares;
  for (const Piece& piece : model.pieces) squares.emplace_back(at(piece.size * piece.padded), 0.0);
  const auto add = [&](const RodModel& from, double sign) {
    for (std::size_t k = 0; k < from.pieces.size(); ++k) {
      const Piece& piece = from.pieces[k];
      const Span& last = from.spans[at(piece.first_span + piece.spans - 1)];
      for (int e = from.spans[at(piece.first_span)].first_element; e < last.first_element + last.elements;
           ++e) {
        const Element& element = from.elements[at(e)];
        for (std::size_t g = 0; g < at(element.points); ++g)
          for (std::size_t c = 0; c < 6; ++c) {
            const double stiff =
                sign * element.weight * element.stiffness[g][c] * piece.scale[c] * piece.scale[c];
            for (int i = 0; i < piece.modes[c]; ++i)
              for (int j = 0; j < piece.modes[c]; ++j)
                squares[k][at((piece.offset[c] + i) * piece.padded + piece.offset[c] + j)] +=
                    stiff * element.modes[g][at(i)] * element.modes[g][at(j)];
          }
      }
    }
  };
  add(model, 1);
  add(fewer, -1);
  return squares;
}

void LoadedRod::lean_on(LoadedRod& fewer) {
  lean_ = &fewer;
  elastic_ = elastic_difference(*model_, *fewer.model_);
}

void LoadedRod::take_hessian_of_lean() {
  LoadedRod& lean = *lean_;
  lean.work_.y = work_.y;
  lean.tensions_ = tensions_;
  lean.spread_tensions();
  lean.work_.symmetric = work_.symmetric;
  lean.work_.finds_length_gradients = false;
  sweep_out(*lean.model_, lean.work_);
  sweep_back_with_hessian(*lean.model_, lean.work_);
  for (std::size_t k = 0; k < elastic_.size(); ++k) {
    std::vector<double>& H = lean.work_.pieces[k].H;
    for (std::size_t i = 0; i < H.size(); ++i) H[i] += elastic_[k][i];
  }
}

}  // namespace sinew::inline v1::strain
