#include "analysis/identify/driven.hpp"

#include <cmath>

#include "analysis/identify/arm_rows.hpp"

namespace sinew::inline v1::identification {
namespace {

/// Between rows further apart nobody saw what the motors did: no lag is left of it.
constexpr double longest_step = 2;

}  // namespace

Driven::Driven(const MeasuredRows& rows, int tendons, const TendonDrive& drive) {
  const std::size_t n = rows.size(), width = at(tendons);
  pulled.resize(n * width);
  by_lag.assign(n * width, 0);
  by_play.assign(n * width, 0);
  for (std::size_t i = 0; i < width; ++i) {
    double left = 0, left_by_play = 0;  // where play left the tendon
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t here = k * width + i;
      const double counted = rows.pulls[here], half = 0.5 * drive.play;
      double now = k == 0 ? counted : left, now_by_play = k == 0 ? 0 : left_by_play;
      if (now <= counted - half) {
        now = counted - half;
        now_by_play = -0.5;
      } else if (now >= counted + half) {
        now = counted + half;
        now_by_play = 0.5;
      }
      const double step = k == 0 || rows.time.empty() ? 1e9 : rows.time[k] - rows.time[k - 1];
      pulled[here] = now;
      by_play[here] = now_by_play;
      if (step > 0 && step < longest_step) {
        // first order, the count linear between rows
        const std::size_t before = here - width;
        const double rate = (now - left) / step, rate_by_play = (now_by_play - left_by_play) / step,
                     decay = drive.lag > 0 ? std::exp(-step / drive.lag) : 0,
                     behind = pulled[before] - left + drive.lag * rate;
        pulled[here] = now - drive.lag * rate + behind * decay;
        by_play[here] = now_by_play - drive.lag * rate_by_play +
                        (by_play[before] - left_by_play + drive.lag * rate_by_play) * decay;
        by_lag[here] = -rate + (by_lag[before] + rate) * decay;
        if (drive.lag > 0) by_lag[here] += behind * decay * step / (drive.lag * drive.lag);
      }
      left = now;
      left_by_play = now_by_play;
    }
  }
}

}  // namespace sinew::inline v1::identification
