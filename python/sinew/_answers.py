"""What the robots' methods answer, for their help: name, shape and unit of each field; base axes, linear part before angular.
docs/protocol.md has the rest.
"""
POSE = "pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and quaternion (4,), w first"
TIP = "tip: of a serial robot instead of pose and legs: position (3,) [m] and quaternion (4,), w first"
LEGS = ("legs: list of one record a leg: curvature [1/m], chord [m], tendon_lengths (2,) [m]; of a rod length [m], force and force_0 (3,) [N], "
        "moment and moment_0 (3,) [N m]")
SECTIONS = "sections: of a serial robot, list of one record a section: position (3,) [m] and quaternion (4,) of its end"
CONFIGURATION = "configuration: of a serial robot, (sections, 2) [rad], where lengths vary (sections, 3) [rad, m]"
CHANGES = "changes: of a serial robot's tendons, (sections, tendons) [m], or a list each where sections differ"
INPUTS = "inputs: (k,) [m, rad], in leg order"
RESIDUAL = "residual: number [m], of rods and chains without a unit: the largest error of what was solved"
ITERATIONS = "iterations: int, of the solver"
WANTED = "J, K, stiffness, stable, sensitivity, margins, backbones: what `want` asks for, and more; see `velocity`, `statics`, `shape`"
ENERGY = "energy, potential: of rods and chains, numbers [J]"
MATRICES = ("J, K: (m, m) and (m, k), J (twist) = K (rates), SI; m is 3 in the plane, 6 in space, k the number of inputs; of a serial robot of c "
            "configuration variables (6, c) and (tendons, c): twist of the tip and rates of the tendons by their rates")
VELOCITY = (
    POSE, TIP, MATRICES,
    "U: (m, k), J^-1 K: sensitivities of the pose to the inputs",
    "determinant: number, of J where it is square",
    "indices: record of numbers: condition, condition_homogenised; position and rotation, the largest singular values of those rows of U",
    "type_1, type_2: singularities: list of legs; record with singular, class_, rank",
    "rates: with `twist`, (k,) [m/s, rad/s]",
    "twist: with `rates`, (3,) or (6,) [m/s, rad/s]",
    RESIDUAL)

OF = {
    "forward": (POSE, TIP, LEGS, SECTIONS, CONFIGURATION, CHANGES, RESIDUAL, ITERATIONS, ENERGY, WANTED),
    "inverse": (INPUTS, POSE, LEGS, TIP, CONFIGURATION, CHANGES, RESIDUAL, WANTED),
    "velocity": VELOCITY,
    "statics": (
        POSE,
        "legs: list of one record a leg: tensions (2,) [N], tendon_lengths (2,) [m], angles (joints,) [rad], chord_force [N], "
        "tip_wrench (3,) or (6,) [N, N m]",
        "wrench: (3,) in the plane, (6,) in space [N, N m], on the platform, about its reference point",
        "stiffness, compliance: (3, 3) or (6, 6): wrench [N, N m] by pose [m, rad], inputs held, and its inverse",
        "stable: bool, beside unstable_directions, an int",
        "potential: number [J]",
        RESIDUAL, ITERATIONS),
    "track": (
        "rows: list of one record a pose: pose, inputs (k,) [m, rad], curvature (legs,) [1/m], closure_error [m], indices",
        "curves: of a curve of equilibria, list of records with rows: parameter, pose, inputs (k,) [m, rad], stable, potential [J], event",
        "equilibria: of a curve, list of one record for each point where the parameter is 1: curve, row, pose, inputs (k,) [m, rad], stable",
        RESIDUAL),
    "diagram": (
        "class_, word, advice: str: exact, indeterminate, inconsistent or unreachable; the same for an operator",
        "slack: (tendons,) [m] at `point`, beside margin and over_tension, numbers [m]",
        "amount: number [m], what a tendon has too much or lacks; of an unreachable bend [rad]",
        "point: (2,) [rad], the bend that meets the tendons best: beta_1, beta_2, or theta cos phi, theta sin phi",
        "frontiers: list of records: half-planes normal (2,) and offset [rad], or curve",
        "polygon, boundary: (corners, 2) [rad]: what no tendon forbids, and that within the envelope",
        "area: number [rad^2], of the boundary"),
    "shape": (
        POSE, TIP,
        "backbones: (legs or sections, points, 2) in the plane, (..., 3) in space [m]",
        "tendons: (legs, 2, points, 2 or 3) [m]; a list each where their lengths differ",
        "lines: (legs, 2, 2 or 3) [m]: ends of the line through each leg",
        "platform, base: (points, 2 or 3) [m]: outlines",
        "frames: list of one pose at the tip of each leg",
        RESIDUAL),
    "identify": (
        "robot: the fitted arm, a Robot; `asked` is that of the start, `file` its file as str, `save` writes it",
        "parameters: table with a record each: name, unit, start, value, deviation in that unit, at_bound (bool), prior_share",
        "errors: records before, fitted, held_out: rms, median, max, numbers [m], of distances between markers; rows and failed, int",
        "flat: list of records: deviation, a number of assumed deviations, and `along`, a str: combinations that the rows leave open",
        "by_row: arrays of each row: distance and held_out_distance (n,) [m], computed (n, 3) [m]",
        "covariance: (p, p), of coordinates: logarithms of factors, else differences in the parameters' units",
        "noise: number [m], of a coordinate of the marker",
        "map: record, where `map` took motors and axes as the rows say: sign, mirrored, turn [rad], agreement",
        ITERATIONS),
    "describe": (
        "kind, space: str: parallel or serial, planar or spatial",
        "inputs, pose, configuration: lists of records: name, unit, and of tendons limits (2,) [m]",
        "home: pose where searches begin, in the plane x, y [m] and phi [rad], in space position (3,) [m] and quaternion (4,)",
        "legs, sections: lists of one record each: what the file says, lengths [m], angles [rad]",
        "models, model: list of str, str",
        "versions: record: sinew, a str; protocol, an int"),
}
