"""Answers to many rows: arrays, computed on all cores where they lie."""
from __future__ import annotations

import enum
import json
import operator
from collections.abc import Iterator, KeysView, Mapping
from typing import TYPE_CHECKING, Any

from . import _arrays
from ._errors import InputError
from ._fields import FIELDS, KINDS, RANKS
from .answer import Answer, Record

if TYPE_CHECKING:
    from .prepared import Prepared
    from .robot import Robot

_MOST_PLANS = 16


class Status(enum.IntEnum):
    """What came of a row, as a number; `Columns.status` has one each, `Answer.status` the word."""

    unreachable = 0
    """No solution: the inputs or the pose are out of reach."""
    left_domain = 1
    """Beyond what a model, a limit or a number holds for."""
    slack = 2
    """A tendon of a serial robot is slack."""
    singular = 3
    """At a singularity: what was asked for has no one value."""
    stalled = 4
    """The solver stopped making progress; that nothing is there is not proven."""
    iteration_limit = 5
    """`max_iterations` was reached."""
    unstable = 6
    """An equilibrium that the robot would leave."""
    converged = 7
    """Solved."""
    stopped = 8
    """Ended from outside before it was computed."""
    bad_input = 9
    """The row's numbers are no input, such as NaN."""
    unsupported = 10
    """Not for this robot or model."""
    failed = 255
    """An error of the library; `message` has it."""


class Columns(Answer):
    """Answers to n rows: of each field an array (n, ...), as attributes and as of a dict; SI and radians, base axes.

    `ok` is an array of n booleans, `status` one of n numbers of `Status`; numbers that a row does not have are NaN.
    `columns[i]` is the whole answer to row i, asked when it is wanted: inputs are the caller's arrays, which are read again then.
    With `path="continue"` it begins at the row's own solution; where that is not known, `InputError` says so.
    """

    __slots__ = ("_prepared", "_inputs", "_values", "_status", "_said")

    def __init__(self, prepared: Prepared, inputs: list[Any], values: dict[str, Any], status: Any, said: str | None) -> None:
        self._prepared, self._inputs, self._values, self._status, self._said = prepared, inputs, values, status, said
        self._robot, self._made = prepared.robot, {}

    def _plain(self) -> dict[str, Any]:
        return self._values

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            return self._values[key]
        try:
            row = range(len(self))[operator.index(key)]  # an IndexError where there is no such row
        except TypeError:
            raise TypeError(f"answers[i] is the answer to one row, i a whole number; found {type(key).__name__}: "
                            "of several rows take parts of the arrays") from None
        values = [_arrays.row_of(column, row) for column in self._inputs]
        return self._on_the_path(row, values) if self._prepared._is_path else self._prepared.answer(values)

    def _on_the_path(self, row: int, values: list[Any]) -> Answer:
        """The answer to a row that began where the one before ended: it begins at the row's own solution."""
        word = Status(int(self._status[row])).name
        start = self._start_of(row)
        answer = self._prepared.answer(values, start)
        if answer.status != word:
            raise InputError(f"row {row} is {word}, after the rows before it; asked alone it is {answer.status}: take it from the arrays",
                             "wrong_array", "path")
        return answer

    def _start_of(self, row: int) -> dict[str, Any] | None:
        """The pose of this row; where it is not solved that of the last one before it that is. None: there is none before it."""
        names = self._prepared._pose_names
        if names is None:
            raise InputError(f'with path="continue" row {row} began where the one before it ended, and asked alone it may end elsewhere: take it '
                             "from the arrays; or, of a pose found from inputs, let the whole pose be among the outputs", "wrong_array", "path")
        solved = next((before for before in range(row, -1, -1) if self._status[before] == Status.converged), None)
        return None if solved is None else {field: _arrays.row_of(self._values[name], solved) for field, name in names.items()}

    def __iter__(self) -> Iterator[Any]:
        return (self[row] for row in range(len(self)))

    def keys(self) -> KeysView[str]:
        """Names of the fields."""
        return self._values.keys()

    def items(self) -> Any:
        """Names and arrays (n, ...), in SI and radians; `units` has each one's."""
        return self._values.items()

    def values(self) -> Any:
        """The arrays (n, ...), in SI and radians, in the order of `keys`."""
        return self._values.values()

    def __len__(self) -> int:
        return len(self._status)

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    @property
    def ok(self) -> Any:
        """Whether each row is solved: booleans (n,)."""
        return _arrays.equal(self._status, Status.converged)

    @property
    def status(self) -> Any:
        """A number of `Status` for each row: bytes (n,)."""
        return self._status

    @property
    def counts(self) -> dict[str, int]:
        """Number of rows of each status, by its word."""
        return {Status(code).name: count for code, count in _arrays.counts(self._status)}

    @property
    def message(self) -> str:
        """How many rows were not solved, and what is wrong with the first that is no input at all."""
        unsolved = [f"{count} {name}" for name, count in self.counts.items() if name != "converged"]
        told = f"{', '.join(unsolved)} of {len(self)} rows" if unsolved else ""
        if self._said:
            from ._errors import from_text
            said = from_text(self._said).message if '"error"' in self._said[:10] else self._said
            told = f"{told}: {said}" if told else said
        return told

    @property
    def units(self) -> dict[str, str]:
        """Units of the arrays by name, SI throughout; "" of plain numbers."""
        return {field["name"]: field["unit"] for field in self._prepared.layout["outputs"]}

    @property
    def question(self) -> Record:
        """What was asked, "$name" where columns went in."""
        _, query, fields, *_ = self._prepared._made_of
        return Record({"query": query, **fields})

    @property
    def method(self) -> str:
        """How the rows were computed: `rods in lanes`, `query by query`, ..."""
        return str(self._prepared.layout["method"])

    def to_dict(self) -> dict[str, Any]:
        """The arrays (n, ...) by name, SI and radians, and `status`; not copied."""
        return {**self._values, "status": self._status}

    def to_json(self) -> str:
        """As `to_dict`, arrays as lists of rows; null where a row has no number."""
        text = json.dumps(self.to_dict(), default=lambda array: array.tolist())
        return json.dumps(json.loads(text, parse_constant=lambda _: None))

    def __repr__(self) -> str:
        shapes = ", ".join(f"{name} {_arrays.shape(value)}" for name, value in self._values.items())
        return f"<{self._prepared.query} of {self._robot.name}: {len(self)} rows{', ' + self.message if self.message else ''} ({shapes})>"

    def __str__(self) -> str:
        return repr(self)

    def _repr_html_(self) -> str:
        from ._html import table
        units = self.units
        return table(repr(self), [(name, str(_arrays.shape(value)), units[name]) for name, value in self._values.items()])

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._prepared, self._inputs, self._values, self._status, self._said)


def _restored(prepared: Prepared, *rest: Any) -> Columns:
    return Columns(prepared, *rest)


def ask_columns(robot: Robot, query: str, fields: dict[str, Any], options: Mapping[str, Any]) -> Columns:
    """The question of a verb's keywords, arrays of which hold columns. Questions that differ in arrays alone are prepared once."""
    from .prepared import Prepared
    fields = {name: value for name, value in fields.items() if value is not None}
    outputs, path = options.get("outputs"), options.get("path")
    columns: dict[str, Any] = {}
    pattern = _with_names(robot, fields, "", "", columns)
    key = repr((query, pattern, outputs, path))
    prepared = robot._planned.get(key)
    if prepared is None:
        try:
            prepared = Prepared(robot, query, pattern, outputs, path)
        except InputError as error:
            raise _of_one_value(error, query, columns) from None
        for old in list(robot._planned)[:-_MOST_PLANS]:  # the list is of one moment, whatever other threads do
            robot._planned.pop(old, None)
        robot._planned[key] = prepared
    answer: Columns = prepared._columns((), {**columns, "threads": options.get("threads"), "out": options.get("out")}, is_many=True)
    return answer


def _of_one_value(error: InputError, query: str, columns: Mapping[str, Any]) -> InputError:
    """Where a field is not to be read as a column the user's array is to be named, not the name that stood for it."""
    for place, array in columns.items():
        if f"{place} = ${place};" in error.message:
            return InputError(f"{place} has shape {_arrays.shape(array)}, rows of values; {query} takes one value of it", "wrong_length", place)
    return error


def _shapes_of(key: str) -> str:
    """What a field takes: arrays of so many dimensions, or none."""
    if _is_no_array(key):
        return f"a {KINDS[FIELDS[key].kind].text}"
    rank = RANKS.get(key, 1)
    one = f"an array of {rank} dimension{'s' if rank > 1 else ''} for one value" if rank else "one number"
    return f"{one}, or an array of {rank + 1} dimension{'s' if rank else ''} for a row each"


def _is_no_array(key: str) -> bool:
    return key in FIELDS and FIELDS[key].kind in ("pose", "poses", "map")


def _with_names(robot: Robot, value: Any, place: str, key: str, columns: dict[str, Any]) -> Any:
    """The fields with "$place" where an array holds a column, which `columns` then has."""
    dimensions = getattr(value, "ndim", None)
    if isinstance(dimensions, int):
        if dimensions <= RANKS.get(key, 1):
            return value
        if dimensions != RANKS.get(key, 1) + 1 or _is_no_array(key):
            raise InputError(f"{place} has shape {_arrays.shape(value)}; give {_shapes_of(key)}", "wrong_length", place)
        columns[place] = _arrays.flat_rows(value) if robot._is_of_tendons(key) else value
        return "$" + place
    if isinstance(value, Mapping):
        return {name: _with_names(robot, item, f"{place}.{name}" if place else str(name), str(name), columns) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_with_names(robot, item, f"{place}[{index}]", key, columns) for index, item in enumerate(value)]
    return value
