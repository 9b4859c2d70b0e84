
#include <cmath>

#include "base/limits.hpp"
#include "leg/project.hpp"
#include "math/linalg.hpp"
#include "robot/arguments.hpp"
#include "robot/parallel.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "solve/continuation.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
Vec<double, 3> twist_between(const PlanarPose& from, const PlanarPose& to) {
  return {to.x - from.x, to.y - from.y, to.phi - from.phi};  // as the numbers say: turns count
}
Vec<double, 6> twist_between(const SpatialPose& from, const SpatialPose& to) {
  return twist_between(SE3<double>::from(from), SE3<double>::from(to));
}

namespace {

/// Newton's steps may shrink no slower: then the branch found is the one begun on.
constexpr double contraction_limit = 0.25;
constexpr double shortest_part = 1e-7;  // of the way between two poses
constexpr int max_steps = 20000;        // between two poses
constexpr int null_steps = 4;           // at a pose

/// Projector onto the motions that leave a leg closed, in scaled coordinates.
template <class LegT>
Mat<double, LegT::coordinates, LegT::coordinates> null_space(const LegT& leg,
                                                             const typename LegT::Frame& platform,
                                                             const typename LegT::Coordinates& q) {
  constexpr int Q = LegT::coordinates;
  const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
  const Mat<double, LegT::rows, Q> slope = blocks.g_q * coordinate_scale(leg).asDiagonal();
  const Mat<double, LegT::rows, LegT::rows> normal = slope * slope.transpose();
  return Mat<double, Q, Q>::Identity() - slope.transpose() * (normal.inverse() * slope);
}

/// One robot following its path: all on plain coordinates, nothing is kept here.
template <class Legs>
class Follower {
 public:
  using Space = typename Legs::Space;
  using Frame = typename Space::template Frame<double>;

  Follower(const Legs& legs, const Robot& robot, const TrackOptions& options, Workspace& work)
      : legs_(legs),
        robot_(robot),
        options_(options),
        work_(work) {}

  /// Closes every leg at the pose from coordinates near by; the leg that cannot, or −1.
  /// @param lead share of `motion` that a redundant leg goes on with before it is put back on its closure
  int close(const AnyPose& pose, Numbers motion, double lead, std::span<double> q) const {
    const Frame platform = Space::frame(in_space<Space>(pose));
    int stuck = -1;
    legs_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
      auto own = own_coordinates(leg, place, q);
      if constexpr (L::is_redundant)
        if (lead > 0) own += lead * typename L::Coordinates(motion.data() + place.coordinate);
      const Projection done = project(leg, platform, 1e-15 * leg.size(), own);
      if (stuck < 0 && (!done.ok || done.contraction > contraction_limit)) stuck = i;
      std::copy(own.begin(), own.end(), q.begin() + place.coordinate);
    });
    return stuck;
  }

  /// Where one leg is at a fold of its branch the solution itself may still be there, straight for instance.
  bool close_at_fold(const AnyPose& pose, std::span<double> q) const {
    const Frame platform = Space::frame(in_space<Space>(pose));
    bool closed = true;
    legs_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
      auto own = own_coordinates(leg, place, q);
      auto tried = own;
      const Projection done = project(leg, platform, 1e-15 * leg.size(), tried);
      if (!done.ok || done.contraction > contraction_limit) {
        const auto found = leg.nearest_solution(platform, {.near = leg.link.branch(own)});
        const double jump = (found.q - own).cwiseQuotient(coordinate_scale(leg)).norm();
        closed = closed && found.count > 0 && jump < 0.05;
        tried = found.q;
      }
      std::copy(tried.begin(), tried.end(), q.begin() + place.coordinate);
    });
    return closed;
  }

  /// Why leg i ends the path at this pose, coming from coordinates q.
  void explain(int i, const AnyPose& pose, Numbers q, FixedText<240>& text) const {
    const Frame platform = Space::frame(in_space<Space>(pose));
    legs_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int at) {
      if (at != i) return;
      std::array<typename L::Coordinates, Workspace::max_solutions> roots;
      const double branch = leg.link.branch(own_coordinates(leg, place, q));
      if (leg.solutions_at(platform, {}, roots) <= 0)
        leg.explain_unreachable(platform, text);
      else if (std::abs(branch) > 0.999 * leg.domain())
        text.append("can bend no further: to a full turn, or its inner tendon to the centre of curvature");
      else
        text.append("has no solution on the branch it is on: two of its solutions meet here (type I)");
    });
  }

  /// Inputs of link coordinates. False where tied legs ask for different ones.
  bool inputs_of(Numbers q, std::span<double> inputs) const {
    bool agree = true;
    legs_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
      const auto a = leg.inputs_of(own_coordinates(leg, place, q));
      for (int j = 0; j < L::inputs; ++j) {
        double& input = inputs[static_cast<std::size_t>(place.input + j)];
        if (place.is_tied && std::abs(input - a[j]) > 1e-9 * leg.size()) agree = false;
        input = a[j];
      }
    });
    return agree;
  }

  /// A step along the null space that betters the objective, if there is one; else q is left alone.
  void better(const AnyPose& pose, std::span<double> q) const {
    std::vector<double> uphill(q.size()), tried(q.size());
    const double length = gradient(pose, q, uphill);
    if (!(length > 1e-9)) return;
    const double here = merit(pose, q);
    for (double step = options_.null_step / null_steps; step > options_.null_step / 100; step /= 2) {
      for (std::size_t k = 0; k < q.size(); ++k) tried[k] = q[k] + step / length * uphill[k];
      if (close(pose, {}, 0, tried) >= 0 || !(merit(pose, tried) > here)) continue;
      std::ranges::copy(tried, q.begin());
      return;
    }
  }

 private:
  /// What the objective makes large.
  double merit(const AnyPose& pose, Numbers q) const {
    if (options_.objective == Objective::singularity) return log_volume(pose, q);
    double sum = 0;
    legs_.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int) {
      const double part = leg.link.branch(own_coordinates(leg, place, q)) / leg.domain();
      sum -= part * part;
    });
    return sum;
  }

  /// log |det J| of unit lines; of a wide or tall J the volume its rows or columns span.
  double log_volume(const AnyPose& pose, Numbers q) const {
    std::array<double, max_rows> sigma;
    const MatrixView lines = homogenise(robot_, assemble(robot_, pose, q, work_), work_);
    const auto count = static_cast<std::size_t>(std::min(lines.rows(), lines.cols()));
    singular_values(lines, std::span(sigma).first(count));
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += std::log(sigma[k]);
    return sum;
  }

  /// Gradient of the merit along the null spaces, by central differences; its length in scaled coordinates.
  double gradient(const AnyPose& pose, Numbers q, std::span<double> uphill) const {
    const Frame platform = Space::frame(in_space<Space>(pose));
    std::vector<double> beside(q.begin(), q.end());
    double square = 0;
    legs_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
      if constexpr (L::is_redundant) {
        const auto scale = coordinate_scale(leg);
        typename L::Coordinates slope;
        for (int j = 0; j < L::coordinates; ++j) {
          const auto k = static_cast<std::size_t>(place.coordinate + j);
          const double h = 1e-5;  // rad
          beside[k] = q[k] + h * scale[j];
          const double ahead = merit(pose, beside);
          beside[k] = q[k] - h * scale[j];
          slope[j] = (ahead - merit(pose, beside)) / (2 * h);
          beside[k] = q[k];
        }
        const typename L::Coordinates along =
            null_space(leg, platform, own_coordinates(leg, place, q)) * slope;
        square += along.squaredNorm();
        for (int j = 0; j < L::coordinates; ++j)
          uphill[static_cast<std::size_t>(place.coordinate + j)] = scale[j] * along[j];
      }
    });
    return std::sqrt(square);
  }

  const Legs& legs_;
  const Robot& robot_;
  const TrackOptions& options_;
  Workspace& work_;
};

/// Legs that bear load never get here: the first pose already has no inverse.
template <class Use>
auto follow(const Robot& robot, const TrackOptions& options, Workspace& work, const Use& use) {
  return with_legs(robot, [&](const auto& legs) { return use(Follower(legs, robot, options, work)); });
}

}  // namespace

Track::Track(const Robot& robot, TrackOptions options, Workspace& work)
    : robot_(&robot),
      options_(options),
      work_(&work),
      coordinates_(static_cast<std::size_t>(coordinate_count(robot))),
      inputs_(static_cast<std::size_t>(input_count(robot))),
      motion_(coordinates_.size()) {}

Report Track::begin(const AnyPose& first) {
  const Inverse solved = inverse(*robot_, first, options_.branch, *work_);
  if (!solved.ok()) return solved.report;
  has_begun_ = true;
  pose_ = first;
  progress_ = 1;
  std::ranges::copy(solved.coordinates, coordinates_.begin());
  std::ranges::copy(solved.inputs, inputs_.begin());
  closure_error_ = solved.report.residual;
  return solved.report;
}

/// Null-space motion at the pose reached, then inputs and evidence.
void Track::settle() {
  const bool seeks = options_.objective == Objective::limits || options_.objective == Objective::singularity;
  follow(*robot_, options_, *work_, [&](const auto& follower) {
    for (int step = 0; seeks && step < null_steps; ++step) follower.better(pose_, coordinates_);
    follower.inputs_of(coordinates_, inputs_);
  });
  closure_error_ = assemble(*robot_, pose_, coordinates_, *work_).closure_error;
}

/// One part of the way: `coordinates` go from where the track is to `pose`, or the leg that cannot is told.
int Track::step(const AnyPose& pose, double part, std::vector<double>& coordinates, Report& report) {
  return follow(*robot_, options_, *work_, [&](const auto& follower) {
    const bool is_last_try = part < shortest_part;
    coordinates = coordinates_;
    int leg = follower.close(pose, motion_, options_.objective == Objective::smooth ? part : 0, coordinates);
    if (leg >= 0 && is_last_try) {  // a fold: perhaps the next pose is just there
      std::vector<double> tried = coordinates_;
      if (follower.close_at_fold(pose, tried)) {
        coordinates = tried;
        leg = -1;
      }
    }
    std::vector<double> inputs(inputs_.size());
    if (leg >= 0 && is_last_try) {
      report.status = Status::unreachable;
      report.message.append("legs[");
      append_number(report.message, leg);
      report.message.append("] ");
      follower.explain(leg, pose, coordinates_, report.message);
    } else if (leg < 0 && !follower.inputs_of(coordinates, inputs)) {
      report.status = Status::unreachable;
      report.message.append("legs that share an actuator would need different inputs");
    }
    return leg;
  });
}

Report Track::advance(const AnyPose& next) {
  if (Report fits = check_arguments(*robot_, next, *work_); !fits.ok()) return fits;
  if (!has_begun_) return begin(next);
  const AnyPose from = pose_;
  const std::vector<double> before = coordinates_;
  std::vector<double> tried;
  Report report;
  ParameterPath end;
  follow_parameter(end, {{1, 0, work_->stop}, 0, max_steps}, [&](double to, double part) {
    ++end.iterations;
    const AnyPose pose = to == 1 ? next : project_to_constraints(*robot_, between(from, next, to));
    const int stuck = step(pose, part, tried, report);
    if (stuck >= 0 || !report.ok()) return ParameterStep{ParameterStep::failed, report.ok() ? part / 2 : 0};
    coordinates_ = tried;
    pose_ = pose;
    return ParameterStep{ParameterStep::reached, 2 * part};
  });
  progress_ = end.progress;
  if (end.stopped) {
    say_stopped(report);
  } else if (end.ran_out) {
    report.status = Status::iteration_limit;
    report.message.append("the path winds too tightly to be followed between two poses; give more poses");
  }
  if (!end.arrived) return report;
  settle();
  for (std::size_t k = 0; k < motion_.size(); ++k) motion_[k] = coordinates_[k] - before[k];
  report.residual = closure_error_;
  return report;
}

AnyPose between(const AnyPose& from, const AnyPose& to, double part) {
  return std::visit(
      [&]<class Pose>(const Pose& start) -> AnyPose {
        using Space = std::conditional_t<std::is_same_v<Pose, PlanarPose>, Planar, Spatial>;
        const auto twist = twist_between(start, in_space<Space>(to));
        return Space::moved(start, part * twist);
      },
      from);
}

}  // namespace sinew::inline v1
