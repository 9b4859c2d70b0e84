#include "query/fields/answer_fields.hpp"

#include <algorithm>

namespace sinew::inline v1 {
namespace {
namespace answer_table {

using namespace answer_bits;
using enum AnswerShape;

constexpr unsigned all_robots = of_all | of_arms | of_arm_legs, with_arms = of_arms | of_arm_legs,
                   platforms = of_platforms | of_arm_legs, tips = of_serial | of_arms,
                   on_arcs = of_kinematic | of_chains, elastic = of_chains | of_rods, any = 0,
                   configuration =
                       asking({Ask::forward, Ask::inverse, Ask::velocity, Ask::shape, Ask::statics}),
                   loaded = asking({Ask::forward, Ask::inverse, Ask::statics}),
                   solving = asking({Ask::forward, Ask::inverse}), sensing = asking({Ask::statics}),
                   path = asking({Ask::track}), diagram = asking({Ask::diagram}),
                   identify = asking({Ask::identify}), describe = asking({Ask::describe}),
                   arms_answer = with_arms | configuration | path;

/// The same field where it has more or fewer numbers.
constexpr AnswerField as(AnswerShape shape, AnswerField field) {
  field.shape = shape;
  return field;
}
constexpr AnswerWord always(AnswerWord word) {
  word.is_always = true;
  return word;
}
constexpr AnswerWord rare(AnswerWord word) {
  word.is_rare = true;
  return word;
}
/// Where the question has this field.
constexpr AnswerWord with(std::string_view field, AnswerWord word) {
  word.with = field;
  return word;
}

// clang-format off
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wunused-const-variable"  // what no place refers to is no field
/// What stands at several places.
namespace field {
constexpr AnswerField
    position{"position", triple, "m", "of a pose in space"},
    quaternion{"quaternion", AnswerShape::quaternion, "", "of a pose in space, w first, w >= 0"},
    inputs{"inputs", AnswerShape::inputs, "m, rad", "in leg order"},
    configuration{"configuration", bends, "rad", "of each section: two angles, and where its length varies its extension [m]"},
    changes{"changes", tendons, "m", "of each tendon, > 0 pays out"},
    tensions{"tensions", tendons, "N", "of each tendon at its motor, of legs on chains both of each"},
    end_tensions{"end_tensions", tendons, "N", "of each tendon where it is fixed: what friction leaves of its tension"},
    slack{"slack", tendons, "m", "of each tendon, of a diagram where the section is; < 0: too short"},
    motors{"motors", tendons, "", "counts of each tendon's motor"},
    residual{"residual", number, "", "largest error of what was solved: [m], of robots on rods without unit"},
    iterations{"iterations", number, "", "of the solver"},
    resolution{"resolution", number, "m", "by how much finer polynomials move an arm's tip"},
    complete{"complete", flag, "", "whether these are all solutions"},
    tendon_lengths{"tendon_lengths", pair, "m", "of both tendons of a leg"},
    curvature{"curvature", number, "1/m", "of a leg, signed"},
    curvatures{"curvatures", list, "1/m", "of an arm or of its legs at these points, or means of equal parts"},
    angles{"angles", joints, "rad", "of a chain's joints"},
    energy{"energy", number, "J", "of rods"},
    potential{"potential", number, "J", "of rods or chains, and of the load; of arms elastic, of weight and dead forces and of tendons that stretch, without the motors that hold tensions"},
    stable{"stable", flag, "", "whether an equilibrium holds by itself"},
    unstable_directions{"unstable_directions", number, "", "in which an equilibrium does not hold by itself"},
    singular{"singular", flag, "", "whether the platform can move with all inputs held: a singularity of type II"},
    type_1{"type_1", list, "", "legs whose inputs cannot follow every motion, from 0"},
    U{"U", sensitivities, "1, rad/m, m, m/N, rad/N", "inverse of J, times K"},
    twist{"twist", freedoms, "m/s, rad/s", "of the platform, for rates"},
    condition{"condition", number, "", "of J; of a sensed wrench how much better its best known direction is known than its worst"},
    wrench{"wrench", freedoms, "N, N m", "of the world on the platform"},
    compliance{"compliance", square, "m/N, 1/N, rad/N, rad/(N m)", "of the platform or tip: the inverse of its stiffness"},
    covariance{"covariance", square, "", "of a sensed wrench [N^2, N^2 m, N^2 m^2]; of identify, of what was fitted"},
    lines{"lines", polylines, "m", "ends of the segments along which legs pull"},
    disc_radius{"discs.radius", number, "m", "of a disc"},
    part{"part", number, "", "of the way to the next pose or point, at most 1"},
    reached{"reached", number, "", "of platforms on arms: share of the way up to which there was an equilibrium that holds"},
    slipping{"slipping", number, "", "at how many guides tendons slip"},
    motor_work{"motor_work", number, "J", "of the motors of an arm's tendons, of a row since the one before"},
    friction_loss{"friction_loss", number, "J", "at the guides of an arm's tendons, of a row since the one before"},
    margin{"margin", number, "m", "of a diagram: to the next tendon that goes slack"},
    over_tension{"over_tension", number, "m", "of a diagram: by which tendons are too short"},
    amount{"amount", number, "", "of a diagram: the most that a tendon has too much or lacks [m]; unreachable: what is asked for, as the limit"},
    near_limit{"near_limit", flag, "", "of a diagram: whether the section is within 5 % of its limit"},
    partial{"partial", flag, "", "of a diagram: whether some tendons are slack and others are not"},
    bend{"point", pair, "rad", "of a diagram: the bend that meets the tendons best"},
    rows{"rows", number, "", "of identify: rows that were measured, or whose errors these are"},
    deviation{"deviation", number, "", "of identify: a standard one, of a parameter in its unit; of a flat direction in assumed deviations"},
    direction{"direction", vector, "", "of an axis"},
    length{"length", number, "m", "of a rod; of describe, of a link, a section or an arm"};
}  // namespace field

constexpr AnswerWord pose[] = {
    {{"x", number, "m", "of a place in the plane"}, in_plane}, {{"y", number, "m", "of a place in the plane"}, in_plane},
    {{"phi", number, "rad", "angle of a pose in the plane"}, in_plane}, {field::position, in_space}, {field::quaternion, in_space},
    with("tilt", {{"tilt", number, "rad", "by which a platform's z axis leans"}, in_space}),
    with("tilt", {{"azimuth", number, "rad", "towards which it leans"}, in_space}),
    with("tilt", {{"torsion", number, "rad", "by which the platform turns about it"}, in_space}),
};
constexpr AnswerWord spatial_pose[] = {{field::position, any}, {field::quaternion, any}};

constexpr AnswerWord leg[] = {
    {field::curvature, of_kinematic | on_tendons}, {{"chord", number, "m", "from a leg's base to its tip"}, of_kinematic | of_rods | on_tendons | on_rods},
    {field::tendon_lengths, of_kinematic | on_tendons}, {field::tendon_lengths, of_chains | loaded},
    {{"base_tangent", AnswerShape::direction, "rad", "of a leg: in the plane its angle, in space a unit vector"}, of_kinematic | on_tendons},
    {{"joint_angles", pair, "rad", "of a leg's universal joint"}, of_kinematic | on_tendons | in_space},
    {{"elbow", number, "", "of a leg: to which side its strut is turned, 1 or -1"}, of_kinematic | of_rods | on_rails | on_tendons | may_move},
    {{"slide", number, "m", "of a leg on a rail"}, of_kinematic | of_rods | on_rails},
    {{"carriage", vector, "m", "where a leg's carriage is"}, of_kinematic | of_rods | on_rails},
    {{"hinge_angle", number, "rad", "of a strut from its rail"}, of_kinematic | of_rods | on_rails}, {field::angles, of_chains},
    {{"chord_force", number, "N", "by which a leg pulls the platform"}, of_chains | loaded}, {as(pair, field::tensions), of_chains | loaded},
    {{"tip_wrench", freedoms, "N, N m", "of a chain's joints at its tip"}, of_chains | loaded},
    {{"motor_torque", number, "N m", "of a leg's motor"}, of_chains | may_move | loaded}, {field::length, of_rods | on_rods},
    {{"force", vector, "N", "of the platform on a leg's tip, base axes"}, of_rods | of_arm_legs},
    {{"force_0", vector, "N", "on a rod in its guide, base axes"}, of_rods | on_rods},
    {{"moment", triple, "N m", "of the platform on a rod's tip, base axes"}, of_rods | of_arm_legs | on_rods},
    {{"moment_0", triple, "N m", "on a rod in its guide, base axes"}, of_rods | on_rods},
    {{"curvature_0", pair, "1/m", "of a rod in its guide, about x and y of base axes"}, of_rods | on_rods},
    {{"tip", vector, "m", "where a rod ends"}, of_rods | on_rods},
    {{"tip_angle", number, "rad", "of a rod's tip tangent from that in the guide"}, of_rods | on_rods}, {field::energy, of_rods | on_rods},
};

constexpr AnswerWord solution[] = {
    {"pose", map, pose, platforms}, {"tip", map, pose, tips}, {field::inputs, of_platforms}, {"legs", maps, leg, platforms}, {field::residual, any},
    {{"double", flag, "", "whether two solutions merge here: a singularity of type II"}, on_arcs},
    {field::stable, elastic | with_arms}, {field::unstable_directions, elastic}, {field::potential, elastic | with_arms},
    {field::configuration, of_serial}, {field::changes, of_serial | with_arms}, {field::tensions, with_arms}, {field::slack, with_arms},
    {field::curvatures, with_arms}, {{"continuum", flag, "", "whether a solution is one of infinitely many"}, with_arms},
};
constexpr AnswerWord indices[] = {
    {field::condition, on_arcs | of_serial}, {{"condition_homogenised", number, "", "of J, its rotations times a length"}, on_arcs | of_serial},
    {{"indices.position", number, "", "largest singular value of the upper rows of U"}, any},
    {{"rotation", number, "", "largest singular value of the lower rows of U"}, any},
};
constexpr AnswerWord axis[] = {{{"axis.point", vector, "m", "on an axis"}, any}, {field::direction, any}};
constexpr AnswerWord type_2[] = {
    {field::singular, any}, {{"rank", number, "", "of the legs' lines"}, on_arcs},
    rare({{"type_2.point", vector, "m", "that lines of legs have in common"}, on_arcs}),
    rare({{"pitch", number, "m", "by which the platform can move along an axis as it turns about it; 0: it turns alone"}, on_arcs}),
    rare({"axis", map, axis, on_arcs}),
};
constexpr AnswerWord type_2_distance[] = {
    {{"found", flag, "", "whether there is a singularity of type II along a direction"}, any},
    rare({{"type_2_distance.distance", number, "", "along a direction to a singularity of type II: as many times that twist"}, any}),
    rare({{"type_2_distance.reached", number, "", "along a direction that was looked at, as many times that twist"}, any}), {"pose", map, pose, any},
};
constexpr AnswerWord margins[] = {
    {{"margins.fold", number, "", "smallest part of the platform's stiffness over the largest, 0 at a fold"}, any},
    {{"margins.strain", number, "", "largest bending strain of a link"}, any},
};
constexpr AnswerWord iterate[] = {
    {{"iteration", number, "", "of an iterate: which it is, from 0"}, any}, {field::residual, any},
    {{"step", number, "", "of an iterate: the fraction of the step that was taken"}, any},
};
constexpr AnswerWord disc[] = {
    {{"discs.height", number, "m", "of a disc that is drawn"}, any}, {field::disc_radius, any}, {"pose", map, spatial_pose, any}};

constexpr AnswerWord row[] = {
    {"pose", map, pose, platforms}, {"tip", map, spatial_pose, of_arms}, {field::inputs, of_platforms}, {"legs", maps, leg, of_arm_legs},
    {as(list, field::angles), of_chains}, {as(list, field::curvature), of_kinematic},
    {{"closure_error", number, "m", "by which a leg fails to close"}, on_arcs},
    {"indices", map, indices, of_platforms}, {field::type_1, on_arcs}, {field::singular, on_arcs}, {"margins", map, margins, of_rods},
    {field::residual, any}, {field::potential, any}, {field::stable, any}, {field::unstable_directions, any}, {field::tensions, tips | of_arm_legs},
    {as(pairs, field::tensions), of_platforms},
    {field::changes, with_arms}, {field::end_tensions, with_arms}, {field::slack, with_arms}, {field::slipping, with_arms},
    {field::motor_work, of_arms}, {field::friction_loss, of_arms}, {field::part, any},
    {{"rows.point", number, "", "of a path of inputs: the point on the way to which a row is, from 0"}, any},
    {{"parameter", number, "", "of a row of a curve: 0 at its beginning, 1 at what it leads to"}, any},
    {{"curve", number, "", "on which curve an equilibrium is, from 0"}, any}, {{"row", number, "", "in which of its rows, from 0"}, any},
    {field::reached, of_arm_legs}, {field::motors, of_arms}, {field::resolution, with_arms}, {field::iterations, any},
};
constexpr AnswerWord from[] = {
    {{"from.curve", number, "", "the curve that another one branches off, from 0"}, any}, {{"from.row", number, "", "its row there, from 0"}, any},
};
constexpr AnswerWord curve[] = {{"rows", maps, row, any}, {"from", map, from, any}};
constexpr AnswerWord end[] = {
    {{"reached.rows", number, "", "rows of a path that were answered"}, any},
    {{"reached.part", number, "", "of the way from the pose before, at most 1"}, any},
    {{"reached.point", number, "", "the point on the way to which a path ended, from 0"}, any}, {"pose", map, pose, platforms},
};
constexpr AnswerWord growing[] = {
    {{"growing.twist", freedoms, "", "of an arm's tip as what holds a tendon grows, by that: [m/N, rad/N], of a change [1, rad/m]"}, any},
    {{"growing.changes", tendons, "", "of each tendon as what holds one grows, by that [m/N], of a change [1]"}, any},
    {{"growing.tensions", tendons, "", "at each motor as what holds a tendon grows, by that [1], of a change [N/m]"}, any}, {field::slipping, any},
};
constexpr AnswerWord shrinking[] = {
    {{"shrinking.twist", freedoms, "", "of an arm's tip as what holds a tendon shrinks, by as much of that as growing"}, any},
    {{"shrinking.changes", tendons, "", "of each tendon as what holds one shrinks, by as much of that as growing"}, any},
    {{"shrinking.tensions", tendons, "", "at each motor as what holds a tendon shrinks, by as much of that as growing"}, any}, {field::slipping, any},
};
constexpr AnswerWord one_sided[] = {{"growing", map, growing, any}, {"shrinking", map, shrinking, any}};
constexpr AnswerWord in_motion[] = {
    {field::twist, any}, {{"in_motion.changes", tendons, "m/s", "of each tendon, as those that hold them go on"}, any},
    {{"in_motion.tensions", tendons, "N/s", "at each motor, as those that hold tendons go on"}, any},
    {field::slipping, any}, {field::U, any}, {field::compliance, any},
    {{"changes_by_inputs", tendons_by_inputs, "m/N, 1", "of an arm in motion: how fast each tendon changes, by what holds each"}, any},
    {{"tensions_by_inputs", tendons_by_inputs, "1, N/m", "the same of tensions at the motors"}, any},
    {{"changes_by_wrench", tendons_by_wrench, "m/N, 1/N", "how fast each tendon changes, by a wrench at the tip"}, any},
    {{"tensions_by_wrench", tendons_by_wrench, "1, 1/m", "the same of tensions at the motors"}, any},
    {{"least", tendons, "N/s, m/s", "rate of each tendon down to which the same guides slip"}, any},
    {{"most", tendons, "N/s, m/s", "rate of each tendon up to which they do"}, any},
};

constexpr AnswerWord envelope[] = {{{"limit", number, "", "of a diagram: size of its envelope [rad], of actuators [m]"}, any}};
constexpr AnswerWord frontier[] = {
    {{"normal", pair, "", "of a diagram: of the half-plane that a tendon allows"}, any},
    {{"offset", number, "", "of a diagram: its distance from the straight section"}, any},
    {{"frontiers.curve", points, "", "of a diagram: points of the limit of a tendon [rad, of lengths m]"}, any},
};
constexpr AnswerWord measured[] = {
    {field::margin, any}, {field::over_tension, any}, {field::amount, any}, {field::near_limit, any}, {field::partial, any}, {field::bend, any},
    {as(list, field::slack), any},
};

constexpr AnswerWord marker_errors[] = {
    {{"rms", number, "m", "of identify: root mean square of the distances of markers, computed and measured"}, any},
    {{"median", number, "m", "of identify: half of these distances are smaller"}, any},
    {{"max", number, "m", "of identify: the largest of these distances"}, any}, {field::rows, any},
    {{"failed", number, "", "of identify: rows without an equilibrium, which these do not count"}, any},
};
constexpr AnswerWord errors[] = {{"before", map, marker_errors, any}, {"fitted", map, marker_errors, any}, {"held_out", map, marker_errors, any}};
constexpr AnswerWord parameter[] = {
    {{"start", number, "", "of identify: a parameter before the fit, in its unit"}, any},
    {{"value", number, "", "of identify: a parameter after the fit, in its unit"}, any}, {field::deviation, any},
    {{"at_bound", flag, "", "of identify: whether a parameter went as far as is believed possible"}, any},
    {{"prior_share", number, "", "of identify: how much of what is known of a parameter was assumed; 1: the rows say nothing"}, any},
    {{"is_factor", flag, "", "of identify: whether the coordinate of a parameter is the logarithm of a factor"}, any},
    {{"coordinate", number, "", "of identify: in which a parameter is fitted, the logarithm of a factor or a difference in its unit"}, any},
    {{"coordinate_deviation", number, "", "of identify: its standard deviation, from rows and assumption together"}, any},
    {{"prior", number, "", "of identify: the standard deviation of it that was assumed"}, any},
};
constexpr AnswerWord flat[] = {
    {field::deviation, any},
    {{"coefficients", list, "", "of identify: of a flat direction, by coordinates over their assumed deviations, of length 1"}, any},
};
constexpr AnswerWord fitted_row[] = {
    {{"distance", number, "m", "of identify: of a row's marker from where the fitted arm shows it"}, any},
    {{"held_out_distance", number, "m", "of identify: the same of a fit that has not seen the row"}, any},
    {{"computed", list, "m", "of identify: where the fitted arm shows a row's marker"}, any},
};
constexpr AnswerWord tendon_map[] = {
    {{"sign", number, "", "of identify: -1 where what motors count is paid out, else 1"}, any},
    {{"mirrored", flag, "", "of identify: whether the tendons run around the arm the other way"}, any},
    {{"turn", number, "rad", "of identify: of the measurement's axes about z"}, any},
    {{"agreement", number, "", "of identify: correlation of markers computed and measured, 0 to 1"}, any},
    {{"next", number, "", "of identify: the same of the next best sign and turn"}, any},
    {{"as_given", number, "", "of identify: the same of counts and tendons as they are given"}, any},
};

/// Of describe: what has a shape or a unit elsewhere of the same name.
constexpr AnswerWord described_backbone[] = {{{"backbone.torsion", number, "N m^2", "of describe: torsional stiffness of a section"}, any}};
constexpr AnswerWord described_disc[] = {{field::disc_radius, any}};
constexpr AnswerWord described_section[] = {{field::length, any}, {"backbone", map, described_backbone, any}, {"discs", map, described_disc, any}};
constexpr AnswerWord described_tendon[] = {{{"tendons.compliance", number, "m/N", "of describe: of a tendon of an arm"}, any}};
constexpr AnswerWord described_stretch[] = {{{"stretch.stiffness", number, "N", "of describe: EA of a serial robot's tendons"}, any}};
constexpr AnswerWord described_base[] = {{{"base.point", vector, "m", "of describe: where a leg begins"}, any}, {field::direction, any}};
constexpr AnswerWord described_closure[] = {{field::length, any}, {field::direction, any}};
constexpr AnswerWord described_link[] = {
    {field::length, any}, {"sections", maps, described_section, any}, {"tendons", maps, described_tendon, any}};
constexpr AnswerWord described_leg[] = {
    {"base", map, described_base, any}, {"link", map, described_link, any}, {"closure", map, described_closure, any}};

constexpr AnswerWord root[] = {
    {"pose", map, pose, of_platforms | configuration, Want::pose}, {"pose", map, pose, of_arm_legs | configuration | path},
    {"tip", map, pose, of_serial | configuration}, {"tip", map, pose, of_arms | configuration | path}, {field::inputs, of_platforms | configuration},
    {field::configuration, of_serial | configuration}, {field::changes, of_serial | configuration}, {field::changes, arms_answer},
    {field::tensions, arms_answer}, {field::slack, arms_answer}, {field::slack, of_serial | asking({Ask::forward})},
    {field::motors, of_serial | configuration}, {field::motors, of_arms | configuration | path},
    {"sections", maps, spatial_pose, of_serial | configuration}, {"legs", maps, leg, of_platforms | configuration, Want::legs},
    {"legs", maps, leg, of_arm_legs | configuration | path}, {field::reached, of_arm_legs | configuration | path},
    {field::wrench, of_chains | loaded}, {field::wrench, of_rods | sensing}, {field::wrench, with_arms | sensing},
    {field::residual, all_robots | configuration | path}, {field::iterations, all_robots | configuration | path | identify}, {field::resolution, arms_answer},
    with("all", {{"count", number, "", "of solutions"}, all_robots | solving}), with("all", {field::complete, (all_robots & ~of_rods) | solving}),
    {field::complete, of_rods | solving}, with("all", {"solutions", maps, solution, all_robots | solving}),
    with("trace", {"trace", maps, iterate, of_kinematic | asking({Ask::forward})}),
    with("until", {{"load", number, "", "how many times the load could be added"}, elastic | with_arms | loaded}),
    with("until", {{"definite_until", number, "", "how many times it could until the stiffness is not definite"}, elastic | with_arms | loaded}),

    {field::energy, of_rods | configuration, Want::legs}, rare({field::potential, of_rods | configuration, Want::legs}),
    {field::potential, of_chains | loaded}, {field::potential, arms_answer},
    rare({{"linear", freedoms, "m, rad", "change of the pose by the linear model"}, of_chains | loaded, Want::legs}),
    rare({{"linear_error", number, "", "of the linear model of a load, relative"}, of_chains | loaded, Want::legs}),
    rare({{"posture_error", number, "rad", "largest turn of a joint by the load"}, of_chains | loaded, Want::legs}),
    rare(with("posture_threshold", {{"linear_valid", flag, "", "whether no joint turns further than `posture_threshold`"}, of_chains | loaded, Want::legs})),
    rare({{"cc_gap", number, "J", "energy of evenly bent links beyond that of chains"}, of_chains | loaded, Want::legs}),
    rare({{"cc_gap_estimate", number, "J", "its estimate by the load"}, of_chains | loaded, Want::legs}),
    rare({"cc_pose", map, pose, of_chains | loaded, Want::legs}),

    {{"J", jacobian, "m, m^2, 1, N/m, N, N m, rad/m", "J (twist) = K (input rates): of lines [m, m^2], of planes [1, m], of rods [N/m, N, N m], of serial robots the tip by its coordinates"}, of_platforms | of_serial | configuration, Want::velocity},
    {{"K", input_jacobian, "m, m^2, 1, N/m, N", "J (twist) = K (input rates): of lines [m, m^2], of planes [1, m], of rods [N/m, N], of serial robots tendons by coordinates"}, of_platforms | of_serial | configuration, Want::velocity},
    {field::U, of_platforms | with_arms | configuration | path, Want::velocity},
    {{"determinant", number, "", "of J: of n lines [m^4] in the plane, [m^(n + 3)] in space"}, on_arcs | configuration, Want::velocity},
    {"indices", map, indices, of_platforms | of_serial | configuration, Want::velocity}, {field::type_1, on_arcs | configuration, Want::velocity},
    {"type_2", map, type_2, of_platforms | configuration, Want::velocity},
    with("twist", {{"rates", AnswerShape::rates, "m/s, rad/s", "of the inputs, for a twist"}, of_platforms | of_serial | configuration, Want::velocity}),
    rare({field::twist, of_rods | configuration, Want::velocity}),
    with("along", {"type_2_distance", map, type_2_distance, of_kinematic | configuration, Want::velocity}),
    {{"steering", two_by_two, "", "of a serial robot: how fast its last section bends, by how fast its tip's axis turns"}, of_serial | configuration, Want::velocity},
    {{"answer_rates", tendons_by_inputs, "m/N, 1, N/m", "of an arm what its tendons answer, by what holds each"}, arms_answer, Want::velocity},

    {{"stiffness", square, "N/m, N, N m", "of the platform, inputs held"}, elastic | arms_answer, Want::stiffness},
    {field::compliance, of_chains | arms_answer, Want::stiffness},
    {{"answers_by_wrench", tendons_by_wrench, "m/N, 1/N, 1, 1/m", "of an arm what its tendons answer, by a wrench at its tip"}, arms_answer, Want::stiffness},
    {field::stable, of_rods | configuration, Want::stability}, always({field::stable, of_chains | arms_answer, Want::stability}),
    {field::unstable_directions, of_rods | configuration, Want::stability}, always({field::unstable_directions, of_chains | loaded, Want::stability}),
    always({{"smallest_eigenvalue", number, "", "of the Hessian of a chain's energy along what is free"}, of_chains | loaded, Want::stability}),
    {{"unstable", points, "", "twists of length 1 along which the platform's stiffness is negative"}, elastic | configuration, Want::stability},
    {{"unstable_legs", list, "", "legs that do not hold by themselves with the platform held, from 0"}, elastic | configuration, Want::stability},
    {{"buckling_margin", number, "", "of an arm: least ratio of its energy's second variation to the backbone's elastic one; 1 straight without load, 0 where it buckles"}, of_arms | configuration | path, Want::margins},
    {{"least_tension", number, "N", "of an arm's tendons"}, of_arms | configuration | path, Want::margins},
    {"margins", map, margins, elastic | configuration, Want::margins},
    {{"sensitivity", by_inputs, "1, rad/m, m", "of the pose by the inputs"}, of_platforms | configuration, Want::sensitivity},

    {field::lines, of_kinematic | configuration, Want::lines}, {field::lines, elastic | configuration, Want::shape},
    {{"backbones", polylines, "m", "points of each leg or of an arm"}, all_robots | configuration | path, Want::shape},
    {{"tendons", polylines, "m", "points of each tendon"}, all_robots | configuration | path, Want::shape},
    {{"base", points, "m", "points of the legs on the base"}, platforms | configuration | path, Want::shape},
    {{"platform", points, "m", "points of the legs on the platform"}, platforms | configuration | path, Want::shape},
    {{"places", list, "m", "of the points of an arm's backbone, along it from its base"}, arms_answer, Want::shape},
    {field::curvatures, arms_answer, Want::shape}, {"discs", maps, disc, of_serial | arms_answer, Want::shape},
    {"frames", maps, pose, all_robots | configuration | path, Want::shape},
    {{"tensions_along", points, "N", "of each tendon between motor and base, then from guide to guide to its end"}, of_arms | path, Want::shape},

    {field::covariance, elastic | with_arms | sensing},
    {{"wrench_sensitivity", square, "1, m", "of a sensed wrench by what was measured"}, elastic | with_arms | sensing},
    {field::condition, elastic | with_arms | sensing},
    {{"misfit", number, "", "of what was measured, in standard deviations"}, elastic | with_arms | sensing},

    {"rows", maps, row, all_robots | path}, {"reached", map, end, (all_robots & ~of_arm_legs) | path}, {"curves", maps, curve, elastic | path},
    {"equilibria", maps, row, elastic | path}, {field::end_tensions, of_arms | path}, {field::slipping, of_arms | path},
    {field::motor_work, of_arms | path}, {field::friction_loss, of_arms | path}, {"one_sided", maps, one_sided, of_arms | path, Want::velocity},
    with("motions", {"in_motion", map, in_motion, of_arms | path}),

    {field::margin, diagram}, {field::over_tension, diagram}, {field::amount, diagram}, {field::near_limit, diagram}, {field::partial, diagram},
    {{"conditional", flag, "", "of a diagram: whether an earlier section is not exact, so that this one may be elsewhere"}, diagram},
    {{"area", number, "", "of a diagram: within that boundary [rad2]"}, diagram},
    {as(list, field::bend), diagram}, {as(list, field::slack), diagram}, {"envelope", map, envelope, diagram}, {"frontiers", maps, frontier, diagram},
    {{"polygon", points, "rad", "of a diagram: bends that no tendon forbids"}, diagram},
    {{"boundary", points, "rad", "of a diagram: the same within the envelope"}, diagram},
    {{"outline", points, "rad", "of a diagram: where the section can be after earlier ones that are not exact"}, diagram},
    with("measured", {"measured", map, measured, diagram}),

    {field::rows, identify}, {{"blocks", number, "", "of identify: motions that rows share"}, identify},
    {{"folds", number, "", "of identify: parts that were held out in turn"}, identify},
    {{"noise", number, "m", "of identify: of a coordinate of the marker"}, identify},
    {"errors", map, errors, identify}, {"parameters", maps, parameter, identify}, {"flat", maps, flat, identify},
    {as(list, field::covariance), identify}, {"by_row", maps, fitted_row, identify}, {"map", map, tendon_map, identify},

    {{"gravity", list, "m/s^2", "of describe: that rods and arms are under"}, describe},
    {"home", map, pose, describe}, {field::length, describe}, {"legs", maps, described_leg, describe},
    {"sections", maps, described_section, describe}, {"tendons", maps, described_tendon, describe}, {"stretch", map, described_stretch, describe},
};
#pragma GCC diagnostic pop
// clang-format on

/// Whether all that is no map says what its numbers are.
constexpr bool says_what_it_is(AnswerGroup group) {
  return std::ranges::all_of(group, [](const AnswerWord& word) {
    const bool is_map = word.field.shape == map || word.field.shape == maps;
    return is_map ? word.below.count > 0 && says_what_it_is(word.below) : !word.field.meaning.empty();
  });
}
static_assert(says_what_it_is(root));

void collect(AnswerGroup group, std::vector<AnswerField>& fields) {
  for (const AnswerWord& word : group) {
    collect(word.below, fields);
    if (word.below.count == 0 &&
        std::ranges::find(fields, word.field.name, &AnswerField::name) == fields.end())
      fields.push_back(word.field);
  }
}

}  // namespace answer_table
}  // namespace

AnswerGroup answer_words() { return answer_table::root; }

std::vector<AnswerField> answer_fields() {
  std::vector<AnswerField> fields;
  answer_table::collect(answer_table::root, fields);
  return fields;
}

}  // namespace sinew::inline v1
