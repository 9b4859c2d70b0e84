"""Fields of questions, by the library's own table. Keywords' help, the stubs of the methods (tools/python_stubs.py) and what an
array's dimensions mean come from it; the library alone judges what a robot takes. docs/protocol.md has the details.
"""
from typing import NamedTuple

from . import _table


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


FIELDS = _fields(*_table.FIELDS)


class Verb(NamedTuple):
    text: str
    answer: str
    fields: tuple[str, ...]


VERBS = {name: Verb(text, answer, _table.QUESTIONS[name]) for name, text, answer in (
    ("forward", "Pose of the platform or tip from the inputs.",
     "pose (or tip), legs (or sections), residual, iterations; of rods and chains energy, potential, and what `want` asks for"),
    ("inverse", "Inputs from the pose.",
     "inputs (or configuration and changes), legs, pose, residual"),
    ("velocity", "Velocity equations J (twist) = K (input rates), sensitivities, singularities.",
     "pose, J, K, U = J^-1 K, determinant, indices, type_1, type_2; with `twist` rates"),
    ("statics", "A tendon-driven robot under a load, or the wrench on it sensed from forces.",
     "pose, legs with tensions and forces, wrench, stiffness, compliance, stable, potential, residual"),
    ("track", "Inputs along a path of poses; of rods and chains also a curve of equilibria.",
     "rows, residual, reached; of a curve curves and equilibria"),
    ("diagram", "What the tendons of one section of a serial robot leave it free to do.",
     "class_, word, amount, advice, point, slack, margin, over_tension, frontiers, polygon, boundary, area"),
    ("shape", "Polylines for a picture.",
     "pose, backbones, tendons, lines, platform, base, frames; points in the base frame [m]"),
    ("describe", "What the robot has.",
     "kind, space, inputs, pose, home, legs or sections, models, versions"),
)}

RANKS = {name: KINDS[field.kind].rank for name, field in FIELDS.items()}
RANKS.update({"x": 0, "y": 0, "phi": 0, "z": 0, "e1": 0, "e2": 0, "position": 1, "quaternion": 1, "tilt": 0, "azimuth": 0, "torsion": 0})

UNITS = {
    **{name: unit for name, unit in _table.UNITS.items() if name not in ("base_tangent", "configuration", "z")}, "quaternion": "",
    "backbones": "m", "tendons": "m", "lines": "m", "platform": "m", "base": "m", "iterations": "", "determinant": "", "residual": "",
    "height": "m", "radius": "m", "axial_forces": "N",
}
"""Of what answers have, where every number of it has the same."""
