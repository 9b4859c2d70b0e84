#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/identify/row_fit.hpp"

namespace sinew::inline v1 {
namespace {

/// Soft tendons and no weight: only directions count here, and numbers of a file that are far off buckle the
/// arm.
MeasuredArm softened(MeasuredArm arm) {
  arm.arm.gravity = {0, 0, 0};
  for (ArmTendon& tendon : arm.arm.tendons) {
    double bends = 0;
    for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
      const double radius = tendon.routes[m].start_radius;
      bends += radius * radius * arm.arm.sections[m].length / arm.arm.sections[m].start.bending_x;
    }
    tendon.compliance = std::max(tendon.compliance, bends);
    tendon.pretension = 0;
  }
  return arm;
}

/// Some of the rows, evenly: a map is of few numbers, and rows may be many.
MeasuredRows thinned(const MeasuredRows& rows, std::size_t most) {
  const std::size_t count = rows.size(), stride = (count + most - 1) / std::max<std::size_t>(most, 1),
                    tendons = count > 0 ? rows.pulls.size() / count : 0;
  if (stride <= 1) return rows;
  MeasuredRows few;
  for (std::size_t k = 0; k < count; k += stride) {
    few.pulls.insert(few.pulls.end(), rows.pulls.begin() + static_cast<long>(k * tendons),
                     rows.pulls.begin() + static_cast<long>((k + 1) * tendons));
    few.markers.insert(few.markers.end(), rows.markers.begin() + static_cast<long>(3 * k),
                       rows.markers.begin() + static_cast<long>(3 * k + 3));
  }
  return few;
}

/// Correlation of markers across the arm as complex numbers: its argument is a turn, its size the agreement.
std::complex<double> correlation(const std::vector<double>& predicted, const std::vector<double>& measured,
                                 bool mirrored) {
  const auto across = [](const std::vector<double>& markers, std::size_t k) {
    return std::complex<double>(markers[3 * k], markers[3 * k + 1]);
  };
  std::vector<std::size_t> known;
  for (std::size_t k = 0; 3 * k < predicted.size(); ++k)
    if (!std::isnan(predicted[3 * k])) known.push_back(k);
  std::complex<double> mean_predicted, mean_measured, sum;
  for (const std::size_t k : known) {
    mean_predicted += across(predicted, k);
    mean_measured += across(measured, k);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(known.size(), 1));
  double of_predicted = 0, of_measured = 0;
  for (const std::size_t k : known) {
    const std::complex<double> p = across(predicted, k) - mean_predicted / count,
                               m = across(measured, k) - mean_measured / count;
    sum += m * (mirrored ? p : std::conj(p));
    of_predicted += std::norm(p);
    of_measured += std::norm(m);
  }
  return sum / std::sqrt(std::max(1e-300, of_predicted * of_measured));
}

}  // namespace

Expected<TendonMap> map_tendons(const MeasuredArm& arm, const MeasuredRows& all, ArmModel model,
                                StopToken stop) {
  if (auto fits = identification::check(arm, all); !fits) return tl::unexpected(fits.error());
  const MeasuredRows rows = thinned(all, 400);
  // As long as no tendon is slack, counts the other way are a half turn: then counts are what they should be.
  constexpr double least_gain = 0.02;
  TendonMap best;
  for (int sign : {1, -1}) {
    MeasuredRows turned = rows;
    for (double& pull : turned.pulls) pull *= sign;
    std::complex<double> straight, mirrored;
    // The arm as it is, where it is about right, tells a sign from a half turn by which tendons are slack.
    for (const MeasuredArm& one : {arm, softened(arm)}) {
      const auto predicted = predict_markers(one, turned, model, stop);
      if (!predicted) return tl::unexpected(predicted.error());
      const auto better = [](std::complex<double>& known, std::complex<double> found) {
        if (std::abs(found) > std::abs(known)) known = found;
      };
      const auto found = correlation(*predicted, rows.markers, false);
      if (sign > 0) best.as_given = std::max(best.as_given, found.real());
      better(straight, found);
      better(mirrored, correlation(*predicted, rows.markers, true));
    }
    for (const auto& [found, is_mirrored] : {std::pair{straight, false}, std::pair{mirrored, true}}) {
      const double agreement = std::abs(found);
      const bool is_first = sign > 0 && !is_mirrored;
      if (is_first || agreement > best.agreement + least_gain) {
        if (!is_first) best.next = std::max(best.next, best.agreement);
        best.sign = sign;
        best.mirrored = is_mirrored;
        best.turn = std::arg(found);
        best.agreement = agreement;
      } else {
        best.next = std::max(best.next, agreement);
      }
    }
  }
  return best;
}

MeasuredArm mapped(const MeasuredArm& arm, const TendonMap& map) {
  MeasuredArm result = arm;
  const double sense = map.mirrored ? -1 : 1;
  for (ArmTendon& tendon : result.arm.tendons)
    for (TendonRoute& route : tendon.routes) {
      route.start_angle = map.turn + sense * route.start_angle;
      route.end_angle = map.turn + sense * route.end_angle;
    }
  return result;
}

}  // namespace sinew::inline v1
