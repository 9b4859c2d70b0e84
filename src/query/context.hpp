/// @file context.hpp
/// What the handlers of queries share: the robot, the reader of the query and the answer being written.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "sinew/analysis/velocity.hpp"
#include "sinew/io/reader.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "sinew/robot/workspace.hpp"

namespace sinew::inline v0 {

using Json = nlohmann::ordered_json;

/// One query being answered. A handler reads every field it knows, calls `ready`, and only then computes.
struct Context {
  const AnyRobot& robot;
  Workspace& work;
  Reader& query;
  Errors& errors;
  Json& answer;
  std::optional<int> max_iterations;

  /// True when all fields are read, none is left over and none was wrong.
  bool ready() {
    query.close();
    return errors.empty();
  }
  void report(const Report& report) {
    answer["status"] = to_string(report.status);
    if (!report.message.empty()) answer["message"] = report.message.view();
  }
};

/// Branch of an inverse-type question, with the storage its views point to.
struct Branch {
  std::vector<int> bending;
  std::vector<double> curvature;
  bool is_default() const { return bending.empty() && curvature.empty(); }
  InverseOptions options() const { return {.bending = bending, .curvature = curvature}; }
};

PlanarPose read_pose(Reader pose);
Branch read_branch(Context& context);
std::vector<double> read_inputs(Context& context, const Reader& inputs);

/// A configuration as a query gives it: `pose` with a branch, `pose` with `inputs`, or `inputs` with `start`.
struct Configuration {
  std::optional<AnyPose> pose, start;
  std::optional<std::vector<double>> inputs;
  Branch branch;
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

Json to_json(const AnyPose& pose);
Json to_json(std::span<const double> values);
Json to_json(const MatrixView& matrix);
Json to_json(const Vec2<double>& point);
Json legs_json(const AnyRobot& robot, const AnyPose& pose, std::span<const double> coordinates,
               Workspace& work);

void answer_forward(Context& context);
void answer_inverse(Context& context);
void answer_velocity(Context& context);
void answer_shape(Context& context);
void answer_describe(Context& context);

}  // namespace sinew::inline v0
