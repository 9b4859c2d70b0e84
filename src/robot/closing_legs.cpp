#include "robot/closing_legs.hpp"

#include <cmath>

#include "base/at.hpp"
#include "sinew/leg/leg_curvature.hpp"

namespace sinew::inline v0 {
namespace {

template <class LegT>
typename LegT::Coordinates coordinates(const LegT& leg, std::span<const double> feeds, int first) {
  return leg.coordinates_of(feeds.subspan(at(first), LegT::inputs));
}

}  // namespace

ClosingLegs::ClosingLegs(std::vector<ClosingLeg> legs, int inputs) : legs_(std::move(legs)), inputs_(inputs) {
  for (const ClosingLeg& one : legs_)
    with_leg(one.leg, [&]<class L>(const L&) {
      rows_ += L::rows;
      for (int k = 0; k < L::inputs; ++k) input_of_.push_back(one.place.input + k);
    });
}

/// Calls `use(leg, place, first row, first feed)`.
template <class Use>
void ClosingLegs::for_each(Use&& use) const {
  int row = 0, feed = 0;
  for (const ClosingLeg& one : legs_)
    with_leg(one.leg, [&]<class L>(const L& leg) {
      use(leg, one.place, row, feed);
      row += L::rows;
      feed += L::inputs;
    });
}

bool ClosingLegs::in_domain(int feed, double value) const {
  bool is = std::isfinite(value);
  for_each([&]<class L>(const L& leg, const LegPlace&, int, int first) {
    if (feed < first || feed >= first + L::inputs || !is) return;
    std::array<double, std::size_t{L::inputs}> inputs;
    inputs.fill(value);
    is = leg.in_domain(leg.coordinates_of(inputs));
  });
  return is;
}

bool ClosingLegs::close_at(const SE3<double>& platform, std::span<double> feeds) const {
  bool closes = true;
  for_each([&]<class L>(const L& leg, const LegPlace&, int, int first) {
    const auto nearest = leg.nearest_solution(platform, Wish{});
    if (nearest.count < 1) {
      closes = false;
      return;
    }
    const auto inputs = leg.inputs_of(nearest.q);
    for (int k = 0; k < L::inputs; ++k) feeds[at(first + k)] = inputs[k];
  });
  return closes;
}

void ClosingLegs::rows_at(const SE3<double>& platform, std::span<const double> feeds,
                          ClosingRows& rows) const {
  rows.count = rows_;
  rows.by_input.setZero(rows_, inputs_);
  for_each([&]<class L>(const L& leg, const LegPlace& place, int row, int first) {
    const auto q = coordinates(leg, feeds, first);
    const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
    const Mat<double, L::rows, L::inputs> by_input = blocks.g_q * leg.input_rate();
    for (int k = 0; k < L::rows; ++k) {
      const double length = blocks.g_x.row(k).template head<3>().norm();
      const double scale = length > 0 ? 1 / length : 0;
      rows.scale[row + k] = scale;
      rows.gap[row + k] = blocks.g[k] * scale;
      rows.by_platform.row(row + k) = blocks.g_x.row(k) * scale;
      for (int j = 0; j < L::inputs; ++j) rows.by_input(row + k, place.input + j) = by_input(k, j) * scale;
    }
  });
}

void ClosingLegs::force_change(
    const SE3<double>& platform, std::span<const double> feeds, const ClosingRows& rows,
    const Vec<double, max_closing_rows>& force, Mat<double, 6, 6>& by_platform,
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows>& by_input) const {
  by_platform.setZero();
  by_input.setZero(6, inputs_);
  for_each([&]<class L>(const L& leg, const LegPlace& place, int row, int first) {
    Vec<double, L::rows> multipliers;  // the force of each row along its line, of which only the line changes
    for (int k = 0; k < L::rows; ++k) multipliers[k] = force[row + k] * rows.scale[row + k];
    const auto change = leg_curvature(leg, platform, coordinates(leg, feeds, first), multipliers);
    by_platform += change.by_platform;
    by_input.template middleCols<L::inputs>(place.input) += change.by_coordinates * leg.input_rate();
  });
}

void ClosingLegs::get_coordinates(std::span<const double> feeds, std::span<double> all) const {
  for_each([&]<class L>(const L& leg, const LegPlace& place, int, int first) {
    const auto q = coordinates(leg, feeds, first);
    std::copy(q.begin(), q.end(), all.begin() + place.coordinate);
  });
}

void ClosingLegs::set_coordinates(std::span<const double> all, std::span<double> feeds) const {
  for_each([&]<class L>(const L& leg, const LegPlace& place, int, int first) {
    const auto inputs = leg.inputs_of(own_coordinates(leg, place, all));
    for (int k = 0; k < L::inputs; ++k) feeds[at(first + k)] = inputs[k];
  });
}

}  // namespace sinew::inline v0
