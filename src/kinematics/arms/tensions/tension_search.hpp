/// @file tension_search.hpp
/// The search for tensions that take a tip, or a platform, to a target, whatever they pull at.
#pragma once
#include <string_view>
#include <vector>

#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// What is pulled.
class PulledBody {
 public:
  PulledBody() = default;
  PulledBody(const PulledBody&) = delete;
  PulledBody& operator=(const PulledBody&) = delete;
  virtual ~PulledBody() = default;

  /// Its equilibrium under these tensions [N], from the last one or anew.
  virtual Report pull(const std::vector<double>& tensions, bool from_last) = 0;
  virtual const SE3<double>& tip() const = 0;
  /// Twist of the tip by tensions, 6 rows [m/N, rad/N]; false where there is none.
  virtual bool rates(std::vector<double>& J) = 0;
  /// Tensions of its last equilibrium [N]; empty where there is none.
  virtual std::vector<double> last_tensions() const = 0;
  /// This equilibrium may be what is answered.
  virtual void keep() = 0;
  /// It is what the next question to the body begins from.
  virtual void bring_back() = 0;
};

/// What is off by more than so many times the precision is not at the target [1]; what is off by less is,
/// though finer polynomials may move it a little.
inline constexpr double far_multiple = 10;
/// What a tip is off where no equilibrium was found.
inline constexpr double error_of_none = 1e300;

struct TensionSearch {
  std::size_t tendons = 0;
  std::string_view what = "tip", whose = "the arm's";  ///< what is taken to the target; whose length counts
  double length = 0;                                   ///< by which places count [m]
  double usual = 0;                                    ///< tension that bends by about a radian [N]
  double most = 0;                                     ///< [N]
  double asked = 0;                                    ///< bound of the question [N]; 0: none
  double precision = 0;
  int starts = 0;
  bool from_last = false;
  int most_work = 1 << 30;  ///< equilibria and their iterations, of all starts: any number, if not told
};
struct FoundTensions {
  Report report;  ///< of the equilibrium; its residual is what the tip is off
  std::vector<double> tensions;
  bool has_begun = false;  ///< some first tensions hold the body
};

/// Tensions of a target with the least sum of squares, or those that come nearest to it.
FoundTensions search_tensions(const ArmTarget& target, const TensionSearch& search, PulledBody& body);

/// The tension of a tendon that bends its section by about one radian: the least of all [N].
double usual_tension(const Arm& arm);
/// The bound that the question sets, or one beyond what any arm is pulled with [N].
double most_tension(const ArmInverseOptions& options, double usual);
std::vector<TendonCommand> as_commands(const std::vector<double>& tensions);

}  // namespace sinew::inline v1
