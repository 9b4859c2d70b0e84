/// Time-optimal motion along a curve by the squares of its speed that can still be braked from: H. Pham,
/// Q.-C. Pham, IEEE Trans. Robot. 34 (2018) 645.
#include "sinew/kinematics/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/shape_preserving.hpp"
#include "sinew/kinematics/serial.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

using Values = std::vector<double>;

/// A line in the plane of acceleration u over squared speed x.
struct Line {
  double at_zero, slope;
  double at(double x) const { return at_zero + slope * x; }
};

/// What the limits allow at one interval of the curve's parameter s: x = ṡ² at its beginning, u = s̈ in it.
/// Convex, and holds x = 0, u = 0.
class Allowed {
 public:
  void clear() {
    upper_.clear();
    lower_.clear();
    most_ = std::numeric_limits<double>::max();
  }
  /// |along u + across x| ≤ limit
  void add_acceleration(double along, double across, double limit) {
    if (std::abs(along) * 1e12 <= std::abs(across)) {
      if (across != 0) most_ = std::min(most_, limit / std::abs(across));
      return;
    }
    const double slope = -across / along, reach = limit / std::abs(along);
    upper_.push_back({reach, slope});
    lower_.push_back({-reach, slope});
  }
  /// rate² (x + growth u) ≤ limit²
  void add_speed(double rate, double growth, double limit) {
    if (rate == 0) return;
    const double most = limit / rate * (limit / rate);
    if (growth == 0)
      most_ = std::min(most_, most);
    else
      upper_.push_back({most / growth, -1 / growth});
  }
  /// 0 ≤ x + 2 width u ≤ next
  void add_end(double next, double width) {
    upper_.push_back({next / (2 * width), -1 / (2 * width)});
    lower_.push_back({0, -1 / (2 * width)});
  }
  /// Greatest x that an acceleration is allowed for. From above by intersections of the two lines that are
  /// worst: the difference is concave, so each is nearer and none is too low.
  double most() const {
    double x = most_;
    for (int k = 0; k < 200; ++k) {
      const Line& high = highest_allowed(x);
      const Line& low = lowest_allowed(x);
      const double excess = low.at(x) - high.at(x);
      if (!(excess > 1e-12 * (std::abs(low.at(x)) + std::abs(high.at(x))))) return x;
      x = std::max(0.0, (high.at_zero - low.at_zero) / (low.slope - high.slope));
    }
    return 0;
  }
  double max_acceleration(double x) const { return highest_allowed(x).at(x); }

 private:
  const Line& highest_allowed(double x) const {
    return *std::ranges::min_element(upper_, {}, [x](const Line& line) { return line.at(x); });
  }
  const Line& lowest_allowed(double x) const {
    return *std::ranges::max_element(lower_, {}, [x](const Line& line) { return line.at(x); });
  }

  std::vector<Line> upper_, lower_;
  double most_ = 0;
};

/// Stage and bends along the curve, and what they do to the tendons.
class Curve {
 public:
  Curve(const SerialRobot& robot, const Values& parameters, const Values& values)
      : curve_(parameters, values),
        work_(robot),
        bends_(robot.sections.size()) {}

  const ShapePreservingCurve& cubics() const { return curve_; }

  /// First and second derivatives by s of the stage, all bends, all tendons, on a piece.
  void derive(std::size_t piece, double s, Values& first, Values& second) {
    first.clear();
    second.clear();
    for (std::size_t c = 0; c < curve_.coordinates(); ++c) {
      first.push_back(curve_.first_derivative(piece, c, s));
      second.push_back(curve_.second_derivative(piece, c, s));
    }
    const double step = 1e-4 * (curve_.knot(piece + 1) - curve_.knot(piece));
    tendon_rates_at(piece, s, rates_);
    tendon_rates_at(piece, s - step, before_);
    tendon_rates_at(piece, s + step, after_);
    for (std::size_t i = 0; i < rates_.size(); ++i) {
      first.push_back(rates_[i]);
      second.push_back((after_[i] - before_[i]) / (2 * step));
    }
  }

 private:
  /// By s. The cubic of the piece also beyond its ends.
  void tendon_rates_at(std::size_t piece, double s, Values& rates) {
    for (std::size_t c = 1; c < curve_.coordinates(); ++c)
      bends_[(c - 1) / 2][static_cast<int>((c - 1) % 2)] = curve_.value(piece, c, s);
    tendon_rates(bends_, kernel::Model::exact, work_);
    const auto K = work_.tendon_jacobian();
    rates.assign(static_cast<std::size_t>(K.rows()), 0.0);
    for (Eigen::Index i = 0; i < K.rows(); ++i)
      for (Eigen::Index c = 0; c < K.cols(); ++c)
        rates[static_cast<std::size_t>(i)] +=
            K(i, c) * curve_.first_derivative(piece, static_cast<std::size_t>(c) + 1, s);
  }

  ShapePreservingCurve curve_;
  SerialWorkspace work_;
  std::vector<Bend> bends_;
  Values rates_, before_, after_;
};

/// Interval of the curve's parameter in which s̈ is constant.
struct Interval {
  std::size_t piece = 0;
  double begin = 0, width = 0;  ///< [s]
  double squared_speed = 0;     ///< ṡ² at its beginning
  double acceleration = 0;      ///< s̈
  double time = 0;              ///< at its beginning
};

struct CoordinateLimits {
  Values speed, acceleration;
};

CoordinateLimits limits_of(const SerialRobot& robot, const TrajectoryLimits& limits) {
  CoordinateLimits all;
  const auto add = [&](std::size_t count, double speed, double acceleration) {
    all.speed.insert(all.speed.end(), count, speed);
    all.acceleration.insert(all.acceleration.end(), count, acceleration);
  };
  add(1, limits.stage_speed, limits.stage_acceleration);
  add(2 * robot.sections.size(), limits.bend_speed, limits.bend_acceleration);
  add(static_cast<std::size_t>(robot.tendon_count()), limits.tendon_speed, limits.tendon_acceleration);
  return all;
}

/// Short intervals: limits are held at their ends and in their middle.
std::vector<Interval> divided(const ShapePreservingCurve& curve) {
  const std::size_t parts = std::max<std::size_t>(16, 1000 / curve.pieces());
  std::vector<Interval> intervals;
  for (std::size_t piece = 0; piece < curve.pieces(); ++piece) {
    const double begin = curve.knot(piece);
    const double width = (curve.knot(piece + 1) - begin) / static_cast<double>(parts);
    for (std::size_t part = 0; part < parts; ++part)
      intervals.push_back({piece, begin + width * static_cast<double>(part), width});
  }
  return intervals;
}

/// Looks for the speeds along a curve.
class Speeds {
 public:
  Speeds(Curve& curve, CoordinateLimits limits) : curve_(curve), limits_(std::move(limits)) {}

  /// Backwards the greatest speeds from which the end can be reached at rest, then forwards as quickly as
  /// they allow. The time it takes.
  double find(std::vector<Interval>& intervals) {
    Values most(intervals.size() + 1, 0.0);
    for (std::size_t i = intervals.size(); i-- > 0;) {
      look_at(intervals[i], most[i + 1]);
      most[i] = allowed_.most();
    }
    double x = 0, time = 0;
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      Interval& interval = intervals[i];
      interval.squared_speed = x;
      interval.time = time;
      look_at(interval, most[i + 1]);
      const double next = std::clamp(x + 2 * interval.width * allowed_.max_acceleration(x), 0.0, most[i + 1]);
      interval.acceleration = (next - x) / (2 * interval.width);
      note_greatest(interval, (x + next) / 2, interval.width / 2);
      note_greatest(interval, next, interval.width);
      time += 2 * interval.width / (std::sqrt(x) + std::sqrt(next));
      x = next;
    }
    return time;
  }

  const Values& greatest_speeds() const { return speeds_; }
  const Values& greatest_accelerations() const { return accelerations_; }

 private:
  /// Of every coordinate at a place in an interval.
  void note_greatest(const Interval& interval, double squared_speed, double shift) {
    curve_.derive(interval.piece, interval.begin + shift, first_, second_);
    speeds_.resize(first_.size());
    accelerations_.resize(first_.size());
    for (std::size_t c = 0; c < first_.size(); ++c) {
      speeds_[c] = std::max(speeds_[c], std::abs(first_[c]) * std::sqrt(squared_speed));
      accelerations_[c] = std::max(accelerations_[c],
                                   std::abs(first_[c] * interval.acceleration + second_[c] * squared_speed));
    }
  }
  /// What is allowed in an interval, at whose end at most `next` is.
  void look_at(const Interval& interval, double next) {
    allowed_.clear();
    for (const double shift : {0.0, interval.width / 2, interval.width}) {
      curve_.derive(interval.piece, interval.begin + shift, first_, second_);
      for (std::size_t c = 0; c < first_.size(); ++c) {
        // q̈ = q′ u + q″ ṡ², and ṡ² has grown by 2 shift u
        allowed_.add_acceleration(first_[c] + 2 * shift * second_[c], second_[c], limits_.acceleration[c]);
        allowed_.add_speed(first_[c], 2 * shift, limits_.speed[c]);
      }
    }
    allowed_.add_end(next, interval.width);
  }

  Curve& curve_;
  CoordinateLimits limits_;
  Allowed allowed_;
  Values first_, second_, speeds_, accelerations_;
};

/// Of stage, bends and tendons the greatest.
TrajectoryLimits gathered(const Values& speeds, const Values& accelerations, std::size_t bends) {
  const auto most = [](const Values& of, std::size_t begin, std::size_t end) {
    return *std::max_element(of.begin() + static_cast<std::ptrdiff_t>(begin),
                             of.begin() + static_cast<std::ptrdiff_t>(end));
  };
  return {speeds[0],
          accelerations[0],
          most(speeds, 1, 1 + bends),
          most(accelerations, 1, 1 + bends),
          most(speeds, 1 + bends, speeds.size()),
          most(accelerations, 1 + bends, speeds.size())};
}

TrajectoryPoint point_at(const ShapePreservingCurve& curve, const Interval& interval, double time) {
  const double passed = time - interval.time, u = interval.acceleration;
  const double speed = std::max(0.0, std::sqrt(interval.squared_speed) + u * passed);
  const double s = interval.begin + std::clamp((std::sqrt(interval.squared_speed) + u * passed / 2) * passed,
                                               0.0, interval.width);
  const std::size_t sections = (curve.coordinates() - 1) / 2;
  TrajectoryPoint point;
  point.time = time;
  point.posture.bends.resize(sections);
  point.bend_speeds.resize(sections);
  point.bend_accelerations.resize(sections);
  for (std::size_t c = 0; c < curve.coordinates(); ++c) {
    const double first = curve.first_derivative(interval.piece, c, s);
    const double q = curve.value(interval.piece, c, s), rate = first * speed;
    const double acceleration = first * u + curve.second_derivative(interval.piece, c, s) * speed * speed;
    if (c == 0) {
      point.posture.stage = q;
      point.stage_speed = rate;
      point.stage_acceleration = acceleration;
      continue;
    }
    const std::size_t m = (c - 1) / 2;
    const auto axis = static_cast<int>((c - 1) % 2);
    point.posture.bends[m][axis] = q;
    point.bend_speeds[m][axis] = rate;
    point.bend_accelerations[m][axis] = acceleration;
  }
  return point;
}

/// Stage, then bends.
Values coordinates_of(const SerialPosture& posture) {
  Values q{posture.stage};
  for (const Bend& bend : posture.bends) q.insert(q.end(), {bend[0], bend[1]});
  return q;
}

Report refused(Status status, std::string_view why, std::size_t posture, std::string_view more = {}) {
  Report report;
  report.status = status;
  report.message.append(why);
  append_number(report.message, static_cast<int>(posture));
  if (!more.empty()) report.message.append(": ");
  report.message.append(more);
  return report;
}

Report check_postures(const SerialRobot& robot, std::span<const SerialPosture> postures) {
  for (std::size_t k = 0; k < postures.size(); ++k) {
    if (postures[k].bends.size() != robot.sections.size())
      return refused(Status::bad_input, "not a bend for each section in posture ", k);
    for (const double q : coordinates_of(postures[k]))
      if (!std::isfinite(q)) return refused(Status::bad_input, "a number is missing in posture ", k);
    if (postures[k].stage < 0) return refused(Status::left_domain, "the stage is below 0 in posture ", k);
    const Report limits = check_limits(robot, postures[k].bends);
    if (!limits.ok()) return refused(limits.status, "posture ", k, limits.message.view());
  }
  return {};
}

bool are_positive(const TrajectoryLimits& limits, double period) {
  for (const double value :
       {limits.stage_speed, limits.stage_acceleration, limits.bend_speed, limits.bend_acceleration,
        limits.tendon_speed, limits.tendon_acceleration, period})
    if (!(value > 0) || !std::isfinite(value)) return false;
  return true;
}

TrajectoryPoint at_rest(const SerialPosture& posture, double time) {
  const std::vector<Bend> still(posture.bends.size(), Bend(0, 0));
  return {time, posture, 0, 0, still, still};
}

}  // namespace

Trajectory time_optimal_trajectory(const SerialRobot& robot, std::span<const SerialPosture> postures,
                                   const TrajectoryLimits& limits, double period) {
  Trajectory trajectory;
  trajectory.report = check_postures(robot, postures);
  if (!trajectory.report.ok()) return trajectory;
  if (postures.empty() || !are_positive(limits, period)) {
    trajectory.report.status = Status::bad_input;
    trajectory.report.message.append("no posture, or a limit or the period is no number above 0");
    return trajectory;
  }
  // The parameter is the time that each part would take at its greatest speed.
  const CoordinateLimits all = limits_of(robot, limits);
  Values parameters{0}, values = coordinates_of(postures[0]), last = values;
  for (const SerialPosture& posture : postures.subspan(1)) {
    const Values q = coordinates_of(posture);
    double longest = 0;
    for (std::size_t c = 0; c < q.size(); ++c)
      longest = std::max(longest, std::abs(q[c] - last[c]) / all.speed[c]);
    if (!(longest > 1e-9)) continue;
    parameters.push_back(parameters.back() + longest);
    values.insert(values.end(), q.begin(), q.end());
    last = q;
  }
  if (parameters.size() == 1) {
    trajectory.points = {at_rest(postures[0], 0)};
    return trajectory;
  }
  Curve curve(robot, parameters, values);
  std::vector<Interval> intervals = divided(curve.cubics());
  Speeds speeds(curve, all);
  trajectory.duration = speeds.find(intervals);
  trajectory.greatest =
      gathered(speeds.greatest_speeds(), speeds.greatest_accelerations(), 2 * robot.sections.size());
  const double count = std::ceil(trajectory.duration / period - 1e-9);
  if (!(count < static_cast<double>(trajectory_point_limit))) {
    trajectory.report.status = Status::bad_input;
    trajectory.report.message.append("more points than a trajectory may have: ask for fewer a second");
    return trajectory;
  }
  std::size_t i = 0;
  for (double k = 0; k < count; ++k) {
    const double time = k * period;
    while (i + 1 < intervals.size() && intervals[i + 1].time <= time) ++i;
    trajectory.points.push_back(point_at(curve.cubics(), intervals[i], time));
    // a disc of bends holds the chord between two that it has, not all that is between their coordinates
    const Report limits_kept = check_limits(robot, trajectory.points.back().posture.bends);
    if (!limits_kept.ok()) {
      trajectory.report = refused(limits_kept.status, "on the way to posture ", intervals[i].piece + 1,
                                  limits_kept.message.view());
      trajectory.points.clear();
      return trajectory;
    }
  }
  trajectory.points.push_back(at_rest(postures.back(), trajectory.duration));
  return trajectory;
}

}  // namespace sinew::inline v1
