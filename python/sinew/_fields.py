"""Fields of questions, in one table. Keywords' help, the stubs of the methods (tools/python_stubs.py) and what an
array's dimensions mean come from it; the library alone judges what a robot takes. docs/protocol.md has the details.
"""
from typing import NamedTuple


class Kind(NamedTuple):
    type: str
    """As a type of _types.py."""
    rank: int
    """Dimensions of one value; an array with one more holds a column."""
    text: str


KINDS = {
    "number": Kind("Number", 0, "a number, or text with a unit"),
    "numbers": Kind("Numbers", 1, "shape (k,); (n, k) for n rows"),
    "lists": Kind("Lists", 2, "a list each"),
    "pose": Kind("Pose", 0, "a pose"),
    "poses": Kind("Sequence[Pose]", 0, "poses"),
    "map": Kind("Mapping[str, Any]", 0, "a dict"),
    "word": Kind("str", 0, "a word"),
    "words": Kind("Sequence[str]", 0, "words"),
    "flag": Kind("bool", 0, "true or false"),
    "count": Kind("int", 0, "a whole number"),
    "any": Kind("Any", 1, "several forms"),
}


class Field(NamedTuple):
    name: str
    kind: str
    unit: str
    text: str


def _fields(*rows: tuple[str, str, str, str]) -> dict[str, Field]:
    return {row[0]: Field(*row) for row in rows}


FIELDS = _fields(
    ("inputs", "numbers", "m, rad", "what the motors command, in the order of robot.inputs: (k,), or (n, k) for n rows"),
    ("configuration", "lists", "rad, m", "of serial robots: the bend of each section, [theta, phi] or [beta_1, beta_2]"),
    ("changes", "lists", "m", "of serial robots: length paid out, a list a section, a value a tendon"),
    ("slack", "numbers", "m", "beside `configuration`: a length a section, paid out to all its tendons"),
    ("pose", "pose", "m, rad", "of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion (4,) [w, x, y, z]}"),
    ("independent", "map", "m", "in place of `pose` where three legs hold the platform: {z, e1, e2}"),
    ("position", "numbers", "m", "of serial robots: the tip's place in the base frame, (3,)"),
    ("direction", "numbers", "", "of serial robots: the tip's axis in the base frame, (3,)"),
    ("bending", "numbers", "", "branch: +1 or -1 a leg, the sign of its curvature, (legs,)"),
    ("curvature", "numbers", "1/m", "branch: the solution nearest to these, (legs,)"),
    ("elbow", "numbers", "", "branch: +1 or -1 a leg, (legs,)"),
    ("start", "any", "", "where the search begins: a pose, inputs, or \"last\", the last answer to this thread"),
    ("wrench", "numbers", "N, N m", "of the world on the platform, about its reference point, in base axes: (fx, fy, m) or (6,)"),
    ("gravity", "numbers", "m/s^2", "in place of the robot's, in base axes, (3,)"),
    ("twist", "numbers", "m/s, rad/s", "of the platform's reference point, linear then angular, in base axes: (3,) or (6,)"),
    ("rates", "numbers", "m/s", "of the inputs, in place of `twist`, (k,)"),
    ("along", "numbers", "", "a direction, as a twist, along which the nearest type II singularity is sought"),
    ("limit", "number", "", "how far to look `along`; of a diagram the envelope's size [rad, m]"),
    ("set_at", "pose", "m, rad", "pose at which the tendons are set without load"),
    ("hold", "word", "", "what then stays of the inner tendon: tension or length"),
    ("tensions", "lists", "N", "[T1, T2] a leg, in place of `set_at`"),
    ("lengths", "lists", "m", "[l1 or None, l2 or None] a leg, in place of `set_at`"),
    ("measured_tensions", "numbers", "N", "[T or None a leg]: what held tendons pull; the wrench is sensed"),
    ("axial_forces", "numbers", "N", "what each rod pulls at its guide, (6,); the wrench is sensed"),
    ("deviation", "any", "N", "standard deviation of the measured forces, one for all or one each"),
    ("inverse", "flag", "", "with `pose`: it is held under the load, its tensions are answered"),
    ("angles", "lists", "rad", "of pseudo-rigid chains: joints leg by leg"),
    ("posture_threshold", "number", "rad", "largest turn of a joint for which the linear model counts as valid"),
    ("until", "map", "", "{wrench, limit}: this load is added, up to `limit` times"),
    ("poses", "poses", "m, rad", "path: the poses on the way"),
    ("from_", "pose", "m, rad", "path: the first pose"),
    ("to", "map", "", "path: the last pose; of a curve of equilibria what changes: {inputs or pose, wrench}"),
    ("range", "numbers", "", "of a curve: [lowest, highest] of the parameter, (2,)"),
    ("backward", "flag", "", "of a curve: set out with a falling parameter"),
    ("branches", "flag", "", "of a curve: also the curves that leave its bifurcations"),
    ("objective", "word", "", "what redundant legs do with their freedom: limits, singularity, smooth, none"),
    ("rk4_steps", "count", "", "of chains: Runge-Kutta steps between poses"),
    ("samples", "count", "", "number of points, or of poses on the way"),
    ("section", "count", "", "of a serial robot, from 0"),
    ("measured", "any", "m", "of a diagram: changes that encoders read"),
    ("tolerance", "number", "m", "of a diagram: in place of the robot's"),
    ("envelope", "word", "", "of a diagram: square, disc or actuator"),
    ("all", "flag", "", "every solution: `solutions`"),
    ("want", "words", "", "more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ..."),
    ("with_respect_to", "words", "", "paths of the robot's numbers by which `sensitivity` is taken, too"),
    ("trace", "flag", "", "the iterates, too"),
    ("model", "word", "", "of the links: cc, prb; of serial robots pcc, lsk"),
    ("law", "word", "", "of chains: M0w, M0, M1"),
    ("theta_is", "word", "", "what an input theta is the angle of: tangent, chord"),
    ("max_iterations", "count", "", "the solve's bound"),
    ("tilt", "flag", "", "poses in space have tilt, azimuth and torsion, too"),
    ("set", "map", "", "{path in the robot file: value}: changes the robot for this question alone"),
)

_COMMON = ("model", "law", "theta_is", "max_iterations", "tilt", "set")
_WANT = ("want", "with_respect_to")
_BRANCH = ("bending", "curvature", "elbow")
_WHERE = ("pose", "inputs", "independent", "configuration", "changes", *_BRANCH, "angles", "start", "wrench", "gravity")


class Verb(NamedTuple):
    text: str
    answer: str
    fields: tuple[str, ...]


VERBS = {
    "forward": Verb("Pose of the platform or tip from the inputs.",
                    "pose (or tip), legs (or sections), residual, iterations; of rods and chains energy, potential, and what `want` asks for",
                    ("inputs", "configuration", "changes", "slack", "wrench", "gravity", "start", "want", "with_respect_to", "until",
                     "posture_threshold", "all", "trace", *_COMMON)),
    "inverse": Verb("Inputs from the pose.", "inputs (or configuration and changes), legs, pose, residual",
                    ("pose", "independent", "position", "direction", *_BRANCH, "start", "wrench", "gravity", "want",
                     "with_respect_to", "posture_threshold", "until", "all", *_COMMON)),
    "velocity": Verb("Velocity equations J (twist) = K (input rates), sensitivities, singularities.",
                     "pose, J, K, U = J^-1 K, determinant, indices, type_1, type_2; with `twist` rates",
                     (*_WHERE, "twist", "rates", "along", "limit", *_WANT, *_COMMON)),
    "statics": Verb("A tendon-driven robot under a load, or the wrench on it sensed from forces.",
                    "pose, legs with tensions and forces, wrench, stiffness, compliance, stable, potential, residual",
                    ("pose", "set_at", "hold", "tensions", "lengths", "inputs", "measured_tensions", "axial_forces", "deviation",
                     "inverse", *_BRANCH, "start", "wrench", "gravity", *_WANT, "until", "posture_threshold", *_COMMON)),
    "track": Verb("Inputs along a path of poses; of rods and chains also a curve of equilibria.",
                  "rows, residual, reached; of a curve curves and equilibria",
                  ("poses", "from_", "to", "samples", "inputs", "pose", "independent", *_BRANCH, "angles", "start", "wrench", "gravity",
                   "objective", "rk4_steps", "set_at", "tensions", "lengths", "range", "backward", "branches", *_COMMON)),
    "diagram": Verb("What the tendons of one section of a serial robot leave it free to do.",
                    "class_, word, amount, advice, point, slack, margin, over_tension, frontiers, polygon, boundary, area",
                    ("section", "changes", "measured", "tolerance", "envelope", "limit", *(name for name in _COMMON if name != "law"))),
    "shape": Verb("Polylines for a picture.", "pose, backbones, tendons, lines, platform, base, frames; points in the base frame [m]",
                  (*_WHERE, "samples", *_WANT, *_COMMON)),
    "describe": Verb("What the robot has.", "kind, space, inputs, pose, home, legs or sections, models, versions", _COMMON[::-1]),
}

RANKS = {name: KINDS[field.kind].rank for name, field in FIELDS.items()}
RANKS.update({"x": 0, "y": 0, "phi": 0, "z": 0, "e1": 0, "e2": 0, "position": 1, "quaternion": 1, "tilt": 0, "azimuth": 0, "torsion": 0})

UNITS = {
    "position": "m", "x": "m", "y": "m", "phi": "rad", "quaternion": "", "tilt": "rad", "azimuth": "rad", "torsion": "rad",
    "curvature": "1/m", "chord": "m", "tendon_lengths": "m", "joint_angles": "rad", "slide": "m", "carriage": "m",
    "hinge_angle": "rad", "length": "m", "force": "N", "moment": "N m", "force_0": "N", "moment_0": "N m", "curvature_0": "1/m",
    "tip_angle": "rad", "energy": "J", "potential": "J", "axial_forces": "N", "tensions": "N", "chord_force": "N",
    "motor_torque": "N m", "changes": "m", "slack": "m", "backbones": "m", "tendons": "m", "lines": "m", "platform": "m",
    "base": "m", "closure_error": "m", "iterations": "", "determinant": "", "residual": "", "height": "m", "radius": "m",
}
"""Of what answers have, where every number of it has the same."""
