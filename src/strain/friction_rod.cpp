#include "strain/friction_rod.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/at.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/math/so3.hpp"
#include "strain/condense.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1::strain {
namespace {

using Vector = Vec3<double>;
using Turn = Mat<double, 3, 3>;
using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

/// Of a tendon that does not stretch, while it is looked for: of what it gives way by on the straight rod.
/// What it gives is taken back; where that is slow, it gives less, down to the second share.
constexpr double give = 5e-3, least_give = 1e-6;
/// Of slip, that rounding may have made [m].
constexpr double edge = 1e-14;
/// Of exchanges of grips; where the rod is not stable at its tensions they may not end.
constexpr int most_rounds = 30;

Vector vector(const double* x) { return {x[0], x[1], x[2]}; }
double size_of_vector(std::span<const double> x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return std::sqrt(sum);
}

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
    const double yields = size_of_vector(whole_gradient),
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

/// Directions and lengths of all tendons between guides, and the angles there.
void FrictionRod::lengths() {
  for (Chain& chain : chains_) {
    Vector before = chain.entry;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      Unit& unit = chain.units[k];
      const Segment& segment = segments_[at(unit.segment)];
      const RodFrame &start = work_.frames[at(segment.first_element)],
                     &end = work_.frames[at(segment.first_element + segment.elements)];
      const Turn from = Rows(start.R), to = Rows(end.R);
      const Vector x =
          vector(end.p) - vector(start.p) + to * vector(unit.end.data()) - from * vector(unit.start.data());
      unit.chord = x.norm();
      unit.turn = from.transpose() * to;
      unit.along_start = from.transpose() * x / unit.chord;
      unit.along_end = to.transpose() * x / unit.chord;
      if (unit.hole) {
        unit.length = unit.chord;
      } else {
        const Element& element = model_->elements[at(segment.first_element)];
        const Guide& guide = model_->guides[at(unit.entry)];
        unit.length = 0;
        for (std::size_t g = 0; g < 2; ++g) unit.length += element.weight * guided(segment, guide, g).norm();
      }
      chain.angle[k] = std::atan2(before.cross(unit.along_start).norm(), before.dot(unit.along_start));
      before = unit.along_end;
    }
  }
}

/// v + u × r + dr/ds.
Vec3<double> FrictionRod::guided(const Segment& segment, const Guide& guide, std::size_t g) const {
  const Six& xi = work_.strains[at(segment.first_element)][g];
  return vector(xi.data()) + vector(xi.data() + 3).cross(vector(guide.place[g].data())) +
         vector(guide.slope[g].data());
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

/// Of lengths and angles by the coordinates.
void FrictionRod::gradients() {
  for (Segment& segment : segments_) {
    const Piece& piece = model_->pieces[at(segment.piece)];
    segment.twist.setZero();
    for (int e = segment.first_element; e < segment.first_element + segment.elements; ++e) {
      const Element& element = model_->elements[at(e)];
      const Turn R = Rows(work_.steps[at(e)].data());
      const Vector p = vector(work_.steps[at(e)].data() + 9);
      if (e > segment.first_element) {  // a twist at the start as it is at the end
        const Eigen::Matrix<double, 3, Eigen::Dynamic> shifted =
            segment.twist.topRows<3>() - skew<double>(p) * segment.twist.bottomRows<3>();
        segment.twist.topRows<3>() = R.transpose() * shifted;
        segment.twist.bottomRows<3>() = (R.transpose() * segment.twist.bottomRows<3>()).eval();
      }
      const auto& w = work_.omega[at(e)];
      Vec<double, 6> back;
      for (int i = 0; i < 6; ++i) back[i] = -w[at(i)];
      const Mat<double, 6, 6> J = SE3<double>::left_jacobian(back);
      for (int g = 0; g < element.points; ++g) {
        Mat<double, 6, 6> by_strain = J;
        if (element.points == 2) {  // h/2 ∓ k ad of the other point's strain
          const Six& xi = work_.strains[at(e)][at(1 - g)];
          const double k = g == 0 ? -element.commutator : element.commutator;
          Mat<double, 6, 6> D = Mat<double, 6, 6>::Identity() * (0.5 * element.length);
          D.topLeftCorner<3, 3>() += k * skew<double>(vector(xi.data() + 3));
          D.bottomRightCorner<3, 3>() += k * skew<double>(vector(xi.data() + 3));
          D.topRightCorner<3, 3>() += k * skew<double>(vector(xi.data()));
          by_strain = J * D;
        }
        for (int c = 0; c < 6; ++c)
          for (int a = 0; a < piece.modes[at(c)]; ++a)
            segment.twist.col(piece.offset[at(c)] + a) +=
                piece.scale[at(c)] * element.modes[at(g)][at(a)] * by_strain.col(c);
      }
    }
  }
  for (Chain& chain : chains_) {
    const Unit* before = nullptr;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      Unit& unit = chain.units[k];
      const Segment& segment = segments_[at(unit.segment)];
      const Piece& piece = model_->pieces[at(segment.piece)];
      const Vector r = vector(unit.end.data());
      unit.gradient.assign(at(piece.size), 0.0);
      Eigen::Map<Eigen::RowVectorXd> gradient(unit.gradient.data(), piece.size);
      if (unit.hole) {
        gradient = unit.along_end.transpose() * segment.twist.topRows<3>() +
                   r.cross(unit.along_end).transpose() * segment.twist.bottomRows<3>();
      } else {
        const Element& element = model_->elements[at(segment.first_element)];
        const Guide& guide = model_->guides[at(unit.entry)];
        for (std::size_t g = 0; g < 2; ++g) {
          const Vector f = element.weight * guided(segment, guide, g).normalized(),
                       m = vector(guide.place[g].data()).cross(f);
          for (int c = 0; c < 6; ++c)
            for (int a = 0; a < piece.modes[at(c)]; ++a)
              gradient[piece.offset[at(c)] + a] +=
                  (c < 3 ? f[c] : m[c - 3]) * piece.scale[at(c)] * element.modes[g][at(a)];
        }
      }
      if (chain.tendon.friction > 0) {
        const Vector &d = before == nullptr ? chain.entry : before->along_end, &next = unit.along_start;
        const double c = d.dot(next), s = d.cross(next).norm();
        chain.first[k] = piece.first;
        chain.turns[k].assign(at(piece.size), 0.0);
        if (s > 1e-14) {
          const Vector by_next = unit.turn.transpose() * (c * next - d) / (s * unit.chord);
          const Eigen::RowVectorXd own = by_next.transpose() * segment.twist.topRows<3>() +
                                         r.cross(by_next).transpose() * segment.twist.bottomRows<3>();
          int shift = 0;
          if (before != nullptr) {
            const Segment& last = segments_[at(before->segment)];
            const Piece& last_piece = model_->pieces[at(last.piece)];
            const Vector by_d = (c * d - next) / (s * before->chord),
                         arm = vector(before->end.data()) - before->chord * d;
            chain.first[k] = last_piece.first;
            shift = piece.first - last_piece.first;
            chain.turns[k].assign(at(shift + piece.size), 0.0);
            Eigen::Map<Eigen::RowVectorXd>(chain.turns[k].data(), last_piece.size) =
                by_d.transpose() * last.twist.topRows<3>() +
                arm.cross(by_d).transpose() * last.twist.bottomRows<3>();
          }
          Eigen::Map<Eigen::RowVectorXd>(chain.turns[k].data() + shift, piece.size) += own;
        }
      }
      before = &unit;
    }
  }
}

void FrictionRod::linearise() {
  sweep_back_with_hessian(*model_, work_);
  gradients();
  columns_ = 0;
  for (Chain& chain : chains_) {
    chain.moves = chain.spans.held ? chain.tendon.friction > 0 && chain.spans.tension > 0 : true;
    chain.first_column = columns_;
    if (chain.moves) columns_ += static_cast<int>(chain.units.size());
  }
}

/// ∂l/∂y · x and ∂b/∂y · x of all spans of tendons that move, and of the guide before each.
void FrictionRod::geometry_rates(const double* x, int stride, int columns, Eigen::MatrixXd& lengths_of,
                                 Eigen::MatrixXd& angles_of) const {
  lengths_of.setZero(columns_, columns);
  angles_of.setZero(columns_, columns);
  Eigen::RowVectorXd line(columns);
  const auto product = [&](const std::vector<double>& gradient, int first) {
    line.setZero();
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      const double* from = x + (first + static_cast<int>(i)) * stride;
      for (int j = 0; j < columns; ++j) line[j] += gradient[i] * from[j];
    }
  };
  for (const Chain& chain : chains_) {
    if (!chain.moves) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const Unit& unit = chain.units[k];
      product(unit.gradient, model_->pieces[at(segments_[at(unit.segment)].piece)].first);
      lengths_of.row(chain.first_column + static_cast<int>(k)) = line;
      if (!(chain.tendon.friction > 0)) continue;
      product(chain.turns[k], chain.first[k]);
      angles_of.row(chain.first_column + static_cast<int>(k)) = chain.tendon.friction * line;
    }
  }
}

/// From these to ∂T/∂y · x.
void FrictionRod::tension_rates(const Eigen::MatrixXd& lengths_of, const Eigen::MatrixXd& angles_of,
                                Eigen::MatrixXd& rates) const {
  rates.setZero(columns_, lengths_of.cols());
  for (const Chain& chain : chains_) {
    if (!chain.moves || !chain.taut) continue;
    const int count = static_cast<int>(chain.units.size()), outer = chain.has_outer ? 1 : 0,
              spans = count + outer, guides = spans - 1, from = chain.first_column;
    for (int k = 0; k < count; ++k) {
      auto out = rates.row(from + k);
      for (int j = 0; j < count; ++j) {
        const double rate = chain.by_stretch[at((k + outer) * spans + j + outer)];
        if (rate != 0) out += rate * lengths_of.row(from + j);
      }
      if (!(chain.tendon.friction > 0)) continue;
      for (int g = 0; g < guides; ++g) {
        const double rate = chain.by_grip[at((k + outer) * guides + g)];
        if (rate != 0) out += rate * angles_of.row(from + g + 1 - outer);
      }
    }
  }
}

/// Factors the Hessian at these tensions; how lengths and angles answer to tensions.
bool FrictionRod::factor_rod(double shift) {
  const Inertia inertia = factor(*model_, work_, shift);
  if (!inertia.ok) return false;
  negative_ = inertia.negative;
  if (columns_ == 0) return true;
  std::fill(fed_.begin(), fed_.end(), 0.0);
  for (const Chain& chain : chains_) {
    if (!chain.moves) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const Unit& unit = chain.units[k];
      const int first = model_->pieces[at(segments_[at(unit.segment)].piece)].first,
                column = chain.first_column + static_cast<int>(k);
      for (std::size_t i = 0; i < unit.gradient.size(); ++i)
        fed_[at((first + static_cast<int>(i)) * stride_ + column)] = unit.gradient[i];
    }
  }
  solve(*model_, work_, fed_.data(), columns_, stride_);
  geometry_rates(fed_.data(), stride_, columns_, length_answers_, angle_answers_);
  return length_answers_.allFinite() && angle_answers_.allFinite();
}

/// Tensions as the guides' grips say, and how they answer to the coordinates.
bool FrictionRod::factor_tendons() {
  same_sign_ = negative_ % 2 == 0;
  if (columns_ == 0) return true;
  for (Chain& chain : chains_)
    if (chain.moves && chain.taut) chain.tensions.derivatives(chain.spans, chain.by_stretch, chain.by_grip);
  tension_rates(length_answers_, angle_answers_, small_);
  small_.diagonal().array() += 1;
  if (!small_.allFinite()) return false;
  lu_.compute(small_);
  bool positive = lu_.permutationP().determinant() > 0;
  for (int i = 0; i < columns_; ++i) {
    const double pivot = lu_.matrixLU()(i, i);
    if (pivot == 0) return false;
    positive = positive == (pivot > 0);
  }
  same_sign_ = same_sign_ == positive;
  return true;
}

bool FrictionRod::factor_all(double shift) {
  for (Chain& chain : chains_) chain.tensions.loosen(chain.spans, edge);
  return factor_rod(shift) && factor_tendons();
}

/// One column, its rows eight numbers apart, solved with the rod's Hessian; then what tendons make of it.
/// @param jumps by how much tensions differ from those that the gradient was taken at; may be empty
void FrictionRod::add_tendons(std::span<double> sides, const Eigen::VectorXd& jumps) {
  if (columns_ == 0) return;
  Eigen::MatrixXd lengths, angles, rates;
  geometry_rates(sides.data(), row, 1, lengths, angles);
  tension_rates(lengths, angles, rates);
  Eigen::VectorXd t = rates.col(0);
  if (jumps.size() > 0) t += jumps;
  change_ = lu_.solve(t);
  for (int i = 0; i < model_->size; ++i) {
    double sum = 0;
    for (int j = 0; j < columns_; ++j) sum += fed_[at(i * stride_ + j)] * change_[j];
    sides[at(i * row)] -= sum;
  }
}

void FrictionRod::solve_all(std::span<double> sides) {
  solve(*model_, work_, sides.data(), 1, row);
  add_tendons(sides, {});
}

/// Newton's step into `side_`. How each guide answers is chosen so that it is right at the step's end, as far
/// as lengths are linear: a complementarity problem in the spans' tensions, solved by exchanging what is
/// wrong.
bool FrictionRod::find_step() {
  if (!factor_rod(drag_)) return false;
  std::fill(side_.begin(), side_.end(), 0.0);
  for (int i = 0; i < model_->size; ++i) side_[at(i * row)] = -work_.gradient[at(i)];
  solve(*model_, work_, side_.data(), 1, row);
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(columns_);
  if (columns_ > 0) {
    for (const Chain& chain : chains_)
      if (chain.moves)
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          jumps[chain.first_column + static_cast<int>(k)] = -chain.pull[k];
    choose_grips(-jumps);
    for (Chain& chain : chains_) {
      chain.chosen = chain.tensions.grips;
      chain.was_taut = chain.taut;
    }
    for (Chain& chain : chains_) {
      if (!chain.moves || !chain.taut) continue;
      const std::size_t outer = chain.has_outer ? 1 : 0;
      chain.tensions.follow(chain.spans);
      for (std::size_t k = 0; k < chain.units.size(); ++k)
        jumps[chain.first_column + static_cast<int>(k)] += chain.tensions.tension[k + outer];
    }
  }
  if (!factor_tendons()) return false;
  add_tendons(side_, jumps);
  return true;
}

/// @param tensions those at which the gradient was taken
void FrictionRod::choose_grips(const Eigen::VectorXd& tensions) {
  bool any = false;
  int size = 0;
  for (Chain& chain : chains_) {
    chain.first_span = size;
    if (!chain.moves) continue;
    any = any || chain.tendon.friction > 0 || !chain.spans.held;
    size += static_cast<int>(chain.spans.stretch.size());
  }
  if (!any) return;
  Eigen::MatrixXd ahead, unused;
  geometry_rates(side_.data(), row, 1, ahead, unused);
  // (c + LH⁻¹Lᵀ) t = e − what has come by slip
  Eigen::MatrixXd yields = Eigen::MatrixXd::Zero(size, size), rows(size, size);
  Eigen::VectorXd stretch(size), right(size), t(size), content(size);
  const Eigen::VectorXd now = ahead.col(0) + length_answers_ * tensions;
  for (const Chain& a : chains_) {
    if (!a.moves) continue;
    const int outer = a.has_outer ? 1 : 0, count = static_cast<int>(a.units.size());
    for (int k = 0; k < count + outer; ++k) {
      stretch[a.first_span + k] = a.spans.stretch[at(k)];
      yields(a.first_span + k, a.first_span + k) = a.spans.compliance[at(k)];
    }
    for (int k = 0; k < count; ++k) stretch[a.first_span + outer + k] += now[a.first_column + k];
    for (const Chain& b : chains_) {
      if (!b.moves) continue;
      yields.block(a.first_span + outer, b.first_span + (b.has_outer ? 1 : 0), count,
                   static_cast<int>(b.units.size())) +=
          length_answers_.block(a.first_column, b.first_column, count, static_cast<int>(b.units.size()));
    }
  }
  for (Chain& chain : chains_)  // as the last step had it
    if (chain.moves && chain.chosen.size() == chain.tensions.grips.size()) {
      chain.tensions.grips = chain.chosen;
      chain.taut = chain.was_taut;
    }
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int patience = 6;
  for (int round = 0; round < most_rounds; ++round) {
    rows.setZero();
    right.setZero();
    for (const Chain& chain : chains_) {
      if (!chain.moves) continue;
      const int spans = static_cast<int>(chain.spans.stretch.size());
      if (!chain.taut) {
        for (int k = 0; k < spans; ++k) rows(chain.first_span + k, chain.first_span + k) = 1;
        continue;
      }
      int base = chain.first_span;
      for (int k = 0; k < spans; ++k) {
        const int line = chain.first_span + k;
        if (k > 0 && chain.tensions.grips[at(k - 1)] != Grip::sticks) {  // its own row says how it follows
          rows(line, line) = 1;
          rows(line, line - 1) = -chain.tensions.ratio(chain.spans, at(k - 1));
        } else {
          base = line;
        }
        if (base == chain.first_span && chain.spans.held) {
          if (k == 0) rows(line, line) = 1, right[line] = chain.spans.tension;
        } else {
          rows.row(base) += yields.row(line);
          right[base] += stretch[line];
        }
      }
    }
    t = rows.partialPivLu().solve(right);
    if (!t.allFinite()) return;
    content = stretch - yields * t;
    struct Wrong {
      Chain* chain;
      std::size_t guide;
      Grip to;
      bool taut = true, exchanges = false;  ///< all of the tendon
    };
    std::vector<Wrong> wrong;
    const double small = 1e-12 * t.cwiseAbs().maxCoeff();
    for (Chain& chain : chains_) {
      if (!chain.moves) continue;
      const auto spans = static_cast<Eigen::Index>(chain.spans.stretch.size());
      if (chain.taut ? !chain.spans.held && t.segment(chain.first_span, spans).maxCoeff() <= 0
                     : content.segment(chain.first_span, spans).sum() > edge) {
        wrong.push_back({&chain, 0, Grip::sticks, !chain.taut, true});
        continue;
      }
      if (!chain.taut || !(chain.tendon.friction > 0)) continue;
      double moved = 0;
      for (std::size_t k = chain.spans.stretch.size(); k-- > 1;) {
        const std::size_t g = k - 1;
        const int line = chain.first_span + static_cast<int>(k);
        moved -= content[line];
        if (!(chain.spans.grip[g] > 0)) continue;
        const Grip grip = chain.tensions.grips[g];
        const double f = std::exp(chain.spans.grip[g]);
        if (grip == Grip::sticks) {
          if (t[line - 1] > f * t[line] + small) wrong.push_back({&chain, g, Grip::outward});
          if (t[line] > f * t[line - 1] + small) wrong.push_back({&chain, g, Grip::inward});
        } else if (static_cast<double>(grip) * moved < -edge) {
          wrong.push_back({&chain, g, Grip::sticks});
        }
      }
    }
    if (wrong.empty()) return;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 6;
    } else {
      --patience;
    }
    const std::size_t changed = patience > 0 ? wrong.size() : 1;  // one by one it does not go round
    for (std::size_t i = 0; i < changed; ++i) {
      Chain& chain = *wrong[i].chain;
      if (wrong[i].exchanges)
        chain.taut = wrong[i].taut;
      else
        chain.tensions.grips[wrong[i].guide] = wrong[i].to;
    }
  }
}

double FrictionRod::residual() const {
  return size_of_vector(work_.gradient) / std::sqrt(model_->energy_scale);
}

/// Whether the equilibrium holds, after linearise(): where the symmetric part of its Jacobian is positive
/// definite it does; else as the sign of the determinant says.
bool FrictionRod::holds() {
  if (!factor_all(0)) return false;
  if (!potential_) return same_sign_;
  if (negative_ == 0 || !same_sign_ || columns_ == 0) return same_sign_ && negative_ == 0;
  // J = H + LᵀV. Of the symmetric part H + W S Wᵀ, W = [Lᵀ Vᵀ], S = ½ [0 1; 1 0], the negative directions
  // are those of H and of −S⁻¹ − WᵀH⁻¹W less those of −S⁻¹.
  const int n = model_->size, m = columns_;
  Eigen::MatrixXd V, L(m, n);
  std::vector<double> unit(at(n * n), 0.0);
  for (int i = 0; i < n; ++i) unit[at(i * n + i)] = 1;
  Eigen::MatrixXd lengths_of, angles_of;
  geometry_rates(unit.data(), n, n, lengths_of, angles_of);
  tension_rates(lengths_of, angles_of, V);
  L.setZero();
  for (const Chain& chain : chains_) {
    if (!chain.moves) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const Unit& one = chain.units[k];
      const int first = model_->pieces[at(segments_[at(one.segment)].piece)].first;
      for (std::size_t i = 0; i < one.gradient.size(); ++i)
        L(chain.first_column + static_cast<int>(k), first + static_cast<int>(i)) = one.gradient[i];
    }
  }
  Eigen::MatrixXd W(n, 2 * m);
  W << L.transpose(), V.transpose();
  const int stride = (2 * m + row - 1) / row * row;
  std::vector<double> fed(at(n * stride), 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * m; ++j) fed[at(i * stride + j)] = W(i, j);
  solve(*model_, work_, fed.data(), 2 * m, stride);
  Eigen::MatrixXd B =
      -W.transpose() *
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, Eigen::Unaligned,
                 Eigen::OuterStride<>>(fed.data(), n, 2 * m, Eigen::OuterStride<>(stride));
  for (int i = 0; i < m; ++i) B(i, m + i) -= 2, B(m + i, i) -= 2;
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(B, Eigen::EigenvaluesOnly).eigenvalues();
  const auto below = (values.array() < 0).count();
  return negative_ + static_cast<int>(below) - m == 0 || same_sign_;
}

/// Newton's steps in coordinates and tensions: the Hessian is taken at the tensions that the last step
/// foresaw, since those of stiff tendons at its end are far off.
Relaxed FrictionRod::newton(const RelaxOptions& options) {
  Relaxed result;
  const double scale = std::sqrt(model_->energy_scale), most = std::numbers::pi * scale;
  constexpr int patience = 6;
  for (Chain& chain : chains_) chain.chosen.clear();
  double best = std::numeric_limits<double>::max();
  for (int waits = 0;; ++result.iterations) {
    evaluate();
    sweep_back(*model_, work_);
    add_drag();
    ++result.evaluations;
    result.residual = residual();
    if (result.residual < best) {
      if (result.residual < 0.9 * best) waits = 0;
      best = result.residual;
      std::copy(work_.y.begin(), work_.y.end(), start_.begin());
    }
    if (result.residual <= options.tolerance || waits > patience || !std::isfinite(result.residual)) break;
    if (result.iterations >= options.max_iterations) {
      result.status = Status::iteration_limit;
      return result;
    }
    if (options.stop && options.stop()) {
      result.status = Status::stopped;
      return result;
    }
    for (const Chain& chain : chains_)
      if (!chain.spans.held || (chain.tendon.friction > 0 && chain.spans.tension > 0))  // else it is known
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          (chain.units[k].hole ? work_.hole_tension : work_.guide_tension)[at(chain.units[k].entry)] =
              chain.pull[k];
    linearise();
    add_drag();
    if (!find_step()) {
      result.status = Status::singular;
      return result;
    }
    double length = 0;
    for (int i = 0; i < model_->size; ++i) length += side_[at(i * row)] * side_[at(i * row)];
    const double share = std::min(1.0, most / std::sqrt(length));
    for (int i = 0; i < model_->size; ++i) work_.y[at(i)] += share * side_[at(i * row)];
    for (Chain& chain : chains_)
      if (chain.moves)
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          chain.pull[k] += share * change_[chain.first_column + static_cast<int>(k)];
    ++waits;
  }
  if (result.residual > options.tolerance ||
      !std::isfinite(result.residual)) {  // as near as rounding lets it?
    std::copy(start_.begin(), start_.end(), work_.y.begin());
    evaluate();
    result.residual = best;
    if (!(best <= 1e3 * options.tolerance)) result.status = Status::stalled;
  }
  linearise();
  return result;
}

/// With what resists a motion that has no time to be slow.
void FrictionRod::add_drag() {
  if (drag_ == 0) return;
  for (std::size_t i = 0; i < work_.gradient.size(); ++i)
    work_.gradient[i] += drag_ * (work_.y[i] - anchor_[i]);
}

/// Implicit steps of ẏ = −residual from where the rod was, ever longer, until Newton's method finds the end:
/// as far as it then moves by itself.
Relaxed FrictionRod::flow(const RelaxOptions& options) {
  Relaxed result;
  RelaxOptions each = options;
  each.max_iterations = 25;
  std::vector<std::vector<double>> pulls(chains_.size());
  const auto keep = [&] {
    anchor_ = work_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) pulls[i] = chains_[i].pull;
  };
  keep();
  double drag = 1;
  bool ended = false;
  while (!ended) {
    drag_ = drag < 1e-3 ? 0 : drag;
    const Relaxed one = newton(each);
    ended = drag_ == 0 && one.status == Status::converged;
    drag_ = 0;
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    result.residual = one.residual;
    result.status = one.status;
    if (one.status == Status::stopped) break;
    if (one.status == Status::converged) {
      keep();
      drag *= 0.3;
    } else {
      work_.y = anchor_;
      for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].pull = pulls[i];
      drag = std::max(0.01, 4 * drag);
      if (drag > 1e5) break;
    }
    if (!ended && result.iterations >= 4 * options.max_iterations) {
      result.status = Status::iteration_limit;
      break;
    }
  }
  return result;
}

/// Tendons that do not stretch give way by this share of what they do at first.
void FrictionRod::soften(double share) {
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    Chain& chain = chains_[i];
    if (chain.tendon.compliance > 0) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const double before = chain.compliance[k];
      chain.compliance[k] = share * chain.give[k];
      if (before > 0) chain.offset[k] *= chain.compliance[k] / before;
    }
  }
}

/// Tendons that do not stretch are let give way, and what they gave is taken back.
Relaxed FrictionRod::rigid(const RelaxOptions& options, bool flows) {
  Relaxed result;
  double share = 1, before = std::numeric_limits<double>::infinity(), lowest_failed = 0;
  soften(share);
  std::vector<double> y;
  std::vector<std::vector<double>> pulls(chains_.size());
  const auto remember_start = [&] {
    y = work_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) pulls[i] = chains_[i].pull;
  };
  const auto recall = [&] {
    work_.y = y;
    for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].pull = pulls[i];
  };
  const bool any = std::ranges::any_of(chains_, [](const Chain& c) { return c.tendon.compliance <= 0; });
  for (int round = 0; round < 40; ++round) {
    RelaxOptions each = options;
    if (any && !flows) each.tolerance = std::max(options.tolerance, std::min(1e-4, before));
    const Relaxed one = flows ? flow(each) : newton(each);
    if (round == 0) first_iterations_ = one.iterations;
    result.status = one.status;
    result.residual = one.residual;
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    if (one.status == Status::stopped) break;
    if (one.status != Status::converged) {
      if (round == 0 || share >= 1) break;
      lowest_failed = share;
      soften(share = std::min(1.0, 10 * share));
      recall();
      continue;
    }
    remember_start();
    double off = 0;
    for (Chain& chain : chains_) {
      if (chain.tendon.compliance > 0) continue;
      const std::size_t outer = chain.has_outer ? 1 : 0;
      for (std::size_t k = 0; k < chain.units.size(); ++k) {
        const double wanted = chain.compliance[k] * chain.tensions.tension[k + outer];
        off = std::max(off, std::abs(wanted - chain.offset[k]));
        chain.offset[k] = wanted;
      }
    }
    if (off < 1e-13 && each.tolerance <= options.tolerance) break;
    if (off > 0.2 * before && share > least_give && 0.1 * share > 2 * lowest_failed) soften(share *= 0.1);
    before = off;
    if (round == 39) result.status = Status::stalled;
  }
  return result;
}

Relaxed FrictionRod::equilibrium(const RelaxOptions& options, bool flows) {
  std::vector<std::vector<double>> offsets;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const auto& tension = now_.tendons[i].tension;
    chains_[i].pull.assign(tension.begin() + 1, tension.end());
    offsets.push_back(chains_[i].offset);
  }
  Relaxed result = rigid(options, flows);
  if (result.status == Status::converged && !holds()) {
    result.negative = 1;
    result.status = Status::unstable;
  }
  if (result.status != Status::converged) {
    work_.y = now_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].offset = offsets[i];
  }
  return result;
}

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

double FrictionRod::slack(std::size_t i) const {
  const Memory& memory = now_.tendons[i];
  if (!memory.slack) return 0;
  double sum = memory.outer - memory.end;
  for (std::size_t k = 0; k < memory.content.size(); ++k)
    sum += memory.content[k] - chains_[i].units[k].length;
  return std::max(0.0, sum);
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
  constexpr double least = 1.0 / 256;
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
    if (refused && part <= least) {  // there is none near by: it moves on by itself
      one = equilibrium(options, true);
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

}  // namespace sinew::inline v1::strain
