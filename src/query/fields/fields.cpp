#include "query/fields/fields.hpp"

#include <algorithm>
#include <array>

#include "base/same_name.hpp"

namespace sinew::inline v1 {
namespace {

using Words = std::string_view[];

constexpr unsigned of_loads = of_chains | of_rods;
/// Of arms by pcc and lsk, too.
constexpr unsigned of_sections = of_serial | of_arms;

constexpr FieldUses of_arm_questions{
    .forward = of_arms, .inverse = of_arms, .velocity = of_arms, .shape = of_arms, .statics = of_arms};
constexpr FieldUses of_arm_paths = [] {
  FieldUses uses = of_arm_questions;
  uses.track = of_arms;
  return uses;
}();
constexpr FieldUses always{.forward = of_all | of_arms,
                           .inverse = of_all | of_arms,
                           .velocity = of_all | of_arms,
                           .shape = of_all | of_arms,
                           .statics = of_loads | of_arms,
                           .track = of_platforms | of_arms,
                           .diagram = of_sections,
                           .identify = of_arms,
                           .describe = of_all | of_arms};

constexpr Words models = {"cc", "prb", "rigid", "rod", "pcc", "lsk", "subsegment_rod", "subsegment_cc"},
                thetas = {"tangent", "chord"}, laws = {"M0w", "M0", "M1"}, holds = {"tension", "length"},
                objectives = {"limits", "singularity", "smooth", "none"},
                envelopes = {"square", "disc", "actuator"},
                balances = {"energy", "projected", "collocated", "closed_form"},
                wants = {"pose",      "legs",    "velocity",    "shape", "stiffness",
                         "stability", "margins", "sensitivity", "lines"};

constexpr FieldUses of_models = [] {
  FieldUses uses = always;
  uses.describe = of_platforms | of_arms;
  return uses;
}();
constexpr FieldUses branches{.inverse = of_kinematic | of_chains,
                             .velocity = of_kinematic | of_chains,
                             .shape = of_kinematic | of_chains,
                             .statics = of_chains,
                             .track = of_kinematic | of_chains};

// clang-format off
constexpr auto table = [] {
using enum FieldShape;
using enum Dimension;
return std::array{
    Field{"query", word, number, always, "the kind of question", ask_words},
    Field{"id", text_or_number, number, always, "repeated in the answer"},
    Field{"model", word, number, of_models,
          "how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default), subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a serial robot, without loads", models},
    Field{"set", settings, number, always, "changes the robot for this question alone: values by their paths in its file, such as legs[0].link.length; on the command line it may be repeated"},
    Field{"theta_is", word, number, always, "what an input theta is the angle of: tangent (default) or chord", thetas},
    Field{"law", word, number,
          {.forward = of_chains, .inverse = of_chains, .velocity = of_chains, .shape = of_chains, .statics = of_chains, .track = of_chains, .describe = of_chains},
          "how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1 (tendons straight between discs)", laws},
    Field{"max_iterations", whole, count, always, "most iterations of the solver; default 100, of arms 200 in each search, of legs of sections 2000, of rods 4000, of identify 60"},
    Field{"tilt", flag, number, always, "poses of the answer have tilt, azimuth and torsion, too; in space only"},

    Field{"inputs", FieldShape::inputs, length, {.forward = of_platforms, .velocity = of_kinematic | of_rods, .shape = of_platforms, .statics = of_loads, .track = of_rods},
          "in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its length; where the leg has a motor, theta, an angle, before it"},
    Field{"pose", FieldShape::pose, length, {.inverse = of_all | of_arms, .velocity = of_platforms, .shape = of_platforms, .statics = of_chains | of_arms, .track = of_rods},
          "of the platform, of a serial robot of its tip; of statics of legs of sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in space x, y, z and a quaternion, on the command line also a rotation vector"},
    Field{"independent", FieldShape::independent, length, {.inverse = of_kinematic | of_rods, .velocity = of_kinematic | of_rods, .shape = of_platforms, .track = of_rods},
          "in place of `pose` where hinges hold the platform in planes, or three rods hold it: height and two components of its quaternion; of hinges a mode, too, tilt or half_turn"},
    Field{"bending", signs, number, branches, "sign of each leg's curvature"},
    Field{"elbow", signs, number, branches, "side to which the strut of each leg turns, where the leg has a motor or a rail"},
    Field{"curvature", per_leg, Dimension::curvature, branches, "a curvature for each leg; the nearest solution is taken"},
    Field{"angles", lists, angle, {.velocity = of_chains, .shape = of_chains, .track = of_chains},
          "of the joints of each chain, from the first sprung one; before them the direction of a first link that a motor turns"},
    Field{"start", FieldShape::start, length,
          {.forward = of_platforms | of_arms, .inverse = of_kinematic | of_rods | of_serial | of_arms, .velocity = of_kinematic | of_rods | of_arms, .shape = of_platforms | of_arms, .statics = of_loads | of_arms, .track = of_platforms | of_arms},
          "where the search begins: a pose, of inverse and track inputs, of a serial robot its configuration, of an arm the mean curvatures and torsion of equal parts, as `all` tells them of each solution, of a platform on legs of sections a solution's pose and curvatures, or last, where the last question with a start ended, of `track` of an arm where its last path did, with what friction remembers; default the robot's home"},
    Field{"set_at", FieldShape::pose, length, {.statics = of_chains, .track = of_chains},
          "the pose at which the tendons are set without load, the outer ones loose"},
    Field{"hold", word, number, {.statics = of_chains, .track = of_chains}, "what stays after `set_at` or with `pose`: tension (default) or length", holds},
    Field{"tensions", lists, force, {.forward = of_arms, .velocity = of_arms, .shape = of_arms, .statics = of_chains | of_arms, .track = of_chains}, "of both tendons of each leg; of an arm those of each section, of legs of sections those of leg 0 first, null for a tendon that `changes` has"},
    Field{"lengths", pairs, length, {.statics = of_chains, .track = of_chains}, "of the tendon of each leg whose length is held; null, on the command line -, leaves the other one loose"},
    Field{"inverse", flag, number, {.statics = of_chains}, "`pose` is held under the load, and the tensions for it answered"},
    Field{"axial_forces", numbers, force, {.statics = of_rods}, "what each of six rods pulls at its guide; answers the wrench on the platform"},
    Field{"measured_tensions", per_leg, force, {.statics = of_chains | of_arms}, "what the tendons at `lengths` pull, a leg each, of an arm those at `changes`, one each; answers the wrench on the platform"},
    Field{"deviation", quantity, force, {.statics = of_loads | of_arms}, "standard deviation of what is measured, one for all or one each; answers how well the wrench is known"},

    Field{"wrench", FieldShape::wrench, force, {.forward = of_loads | of_arms, .inverse = of_loads | of_arms, .velocity = of_rods | of_arms, .shape = of_loads | of_arms, .statics = of_chains | of_arms, .track = of_loads | of_arms},
          "force and moment on the platform, about its reference point, of an arm on its tip, in base axes"},
    Field{"gravity", point, acceleration, {.forward = of_rods | of_arms, .inverse = of_rods | of_arms, .velocity = of_rods | of_arms, .shape = of_rods | of_arms, .statics = of_rods | of_arms, .track = of_rods | of_arms},
          "of rods, arms and platforms that have a mass [m/s2]; default the file's"},
    Field{"until", growing_load, force, {.forward = of_loads | of_arms, .statics = of_chains},
          "a wrench that is added again and again until the robot buckles, up to `limit` times"},
    Field{"posture_threshold", quantity, angle, {.forward = of_chains, .statics = of_chains}, "turn of a joint up to which the linear model counts as valid"},

    Field{"want", words, number, {.forward = of_all | of_arms, .inverse = of_all | of_arms, .velocity = of_all | of_arms, .shape = of_kinematic | of_rods | of_serial | of_arms, .statics = of_loads | of_arms, .track = of_arms},
          "what is answered about the configuration: velocity, shape, stiffness, stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them is named", wants},
    Field{"all", flag, number, {.forward = of_platforms | of_arms, .inverse = of_all}, "every solution, not only the one wanted"},
    Field{"trace", flag, number, {.forward = of_kinematic}, "the residual of each iterate is answered, too"},
    Field{"twist", FieldShape::twist, number, {.forward = of_all, .inverse = of_all, .velocity = of_all, .shape = of_kinematic | of_rods | of_serial, .statics = of_loads},
          "velocity and turning rate of the platform or the tip, in space three each, of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs; with the want velocity"},
    Field{"rates", FieldShape::inputs, number, {.forward = of_rods, .inverse = of_rods, .velocity = of_rods, .shape = of_rods, .statics = of_rods},
          "of the inputs, in place of `twist`; answers the twist of the platform"},
    Field{"along", FieldShape::twist, number, {.forward = of_kinematic, .inverse = of_kinematic, .velocity = of_kinematic, .shape = of_kinematic},
          "a direction in which the nearest type II is looked for; with the want velocity"},
    Field{"limit", quantity, number, {.forward = of_kinematic, .inverse = of_kinematic, .velocity = of_kinematic, .shape = of_kinematic, .diagram = of_sections},
          "how far to look `along` its direction; of a diagram the envelope's size"},
    Field{"samples", whole, count, {.forward = of_kinematic | of_rods | of_serial | of_arms, .inverse = of_kinematic | of_rods | of_serial | of_arms, .velocity = of_kinematic | of_rods | of_serial | of_arms, .shape = of_kinematic | of_rods | of_serial | of_arms, .statics = of_rods | of_arms, .track = of_platforms | of_arms},
          "points of each backbone of a shape; poses on a path, default 60; points on a curve, at most, default 500"},

    Field{"configuration", lists, angle, {.forward = of_serial, .velocity = of_serial, .shape = of_serial},
          "of a serial robot two angles a section: theta, phi of a neutral backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its extension; sections not given are straight"},
    Field{"changes", lists, length, {.forward = of_serial | of_arms, .velocity = of_serial | of_arms, .shape = of_serial | of_arms, .statics = of_arms, .diagram = of_sections},
          "of a serial robot or an arm the change of each tendon, > 0 pays out, section after section, of legs of sections leg after leg"},
    Field{"slack", numbers, length, {.forward = of_serial},
          "what the tendons of each section are paid out beyond its configuration; < 0 stiffens"},
    Field{"position", point, length, {.inverse = of_serial | of_arms, .statics = of_arms}, "of the tip of a serial robot or an arm, or of the platform on legs of sections; of statics where it was seen"},
    Field{"direction", point, number, {.inverse = of_serial | of_arms}, "in which the tip of a serial robot or an arm points, or the z axis of the platform on legs of sections"},
    Field{"section", whole, count, {.diagram = of_sections}, "which section, from 0"},
    Field{"measured", lists, length, {.diagram = of_sections}, "changes that encoders read, beside those commanded"},
    Field{"tolerance", quantity, length, {.diagram = of_sections}, "of a tendon before it counts as slack or too short; default the file's"},
    Field{"envelope", word, number, {.diagram = of_sections}, "bends that a section is allowed: square, disc or actuator; default its limit", envelopes},

    Field{"following", FieldShape::wrench, force, of_arm_paths, "force and moment on an arm's tip, or on the platform on legs of sections, in its own axes, with which they turn"},
    Field{"distributed", point, number, of_arm_paths, "force on all of an arm's backbone, or on those of all legs of sections, in base axes [N/m]"},
    Field{"distributed_following", point, number, of_arm_paths, "the same in the backbone's own axes [N/m]; in the plane x to its right and y along it"},
    Field{"loads", point_loads, number, of_arm_paths, "on an arm's backbone: a list of place, from the base along it, wrench and, where it turns with the place, following; on legs of sections with the leg, from 0"},
    Field{"balance", word, number, of_arm_paths, "how an arm's equilibrium is written: energy (default), or as published models have it: projected, collocated, closed_form; a path knows energy alone", balances},
    Field{"order", whole, count, of_arm_paths, "of the polynomials of an arm's strain, 0 to 9, without refinement; default as `accuracy` needs (docs/arm-models.md)"},
    Field{"elements", whole, count, of_arm_paths, "of each section (rod) or between two discs (subsegment_rod), without refinement; joints between two discs (prb); default as `order` or `accuracy` needs"},
    Field{"accuracy", quantity, number, of_arm_paths, "of an arm's tip to which polynomials are refined, over its length, above 0 and up to 1; default 1e-6. Without refinement give elements"},
    Field{"tension_limit", quantity, force, {.inverse = of_arms}, "most that a tendon may pull"},
    Field{"force_alone", flag, number, {.statics = of_arms}, "the wrench that is sensed has no moment; default true"},

    Field{"poses", places, length, {.track = of_platforms}, "the path, pose by pose"},
    Field{"points", path_points, number, {.track = of_arms},
          "the path of an arm, whose tendons rub, or of a platform on legs of sections, whose tendons do not: a list of tensions or changes, as `forward` takes them, of such a platform also of a pose, and where they change wrench, following, distributed, distributed_following, loads, gravity"},
    Field{"steps", whole, count, {.track = of_arms}, "even ones to each point of an arm's path, a row each; default 10; finer ones tell more of what slips first"},
    Field{"motions", lists, number, {.track = of_arms}, "of the tendons of each section of an arm in which direction, and how fast [N/s, m/s], what holds them goes on where the path ends: a change > 0 pays out, null rests. The answer has the rates there, with friction, as matrices"},
    Field{"from", place, length, {.track = of_platforms}, "first pose of a path, of rods with three inputs z, e1 and e2"},
    Field{"to", target, length, {.track = of_platforms}, "last pose of a path; of a curve of equilibria what changes along it: inputs, tensions, lengths, wrench, pose"},
    Field{"objective", word, number, {.track = of_kinematic | of_chains}, "what redundant legs do with their freedom: limits, singularity, smooth or none", objectives},
    Field{"rk4_steps", whole, count, {.track = of_chains}, "Runge-Kutta steps between poses; default the flow itself"},
    Field{"range", FieldShape::range, number, {.track = of_loads}, "how far a curve goes: 0 is its beginning, 1 what it leads to; default [0, 1]"},
    Field{"backward", flag, number, {.track = of_loads}, "a curve sets out the other way"},
    Field{"branches", flag, number, {.track = of_loads}, "curves that leave it at bifurcations are followed, too"},

    Field{"rows", measured_rows, number, {.identify = of_arms},
          "what was measured of an arm: pulls, a row each of what every motor draws in [m], markers, a row each of a marker's x, y, z [m], where known time [s], and blocks, whole numbers that rows of one motion share; or the text of a .csv table (docs/identify.md)"},
    Field{"fit", names, number, {.identify = of_arms},
          "what may change, such as sections.bending,tendons.offset,marker; default what rows can usually tell (docs/identify.md)"},
    Field{"noise", quantity, length, {.identify = of_arms}, "of a coordinate of the marker; default what the fit leaves"},
    Field{"folds", whole, count, {.identify = of_arms}, "in how many parts blocks of rows are held out in turn, and judged by a fit without them; default 5, 0 for none"},
    Field{"map", flag, number, {.identify = of_arms}, "motors and axes are taken as the rows say, should pulls be paid out, or tendons turned or the other way round"},
};
}();
// clang-format on

}  // namespace

std::span<const Field> question_fields() { return table; }

const Field* find_field(std::string_view name) {
  const auto found =
      std::ranges::find_if(table, [&](const Field& field) { return is_same_name(field.name, name); });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace sinew::inline v1
