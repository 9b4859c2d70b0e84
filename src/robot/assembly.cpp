#include "sinew/robot/assembly.hpp"

#include <cmath>

#include "robot/pose.hpp"
#include "sinew/base/assert.hpp"

namespace sinew::inline v0 {
namespace {

std::size_t at(int row, int column, int columns) { return static_cast<std::size_t>(row * columns + column); }

/// Rows of one leg into J, K and s; its closure error [m].
template <class LegT, class Frame>
double assemble_leg(const LegT& leg, const LegPlace& place, const Frame& platform, Numbers coordinates,
                    Workspace& work) {
  constexpr int dof = LegT::Space::dof;
  const int inputs = static_cast<int>(work.inputs.size());
  const auto q = own_coordinates(leg, place, coordinates);
  const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
  const Mat<double, LegT::rows, LegT::inputs> g_a = blocks.g_q * leg.input_rate();
  for (int i = 0; i < LegT::rows; ++i) {
    for (int j = 0; j < dof; ++j) work.J[at(place.row + i, j, dof)] = blocks.g_x(i, j);
    for (int j = 0; j < LegT::inputs; ++j) work.K[at(place.row + i, place.input + j, inputs)] = -g_a(i, j);
    work.s[at(place.row, i, 1)] = -blocks.g[i];
  }
  return std::isfinite(blocks.error) ? std::abs(blocks.error) : std::numeric_limits<double>::infinity();
}

template <class LegT>
Reduced assemble_robot(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                       Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  Reduced reduced{MatrixView(work.J.data(), robot.total.row, Space::dof),
                  MatrixView(work.K.data(), robot.total.row, robot.total.input), work.s, 0, 0};
  std::fill(work.K.begin(), work.K.end(), 0.0);
  robot.for_each_leg([&](const auto& leg, const LegPlace& place, int i) {
    const double error = assemble_leg(leg, place, platform, coordinates, work);
    if (error <= reduced.closure_error) return;
    reduced.closure_error = error;
    reduced.worst_leg = i;
  });
  return reduced;
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

Report beyond_domain(int input) {
  Report report;
  report.status = Status::left_domain;
  report.message.append("inputs[");
  append_number(report.message, input);
  report.message.append(
      "] bends the link to a full turn, or a tendon to its centre of curvature; give a length "
      "nearer to the backbone's");
  return report;
}

template <class LegT>
Report command_robot(const ParallelRobot<LegT>& robot, Numbers inputs, Workspace& work) {
  if (inputs.size() != work.inputs.size()) return wrong_count(inputs.size(), work.inputs.size());
  Report report;
  robot.for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
    const auto q = leg.coordinates_of(inputs.subspan(static_cast<std::size_t>(place.input), L::inputs));
    std::copy(q.begin(), q.end(), work.coordinates.begin() + place.coordinate);
    if (report.ok() && !leg.in_domain(q)) report = beyond_domain(place.input + L::inputs - 1);
  });
  if (report.ok()) std::copy(inputs.begin(), inputs.end(), work.inputs.begin());
  return report;
}

}  // namespace

Reduced assemble(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  return std::visit([&](const auto& r) { return assemble_robot(r, pose, coordinates, work); }, robot.model);
}

MatrixView homogenise(const AnyRobot& robot, const Reduced& reduced, Workspace& work) {
  const auto [dimension, radius] = std::visit(
      []<class LegT>(const ParallelRobot<LegT>& r) {
        return std::pair<Eigen::Index, double>(LegT::Space::dimension, r.platform_radius);
      },
      robot.model);
  const Eigen::Index dof = reduced.J.cols(), inputs = reduced.K.cols();
  for (Eigen::Index i = 0; i < reduced.J.rows(); ++i) {
    const double length = reduced.J.row(i).head(dimension).norm(), scale = length > 0 ? 1 / length : 0;
    for (Eigen::Index j = 0; j < dof; ++j)
      work.unit_J[static_cast<std::size_t>(i * dof + j)] =
          reduced.J(i, j) * (j < dimension ? scale : scale / radius);
    for (Eigen::Index j = 0; j < inputs; ++j)
      work.unit_K[static_cast<std::size_t>(i * inputs + j)] = reduced.K(i, j) * scale;
  }
  return {work.unit_J.data(), reduced.J.rows(), dof};
}

Report command(const AnyRobot& robot, Numbers inputs, Workspace& work) {
  return std::visit([&](const auto& r) { return command_robot(r, inputs, work); }, robot.model);
}

std::span<const LegState> leg_states(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates,
                                     Workspace& work) {
  std::visit(
      [&]<class LegT>(const ParallelRobot<LegT>& r) {
        using Space = typename LegT::Space;
        const auto platform = Space::frame(in_space<Space>(pose));
        r.for_each_leg([&](const auto& leg, const LegPlace& place, int i) {
          work.legs[static_cast<std::size_t>(i)] =
              leg.state(platform, own_coordinates(leg, place, coordinates));
        });
      },
      robot.model);
  return work.legs;
}

AnyPose home(const AnyRobot& robot) {
  return std::visit([](const auto& r) -> AnyPose { return r.home; }, robot.model);
}
int leg_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.leg_count(); }, robot.model);
}
int input_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.total.input; }, robot.model);
}
int coordinate_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.total.coordinate; }, robot.model);
}
int row_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.total.row; }, robot.model);
}
int dof(const AnyRobot& robot) {
  return std::visit([]<class LegT>(const ParallelRobot<LegT>&) { return LegT::Space::dof; }, robot.model);
}

bool has_redundant_leg(const AnyRobot& robot) {
  bool found = false;
  std::visit(
      [&](const auto& r) {
        r.for_each_leg([&]<class L>(const L&, const LegPlace&, int) { found = found || L::is_redundant; });
      },
      robot.model);
  return found;
}

std::vector<InputOfLeg> inputs_of(const AnyRobot& robot) {
  std::vector<InputOfLeg> inputs;
  std::visit(
      [&](const auto& r) {
        r.for_each_leg([&]<class L>(const L&, const LegPlace& place, int i) {
          if (place.is_tied) return;
          for (const InputKind& kind : L::Drive::input_kinds) inputs.push_back({i, kind});
        });
      },
      robot.model);
  return inputs;
}

Workspace::Workspace(const AnyRobot& robot) {
  const auto legs_ = static_cast<std::size_t>(leg_count(robot));
  const auto rows_ = static_cast<std::size_t>(row_count(robot));
  const auto inputs_ = static_cast<std::size_t>(input_count(robot));
  const auto dof_ = static_cast<std::size_t>(sinew::dof(robot));
  coordinates.resize(static_cast<std::size_t>(coordinate_count(robot)));
  inputs.resize(inputs_);
  J.resize(rows_ * dof_);
  K.resize(rows_ * inputs_);
  U.resize(dof_ * inputs_);
  s.resize(rows_);
  unit_J.resize(rows_ * dof_);
  unit_K.resize(rows_ * inputs_);
  rates.resize(inputs_);
  solutions.resize(inputs_ * max_solutions);
  solution_count.resize(legs_);
  type_1.resize(legs_);
  legs.resize(legs_);
}

}  // namespace sinew::inline v0
