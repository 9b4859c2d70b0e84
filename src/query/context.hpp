/// @file context.hpp
/// What the handlers of queries share: the robot, the reader of the query and the answer being written.
#pragma once
#include <functional>
#include <limits>
#include <optional>

#include "io/document/reader.hpp"
#include "query/answer/value.hpp"
#include "query/kinds.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "sinew/robot/robot.hpp"
#include "sinew/session.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

struct Handlers;

/// Who is told how far a question is; may be empty.
using ProgressCall = std::function<void(const QuestionProgress&)>;

/// When the search for a pose begins where the last one ended.
enum class Continues { always, where_asked };

/// One query being answered, whatever the robot. A handler reads every field it knows, calls `ready`, and
/// only then computes.
struct Question {
  Reader& query;
  Errors& errors;
  Value& answer;
  const Handlers& handlers;  ///< of the robot's mechanics
  Ask ask;
  std::optional<int> max_iterations = {};
  /// The pose last answered, where a search may begin. Null for a question by itself.
  std::optional<AnyPose>* last = nullptr;
  /// On a path of questions always: the workspace then still holds that answer. In a session where `start`
  /// says so.
  Continues continues = Continues::where_asked;
  bool names_start = false;                ///< `start` was read
  bool starts_at_last = false;             ///< ... and there is a last pose
  const ProgressCall* progress = nullptr;  ///< none: nobody wants to know
  bool is_only_read = false;  ///< nothing is computed: what is wrong with the fields is all that is asked

  /// True when all fields are read, none is left over and none was wrong, and the answer is wanted.
  bool ready() { return is_read() && !is_only_read; }
  /// The same whether or not the answer is wanted.
  bool is_read() {
    query.close();
    return errors.empty();
  }
  /// Where a question that names no start begins on a path of questions.
  std::optional<AnyPose> path_start() const {
    return last && continues == Continues::always ? *last : std::nullopt;
  }
  /// Keeps the pose that was found; none where the search failed. Whether it is `last` from now on.
  bool remember(const std::optional<AnyPose>& found) {
    if (!last || !(names_start || continues == Continues::always)) return false;
    *last = found;
    return found.has_value();
  }
  void report(Report report) {
    if (report.status == Status::stopped && report.message.empty()) say_stopped(report);
    answer["status"] = to_string(report.status);
    if (!report.message.empty()) answer["message"] = report.message.view();
  }
  /// What a part of the answer says of itself, after what is said of the configuration. Its status counts
  /// where it is no success.
  void add_report(const Report& report) {
    if (!report.ok()) answer["status"] = to_string(report.status);
    add_message(report.message.view());
  }
  void add_message(std::string_view message) {
    if (message.empty()) return;
    std::string said(answer.text_at("message"));
    answer["message"] = said.empty() ? std::string(message) : said + "; " + std::string(message);
  }
};

/// One put to a robot with a platform.
struct Context : Question {
  const Robot& robot;
  Workspace& work;
};

/// Branch of an inverse-type question, with the storage its views point to.
struct Branch {
  std::vector<int> bending;
  std::vector<double> curvature;
  std::vector<int> elbow;
  bool is_default() const { return bending.empty() && curvature.empty() && elbow.empty(); }
  InverseOptions options() const { return {.bending = bending, .curvature = curvature, .elbow = elbow}; }
};

/// A pose of the robot's space.
AnyPose read_pose(const Context& context, Reader pose);

/// Where a search is to begin, by `start`: a pose, or `last`, the pose found last by a question that named
/// its start. Nothing for home.
std::optional<AnyPose> read_start(Context& context);

/// The pose that a query asks for by `pose` or `independent`, if it does; the report says whether there is
/// one.
struct AskedPose {
  std::optional<AnyPose> pose;
  Report report;
  std::optional<std::pair<IndependentPose, OperationMode>> independent;  ///< what gave it, if that did
};
AskedPose read_asked_pose(Context& context);
Branch read_branch(Context& context);
std::vector<double> read_inputs(Context& context, const Reader& inputs);

/// A configuration as a query gives it: a pose with a branch, a pose with `inputs`, or `inputs` with `start`.
struct Configuration {
  AskedPose at = {};
  std::optional<AnyPose> start = {};
  std::optional<std::vector<double>> inputs = {};
  Branch branch = {};
};

/// The same, solved.
struct Solved {
  Report report;
  AnyPose pose;
  std::vector<double> coordinates;
};

Configuration read_configuration(Context& context);
/// Solves what is missing. An error (with `context.errors` filled) where pose and inputs contradict each
/// other.
Solved solve_configuration(Context& context, const Configuration& configuration);

Value pose_value(const AnyPose& pose);
/// `tilt`, `azimuth` and `torsion` beside the quaternions of `pose`, `tip` and the poses of `solutions`.
void add_tilt(Value& answer);
Value indices_value(const Indices& indices);
Value type_two_value(const TypeTwo& type, bool is_planar);
void put_number(Value& object, Value::Key key, double value);  ///< leaves out NaN and infinity
Value legs_value(const Robot& robot, const AnyPose& pose, std::span<const double> coordinates,
                 Workspace& work);

/// The field `along` of a velocity query, with its `limit`: a direction to look for type II in.
struct Along {
  std::vector<double> direction;
  double limit = std::numeric_limits<double>::quiet_NaN();
};
std::optional<Along> read_along(Context& context);
/// Writes `type_2_distance`. Uses the workspace.
void put_type_2_distance(Context& context, const Along& along, const Configuration& given,
                         const AnyPose& pose);

inline constexpr int default_path_samples = 60, max_path_samples = 100000;
/// Poses of a path: a list, or samples of a straight line.
std::vector<AnyPose> read_path(Context& context);
/// Where along a path of so many samples it ended, and why.
/// @param beyond how much of the way from the last row to the next one was gone
/// @param pose where it ended
void put_path_end(Context& context, const Report& report, std::size_t rows, std::size_t samples,
                  double beyond, const AnyPose& pose);
Objective read_objective(Reader& query);

void put_shape(Value& answer, const AnyShape& picture);

}  // namespace sinew::inline v1
