#include "query/fields/answer_fields.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace sinew::inline v1 {
namespace {

// clang-format off
constexpr auto answer_table = [] {
using enum AnswerShape;
return std::array{
    // Names of more than one word come before those of one, which would be found in their place.
    AnswerField{"indices.position", number, "", "largest singular value of the upper rows of U"},
    AnswerField{"rows.point", number, "", "of a path of inputs: the point on the way to which a row is, from 0"},
    AnswerField{"reached.point", number, "", "the same of where a path ended"},
    AnswerField{"in_motion.changes", tendons, "m/s", "of each tendon, as those that hold them go on"},
    AnswerField{"in_motion.tensions", tendons, "N/s", "at each motor, as those that hold tendons go on"},
    AnswerField{"growing.twist", freedoms, "", "of an arm's tip as what holds a tendon grows, by that: [m/N, rad/N], of a change [1, rad/m]"},
    AnswerField{"growing.changes", tendons, "", "of each tendon as what holds one grows, by that [m/N], of a change [1]"},
    AnswerField{"growing.tensions", tendons, "", "at each motor as what holds a tendon grows, by that [1], of a change [N/m]"},
    AnswerField{"shrinking.twist", freedoms, "", "of an arm's tip as what holds a tendon shrinks, by as much of that as growing"},
    AnswerField{"shrinking.changes", tendons, "", "of each tendon as what holds one shrinks, by as much of that as growing"},
    AnswerField{"shrinking.tensions", tendons, "", "at each motor as what holds a tendon shrinks, by as much of that as growing"},
    AnswerField{"type_2_distance.distance", number, "", "along a direction to a singularity of type II: as many times that twist"},
    AnswerField{"type_2_distance.reached", number, "", "along a direction that was looked at, as many times that twist"},
    AnswerField{"reached.part", number, "", "of the way from the pose before, at most 1"},
    AnswerField{"reached.rows", number, "", "rows of a path that were answered"},
    AnswerField{"discs.radius", number, "m", "of a disc that is drawn"},
    AnswerField{"discs.height", number, "m", "of a disc that is drawn"},
    AnswerField{"margins.fold", number, "", "smallest part of the platform's stiffness over the largest, 0 at a fold"},
    AnswerField{"margins.strain", number, "", "largest bending strain of a link"},
    AnswerField{"curves.from.curve", number, "", "the curve that another one branches off, from 0"},
    AnswerField{"curves.from.row", number, "", "its row there, from 0"},
    AnswerField{"equilibria.curve", number, "", "on which curve an equilibrium is, from 0"},
    AnswerField{"equilibria.row", number, "", "in which of its rows, from 0"},
    AnswerField{"frontiers.curve", list, "", "of a diagram: points of the limit of a tendon [rad, of lengths m]"},
    AnswerField{"tendons.compliance", number, "m/N", "of describe: of a tendon of an arm"},
    AnswerField{"stretch.stiffness", number, "N", "of describe: EA of a serial robot's tendons"},
    AnswerField{"x", number, "m", "of a place in the plane"},
    AnswerField{"y", number, "m", "of a place in the plane"},
    AnswerField{"z", number, "m", "height of a platform"},
    AnswerField{"phi", number, "rad", "angle of a pose in the plane"},
    AnswerField{"position", triple, "m", "of a pose in space"},
    AnswerField{"quaternion", AnswerShape::quaternion, "", "of a pose in space, w first, w >= 0"},
    AnswerField{"tilt", number, "rad", "by which a platform's z axis leans"},
    AnswerField{"azimuth", number, "rad", "towards which it leans"},
    AnswerField{"torsion", number, "rad", "by which the platform turns about it"},
    AnswerField{"inputs", AnswerShape::inputs, "m, rad", "in leg order"},
    AnswerField{"residual", number, "", "largest error of what was solved: [m], of robots on rods without unit"},
    AnswerField{"iterations", number, "", "of the solver"},
    AnswerField{"closure_error", number, "m", "by which a leg fails to close"},
    AnswerField{"step", number, "", "of an iterate: the fraction of the step that was taken"},
    AnswerField{"iteration", number, "", "of an iterate: which it is, from 0"},
    AnswerField{"count", number, "", "of solutions"},
    AnswerField{"part", number, "", "of the way to the next pose or point, at most 1"},
    AnswerField{"reached", number, "", "of platforms on arms: share of the way up to which there was an equilibrium that holds"},
    AnswerField{"load", number, "", "how many times the load could be added"},
    AnswerField{"definite_until", number, "", "how many times it could until the stiffness is not definite"},
    AnswerField{"parameter", number, "", "of a row of a curve: 0 at its beginning, 1 at what it leads to"},
    AnswerField{"unstable_directions", number, "", "in which an equilibrium does not hold by itself"},
    AnswerField{"smallest_eigenvalue", number, "", "of the Hessian of a chain's energy along what is free"},
    AnswerField{"linear_error", number, "", "of the linear model of a load, relative"},
    AnswerField{"steps", number, "", "of progress: steps of a fit so far"},
    AnswerField{"error", number, "m", "of progress: root mean square of a fit's distances so far"},

    AnswerField{"backbones", list, "m", "points of each leg or of an arm"},
    AnswerField{"tendons", list, "m", "points of each tendon"},
    AnswerField{"lines", list, "m", "ends of the segments along which legs pull"},
    AnswerField{"base", list, "m", "points of the legs on the base"},
    AnswerField{"platform", list, "m", "points of the legs on the platform"},
    AnswerField{"places", list, "m", "of the points of an arm's backbone, along it from its base"},
    AnswerField{"curvatures", list, "1/m", "of an arm or of its legs at these points, or means of equal parts"},

    AnswerField{"curvature", number, "1/m", "of a leg, signed"},
    AnswerField{"chord", number, "m", "from a leg's base to its tip"},
    AnswerField{"tendon_lengths", pair, "m", "of both tendons of a leg"},
    AnswerField{"base_tangent", direction, "rad", "of a leg: in the plane its angle, in space a unit vector"},
    AnswerField{"joint_angles", pair, "rad", "of a leg's universal joint"},
    AnswerField{"angles", joints, "rad", "of a chain's joints"},
    AnswerField{"slide", number, "m", "of a leg on a rail"},
    AnswerField{"carriage", vector, "m", "where a leg's carriage is"},
    AnswerField{"hinge_angle", number, "rad", "of a strut from its rail"},
    AnswerField{"elbow", number, "", "of a leg: to which side its strut is turned, 1 or -1"},
    AnswerField{"length", number, "m", "of a rod"},
    AnswerField{"force", vector, "N", "of the platform on a leg's tip, base axes"},
    AnswerField{"force_0", vector, "N", "on a rod in its guide, base axes"},
    AnswerField{"moment", triple, "N m", "of the platform on a rod's tip, base axes"},
    AnswerField{"moment_0", triple, "N m", "on a rod in its guide, base axes"},
    AnswerField{"curvature_0", pair, "1/m", "of a rod in its guide, about x and y of base axes"},
    AnswerField{"tip", vector, "m", "of a rod; of a serial robot a pose"},
    AnswerField{"tip_angle", number, "rad", "of a rod's tip tangent from that in the guide"},
    AnswerField{"tensions", pair, "N", "of both tendons of a leg"},
    AnswerField{"chord_force", number, "N", "by which a leg pulls the platform"},
    AnswerField{"tip_wrench", freedoms, "N, N m", "of a chain's joints at its tip"},
    AnswerField{"motor_torque", number, "N m", "of a leg's motor"},
    AnswerField{"energy", number, "J", "of rods"},
    AnswerField{"cc_gap", number, "J", "energy of evenly bent links beyond that of chains"},
    AnswerField{"cc_gap_estimate", number, "J", "its estimate by the load"},
    AnswerField{"posture_error", number, "rad", "largest turn of a joint by the load"},
    AnswerField{"potential", number, "J", "of rods or chains, and of the load; of arms elastic, of weight and dead forces and of tendons that stretch, without the motors that hold tensions"},

    AnswerField{"J", jacobian, "m, m^2, 1, N/m, N, N m, rad/m", "J (twist) = K (input rates): of lines [m, m^2], of planes [1, m], of rods [N/m, N, N m], of serial robots the tip by its coordinates"},
    AnswerField{"K", input_jacobian, "m, m^2, 1, N/m, N", "J (twist) = K (input rates): of lines [m, m^2], of planes [1, m], of rods [N/m, N], of serial robots tendons by coordinates"},
    AnswerField{"U", sensitivities, "1, rad/m, m, m/N, rad/N", "inverse of J, times K"},
    AnswerField{"rates", AnswerShape::rates, "m/s, rad/s", "of the inputs, for a twist"},
    AnswerField{"twist", freedoms, "m/s, rad/s", "of the platform, for rates"},
    AnswerField{"steering", two_by_two, "", "of a serial robot's tip"},
    AnswerField{"determinant", number, "", "of J, unit lines"},
    AnswerField{"rotation", number, "", "largest singular value of the lower rows of U"},
    AnswerField{"condition_homogenised", number, "", "of J, its rotations times a length"},
    AnswerField{"rank", number, "", "of the legs' lines"},
    AnswerField{"type_2.point", vector, "m", "that lines of legs have in common"},
    AnswerField{"axis.point", vector, "m", "on an axis"},
    AnswerField{"base.point", vector, "m", "where a leg begins"},
    AnswerField{"point", pair, "rad", "of a diagram: the bend that meets the tendons best"},
    AnswerField{"direction", vector, "", "of an axis"},
    AnswerField{"wrench", freedoms, "N, N m", "of the world on the platform"},
    AnswerField{"stiffness", square, "N/m, N, N m", "of the platform, inputs held"},
    AnswerField{"compliance", square, "m/N, 1/N, rad/N, rad/(N m)", "its inverse"},
    AnswerField{"covariance", square, "", "of a sensed wrench [N^2, N^2 m, N^2 m^2]; of identify, of what was fitted"},
    AnswerField{"wrench_sensitivity", square, "1, m", "of a sensed wrench by what was measured"},
    AnswerField{"sensitivity", by_inputs, "1, rad/m, m", "of the pose by the inputs"},
    AnswerField{"linear", freedoms, "m, rad", "change of the pose by the linear model"},

    AnswerField{"configuration", bends, "rad", "of each section: two angles, and where its length varies its extension [m]"},
    AnswerField{"changes", tendons, "m", "of each tendon, > 0 pays out"},
    AnswerField{"end_tensions", tendons, "N", "of each tendon where it is fixed: what friction leaves of its tension"},
    AnswerField{"tensions_along", list, "N", "of each tendon between motor and base, then from guide to guide to its end"},
    AnswerField{"slipping", number, "", "at how many guides tendons slip"},
    AnswerField{"changes_by_inputs", input_jacobian, "m/N, 1", "of an arm in motion: how fast each tendon changes, by what holds each"},
    AnswerField{"tensions_by_inputs", input_jacobian, "1, N/m", "the same of tensions at the motors"},
    AnswerField{"changes_by_wrench", input_jacobian, "m/N, 1/N", "how fast each tendon changes, by a wrench at the tip"},
    AnswerField{"tensions_by_wrench", input_jacobian, "1, 1/m", "the same of tensions at the motors"},
    AnswerField{"least", tendons, "N/s, m/s", "rate of each tendon down to which the same guides slip"},
    AnswerField{"most", tendons, "N/s, m/s", "rate of each tendon up to which they do"},
    AnswerField{"motor_work", number, "J", "of the motors of an arm's tendons, of a row since the one before"},
    AnswerField{"friction_loss", number, "J", "at the guides of an arm's tendons, of a row since the one before"},
    AnswerField{"motors", tendons, "", "counts of each tendon's motor"},
    AnswerField{"slack", tendons, "m", "of each tendon"},
    AnswerField{"resolution", number, "m", "by how much finer polynomials move an arm's tip"},
    AnswerField{"buckling_margin", number, "", "of an arm: least ratio of its energy's second variation to the backbone's elastic one; 1 straight without load, 0 where it buckles"},
    AnswerField{"least_tension", number, "N", "of an arm's tendons"},
    AnswerField{"answer_rates", input_jacobian, "m/N, 1, N/m", "of an arm what its tendons answer, by what holds each"},
    AnswerField{"answers_by_wrench", input_jacobian, "m/N, 1/N, 1, 1/m", "the same by a wrench at its tip"},
    AnswerField{"condition", number, "", "of J; of a sensed wrench how much better its best known direction is known than its worst"},
    AnswerField{"misfit", number, "", "of what was measured, in standard deviations"},
    AnswerField{"margin", number, "m", "of a diagram: to the next tendon that goes slack"},
    AnswerField{"over_tension", number, "m", "of a diagram: by which tendons are too short"},
    AnswerField{"amount", number, "", "of a diagram: the most that a tendon has too much or lacks [m]; unreachable: what is asked for, as the limit"},
    AnswerField{"limit", number, "", "of a diagram: size of its envelope [rad], of actuators [m]"},
    AnswerField{"normal", pair, "", "of a diagram: of the half-plane that a tendon allows"},
    AnswerField{"offset", number, "", "of a diagram: its distance from the straight section"},
    AnswerField{"polygon", list, "rad", "of a diagram: bends that no tendon forbids"},
    AnswerField{"boundary", list, "rad", "of a diagram: the same within the envelope"},
    AnswerField{"outline", list, "rad", "of a diagram: where the section can be after earlier ones that are not exact"},
    AnswerField{"area", number, "", "of a diagram: within that boundary [rad2]"},
};
}();
// clang-format on

/// Its words alone, `rows.point` of `rows[3].point`.
std::string without_indices(std::string_view place) {
  std::string words;
  bool is_index = false;
  for (const char c : place) {
    if (c == '[') is_index = true;
    if (!is_index) words += c;
    if (c == ']') is_index = false;
  }
  return words;
}

}  // namespace

std::span<const AnswerField> answer_fields() { return answer_table; }

const AnswerField* find_answer_field(std::string_view place) {
  const std::string words = without_indices(place);
  const auto found = std::ranges::find_if(answer_table, [&](const AnswerField& field) {
    return words.ends_with(field.name) &&
           (words.size() == field.name.size() || words[words.size() - field.name.size() - 1] == '.');
  });
  return found == answer_table.end() ? nullptr : &*found;
}

}  // namespace sinew::inline v1
