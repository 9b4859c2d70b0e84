/// @file sense_search.hpp
/// The search for a wrench that explains what was measured, whatever it acts on.
#pragma once
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// What was measured less what an equilibrium has, and rates of that by the wrench, in standard deviations.
struct Comparison {
  std::vector<double> off, rows;  ///< of these six each

  void add(double difference, const double* by_wrench, double deviation) {
    off.push_back(difference / deviation);
    for (std::size_t k = 0; k < 6; ++k) rows.push_back(by_wrench[k] / deviation);
  }
  /// Of every tendon that was measured, what is not held. @param by_wrench six rates a tendon
  template <class Measurement, class State>
  void add_tendons(const Measurement& measured, const State& state, const std::vector<double>& by_wrench) {
    for (std::size_t i = 0; i < measured.answers.size(); ++i) {
      if (std::isnan(measured.answers[i])) continue;
      const bool is_change = measured.held[i].held == TendonHeld::tension;
      add(measured.answers[i] - (is_change ? state.changes[i] : state.tensions[i]), by_wrench.data() + 6 * i,
          is_change ? measured.change_deviation : measured.tension_deviation);
    }
  }
};

/// What the wrench acts on.
class LoadedBody {
 public:
  LoadedBody() = default;
  LoadedBody(const LoadedBody&) = delete;
  LoadedBody& operator=(const LoadedBody&) = delete;
  virtual ~LoadedBody() = default;

  /// Its equilibrium under this wrench, from the last one or anew.
  virtual Report load(const std::array<double, 6>& wrench, bool from_last) = 0;
  /// Of the equilibrium. False where it is a fold, which has no rates.
  virtual bool compare(Comparison& with) = 0;
};

struct WrenchSearch {
  std::array<double, 6> first{};  ///< wrench from which it begins [N, N m]
  std::size_t unknowns = 6;       ///< 3: the force alone
  /// Which components of the wrench they are; moments come last.
  std::array<std::size_t, 6> components{0, 1, 2, 3, 4, 5};
  /// Of it what acts anyway [N, N m]: of several wrenches that explain what was measured as well the one that
  /// is least beside this is answered.
  std::array<double, 6> known{};
  double length = 0;  ///< by which moments count [m]
  double usual = 0;   ///< force that bends much [N]: further no step goes at first
  bool from_last = false;
  int most_work = 1 << 30;  ///< equilibria and their iterations: any number, if not told
};
struct FoundWrench {
  Report report;
  std::array<double, 6> wrench{};       ///< all of it [N, N m]
  std::array<double, 36> covariance{};  ///< of its unknowns [N², N² m, N² m²]
  std::size_t measured = 0;             ///< numbers that were compared [1]
  double misfit = not_a_number;         ///< root mean square [1]; not a number: nothing was compared
  double condition =
      0;  ///< of the wrench, moments over the length: best known over worst known direction [1]
};
/// A misfit beyond which what is measured is not explained [1]: of errors as large as they are said to be it
/// is about 1, and hardly ever that large.
inline constexpr double large_misfit = 5;
/// Says so of a wrench that was found, or that the search was cut off.
void report_misfit(double misfit, Report& report);

/// Where another wrench was found that explains what was measured as well the message tells it.
/// The body is left in the equilibrium of the answer, or near it.
FoundWrench search_wrench(const WrenchSearch& search, LoadedBody& body);

/// A force at the tip that bends the arm by about two radians [N].
double usual_force(const Arm& arm);
/// What is wrong with what is measured of tendons, and with the number of things measured; or empty.
std::string_view measurement_misfit(std::size_t tendons, const std::vector<TendonCommand>& held,
                                    const std::vector<double>& answers, std::size_t others,
                                    std::size_t unknowns, std::initializer_list<double> deviations);

}  // namespace sinew::inline v1
