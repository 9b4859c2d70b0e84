"""Fields of questions, by the library's own table. Keywords' help, the stubs of the methods (tools/python_stubs.py) and what an
array's dimensions mean come from it; the library alone judges what a robot takes. docs/protocol.md has the details.
"""
from typing import NamedTuple

from . import _answers as answers
from . import _table


class Kind(NamedTuple):
    type: str
    """As a type of _types.py."""
    rank: int
    """Dimensions of one value; an array with one more holds a column."""
    text: str
    """As help says it."""


KINDS = {
    "number": Kind("Number", 0, "number"),
    "numbers": Kind("Numbers", 1, "numbers"),
    "lists": Kind("Lists", 2, "lists of numbers"),
    "pose": Kind("Pose", 0, "pose"),
    "poses": Kind("Sequence[Pose]", 0, "list of poses"),
    "map": Kind("Mapping[str, Any]", 0, "dict"),
    "word": Kind("str", 0, "str"),
    "words": Kind("Sequence[str]", 0, "list of str"),
    "flag": Kind("bool", 0, "bool"),
    "names": Kind("str | Sequence[str]", 0, "str, or list of str"),
    "rows": Kind("Rows", 0, "dict of arrays, or a path"),
    "count": Kind("int", 0, "int"),
    "any": Kind("Any", 1, "number, list, dict or str"),
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
    answer: tuple[str, ...]
    fields: tuple[str, ...]


VERBS = {name: Verb(text, answers.OF[name], _table.QUESTIONS[name]) for name, text in (
    ("forward", "Pose of the platform or tip from the inputs."),
    ("inverse", "Inputs from the pose."),
    ("velocity", "Velocity equations J (twist) = K (input rates), sensitivities, singularities."),
    ("statics", "A tendon-driven robot under a load, or the wrench on it sensed from forces."),
    ("track", "Inputs along a path of poses; of rods and chains also a curve of equilibria."),
    ("diagram", "What the tendons of one section of a serial robot leave it free to do."),
    ("shape", "Polylines for a picture."),
    ("identify", "Parameters of an arm, fitted to measured rows."),
    ("describe", "What the robot has."),
)}

BATCH = ("outputs", "path", "threads", "out")
"""Keywords of questions of many rows, which are no fields of a question."""
SINGLE = ("describe", "identify")
"""Never asked of many rows at once."""

RANKS = {name: KINDS[field.kind].rank for name, field in FIELDS.items()}
RANKS.update({"x": 0, "y": 0, "phi": 0, "z": 0, "e1": 0, "e2": 0, "position": 1, "quaternion": 1, "tilt": 0, "azimuth": 0, "torsion": 0,
              "pulls": 2, "markers": 2, "time": 1, "blocks": 1})

UNITS = {
    **{name: unit for name, unit in _table.UNITS.items() if name not in ("base_tangent", "configuration")}, "quaternion": "",
    "area": "rad^2", "iterations": "", "determinant": "", "residual": "",
    "height": "m", "radius": "m", "axial_forces": "N",
}
"""Of what answers have, where every number of it has the same."""
