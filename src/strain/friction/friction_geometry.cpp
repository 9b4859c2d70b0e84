#include <cmath>

#include "base/at.hpp"
#include "sinew/math/se3.hpp"
#include "strain/friction/friction_rod.hpp"

namespace sinew::inline v1::strain {
namespace {

using Vector = Vec3<double>;
using Turn = Mat<double, 3, 3>;
using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

Vector vector(const double* x) { return {x[0], x[1], x[2]}; }

}  // namespace

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

/// ∂Ω/∂ξ of an element at a Gauss point: h/2 ∓ k ad of the other point's strain.
Mat<double, 6, 6> FrictionRod::omega_by_strain(std::size_t e, int g) const {
  const Element& element = model_->elements[e];
  const Six& xi = work_.strains[e][at(1 - g)];
  const double k = g == 0 ? -element.commutator : element.commutator;
  Mat<double, 6, 6> D = Mat<double, 6, 6>::Identity() * (0.5 * element.length);
  D.topLeftCorner<3, 3>() += k * skew<double>(vector(xi.data() + 3));
  D.bottomRightCorner<3, 3>() += k * skew<double>(vector(xi.data() + 3));
  D.topRightCorner<3, 3>() += k * skew<double>(vector(xi.data()));
  return D;
}

/// The twist of a segment's end against its start by the piece's coordinates.
void FrictionRod::find_twist(Segment& segment) const {
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
      if (element.points == 2) by_strain = J * omega_by_strain(at(e), g);
      for (int c = 0; c < 6; ++c)
        for (int a = 0; a < piece.modes[at(c)]; ++a)
          segment.twist.col(piece.offset[at(c)] + a) +=
              piece.scale[at(c)] * element.modes[at(g)][at(a)] * by_strain.col(c);
    }
  }
}

/// The gradient of a tendon's length along a segment by the piece's coordinates.
void FrictionRod::find_length_gradient(Unit& unit) const {
  const Segment& segment = segments_[at(unit.segment)];
  const Piece& piece = model_->pieces[at(segment.piece)];
  unit.gradient.assign(at(piece.size), 0.0);
  Eigen::Map<Eigen::RowVectorXd> gradient(unit.gradient.data(), piece.size);
  if (unit.hole) {
    const Vector r = vector(unit.end.data());
    gradient = unit.along_end.transpose() * segment.twist.topRows<3>() +
               r.cross(unit.along_end).transpose() * segment.twist.bottomRows<3>();
    return;
  }
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

/// The gradient of the angle by which a tendon turns where its k-th unit begins.
void FrictionRod::find_angle_gradient(Chain& chain, std::size_t k) const {
  const Unit& unit = chain.units[k];
  const Unit* before = k == 0 ? nullptr : &chain.units[k - 1];
  const Segment& segment = segments_[at(unit.segment)];
  const Piece& piece = model_->pieces[at(segment.piece)];
  const Vector &d = before == nullptr ? chain.entry : before->along_end, &next = unit.along_start;
  const double c = d.dot(next), s = d.cross(next).norm();
  chain.first[k] = piece.first;
  chain.turns[k].assign(at(piece.size), 0.0);
  if (!(s > 1e-14)) return;
  const Vector r = vector(unit.end.data()),
               by_next = unit.turn.transpose() * (c * next - d) / (s * unit.chord);
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
        by_d.transpose() * last.twist.topRows<3>() + arm.cross(by_d).transpose() * last.twist.bottomRows<3>();
  }
  Eigen::Map<Eigen::RowVectorXd>(chain.turns[k].data() + shift, piece.size) += own;
}

/// Of lengths and angles by the coordinates.
void FrictionRod::gradients() {
  for (Segment& segment : segments_) find_twist(segment);
  for (Chain& chain : chains_)
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      find_length_gradient(chain.units[k]);
      if (chain.tendon.friction > 0) find_angle_gradient(chain, k);
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

}  // namespace sinew::inline v1::strain
