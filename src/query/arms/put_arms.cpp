/// What is told of equilibria of arms and of platforms on arms.
#include <algorithm>
#include <array>
#include <numeric>

#include "math/linalg.hpp"
#include "query/arms/arms.hpp"

namespace sinew::inline v1 {

Value wrench_value(bool is_planar, const std::array<double, 6>& wrench) {
  std::vector<double> numbers;
  for (const std::size_t k : freedoms_of(is_planar)) numbers.push_back(wrench[k]);
  return numbers;
}
Value matrix_value(bool is_planar, const double* numbers, std::size_t rows, std::size_t columns, bool by_rows,
                   bool by_columns) {
  std::vector<std::size_t> of_rows(rows), of_columns(columns);
  std::iota(of_rows.begin(), of_rows.end(), std::size_t{0});
  std::iota(of_columns.begin(), of_columns.end(), std::size_t{0});
  const auto freedoms = freedoms_of(is_planar);
  if (by_rows) of_rows.assign(freedoms.begin(), freedoms.end());
  if (by_columns) of_columns.assign(freedoms.begin(), freedoms.end());
  std::vector<double> kept;
  for (const std::size_t i : of_rows)
    for (const std::size_t j : of_columns) kept.push_back(numbers[i * columns + j]);
  return Value(MatrixView(kept.data(), static_cast<Eigen::Index>(of_rows.size()),
                          static_cast<Eigen::Index>(of_columns.size())));
}

bool has_friction(const Arm& arm) {
  return std::ranges::any_of(arm.tendons, [](const ArmTendon& tendon) { return tendon.friction > 0; });
}
bool has_friction(const ArmLegs& robot) {
  return std::ranges::any_of(robot.legs, [](const ArmLeg& leg) { return has_friction(leg.arm); });
}

namespace {

template <class Arms, class State>
void put_tendons(Value& answer, const Arms& robot, const State& state) {
  answer["tensions"] = by_end_section(robot, state.tensions);
  answer["changes"] = by_end_section(robot, state.changes);
  answer["slack"] = by_end_section(robot, state.slack);
  put_number(answer, "potential", state.energy);
}

}  // namespace

void put_arm_numbers(Value& answer, const Arm& arm, const ArmState& state) {
  answer["tip"] = pose_value(AnyPose(spatial_pose(state.tip)));
  put_tendons(answer, arm, state);
}
void put_arm_numbers(Value& answer, const ArmLegs& robot, const ArmLegsState& state) {
  answer["pose"] = pose_value(pose_of(robot.is_planar, state.platform));
  put_tendons(answer, robot, state);
}

namespace {

std::vector<double> numbers_of(std::span<const Vec3<double>> points, int count) {
  std::vector<double> numbers;
  for (const Vec3<double>& point : points)
    numbers.insert(numbers.end(), point.begin(), point.begin() + count);
  return numbers;
}

std::vector<double> places_along(const Arm& arm, int samples) {
  std::vector<double> places;
  for (int k = 0; k < samples; ++k) places.push_back(arm.length() * k / (samples - 1));
  return places;
}

/// Lines and discs of arms, as shapes answer them.
struct ArmPicture {
  Value backbones = Value::list(), curvatures = Value::list(), tendons = Value::list(), discs = Value::list();
  /// In the plane of x and y: points of two numbers, the curvature that turns to the right; no discs.
  bool is_planar = false;

  /// @param unknown_radius of discs of which it is not known [m]
  void add(const Arm& arm, const ArmWorkspace& work, int samples, double unknown_radius);
};

void ArmPicture::add(const Arm& arm, const ArmWorkspace& work, int samples, double unknown_radius) {
  const std::vector<double> places = places_along(arm, samples);
  const int dimension = is_planar ? 2 : 3;
  std::vector<Vec3<double>> points;
  std::vector<double> curvature;
  for (const SE3<double>& frame : arm_frames(arm, places, work)) points.push_back(frame.p);
  for (const auto& strain : arm_strains(arm, places, work))
    if (is_planar)
      curvature.push_back(strain[4]);
    else
      curvature.insert(curvature.end(), strain.begin() + 3, strain.end());
  backbones.push_back(Value(numbers_of(points, dimension), static_cast<std::size_t>(dimension)));
  curvatures.push_back(is_planar ? Value(curvature) : Value(curvature, 3));
  const auto lines = arm_tendon_lines(arm, work);
  std::size_t next = 0;
  for (const std::size_t count : tendon_counts(arm)) {
    Value of_section = Value::list();
    for (std::size_t i = 0; i < count; ++i, ++next)
      of_section.push_back(Value(numbers_of(lines[next], dimension), static_cast<std::size_t>(dimension)));
    tendons.push_back(std::move(of_section));
  }
  if (is_planar) return;
  double from = 0;
  for (const ArmSection& section : arm.sections) {
    std::vector<double> at_discs;
    for (int k = 1; k <= section.discs.count; ++k)
      at_discs.push_back(from + section.length * k / section.discs.count);
    for (const SE3<double>& frame : arm_frames(arm, at_discs, work))
      discs.push_back({{"pose", pose_value(AnyPose(spatial_pose(frame)))},
                       {"height", 0.0},
                       {"radius", section.discs.radius > 0 ? section.discs.radius : unknown_radius}});
    from += section.length;
  }
}

}  // namespace

void put_arm_shape(ArmContext& context, const ArmState&, int samples) {
  const Arm& arm = context.robot;
  ArmPicture picture;
  picture.add(arm, context.work, samples, 0);
  std::vector<double> ends;
  double end = 0;
  for (const ArmSection& section : arm.sections) ends.push_back(end += section.length);
  Value frames = Value::list();
  for (const SE3<double>& frame : arm_frames(arm, ends, context.work))
    frames.push_back(pose_value(AnyPose(spatial_pose(frame))));
  Value& answer = context.answer;
  answer["places"] = places_along(arm, samples);
  answer["backbones"] = std::move(picture.backbones);
  answer["curvatures"] = std::move(picture.curvatures.back());
  answer["tendons"] = std::move(picture.tendons);
  answer["discs"] = std::move(picture.discs);
  answer["frames"] = std::move(frames);
}

void put_arm_shape(ArmLegsContext& context, const ArmLegsState& state, int samples) {
  const ArmLegs& robot = context.robot;
  const SE3<double>& platform = state.platform;
  ArmPicture picture;
  picture.is_planar = robot.is_planar;
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    double around = 0;  // where a disc's size is not known: its tendons run within it
    for (const ArmTendon& tendon : robot.legs[k].arm.tendons)
      for (const TendonRoute& route : tendon.routes)
        around = std::max({around, 1.15 * route.start_radius, 1.15 * route.end_radius});
    picture.add(robot.legs[k].arm, arm_legs_shape(context.work, k), samples, around);
  }
  const int dimension = robot.is_planar ? 2 : 3;
  std::vector<double> base, plate;
  for (const ArmLeg& leg : robot.legs) {
    const Vec3<double> corner = platform.p + platform.rotate(leg.platform_point);
    base.insert(base.end(), leg.base.p.begin(), leg.base.p.begin() + dimension);
    plate.insert(plate.end(), corner.begin(), corner.begin() + dimension);
  }
  Value& answer = context.answer;
  answer["base"] = Value(base, static_cast<std::size_t>(dimension));
  answer["platform"] = Value(plate, static_cast<std::size_t>(dimension));
  answer["backbones"] = std::move(picture.backbones);
  answer["curvatures"] = std::move(picture.curvatures);
  answer["tendons"] = std::move(picture.tendons);
  if (!robot.is_planar) answer["discs"] = std::move(picture.discs);
  answer["frames"] = Value::list({pose_value(pose_of(robot.is_planar, platform))});
}

namespace {

bool tells_stability(const ArmState& state) { return state.stability_told; }
bool tells_stability(const ArmLegsState&) { return true; }

/// Of a platform what holds it, of an arm what `compliance` is the inverse of.
void put_stiffness(ArmContext& context, const ArmRates& rates) {
  std::array<double, 36> identity{}, stiffness{};
  for (std::size_t i = 0; i < 6; ++i) identity[7 * i] = 1;
  if (solve(MatrixView(rates.compliance.data(), 6, 6), {identity.data(), 6, 6}, stiffness))
    context.answer["stiffness"] = Value(MatrixView(stiffness.data(), 6, 6));
  else
    context.add_message(
        "the stiffness is not finite: by this model the tip yields in fewer than six directions, those of "
        "compliance");
}
void put_stiffness(ArmLegsContext& context, const ArmLegsRates& rates) {
  if (rates.has_stiffness)
    context.answer["stiffness"] =
        matrix_value(context.robot.is_planar, rates.stiffness.data(), 6, 6, true, true);
  else
    context.add_message("the stiffness is not finite: a leg that does not stretch is straight");
}

}  // namespace

template <class Arms>
void put_arm_wants(ArmContextOf<Arms>& context, const typename ArmTypes<Arms>::State& state, Wants words,
                   int samples) {
  if (!state.report.is_solved()) return;
  if (words.has(Want::shape)) put_arm_shape(context, state, samples);
  constexpr bool is_arm = std::is_same_v<Arms, Arm>;
  const bool wants_margins = is_arm && !(words & Wants{Want::stability, Want::margins}).is_empty();
  if (!wants_margins && (words & Wants{Want::velocity, Want::stiffness}).is_empty()) return;
  const auto rates = [&] {
    if constexpr (is_arm)
      return arm_rates(context.robot, context.work, wants_margins);
    else
      return arm_legs_rates(context.robot, context.work);
  }();
  if (!rates.regular) {
    context.add_message(tells_stability(state) ? "the equilibrium is a fold: it has no rates"
                                               : "rates and margins are told of balances by energy alone");
    return;
  }
  if constexpr (!is_arm)
    if (rates.opposed)
      return context.add_message(
          "tendons that do not stretch are held against one another: there is an equilibrium, but no rates");
  Value& answer = context.answer;
  const bool planar = is_planar(context.robot);
  const std::size_t tendons = state.tensions.size();
  if (words.has(Want::velocity)) {
    answer["U"] = matrix_value(planar, rates.J.data(), 6, tendons, true, false);
    answer["answer_rates"] = matrix_value(planar, rates.answers.data(), tendons, tendons, false, false);
  }
  if (words.has(Want::stiffness)) {
    answer["compliance"] = matrix_value(planar, rates.compliance.data(), 6, 6, true, true);
    put_stiffness(context, rates);
    answer["answers_by_wrench"] =
        matrix_value(planar, rates.answers_by_wrench.data(), tendons, 6, false, true);
  }
  if constexpr (is_arm) {
    if (wants_margins) answer["buckling_margin"] = rates.margin;
    if (rates.margin_is_bound)
      context.add_message(
          "more than six tendons are exactly at rest and counted as slack: the margin to buckling is at "
          "least this");
    if (words.has(Want::margins) && tendons > 0) answer["least_tension"] = std::ranges::min(state.tensions);
  }
}

template void put_arm_wants(ArmContext&, const ArmState&, Wants, int);
template void put_arm_wants(ArmLegsContext&, const ArmLegsState&, Wants, int);

namespace {

/// What an arm's answer has beside, or a platform's.
void put_own(Value& answer, const Arm& arm, const ArmState& state) {
  if (!arm.motor) return;
  std::vector<double> counts = state.changes;
  for (double& count : counts) count *= arm.motor->counts_per_length();
  answer["motors"] = by_end_section(arm, counts);
}
void put_own(Value& answer, const ArmLegs& robot, const ArmLegsState& state) {
  Value legs = Value::list();
  for (const auto& [fx, fy, fz, mx, my, mz] : state.tip_loads)
    if (robot.is_planar)
      legs.push_back({{"force", {fx, fy}}, {"moment", {0.0, 0.0, mz}}});
    else
      legs.push_back({{"force", {fx, fy, fz}}, {"moment", {mx, my, mz}}});
  answer["legs"] = std::move(legs);
  answer["reached"] = state.reached;
}

}  // namespace

template <class Arms>
void put_arm_state(ArmContextOf<Arms>& context, const typename ArmTypes<Arms>::State& state,
                   const Report& report) {
  Value& answer = context.answer;
  put_arm_numbers(answer, context.robot, state);
  put_own(answer, context.robot, state);
  if (tells_stability(state)) answer["stable"] = state.stable;
  put_number(answer, "residual", report.residual);
  answer["iterations"] = report.iterations;
  if (state.resolution > 0) answer["resolution"] = state.resolution;
}
template void put_arm_state(ArmContext&, const ArmState&, const Report&);
template void put_arm_state(ArmLegsContext&, const ArmLegsState&, const Report&);

}  // namespace sinew::inline v1
