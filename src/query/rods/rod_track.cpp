/// `track` of robots on rods along poses, or along coordinates that three inputs hold: the inputs at each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "query/questions.hpp"
#include "query/rods/rods.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

/// What inputs can hold: a pose, or three coordinates of one.
using Held = std::variant<SpatialPose, IndependentPose>;

Held held_between(const Held& from, const Held& to, double part) {
  if (const auto* a = std::get_if<SpatialPose>(&from))
    return std::get<SpatialPose>(between(*a, std::get<SpatialPose>(to), part));
  const auto &a = std::get<IndependentPose>(from), &b = std::get<IndependentPose>(to);
  return IndependentPose{std::lerp(a.z, b.z, part), std::lerp(a.e1, b.e1, part), std::lerp(a.e2, b.e2, part)};
}

Held read_three(Context& context, Reader& place) {
  if (place.is(Node::Kind::map) && (place.has("position") || place.has("quaternion"))) {
    place.fail("not_available",
               "on rods the rest of a pose follows from three lengths and load; give {z, e1, e2}");
    return IndependentPose{};
  }
  return read_independent(context, place);
}

/// As read_path, of {z, e1, e2}.
std::vector<Held> read_independent_path(Context& context) {
  std::vector<Held> path;
  Reader& query = context.query;
  if (const auto list = query.optional("poses")) {
    for (Reader& item : list->items()) path.push_back(read_three(context, item));
    if (path.empty()) list->fail("empty_list", "a path needs at least one pose");
    for (const char* key : {"from", "to", "samples"})
      if (query.has(key)) query.fail("ambiguous", fmt::format("gives both poses and {}; keep one", key));
    return path;
  }
  Reader first = query.required("from", "{z, e1, e2}: where the path begins"),
         last = query.required("to", "{z, e1, e2}: where the path ends");
  const Held from = read_three(context, first), to = read_three(context, last);
  const auto samples = query.optional("samples");
  const int count = samples ? samples->integer(Range::between(2, max_path_samples)) : default_path_samples;
  for (int k = 0; k < count && context.errors.empty(); ++k)
    path.push_back(k + 1 < count ? held_between(from, to, static_cast<double>(k) / (count - 1)) : to);
  return path;
}

Equilibrium hold(Context& context, const Held& wanted, const EquilibriumOptions& options) {
  return std::visit(
      [&](const auto& one) { return inverse_equilibrium(context.robot, one, options, context.work); },
      wanted);
}

/// So far may the platform go at once, over a rod's length and in rad: beyond, Newton's method might find
/// another branch.
constexpr double longest_stride = 0.05, widest_turn = 0.1;

/// From the equilibrium that is held to the next one on the path: to a pose in strides; three coordinates are
/// followed in strides by who solves them.
Equilibrium follow_to(Context& context, const Held& from, const Held& to, EquilibriumOptions options,
                      double length) {
  options.warm_start = true;
  int strides = 1;
  if (const auto* pose = std::get_if<SpatialPose>(&to)) {
    const Vec<double, 6> way = twist_between(std::get<SpatialPose>(from), *pose);
    const double far =
        std::max(way.head<3>().norm() / (longest_stride * length), way.tail<3>().norm() / widest_turn);
    strides = static_cast<int>(std::clamp(std::ceil(far), 1.0, 1e6));
  }
  options.check_stability = false;
  for (int k = 1; k < strides; ++k) {
    Equilibrium found = hold(context, held_between(from, to, static_cast<double>(k) / strides), options);
    if (!found.is_solved()) return found;
  }
  options.check_stability = true;
  return hold(context, to, options);
}

Value rod_row_value(const Equilibrium& found, const RodAnalysis& analysis) {
  Value row{{"pose", pose_value(found.pose)},
            {"inputs", Value(found.inputs)},
            {"status", to_string(found.report.status)},
            {"residual", found.report.residual},
            {"stable", analysis.unstable_directions == 0},
            {"unstable_directions", analysis.unstable_directions}};
  put_number(row, "potential", analysis.potential);
  row["margins"] = {{"fold", analysis.smallest_pivot}, {"strain", analysis.largest_strain}};
  row["indices"] = indices_value(analysis);
  if (analysis.is_singular()) row["singular"] = true;
  return row;
}

/// How much of the way from one to the other the platform has come.
double part_of(const Held& from, const Held& to, const SpatialPose& here) {
  double along = 0, square = 0;
  const auto add = [&](double come, double whole) { along += come * whole, square += whole * whole; };
  if (const auto* pose = std::get_if<SpatialPose>(&from)) {
    const Vec<double, 6> whole = twist_between(*pose, std::get<SpatialPose>(to)),
                         come = twist_between(*pose, here);
    for (int k = 0; k < 6; ++k) add(come[k], whole[k]);
  } else {
    const auto &a = std::get<IndependentPose>(from), &b = std::get<IndependentPose>(to);
    add(here.position[2] - a.z, b.z - a.z);
    add(here.quaternion[1] - a.e1, b.e1 - a.e1);
    add(here.quaternion[2] - a.e2, b.e2 - a.e2);
  }
  return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
}

struct RodPath : Context {
  explicit RodPath(const Context& context) : Context(context) {}

  void read();
  void solve();
  void tell();

 private:
  std::vector<Held> path_ = {};
  RodStart start_ = {};
  EquilibriumOptions options_ = {};

  bool is_begun_ = false;
  Equilibrium found_ = {};  ///< the last
  Value rows_ = Value::list();
  double worst_ = 0;
  std::size_t unstable_ = 0, first_unstable_ = 0;  ///< how many rows, and which is the first, from 1
};

void RodPath::read() {
  const int inputs = input_count(robot);
  read_branch(*this);  // refuses bending, curvature and elbow
  read_objective(query);
  if (inputs == 3)
    path_ = read_independent_path(*this);
  else
    for (const AnyPose& pose : read_path(*this)) path_.emplace_back(std::get<SpatialPose>(pose));
  if (inputs != 3 && inputs != 6)
    query.fail("not_available",
               fmt::format("a pose is held by six inputs, z, e1 and e2 by three; this robot has {}: follow "
                           "what changes, by inputs and to: {{inputs, wrench}}",
                           inputs));
  start_ = read_start_of_inverse(*this);
  options_ = read_equilibrium_options(*this);
}

void RodPath::solve() {
  EquilibriumOptions options = options_;
  options.warm_start = begin_at(*this, start_, options, found_.report);
  is_begun_ = found_.report.is_solved();
  if (!is_begun_) return remember_held(*this, {});
  double length = 0;
  for (std::size_t k = 0; k < path_.size(); ++k) {
    found_ =
        k == 0 ? hold(*this, path_[0], options) : follow_to(*this, path_[k - 1], path_[k], options, length);
    if (!found_.is_solved() || note_stop(work.stop, found_.report)) break;
    const RodAnalysis analysis = analyse_equilibrium(robot, work);
    length = analysis.rods.front().length;
    worst_ = std::max(worst_, found_.report.residual);
    if (analysis.unstable_directions > 0 && unstable_++ == 0) first_unstable_ = k + 1;
    rows_.push_back(rod_row_value(found_, analysis));
  }
  const bool arrives = rows_.size() == path_.size();
  remember_held(*this, arrives ? std::optional(found_.pose) : std::nullopt);
}

void RodPath::tell() {
  if (!is_begun_) {
    report(found_.report);
    answer["message"] = "from start: " + std::string(found_.report.message.view());
    answer["reached"] = {{"rows", 0}, {"part", 0.0}};
    return;
  }
  if (const std::size_t k = rows_.size(); k < path_.size()) {
    put_path_end(*this, found_.report, k, path_.size(),
                 k > 0 ? part_of(path_[k - 1], path_[k], found_.pose) : 0, found_.pose);
  } else {
    answer["status"] = to_string(unstable_ > 0 ? Status::unstable : Status::converged);
    if (unstable_ > 0)
      answer["message"] = fmt::format(
          "at {} of {} poses the robot does not hold by itself, first at pose {}: see unstable_directions",
          unstable_, k, first_unstable_);
  }
  answer["residual"] = worst_;
  answer["rows"] = std::move(rows_);
}

}  // namespace

void answer_rods_path(Context& context) { answer_question<RodPath>(context); }

}  // namespace sinew::inline v1
