#include "sinew/kinematics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/at.hpp"
#include "base/limits.hpp"
#include "kinematics/rods/verdict.hpp"
#include "math/linalg.hpp"
#include "math/plane_axes.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double missed_part = 1e-9;  ///< of a motion that is followed, at most

Report refused_rates(Status status, std::string_view why) {
  Report report = failed(status);
  report.message.append(why);
  return report;
}

bool are_finite(Numbers numbers) {
  return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

/// Equations A·(rates) = b: some rows of translations or forces, then some of turns or moments.
struct RateEquations {
  int forward = 3, turning = 3, inputs = 0;
  std::array<double, 6 * max_rows> a{};
  std::array<double, 6> b{};

  int rows() const { return forward + turning; }
  double* row(int i) { return &a[at(i * inputs)]; }
  double largest(int first, int count) {
    double most = 0;
    for (int i = first * inputs; i < (first + count) * inputs; ++i) most = std::max(most, std::abs(a[at(i)]));
    return most;
  }
  /// Turns and moments to the size of the others.
  void balance() {
    const double ahead = largest(0, forward), about = largest(forward, turning);
    if (!(ahead > 0) || !(about > 0)) return;
    for (int i = forward; i < rows(); ++i) {
      for (int j = 0; j < inputs; ++j) row(i)[j] *= ahead / about;
      b[at(i)] *= ahead / about;
    }
  }
  /// The shortest of the best; whether they do it.
  bool solve_for(std::span<double> rates) {
    balance();
    least_norm(MatrixView(a.data(), rows(), inputs), std::span(b).first(at(rows())), rates);
    double wanted = 0, missed = 0;
    for (int i = 0; i < rows(); ++i) {
      double found = 0;
      for (int j = 0; j < inputs; ++j) found += row(i)[j] * rates[at(j)];
      wanted = std::max(wanted, std::abs(b[at(i)]));
      missed = std::max(missed, std::abs(found - b[at(i)]));
      if (!std::isfinite(found)) return false;
    }
    return missed <= missed_part * wanted;
  }
};

Report rates_in_plane(const RodAnalysis& analysis, Numbers twist, std::span<double> rates) {
  const std::size_t inputs = rates.size();
  const auto part = [&](std::size_t row) {
    return twist.size() == 6 ? twist[row] : twist[std::min<std::size_t>(row, 2)];
  };
  if (twist.size() == 6 && (twist[2] != 0 || twist[3] != 0 || twist[4] != 0))
    return refused_rates(Status::bad_input,
                         "the robot is in the plane z = 0: a twist of it is (vx, vy, 0, 0, 0, w)");
  RateEquations equations;
  equations.forward = 2;
  equations.turning = 1;
  equations.inputs = static_cast<int>(inputs);
  for (std::size_t i = 0; i < plane_axes.size(); ++i) {
    const std::size_t row = plane_axes[i];
    std::copy_n(&analysis.feed[row * inputs], inputs, equations.row(static_cast<int>(i)));
    for (const std::size_t column : plane_axes)
      equations.b[i] += analysis.stiffness[6 * row + column] * part(column);
  }
  if (equations.solve_for(rates)) return {};
  return refused_rates(Status::singular,
                       inputs < plane_axes.size()
                           ? "the platform cannot move so: it has fewer inputs than the plane has freedoms"
                           : "type I: no rates of the inputs move the platform so; what they do depends on "
                             "each other");
}

}  // namespace

Report rod_rates(const RodAnalysis& analysis, Numbers twist, std::span<double> rates) {
  const std::size_t inputs = analysis.sensitivity.size() / 6;
  const bool is_whole = twist.size() == 6;
  if (inputs == 0 || inputs > at(max_rows) || rates.size() != inputs ||
      !(is_whole || (twist.size() == 3 && (inputs == 3 || analysis.is_in_plane))) || !are_finite(twist))
    return refused_rates(Status::bad_input,
                         "a twist has six numbers; or three, of a robot in the plane vx, vy, w, of another "
                         "with three inputs vz, wx, wy");
  if (analysis.is_in_plane) return rates_in_plane(analysis, twist, rates);
  RateEquations equations;
  equations.inputs = static_cast<int>(inputs);
  // U may be infinite where J and K are not; but these do not have the motions that other legs drive
  const bool balances = is_whole && analysis.closing_forces.empty();
  if (!balances && analysis.is_singular())
    return refused_rates(
        Status::singular,
        "type II: the platform can move with all inputs held, so that these do not tell how it "
        "moves; ask beside this configuration");
  if (balances) {
    std::ranges::copy(analysis.feed, equations.a.begin());
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t c = 0; c < 6; ++c) equations.b[r] += analysis.stiffness[6 * r + c] * twist[c];
  } else if (is_whole) {
    std::ranges::copy(analysis.sensitivity, equations.a.begin());
    std::ranges::copy(twist, equations.b.begin());
  } else {
    equations.forward = 1;
    equations.turning = 2;
    for (int i = 0; i < 3; ++i) {
      std::copy_n(&analysis.sensitivity[at(i + 2) * inputs], inputs, equations.row(i));  // z, then x and y
      equations.b[at(i)] = twist[at(i)];
    }
  }
  if (equations.solve_for(rates)) return {};
  if (is_whole && inputs < 6)
    return refused_rates(Status::singular,
                         inputs == 3
                             ? "the platform cannot move so: three inputs move it in three ways, and the "
                               "rest follows; give three numbers, vz, wx, wy"
                             : "the platform cannot move so: it has fewer inputs than a twist has parts");
  return refused_rates(
      Status::singular,
      "type I: no rates of the inputs move the platform so; what they do depends on each other");
}

Report rod_twist(const RodAnalysis& analysis, Numbers rates, std::span<double, 6> twist) {
  const std::size_t inputs = analysis.sensitivity.size() / 6;
  if (inputs == 0 || rates.size() != inputs || !are_finite(rates))
    return refused_rates(Status::bad_input, "there is one rate for each input of the robot");
  if (analysis.is_singular())
    return refused_rates(
        Status::singular,
        "type II: the platform can move with all inputs held, so that their rates do not tell how "
        "it moves; ask beside this configuration");
  for (std::size_t r = 0; r < 6; ++r) {
    twist[r] = 0;
    for (std::size_t k = 0; k < inputs; ++k) twist[r] += analysis.sensitivity[r * inputs + k] * rates[k];
  }
  return {};
}

}  // namespace sinew::inline v1
