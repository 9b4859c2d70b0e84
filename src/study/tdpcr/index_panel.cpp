#include "study/tdpcr/index_panel.hpp"

#include <fmt/format.h>

#include <numbers>

namespace sinew::inline v1::example51 {

using std::numbers::pi;

Axis log_axis(std::string label, std::string unit, double low, double high) {
  return {.label = std::move(label), .unit = std::move(unit), .log = true, .low = low, .high = high};
}

Panel index_panel(Axis y, std::vector<Series> curves, double limit) {
  Series rate{.label = "derived: " + fmt::format("{:.4g}", limit) + " / (π/3 − φ)",
              .x = {},
              .y = {},
              .mark = Mark::dashed,
              .colour = Colour::black,
              .width = 1.5};
  for (int i = 0; i <= 400; ++i) {
    const double eta = 0.9985 * i / 400;
    rate.x.push_back(eta);
    rate.y.push_back(limit / (pi / 3 * (1 - eta)));
  }
  Series end{.label = "last pose: type II singular",
             .x = {1, 1},
             .y = {*y.low, *y.high},
             .mark = Mark::dotted,
             .colour = Colour::vermillion};
  curves.push_back(std::move(rate));
  curves.push_back(std::move(end));
  return {.title = "",
          .x = {.label = "", .unit = "", .low = 0, .high = 1.02},
          .y = std::move(y),
          .series = std::move(curves)};
}

}  // namespace sinew::inline v1::example51
