#include "query/fields/answer_fields.hpp"

#include <algorithm>
#include <array>

namespace sinew::inline v1 {
namespace {

// clang-format off
constexpr auto answer_table = [] {
using enum AnswerShape;
return std::array{
    AnswerField{"indices.position", number, "", "largest singular value of the upper rows of U"},
    AnswerField{"x", number, "m", "of a place in the plane"},
    AnswerField{"y", number, "m", "of a place in the plane"},
    AnswerField{"z", number, "m", "height of a platform"},
    AnswerField{"phi", number, "rad", "angle of a pose in the plane"},
    AnswerField{"position", triple, "m", "of a pose in space"},
    AnswerField{"quaternion", AnswerShape::quaternion, "", "of a pose in space, w first, w >= 0"},
    AnswerField{"tilt", number, "rad", "by which a platform's z axis leans"},
    AnswerField{"azimuth", number, "rad", "towards which it leans"},
    AnswerField{"torsion", number, "rad", "by which the platform turns about it"},
    AnswerField{"inputs", AnswerShape::inputs, "", "in leg order [m, rad]"},
    AnswerField{"residual", number, "", "largest error of what was solved: [m], of robots on rods without unit"},
    AnswerField{"iterations", number, "", "of the solver"},
    AnswerField{"closure_error", number, "m", "by which a leg fails to close"},

    AnswerField{"curvature", number, "1/m", "of a leg, signed"},
    AnswerField{"chord", number, "m", "from a leg's base to its tip"},
    AnswerField{"tendon_lengths", pair, "m", "of both tendons of a leg"},
    AnswerField{"base_tangent", direction, "rad", "of a leg: in the plane its angle, in space a unit vector"},
    AnswerField{"joint_angles", pair, "rad", "of a leg's universal joint"},
    AnswerField{"angles", joints, "rad", "of a chain's joints"},
    AnswerField{"slide", number, "m", "of a leg on a rail"},
    AnswerField{"carriage", vector, "m", "where a leg's carriage is"},
    AnswerField{"hinge_angle", number, "rad", "of a strut from its rail"},
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
    AnswerField{"tip_wrench", freedoms, "", "of a chain's joints at its tip [N, N m]"},
    AnswerField{"motor_torque", number, "N m", "of a leg's motor"},
    AnswerField{"energy", number, "J", "of rods"},
    AnswerField{"cc_gap", number, "J", "energy of evenly bent links beyond that of chains"},
    AnswerField{"cc_gap_estimate", number, "J", "its estimate by the load"},
    AnswerField{"posture_error", number, "rad", "largest turn of a joint by the load"},
    AnswerField{"potential", number, "J", "of rods or chains, and of the load; of arms elastic, of weight and dead forces and of tendons that stretch, without the motors that hold tensions"},

    AnswerField{"J", jacobian, "", "J (twist) = K (input rates)"},
    AnswerField{"K", input_jacobian, "", "J (twist) = K (input rates)"},
    AnswerField{"U", sensitivities, "", "inverse of J, times K"},
    AnswerField{"rates", AnswerShape::rates, "", "of the inputs, for a twist [m/s, rad/s]"},
    AnswerField{"twist", freedoms, "", "of the platform, for rates [m/s, rad/s]"},
    AnswerField{"steering", two_by_two, "", "of a serial robot's tip"},
    AnswerField{"point", vector, "m", "that lines of legs have in common, or on an axis"},
    AnswerField{"direction", vector, "", "of an axis"},
    AnswerField{"wrench", freedoms, "", "of the world on the platform [N, N m]"},
    AnswerField{"stiffness", square, "", "of the platform, inputs held"},
    AnswerField{"compliance", square, "", "its inverse"},
    AnswerField{"covariance", square, "", "of a sensed wrench"},
    AnswerField{"wrench_sensitivity", square, "", "of a sensed wrench by what was measured"},
    AnswerField{"sensitivity", by_inputs, "", "of the pose by the inputs"},
    AnswerField{"linear", freedoms, "", "change of the pose by the linear model [m, rad]"},

    AnswerField{"configuration", bends, "rad", "of each section: two angles, and where its length varies its extension [m]"},
    AnswerField{"changes", tendons, "m", "of each tendon, > 0 pays out"},
    AnswerField{"end_tensions", tendons, "N", "of each tendon where it is fixed: what friction leaves of its tension"},
    AnswerField{"motor_work", number, "J", "of the motors of an arm's tendons, of a row since the one before"},
    AnswerField{"friction_loss", number, "J", "at the guides of an arm's tendons, of a row since the one before"},
    AnswerField{"motors", tendons, "", "counts of each tendon's motor"},
    AnswerField{"slack", tendons, "m", "of each tendon"},
    AnswerField{"resolution", number, "m", "by how much finer polynomials move an arm's tip"},
    AnswerField{"buckling_margin", number, "", "of an arm: least ratio of its energy's second variation to the backbone's elastic one; 1 straight without load, 0 where it buckles"},
    AnswerField{"least_tension", number, "N", "of an arm's tendons"},
    AnswerField{"answer_rates", input_jacobian, "", "of an arm what its tendons answer, by what holds each"},
    AnswerField{"answers_by_wrench", input_jacobian, "", "the same by a wrench at its tip"},
    AnswerField{"condition", number, "", "of J; of a sensed wrench how much better its best known direction is known than its worst"},
    AnswerField{"misfit", number, "", "of what was measured, in standard deviations"},
    AnswerField{"margin", number, "m", "of a diagram: to the next tendon that goes slack"},
    AnswerField{"over_tension", number, "m", "of a diagram: by which tendons are too short"},
};
}();
// clang-format on

/// Without the indices at its end.
std::string_view without_indices(std::string_view place) {
  while (place.ends_with(']') && place.rfind('[') != std::string_view::npos)
    place = place.substr(0, place.rfind('['));
  return place;
}

}  // namespace

std::span<const AnswerField> answer_fields() { return answer_table; }

const AnswerField* find_answer_field(std::string_view place) {
  place = without_indices(place);
  const auto found = std::ranges::find_if(answer_table, [&](const AnswerField& field) {
    return place.ends_with(field.name) &&
           (place.size() == field.name.size() || place[place.size() - field.name.size() - 1] == '.');
  });
  return found == answer_table.end() ? nullptr : &*found;
}

}  // namespace sinew::inline v1
