#include "sinew/robot/assembly.hpp"

#include <cmath>
#include <limits>

#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "robot/rod_work.hpp"

namespace sinew::inline v0 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t cell(int row, int column, int columns) {
  return static_cast<std::size_t>(row * columns + column);
}

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
    const int row = i < LegT::driven_rows ? place.row + i : place.plane;
    for (int j = 0; j < dof; ++j) work.J[cell(row, j, dof)] = blocks.g_x(i, j);
    for (int j = 0; j < LegT::inputs; ++j) work.K[cell(row, place.input + j, inputs)] = -g_a(i, j);
    work.s[cell(row, 0, 1)] = -blocks.g[i];
  }
  const double misfit = LegT::misfit(blocks);
  return std::isfinite(misfit) ? misfit : infinity;
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
  report.status = Status::bad_input;
  report.message.append("the robot has ");
  append_number(report.message, static_cast<int>(needed));
  report.message.append(" inputs, ");
  append_number(report.message, static_cast<int>(found));
  report.message.append(" were given");
  return report;
}

Report beyond_domain(int input, std::string_view what) {
  Report report;
  report.status = Status::left_domain;
  report.message.append("inputs[");
  append_number(report.message, input);
  report.message.append("] ");
  report.message.append(what);
  return report;
}

template <class LegT>
Report command_robot(const ParallelRobot<LegT>& robot, Numbers inputs, Workspace& work) {
  if (inputs.size() != work.inputs.size()) return wrong_count(inputs.size(), work.inputs.size());
  Report report;
  robot.for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
    const auto q = leg.coordinates_of(inputs.subspan(static_cast<std::size_t>(place.input), L::inputs));
    std::copy(q.begin(), q.end(), work.coordinates.begin() + place.coordinate);
    if (report.ok() && !leg.in_domain(q))
      report = beyond_domain(place.input + L::inputs - 1, L::Link::beyond_domain);
  });
  if (report.ok()) std::copy(inputs.begin(), inputs.end(), work.inputs.begin());
  return report;
}

/// Balance of the platform on rods: J its stiffness, K what feeding them does to the wrench, s what is
/// missing.
template <class System>
Reduced assemble_rods(const SpatialPose& pose, Numbers coordinates, RodWorkOf<System>& rods,
                      Workspace& work) {
  System& system = rods.system;
  system.set_platform(SE3<double>::from(pose));
  system.set_rods(coordinates);
  rods.is_solved = false;
  system.evaluate();
  system.linearise();
  const int inputs = system.inputs();
  std::copy_n(system.stiffness().data(), 36, work.J.begin());
  const Vec<double, 6> missing = system.missing();
  std::copy(missing.begin(), missing.end(), work.s.begin());
  for (int j = 0; j < inputs; ++j) {
    const Vec<double, 6> feed = system.feed_wrench(j);
    for (int i = 0; i < 6; ++i) work.K[cell(i, j, inputs)] = -feed[i];
  }
  return {MatrixView(work.J.data(), 6, 6), MatrixView(work.K.data(), 6, inputs), work.s, system.rod_error(),
          0};
}

}  // namespace

Reduced assemble(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work) {
  if (!check_arguments(robot, pose, coordinates, work).ok())
    return {MatrixView(nullptr, 0, dof(robot)), MatrixView(nullptr, 0, input_count(robot)), {}, infinity, 0};
  return visit_closing(
      robot, [&](const auto& r) { return assemble_robot(r, pose, coordinates, work); },
      [&] {
        const SpatialPose& place = std::get<SpatialPose>(pose);
        return with_rods(work, [&](auto& rods) { return assemble_rods(place, coordinates, rods, work); });
      });
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
  if (Report report = check_workspace(robot, work); !report.ok()) return report;
  return visit_closing(
      robot, [&](const auto& r) { return command_robot(r, inputs, work); },
      [&] {
        Report report;
        report.status = Status::left_domain;
        report.message.append("the legs bear load: inputs alone do not shape them, an equilibrium does");
        return report;
      });
}

std::span<const LegState> leg_states(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates,
                                     Workspace& work) {
  if (!check_arguments(robot, pose, coordinates, work).ok()) return {};
  visit_closing(
      robot,
      [&]<class LegT>(const ParallelRobot<LegT>& r) {
        using Space = typename LegT::Space;
        const auto platform = Space::frame(in_space<Space>(pose));
        r.for_each_leg([&](const auto& leg, const LegPlace& place, int i) {
          work.legs[static_cast<std::size_t>(i)] =
              leg.state(platform, own_coordinates(leg, place, coordinates));
        });
      },
      [&] {  // of rods there is none; see RodReading
        for (const ClosingLeg& one : closing_legs_of(robot))
          with_leg(one.leg, [&](const auto& leg) {
            work.legs[static_cast<std::size_t>(one.index)] = leg.state(
                SE3<double>::from(std::get<SpatialPose>(pose)), own_coordinates(leg, one.place, coordinates));
          });
      });
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
bool has_ties(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.has_ties(); }, robot.model);
}
int coordinate_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.total.coordinate; }, robot.model);
}
int row_count(const AnyRobot& robot) {
  return visit_closing(
      robot, [](const auto& r) { return r.total.row; }, [] { return Spatial::dof; });
}
int dof(const AnyRobot& robot) {
  return std::visit([]<class LegT>(const ParallelRobot<LegT>&) { return LegT::Space::dof; }, robot.model);
}

namespace {

/// Whether `is` holds of a leg.
template <class Is>
bool any_leg(const AnyRobot& robot, const Is& is) {
  bool found = false;
  std::visit(
      [&](const auto& r) {
        r.for_each_leg([&](const auto& leg, const LegPlace&, int) { found = found || is(leg); });
      },
      robot.model);
  return found;
}

}  // namespace

bool has_redundant_leg(const AnyRobot& robot) {
  return any_leg(robot, []<class L>(const L&) { return L::is_redundant; });
}
bool has_elbow(const AnyRobot& robot) {
  return any_leg(robot, []<class L>(const L&) { return L::has_elbow; });
}
bool has_arc(const AnyRobot& robot) {
  return any_leg(robot, []<class L>(const L&) { return HasArc<typename L::Link>; });
}
int plane_count(const AnyRobot& robot) {
  return std::visit([](const auto& r) { return r.total.plane; }, robot.model);
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

Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

Workspace::Workspace(const AnyRobot& any) : robot(any.identity) {
  const auto legs_ = static_cast<std::size_t>(leg_count(any));
  const auto rows_ = static_cast<std::size_t>(row_count(any));
  const auto inputs_ = static_cast<std::size_t>(input_count(any));
  const auto dof_ = static_cast<std::size_t>(sinew::dof(any));
  if (bears_load(any)) rods = std::make_unique<RodWorks>(any);
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

}  // namespace sinew::inline v0
