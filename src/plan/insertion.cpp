#include "sinew/plan/insertion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "plan/draw.hpp"
#include "plan/parallel.hpp"
#include "plan/search.hpp"
#include "plan/smoothing.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double bend_weight = 0.02;        // of a final pose [1/rad]: of several, the straighter
constexpr double guide_weight = 1 / 1e-3;   // of the way out [1/m]
constexpr double change_weight = 1 / 0.05;  // of bends from step to step [1/rad]
constexpr double coarse = 0.8, fine = 0.4;  // spacing of points on the backbone, in radii
constexpr double between_points = 0.05e-3;  // what the distance of points may have too much [m]
constexpr double hopeless = -0.3e-3;        // clearance from which smoothing does not lead to a good way [m]
constexpr std::size_t batch = 24;  // final poses that are searched together, so that threads decide nothing

/// One way out of a final pose, from there to outside.
struct WayOut {
  std::vector<Posture> way;
  double clearance = 0;
  Blocked blocked;
};

class Planner {
 public:
  Planner(const InsertionScene& scene, const InsertionOptions& options)
      : begin_(std::chrono::steady_clock::now()),
        scene_(scene),
        options_(options),
        obstacles_(scene.solids) {
    deadline_.stop = options.stop;
    deadline_.at = begin_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                std::chrono::duration<double>(std::min(options.time_limit, 1e6)));
    const std::size_t threads =
        options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    for (std::size_t t = 0; t < threads; ++t) {
      searches_.emplace_back(scene, obstacles_, coarse);
      fine_.emplace_back(scene, obstacles_, fine);
    }
    for (std::vector<Search>* all : {&searches_, &fine_})
      for (Search& search : *all) search.deadline = deadline_;
    goal_ = scene.clearance + std::max(0.3e-3, 0.2 * scene.clearance);
  }

  InsertionPlan plan() {
    if (scene_.robot.sections.empty() || !(options_.step > 0)) {
      result_.report.status = Status::bad_input;
      result_.report.message = std::string_view("a robot with sections and a step > 0 are needed");
      return finished();
    }
    for (std::size_t first = 0; first < static_cast<std::size_t>(options_.starts) && !is_over();
         first += batch) {
      const std::size_t count = std::min(batch, static_cast<std::size_t>(options_.starts) - first);
      std::vector<Posture> poses = final_poses(first, count);
      if (is_over()) break;
      result_.starts += static_cast<int>(count);
      for (const Posture& pose : poses) {
        if (is_over()) break;
        ++result_.ways;
        WayOut out = way_out(pose);
        if (!(out.clearance > hopeless)) {
          note(out.blocked);
          continue;
        }
        if (finish(std::move(out))) return finished();
      }
    }
    return failed();
  }

 private:
  bool is_over() const { return deadline_.is_over(); }

  void say(std::string_view phase, double share) const {
    if (options_.progress) options_.progress({phase, share});
  }

  /// Postures at the target and clear, the clearest first; only what is not like another one.
  std::vector<Posture> final_poses(std::size_t first, std::size_t count) {
    say("final pose", static_cast<double>(first) / options_.starts);
    struct Found {
      Posture x;
      double gap, miss;
      int solid;
      Vec3<double> place;
    };
    std::vector<Found> found(count);
    in_parallel(count, searches_.size(), [&](std::size_t i, std::size_t thread) {
      Search& search = searches_[thread];
      search.goal = goal_;
      Draw draw(options_.seed * 1'000'003 + first + i);
      Posture x(search.lower.size());
      for (std::size_t k = 0; k < x.size(); ++k)
        x[k] = draw.between(search.lower[k], search.upper[k]) * (k == 0 ? 1 : 0.7);
      const auto terms = [&](Quadratic& at) {
        search.add_target(at);
        for (std::size_t k = 1; k < x.size(); ++k)
          at.add(bend_weight * search.body.posture(k), static_cast<Eigen::Index>(k) + 1,
                 [&](Eigen::Index j) { return static_cast<std::size_t>(j) == k ? bend_weight : 0.0; });
      };
      // first a thin robot, which finds its way round what a thick one is caught by
      for (const double share : {0.9, 0.5, 0.2, 0.0}) {
        search.goal = goal_ - share * search.body.radius(0);
        x = search.descended(x, terms, share > 0 ? 15 : 60, false);
      }
      const Gap gap = search.gap(goal_);
      found[i] = {x, gap.size, search.is_at_target() ? 0 : search.tip_error(), gap.solid,
                  search.body.point(gap.point)};
    });
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
      return a.miss != b.miss ? a.miss < b.miss : a.gap > b.gap;
    });
    std::vector<Posture> good;
    for (const Found& f : found) {
      if (f.miss > 0 || f.gap < scene_.clearance) {
        Blocked blocked{f.solid < 0 ? "" : scene_.solids[static_cast<std::size_t>(f.solid)].name, f.place,
                        f.x[0], std::max(scene_.clearance - f.gap, 0.0)};
        if (f.miss > 0 && f.gap >= scene_.clearance) blocked.solid.clear(), blocked.missing = f.miss;
        note_final(blocked, f.miss);
        continue;
      }
      const bool is_new = std::none_of(good.begin(), good.end(), [&](const Posture& other) {
        double most = 0;
        for (std::size_t k = 1; k < other.size(); ++k) most = std::max(most, std::abs(other[k] - f.x[k]));
        return most < 0.03;
      });
      if (is_new) good.push_back(f.x);
    }
    return good;
  }

  /// Backwards out of a final pose, the body on the line that it lay on.
  WayOut way_out(const Posture& final_pose) {
    Search& search = searches_.front();
    search.goal = goal_;
    search.body.place(final_pose, false);
    Guide guide;
    for (std::size_t i = 0; i < search.body.size(); ++i) {
      guide.points.push_back(search.body.point(i));
      guide.arcs.push_back(search.body.arc(i));
    }
    guide.behind = scene_.axis;
    const auto steps = static_cast<std::size_t>(std::ceil(final_pose[0] / options_.step - 1e-9));
    WayOut out;
    out.way.push_back(final_pose);
    out.clearance = search.gap(goal_).size;
    for (std::size_t k = 1; k <= steps && !is_over(); ++k) {
      const Posture& last = out.way.back();
      Posture x = last;
      if (k > 1)  // as it went on
        for (std::size_t i = 1; i < x.size(); ++i) x[i] += last[i] - out.way[k - 2][i];
      x[0] = final_pose[0] * (1 - static_cast<double>(k) / static_cast<double>(steps));
      const double advance = x[0] - final_pose[0];
      const auto terms = [&](Quadratic& at) {
        search.add_guide(at, guide, advance, guide_weight);
        for (std::size_t i = 1; i < x.size(); ++i)
          at.add(change_weight * (search.body.posture(i) - last[i]), static_cast<Eigen::Index>(i) + 1,
                 [&](Eigen::Index j) { return static_cast<std::size_t>(j) == i ? change_weight : 0.0; });
      };
      Posture best = search.descended(x, terms, 25, true);
      Gap gap = search.gap(goal_);
      if (gap.size < 0) repair(search, x, terms, best, gap, k);
      search.body.place(best, false);
      if (gap.size < out.clearance) {
        out.clearance = gap.size;
        out.blocked = {gap.solid < 0 ? "" : scene_.solids[static_cast<std::size_t>(gap.solid)].name,
                       search.body.point(gap.point), best[0], scene_.clearance - gap.size};
      }
      out.way.push_back(std::move(best));
      if (out.clearance < -1e-3) break;
      if (k % 8 == 0) say("way out", static_cast<double>(k) / static_cast<double>(steps));
    }
    return out;
  }

  /// Another descent from places around; the clearest is taken.
  void repair(Search& search, const Posture& from, const std::function<void(Quadratic&)>& terms,
              Posture& best, Gap& gap, std::size_t step) {
    Draw draw(options_.seed * 7919 + step);
    for (int attempt = 0; attempt < 8 && gap.size < 0; ++attempt) {
      Posture x = from;
      for (std::size_t i = 1; i < x.size(); ++i) x[i] += draw.between(-0.05, 0.05);
      x = search.descended(x, terms, 25, true);
      const Gap other = search.gap(goal_);
      if (other.size > gap.size) best = x, gap = other;
    }
  }

  /// Smooths a way and has it checked; whether it is good.
  bool finish(WayOut out) {
    std::vector<Posture> way(out.way.rbegin(), out.way.rend());
    for (const double more : {0.0, 0.3e-3, 0.6e-3}) {
      if (is_over()) return false;
      say("smoothing", more / 0.9e-3);
      smooth(way, fine_, goal_ + more, 40);
      fine_.front().body.place(way.back(), false);
      if (!fine_.front().is_at_target()) return false;
      const double tip_error = fine_.front().tip_error();
      std::vector<InsertionStep> steps;
      for (const Posture& x : way) steps.push_back(step_of(x));
      std::vector<InsertionStep> all = interpolated(steps, options_.step / 2);
      const double size = measure(all);
      if (size >= scene_.clearance - between_points) {
        if (is_checked(std::move(all))) {
          result_.tip_error = tip_error;
          return true;
        }
      } else if (size < hopeless) {
        return false;
      }
    }
    return false;
  }

  /// Least clearance of points on the backbone: nearly that of the robot, and soon known.
  double measure(const std::vector<InsertionStep>& steps) {
    std::vector<Gap> gaps(steps.size());
    std::vector<Vec3<double>> places(steps.size());
    in_parallel(steps.size(), fine_.size(), [&](std::size_t k, std::size_t thread) {
      Search& search = fine_[thread];
      search.body.place(posture_of(steps[k]), false);
      gaps[k] = search.gap(goal_);
      places[k] = search.body.point(gaps[k].point);
    });
    const auto least = std::min_element(gaps.begin(), gaps.end(),
                                        [](const Gap& a, const Gap& b) { return a.size < b.size; });
    const auto k = static_cast<std::size_t>(least - gaps.begin());
    if (least->size < scene_.clearance)
      note({least->solid < 0 ? "" : scene_.solids[static_cast<std::size_t>(least->solid)].name, places[k],
            steps[k].stage, scene_.clearance - least->size});
    return least->size;
  }

  bool is_checked(std::vector<InsertionStep> steps) {
    say("check", 0);
    InsertionCheckOptions options;
    options.threads = static_cast<unsigned>(searches_.size());
    options.stop = options_.stop;
    options.deadline = deadline_.at;
    InsertionCheck check = check_insertion(scene_, steps, options);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const TightSpot& spot = check.steps[k].spot;
      steps[k].clearance = spot.distance, steps[k].solid = spot.solid, steps[k].place = spot.on_robot;
    }
    const InsertionStep& worst = steps[check.worst];
    if (check.is_stopped || check.verdict == InsertionVerdict::touches ||
        check.clearance < scene_.clearance) {
      note({worst.solid < 0 ? "" : scene_.solids[static_cast<std::size_t>(worst.solid)].name, worst.place,
            worst.stage, scene_.clearance - worst.clearance});
      return false;
    }
    result_.steps = std::move(steps);
    result_.check = std::move(check);
    result_.report = {};
    return true;
  }

  void note(const Blocked& blocked) {
    if (!nearest_ || blocked.missing < nearest_->missing) nearest_ = blocked;
  }
  void note_final(const Blocked& blocked, double miss) {
    if (final_ && !(miss < final_miss_ || (miss == final_miss_ && blocked.missing < final_->missing))) return;
    final_ = blocked, final_miss_ = miss;
  }

  InsertionPlan finished() {
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    return std::move(result_);
  }

  InsertionPlan failed() {
    const auto mm = [](double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); };
    const auto at = [&](const Vec3<double>& p) {
      return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
    };
    result_.report.status = is_over() ? Status::stopped : Status::unreachable;
    const std::string prefix = is_over() ? "stopped before a way was found; so far " : "";
    std::string text;
    const std::optional<Blocked>& why = nearest_ ? nearest_ : final_;
    if (why) result_.blocked = *why;
    if (!why)
      text = prefix + (result_.ways > 0 ? "the ways that were found lose the target where they are made clear"
                                        : "nothing was tried");
    else if (nearest_)
      text = fmt::format("{}no way in: {} is in the way at stage {}, at {}; {} of clearance are missing",
                         prefix, why->solid.empty() ? "nothing" : why->solid, mm(why->stage), at(why->place),
                         mm(why->missing));
    else if (why->solid.empty())
      text = fmt::format("{}the tip does not get to the target: the nearest of {} tries is {} away", prefix,
                         result_.starts, mm(why->missing));
    else
      text = fmt::format("{}no pose at the target is clear: {} is in the way, at {}; {} are missing", prefix,
                         why->solid, at(why->place), mm(why->missing));
    result_.report.message = std::string_view(text);
    return finished();
  }

  std::chrono::steady_clock::time_point begin_;
  Deadline deadline_;
  const InsertionScene& scene_;
  const InsertionOptions& options_;
  Obstacles obstacles_;
  std::vector<Search> searches_, fine_;
  double goal_ = 0;
  InsertionPlan result_;
  std::optional<Blocked> nearest_, final_;
  double final_miss_ = 0;
};

}  // namespace

InsertionPlan plan_insertion(const InsertionScene& scene, const InsertionOptions& options) {
  return Planner(scene, options).plan();
}

}  // namespace sinew::inline v1
