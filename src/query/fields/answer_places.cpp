#include "query/fields/answer_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "query/fields/answer_fields.hpp"
#include "query/fields/fields.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {
namespace {
namespace answer_words {

/// Bits in groups: who answers, in which space, what a leg has, what is asked. A word that names none of a
/// group is of all of it. `of_arms` is one arm here.
constexpr unsigned of_arm_legs = 32, in_plane = 64, in_space = 128, on_tendons = 256, on_rails = 512,
                   on_rods = 1024;
constexpr unsigned may_move = 2048, may_not = 4096;  ///< at a pose; of chains by a motor
constexpr unsigned asking(std::initializer_list<Ask> asks) {
  unsigned bits = 0;
  for (const Ask ask : asks) bits |= 0x10000U << static_cast<unsigned>(ask);
  return bits;
}
constexpr unsigned groups[] = {of_all | of_arms | of_arm_legs, in_plane | in_space,
                               on_tendons | on_rails | on_rods, may_move | may_not,
                               asking({Ask::forward, Ask::inverse, Ask::velocity, Ask::shape, Ask::statics,
                                       Ask::track, Ask::diagram, Ask::identify, Ask::describe})};

constexpr bool is_of(unsigned word, unsigned robot) {
  return std::ranges::all_of(groups, [&](unsigned group) {
    return (word & group) == 0 || (robot & group) == 0 || (word & robot & group) != 0;
  });
}

template <std::size_t count>
constexpr AnswerGroup group_of(const std::array<AnswerWord, count>& words) {
  return {words.data(), count};
}

constexpr unsigned all_robots = of_all | of_arms | of_arm_legs, with_arms = of_arms | of_arm_legs,
                   platforms = of_platforms | of_arm_legs, tips = of_serial | of_arms,
                   on_arcs = of_kinematic | of_chains,
                   configuration =
                       asking({Ask::forward, Ask::inverse, Ask::velocity, Ask::shape, Ask::statics}),
                   loaded = asking({Ask::forward, Ask::inverse, Ask::statics}),
                   solving = asking({Ask::forward, Ask::inverse}), sensing = asking({Ask::statics}),
                   path = asking({Ask::track}), diagram = asking({Ask::diagram}),
                   identify = asking({Ask::identify});
constexpr auto value = AnswerPart::value;
constexpr auto list = AnswerPart::list;
constexpr auto map = AnswerPart::map;
constexpr auto maps = AnswerPart::maps;

// clang-format off
constexpr std::array pose_words{
    AnswerWord{"x", in_plane}, AnswerWord{"y", in_plane}, AnswerWord{"phi", in_plane},
    AnswerWord{"position", in_space}, AnswerWord{"quaternion", in_space},
    AnswerWord{.name = "tilt", .of = in_space, .with = "tilt"},
    AnswerWord{.name = "azimuth", .of = in_space, .with = "tilt"},
    AnswerWord{.name = "torsion", .of = in_space, .with = "tilt"},
};
constexpr AnswerGroup pose_fields = group_of(pose_words);
constexpr std::array spatial_words{AnswerWord{"position", 0}, AnswerWord{"quaternion", 0}};
constexpr AnswerGroup spatial_pose = group_of(spatial_words);

constexpr std::array leg_words{
    AnswerWord{"curvature", of_kinematic | on_tendons}, AnswerWord{"chord", of_kinematic | of_rods | on_tendons | on_rods},
    AnswerWord{"tendon_lengths", of_kinematic | on_tendons}, AnswerWord{"tendon_lengths", of_chains | loaded}, AnswerWord{"base_tangent", of_kinematic | on_tendons},
    AnswerWord{"joint_angles", of_kinematic | on_tendons | in_space},
    AnswerWord{"elbow", of_kinematic | of_rods | on_rails | on_tendons | may_move},
    AnswerWord{"slide", of_kinematic | of_rods | on_rails}, AnswerWord{"carriage", of_kinematic | of_rods | on_rails},
    AnswerWord{"hinge_angle", of_kinematic | of_rods | on_rails},
    AnswerWord{"angles", of_chains}, AnswerWord{"chord_force", of_chains | loaded}, AnswerWord{"tensions", of_chains | loaded},
    AnswerWord{"tip_wrench", of_chains | loaded}, AnswerWord{"motor_torque", of_chains | may_move | loaded},
    AnswerWord{"length", of_rods | on_rods}, AnswerWord{"force", of_rods | of_arm_legs}, AnswerWord{"force_0", of_rods | on_rods},
    AnswerWord{"moment", of_rods | of_arm_legs | on_rods}, AnswerWord{"moment_0", of_rods | on_rods},
    AnswerWord{"curvature_0", of_rods | on_rods}, AnswerWord{"tip", of_rods | on_rods}, AnswerWord{"tip_angle", of_rods | on_rods},
    AnswerWord{"energy", of_rods | on_rods},
};
constexpr AnswerGroup leg_fields = group_of(leg_words);

constexpr std::array solution_words{
    AnswerWord{"pose", platforms, map, pose_fields}, AnswerWord{"tip", tips, map, pose_fields}, AnswerWord{"inputs", of_platforms},
    AnswerWord{"legs", platforms, maps, leg_fields}, AnswerWord{"residual", 0}, AnswerWord{"double", on_arcs},
    AnswerWord{"stable", of_chains | of_rods | with_arms}, AnswerWord{"unstable_directions", of_chains | of_rods},
    AnswerWord{"potential", of_chains | of_rods | with_arms}, AnswerWord{"configuration", of_serial}, AnswerWord{"changes", of_serial | with_arms},
    AnswerWord{"tensions", with_arms}, AnswerWord{"slack", with_arms}, AnswerWord{"curvatures", with_arms, list}, AnswerWord{"continuum", with_arms},
};
constexpr std::array indices_words{
    AnswerWord{"condition", on_arcs | of_serial}, AnswerWord{"condition_homogenised", on_arcs | of_serial},
    AnswerWord{"position", 0}, AnswerWord{"rotation", 0},
};
constexpr std::array axis_words{AnswerWord{"point", 0}, AnswerWord{"direction", 0}};
constexpr std::array type_two_words{
    AnswerWord{"singular", 0}, AnswerWord{"rank", on_arcs},
    AnswerWord{.name = "point", .of = on_arcs, .is_rare = true}, AnswerWord{.name = "pitch", .of = on_arcs, .is_rare = true},
    AnswerWord{.name = "axis", .of = on_arcs, .part = map, .below = group_of(axis_words), .is_rare = true},
};
constexpr std::array type_two_distance_words{
    AnswerWord{"found", 0}, AnswerWord{.name = "distance", .of = 0, .is_rare = true}, AnswerWord{.name = "reached", .of = 0, .is_rare = true},
    AnswerWord{"pose", 0, map, pose_fields},
};
constexpr std::array margin_words{AnswerWord{"fold", 0}, AnswerWord{"strain", 0}};
constexpr std::array iterate_words{AnswerWord{"iteration", 0}, AnswerWord{"residual", 0}, AnswerWord{"step", 0}};
constexpr std::array disc_words{AnswerWord{"height", 0}, AnswerWord{"radius", 0}, AnswerWord{"pose", 0, map, spatial_pose}};
constexpr std::array row_words{
    AnswerWord{"pose", platforms, map, pose_fields}, AnswerWord{"tip", of_arms, map, spatial_pose}, AnswerWord{"inputs", of_platforms},
    AnswerWord{"legs", of_arm_legs, maps, leg_fields}, AnswerWord{"angles", of_chains, list}, AnswerWord{"curvature", of_kinematic, list}, AnswerWord{"closure_error", on_arcs},
    AnswerWord{"indices", of_platforms, map, group_of(indices_words)}, AnswerWord{"type_1", on_arcs, list}, AnswerWord{"singular", on_arcs},
    AnswerWord{"margins", of_rods, map, group_of(margin_words)}, AnswerWord{"residual", 0}, AnswerWord{"potential", 0}, AnswerWord{"stable", 0},
    AnswerWord{"unstable_directions", 0}, AnswerWord{"tensions", 0}, AnswerWord{"changes", with_arms}, AnswerWord{"end_tensions", with_arms},
    AnswerWord{"slack", with_arms}, AnswerWord{"slipping", with_arms}, AnswerWord{"motor_work", of_arms}, AnswerWord{"friction_loss", of_arms},
    AnswerWord{"part", 0}, AnswerWord{"point", 0}, AnswerWord{"parameter", 0}, AnswerWord{"curve", 0}, AnswerWord{"row", 0}, AnswerWord{"reached", of_arm_legs},
    AnswerWord{"motors", of_arms}, AnswerWord{"resolution", with_arms}, AnswerWord{"iterations", 0},
};
constexpr AnswerGroup row_fields = group_of(row_words);
constexpr std::array from_words{AnswerWord{"curve", 0}, AnswerWord{"row", 0}};
constexpr std::array curve_words{AnswerWord{"rows", 0, maps, row_fields}, AnswerWord{"from", 0, map, group_of(from_words)}};
constexpr std::array end_words{AnswerWord{"rows", 0}, AnswerWord{"part", 0}, AnswerWord{"point", 0}, AnswerWord{"pose", platforms, map, pose_fields}};
constexpr std::array one_side_words{AnswerWord{"twist", 0}, AnswerWord{"changes", 0}, AnswerWord{"tensions", 0}, AnswerWord{"slipping", 0}};
constexpr std::array two_sides_words{
    AnswerWord{"growing", 0, map, group_of(one_side_words)}, AnswerWord{"shrinking", 0, map, group_of(one_side_words)}};
constexpr std::array motion_words{
    AnswerWord{"twist", 0}, AnswerWord{"changes", 0}, AnswerWord{"tensions", 0}, AnswerWord{"slipping", 0}, AnswerWord{"U", 0}, AnswerWord{"compliance", 0},
    AnswerWord{"changes_by_inputs", 0}, AnswerWord{"tensions_by_inputs", 0}, AnswerWord{"changes_by_wrench", 0}, AnswerWord{"tensions_by_wrench", 0},
    AnswerWord{"least", 0}, AnswerWord{"most", 0},
};
constexpr std::array envelope_words{AnswerWord{"limit", 0}};
constexpr std::array frontier_words{AnswerWord{"normal", 0}, AnswerWord{"offset", 0}, AnswerWord{"curve", 0, list}};
constexpr std::array measured_words{
    AnswerWord{"margin", 0}, AnswerWord{"over_tension", 0}, AnswerWord{"amount", 0}, AnswerWord{"near_limit", 0},
    AnswerWord{"partial", 0}, AnswerWord{"point", 0}, AnswerWord{"slack", 0, list},
};
constexpr std::array error_words{
    AnswerWord{"rms", 0}, AnswerWord{"median", 0}, AnswerWord{"max", 0}, AnswerWord{"rows", 0}, AnswerWord{"failed", 0}};
constexpr std::array errors_words{
    AnswerWord{"before", 0, map, group_of(error_words)}, AnswerWord{"fitted", 0, map, group_of(error_words)},
    AnswerWord{"held_out", 0, map, group_of(error_words)}};
constexpr std::array parameter_words{
    AnswerWord{"start", 0}, AnswerWord{"value", 0}, AnswerWord{"deviation", 0}, AnswerWord{"at_bound", 0}, AnswerWord{"prior_share", 0},
    AnswerWord{"is_factor", 0}, AnswerWord{"coordinate", 0}, AnswerWord{"coordinate_deviation", 0}, AnswerWord{"prior", 0}};
constexpr std::array flat_words{AnswerWord{"deviation", 0}, AnswerWord{"coefficients", 0, list}};
constexpr std::array map_words{
    AnswerWord{"sign", 0}, AnswerWord{"mirrored", 0}, AnswerWord{"turn", 0}, AnswerWord{"agreement", 0}, AnswerWord{"next", 0}, AnswerWord{"as_given", 0}};
constexpr std::array fitted_row_words{AnswerWord{"distance", 0}, AnswerWord{"held_out_distance", 0}, AnswerWord{"computed", 0, list}};

constexpr auto root_words = [] {
using enum Want;
constexpr unsigned arms_answer = with_arms | configuration | path, elastic = of_chains | of_rods;
return std::array{
    AnswerWord{.name = "pose", .of = of_platforms | configuration, .part = map, .below = pose_fields, .want = Want::pose},
    AnswerWord{"pose", of_arm_legs | configuration | path, map, pose_fields},
    AnswerWord{"tip", of_serial | configuration, map, pose_fields}, AnswerWord{"tip", of_arms | configuration | path, map, pose_fields},
    AnswerWord{"inputs", of_platforms | configuration}, AnswerWord{"configuration", of_serial | configuration},
    AnswerWord{"changes", of_serial | configuration}, AnswerWord{"changes", arms_answer}, AnswerWord{"tensions", arms_answer},
    AnswerWord{"slack", arms_answer}, AnswerWord{"slack", of_serial | asking({Ask::forward})},
    AnswerWord{"motors", of_serial | configuration}, AnswerWord{"motors", of_arms | configuration | path},
    AnswerWord{"sections", of_serial | configuration, maps, spatial_pose},
    AnswerWord{.name = "legs", .of = of_platforms | configuration, .part = maps, .below = leg_fields, .want = Want::legs},
    AnswerWord{"legs", of_arm_legs | configuration | path, maps, leg_fields}, AnswerWord{"reached", of_arm_legs | configuration | path},
    AnswerWord{"wrench", of_chains | loaded}, AnswerWord{"wrench", of_rods | sensing}, AnswerWord{"wrench", with_arms | sensing},
    AnswerWord{"residual", all_robots | configuration | path}, AnswerWord{"iterations", all_robots | configuration | path | identify},
    AnswerWord{"resolution", arms_answer},
    AnswerWord{.name = "count", .of = all_robots | solving, .with = "all"}, AnswerWord{.name = "complete", .of = (all_robots & ~unsigned{of_rods}) | solving, .with = "all"}, AnswerWord{"complete", of_rods | solving},
    AnswerWord{.name = "solutions", .of = all_robots | solving, .part = maps, .below = group_of(solution_words), .with = "all"},
    AnswerWord{.name = "trace", .of = of_kinematic | asking({Ask::forward}), .part = maps, .below = group_of(iterate_words), .with = "trace"},
    AnswerWord{.name = "load", .of = elastic | with_arms | loaded, .with = "until"},
    AnswerWord{.name = "definite_until", .of = elastic | with_arms | loaded, .with = "until"},

    AnswerWord{.name = "energy", .of = of_rods | configuration, .want = Want::legs},
    AnswerWord{.name = "potential", .of = of_rods | configuration, .want = Want::legs, .is_rare = true},
    AnswerWord{"potential", of_chains | loaded}, AnswerWord{"potential", arms_answer},
    AnswerWord{.name = "linear", .of = of_chains | loaded, .want = Want::legs, .is_rare = true},
    AnswerWord{.name = "linear_error", .of = of_chains | loaded, .want = Want::legs, .is_rare = true},
    AnswerWord{.name = "posture_error", .of = of_chains | loaded, .want = Want::legs, .is_rare = true},
    AnswerWord{.name = "linear_valid", .of = of_chains | loaded, .want = Want::legs, .with = "posture_threshold", .is_rare = true},
    AnswerWord{.name = "cc_gap", .of = of_chains | loaded, .want = Want::legs, .is_rare = true},
    AnswerWord{.name = "cc_gap_estimate", .of = of_chains | loaded, .want = Want::legs, .is_rare = true},
    AnswerWord{.name = "cc_pose", .of = of_chains | loaded, .part = map, .below = pose_fields, .want = Want::legs, .is_rare = true},

    AnswerWord{.name = "J", .of = of_platforms | of_serial | configuration, .want = velocity},
    AnswerWord{.name = "K", .of = of_platforms | of_serial | configuration, .want = velocity},
    AnswerWord{.name = "U", .of = of_platforms | with_arms | configuration | path, .want = velocity},
    AnswerWord{.name = "determinant", .of = on_arcs | configuration, .want = velocity},
    AnswerWord{.name = "indices", .of = of_platforms | of_serial | configuration, .part = map, .below = group_of(indices_words), .want = velocity},
    AnswerWord{.name = "type_1", .of = on_arcs | configuration, .part = list, .want = velocity},
    AnswerWord{.name = "type_2", .of = of_platforms | configuration, .part = map, .below = group_of(type_two_words), .want = velocity},
    AnswerWord{.name = "rates", .of = of_platforms | of_serial | configuration, .want = velocity, .with = "twist"},
    AnswerWord{.name = "twist", .of = of_rods | configuration, .want = velocity, .is_rare = true},
    AnswerWord{.name = "type_2_distance", .of = of_kinematic | configuration, .part = map, .below = group_of(type_two_distance_words), .want = velocity, .with = "along"},
    AnswerWord{.name = "steering", .of = of_serial | configuration, .want = velocity},
    AnswerWord{.name = "answer_rates", .of = with_arms | configuration | path, .want = velocity},

    AnswerWord{.name = "stiffness", .of = elastic | with_arms | configuration | path, .want = stiffness},
    AnswerWord{.name = "compliance", .of = of_chains | with_arms | configuration | path, .want = stiffness},
    AnswerWord{.name = "answers_by_wrench", .of = with_arms | configuration | path, .want = stiffness},
    AnswerWord{.name = "stable", .of = of_rods | configuration, .want = stability},
    AnswerWord{.name = "stable", .of = of_chains | with_arms | configuration | path, .want = stability, .is_always = true},
    AnswerWord{.name = "unstable_directions", .of = of_rods | configuration, .want = stability},
    AnswerWord{.name = "unstable_directions", .of = of_chains | loaded, .want = stability, .is_always = true},
    AnswerWord{.name = "smallest_eigenvalue", .of = of_chains | loaded, .want = stability, .is_always = true},
    AnswerWord{.name = "unstable", .of = elastic | configuration, .part = list, .want = stability},
    AnswerWord{.name = "unstable_legs", .of = elastic | configuration, .part = list, .want = stability},
    AnswerWord{.name = "buckling_margin", .of = of_arms | configuration | path, .want = margins},
    AnswerWord{.name = "least_tension", .of = of_arms | configuration | path, .want = margins},
    AnswerWord{.name = "margins", .of = elastic | configuration, .part = map, .below = group_of(margin_words), .want = margins},
    AnswerWord{.name = "sensitivity", .of = of_platforms | configuration, .want = sensitivity},

    AnswerWord{.name = "lines", .of = of_kinematic | configuration, .part = list, .want = lines},
    AnswerWord{.name = "lines", .of = elastic | configuration, .part = list, .want = shape},
    AnswerWord{.name = "backbones", .of = all_robots | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "tendons", .of = all_robots | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "base", .of = platforms | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "platform", .of = platforms | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "places", .of = with_arms | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "curvatures", .of = with_arms | configuration | path, .part = list, .want = shape},
    AnswerWord{.name = "discs", .of = of_serial | with_arms | configuration | path, .part = maps, .below = group_of(disc_words), .want = shape},
    AnswerWord{.name = "frames", .of = all_robots | configuration | path, .part = maps, .below = pose_fields, .want = shape},
    AnswerWord{.name = "tensions_along", .of = of_arms | path, .part = list, .want = shape},

    AnswerWord{"covariance", elastic | with_arms | sensing}, AnswerWord{"wrench_sensitivity", elastic | with_arms | sensing},
    AnswerWord{"condition", elastic | with_arms | sensing}, AnswerWord{"misfit", elastic | with_arms | sensing},

    AnswerWord{"rows", all_robots | path, maps, row_fields}, AnswerWord{"reached", (all_robots & ~of_arm_legs) | path, map, group_of(end_words)},
    AnswerWord{"curves", elastic | path, maps, group_of(curve_words)}, AnswerWord{"equilibria", elastic | path, maps, row_fields},
    AnswerWord{"end_tensions", of_arms | path}, AnswerWord{"slipping", of_arms | path}, AnswerWord{"motor_work", of_arms | path}, AnswerWord{"friction_loss", of_arms | path},
    AnswerWord{.name = "one_sided", .of = of_arms | path, .part = maps, .below = group_of(two_sides_words), .want = velocity},
    AnswerWord{.name = "in_motion", .of = of_arms | path, .part = map, .below = group_of(motion_words), .with = "motions"},

    AnswerWord{"margin", diagram}, AnswerWord{"over_tension", diagram}, AnswerWord{"amount", diagram}, AnswerWord{"near_limit", diagram},
    AnswerWord{"partial", diagram}, AnswerWord{"conditional", diagram}, AnswerWord{"area", diagram}, AnswerWord{"point", diagram, list}, AnswerWord{"slack", diagram, list},
    AnswerWord{"envelope", diagram, map, group_of(envelope_words)}, AnswerWord{"frontiers", diagram, maps, group_of(frontier_words)},
    AnswerWord{"polygon", diagram, list}, AnswerWord{"boundary", diagram, list}, AnswerWord{"outline", diagram, list},
    AnswerWord{.name = "measured", .of = diagram, .part = map, .below = group_of(measured_words), .with = "measured"},

    AnswerWord{"rows", identify}, AnswerWord{"blocks", identify}, AnswerWord{"folds", identify}, AnswerWord{"noise", identify},
    AnswerWord{"errors", identify, map, group_of(errors_words)}, AnswerWord{"parameters", identify, maps, group_of(parameter_words)},
    AnswerWord{"flat", identify, maps, group_of(flat_words)}, AnswerWord{"covariance", identify, list},
    AnswerWord{"by_row", identify, maps, group_of(fitted_row_words)}, AnswerWord{"map", identify, map, group_of(map_words)},
};
}();
// clang-format on
constexpr AnswerGroup root = group_of(root_words);

unsigned bits_of(const Robot& robot) {
  if (robot.serial()) return of_serial | in_space;
  if (robot.arm()) return of_arms | in_space;
  if (const ArmLegs* legs = robot.arm_legs()) return of_arm_legs | (legs->is_planar ? in_plane : in_space);
  const unsigned space = robot.planar() ? in_plane : in_space;
  if (has_rods(robot)) return of_rods | space;
  return (robot.model() == Model::prb ? unsigned{of_chains} : unsigned{of_kinematic}) | space;
}

/// What each leg is, by its inputs; one that shares those of another is like the one before it.
std::vector<unsigned> bits_of_legs(const Robot& robot) {
  if (const ArmLegs* legs = robot.arm_legs()) return std::vector<unsigned>(legs->legs.size());
  if (robot.serial() || robot.arm()) return {};
  std::vector<unsigned> legs(static_cast<std::size_t>(leg_count(robot)));
  for (const InputOfLeg& input : inputs_of(robot)) {
    unsigned& bits = legs[static_cast<std::size_t>(input.leg)];
    if (input.name == "slide") bits |= on_rails | may_move;
    if (input.name == "length") bits |= on_rods;
    if (input.name == "theta") bits |= may_move;
    if (input.name == "tendon_1") bits |= on_tendons;
  }
  for (std::size_t i = 1; i < legs.size(); ++i)
    if (legs[i] == 0) legs[i] = legs[i - 1];
  for (unsigned& bits : legs)
    if ((bits & may_move) == 0) bits |= may_not;
  return legs;
}

/// A name of a place, with the indices after it.
struct Step {
  std::string_view name;
  std::vector<std::size_t> indices;
};
std::vector<Step> steps_of(std::string_view place) {
  std::vector<Step> steps;
  while (!place.empty()) {
    std::string_view part = place.substr(0, place.find('.'));
    place.remove_prefix(std::min(part.size() + 1, place.size()));
    Step step{part.substr(0, part.find('[')), {}};
    for (std::size_t open = part.find('['); open < part.size(); open = part.find('[', open + 1)) {
      std::size_t index = 0;
      std::from_chars(part.data() + open + 1, part.data() + part.size(), index);
      step.indices.push_back(index);
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

std::string joined_place(std::string_view before, std::string_view name) {
  return before.empty() ? std::string(name) : fmt::format("{}.{}", before, name);
}

/// A place that has this name as its last one, or whose spelling is close.
std::string_view hint_of(std::string_view written, std::span<const std::string> places) {
  const auto ends = std::ranges::find_if(places, [&](std::string_view place) {
    return place.ends_with(written) && place.size() > written.size() &&
           place[place.size() - written.size() - 1] == '.';
  });
  if (ends != places.end()) return *ends;
  const std::vector<std::string_view> all(places.begin(), places.end());
  return closest(written, all);
}

}  // namespace answer_words
}  // namespace

using answer_words::asking, answer_words::joined_place;

bool has_what_it_goes_with(const AnswerWord& word, const Node& query) {
  if (word.with.empty()) return true;
  const Node* field = query.find(word.with);
  return field && field->kind != Node::Kind::null && (field->kind != Node::Kind::boolean || field->boolean);
}

AnswerPlaces::AnswerPlaces(const Robot& robot, Ask ask)
    : bits_(answer_words::bits_of(robot) | asking({ask})),
      legs_(answer_words::bits_of_legs(robot)),
      ask_(ask) {}

Wants AnswerPlaces::wanted(Wants named) const {
  return wanted_of((bits_ & of_rods) != 0 ? usual_of_rods(ask_) : usual_of(ask_), named);
}

/// Whether its answers can be told to have it.
bool AnswerPlaces::is_given(const AnswerWord& word) const {
  if (!word.want || word.is_always || wanted({}).has(*word.want)) return true;
  const unsigned mechanics = (bits_ & answer_words::of_arm_legs) != 0 ? unsigned{of_arms} : bits_;
  return (find_field("want")->uses.of(ask_) & mechanics & (of_all | of_arms)) != 0;
}

std::vector<const AnswerWord*> AnswerPlaces::words(AnswerGroup group, std::ptrdiff_t leg) const {
  const unsigned own = leg >= 0 && leg < std::ssize(legs_) ? legs_[static_cast<std::size_t>(leg)] : 0;
  std::vector<const AnswerWord*> found;
  for (const AnswerWord& word : std::span(group.first, group.count))
    if (answer_words::is_of(word.of, bits_ | own) && is_given(word)) found.push_back(&word);
  return found;
}

std::string AnswerPlaces::no_such(std::string_view place, std::string_view before, AnswerGroup group,
                                  std::ptrdiff_t leg) const {
  std::vector<std::string> names, all;
  const auto add = [](std::vector<std::string>& to, std::string name) {
    if (std::ranges::find(to, name) == to.end()) to.push_back(std::move(name));
  };
  const auto collect = [&](const auto& self, AnswerGroup at, const std::string& prefix, std::ptrdiff_t own,
                           int depth) -> void {
    for (const AnswerWord* word : words(at, own)) {
      std::string name = joined_place(prefix, word->name);
      if (word->part == AnswerPart::maps) name += "[0]";
      if (depth == 0) add(names, std::string(word->name));
      if (word->below.count == 0)
        add(all, name);
      else if (depth < 2)
        self(self, word->below, name, word->name == "legs" ? 0 : own, depth + 1);
    }
  };
  collect(collect, group, std::string(before), leg, 0);
  const std::string_view hint = answer_words::hint_of(place, all);
  constexpr std::size_t most = 40;
  return fmt::format("no answer to {} has {} by this robot and model{} There {}: {}{}.", word_of(ask_),
                     in_quotes(place),
                     hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                     before.empty() ? "are" : fmt::format("are in {}", before),
                     fmt::join(std::span(names).first(std::min(names.size(), most)), ", "),
                     names.size() > most ? ", ..." : "");
}

tl::expected<AnswerPlaces::Found, std::string> AnswerPlaces::find(std::string_view place) const {
  constexpr std::string_view count = ".count";
  const bool counts = place.ends_with(count);
  const std::vector<answer_words::Step> steps =
      answer_words::steps_of(counts ? place.substr(0, place.size() - count.size()) : place);
  Found found{};
  AnswerGroup group = answer_words::root;
  std::string before;
  std::ptrdiff_t leg = -1;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto& [name, indices] = steps[k];
    const auto known = words(group, leg);
    const auto at = std::ranges::find(known, name, [](const AnswerWord* word) { return word->name; });
    if (at == known.end()) return tl::unexpected(no_such(place, before, group, leg));
    const AnswerWord& word = **at;
    if (k == 0) found.root = &word;
    const bool is_last = k + 1 == steps.size();
    before = joined_place(before, name);
    if (word.below.count == 0 && !is_last) return tl::unexpected(no_such(place, before, {}, leg));
    if (word.part == AnswerPart::map && (is_last || !indices.empty()))
      return tl::unexpected(fmt::format("{} is no number; name one of its fields, such as {}.{}", before,
                                        before, words(word.below, leg).front()->name));
    if (word.part == AnswerPart::maps && indices.size() != 1 && !(is_last && counts && indices.empty()))
      return tl::unexpected(fmt::format("{} is a list; name one of them, such as {}[0].{}", before, before,
                                        words(word.below, name == "legs" ? 0 : leg).front()->name));
    if (word.part == AnswerPart::maps && is_last && !counts)
      return tl::unexpected(fmt::format("{}[{}] is no number; name one of its fields, such as {}[{}].{}",
                                        before, indices[0], before, indices[0],
                                        words(word.below, name == "legs" ? 0 : leg).front()->name));
    if (word.part == AnswerPart::list && is_last && indices.empty() && !counts)
      return tl::unexpected(fmt::format(
          "{} is as long as it is, which is no column; name one of its numbers, such as {}[0], or {}.count, "
          "or ask such rows one by one",
          before, before, before));
    if (name == "legs" && !indices.empty()) {
      leg = static_cast<std::ptrdiff_t>(indices[0]);
      if (indices[0] >= legs_.size())
        return tl::unexpected(
            fmt::format("there is no {}[{}]; give a leg from 0 to {}", before, indices[0], legs_.size() - 1));
    }
    if (!indices.empty()) before += fmt::format("[{}]", fmt::join(indices, "]["));
    found.last = &word;
    found.is_index = !indices.empty();
    group = word.below;
  }
  return found;
}

std::vector<std::string> AnswerPlaces::given_by(Want want, const Node& query) const {
  std::vector<std::string> places;
  const auto collect = [&](const auto& self, AnswerGroup group, const std::string& before,
                           std::ptrdiff_t leg) -> void {
    for (const AnswerWord* word : words(group, leg)) {
      if (before.empty() && word->want != want) continue;
      if (word->is_rare || !has_what_it_goes_with(*word, query)) continue;
      const std::string place = joined_place(before, word->name);
      if (word->part == AnswerPart::value) places.push_back(place);
      if (word->part == AnswerPart::map) self(self, word->below, place, leg);
      if (word->part == AnswerPart::maps && word->name == "legs")
        for (std::size_t i = 0; i < legs_.size(); ++i)
          self(self, word->below, fmt::format("{}[{}]", place, i), static_cast<std::ptrdiff_t>(i));
    }
  };
  collect(collect, answer_words::root, "", -1);
  return places;
}

}  // namespace sinew::inline v1
