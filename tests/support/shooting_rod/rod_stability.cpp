#include <array>
#include <cmath>
#include <numbers>

#include "math/linalg.hpp"
#include "shooting_rod/rod_bvp.hpp"
#include "shooting_rod/rod_tangents.hpp"

namespace sinew::inline v1 {
namespace {

using Matrix6 = Mat<double, 6, 6>;
constexpr int max_pieces = 256;
constexpr double free_turn = 1e-5;  // EI/L: what resists less turns freely

/// Units in which all that bends is of order 1.
struct Units {
  Units(const SpatialRod& rod, double rod_length)
      : length(rod_length),
        moment(std::sqrt(rod.bending_stiffness[0]) * std::sqrt(rod.bending_stiffness[1]) / rod_length),
        force(moment / rod_length) {}
  double length, moment, force;
};

/// A piece between two sections, by what it resists to their motions (translation, rotation vector): the
/// wrenches on it are  far = Kff z_far + Kfn z_near  and  near = Knf z_far + Knn z_near.
struct Piece {
  Matrix6 far_far, far_near, near_far, near_near;
};

/// False where the far end cannot be moved every way.
bool find_piece(const Units& unit, const Mat<double, 12, 10>& rate, Piece& piece) {
  Vec<double, 12> row;
  row << Vec3<double>::Constant(1 / unit.length), Vec3<double>::Ones(),
      Vec3<double>::Constant(1 / unit.force), Vec3<double>::Constant(1 / unit.moment);
  const Mat<double, 12, 10> r = row.asDiagonal() * rate;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> by_wrench;
  by_wrench << r.topLeftCorner<6, 3>() * unit.force, r.block<6, 3>(0, 3) * unit.moment;
  Matrix6 wrench, pose = Matrix6::Zero(), moved = Matrix6::Zero();
  wrench << r.bottomLeftCorner<6, 3>() * unit.force, r.block<6, 3>(6, 3) * unit.moment;
  pose.topLeftCorner<3, 3>().setIdentity();
  pose.rightCols<3>() = r.block<6, 3>(0, 6);
  moved.rightCols<3>() = r.block<6, 3>(6, 6);

  // z_far = pose z_near + by_wrench w_near,  w_far = moved z_near + wrench w_near,  near = −w_near
  Eigen::Matrix<double, 6, 12, Eigen::RowMajor> right, solved;
  right << Matrix6::Identity(), -pose;
  if (!solve(MatrixView(by_wrench.data(), 6, 6), MatrixView(right.data(), 6, 12),
             {solved.data(), static_cast<std::size_t>(solved.size())}))
    return false;
  piece.near_far = -solved.leftCols<6>();
  piece.near_near = -solved.rightCols<6>();
  piece.far_far = wrench * solved.leftCols<6>();
  piece.far_near = moved + wrench * solved.rightCols<6>();
  return true;
}

struct Inertia {
  int negative = 0;
  bool has_free_turn = false;  ///< an eigenvalue that is 0 but for rounding: neither stable nor unstable
};

template <int n>
Inertia inertia(const Mat<double, n, n>& a) {
  const Eigen::Matrix<double, n, n, Eigen::RowMajor> rows = a;
  std::array<double, static_cast<std::size_t>(n)> values;
  symmetric_eigenvalues(MatrixView(rows.data(), n, n), values);
  Inertia found;
  for (const double value : values) {
    found.negative += value < -free_turn;
    found.has_free_turn = found.has_free_turn || std::abs(value) <= free_turn;
  }
  return found;
}

/// Pieces so short that none is unstable by itself: the section turns by less than half a radian in each.
int pieces_for(const SpatialRod& rod, double length, const RodState<double>& base) {
  const double softest = std::min(rod.bending_stiffness.minCoeff(), rod.torsion_stiffness);
  const Vec3<double> moment = base.R.rotate_back(base.m);
  const Vec3<double> bend(moment[0] / rod.bending_stiffness[0], moment[1] / rod.bending_stiffness[1],
                          moment[2] / rod.torsion_stiffness);
  const double force = base.n.norm() + length * rod.load.norm();
  const double turn = length * ((bend + rod.precurvature).norm() + std::sqrt(force / softest));
  return turn < 0.5 * max_pieces ? std::max(8, static_cast<int>(std::ceil(2 * turn))) : 0;
}

/// The pieces put together from the base on: what the part so far resists to a motion of its end, and the
/// directions in which it has given way.
class Assembly {
 public:
  void begin(const Piece& first, const RodEnds& ends, const Vec3<double>& tangent) {
    stiffness_ = first.far_far;
    if (ends.base == RodEnds::Base::held) return;
    const double pivot = dot(tangent, Vec3<double>(first.near_near.bottomRightCorner<3, 3>() * tangent));
    unstable_ += pivot < 0;
    stiffness_ -= (first.far_near.rightCols<3>() * tangent) *
                  (tangent.transpose() * first.near_far.bottomRows<3>()) / pivot;
  }

  bool append(const Piece& next) {
    Matrix6 joint = stiffness_ + next.near_near;
    const Inertia found = inertia<6>(joint);
    unstable_ += found.negative;
    if (found.has_free_turn) joint += 2 * free_turn * Matrix6::Identity();
    const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> left = joint, right = next.near_far;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> solved;
    if (!solve(MatrixView(left.data(), 6, 6), MatrixView(right.data(), 6, 6), {solved.data(), 36}))
      return false;
    stiffness_ = next.far_far - next.far_near * solved;
    return true;
  }

  int unstable(const RodEnds& ends, const Vec3<double>& tangent) const {
    const Mat<double, 3, 3> turn = stiffness_.bottomRightCorner<3, 3>();
    if (ends.tip == RodEnds::Tip::ball) return unstable_ + inertia<3>(turn).negative;
    const bool turns = dot(tangent, Vec3<double>(turn * tangent)) < -free_turn;
    return unstable_ + (ends.tip == RodEnds::Tip::tangent && turns);
  }

 private:
  Matrix6 stiffness_ = Matrix6::Zero();
  int unstable_ = 0;
};

}  // namespace

// Substructures: the number of negative directions of a rod in pieces is the sum of those of its pieces,
// none, and of the joints, each with all before it given way (Haynsworth).
int unstable_directions(const SpatialRod& rod, double length, const RodState<double>& base,
                        const RodEnds& ends) {
  if (integrate(rod, length, base, {0, 1e-3}).status == Status::left_domain) return -1;
  const int pieces = pieces_for(rod, length, base);
  if (pieces == 0) return -1;
  const Units unit(rod, length);
  SpatialRod near = rod;  // a straight piece that does not stretch has no finite stiffness
  near.extension_compliance = std::max(rod.extension_compliance, 1e-8 / unit.force);
  constexpr int steps = 2;
  RodState<double> at = base;
  Assembly all;
  for (int k = 0; k < pieces; ++k) {
    rod_steps::Walk<double> walk(near, length / pieces, at, steps);
    rod_steps::Tangents<3> columns(at, rod.load, length / pieces);
    for (int i = 0; i < steps; ++i) {
      walk.step();
      columns.step(walk);
    }
    Piece piece;
    if (!find_piece(unit, columns.rate(walk), piece)) return -1;
    if (k == 0) all.begin(piece, ends, at.tangent());
    if (k > 0 && !all.append(piece)) return -1;
    at = walk.state(at);
  }
  return all.unstable(ends, at.tangent());
}

}  // namespace sinew::inline v1
