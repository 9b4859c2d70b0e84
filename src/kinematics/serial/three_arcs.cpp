#include "kinematics/serial/three_arcs.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/serial/arc_newton.hpp"
#include "kinematics/serial/arc_pairs.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

using namespace detail;

constexpr int max_boxes = 400000;
constexpr std::size_t max_pieces = 100000;  // 40 MB
constexpr std::size_t max_solutions = 32;
constexpr double same_bends = 1e-7;       // of regular solutions
constexpr double limit_slack = 1e-9;      // bends at the limit count
constexpr double example_spacing = 0.25;  // of examples of a continuum

/// The search through all pairs of pieces of the two outer curves.
class BoxSearch {
 public:
  BoxSearch(const ThreeArcPose& pose, double resolution, double spacing)
      : pose_(pose),
        first_(pose.first_curve()),
        last_(pose.last_curve()),
        resolution_(resolution),
        spacing_(spacing) {}

  void run(StopToken stop) {
    std::vector<Pair> open{{0, 0, 3}};
    while (!open.empty() && !stop.stop_requested() && boxes < max_boxes && pieces() < max_pieces &&
           solutions.size() < max_solutions) {
      const Pair pair = open.back();
      open.pop_back();
      if (const Pair left = examined(pair); left.signs) split(left, open);
    }
    open_boxes += static_cast<int>(open.size());
    is_cut = !open.empty();
  }

  std::vector<ArcSolution> solutions;  // single ones beyond the limit too: they account for their pairs
  int boxes = 0, open_boxes = 0;
  bool is_cut = false;  ///< ended before all was looked at

 private:
  /// Pieces of the two curves; signs: bit 0 for +, bit 1 for −.
  struct Pair {
    int first, last;
    unsigned signs;
  };

  /// The pair with the signs for which it stays open.
  Pair examined(Pair pair) {
    ++boxes;
    const Piece &first = first_[pair.first], &last = last_[pair.last];
    const PairBounds bounds = pair_bounds(pose_, first, last);
    if (bounds.is_empty) return {pair.first, pair.last, 0};
    if (bounds.is_too_large) return pair;
    const bool is_smallest = std::max(first.radius, last.radius) < resolution_;
    for (const unsigned bit : {1u, 2u}) {
      if (!(pair.signs & bit)) continue;
      const int sign = bit == 1 ? 1 : -1;
      const PairAnswer answer = classify_pair(pose_, first, last, bounds, sign);
      const bool is_done = answer.verdict == Verdict::empty ||
                           (answer.verdict == Verdict::single && is_solved(first, last, answer.guess));
      if (!is_done && is_smallest) leave_open(first, last, sign);
      if (is_done || is_smallest) pair.signs &= ~bit;
    }
    return pair;
  }

  /// The one solution that may be in the doubled pair is known.
  bool is_solved(const Piece& first, const Piece& last, const OuterBends& guess) {
    const auto is_here = [&](const ArcSolution& s) {
      return s.sign == guess.sign && (s.bends[0] - first.middle).norm() <= 2 * first.radius &&
             (s.bends[2] - last.middle).norm() <= 2 * last.radius;
    };
    if (std::ranges::any_of(solutions, is_here)) return true;
    const std::optional<ArcSolution> found = polished(pose_, guess);
    // beyond a full turn the middle arc is none of those searched
    if (!found || !is_here(*found) || found->bends[1].norm() > 2 * std::numbers::pi) return false;
    add(*found, same_bends);
    return true;
  }

  void leave_open(const Piece& first, const Piece& last, int sign) {
    ++open_boxes;
    const std::optional<ArcSolution> found = settled(pose_, {first.middle, last.middle, sign});
    // where the Jacobian is nearly singular the solution is not known better than this
    if (found && is_within_limit(pose_, found->bends))
      add(*found, std::max(spacing_, 1e-12 / std::max(regularity(pose_, found->bends), 1e-10)));
  }

  void add(const ArcSolution& found, double spacing) {
    const auto is_same = [&](const ArcSolution& s) {
      return s.sign == found.sign && distance(s.bends, found.bends) < spacing;
    };
    if (std::ranges::none_of(solutions, is_same)) solutions.push_back(found);
  }

  std::size_t pieces() const { return first_.size() + last_.size(); }

  void split(const Pair& pair, std::vector<Pair>& open) {
    if (first_[pair.first].radius >= last_[pair.last].radius) {
      for (const int part : first_.parts(pair.first))
        if (part != Piece::nothing) open.push_back({part, pair.last, pair.signs});
    } else {
      for (const int part : last_.parts(pair.last))
        if (part != Piece::nothing) open.push_back({pair.first, part, pair.signs});
    }
  }

  ThreeArcPose pose_;
  PieceTree first_, last_;
  double resolution_, spacing_;
};

bool has_left_domain(const ThreeArcs& robot, const SpatialPose& tip, Report& report) {
  bool is_good = robot.limit > 0 && robot.limit <= 2 * std::numbers::pi && tip.position.allFinite();
  double norm = 0;
  for (const double q : tip.quaternion) norm += q * q;
  is_good = is_good && norm > 0 && std::isfinite(norm) && tip.position.norm() < 1e150;
  for (const double length : robot.lengths) is_good = is_good && length > 0 && length < 1e150;
  if (is_good) return false;
  report.status = Status::left_domain;
  report.message.append(
      "lengths must be above 0, the limit in (0, 2 pi], and the pose finite with a quaternion other than 0");
  return true;
}

bool is_too_far(const ThreeArcs& robot, const SpatialPose& tip, Report& report) {
  const double reach = robot.lengths[0] + robot.lengths[1] + robot.lengths[2], distance = tip.position.norm();
  if (distance <= reach * (1 + 1e-12)) return false;
  report.status = Status::unreachable;
  report.message.append("the tip is ");
  append_mm(report.message, distance);
  report.message.append(" from the base, the robot ");
  append_mm(report.message, reach);
  report.message.append(" long");
  return true;
}

/// Rounded, so that solutions equal but for rounding are in the same order everywhere.
std::array<double, 7> sort_key(const ArcSolution& solution) {
  std::array<double, 7> key{};
  for (std::size_t k = 0; k < 3; ++k) {
    key[0] += solution.bends[k].squaredNorm();
    for (int j = 0; j < 2; ++j) key[2 * k + static_cast<std::size_t>(j) + 1] = solution.bends[k][j];
  }
  for (double& number : key) number = std::round(number / 1e-9);
  return key;
}

/// The straight robot: nothing else is as long.
bool is_straight(const ThreeArcPose& pose, ThreeArcSolutions& answer) {
  const Vec2<double> none(0, 0);
  const double error = pose_error({none, none, none}, pose);
  if (error > 1e-13) return false;
  answer.solutions.push_back({none, none, none});
  answer.residual.push_back(error);
  answer.regularity.push_back(0);
  answer.report.residual = error;
  return true;
}

void tell(BoxSearch& search, const ThreeArcPose& pose, double size, ThreeArcSolutions& answer) {
  std::erase_if(search.solutions, [&](const ArcSolution& s) { return !is_within_limit(pose, s.bends); });
  std::ranges::sort(search.solutions, {}, sort_key);
  for (const ArcSolution& s : search.solutions) {
    answer.solutions.push_back(s.bends);
    answer.residual.push_back(s.residual * size);
    answer.regularity.push_back(regularity(pose, s.bends));
    answer.report.residual = std::max(answer.report.residual, answer.residual.back());
  }
  answer.boxes = answer.report.iterations = search.boxes;
  answer.open_boxes = search.open_boxes;
}

void explain(bool is_free, bool is_cut, ThreeArcSolutions& answer) {
  Report& report = answer.report;
  if (answer.solutions.empty()) {
    report.status = answer.is_complete() ? Status::unreachable : Status::stalled;
    report.message.append(answer.is_complete()
                              ? "no bends within the limit reach the pose"
                              : "no bends found, but boxes of bends remain that may hold some");
    return;
  }
  const bool is_nearly_free = !answer.is_complete() && std::ranges::min(answer.regularity) < 1e-8;
  if (!is_free && !is_cut && !is_nearly_free) return;
  report.status = Status::singular;
  report.message.append(
      is_free  ? "a continuum of bends reaches the pose; those listed are examples"
      : is_cut ? "too many bends reach the pose, or nearly a continuum; those listed are examples"
               : "solutions merge at this pose, or nearly; those listed stand for all near them");
}

}  // namespace

SE3<double> tip_pose(const ThreeArcs& robot, const ThreeBends& bends) { return tip_of(robot.lengths, bends); }

ThreeArcSolutions all_bends(const ThreeArcs& robot, const SpatialPose& tip, StopToken stop) {
  ThreeArcSolutions answer;
  if (has_left_domain(robot, tip, answer.report) || is_too_far(robot, tip, answer.report)) return answer;
  const double size = robot.lengths[0] + robot.lengths[1] + robot.lengths[2];
  ThreeArcPose pose{robot.lengths, robot.limit + limit_slack, SE3<double>::from(tip)};
  for (double& length : pose.lengths) length /= size;
  pose.tip.p /= size;
  if (is_straight(pose, answer)) return answer;
  const bool is_free = pose.has_free_circle();
  BoxSearch search(pose, is_free ? example_spacing : ThreeArcSolutions::resolution,
                   is_free ? example_spacing : 10 * ThreeArcSolutions::resolution);
  search.run(stop);
  tell(search, pose, size, answer);
  if (!note_stop(stop, answer.report)) explain(is_free, search.is_cut, answer);
  return answer;
}

}  // namespace sinew::inline v1
