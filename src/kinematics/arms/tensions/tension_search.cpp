#include "kinematics/arms/tensions/tension_search.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/arms/tensions/bounded_least_squares.hpp"
#include "kinematics/arms/tensions/target_rows.hpp"

namespace sinew::inline v1 {

std::vector<TendonCommand> as_commands(const std::vector<double>& tensions) {
  std::vector<TendonCommand> commands;
  for (const double tension : tensions) commands.push_back({TendonHeld::tension, tension});
  return commands;
}

double usual_tension(const Arm& arm) {
  double least = 1e300;
  for (std::size_t m = 0; m < arm.sections.size(); ++m)
    for (const ArmTendon& tendon : arm.tendons) {
      if (tendon.section() != static_cast<int>(m)) continue;
      const ArmSection& section = arm.sections[m];
      least = std::min(least, section.start.bending_x / (section.length * tendon.routes[m].start_radius));
    }
  return least;
}

double most_tension(const ArmInverseOptions& options, double usual) {
  constexpr double unbounded = 1e3;  // usual tensions: an arm that is pulled so hard is bent to a point
  return options.most_tension > 0 ? options.most_tension : unbounded * usual;
}

namespace {

double squares(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

/// Steps from one beginning [1]: a way that takes this many goes to and fro.
constexpr int most_tension_steps = 100;
/// What a step along the target to less tension may be off it, over the length and [rad]: the last steps go
/// back to it.
constexpr double near_target = 1e-3;
/// The first radius, and the least with which the way along the target begins, over the usual tension [1]:
/// half a radian of bending, within which rates tell much, and a tenth.
constexpr double first_radius = 0.5, first_radius_along = 0.1;
/// Radii over the usual tension [1] below which a way along the target is given up for the last steps, and
/// any way for good; and tensions over the usual one [1] that change so little that the least are found, or
/// that no step is left.
constexpr double least_radius_along = 1e-3, least_tension_radius = 1e-8, least_change_along = 1e-4,
                 least_change = 1e-13;
/// Steps from a step along the target back to it [1]: errors square with each.
constexpr int most_steps_back = 3;
/// A radius that was used up doubles, and one that was too large becomes this share of the step [1].
constexpr double wider = 2, narrower = 0.4;
/// A step along the target to a larger sum is taken where it leaves less than this share of what the tip is
/// off [1].
constexpr double much_nearer = 0.3;
/// First tensions beyond the first beginning over the usual one [1], and what each further beginning adds:
/// from bent by about half a radian on.
constexpr double first_pull = 0.4, more_pull = 0.15;

/// To the target by the nearest tensions; along it to the least; and to the target again, exactly.
enum class Phase { there, least, exact };

class TensionSteps {
 public:
  TensionSteps(const ArmTarget& target, const TensionSearch& search, PulledBody& body)
      : target_(target),
        search_(search),
        body_(body) {}
  FoundTensions run() {
    best_.report.residual = error_of_none;
    for (int start = 0;
         start < search_.starts && best_.report.residual > search_.precision && spent_ < search_.most_work;
         ++start) {
      const bool has_begun = begin(start);
      if (is_over_) return best_;
      if (!has_begun) continue;
      for (int k = 0; k < most_tension_steps && spent_ < search_.most_work; ++k, ++iterations_)
        if (!step()) break;
      if (is_over_) return best_;
      if (error_ < best_.report.residual && report_.is_solved()) {
        best_.tensions = tensions_;
        best_.report = report_;
        best_.report.residual = error_;
        body_.keep();
      }
    }
    best_.report.iterations = iterations_;
    return best_;
  }

 private:
  Report pull(const std::vector<double>& tensions, bool from_last) {
    const Report report = body_.pull(tensions, from_last);
    spent_ += 1 + report.iterations;
    return report;
  }
  double error() const { return off_target(target_, body_.tip(), search_.length); }
  /// @returns false
  bool end_with(const Report& report) {
    best_.report = report;
    best_.tensions = tensions_;
    is_over_ = true;
    return false;
  }
  /// None, or those of the last equilibrium; then of about a third of the tendons, others each time and more
  /// each time.
  std::vector<double> first_tensions(int start, bool from_last) const {
    const std::size_t m = search_.tendons;
    std::vector<double> tensions(m, 0.0);
    if (start > 0)
      for (std::size_t i = 0; i < m; ++i)
        if ((i * 7 + static_cast<std::size_t>(start) * 5) % m < 1 + m / 3)
          tensions[i] = std::min(search_.most, search_.usual * (first_pull + more_pull * start));
    if (const auto last = body_.last_tensions(); from_last && !last.empty())
      for (std::size_t i = 0; i < m; ++i) tensions[i] = std::clamp(last[i], 0.0, search_.most);
    return tensions;
  }
  /// @returns whether the body has an equilibrium there
  bool begin(int start) {
    const bool from_last = start == 0 && search_.from_last;
    tensions_ = first_tensions(start, from_last);
    report_ = pull(tensions_, from_last);
    if (report_.status == Status::bad_input || report_.status == Status::stopped ||
        report_.status == Status::unsupported)
      return end_with(report_);
    if (!report_.is_solved()) return false;
    best_.has_begun = true;
    error_ = error();
    radius_ = first_radius * search_.usual;
    longest_before_ = 1e300;
    phase_ = Phase::there;
    return true;
  }
  /// Tensions that meet the target where the body is linear in them: the nearest to `centre`. False where it
  /// has no rates. @param from of the body's equilibrium
  bool aim(const std::vector<double>& from, const std::vector<double>& centre, std::vector<double>& next) {
    std::vector<double> J;
    if (!body_.rates(J)) return false;
    const std::size_t m = search_.tendons;
    const TargetRows rows = rows_of(target_, body_.tip(), J, search_.length);
    std::vector<double> b = rows.off;
    for (std::size_t r = 0; r < b.size(); ++r)
      for (std::size_t i = 0; i < m; ++i) b[r] += rows.J[r * m + i] * from[i];
    next = bounded_least_squares(rows.J, b, centre, search_.most);
    return true;
  }
  /// From a step along the target back to it, by the nearest tensions: sums tell nothing off it, since
  /// tensions bring the tip along an arm by very little.
  /// @param next of the step, then of where it ends; @returns what is off there
  double back_to_target(std::vector<double>& next, double after, Report& trial) {
    for (int k = 0; k < most_steps_back && after > search_.precision && after < near_target; ++k) {
      std::vector<double> nearer;
      if (!aim(next, next, nearer)) return error_of_none;
      trial = pull(nearer, true);
      if (!trial.is_solved()) return error_of_none;
      const double now = error();
      if (!(now < after)) return error_of_none;
      next = nearer;
      after = now;
    }
    return after;
  }
  /// @returns whether the way goes on
  bool step() {
    const double usual = search_.usual;
    if (phase_ == Phase::there && error_ < near_target)
      phase_ = Phase::least, radius_ = std::max(radius_, first_radius_along * usual);
    if (phase_ == Phase::exact && error_ <= search_.precision) return false;
    std::vector<double> next;
    const bool goes_along = phase_ == Phase::least;
    if (!aim(tensions_, goes_along ? std::vector<double>(search_.tendons, 0.0) : tensions_, next))
      return false;
    double longest = 0;
    for (std::size_t i = 0; i < next.size(); ++i)
      longest = std::max(longest, std::abs(next[i] - tensions_[i]));
    if (phase_ == Phase::least && longest < least_change_along * usual) {
      phase_ = Phase::exact;
      return true;
    }
    if (longest < least_change * usual) return false;
    const double share = std::min(1.0, radius_ / longest);
    for (std::size_t i = 0; i < next.size(); ++i) next[i] = tensions_[i] + share * (next[i] - tensions_[i]);
    Report trial = pull(next, true);
    double after = trial.is_solved() ? error() : error_of_none;
    if (goes_along) after = back_to_target(next, after, trial);
    if (trial.status == Status::stopped) return end_with(trial);
    if (!is_better(next, after, longest)) return step_back(longest);
    longest_before_ = longest;
    if (share < 1) radius_ *= wider;
    tensions_ = next;
    report_ = trial;
    error_ = after;
    return true;
  }
  bool is_better(const std::vector<double>& next, double after, double longest) const {
    if (phase_ != Phase::least) return after < error_;
    if (after <= search_.precision && error_ > search_.precision) return true;
    if (error_ <= search_.precision) return after <= search_.precision && squares(next) < squares(tensions_);
    // Near the target the sum may rise a little again where that leads back to it.
    const bool leads_back = after < much_nearer * error_ ||
                            (after < far_multiple * search_.precision && longest < longest_before_);
    return after < near_target && (squares(next) < squares(tensions_) || leads_back);
  }
  /// To where it was, for a shorter step. @returns whether the way goes on
  bool step_back(double longest) {
    radius_ = narrower * std::min(radius_, longest);
    report_ = pull(tensions_, true);
    if (!report_.is_solved() && report_.status != Status::stopped) {  // the way back gives way, too
      report_ = pull(tensions_, false);
      if (report_.is_solved()) error_ = error();
    }
    if (report_.status == Status::stopped) return end_with(report_);
    if (!report_.is_solved() || radius_ < least_tension_radius * search_.usual) return false;
    if (phase_ == Phase::least && radius_ < least_radius_along * search_.usual)
      phase_ = Phase::exact, radius_ = search_.usual;
    return true;
  }

  const ArmTarget& target_;
  const TensionSearch& search_;
  PulledBody& body_;
  FoundTensions best_;
  bool is_over_ = false;  ///< what was found is answered at once
  int iterations_ = 0, spent_ = 0;
  /// Of the step that was taken last: it was the last that the body took, too.
  std::vector<double> tensions_;
  Report report_;
  double error_ = 0, radius_ = 0, longest_before_ = 0;
  Phase phase_ = Phase::there;
};

}  // namespace

FoundTensions search_tensions(const ArmTarget& target, const TensionSearch& search, PulledBody& body) {
  return TensionSteps(target, search, body).run();
}

}  // namespace sinew::inline v1
