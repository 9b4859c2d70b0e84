/// Handlers of queries to platforms on arms: forward, velocity, shape, describe.
#include <algorithm>
#include <array>

#include "io/read_pose.hpp"
#include "query/arms/arms.hpp"
#include "query/batch/sampler.hpp"
#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {
namespace {

/// Tendons that end at each section, sections of leg 0 first.
std::vector<std::size_t> tendon_counts_of(const ArmLegs& robot) {
  std::vector<std::size_t> counts;
  for (const ArmLeg& leg : robot.legs) {
    const auto own = tendons_by_section(leg.arm);
    counts.insert(counts.end(), own.begin(), own.end());
  }
  return counts;
}

constexpr std::string_view not_yet = "is not available of legs of sections in this version; leave it out";
constexpr Lack lacking[] = {
    {"following", not_yet}, {"distributed", not_yet}, {"distributed_following", not_yet},
    {"loads", not_yet},     {"all", not_yet},         {"start", not_yet},
    {"balance", not_yet}};

void put_legs_shape(Context& context, const ArmLegs& robot, int samples) {
  ArmPicture picture;
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    double around = 0;  // where a disc's size is not known: its tendons run within it
    for (const ArmTendon& tendon : robot.legs[k].arm.tendons)
      for (const TendonRoute& route : tendon.routes)
        around = std::max({around, 1.15 * route.start_radius, 1.15 * route.end_radius});
    picture.add(robot.legs[k].arm, arm_legs_shape(*context.work.arm_legs, k), samples, around);
  }
  Value& answer = context.answer;
  answer["backbones"] = std::move(picture.backbones);
  answer["curvatures"] = std::move(picture.curvatures);
  answer["tendons"] = std::move(picture.tendons);
  answer["discs"] = std::move(picture.discs);
}

void put_legs_state(Context& context, const ArmLegs& robot, const ArmLegsState& state) {
  context.report(state.report);
  if (std::ranges::any_of(robot.legs, [](const ArmLeg& leg) { return has_friction(leg.arm); }))
    context.add_message("tendons are taken as if they did not rub");
  if (state.report.status == Status::bad_input || state.report.status == Status::unsupported) return;
  const auto counts = tendon_counts_of(robot);
  Value& answer = context.answer;
  answer["pose"] = pose_value(AnyPose(spatial_pose(state.platform)));
  Value legs = Value::list();
  for (const auto& load : state.tip_loads)
    legs.push_back({{"force", {load[0], load[1], load[2]}}, {"moment", {load[3], load[4], load[5]}}});
  answer["legs"] = std::move(legs);
  answer["tensions"] = by_end_section(counts, state.tensions);
  answer["changes"] = by_end_section(counts, state.changes);
  answer["slack"] = by_end_section(counts, state.slack);
  answer["stable"] = state.stable;
  answer["reached"] = state.reached;
  put_number(answer, "potential", state.energy);
  put_number(answer, "residual", state.report.residual);
  answer["iterations"] = state.report.iterations;
  if (state.resolution > 0) answer["resolution"] = state.resolution;
}

struct ArmLegsForward {
  ArmOptions options;
  std::vector<TendonCommand> commands;
  ArmLegsLoad load;
  std::optional<Until<Spatial>> until;
  Wants wanted;
  int samples = 0;
};

ArmLegsForward read_legs(Context& context) {
  ArmLegsForward asked;
  asked.options = read_arm_options(context);
  if (!context.max_iterations)
    asked.options.max_iterations = 2000;  // of all steps in which inputs and loads grow
  asked.commands = read_arm_commands(tendon_counts_of(*context.robot.arm_legs()), context.query);
  if (const auto wrench = context.query.optional("wrench")) {
    const auto numbers = read_wrench<Spatial>(*wrench);
    std::copy(numbers.begin(), numbers.end(), asked.load.wrench.begin());
  }
  if (const auto gravity = context.query.optional("gravity")) {
    const Vec3<double> g = read_gravity(*gravity);
    asked.load.gravity = {g[0], g[1], g[2]};
  }
  if (context.ask == Ask::forward) asked.until = read_until<Spatial>(context);
  asked.wanted = read_wants(context);
  asked.samples = read_samples(context, asked.wanted, 60, 2000);
  return asked;
}

void answer_legs(Context& context, const ArmLegsForward& asked) {
  const auto& [options, commands, load, until, wanted, samples] = asked;
  const ArmLegs& robot = *context.robot.arm_legs();
  ArmLegsWorkspace& work = *context.work.arm_legs;
  work.stop = context.work.stop;
  const ArmLegsState& state = arm_legs_forward(robot, commands, load, options, work);
  if (until && state.report.ok()) {
    std::array<double, 6> direction{};
    std::copy(until->direction.begin(), until->direction.end(), direction.begin());
    const ArmLegsLoadPath path = arm_legs_follow_load(robot, direction, until->limit, work);
    put_legs_state(context, robot, path.state);
    put_growth(context.answer, path);
    if (path.end == LoadEnd::stopped) context.answer["status"] = to_string(Status::stopped);
  } else {
    put_legs_state(context, robot, state);
  }
  if (!state.report.is_solved()) return;
  if (wanted.has(Want::shape)) put_legs_shape(context, robot, samples);
  if (!wanted.has(Want::velocity) && !wanted.has(Want::stiffness)) return;
  const ArmLegsRates rates = arm_legs_rates(robot, work);
  if (!rates.regular) {
    context.add_message(
        "the platform has no rates: its stiffness is singular, or not finite, as of straight legs that do "
        "not "
        "stretch");
    return;
  }
  const auto count = static_cast<Eigen::Index>(robot.tendons());
  if (wanted.has(Want::velocity)) context.answer["U"] = Value(MatrixView(rates.J.data(), 6, count));
  if (wanted.has(Want::stiffness))
    context.answer["stiffness"] = Value(MatrixView(rates.stiffness.data(), 6, 6));
}

void describe_arm_legs(Context& context) {
  const ArmLegs& robot = *context.robot.arm_legs();
  Value inputs = Value::list(), legs = Value::list();
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    const std::string path = joined(joined("legs", k), "link");
    std::vector<std::size_t> counts(leg.arm.sections.size());
    for (const ArmTendon& tendon : leg.arm.tendons) {
      const auto section = static_cast<std::size_t>(tendon.section());
      inputs.push_back(
          {{"name", joined(joined(joined(joined(path, "sections"), section), "tendons"), counts[section]++)},
           {"unit", "m"}});
    }
    Value sections = Value::list();
    for (std::size_t m = 0; m < leg.arm.sections.size(); ++m)
      sections.push_back({{"type", "elastic"},
                          {"length", leg.arm.sections[m].length},
                          {"discs", leg.arm.sections[m].discs.count},
                          {"tendons", counts[m]}});
    legs.push_back({{"base",
                     {{"point", Value(leg.base.p)},
                      {"direction", Value(leg.base.rotate(Vec3<double>(0, 0, 1)))},
                      {"section_x", Value(leg.base.rotate(Vec3<double>(1, 0, 0)))}}},
                    {"link", {{"type", "elastic"}, {"length", leg.arm.length()}, {"sections", sections}}},
                    {"closure", {{"type", leg.is_clamped ? "clamp" : "ball"}}},
                    {"platform_point", Value(leg.platform_point)}});
  }
  Value& answer = context.answer;
  answer["status"] = "converged";
  answer["kind"] = "arm_legs";
  answer["space"] = "spatial";
  answer["inputs"] = std::move(inputs);
  answer["home"] = pose_value(AnyPose(robot.home));
  answer["platform"] = {{"mass", robot.platform_mass}};
  answer["gravity"] = robot.gravity;
  answer["legs"] = std::move(legs);
  answer["models"] = Value::list({"rod", "subsegment_rod", "subsegment_cc", "cc", "prb"});
  answer["model"] = "subsegment_rod";
  answer["geometry"] = robot.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace

constexpr Handlers arm_legs_handlers{.robots = "legs of sections",
                                     .wants = {Want::pose, Want::legs, Want::velocity, Want::shape,
                                               Want::stiffness, Want::stability},  // that is told always
                                     .forward = handle<read_legs, answer_legs>,
                                     .velocity = handle<read_legs, answer_legs>,
                                     .shape = handle<read_legs, answer_legs>,
                                     .describe = tell<describe_arm_legs>,
                                     .lacks = lacking};

}  // namespace sinew::inline v1
