#include "robot/closing_legs.hpp"

#include <cmath>
#include <complex>

#include "base/at.hpp"

namespace sinew::inline v0 {
namespace {

using Complex = std::complex<double>;
constexpr double tiny = 1e-100;  // a complex step: no difference is taken

/// The pose after an imaginary step along one of its six motions.
SE3<Complex> stepped(const SE3<double>& pose, int motion) {
  SE3<Complex> moved{pose.p.cast<Complex>(), {Complex(pose.R.w), pose.R.v.cast<Complex>()}};
  const Complex step(0, tiny);
  if (motion < 3) {
    moved.p[motion] += step;
    return moved;
  }
  Vec3<Complex> half = Vec3<Complex>::Zero();
  half[motion - 3] = 0.5 * step;
  moved.R = SO3<Complex>{Complex(1), half}.compose(moved.R);
  return moved;
}

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
    const auto q = coordinates(leg, feeds, first);
    const Vec<Complex, L::coordinates> z = q.template cast<Complex>();
    // the force of each row along its line, of which only the line changes
    const auto wrench_change = [&](const auto& blocks) {
      Vec<double, 6> change = Vec<double, 6>::Zero();
      for (int k = 0; k < L::rows; ++k)
        for (int c = 0; c < 6; ++c)
          change[c] += force[row + k] * rows.scale[row + k] * blocks.g_x(k, c).imag() / tiny;
      return change;
    };
    for (int motion = 0; motion < 6; ++motion)
      by_platform.col(motion) += wrench_change(
          leg.template blocks<Complex>(stepped(platform, motion), leg.template tip<Complex>(z)));
    const SE3<Complex> here = stepped(platform, 0);
    SE3<Complex> still = here;
    still.p[0] = platform.p[0];
    const Mat<double, L::coordinates, L::inputs> rate = leg.input_rate();
    for (int j = 0; j < L::inputs; ++j) {
      Vec<Complex, L::coordinates> moved = z;
      for (int c = 0; c < L::coordinates; ++c) moved[c] += Complex(0, tiny * rate(c, j));
      by_input.col(place.input + j) +=
          wrench_change(leg.template blocks<Complex>(still, leg.template tip<Complex>(moved)));
    }
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
