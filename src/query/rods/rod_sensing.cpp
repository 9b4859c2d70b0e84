/// `statics` of robots on rods: the wrench from axial forces.
#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "query/questions.hpp"
#include "query/rods/rods.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

namespace {

/// Inputs and what rods pull at their guides.
struct RodSensing : Context {
  explicit RodSensing(const Context& context) : Context(context) {}

  void read();
  void solve();
  void tell();

 private:
  std::vector<double> inputs_ = {}, axial_ = {}, deviations_ = {};
  EquilibriumOptions options_ = {};
  bool has_deviations_ = false;
  RodWants wanted_ = {};
  SensedWrench sensed_ = {};
};

void RodSensing::read() {
  constexpr std::size_t rods = 6;
  inputs_ = read_inputs(*this, query.required("inputs", "rod lengths, in leg order"));
  const Reader axial = query.required("axial_forces", "what each rod pulls at its guide: six forces");
  if (leg_count(robot) != static_cast<int>(rods))
    axial.fail("not_available", "a wrench has six parts: it is read from six rods");
  axial_ = read_forces(axial, rods, Range::between(-1e9, 1e9), false);
  const auto deviation = query.optional("deviation");
  has_deviations_ = deviation.has_value();
  deviations_ =
      deviation ? read_forces(*deviation, rods, Range::not_negative(), true) : std::vector<double>(rods, 0.0);
  options_.gravity = read_gravity_of(*this);
  options_.start = read_spatial_start(*this);
  if (max_iterations) options_.max_iterations = *max_iterations;
  wanted_ = read_rod_wants(*this);
}

void RodSensing::solve() {
  options_.warm_start = holds_last(*this) || (path_start() && !options_.start);
  sensed_ = sense_wrench(robot, inputs_, axial_, deviations_, options_, work);
  remember_held(*this, sensed_.report.is_solved() ? std::optional(sensed_.pose) : std::nullopt);
}

Value rows_value(const std::array<double, 36>& numbers) { return Value(MatrixView(numbers.data(), 6, 6)); }

void RodSensing::tell() {
  report(sensed_.report);
  if (!sensed_.report.is_solved()) return;
  answer["iterations"] = sensed_.report.iterations;
  answer["residual"] = sensed_.report.residual;
  put_rod_wants(*this, held_equilibrium(robot, work), wanted_, options_.gravity);
  answer["wrench"] = Value(std::span<const double>(sensed_.wrench.data(), 6));
  answer["wrench_sensitivity"] = rows_value(sensed_.sensitivity);
  if (has_deviations_ &&
      std::ranges::all_of(sensed_.covariance, [](double part) { return std::isfinite(part); }))  // of squares
    answer["covariance"] = rows_value(sensed_.covariance);
}

}  // namespace

void answer_rods_statics(Context& context) { answer_question<RodSensing>(context); }

}  // namespace sinew::inline v1
