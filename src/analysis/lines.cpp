#include "sinew/analysis/velocity.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/lines.hpp"
#include "base/assert.hpp"
#include "base/limits.hpp"
#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

/// Rank and condition, and how far the free twists of these lines may be off: a line that is off by
/// `type_2_tolerance` turns the null space by as much over the smallest σ that counts.
struct Spectrum {
  TypeTwo type;
  double noise = 0;
};

Spectrum spectrum(const MatrixView& lines, int freedoms) {
  SINEW_EXPECTS(lines.cols() == freedoms && lines.rows() <= max_rows);
  Spectrum found;
  TypeTwo& type = found.type;
  type.singular = true;
  type.kind = LineClass::undefined;
  if (lines.cols() != freedoms || lines.rows() > max_rows || !lines.allFinite()) return found;
  type.kind = LineClass::none;
  if (lines.rows() == 0) return found;

  std::array<double, 6> data;
  const std::span<double> sigma(data.data(), static_cast<std::size_t>(std::min(lines.rows(), lines.cols())));
  singular_values(lines, sigma);
  type.rank = rank(sigma, type_2_tolerance);
  type.singular = type.rank < freedoms;
  if (!type.singular) type.kind = LineClass::regular;
  if (type.rank > 0)
    found.noise = type_2_tolerance * sigma.front() / sigma[static_cast<std::size_t>(type.rank - 1)];
  const double ratio = sigma.front() / sigma.back();
  if (lines.rows() >= freedoms && ratio < 1e15) type.condition = ratio;
  return found;
}

/// An orthonormal basis of the twists that lines in space leave free, one a column; `turn` is ω·radius.
struct FreeTwists {
  int count;
  Mat<double, 3, 6> v, turn;
};

FreeTwists free_twists(const MatrixView& lines, int rank) {
  const Svd parts = svd(lines);
  FreeTwists free{.count = 6 - rank, .v = {}, .turn = {}};
  free.v.leftCols(free.count) = parts.v().topRightCorner(3, free.count);
  free.turn.leftCols(free.count) = parts.v().bottomRightCorner(3, free.count);
  return free;
}

/// Number of singular values above an absolute bound.
int count_above(const MatrixView& a, double bound) {
  std::array<double, 6> data;
  const std::span<double> sigma(data.data(), static_cast<std::size_t>(std::min(a.rows(), a.cols())));
  singular_values(a, sigma);
  return static_cast<int>(std::count_if(sigma.begin(), sigma.end(), [&](double s) { return s > bound; }));
}

/// Klein's form v·ω on the free twists, as its symmetric matrix.
struct KleinForm {
  int size;
  std::array<double, 36> data;

  explicit KleinForm(const FreeTwists& free) : size(free.count), data{} {
    std::size_t k = 0;
    for (int a = 0; a < size; ++a)
      for (int b = 0; b < size; ++b)
        data[k++] = (free.v.col(a).dot(free.turn.col(b)) + free.v.col(b).dot(free.turn.col(a))) / 2;
  }
  /// Dimension of the twists on which it vanishes together with all the others: lines common to the free
  /// twists and to the span of the rows.
  int nullity(double noise) const { return size - count_above({data.data(), size, size}, noise); }
  /// Two free twists only: whether both eigenvalues are of one sign.
  bool definite() const { return data[0] * data[3] > data[1] * data[2]; }
};

Vec3<double> unit_upwards(const Vec3<double>& a) {
  const Vec3<double> unit = a / a.norm();
  for (const int k : {2, 1, 0})
    if (std::abs(unit[k]) > 1e-9) return unit[k] > 0 ? unit : Vec3<double>(-unit);
  return unit;
}

void classify_five(TypeTwo& type, const FreeTwists& free, const Vec3<double>& reference, double radius,
                   double noise) {
  const Vec3<double> v = free.v.col(0), turn = free.turn.col(0);
  if (turn.norm() <= noise) {
    type.kind = LineClass::special_complex;
    type.screw = Screw{std::numeric_limits<double>::infinity(), reference, unit_upwards(v)};
    return;
  }
  const double form = v.dot(turn), scale = radius / turn.squaredNorm();
  const bool rotation = std::abs(form) <= noise;
  type.kind = rotation ? LineClass::special_complex : LineClass::general_complex;
  type.screw = Screw{rotation ? 0 : form * scale, reference + cross(turn, v) * scale, unit_upwards(turn)};
}

LineClass class_of_four(const KleinForm& form, double noise) {
  const int nullity = form.nullity(noise);
  if (nullity == 2) return LineClass::degenerate_congruence;
  if (nullity == 1) return LineClass::parabolic_congruence;
  return form.definite() ? LineClass::elliptic_congruence : LineClass::hyperbolic_congruence;
}

/// c of three rotations about lines through c, from v = c × ω: with V = (v₁ v₂ v₃) and W likewise,
/// [c]ₓ = V W⁻¹, and its transpose is W⁻ᵀ Vᵀ.
std::optional<Vec3<double>> centre(const FreeTwists& free, const Vec3<double>& reference, double radius) {
  std::array<double, 9> x;
  // Columns first, read as rows first: the transposes.
  if (!solve({free.turn.data(), 3, 3}, {free.v.data(), 3, 3}, x)) return std::nullopt;
  return reference + Vec3<double>(x[5] - x[7], x[6] - x[2], x[1] - x[3]) * (radius / 2);
}

void classify_three(TypeTwo& type, const FreeTwists& free, const Vec3<double>& reference, double radius,
                    double noise) {
  const int nullity = KleinForm(free).nullity(noise);
  if (nullity < 3) {
    type.kind = nullity == 0 ? LineClass::regulus : LineClass::two_pencils;
    return;
  }
  // Rotations about the lines through a point (3 ways to turn), those about the lines of a plane (2), or
  // about parallel lines (1: the point is at infinity).
  const int turns = count_above({free.turn.data(), 3, 3}, noise);
  type.kind = turns == 2 ? LineClass::plane_of_lines : LineClass::bundle;
  if (turns == 3) type.point = centre(free, reference, radius);
}

}  // namespace

TypeTwo classify(const MatrixView& lines, const Vec2<double>& reference, double radius) {
  SINEW_EXPECTS(radius > 0);
  auto [type, noise] = spectrum(lines, 3);
  if (type.rank == 1) type.kind = LineClass::coincident;
  if (type.rank != 2) return type;

  const Vec3<double> free = svd(lines).v().col(2);  // (v, ω·radius)
  if (std::abs(free[2]) <= noise) {
    type.kind = LineClass::parallel;
    return type;
  }
  type.kind = LineClass::concurrent;
  const Vec2<double> point = reference + perp(free.head<2>()) * (radius / free[2]);
  type.point = Vec3<double>(point.x(), point.y(), 0);
  return type;
}

TypeTwo classify(const MatrixView& lines, const Vec3<double>& reference, double radius) {
  SINEW_EXPECTS(radius > 0);
  auto [type, noise] = spectrum(lines, 6);
  if (type.rank == 0 || type.rank == 6) return type;

  const FreeTwists free = free_twists(lines, type.rank);
  if (type.rank == 1) type.kind = LineClass::single_line;
  if (type.rank == 2)
    type.kind = KleinForm(free).nullity(noise) == 0 ? LineClass::skew_pair : LineClass::planar_pencil;
  if (type.rank == 3) classify_three(type, free, reference, radius, noise);
  if (type.rank == 4) type.kind = class_of_four(KleinForm(free), noise);
  if (type.rank == 5) classify_five(type, free, reference, radius, noise);
  return type;
}

std::string_view to_string(LineClass kind) noexcept {
  constexpr std::array<std::string_view, 19> names{
      "regular",
      "undefined",
      "none",
      "concurrent",
      "parallel",
      "coincident",
      "1 single line",
      "2a pair of skew lines",
      "2b planar pencil",
      "3a regulus",
      "3b two planar pencils (degenerate regulus)",
      "3c bundle of lines",
      "3d plane of lines",
      "4a elliptic congruence",
      "4b hyperbolic congruence",
      "4c parabolic congruence",
      "4d degenerate congruence",
      "5a general linear complex",
      "5b special linear complex",
  };
  const auto index = static_cast<std::size_t>(kind);
  return index < names.size() ? names[index] : "unknown";
}

}  // namespace sinew::inline v1
