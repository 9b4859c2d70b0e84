"""Questions prepared once and put many times."""
from __future__ import annotations

import operator
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _arrays, _sinew
from ._errors import InputError, from_text
from ._fields import VERBS
from .columns import Columns, Status

if TYPE_CHECKING:
    from .answer import Answer
    from .robot import Robot


class Row(_sinew.Row):
    """What a prepared question answers of one row: its outputs, as attributes; `ok`, `status`.

    Numbers are SI and radians, in base axes; an output of rank 1 or 2 is an array of the shape that `Prepared.outputs` says. A
    number that the row does not have is NaN.
    """

    __slots__ = ()

    @property
    def status(self) -> str:
        """One word: `converged`, or why not."""
        return Status(self._code).name

    @property
    def answer(self) -> Answer:
        """The whole answer to the same question, asked again."""
        question: Prepared = self._question
        return question.answer(list(self._inputs().values()))

    @property
    def message(self) -> str:
        """Why it is not solved; empty where it is."""
        return "" if self.ok else self.answer.message

    @property
    def units(self) -> dict[str, str]:
        """Units of the outputs by name, SI throughout; "" of plain numbers."""
        return {field["name"]: field["unit"] for field in self._question.layout["outputs"]}

    def to_dict(self) -> dict[str, Any]:
        """Outputs by name: numbers and arrays of their shape, SI and radians."""
        return {field["name"]: getattr(self, field["name"]) for field in self._question.layout["outputs"]}

    def __copy__(self) -> Row:
        return self

    def __deepcopy__(self, memo: Any) -> Row:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return self._question._row, self._state()

    def __repr__(self) -> str:
        values = ", ".join(f"{name}: {value!r}" for name, value in self.to_dict().items())
        return f"<{self._question.query} of {self._question.robot.name}: {self.status} ({values})>"

    def _repr_html_(self) -> str:
        return self.answer._repr_html_()


class Prepared(_sinew.Question):
    """A function of what stands as "$name" in the fields of a question; see `Robot.prepare`.

    Arguments are in the order in which the names stand in the question, or by name. Numbers, lists or (k,) arrays are
    one row and give a `Row`; arrays (n,) or (n, k) are n rows and give `Columns`. Numbers are SI and radians; `inputs` says
    units and shapes. `threads` (of n rows; one row is computed by one) and `out` are as of the robot's methods. Raises `InputError` where an array is not to be read,
    `TypeError` where arguments are missing or not known. Any number of threads may call it; `stop()` ends what others compute.
    """

    robot: Robot
    """The robot that is asked."""
    query: str
    """Which question: `forward`, `inverse`, ..."""
    _made_of: tuple[Robot, str, dict[str, Any], Any, str | None]

    def __new__(cls, robot: Robot, query: str, fields: dict[str, Any], outputs: Any, path: str | None) -> Prepared:
        asked = dict(fields)
        if robot._settings:
            asked["set"] = {**robot._settings, **(asked.get("set") or {})}
        if outputs is not None:
            asked["outputs"] = _named(outputs)
        self: Prepared = super().__new__(cls, robot._handle, query, {**asked, "path": path}, Row)
        self.robot, self.query = robot, query
        self._made_of = (robot, query, fields, outputs, path)
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return Prepared, self._made_of

    def __repr__(self) -> str:
        names = ", ".join(f"{field['name']} {_arrays.shape_text(field['shape'])}" for field in self.layout["inputs"])
        return f"<{self.query} of {self.robot.name}, a function of {names}>"

    @property
    def inputs(self) -> list[dict[str, Any]]:
        """What goes in, a dict each: `name`, `unit`, `rank`, and `shape` of one row, a list of numbers: `[]` of a number, `[3]`."""
        return [dict(field) for field in self.layout["inputs"]]

    @property
    def outputs(self) -> list[dict[str, Any]]:
        """What comes out, a dict each: `name`, `unit`, `rank`, and `shape` of one row, a list of numbers: `[]` of a number, `[6, 3]`."""
        return [dict(field) for field in self.layout["outputs"]]

    def answer(self, values: Sequence[Any], start: Any = None) -> Answer:
        """The whole answer to one row: `values` in the order of `inputs`, in their shapes, SI and radians. A `start` is taken in
        place of the question's.
        """
        named = {field["name"]: value for field, value in zip(self.layout["inputs"], values)}
        fields = {**_filled(self._made_of[2], named, self.robot, ""), **({"want": self.layout["want"]} if self.layout["want"] else {})}
        answer: Answer = self.robot._ask(self.query, fields if start is None else {**fields, "start": start})
        return answer

    @property
    def _is_path(self) -> bool:
        return self._made_of[4] == "continue"

    @property
    def _pose_names(self) -> dict[str, str] | None:
        """By which names the numbers of a whole pose come out, where it is sought, from inputs: it is a `start` then."""
        about = self.robot._about()._plain()
        if about.get("kind") != "parallel" or "start" not in VERBS[self.query].fields or not {"pose", "independent"}.isdisjoint(self._made_of[2]):
            return None
        outputs = self._made_of[3]
        names = [field["name"] for field in self.layout["outputs"]]
        places = {f"pose.{name}": name for name in names} if outputs is None else {place: name for name, place in _named(outputs).items()}
        fields = ("x", "y", "phi") if about.get("space") == "planar" else ("position", "quaternion")
        found = {field: places[f"pose.{field}"] for field in fields if f"pose.{field}" in places}
        return found if len(found) == len(fields) else None

    def _columns(self, args: tuple[Any, ...], named: dict[str, Any], is_many: bool = False) -> Any:
        """What is not plainly one row of numbers."""
        named = dict(named)
        threads, out = _count_of_threads(named.pop("threads", None)), named.pop("out", None)
        fields = self.layout["inputs"]
        values = self._arguments(args, named)
        columns = [_arrays.column(value, field) for value, field in zip(values, fields)]
        ranks = [array.ndim - len(field["shape"]) for array, field in zip(columns, fields)]
        if not is_many and out is None and not any(ranks):  # one row, of numbers of another kind
            return _sinew.Question.__call__(self, *(array.tolist() for array in columns))
        return self._run(columns, ranks, threads, out)

    def _arguments(self, args: tuple[Any, ...], named: dict[str, Any]) -> list[Any]:
        names = [field["name"] for field in self.layout["inputs"]]
        known = f"it takes {', '.join(names)}, threads, out"
        if len(args) > len(names):
            raise TypeError(f"{len(args)} arguments are too many: {known}")
        given = dict(zip(names, args))
        for name, value in named.items():
            if name not in names:
                raise TypeError(f"there is no argument {name!r}: {known}")
            if name in given:
                raise TypeError(f"{name!r} is given twice: {known}")
            given[name] = value
        missing = [name for name in names if name not in given]
        if missing:
            raise TypeError(f"{', '.join(missing)} missing: {known}")
        return [given[name] for name in names]

    def _run(self, columns: list[Any], ranks: list[int], threads: int, out: Any) -> Columns:
        sizes = {len(array) for array, rank in zip(columns, ranks) if rank}
        if len(sizes) > 1:
            told = ", ".join(f"{field['name']} {_arrays.shape(array)}" for array, field in zip(columns, self.layout["inputs"]))
            raise InputError(f"arrays of different lengths: {told}; give as many rows of each", "wrong_length", self.query)
        rows = sizes.pop() if sizes else 1
        inputs = [array if rank else _arrays.repeated(array, rows) for array, rank in zip(columns, ranks)]
        outputs = _arrays.outputs(self.layout["outputs"], rows, out, inputs)
        status = _arrays.bytes_of(rows)
        filled = [_arrays.to_be_filled(array) for array in outputs.values()]
        said = self.run(rows, [_arrays.as_it_lies(array) for array in inputs], filled, status, threads)
        for array, numbers in zip(outputs.values(), filled):
            _arrays.fill(array, numbers)
        if said and said.startswith('{"error"') and _arrays.counts(status) == [(Status.bad_input, rows)]:
            raise from_text(said)  # no row is input: it is the question that is wrong
        return Columns(self, inputs, outputs, status, said)


def _count_of_threads(threads: Any) -> int:
    try:
        count = 0 if threads is None else operator.index(threads)
    except TypeError:
        count = -1
    if not 0 <= count < 2**31:
        raise InputError(f"threads = {threads!r}; give a whole number, 0 for as many as there are cores", "out_of_range", "threads")
    return count


def _named(outputs: Any) -> Mapping[str, str]:
    """`["pose.position"]` is `{"position": "pose.position"}`."""
    if not isinstance(outputs, Iterable):
        raise InputError(f"outputs: found {type(outputs).__name__}; give a dict of names and places, or a list of places", "wrong_type", "outputs")
    named = outputs if isinstance(outputs, Mapping) else _by_last_word([outputs] if isinstance(outputs, str) else list(outputs))
    for name in named:
        if hasattr(Row, str(name)) or hasattr(Columns, str(name)):
            raise InputError(f"outputs: answers have a {name!r} of their own; give this one another name, such as \"my_{name}\"",
                             "ambiguous", f"outputs.{name}")
    return named


def _by_last_word(places: list[Any]) -> dict[str, Any]:
    """By the whole place, `legs_0_chord`, where others end with the same word."""
    last = [str(place).rsplit(".", 1)[-1] for place in places]
    return {word if last.count(word) == 1 else re.sub(r"[.\[]", "_", str(place)).replace("]", ""): place for word, place in zip(last, places)}


def _filled(value: Any, named: Mapping[str, Any], robot: Robot, key: str) -> Any:
    """The fields with the numbers where "$name" stood."""
    if isinstance(value, str) and value.startswith("$"):
        numbers = named.get(value[1:], value)
        return robot._by_sections(numbers) if robot._is_of_tendons(key) else numbers
    if isinstance(value, Mapping):
        return {name: _filled(item, named, robot, name) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_filled(item, named, robot, "") for item in value]
    return value
