#include "analysis/identify/arm_rows.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "sinew/math/entire.hpp"
#include "strain/rod_frames.hpp"

namespace sinew::inline v1 {
namespace {

using strain::Block;
using strain::Element;
using strain::Hole;
using strain::Piece;
using strain::RodFrame;
using Vector = Eigen::Vector3d;
using Turn = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

using identification::at;
Vector of(const strain::Three& x) { return {x[0], x[1], x[2]}; }
Vector of(const double* x) { return {x[0], x[1], x[2]}; }

Eigen::Matrix3d skew(const Vector& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}
Eigen::Matrix3d exponential(const Vector& t) {
  const double angle = t.norm();
  const Eigen::Matrix3d m = skew(t);
  return Eigen::Matrix3d::Identity() + sinc(angle) * m + cosc(angle) * m * m;
}

/// By a turn about z, and by the logarithm of its length.
Vector turned(const Vector& r) { return {-r.y(), r.x(), 0}; }

/// A column of a block: its linear and its angular part.
Vector linear(const Block& b, int k) { return {b.a[0][k], b.a[1][k], b.a[2][k]}; }
Vector angular(const Block& b, int k) { return {b.a[3][k], b.a[4][k], b.a[5][k]}; }

}  // namespace

ArmFields::ArmFields(const Arm& arm) : tendons_(static_cast<int>(arm.tendons.size())) {
  int next = 6 * static_cast<int>(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) {
    routes_.push_back(next);
    next += 2 * static_cast<int>(tendon.routes.size());
  }
  lengths_ = next;
  rest_ = next + 3 * tendons_;
}

ArmRows::ArmRows(const MeasuredArm& arm, const ArmBasis& basis) : arm_(arm), basis_(basis), fields_(arm.arm) {
  set(arm);
}

void ArmRows::set(const MeasuredArm& arm) {
  arm_ = arm;
  model_ = make_rod(arm_.arm, basis_);
  if (!rod_) {
    rod_.emplace(model_);
    tangent_.emplace(model_);
    directions_.resize(at(model_.size * strain::row));
  }
  double end = 0, from = 0;
  std::size_t m = 0;
  section_of_piece_.assign(model_.pieces.size(), 0);
  for (std::size_t k = 0; k < model_.pieces.size(); ++k) {
    const Piece& piece = model_.pieces[k];
    const strain::Span& last = model_.spans[at(piece.first_span + piece.spans - 1)];
    const int first = model_.spans[at(piece.first_span)].first_element;
    while (m + 1 < arm_.arm.sections.size() && from > end + arm_.arm.sections[m].length - 1e-9) {
      end += arm_.arm.sections[m].length;
      ++m;
    }
    section_of_piece_[k] = static_cast<int>(m);
    for (int e = first; e < last.first_element + last.elements; ++e) from += model_.elements[at(e)].length;
  }
  base_turn_ = exponential(of(arm_.marker.tilt.data()));
  straighten();
  load();
}

void ArmRows::straighten() {
  straight_.assign(arm_.arm.tendons.size(), 0);
  straight_by_field_.setZero(fields_.size());
  for (std::size_t k = 0; k < model_.pieces.size(); ++k) {
    const Piece& piece = model_.pieces[k];
    const int m = section_of_piece_[k];
    for (int s = piece.first_span; s < piece.first_span + piece.spans; ++s) {
      const strain::Span& span = model_.spans[at(s)];
      double length = 0;
      for (int e = span.first_element; e < span.first_element + span.elements; ++e) {
        const Element& element = model_.elements[at(e)];
        length += element.length;
        for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
          const strain::Guide& guide = model_.guides[at(i)];
          for (std::size_t g = 0; g < at(element.points); ++g) {
            const Vector slope = of(guide.slope[g]);
            const double x = std::sqrt(1 + slope.squaredNorm());
            straight_[at(guide.tendon)] += element.weight * x;
            straight_by_field_[fields_.radius(guide.tendon, m)] += element.weight * slope.squaredNorm() / x;
          }
        }
      }
      for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
        const Hole& hole = model_.holes[at(i)];
        const Vector across = of(hole.end) - of(hole.start);
        const double x = std::sqrt(length * length + across.squaredNorm());
        straight_[at(hole.tendon)] += x;
        straight_by_field_[fields_.radius(hole.tendon, m)] += across.squaredNorm() / x;
      }
    }
  }
}

void ArmRows::load() {
  const Vector gravity = of(arm_.arm.gravity.data());
  for (std::size_t k = 0; k < model_.masses.size(); ++k) {
    strain::NodeLoad& load = rod_->work().loads[k];
    for (int i = 0; i < 3; ++i) {
      load.force[i] = model_.masses[k].amount * gravity[i];
      for (int j = 0; j < 3; ++j) load.couple[3 * i + j] = gravity[i] * model_.masses[k].moment[at(j)];
    }
  }
}

Status ArmRows::solve(std::span<const double> free_lengths, std::span<double> y) {
  for (std::size_t i = 0; i < rod_->holds.size(); ++i)
    rod_->holds[i] = {.by_tension = false,
                      .tension = 0,
                      .free_length = free_lengths[i],
                      .compliance = arm_.arm.tendons[i].compliance,
                      .toe = arm_.drive.toe[i]};
  strain::RelaxOptions options;
  options.tolerance = tolerance;
  std::copy(y.begin(), y.end(), rod_->work().y.begin());
  strain::Relaxed found = rod_->relax(options);
  if (found.status != Status::converged) {
    std::fill(rod_->work().y.begin(), rod_->work().y.end(), 0.0);
    found = rod_->relax(options);
  }
  if (found.status == Status::converged) std::copy(rod_->work().y.begin(), rod_->work().y.end(), y.begin());
  return found.status;
}

Eigen::Vector3d ArmRows::marker() const {
  const RodFrame& tip = rod_->work().frames.back();
  return of(arm_.marker.base.data()) + base_turn_ * (of(tip.p) + turn_of(tip) * of(arm_.marker.place.data()));
}

void ArmRows::sensitivities(Eigen::Matrix3Xd& by_field, bool exact) {
  const int n = model_.size;
  strain::RodWork& work = rod_->work();
  by_field.setZero(3, fields_.size());
  const Vector mark = of(arm_.marker.place.data());
  if (exact) {
    rod_->linearise(true);
    rod_->factor_all(0);
  }
  // Z = H⁻¹ Qᵀ, Q the marker's motion in the tip's axes; then ∂/∂p = −Zᵀ ∂g/∂p
  thread_local std::vector<double> twists;
  twists.resize(at(6 * n));
  strain::tip_twists(model_, work, twists.data());
  std::fill(directions_.begin(), directions_.end(), 0.0);
  for (int j = 0; j < n; ++j) {
    const Vector v(twists[at(j)], twists[at(n + j)], twists[at(2 * n + j)]),
        w(twists[at(3 * n + j)], twists[at(4 * n + j)], twists[at(5 * n + j)]), q = v + w.cross(mark);
    for (int k = 0; k < 3; ++k) directions_[at(j * strain::row + k)] = q[k];
  }
  rod_->solve_all(directions_, 3, strain::row);
  strain::tangents(model_, work, directions_.data(), *tangent_);

  const std::size_t tendons = arm_.arm.tendons.size();
  const auto tensions = rod_->tensions();
  std::vector<double> give(tendons, 1.0);
  Eigen::Matrix3Xd by_tension = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(tendons));
  for (std::size_t i = 0; i < tendons; ++i) {
    const double* gradient = work.length_gradient.data() + i * at(n);
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < 3; ++k)
        by_tension(k, static_cast<Eigen::Index>(i)) -= gradient[j] * directions_[at(j * strain::row + k)];
    if (!(tensions[i] > 0)) continue;
    const ArmTendon& tendon = arm_.arm.tendons[i];
    const int t = static_cast<int>(i);
    const double toe = arm_.drive.toe[i], low = toe / (2 * tendon.compliance);
    give[i] = tensions[i] >= low ? tendon.compliance : tendon.compliance * std::sqrt(low / tensions[i]);
    by_field.col(fields_.free_length(t)) = by_tension.col(t) * (-1 / give[i]);
    by_field.col(fields_.compliance(t)) =
        by_tension.col(t) * (tendon.pretension * tendon.compliance / give[i] - tensions[i]);
    by_field.col(fields_.toe(t)) =
        by_tension.col(t) * (tensions[i] >= low ? -0.5 / tendon.compliance : -tensions[i] / toe);
  }
  for (std::size_t piece = 0; piece < model_.pieces.size(); ++piece) {
    const Piece& part = model_.pieces[piece];
    const int m = section_of_piece_[piece];
    for (int s = part.first_span; s < part.first_span + part.spans; ++s) {
      const strain::Span& span = model_.spans[at(s)];
      const int last = span.first_element + span.elements;
      for (int e = span.first_element; e < last; ++e) {
        const Element& element = model_.elements[at(e)];
        for (std::size_t g = 0; g < at(element.points); ++g) {
          const Block& strains = tangent_->strains[at(e)][g];
          const auto& xi = work.strains[at(e)][g];
          for (std::size_t c = 3; c < 6; ++c) {
            const double stiff = element.weight * element.stiffness[g][c],
                         moment = stiff * (xi[c] - element.rest[g][c]);
            const int stiffness = fields_.bending_x(m) + static_cast<int>(c) - 3,
                      curvature = fields_.curvature(m, static_cast<int>(c) - 3);
            for (int k = 0; k < 3; ++k) {
              by_field(k, stiffness) -= moment * strains.a[c][k];
              by_field(k, curvature) += stiff * strains.a[c][k];
            }
          }
          const Vector v = of(xi.data()), u = of(xi.data() + 3);
          for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
            const strain::Guide& guide = model_.guides[at(i)];
            const double tension = tensions[at(guide.tendon)];
            if (!(tension > 0)) continue;
            const Vector r = of(guide.place[g]), slope = of(guide.slope[g]), x = v + u.cross(r) + slope;
            const double length = x.norm();
            const Vector t = x / length;
            const auto change = [&](int field, const Vector& dr, const Vector& dslope) {
              const Vector dx = u.cross(dr) + dslope, dt = (dx - t * t.dot(dx)) / length,
                           around = dr.cross(t) + r.cross(dt);
              for (int k = 0; k < 3; ++k)
                by_field(k, field) -=
                    element.weight * tension * (linear(strains, k).dot(dt) + angular(strains, k).dot(around));
              by_field.col(field) +=
                  by_tension.col(guide.tendon) * (element.weight * t.dot(dx) / give[at(guide.tendon)]);
            };
            change(fields_.angle(guide.tendon, m), turned(r), turned(slope));
            change(fields_.radius(guide.tendon, m), r, slope);
          }
        }
      }
      if (span.holes == 0) continue;
      const RodFrame &start = work.frames[at(span.first_element)], &end = work.frames[at(last)];
      const Turn from = turn_of(start), to = turn_of(end);
      const Eigen::Matrix3d back = to.transpose() * from;  // axes of the start in those of the end
      const Vector apart = to.transpose() * (of(end.p) - of(start.p));
      Vector v[3], w[3];  // of the end against the start, in the end's axes
      for (int k = 0; k < 3; ++k) {
        const Vector turn = back * angular(tangent_->nodes[at(span.first_element)], k),
                     move = back * linear(tangent_->nodes[at(span.first_element)], k) + turn.cross(apart);
        v[k] = linear(tangent_->nodes[at(last)], k) - move;
        w[k] = angular(tangent_->nodes[at(last)], k) - turn;
      }
      for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
        const Hole& hole = model_.holes[at(i)];
        const double tension = tensions[at(hole.tendon)];
        if (!(tension > 0)) continue;
        const Vector r = of(hole.end), begin = of(hole.start), x = r + apart - back * begin;
        const double length = x.norm();
        const Vector t = x / length;
        const auto change = [&](int field, const Vector& dend, const Vector& dstart) {
          const Vector dx = dend - back * dstart, dt = (dx - t * t.dot(dx)) / length,
                       around = dend.cross(t) + r.cross(dt);
          for (int k = 0; k < 3; ++k) by_field(k, field) -= tension * (v[k].dot(dt) + w[k].dot(around));
          by_field.col(field) += by_tension.col(hole.tendon) * (t.dot(dx) / give[at(hole.tendon)]);
        };
        change(fields_.angle(hole.tendon, m), turned(r), turned(begin));
        change(fields_.radius(hole.tendon, m), r, begin);
      }
    }
  }
  for (std::size_t i = 0; i < tendons; ++i) {  // the length that it is fitted at is that of the straight arm
    const int t = static_cast<int>(i);
    if (!(tensions[i] > 0)) continue;
    for (int m = 0; m < static_cast<int>(arm_.arm.tendons[i].routes.size()); ++m)
      by_field.col(fields_.radius(t, m)) +=
          by_field.col(fields_.free_length(t)) * straight_by_field_[fields_.radius(t, m)];
  }
  const Vector gravity = of(arm_.arm.gravity.data());
  const Vector tip_place = of(arm_.arm.tip_mass_place.data());
  for (std::size_t node = 1; node < model_.masses.size(); ++node) {
    const auto& mass = model_.masses[node];
    const bool is_tip = node + 1 == model_.masses.size();
    if (mass.amount == 0 && !is_tip) continue;
    const Turn R = turn_of(work.frames[node]);
    for (int k = 0; k < 3; ++k) {
      const Vector v = linear(tangent_->nodes[node], k), w = angular(tangent_->nodes[node], k),
                   moved = R * (mass.amount * v + w.cross(of(mass.moment)));
      for (int j = 0; j < 3; ++j) by_field(k, fields_.gravity(j)) += moved[j];
      by_field(k, fields_.mass()) += gravity.dot(moved);
      if (is_tip) {
        const Vector tip = R * (v + w.cross(tip_place));
        by_field(k, fields_.tip_mass()) += gravity.dot(tip);
        by_field(k, fields_.mass()) -= arm_.arm.tip_mass * gravity.dot(tip);
      }
    }
  }
  // from the tip's axes into those of the measurement
  const RodFrame& tip = work.frames.back();
  const Eigen::Matrix3d out = base_turn_ * turn_of(tip);
  by_field = out * by_field;
  const Vector tilt = of(arm_.marker.tilt.data()), here = of(tip.p) + turn_of(tip) * mark;
  const double angle = tilt.norm();
  const Eigen::Matrix3d t = skew(tilt),
                        right = Eigen::Matrix3d::Identity() - cosc(angle) * t + sinc3(angle) * t * t,
                        by_tilt = -base_turn_ * skew(here) * right;
  for (int j = 0; j < 3; ++j) {
    by_field.col(fields_.marker(j)) = out.col(j);
    by_field.col(fields_.base(j)) = Vector::Unit(j);
    by_field.col(fields_.tilt(j)) = by_tilt.col(j);
  }
}

}  // namespace sinew::inline v1
