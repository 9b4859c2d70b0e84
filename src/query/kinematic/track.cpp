/// `track` of legs that bear no load: a path of poses into rows of inputs.
#include <fmt/format.h>

#include <cmath>

#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "query/context.hpp"
#include "query/kinematic/kinematics.hpp"
#include "query/questions.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

/// From, to and how many: angles of the plane as the numbers say, rotations the shortest way; in between put
/// back into the planes that hinges may hold the platform in.
std::vector<AnyPose> straight_path(const Robot& robot, const AnyPose& from, const AnyPose& to, int samples) {
  std::vector<AnyPose> poses;
  const auto *a = std::get_if<PlanarPose>(&from), *b = std::get_if<PlanarPose>(&to);
  for (int k = 0; k < samples; ++k) {
    const double part = static_cast<double>(k) / (samples - 1);
    if (a && b)
      poses.emplace_back(PlanarPose{std::lerp(a->x, b->x, part), std::lerp(a->y, b->y, part),
                                    std::lerp(a->phi, b->phi, part)});
    else
      poses.push_back(k == 0            ? from
                      : k + 1 < samples ? project_to_constraints(robot, between(from, to, part))
                                        : to);
  }
  return poses;
}

}  // namespace

std::vector<AnyPose> read_path(Context& context) {
  Reader& query = context.query;
  if (const auto list = query.optional("poses")) {
    std::vector<AnyPose> poses;
    for (Reader& item : list->items()) poses.push_back(read_pose(context, std::move(item)));
    for (std::size_t k = 1; k < poses.size();
         ++k)  // a list holds angles of answers, in (−π, π]: the short way
      if (auto* to = std::get_if<PlanarPose>(&poses[k])) {
        const double before = std::get<PlanarPose>(poses[k - 1]).phi;
        to->phi = before + wrap_angle(to->phi - before);
      }
    if (poses.empty()) list->fail("empty_list", "a path needs at least one pose");
    for (const char* key : {"from", "to", "samples"})
      if (query.has(key)) query.fail("ambiguous", fmt::format("gives both poses and {}; keep one", key));
    return poses;
  }
  const AnyPose from = read_pose(context, query.required("from", "first pose of the path, or poses: a list"));
  const AnyPose to = read_pose(context, query.required("to", "last pose of the path"));
  const auto samples = query.optional("samples");
  const int count = samples ? samples->integer(Range::between(2, max_path_samples)) : default_path_samples;
  return context.errors.empty() ? straight_path(context.robot, from, to, std::max(count, 2))
                                : std::vector<AnyPose>{};
}

Objective read_objective(Reader& query) {
  const auto objective = query.optional("objective");
  if (!objective) return Objective::none;
  return objective->choice_of<Objective>({{"limits", Objective::limits},
                                          {"singularity", Objective::singularity},
                                          {"smooth", Objective::smooth},
                                          {"none", Objective::none}});
}

namespace {

std::string in_words(const AnyPose& pose) {
  if (const auto* planar = std::get_if<PlanarPose>(&pose))
    return fmt::format("x = {}, y = {}, phi = {}", human(planar->x, Dimension::length),
                       human(planar->y, Dimension::length), human(planar->phi, Dimension::angle));
  const auto& spatial = std::get<SpatialPose>(pose);
  const Vec3<double>& p = spatial.position;
  const Vec3<double> turn = SE3<double>::from(spatial).R.log() * (180 / std::numbers::pi);
  return fmt::format("position ({:.6g}, {:.6g}, {:.6g}) mm, rotation vector ({:.4g}, {:.4g}, {:.4g}) deg",
                     1e3 * p[0], 1e3 * p[1], 1e3 * p[2], turn[0], turn[1], turn[2]);
}

Value row_value(Context& context, const Track& track) {
  Value row{{"pose", pose_value(track.pose())},
            {"inputs", Value(track.inputs())},
            {"curvature", Value::Block()},
            {"closure_error", track.closure_error()}};
  const std::vector<double> coordinates(track.coordinates().begin(), track.coordinates().end());
  std::vector<double> curvature;
  for (const LegState& leg : leg_states(context.robot, track.pose(), coordinates, context.work))
    if (!std::isnan(leg.curvature)) curvature.push_back(leg.curvature);
  row["curvature"] = curvature;
  const Velocity at = velocity(context.robot, track.pose(), coordinates, context.work);
  row["indices"] = indices_value(at.indices);
  if (!at.type_1.empty()) row["type_1"] = std::span<const int>(at.type_1);
  if (at.type_2.singular) row["singular"] = true;
  return row;
}

}  // namespace

void put_path_end(Context& context, const Report& report, std::size_t rows, std::size_t samples,
                  double beyond, const AnyPose& pose) {
  Value& answer = context.answer;
  context.report(report);
  if (rows == 0) {
    answer["message"] = fmt::format("the first pose: {}", report.message.view());
    answer["reached"] = {{"rows", 0}, {"part", 0.0}};
    return;
  }
  const double part = (static_cast<double>(rows - 1) + beyond) / static_cast<double>(samples - 1);
  answer["message"] = fmt::format("the path ends between poses {} and {} of {}, {:.4g} % along it, at {}: {}",
                                  rows, rows + 1, samples, 100 * part, in_words(pose), report.message.view());
  answer["reached"] = {{"rows", rows}, {"part", part}, {"pose", pose_value(pose)}};
}

namespace {

struct KinematicPath : Context {
  explicit KinematicPath(const Context& context) : Context(context) {}

  void read();
  void tell();

 private:
  std::vector<AnyPose> poses_ = {};
  Branch branch_ = {};
  Objective objective_ = Objective::none;
  std::vector<double> start_ = {};
};

void KinematicPath::read() {
  poses_ = read_path(*this);
  branch_ = read_branch(*this);
  objective_ = read_objective(query);
  if (const auto given = query.optional("start")) start_ = read_inputs(*this, *given);
}

void KinematicPath::tell() {
  TrackOptions options{.branch = branch_.options(), .objective = objective_};
  options.branch.start = start_;
  Track track(robot, options, work);
  Value rows = Value::list();
  Report found;
  double worst = 0;
  for (const AnyPose& pose : poses_) {
    found = track.advance(pose);
    note_stop(work.stop, found);
    if (!found.ok()) break;
    worst = std::max(worst, track.closure_error());
    rows.push_back(row_value(*this, track));
  }
  report(found);
  if (!found.ok()) put_path_end(*this, found, rows.size(), poses_.size(), track.progress(), track.pose());
  answer["residual"] = worst;
  answer["rows"] = std::move(rows);
}

}  // namespace

void answer_kinematic_track(Context& context) { answer_question<KinematicPath>(context); }

}  // namespace sinew::inline v1
