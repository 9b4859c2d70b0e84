/// @file arms.hpp
/// What the handlers of questions to arms share.
#pragma once
#include "io/reader.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// A query put to an arm.
struct ArmContext : Question {
  const Arm& robot;
  ArmWorkspace& work;
  std::vector<std::array<double, 3>> curvatures = {};  ///< of `start` [rad/m]
  explicit ArmContext(Context& context)
      : Question(context),
        robot(*context.robot.arm()),
        work(*context.work.arm) {
    work.stop = context.work.stop;
  }
};

/// What a tendon may be held at [N, m]: of questions, and of rows, which put other numbers in their place.
constexpr Range range_of(TendonHeld held) {
  return held == TendonHeld::tension ? Range::between(0, 1e9) : Range::place();
}
/// `tensions` and `changes` of a question, or of a point of a path: each tendon is held by one of them. What
/// neither names is loose where changes are not given, else as long as at rest.
std::vector<TendonCommand> read_arm_commands(const Arm& arm, Reader& place);
/// The same where a section has as many tendons as `counts` says: of a platform, sections of leg 0 first.
std::vector<TendonCommand> read_arm_commands(const std::vector<std::size_t>& counts, Reader& place);
/// Of every tendon how fast what holds it changes [N/s] or [m/s]: those of each section, 0 where none is
/// given.
std::vector<double> read_arm_motions(const Arm& arm, const Reader& list);
/// How many tendons end at each section.
std::vector<std::size_t> tendons_by_section(const Arm& arm);
/// Loads of a question, or of a point of a path.
/// @param load what holds where they are not given
ArmLoad read_arm_load(const Arm& arm, Reader& place, ArmLoad load = {});
/// `distributed`, or `distributed_following`: a force along a backbone [N/m].
std::array<double, 3> read_along(const Reader& along);
/// Where a load acts on a backbone of this length [m].
double read_place_along(Reader& load, double length);
/// `model`, `order`, `elements`, `accuracy` and the bound on iterations.
ArmOptions read_arm_options(Question& context);
/// `start`: `last`, where the workspace is.
/// @param shape of questions where it may be a shape, too: mean curvatures of equal parts, which stay there
void read_arm_start(Question& context, ArmOptions& options,
                    std::vector<std::array<double, 3>>* shape = nullptr);
/// `pose`, or `position` and `direction`, of a tip or a platform.
ArmTarget read_arm_target(Question& context);

struct ArmWanted {
  Wants words;
  int samples = 0;  ///< of `shape`
};

/// A question of an equilibrium under what holds the tendons.
struct ArmForward {
  ArmOptions options;
  std::vector<TendonCommand> commands;
  ArmLoad load;
  std::optional<Until<Spatial>> until;
  bool wants_all = false;
  ArmWanted wanted;
};
ArmForward read_arm_forward(ArmContext& context);

/// `steps` to each point of a path, whose `list` has so many.
int read_path_steps(Reader& query, const Reader& list, std::size_t points);

/// @name In files of their own
/// @{
void answer_arms_track(Context& context);
void answer_arms_identify(Context& context);
void answer_arm_describe(Context& context);
/// @}

/// @name As `describe` has them
/// @{
Value section_value(const ArmSection& section);
Value tendon_value(const ArmTendon& tendon);
/// @}

/// Numbers of all tendons as a list a section.
Value by_end_section(const Arm& arm, std::span<const double> values);
Value by_end_section(const std::vector<std::size_t>& counts, std::span<const double> values);
/// Lines and discs of arms, as shapes answer them.
struct ArmPicture {
  Value backbones = Value::list(), curvatures = Value::list(), tendons = Value::list(), discs = Value::list();
  /// In the plane of x and y: points of two numbers, the curvature that turns to the right; no discs.
  bool is_planar = false;

  /// @param unknown_radius of discs of which it is not known [m]
  void add(const Arm& arm, const ArmWorkspace& work, int samples, double unknown_radius);
};
/// `places`, `backbones`, `tendons` and the rest of a shape, of the equilibrium in the workspace.
void put_arm_shape(ArmContext& context, int samples);
/// Whether friction is known of any of its tendons.
bool has_friction(const Arm& arm);

}  // namespace sinew::inline v1
