/// Handlers of queries to platforms on arms: forward, velocity, shape, describe.
#include <algorithm>
#include <array>

#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "query/arms.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {
namespace {

constexpr Wants arm_legs_wants{Want::pose,  Want::legs,      Want::velocity,
                               Want::shape, Want::stiffness, Want::stability};  // that is told always

/// Tendons that end at each section, sections of leg 0 first.
std::vector<std::size_t> tendon_counts_of(const ArmLegs& robot) {
  std::vector<std::size_t> counts;
  for (const ArmLeg& leg : robot.legs) {
    const auto own = tendons_by_section(leg.arm);
    counts.insert(counts.end(), own.begin(), own.end());
  }
  return counts;
}

/// What arms alone answer.
void refuse_of_legs(Reader& query) {
  for (const char* key :
       {"following", "distributed", "distributed_following", "loads", "all", "start", "balance"})
    if (const auto asked = query.optional(key))
      asked->fail("not_available", "is not available of legs of sections in this version; leave it out");
}

void put_points(std::vector<double>& numbers, const Vec3<double>& point) {
  numbers.insert(numbers.end(), point.begin(), point.end());
}

void put_legs_shape(Context& context, const ArmLegs& robot, int samples) {
  Value backbones = Value::list(), curvatures = Value::list(), tendons = Value::list(), discs = Value::list();
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const Arm& arm = robot.legs[k].arm;
    const ArmWorkspace& work = arm_legs_shape(*context.work.arm_legs, k);
    std::vector<double> places, backbone, curvature;
    for (int i = 0; i < samples; ++i) places.push_back(arm.length() * i / (samples - 1));
    for (const SE3<double>& frame : arm_frames(arm, places, work)) put_points(backbone, frame.p);
    for (const auto& strain : arm_strains(arm, places, work))
      curvature.insert(curvature.end(), strain.begin() + 3, strain.end());
    backbones.push_back(Value(backbone, 3));
    curvatures.push_back(Value(curvature, 3));
    const auto lines = arm_tendon_lines(arm, work);
    std::size_t next = 0;
    for (const std::size_t count : tendons_by_section(arm)) {
      Value of_section = Value::list();
      for (std::size_t i = 0; i < count; ++i, ++next) {
        std::vector<double> numbers;
        for (const Vec3<double>& point : lines[next]) put_points(numbers, point);
        of_section.push_back(Value(numbers, 3));
      }
      tendons.push_back(std::move(of_section));
    }
    double from = 0, around = 0;  // where a disc's size is not known: its tendons run within it
    for (const ArmTendon& tendon : arm.tendons)
      for (const TendonRoute& route : tendon.routes)
        around = std::max({around, 1.15 * route.start_radius, 1.15 * route.end_radius});
    for (const ArmSection& section : arm.sections) {
      std::vector<double> at_discs;
      for (int i = 1; i <= section.discs.count; ++i)
        at_discs.push_back(from + section.length * i / section.discs.count);
      for (const SE3<double>& frame : arm_frames(arm, at_discs, work))
        discs.push_back({{"pose", pose_value(AnyPose(spatial_pose(frame)))},
                         {"height", 0.0},
                         {"radius", section.discs.radius > 0 ? section.discs.radius : around}});
      from += section.length;
    }
  }
  Value& answer = context.answer;
  answer["backbones"] = std::move(backbones);
  answer["curvatures"] = std::move(curvatures);
  answer["tendons"] = std::move(tendons);
  answer["discs"] = std::move(discs);
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

void answer_arm_legs(Context& context, Want usual) {
  const ArmLegs& robot = *context.robot.arm_legs();
  refuse_of_legs(context.query);
  ArmOptions options = read_arm_options(context);
  if (!context.max_iterations) options.max_iterations = 2000;  // of all steps in which inputs and loads grow
  const auto commands = read_arm_commands(tendon_counts_of(robot), context.query);
  ArmLegsLoad load;
  if (const auto wrench = context.query.optional("wrench")) {
    const auto numbers = read_wrench<Spatial>(*wrench);
    std::copy(numbers.begin(), numbers.end(), load.wrench.begin());
  }
  if (const auto gravity = context.query.optional("gravity")) {
    const Vec3<double> g = read_gravity(*gravity);
    load.gravity = {g[0], g[1], g[2]};
  }
  std::optional<Until<Spatial>> until;
  if (usual == Want::pose) until = read_until<Spatial>(context);
  const Wants wanted = read_wants(context, {usual}, arm_legs_wants);
  const int samples = read_samples(context, wanted, 60, 2000);
  if (!context.ready()) return;
  ArmLegsWorkspace& work = *context.work.arm_legs;
  work.stop = context.work.stop;
  const ArmLegsState& state = arm_legs_forward(robot, commands, load, options, work);
  if (until && state.report.ok()) {
    std::array<double, 6> direction{};
    std::copy(until->direction.begin(), until->direction.end(), direction.begin());
    const ArmLegsLoadPath path = arm_legs_follow_load(robot, direction, until->limit, work);
    put_legs_state(context, robot, path.state);
    context.answer["load"] = path.load;
    context.answer["why"] = to_string(path.end);
    if (path.definite_until >= 0) context.answer["definite_until"] = path.definite_until;
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

}  // namespace

void answer_arm_legs_forward(Context& context) { answer_arm_legs(context, Want::pose); }
void answer_arm_legs_velocity(Context& context) { answer_arm_legs(context, Want::velocity); }
void answer_arm_legs_shape(Context& context) { answer_arm_legs(context, Want::shape); }

void answer_arm_legs_describe(Context& context) {
  if (!context.ready()) return;
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

}  // namespace sinew::inline v1
