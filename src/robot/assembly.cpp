#include "sinew/robot/assembly.hpp"

#include <cmath>

#include "robot/pose.hpp"
#include "sinew/base/assert.hpp"

namespace sinew::inline v0 {
namespace {

std::size_t at(int row, int column, int columns) { return static_cast<std::size_t>(row * columns + column); }

template <class LegT>
Reduced assemble_robot(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                       Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  const int rows = robot.row_count(), inputs = static_cast<int>(work.inputs.size());
  Reduced reduced{MatrixView(work.J.data(), rows, Space::dof), MatrixView(work.K.data(), rows, inputs),
                  work.s, 0, 0};
  std::fill(work.K.begin(), work.K.end(), 0.0);
  for (int i = 0; i < rows; ++i) {
    const auto index = static_cast<std::size_t>(i);
    with_leg(robot.legs[index], [&](const auto& leg) {
      const double q = coordinates[index];
      const auto blocks = leg.template blocks<double>(platform, leg.tip(q));
      for (int j = 0; j < Space::dof; ++j) work.J[at(i, j, Space::dof)] = blocks.g_x[j];
      work.K[at(i, robot.input_of_leg[index], inputs)] = -blocks.g_q[0] * leg.input_rate();
      work.s[index] = -blocks.g;
      const double error =
          std::isfinite(blocks.error) ? std::abs(blocks.error) : std::numeric_limits<double>::infinity();
      if (error > reduced.closure_error) {
        reduced.closure_error = error;
        reduced.worst_leg = i;
      }
    });
  }
  return reduced;
}

Report refusal(Status status, std::string_view what, int index, std::string_view rule) {
  Report report;
  report.status = status;
  report.message.append(what);
  report.message.append("[");
  append_number(report.message, index);
  report.message.append("]");
  report.message.append(rule);
  return report;
}

Report wrong_count(std::size_t found, std::size_t needed) {
  Report report;
  report.status = Status::left_domain;
  report.message.append("the robot has ");
  append_number(report.message, static_cast<int>(needed));
  report.message.append(" inputs, ");
  append_number(report.message, static_cast<int>(found));
  report.message.append(" were given");
  return report;
}

template <class LegT>
Report command_robot(const ParallelRobot<LegT>& robot, Numbers inputs, Workspace& work) {
  if (inputs.size() != work.inputs.size()) return wrong_count(inputs.size(), work.inputs.size());
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const int source = robot.input_of_leg[i];
    const double a = inputs[static_cast<std::size_t>(source)];
    work.coordinates[i] = robot.legs[i].coordinate(a);
    if (!robot.legs[i].in_domain(work.coordinates[i]))
      return refusal(Status::left_domain, "inputs", source,
                     " bends the link to a full turn, or a tendon to its centre of curvature; give a length "
                     "nearer to the backbone's");
  }
  std::copy(inputs.begin(), inputs.end(), work.inputs.begin());
  return {};
}

template <class LegT>
void states_of_robot(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                     Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    work.legs[i] = robot.legs[i].state(platform, coordinates[i]);
}

}  // namespace

Reduced assemble(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  return std::visit([&](const auto& r) { return assemble_robot(r, pose, coordinates, work); }, robot.model);
}

Report command(const AnyRobot& robot, Numbers inputs, Workspace& work) {
  return std::visit([&](const auto& r) { return command_robot(r, inputs, work); }, robot.model);
}

std::span<const LegState> leg_states(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates,
                                     Workspace& work) {
  std::visit([&](const auto& r) { states_of_robot(r, pose, coordinates, work); }, robot.model);
  return work.legs;
}

AnyPose home(const AnyRobot& robot) {
  return std::visit([](const auto& r) -> AnyPose { return r.home; }, robot.model);
}
int leg_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.leg_count(); }, robot.model);
}
int input_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.input_count(); }, robot.model);
}
int dof(const AnyRobot& robot) {
  return std::visit([]<class LegT>(const ParallelRobot<LegT>&) { return LegT::Space::dof; }, robot.model);
}

Workspace::Workspace(const AnyRobot& robot) {
  const auto legs_ = static_cast<std::size_t>(leg_count(robot));
  const auto inputs_ = static_cast<std::size_t>(input_count(robot));
  const auto dof_ = static_cast<std::size_t>(dof(robot));
  coordinates.resize(legs_);
  inputs.resize(inputs_);
  J.resize(legs_ * dof_);
  K.resize(legs_ * inputs_);
  U.resize(dof_ * inputs_);
  s.resize(legs_);
  unit_J.resize(legs_ * dof_);
  unit_K.resize(legs_ * inputs_);
  rates.resize(inputs_);
  solutions.resize(inputs_ * max_solutions);
  solution_count.resize(inputs_);
  type_1.resize(legs_);
  legs.resize(legs_);
}

}  // namespace sinew::inline v0
