#include "kinematics/normal_legs.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

#include "sinew/base/limits.hpp"

namespace sinew::inline v0::detail {
namespace {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;
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

bool is_in_domain(std::span<const Reach<3>> legs, Report& report) {
  if (legs.size() > static_cast<std::size_t>(max_rows))
    return refuse(report, Status::left_domain, "more legs than a robot may have (24)");
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Reach<3>& leg = legs[i];
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
Eigen::Index spanned(const Points& points, Vec3<double>& normal) {
  Eigen::JacobiSVD<Points> svd(points, Eigen::ComputeFullU);
  normal = svd.matrixU().col(2);
  return svd.setThreshold(rank_tolerance).rank();
}

/// The six equations that are most independent, orthonormal; false where there are not six.
bool six_sections(NormalLegs& normal, Report& report) {
  const auto count = static_cast<Eigen::Index>(normal.legs.size());
  Eigen::MatrixXd columns(leg_coordinates, count);
  for (Eigen::Index i = 0; i < count; ++i)
    columns.col(i) = leg_equation(normal.legs[static_cast<std::size_t>(i)]).normalized();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(rank_tolerance);
  if (qr.rank() < 6) {
    report.message.append("the legs hold only ");
    append_number(report.message, static_cast<int>(qr.rank()));
    return refuse(report, Status::singular, " of the platform's six freedoms: its poses are a continuum");
  }
  const Eigen::MatrixXd unit = qr.householderQ() * Eigen::MatrixXd::Identity(leg_coordinates, 6);
  normal.sections = unit.transpose().cast<Complex>();
  return true;
}

/// Moves and scales the legs to their own middle and size; false where points lie on a line.
bool normalise(std::span<const Reach<3>> legs, NormalLegs& normal, Report& report) {
  const auto count = static_cast<Eigen::Index>(legs.size());
  Points anchors(3, count), ends(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    anchors.col(i) = legs[static_cast<std::size_t>(i)].anchor;
    ends.col(i) = legs[static_cast<std::size_t>(i)].platform_point;
  }
  anchors = middled(anchors, normal.base_middle);
  ends = middled(ends, normal.platform_middle);
  normal.size = std::max(anchors.cwiseAbs().maxCoeff(), ends.cwiseAbs().maxCoeff());
  for (const Reach<3>& leg : legs) normal.size = std::max(normal.size, leg.distance);
  for (Eigen::Index i = 0; i < count; ++i)
    normal.legs.push_back({anchors.col(i) / normal.size,
                           legs[static_cast<std::size_t>(i)].distance / normal.size,
                           ends.col(i) / normal.size});
  const Eigen::Index base_span = spanned(anchors, normal.base_normal),
                     platform_span = spanned(ends, normal.platform_normal);
  normal.base_is_flat = base_span == 2;
  normal.platform_is_flat = platform_span == 2;
  return (base_span >= 2 && platform_span >= 2) ||
         refuse(report, Status::singular,
                "all base points or all platform points lie on a line: the turn about it is free");
}

}  // namespace

std::optional<NormalLegs> normal_legs(std::span<const Reach<3>> legs, Report& report) {
  if (!is_in_domain(legs, report)) return std::nullopt;
  if (legs.size() < 6) {
    refuse(report, Status::singular, "fewer than six legs: the platform's poses are a continuum");
    return std::nullopt;
  }
  NormalLegs normal;
  if (!normalise(legs, normal, report) || !six_sections(normal, report)) return std::nullopt;
  return normal;
}

}  // namespace sinew::inline v0::detail
