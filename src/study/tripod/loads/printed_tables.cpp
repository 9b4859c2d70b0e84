#include "study/tripod/loads/printed_tables.hpp"

#include <cmath>

namespace sinew::inline v1::tripod {
namespace {

using Weights = std::array<double, load_steps>;

// Least squares through four values an even step apart, the first one step from 0.
constexpr Weights parabola_at_0{2.25, -0.75, -1.25, 0.75};
constexpr Weights line_at_0{1, 0.5, 0, -0.5};
constexpr Weights line_slope{-0.3, -0.1, 0.1, 0.3};  // per step

/// Σ weight · |load| / RMS.
double weighted(const RmsCells& cells, Load load, std::size_t variable, const Weights& weights) {
  double sum = 0;
  for (std::size_t step = 1; step <= load_steps; ++step)
    sum += weights[step - 1] * std::abs(value_of(load, step)) / cell(cells, load, step, variable);
  return sum;
}

}  // namespace

const char* name_of(Load load) {
  return load == Load::force_z ? "F_z" : load == Load::moment_x ? "M_x" : "M_y";
}

const char* unit_of(Load load) { return load == Load::force_z ? "N" : "N m"; }

double value_of(Load load, std::size_t step) {
  return (load == Load::force_z ? -2.5 : 0.25) * static_cast<double>(step);
}

double cell(const RmsCells& cells, Load load, std::size_t step, std::size_t variable) {
  return cells[static_cast<std::size_t>(load)][step - 1][variable];
}

double linear_limit(const RmsCells& cells, Load load, std::size_t variable) {
  return 1 / weighted(cells, load, variable, parabola_at_0);
}

double pole(const RmsCells& cells, Load load, std::size_t variable) {
  return -weighted(cells, load, variable, line_at_0) / weighted(cells, load, variable, line_slope) *
         std::abs(value_of(load, 1));
}

}  // namespace sinew::inline v1::tripod
