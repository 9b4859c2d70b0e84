#include "kinematics/modes/normal_legs.hpp"

#include <algorithm>

#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1::detail {
namespace {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
constexpr double rank_tolerance = 1e-9;

bool refuse(Report& report, Status status, std::string_view why) {
  report.status = status;
  report.message.append(why);
  return false;
}

bool refuse_leg(Report& report, std::size_t leg, std::string_view why) {
  report.message.append("legs[");
  append_number(report.message, static_cast<int>(leg));
  report.message.append("]");
  return refuse(report, Status::left_domain, why);
}

bool is_in_domain(std::span<const PlatformConstraint<3>> legs, Report& report) {
  if (legs.size() > static_cast<std::size_t>(max_rows))
    return refuse(report, Status::left_domain, "more legs than a robot may have (24)");
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const PlatformConstraint<3>& leg = legs[i];
    const double extent = leg.anchor.lpNorm<1>() + leg.platform_point.lpNorm<1>() + leg.distance;
    if (!(std::isfinite(extent) && extent < 1e150))
      return refuse_leg(report, i, " is not finite, or too large to be squared");
    if (leg.distance <= 0)
      return refuse_leg(report, i,
                        " has no length: a platform point pinned to the base is not a distance leg");
  }
  return true;
}

Points middled(Points points, Vec3<double>& middle) {
  middle = points.rowwise().mean();
  points.colwise() -= middle;
  return points;
}

/// How many dimensions the points span about their middle, and the direction in which they span least.
int spanned(const Points& points, Vec3<double>& normal) {
  const Svd axes = svd(MatrixView(points.data(), 3, points.cols()));
  normal = axes.u().col(2);
  return rank(axes.sigma(), rank_tolerance);
}

/// Six orthonormal combinations of the legs' equations, the most independent; false where there are not six.
bool six_sections(NormalLegs& normal, Report& report) {
  const auto count = static_cast<Eigen::Index>(normal.legs.size());
  Eigen::Matrix<double, Eigen::Dynamic, leg_coordinates, Eigen::RowMajor> rows(count, leg_coordinates);
  for (Eigen::Index i = 0; i < count; ++i)
    rows.row(i) = leg_equation(normal.legs[static_cast<std::size_t>(i)]).normalized().transpose();
  const Svd equations = svd(MatrixView(rows.data(), count, leg_coordinates));
  const int held = rank(equations.sigma(), rank_tolerance);
  if (held < 6) {
    report.message.append("the legs hold only ");
    append_number(report.message, held);
    return refuse(report, Status::singular, " of the platform's six freedoms: its poses are a continuum");
  }
  normal.sections = equations.v().leftCols<6>().transpose().cast<Complex>();
  return true;
}

/// Moves and scales the legs to their own middle and size; false where points lie on a line.
bool normalise(std::span<const PlatformConstraint<3>> legs, NormalLegs& normal, Report& report) {
  const auto count = static_cast<Eigen::Index>(legs.size());
  Points anchors(3, count), ends(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    anchors.col(i) = legs[static_cast<std::size_t>(i)].anchor;
    ends.col(i) = legs[static_cast<std::size_t>(i)].platform_point;
  }
  anchors = middled(anchors, normal.base_middle);
  ends = middled(ends, normal.platform_middle);
  normal.size = std::max(anchors.cwiseAbs().maxCoeff(), ends.cwiseAbs().maxCoeff());
  for (const PlatformConstraint<3>& leg : legs) normal.size = std::max(normal.size, leg.distance);
  for (Eigen::Index i = 0; i < count; ++i)
    normal.legs.push_back({anchors.col(i) / normal.size,
                           legs[static_cast<std::size_t>(i)].distance / normal.size,
                           ends.col(i) / normal.size});
  const int base_span = spanned(anchors, normal.base_normal),
            platform_span = spanned(ends, normal.platform_normal);
  normal.base_is_flat = base_span == 2;
  normal.platform_is_flat = platform_span == 2;
  return (base_span >= 2 && platform_span >= 2) ||
         refuse(report, Status::singular,
                "all base points or all platform points lie on a line: the turn about it is free");
}

}  // namespace

std::optional<NormalLegs> normal_legs(std::span<const PlatformConstraint<3>> legs, Report& report) {
  if (!is_in_domain(legs, report)) return std::nullopt;
  if (legs.size() < 6) {
    refuse(report, Status::singular, "fewer than six legs: the platform's poses are a continuum");
    return std::nullopt;
  }
  NormalLegs normal;
  if (!normalise(legs, normal, report) || !six_sections(normal, report)) return std::nullopt;
  return normal;
}

}  // namespace sinew::inline v1::detail
