/// @file arms.hpp
/// What the handlers of questions to arms share.
#pragma once
#include "io/reader.hpp"
#include "query/context.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// A query put to an arm.
struct ArmContext : Question {
  const Arm& robot;
  ArmWorkspace& work;
  explicit ArmContext(Context& context)
      : Question(context),
        robot(*context.robot.arm()),
        work(*context.work.arm) {
    work.stop = context.work.stop;
  }
};

/// `tensions` and `changes` of a question, or of a point of a path: each tendon is held by one of them. What
/// neither names is loose where changes are not given, else as long as at rest.
std::vector<TendonCommand> read_arm_commands(const Arm& arm, Reader& place);
/// The same where a section has as many tendons as `counts` says: of a platform, sections of leg 0 first.
std::vector<TendonCommand> read_arm_commands(const std::vector<std::size_t>& counts, Reader& place);
/// How many tendons end at each section.
std::vector<std::size_t> tendons_by_section(const Arm& arm);
/// Loads of a question, or of a point of a path.
/// @param load what holds where they are not given
ArmLoad read_arm_load(const Arm& arm, Reader& place, ArmLoad load = {});
/// `model`, `order`, `elements`, `accuracy` and the bound on iterations.
ArmOptions read_arm_options(Question& context);
/// `start`: `last`, where the workspace is.
void read_arm_start(ArmContext& context, ArmOptions& options);

/// Numbers of all tendons as a list a section.
Value by_end_section(const Arm& arm, std::span<const double> values);
Value by_end_section(const std::vector<std::size_t>& counts, std::span<const double> values);
/// `places`, `backbones`, `tendons` and the rest of a shape, of the equilibrium in the workspace.
void put_arm_shape(ArmContext& context, int samples);
/// Whether friction is known of any of its tendons.
bool has_friction(const Arm& arm);

}  // namespace sinew::inline v1
