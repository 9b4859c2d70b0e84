"""Answers: what a question came to, field by field."""
from __future__ import annotations

import json
import keyword
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _arrays
from ._fields import UNITS

if TYPE_CHECKING:
    from .robot import Robot


_WANTS = {"stiffness": "stiffness", "stable": "stability", "unstable_directions": "stability", "margins": "margins",
          "sensitivity": "sensitivity", "J": "velocity", "K": "velocity", "U": "velocity", "indices": "velocity", "backbones": "shape"}


class Record(Mapping[str, Any]):
    """Named values, as attributes (`pose.position`) and as of a dict (`pose["position"]`).

    Numbers are SI and radians, vectors in base axes. Lists of numbers are NumPy arrays where NumPy is installed; a matrix is
    (rows, columns), a polyline (points, 2 or 3). A name that is a word of Python's takes an underscore:
    `type_2.class_`.
    """

    __slots__ = ("_raw", "_made")

    def __init__(self, raw: dict[str, Any]) -> None:
        self._raw: Any = raw
        self._made: dict[str, Any] = {}

    def _plain(self) -> dict[str, Any]:
        plain: dict[str, Any] = self._raw
        return plain

    def __getitem__(self, name: str) -> Any:
        made = self._made.get(name)
        if made is None:
            made = self._made[name] = _value(self._plain()[name])
        return made

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        plain = self._plain()
        place = name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name
        if place in plain:
            return self[place]
        way = f', and more with want=["{_WANTS[name]}"]' if name in _WANTS and "query" in plain else ""
        raise AttributeError(f"{self._title()} has no {name!r}; it has {', '.join(plain) or 'nothing'}{way}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(name + "_" if keyword.iskeyword(name) else name for name in self._plain())})

    def __iter__(self) -> Iterator[str]:
        return iter(self._plain())

    def __len__(self) -> int:
        return len(self._plain())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and bool(self._plain() == other._plain())

    def __hash__(self) -> int:
        return hash(json.dumps(self._plain(), sort_keys=True))

    def to_dict(self) -> dict[str, Any]:
        """The same as dicts, lists, numbers (SI and radians), texts: a copy, matrices as lists of rows."""
        copied: dict[str, Any] = json.loads(json.dumps(self._plain()))
        return copied

    def _title(self) -> str:
        return "this part of an answer"

    def __repr__(self) -> str:
        return "{" + ", ".join(f"{name}: {self[name]!r}" for name in self) + "}"

    def __reduce__(self) -> tuple[Any, ...]:
        return Record, (self._plain(),)


def _value(raw: Any) -> Any:
    if type(raw) is dict:
        return Record(raw)
    if type(raw) is list:
        if _arrays.depth(raw):
            return _arrays.to_array(raw)
        return [_value(item) for item in raw]
    return raw


class Answer(Record):
    """What came of a question: `ok`, `status`, `message`, and the fields of its kind, which the methods of `Robot` list."""

    __slots__ = ("_text", "_question", "_robot")

    if TYPE_CHECKING:  # a question of many rows has `Columns` in its place, which have the answer to each row by its number
        def __getitem__(self, key: str | int) -> Any: ...
        def __iter__(self) -> Iterator[Any]: ...

    def __init__(self, robot: Robot, question: str, text: str) -> None:
        self._robot, self._question, self._text = robot, question, text
        self._raw: Any = None
        self._made = {}

    def _plain(self) -> dict[str, Any]:
        if self._raw is None:  # read when something of it is wanted
            self._raw = json.loads(self._text)
        plain: dict[str, Any] = self._raw
        return plain

    @property
    def ok(self) -> Any:
        """Whether it is solved, a bool: `status` is `converged`. Of `Columns` booleans (n,)."""
        return self._plain().get("status") == "converged"

    @property
    def status(self) -> Any:
        """One word: `converged`, or why not: `unreachable`, `singular`, `unstable`, ...

        Of `Columns` a number of `Status` for each row, (n,).
        """
        return self._plain().get("status", "")

    @property
    def message(self) -> str:
        """Why it is not solved; or a remark, such as one about a number whose unit may be wrong. Mostly empty."""
        return str(self._plain().get("message", ""))

    @property
    def robot(self) -> Robot:
        """The robot that was asked."""
        return self._robot

    @property
    def question(self) -> Record:
        """What was asked, with all its fields, numbers as they were given."""
        return Record(json.loads(self._question))

    @property
    def units(self) -> dict[str, str]:
        """Units of the fields by their place: `{"pose.position": "m", ...}`. SI throughout; "" of plain numbers."""
        units = dict(_units(self._plain(), self._robot, ""))
        return {**units, **_units_of_robot(self, [place for place, unit in units.items() if ", " in unit and "[]" not in place])}

    def to_json(self) -> str:
        """The answer as the library wrote it, numbers to all digits, SI and radians."""
        return self._text

    def _title(self) -> str:
        return f"this answer to {self._plain().get('query', 'a question')} ({self.status})"

    def __repr__(self) -> str:
        plain = self._plain()
        fields = ", ".join(name for name in plain if name not in ("query", "robot", "status", "message"))
        said = f": {self.message}" if self.message else ""
        return f"<{plain.get('query')} of {plain.get('robot')}: {self.status}{said} ({fields})>"

    def __str__(self) -> str:
        from ._text import lines_of
        return "\n".join([repr(self), *lines_of(self)])

    def _repr_html_(self) -> str:
        from ._html import fragment
        return fragment(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return Answer, (self._robot, self._question, self._text)


_WITHOUT = ("indices.", "freedoms.")  # ratios and counts, whose names mean something else elsewhere
_MIXED = (".growing.", ".shrinking.")  # of several units, of which the table may have none
_LONG = tuple((f".{name}", unit) for name, unit in UNITS.items() if "." in name)  # other than of their last word


def _unit(place: str, name: str) -> str | None:
    """Of `rows[].point`, whose last word is `name`; None where nothing is known, or numbers have several."""
    words = "." + place.replace("[]", "")
    for end, unit in _LONG:
        if words.endswith(end):
            return unit or (None if end.startswith(_MIXED) else "")
    return UNITS.get(name)


def _units_of_robot(answer: Answer, places: list[str]) -> dict[str, str]:
    """Of places whose numbers have several units, of which a robot has some: as those of rows of the same question."""
    question = dict(answer.question.to_dict())
    query = question.pop("query", None)
    question.pop("want", None)  # outputs bring the words that they go with
    from .prepared import Prepared
    for pattern in _patterns(question) if places else ():
        try:
            prepared = Prepared(answer.robot, query, pattern, {f"place_{index}": place for index, place in enumerate(places)}, None)
        except ValueError:  # what was named is no field of numbers
            continue
        return {place: field["unit"] for place, field in zip(places, prepared.layout["outputs"])}
    return {}


def _patterns(value: Any) -> Iterator[Any]:
    """The same with "$row" in the place of a list of numbers or of a number, one after the other."""
    if _arrays.depth(value) or type(value) in (float, int):
        yield "$row"
    if type(value) is dict:
        for name, item in value.items():
            yield from ({**value, name: pattern} for pattern in _patterns(item))
    elif type(value) is list:
        for index, item in enumerate(value):
            yield from ([*value[:index], pattern, *value[index + 1:]] for pattern in _patterns(item))


def _units(plain: Mapping[str, Any], robot: Robot, outer: str) -> Iterator[tuple[str, str]]:
    for name, value in plain.items():
        place = outer + name
        if name == "inputs":
            yield place, ", ".join(dict.fromkeys(robot._input_units()))
        elif name == "wrench":
            yield place, "N, N m"
        elif type(value) is dict:
            yield from _units(value, robot, place + ".")
        elif type(value) is list and value and type(value[0]) is dict:
            yield from _units(value[0], robot, place + "[].")
        elif not outer.endswith(_WITHOUT) and (unit := _unit(place, name)) is not None:
            yield place, unit
