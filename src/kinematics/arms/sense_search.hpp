/// @file sense_search.hpp
/// The search for a wrench that explains what was measured, whatever it acts on.
#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// What the wrench acts on.
class LoadedBody {
 public:
  LoadedBody() = default;
  LoadedBody(const LoadedBody&) = delete;
  LoadedBody& operator=(const LoadedBody&) = delete;
  virtual ~LoadedBody() = default;

  /// Its equilibrium under this wrench, from the last one or anew.
  virtual Report load(const std::array<double, 6>& wrench, bool from_last) = 0;
  /// Of the equilibrium: what was measured less what it has, and rates of that by the wrench, six a row, all
  /// in standard deviations. False where it is a fold, which has no rates.
  virtual bool compare(std::vector<double>& off, std::vector<double>& rows) = 0;
};

struct WrenchSearch {
  std::array<double, 6> first{};  ///< wrench from which it begins [N, N m]
  std::size_t unknowns = 6;       ///< 3: the force alone
  /// Which components of the wrench they are; moments come last.
  std::array<std::size_t, 6> components{0, 1, 2, 3, 4, 5};
  double length = 0;  ///< by which moments count [m]
  double usual = 0;   ///< force that bends much [N]: further no step goes at first
  bool from_last = false;
  int most_work = 1 << 30;  ///< equilibria and their iterations
};
struct FoundWrench {
  Report report;
  std::array<double, 6> wrench{};       ///< all of it [N, N m]
  std::array<double, 36> covariance{};  ///< of its unknowns [N², N² m, N² m²]
  double misfit = 0;                    ///< root mean square [1]
  double condition =
      0;  ///< of the wrench, moments over the length: best known over worst known direction [1]
};
/// The body is left in the equilibrium of the answer, or near it.
FoundWrench search_wrench(const WrenchSearch& search, LoadedBody& body);

/// A force at the tip that bends the arm by about two radians [N].
double usual_force(const Arm& arm);
/// What is wrong with the number of things measured, or empty.
std::string_view measurement_misfit(std::size_t tendons, const std::vector<TendonCommand>& held,
                                    const std::vector<double>& answers, std::size_t others,
                                    std::size_t unknowns);

}  // namespace sinew::inline v1
