#include "sinew/kinematics/inverse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leg/project.hpp"
#include "robot/arguments.hpp"
#include "robot/parallel.hpp"
#include "robot/pose.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

constexpr auto per_leg = static_cast<std::size_t>(Workspace::max_solutions);
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of the robot's size: within it a leg counts as closed by an input that another leg asked for.
constexpr double common_tolerance = 1e-12;

Report refused(Status status, std::string_view text) {
  Report report;
  report.status = status;
  report.message.append(text);
  return report;
}

Report name(Status status, std::string_view what, std::size_t index) {
  Report report = refused(status, what);
  report.message.append("[");
  append_number(report.message, static_cast<int>(index));
  report.message.append("] ");
  return report;
}

/// Why leg i has no solution: `count` 0 or -1 as its search ended.
template <class LegT, class Frame>
Report without_solution(const LegT& leg, const Frame& platform, std::size_t i, int count) {
  Report report = name(count < 0 ? Status::stalled : Status::unreachable, "legs", i);
  if (count < 0)
    report.message.append("has sizes so unlike each other that its solutions cannot be told apart");
  else
    leg.explain_unreachable(platform, report.message);
  return report;
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The inverse problem of one robot at one pose.
template <class Legs>
class Problem {
 public:
  using Space = typename Legs::Space;
  using Frame = typename Space::template Frame<double>;

  Problem(const Legs& legs, const AnyPose& pose, const InverseOptions& options, Workspace& work)
      : legs_(legs),
        platform_(Space::frame(in_space<Space>(pose))),
        options_(options),
        work_(work) {}

  /// Largest distance by which a leg fails to close with the wanted solutions [m].
  double closure_error() const { return closure_error_; }

  bool is_finite() const { return Space::is_finite(platform_); }

  /// All solutions of every leg into the workspace.
  Report solve_all() {
    return each_owner([&](const auto& leg, const LegPlace& place, std::size_t i, Report& report) {
      report = solve_leg(leg, place, i);
    });
  }

  /// The wanted solution of every leg into the workspace.
  Report solve_wanted() {
    return each_owner([&](const auto& leg, const LegPlace& place, std::size_t i, Report& report) {
      if (legs_.has_ties())
        report = choose(leg, place, i);
      else if (!keep_nearest(leg, place, i))
        report = without_nearest(leg, place, i);
    });
  }

 private:
  /// Calls `use(leg, place, i, report)` with every leg that has inputs of its own, until one reports a
  /// failure.
  template <class Use>
  Report each_owner(const Use& use) {
    Report report;
    legs_.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int i) {
      if (place.is_tied)
        work_.solution_count[index(i)] = 1;
      else if (report.ok())
        use(leg, place, index(i), report);
    });
    return report;
  }

  /// Calls `use` with the legs that the same inputs move.
  template <class Use>
  void each_sharing(const LegPlace& owner, const Use& use) const {
    legs_.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int i) {
      if (place.input == owner.input) use(leg, place, index(i));
    });
  }

  template <class LegT>
  SolutionPreference wish_of(const LegT& leg, const LegPlace& place, std::size_t i) const {
    SolutionPreference wish;
    if (!options_.bending.empty()) wish.bending = options_.bending[i];
    if (!options_.elbow.empty()) wish.elbow = options_.elbow[i];
    if (HasArc<typename LegT::Link> && !options_.curvature.empty())
      wish.near = options_.curvature[i];
    else if (!options_.start.empty())
      wish.near = leg.link.branch(start_of(leg, place));
    return wish;
  }
  /// Elbow +1 where none is asked for; a start tells on which side of a rail the carriage is.
  template <class LegT>
  SolutionPreference default_elbow(const LegT&, SolutionPreference wish) const {
    const bool is_told = wish.elbow != 0 || (!LegT::is_redundant && is_from_start());
    if (LegT::has_elbow && !is_told) wish.elbow = 1;
    return wish;
  }
  template <class LegT>
  typename LegT::Coordinates start_of(const LegT& leg, const LegPlace& place) const {
    return leg.coordinates_of(options_.start.subspan(index(place.input), LegT::inputs));
  }

  /// Largest closure error of the legs that the owner's inputs move, over their size.
  double closure_error(const LegPlace& owner, std::span<const double> inputs) const {
    double worst = 0;
    each_sharing(owner, [&]<class L>(const L& leg, const LegPlace&, std::size_t) {
      const auto q = leg.coordinates_of(inputs);
      const double error =
          L::closure_error(leg.template blocks<double>(platform_, leg.template tip<double>(q)));
      worst = std::max(worst, leg.in_domain(q) ? error / leg.size() : infinity);
    });
    return worst;
  }

  std::span<double> solution(const LegPlace& place, int count, int inputs) {
    return std::span(work_.solutions)
        .subspan(index(place.input) * per_leg + index(count * inputs), index(inputs));
  }

  /// Puts inputs among the solutions of their owner, unless they are there: two legs may ask for the same.
  void add(const LegPlace& place, std::size_t owner, std::span<const double> inputs, double scale) {
    int& count = work_.solution_count[owner];
    const int width = static_cast<int>(inputs.size());
    for (int k = 0; k < count && scale > 0; ++k)
      if (std::abs(solution(place, k, width)[0] - inputs[0]) <= 1e-7 * scale) return;
    if (count == Workspace::max_solutions) return;
    std::copy(inputs.begin(), inputs.end(), solution(place, count, width).begin());
    ++count;
  }

  /// All inputs of the owner that close every leg they move.
  template <class LegT>
  Report solve_leg(const LegT& owner, const LegPlace& place, std::size_t i) {
    work_.solution_count[i] = 0;
    Report report;
    std::size_t sharing = 0;
    each_sharing(place, [&]<class L>(const L& leg, const LegPlace& at, std::size_t j) {
      if (!report.ok()) return;
      ++sharing;
      std::array<typename L::Coordinates, per_leg> roots;
      const int count = leg.solutions_at(platform_, wish_of(leg, at, j), roots);
      if (count <= 0) report = without_solution(leg, platform_, j, count);
      for (int k = 0; k < count; ++k) {
        const auto a = tidy_inputs(leg, roots[index(k)]);
        const std::span<const double> inputs(a.data(), L::inputs);
        if (!legs_.has_ties() || closure_error(place, inputs) <= common_tolerance)
          add(place, i, inputs, legs_.has_ties() ? owner.size() : 0);
      }
    });
    if (!report.ok() || work_.solution_count[i] > 0) return report;
    report = name(Status::unreachable, "legs", i);
    report.message.append(
        "and those tied to it have one actuator, and no value of it closes them all at this pose");
    return report;
  }

  /// How little inputs are wanted; infinite where they are ruled out.
  double cost(const LegPlace& owner, std::span<const double> inputs) const {
    double worst = 0;
    each_sharing(owner, [&]<class LegT>(const LegT& leg, const LegPlace& place, std::size_t i) {
      const SolutionPreference wish = default_elbow(leg, wish_of(leg, place, i));
      const auto q = leg.coordinates_of(inputs);
      const double branch = leg.link.branch(q);
      const bool is_bent_against = HasArc<typename LegT::Link> && branch * wish.bending < 0;
      const bool is_turned_against = wish.elbow != 0 && leg.state(platform_, q).elbow * wish.elbow < 0;
      worst = std::max(worst, is_bent_against || is_turned_against ? infinity : std::abs(branch - wish.near));
    });
    return worst;
  }

  /// The wanted one of all inputs that move several legs.
  template <class LegT>
  Report choose(const LegT& owner, const LegPlace& place, std::size_t i) {
    if (Report report = solve_leg(owner, place, i); !report.ok()) return report;
    double best = infinity;
    std::span<const double> chosen;
    for (int k = work_.solution_count[i]; k-- > 0;) {
      const auto inputs = solution(place, k, LegT::inputs);
      const double c = cost(place, inputs);
      if (!(c < best)) continue;
      best = c;
      chosen = inputs;
    }
    if (std::isinf(best)) {
      Report report = name(Status::unreachable, "inputs", index(place.input));
      report.message.append("has no value at this pose that bends its legs as asked");
      return report;
    }
    each_sharing(place, [&](const auto& leg, const LegPlace& at, std::size_t) {
      keep(leg, at, leg.coordinates_of(chosen));
      closure_error_ = std::max(closure_error_, leg.closure_error(platform_, leg.coordinates_of(chosen)));
    });
    return {};
  }

  /// The wanted solution of a leg that has its inputs for itself; false where it has none.
  template <class LegT>
  bool keep_nearest(const LegT& leg, const LegPlace& place, std::size_t i) {
    if (LegT::is_redundant && is_from_start()) {
      auto q = start_of(leg, place);
      if (leg.in_domain(q) && project(leg, platform_, 1e-15 * leg.size(), q).ok) {
        keep(leg, place, q);
        closure_error_ = std::max(closure_error_, leg.closure_error(platform_, q));
        return true;
      }
    }
    const auto found = leg.nearest_solution(platform_, default_elbow(leg, wish_of(leg, place, i)));
    keep(leg, place, found.q);
    closure_error_ =
        found.closure_error <= closure_error_ ? closure_error_ : found.closure_error;  // NaN is the worst
    return found.count > 0;
  }

  /// Why it has none.
  template <class LegT>
  Report without_nearest(const LegT& leg, const LegPlace& place, std::size_t i) const {
    const SolutionPreference wish = default_elbow(leg, wish_of(leg, place, i)), anything{.near = wish.near};
    if (!HasArc<typename LegT::Link> || wish.bending == 0 ||
        leg.nearest_solution(platform_, anything).count <= 0)
      return without_solution(leg, platform_, i, leg.nearest_solution(platform_, wish).count);
    Report report = name(Status::unreachable, "legs", i);
    report.message.append(wish.bending > 0 ? "has no solution of positive curvature at this pose"
                                           : "has no solution of negative curvature at this pose");
    return report;
  }

  bool is_from_start() const {
    return !options_.start.empty() && options_.curvature.empty() && options_.bending.empty() &&
           options_.elbow.empty();
  }

  /// Inputs whose angles lie in (−π, π].
  template <class LegT>
  static Vec<double, LegT::inputs> tidy_inputs(const LegT& leg, const typename LegT::Coordinates& q) {
    auto a = leg.inputs_of(q);
    for (int j = 0; j < LegT::inputs; ++j)
      if (LegT::Drive::input_kinds[static_cast<std::size_t>(j)].dimension == Dimension::angle)
        a[j] = wrap_angle(a[j]);
    return a;
  }

  template <class LegT>
  void keep(const LegT& leg, const LegPlace& place, const typename LegT::Coordinates& q) {
    const auto a = is_from_start() ? leg.inputs_of(q) : tidy_inputs(leg, q);
    std::copy(q.begin(), q.end(), work_.coordinates.begin() + place.coordinate);
    std::copy(a.begin(), a.end(), work_.inputs.begin() + place.input);
  }

  const Legs& legs_;
  Frame platform_;
  const InverseOptions& options_;
  Workspace& work_;
  double closure_error_ = 0;
};

Report check(const InverseOptions& options, const Workspace& work) {
  const std::size_t legs = work.legs.size();
  const auto fits = [](std::size_t size, std::size_t needed) { return size == 0 || size == needed; };
  if (fits(options.bending.size(), legs) && fits(options.curvature.size(), legs) &&
      fits(options.elbow.size(), legs) && fits(options.start.size(), work.inputs.size()))
    return {};
  return refused(Status::bad_input,
                 "bending, curvature and elbow need one value a leg, start one value an input");
}

/// Calls `solve` with the problem, if the pose is one.
template <class Solve>
Report with_problem(const Robot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work,
                    const Solve& solve) {
  if (const Report report = check_arguments(robot, pose, work); !report.ok()) return report;
  if (const Report report = check(options, work); !report.ok()) return report;
  return with_closing_legs(
      robot,
      [&](const auto& r) {
        Problem problem(r, pose, options, work);
        return problem.is_finite()
                   ? solve(problem)
                   : refused(Status::left_domain, "the pose is not a finite number in every coordinate");
      },
      [] {
        return refused(Status::unsupported,
                       "the legs bear load: their inputs hold an equilibrium; ask inverse_equilibrium");
      });
}

}  // namespace

Inverse inverse(const Robot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  const Report report = with_problem(robot, pose, options, work, [](auto& problem) {
    Report solved = problem.solve_wanted();
    if (solved.ok()) solved.residual = problem.closure_error();
    return solved;
  });
  return {report, work.inputs, work.coordinates};
}

WorkingModes working_modes(const Robot& robot, const AnyPose& pose, const InverseOptions& options,
                           Workspace& work) {
  WorkingModes modes{
      with_problem(robot, pose, options, work, [](auto& problem) { return problem.solve_all(); }),
      work.solutions, work.solution_count, 0, has_redundant_leg(robot)};
  if (!modes.report.ok()) return modes;
  modes.count = 1;
  for (const int n : work.solution_count) modes.count *= n;
  return modes;
}

void WorkingModes::mode(const Robot& robot, std::size_t k, std::span<double> inputs) const {
  const auto width = static_cast<std::size_t>(input_count(robot));
  if (!report.ok() || inputs.size() != width || solutions.size() != width * per_leg ||
      solution_count.size() != static_cast<std::size_t>(leg_count(robot)))
    return void(
        std::ranges::fill(inputs,
                          std::numeric_limits<double>::quiet_NaN()));  // modes of another robot, or none
  with_legs(robot, [&](const auto& r) {
    for (std::size_t i = r.legs.size(); i-- > 0;) {
      const LegPlace& place = r.places[i];
      if (place.is_tied) continue;
      const auto n = static_cast<std::size_t>(solution_count[i]);
      with_leg(r.legs[i], [&]<class L>(const L&) {
        const auto from = solutions.begin() + place.input * Workspace::max_solutions +
                          static_cast<std::ptrdiff_t>(k % n) * L::inputs;
        std::copy(from, from + L::inputs, inputs.begin() + place.input);
      });
      k /= n;
    }
  });
}

}  // namespace sinew::inline v1
