/// `statics` of robots on rods: the wrench from axial forces.
#include <algorithm>
#include <cmath>

#include "io/reader.hpp"
#include "query/rods/rods.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

namespace {

struct SensingQuery {
  std::vector<double> inputs, axial, deviations;
  EquilibriumOptions options;
  bool has_deviations = false;
  RodWants wanted;
};

SensingQuery read_sensing(Context& context) {
  constexpr std::size_t rods = 6;
  SensingQuery asked;
  asked.inputs = read_inputs(context, context.query.required("inputs", "rod lengths, in leg order"));
  const Reader axial = context.query.required("axial_forces", "what each rod pulls at its guide: six forces");
  if (leg_count(context.robot) != static_cast<int>(rods))
    axial.fail("not_available", "a wrench has six parts: it is read from six rods");
  asked.axial = read_forces(axial, rods, Range::between(-1e9, 1e9), false);
  const auto deviation = context.query.optional("deviation");
  asked.has_deviations = deviation.has_value();
  asked.deviations =
      deviation ? read_forces(*deviation, rods, Range::not_negative(), true) : std::vector<double>(rods, 0.0);
  asked.options.gravity = read_gravity_of(context);
  asked.options.start = read_spatial_start(context);
  if (context.max_iterations) asked.options.max_iterations = *context.max_iterations;
  asked.wanted = read_rod_wants(context);
  return asked;
}

Value rows_value(const std::array<double, 36>& numbers) { return Value(MatrixView(numbers.data(), 6, 6)); }

void answer_sensing(Context& context, const SensingQuery& asked) {
  EquilibriumOptions options = asked.options;
  options.warm_start = holds_last(context) || (context.path_start() && !options.start);
  const SensedWrench sensed =
      sense_wrench(context.robot, asked.inputs, asked.axial, asked.deviations, options, context.work);
  context.report(sensed.report);
  const bool is_solved = sensed.report.is_solved();
  remember_held(context, is_solved ? std::optional(sensed.pose) : std::nullopt);
  if (!is_solved) return;
  Value& answer = context.answer;
  answer["iterations"] = sensed.report.iterations;
  answer["residual"] = sensed.report.residual;
  put_rod_wants(context, held_equilibrium(context.robot, context.work), asked.wanted, options.gravity);
  answer["wrench"] = Value(std::span<const double>(sensed.wrench.data(), 6));
  answer["wrench_sensitivity"] = rows_value(sensed.sensitivity);
  if (asked.has_deviations &&
      std::ranges::all_of(sensed.covariance, [](double part) { return std::isfinite(part); }))  // of squares
    answer["covariance"] = rows_value(sensed.covariance);
}

}  // namespace

void answer_rods_statics(Context& context) { handle<read_sensing, answer_sensing>(context); }

}  // namespace sinew::inline v1
