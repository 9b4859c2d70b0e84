"""Robots, and the questions that can be put to them."""
from __future__ import annotations

import importlib.resources
import itertools
import json
import math
import os
import threading
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Union

from . import _sinew
from ._errors import InputError, from_text
from ._fields import BATCH, RANKS, SINGLE
from ._progress import Watch
from ._verbs import Verbs
from .answer import Answer, Record
from .identification import Identification, rows_of

if TYPE_CHECKING:
    from ._view import View
    from .prepared import Prepared

Source = Union[str, "os.PathLike[str]", Mapping[str, Any], "Robot"]
_FILE, _TEXT = 0, 1
_OF_ROWS = frozenset(BATCH)
_SUBJECTS = {"serial": "configuration", "arm": "tensions", "arm_legs": "tensions"}


class Robot(Verbs):
    """A robot. It never changes, and any number of threads may use it.

    Questions are methods: `forward`, `inverse`, `velocity`, `statics`, `track`, `diagram`, `shape`, `identify`,
    `describe`. Their fields are keywords; numbers are SI and radians, or text with a unit ("10 mm"). A field that is an array with one
    dimension more than one value needs holds n rows: the answer then has arrays, see `Columns`.
    """

    _kind: int
    _source: str
    _copy: str
    _settings: dict[str, Any]
    _handle: _sinew.Handle

    def __init__(self, source: Source) -> None:
        self._settings = {}
        if isinstance(source, Robot):
            self._kind, self._source, self._handle = source._kind, source._source, source._handle
            self._copy, self._settings = source._copy, source._settings
        elif isinstance(source, Mapping):
            self._kind, self._source = _TEXT, json.dumps(_plain(source))
        elif isinstance(source, (str, os.PathLike)):
            self._source = os.fspath(source)
            self._kind = _TEXT if isinstance(source, str) and ("\n" in source or source.lstrip().startswith("{")) else _FILE
        else:
            raise InputError(f"a robot is a name, a path, the text of a robot file, or a dict; found {type(source).__name__}",
                             "wrong_type", "source")
        self._open()

    def _open(self) -> None:
        if not hasattr(self, "_handle"):
            self._handle = _sinew.open(self._source, self._kind)
        if not hasattr(self, "_copy"):  # to be opened elsewhere, and to be compared by
            self._copy = self._source if self._kind == _TEXT or self._source in robots() else _read(self._source)
        self._local = threading.local()
        self._planned: dict[Any, Any] = {}
        self._described: Answer | None = None

    def _session(self) -> _sinew.Session:
        """This thread's; another one where a handler asks while this one computes."""
        session: _sinew.Session
        try:
            session = self._local.session
        except AttributeError:
            session = self._local.session = self._handle.session()
        return self._handle.session() if session.is_busy else session

    def _ask(self, query: Any, fields: dict[str, Any]) -> Any:
        options: dict[str, Any] = {}
        if query not in SINGLE and not _OF_ROWS.isdisjoint(fields):  # taken out unread: `out` may hold anything
            options = {name: value for name, value in fields.items() if name in _OF_ROWS and value is not None}
            fields = {name: value for name, value in fields.items() if name not in _OF_ROWS}
        if self._settings:
            fields = {**fields, "set": {**self._settings, **(fields.get("set") or {})}}
        for name in ("changes", "tensions"):
            if getattr(fields.get(name), "ndim", 0) == 2 and self._is_of_tendons(name):
                fields = {**fields, name: self._rows_of_tendons(fields[name])}
        session = self._session()
        if query == "identify":
            fields = dict(fields)
            watch = Watch(session, fields.pop("progress", None))
            if "rows" in fields:
                fields["rows"] = rows_of(fields["rows"])
            with watch:
                asked = session.ask(query, fields, RANKS)
        else:
            asked = session.ask(query, fields, RANKS)
        if asked is None:
            from .columns import ask_columns
            return ask_columns(self, query, fields, options)
        if options:
            raise _only_of_rows(list(options))
        question, text = asked
        if text.startswith('{"error"'):
            raise from_text(text, _hint_of_rows(fields))
        return (Identification if query == "identify" else Answer)(self, question, text)

    def ask(self, question: Mapping[str, Any] | str) -> Answer:
        """A `question` as the protocol has it (docs/protocol.md): a dict, or JSON text. Its numbers are SI and radians, or text
        with a unit.

        Raises `InputError` where it is not to be read. No solution is no error: see `Answer.status`.
        """
        if not isinstance(question, (str, Mapping)):
            raise InputError(f"a question is a dict, or JSON text; found {type(question).__name__}", "wrong_type", "query")
        if isinstance(question, Mapping):
            fields = dict(question)
            answer: Answer = self._ask(fields.pop("query", None), fields)
            return answer
        text = self._session().ask_text(question)
        plain = json.loads(text)
        if "error" in plain:
            raise from_text(text)
        return (Identification if plain.get("query") == "identify" else Answer)(self, question, text)

    def prepare(self, query: str, *, outputs: Any = None, path: str | None = None, **fields: Any) -> Prepared:
        """A question to be put many times: a function (`Prepared`) of what stands as "$name" in its fields.

            forward = robot.prepare("forward", inputs="$lengths")
            forward([0.44, 0.42, 0.41]).position          # one row
            forward(numpy.full((1000, 3), 0.42)).position  # (1000, 3)

        `outputs` names what comes out, `{"z": "pose.position[2]"}` or a list of places; left out, what the question is
        mostly asked for. `path="continue"`: each row begins where the one before it ended, as along a trajectory. `query` is
        the name of a method, `fields` are its fields, their shapes and units as there. Raises `InputError` where they are not
        to be read.
        """
        from .prepared import Prepared
        if not isinstance(query, str):
            raise TypeError("prepare takes the kind of a question, then its fields: prepare(\"forward\", inputs=\"$lengths\")")
        return Prepared(self, query, fields, outputs, path)

    def set(self, values: Mapping[str, Any]) -> Robot:
        """Another robot, like this one but for `values`, by their paths in a robot file: `robot.set({"legs[0].link.length": "180 mm"})`.

        Numbers are SI and radians, or text with a unit. Raises `InputError` where there is no such robot.
        """
        if not isinstance(values, Mapping):
            raise InputError(f"set takes a dict of paths and values, not {type(values).__name__}", "wrong_type", "set")
        changed = Robot(self)
        changed._settings = {**self._settings, **_plain(values)}
        changed.describe()  # whether there is such a robot
        return changed

    def _about(self) -> Answer:
        if self._described is None:
            self._described = self.describe()
        return self._described

    @property
    def name(self) -> str:
        """Name of the robot, as its file has it."""
        return str(self._about()._plain()["robot"])

    @property
    def inputs(self) -> list[Record]:
        """What the motors command, in order, a record each: `name`, `unit` (m or rad) and, of tendons, `limits` (2,) [m]."""
        return [Record(entry) for entry in self._about()._plain()["inputs"]]

    def _input_units(self) -> list[str]:
        return [entry["unit"] for entry in self._about()._plain()["inputs"]]

    def _subject(self, query: str, value: Any) -> str:
        """What a question is mostly about, whose value goes without a name."""
        kind = self._about()._plain()["kind"]
        if isinstance(value, Mapping) or (query == "inverse" and kind not in ("serial", "arm")):
            return "pose"
        return "position" if query == "inverse" else _SUBJECTS.get(kind, "inputs")

    def _by_sections(self, numbers: list[float]) -> list[list[float]]:
        """Numbers of all tendons, in order, as a list a section."""
        left = iter(numbers)
        return [list(itertools.islice(left, count)) for count in self._tendon_counts()]

    def _tendon_counts(self) -> list[int]:
        """How many tendons end at each section; of legs of sections those of leg 0 first."""
        about = self._about()._plain()
        arms = [leg["link"] for leg in about["legs"]] if about.get("kind") == "arm_legs" else [about]
        if about.get("kind") in ("arm", "arm_legs"):
            return [sum(tendon["section"] == m for tendon in arm["tendons"]) for arm in arms for m in range(len(arm["sections"]))]
        return [section["tendons"]["count"] for section in about.get("sections", [])]

    def _is_of_tendons(self, name: str) -> bool:
        """Whether a field has a number of every tendon, a list a section in questions, all in a row in columns."""
        return name in ("changes", "measured") or name == "tensions" and self._about()._plain().get("kind") in ("arm", "arm_legs")

    def _rows_of_tendons(self, changes: Any) -> Any:
        """Rows of all tendons, as columns have them (n, 15), as columns (n, 1, 15); a list a section (5, 3) as it is."""
        counts = self._tendon_counts()
        rows, width = changes.shape
        is_of_rows = width == sum(counts) and (rows > 1 or len(counts) > 1)
        return changes.reshape(rows, 1, width) if is_of_rows else changes

    def plot(self, answer: Any = None, ax: Any = None) -> Any:
        """Draws the robot at the pose of `answer` (None: at home) by matplotlib, on the axes `ax` (None: new ones); returns the axes.

        Axes are those of the base, lengths in mm. Raises `ValueError` where `ax` is planar and the robot is not.
        """
        from ._plot import plot
        return plot(self, answer, ax)

    def save_html(self, answer: Any, path: str | os.PathLike[str]) -> None:
        """Writes the file `path` for a browser: `answer` as a table with units, and its pose, to be turned by the mouse. It loads nothing."""
        from ._html import save
        save(self, answer, path)

    def view(self, *, port: int = 0, open_browser: bool = True) -> View:
        """Starts `sinew serve` and opens the viewer: in a notebook in a frame, else in a browser, where `open_browser` is true.

        `port` is a number of TCP's, 0 for a free one. Returns a `View`. Raises `InputError` where the command is not there.
        """
        from ._view import View
        return View(self, port, open_browser)

    def __repr__(self) -> str:
        known = f"sinew.load({self._source!r})" if self._kind == _FILE else f"<sinew.Robot {self.name!r}>"
        return known + (f".set({self._settings!r})" if self._settings else "")

    def _key(self) -> tuple[str, str]:
        return self._copy, json.dumps(self._settings, sort_keys=True)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Robot) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __copy__(self) -> Robot:
        return self

    def __deepcopy__(self, memo: Any) -> Robot:
        return self

    def __getstate__(self) -> dict[str, Any]:
        is_name = self._kind == _FILE and self._copy == self._source
        return {"source": self._copy, "kind": _FILE if is_name else _TEXT, "settings": self._settings}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._source, self._kind, self._settings = state["source"], state["kind"], state["settings"]
        self._open()


def robots() -> list[str]:
    """Names of the robots that come with sinew, for `load`."""
    folder = importlib.resources.files("sinew") / "robots"
    return sorted(entry.name[:-len(".yaml")] for entry in folder.iterdir() if entry.name.endswith(".yaml"))


def _only_of_rows(names: list[str]) -> InputError:
    what = "is for questions" if len(names) == 1 else "are for questions"
    return InputError(f"{', '.join(names)} {what} of many rows, and this is one: give a field as an array of one dimension more, a row each, "
                      f"or leave {'it' if len(names) == 1 else 'them'} out", "unknown_key", names[0])


def _hint_of_rows(fields: Mapping[str, Any]) -> str:
    """For lists of rows where one row is read."""
    for name, value in fields.items():
        if RANKS.get(name) == 1 and isinstance(value, (list, tuple)) and value and isinstance(value[0], (list, tuple)):
            return f" Rows are given as an array: {name}=numpy.array(...)."
    return ""


def _read(path: str) -> str:
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    """A copy that JSON can write: arrays as lists."""
    try:
        for place, number in _numbers_of(values, ""):
            if not math.isfinite(number):
                raise InputError(f"{place} is {number}; give a finite number", "out_of_range", place)
        copied: dict[str, Any] = json.loads(json.dumps(values, default=_convert, allow_nan=False))
    except InputError:
        raise
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"this is no robot or change of one: {error}", "wrong_type", "set") from None
    return copied


def _numbers_of(value: Any, place: str) -> Iterator[tuple[str, float]]:
    """Floating point numbers with their places, `legs[0].link.length`."""
    if isinstance(value, float):
        yield place, value
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from _numbers_of(item, f"{place}.{name}" if place else str(name))
    elif isinstance(value, (list, tuple)):
        for index, item in enumerate(value):
            yield from _numbers_of(item, f"{place}[{index}]")
    elif hasattr(value, "tolist"):
        yield from _numbers_of(value.tolist(), place)


def _convert(value: Any) -> Any:
    for method in ("tolist", "to_dict", "keys"):
        if hasattr(value, method):
            return dict(value) if method == "keys" else getattr(value, method)()
    raise TypeError(f"{type(value).__name__} is no number, text, list or dict")
