/// @file arms.hpp
/// What questions to arms, and to platforms on arms, have in common: what is read of them, and what is told.
#pragma once
#include "io/document/reader.hpp"
#include "io/measured/measurement.hpp"
#include "math/plane_axes.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "sinew/kinematics/arm.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

/// @name What an arm and a platform on arms are asked by
/// @{
template <class Arms>
struct ArmTypes;
template <>
struct ArmTypes<Arm> {
  using Workspace = ArmWorkspace;
  using Load = ArmLoad;
  using State = ArmState;
  using Start = std::vector<std::array<double, 3>>;  ///< curvatures; empty: none
  using Growth = ArmLoadPath;
  using Measurement = ArmMeasurement;
  using Sensed = ArmSensed;
  using Step = ArmStep;
  using Point = ArmPathPoint;
  static constexpr auto& inverse = arm_inverse;
  static constexpr int usual_iterations = ArmOptions{}.max_iterations;
  static const Arm& of(const Robot& robot) { return *robot.arm(); }
  static ArmWorkspace& of(const sinew::Workspace& work) { return *work.arm; }
};
template <>
struct ArmTypes<ArmLegs> {
  using Workspace = ArmLegsWorkspace;
  using Load = ArmLegsLoad;
  using State = ArmLegsState;
  using Start = std::optional<ArmLegsStart>;
  using Growth = ArmLegsLoadPath;
  using Measurement = ArmLegsMeasurement;
  using Sensed = ArmLegsSensed;
  using Step = ArmLegsStep;
  using Point = ArmLegsState;
  static constexpr auto& inverse = arm_legs_inverse;
  static constexpr int usual_iterations = 2000;  ///< of all steps in which inputs and loads grow
  static const ArmLegs& of(const Robot& robot) { return *robot.arm_legs(); }
  static ArmLegsWorkspace& of(const sinew::Workspace& work) { return *work.arm_legs; }
};
/// @}

/// A query put to one of them.
template <class Arms>
struct ArmContextOf : Question {
  const Arms& robot;
  typename ArmTypes<Arms>::Workspace& work;
  explicit ArmContextOf(Context& context)
      : Question(context),
        robot(ArmTypes<Arms>::of(context.robot)),
        work(ArmTypes<Arms>::of(context.work)) {
    work.stop = context.work.stop;
  }
};
using ArmContext = ArmContextOf<Arm>;
using ArmLegsContext = ArmContextOf<ArmLegs>;

/// @name Numbers of a robot in space, or of one in the plane those that it has
/// @{
inline bool is_planar(const Arm&) { return false; }
inline bool is_planar(const ArmLegs& robot) { return robot.is_planar; }
inline std::span<const std::size_t> freedoms_of(bool is_planar) {
  static constexpr std::array<std::size_t, 6> all{0, 1, 2, 3, 4, 5};
  return is_planar ? std::span<const std::size_t>(plane_axes) : std::span<const std::size_t>(all);
}
AnyPose pose_of(bool is_planar, const SE3<double>& pose);
SE3<double> read_pose_of(bool is_planar, Reader pose);
std::array<double, 3> read_position_of(bool is_planar, const Reader& position);
std::array<double, 6> read_wrench_of(bool is_planar, const Reader& list);
Value wrench_value(bool is_planar, const std::array<double, 6>& wrench);
/// @param by_rows, by_columns whether rows, or columns, are six of the freedoms, or of a wrench
Value matrix_value(bool is_planar, const double* numbers, std::size_t rows, std::size_t columns, bool by_rows,
                   bool by_columns);
/// @}

/// How many tendons end at each section; sections of leg 0 first.
std::vector<std::size_t> tendon_counts(const ArmLegs& robot);
/// Numbers of all tendons as a list a section.
template <class Arms>
Value by_end_section(const Arms& robot, std::span<const double> values) {
  Value list = Value::list();
  std::size_t first = 0;
  for (const std::size_t count : tendon_counts(robot)) {
    list.push_back(Value(values.subspan(first, count)));
    first += count;
  }
  return list;
}

/// What a tendon may be held at [N, m]: of questions, and of rows, which put other numbers in their place.
constexpr Range range_of(TendonHeld held) {
  return held == TendonHeld::tension ? Range::between(0, 1e9) : Range::place();
}
/// `tensions` and `changes` of a question, or of a point of a path: each tendon is held by one of them. What
/// neither names is loose where changes are not given, else as long as at rest.
/// @param counts of tendons by section
std::vector<TendonCommand> read_arm_commands(const std::vector<std::size_t>& counts, Reader& place);
/// Of every tendon how fast what holds it changes [N/s] or [m/s]: those of each section, 0 where none is
/// given.
std::vector<double> read_arm_motions(const Arm& arm, const Reader& list);
/// Loads of a question, or of a point of a path.
/// @param load what holds where they are not given
template <class Arms>
typename ArmTypes<Arms>::Load read_arm_load(const Arms& robot, Reader& place,
                                            typename ArmTypes<Arms>::Load load = {});
/// `model`, `order`, `elements`, `accuracy` and the bound on iterations.
/// @param usual_iterations that bound where none is asked for
ArmOptions read_arm_options(Question& context, int usual_iterations);
/// `start`: `last`, where the workspace is.
void read_arm_start(Question& context, ArmOptions& options);
/// The mean curvatures of equal parts of a backbone, at which a search may begin.
std::vector<std::array<double, 3>> read_curvatures(const Reader& list, std::string_view whose);
/// `pose`, or `position` and `direction`, of a tip or a platform.
ArmTarget read_arm_target(Question& context, bool is_planar);

/// @name In files of their own
/// @{
template <class Arms>
void answer_arms_track(Context& context);
template <class Arms>
void answer_arms_describe(Context& context);
void answer_arms_identify(Context& context);
/// @}

/// Where the tip, or the platform, is, and what tendons do: of an answer, a row of a path, a solution.
/// @{
void put_arm_numbers(Value& answer, const Arm& arm, const ArmState& state);
void put_arm_numbers(Value& answer, const ArmLegs& robot, const ArmLegsState& state);
/// @}
/// All that is told of an equilibrium always, or of the best iterate.
/// @param report of the question
template <class Arms>
void put_arm_state(ArmContextOf<Arms>& context, const typename ArmTypes<Arms>::State& state,
                   const Report& report);
/// What is wanted of the equilibrium in the workspace.
template <class Arms>
void put_arm_wants(ArmContextOf<Arms>& context, const typename ArmTypes<Arms>::State& state, Wants words,
                   int samples);
/// `backbones`, `tendons` and the rest of a shape, of the equilibrium in the workspace.
/// @{
void put_arm_shape(ArmContext& context, const ArmState& state, int samples);
void put_arm_shape(ArmLegsContext& context, const ArmLegsState& state, int samples);
/// @}
/// Whether friction is known of any of its tendons.
bool has_friction(const Arm& arm);
bool has_friction(const ArmLegs& robot);
/// What is said then of equilibria.
constexpr std::string_view without_friction(const Arm&) {
  return "its tendons are taken as if they did not rub; track follows a path with their friction";
}
constexpr std::string_view without_friction(const ArmLegs&) {
  return "tendons are taken as if they did not rub";
}

}  // namespace sinew::inline v1
