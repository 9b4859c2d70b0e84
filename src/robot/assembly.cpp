#include "sinew/robot/assembly.hpp"

#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "robot/arguments.hpp"
#include "robot/limbs/kinematic_group.hpp"
#include "robot/pose.hpp"
#include "robot/rods/rod_work.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/serial.hpp"
#include "solve/message.hpp"
#include "tendon/input_kind.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Report wrong_count(std::size_t found, std::size_t needed) {
  Report report;
  report.status = Status::bad_input;
  report.message.append("the robot has ");
  append_number(report.message, static_cast<int>(needed));
  report.message.append(" inputs, ");
  append_number(report.message, static_cast<int>(found));
  report.message.append(" were given");
  return report;
}

/// Balance of the platform on rods: J its stiffness, K what feeding them does to the wrench, s what is
/// missing. Never inlined: what it keeps on the stack would slow J and K of legs that close.
[[gnu::noinline]] Reduced assemble_rods(const SpatialPose& pose, Numbers coordinates, Workspace& work) {
  RodGroup& system = *work.rods->system;
  system.set_platform(SE3<double>::from(pose));
  system.set_rods(coordinates);
  work.rods->is_solved = false;
  work.rods->signs.reset();
  system.evaluate();
  system.linearise();
  const int inputs = system.inputs();
  std::copy_n(system.stiffness().data(), 36, work.J.begin());
  const Vec<double, 6> missing = system.wrench_residual();
  std::copy(missing.begin(), missing.end(), work.s.begin());
  for (int j = 0; j < inputs; ++j) {
    const Vec<double, 6> feed = system.input_wrench_jacobian(j);
    for (int i = 0; i < 6; ++i) work.K[at(i * inputs + j)] = -feed[i];
  }
  return {MatrixView(work.J.data(), 6, 6), MatrixView(work.K.data(), 6, inputs), work.s, system.limb_error(),
          0};
}

}  // namespace

Reduced assemble(const Robot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  if (!check_arguments(robot, pose, coordinates, work).ok() || robot.model() == Model::prb)
    return {MatrixView(nullptr, 0, dof(robot)), MatrixView(nullptr, 0, input_count(robot)), {}, infinity, 0};
  if (bears_load(robot)) {
    const SpatialPose& place = std::get<SpatialPose>(pose);
    return assemble_rods(place, coordinates, work);
  }
  return with_legs(robot, [&]<class Any>(const ParallelRobot<Any>& legs) {
    using Space = typename Any::Space;
    const auto closure_error = KinematicGroup(legs).evaluate(Space::frame(in_space<Space>(pose)), coordinates,
                                                             {work.J, work.K, work.s});
    return Reduced{MatrixView(work.J.data(), legs.total.row, Space::dof),
                   MatrixView(work.K.data(), legs.total.row, legs.total.input), work.s,
                   closure_error.distance, closure_error.leg};
  });
}

MatrixView homogenise(const Robot& robot, const Reduced& reduced, Workspace& work) {
  const Eigen::Index dimension = robot.planar() ? Planar::dimension : Spatial::dimension;
  const double radius = platform_radius(robot);
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

Report coordinates_from_inputs(const Robot& robot, Numbers inputs, Workspace& work) {
  if (Report report = check_workspace(robot, work); !report.ok()) return report;
  if (bears_load(robot)) {
    Report report;
    report.status = Status::unsupported;
    report.message.append("the legs bear load: inputs alone do not shape them, an equilibrium does");
    return report;
  }
  if (inputs.size() != work.inputs.size()) return wrong_count(inputs.size(), work.inputs.size());
  const Report report = with_legs(robot, [&]<class Any>(const ParallelRobot<Any>& legs) {
    return KinematicGroup(legs).to_coordinates(inputs, work.coordinates);
  });
  if (report.ok()) std::ranges::copy(inputs, work.inputs.begin());
  return report;
}

std::span<const LegState> leg_states(const Robot& robot, const AnyPose& pose, Numbers coordinates,
                                     Workspace& work) {
  if (!check_arguments(robot, pose, coordinates, work).ok() || robot.model() == Model::prb) return {};
  with_legs(robot, [&]<class LegT>(const ParallelRobot<LegT>& r) {
    using Space = typename LegT::Space;
    const auto platform = Space::frame(in_space<Space>(pose));
    r.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int i) {
      work.legs[static_cast<std::size_t>(i)] = leg.state(platform, own_coordinates(leg, place, coordinates));
    });
  });
  return work.legs;
}

AnyPose home(const Robot& robot) {
  return with_legs(robot, [](const auto& r) -> AnyPose { return r.home; });
}
double platform_radius(const Robot& robot) {
  return with_legs(robot, [](const auto& r) { return r.platform_radius; });
}
int leg_count(const Robot& robot) {
  return with_legs(robot, [](const auto& r) { return r.leg_count(); });
}
int dof(const Robot& robot) { return robot.planar() ? Planar::dof : Spatial::dof; }

namespace {

const LegPlace& total(const Robot& robot) {
  return with_legs(robot, [](const auto& r) -> const LegPlace& { return r.total; });
}

/// Whether `is` holds of a leg.
template <class Is>
bool any_leg(const Robot& robot, const Is& is) {
  bool found = false;
  with_legs(robot, [&](const auto& r) {
    r.for_each_leg([&](const auto& leg, const LegPlace&, int) { found = found || is(leg); });
  });
  return found;
}

}  // namespace

int input_count(const Robot& robot) { return total(robot).input; }
bool has_ties(const Robot& robot) { return total(robot).is_tied; }
int coordinate_count(const Robot& robot) { return total(robot).coordinate; }
int row_count(const Robot& robot) { return has_rods(robot) ? Spatial::dof : total(robot).row; }
int plane_count(const Robot& robot) { return total(robot).plane; }

bool has_redundant_leg(const Robot& robot) {
  return any_leg(robot, []<class L>(const L&) { return L::is_redundant; });
}
bool has_elbow(const Robot& robot) {
  return any_leg(robot, []<class L>(const L&) { return L::has_elbow; });
}
bool has_arc(const Robot& robot) {
  return any_leg(robot, []<class L>(const L&) { return HasArc<typename L::Link>; });
}

std::vector<InputOfLeg> inputs_of(const Robot& robot) {
  std::vector<InputOfLeg> inputs;
  with_legs(robot, [&](const auto& r) {
    r.for_each_leg([&]<class L>(const L&, const LegPlace& place, int i) {
      if (place.is_tied) return;
      for (const InputKind& kind : L::Drive::input_kinds) inputs.push_back({i, kind.name, kind.dimension});
    });
  });
  return inputs;
}

Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

Workspace::Workspace(const Robot& any) : robot(any.shared()) {
  if (!any.is_within_limits()) return;  // no question gets as far as to use it
  const auto legs_ = static_cast<std::size_t>(leg_count(any));
  const auto rows_ = static_cast<std::size_t>(row_count(any));
  const auto inputs_ = static_cast<std::size_t>(input_count(any));
  const auto dof_ = static_cast<std::size_t>(sinew::dof(any));
  if (has_rods(any)) rods = std::make_unique<RodWork>(rod_group(any));
  if (any.serial()) serial = std::make_unique<SerialWorkspace>(*any.serial());
  if (any.arm()) arm = std::make_unique<ArmWorkspace>(*any.arm());
  if (any.arm_legs()) arm_legs = std::make_unique<ArmLegsWorkspace>(*any.arm_legs());
  if (any.model() == Model::prb) arcs = std::make_unique<Workspace>(*any.as(Model::cc));
  coordinates.resize(static_cast<std::size_t>(coordinate_count(any)));
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

}  // namespace sinew::inline v1
