"""Fits of an arm to measured rows: `Robot.identify`."""
from __future__ import annotations

import html
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _arrays
from ._errors import InputError
from ._text import number
from .answer import Answer, Record

if TYPE_CHECKING:
    from .robot import Robot

_COLUMNS = ("pulls", "markers", "time", "blocks")


def rows_of(rows: Any) -> Any:
    """What was measured, as the question takes it: columns by their names, or the text of a table."""
    if rows is None or isinstance(rows, Mapping):
        return rows
    if isinstance(rows, os.PathLike) or (isinstance(rows, str) and "\n" not in rows):
        path = os.fspath(rows)
        try:
            with open(path, encoding="utf-8") as file:
                return file.read()
        except OSError as error:
            raise InputError(f"rows: the table {path} cannot be read: {error.strerror}; give the path of a .csv file, or a dict of "
                             "columns: {'pulls': ..., 'markers': ...}", "file_unreadable", "rows") from None
        except UnicodeDecodeError:
            raise InputError(f"rows: {path} is no text; give a .csv file", "not_utf8", "rows") from None
    if isinstance(rows, str):
        return rows
    if hasattr(rows, "to_csv"):  # of pandas
        return rows.to_csv(index=False)
    raise InputError(f"rows are a dict of arrays ({', '.join(_COLUMNS)}), the path of a .csv file, or a table with to_csv; "
                     f"found {type(rows).__name__}", "wrong_type", "rows")


class Parameters(Sequence[Record]):
    """Parameters of a fit as a table: a record each, by index or by `name`, and columns as attributes.

        answer.parameters["sections[0].bending"].value
        answer.parameters.deviation  # of all of them

    `name` and `unit` are lists of str. Numbers are arrays of shape (p,), NaN where they are not known, in the unit of each:
    `start`, `value`, `deviation` (standard, of rows and assumption together), `prior` and `prior_share` (of what is known of
    it; 1: the rows say nothing). `at_bound`: bool each, whether it went as far as is believed possible.
    """

    def __init__(self, entries: list[dict[str, Any]]) -> None:
        self._entries = entries

    def __len__(self) -> int:
        return len(self._entries)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, str):
            for entry in self._entries:
                if entry["name"] == index:
                    return Record(entry)
            raise KeyError(f"{index!r} was not fitted; there are {', '.join(self.name)}")
        if isinstance(index, slice):
            return Parameters(self._entries[index])
        return Record(self._entries[index])

    def __iter__(self) -> Iterator[Record]:
        return (Record(entry) for entry in self._entries)

    def _column(self, name: str) -> Any:
        return _arrays.to_array([entry.get(name, math.nan) for entry in self._entries])

    @property
    def name(self) -> list[str]:
        """Names, a list of str."""
        return [entry["name"] for entry in self._entries]

    @property
    def unit(self) -> list[str]:
        """Units of the values, a list of str; "" of a plain number."""
        return [entry["unit"] for entry in self._entries]

    @property
    def start(self) -> Any:
        """Values before the fit, numbers of shape (p,) in the unit of each."""
        return self._column("start")

    @property
    def value(self) -> Any:
        """Values after the fit, numbers of shape (p,) in the unit of each."""
        return self._column("value")

    @property
    def deviation(self) -> Any:
        """Standard deviations of the values, numbers of shape (p,) in the unit of each."""
        return self._column("deviation")

    @property
    def prior_share(self) -> Any:
        """How much of what is known comes from what was assumed, numbers of shape (p,) from 0 to 1, no unit."""
        return self._column("prior_share")

    @property
    def at_bound(self) -> list[bool]:
        """Whether each went as far as is believed possible, a bool each."""
        return [entry["at_bound"] for entry in self._entries]

    def _cells(self) -> list[tuple[str, ...]]:
        cells = []
        for entry in self._entries:
            note = "at its bound" if entry["at_bound"] else "as assumed" if entry.get("prior_share", 0) > 0.9 else ""
            cells.append((entry["name"], entry["unit"] or "1", *(number(entry.get(key, math.nan)) for key in ("start", "value", "deviation")),
                          f"{100 * (1 - entry.get('prior_share', math.nan)):.0f}", note))
        return cells

    _HEADINGS = ("parameter", "unit", "start", "value", "deviation", "from rows [%]", "note")

    def __str__(self) -> str:
        return _lines(self._HEADINGS, self._cells())

    def __repr__(self) -> str:
        return f"<{len(self)} parameters: {', '.join(self.name)}>"

    def _repr_html_(self) -> str:
        return _table("parameters", self._HEADINGS, self._cells())


def _lines(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    rows = [headings, *cells]
    widths = [max(len(row[column]) for row in rows) for column in range(len(headings))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def _table(caption: str, headings: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    def line(tag: str, row: Sequence[str]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row) + "</tr>"

    return (f"<table><caption>{html.escape(caption)}</caption><thead>{line('th', headings)}</thead>"
            f"<tbody>{''.join(line('td', row) for row in cells)}</tbody></table>")


class ByRow:
    """What was found of each measured row, as arrays of n rows; NaN where it is not known."""

    def __init__(self, entries: list[dict[str, Any]]) -> None:
        self._entries = entries

    def __len__(self) -> int:
        return len(self._entries)

    def _column(self, name: str, otherwise: Any = math.nan) -> Any:
        return _arrays.to_array([entry.get(name, otherwise) for entry in self._entries])

    @property
    def distance(self) -> Any:
        """Distances between the marker measured and that of the fitted arm, numbers of shape (n,) [m]."""
        return self._column("distance")

    @property
    def held_out_distance(self) -> Any:
        """The same of fits that have not seen the row, numbers of shape (n,) [m]."""
        return self._column("held_out_distance")

    @property
    def computed(self) -> Any:
        """Where the fitted arm would show the marker, numbers of shape (n, 3) [m]."""
        return self._column("computed", [math.nan] * 3)

    def __repr__(self) -> str:
        return f"<of {len(self)} rows: distance, held_out_distance, computed>"


class Identification(Answer):
    """What `Robot.identify` found: `status`, `parameters`, `errors`, `flat`, and the fitted arm as a `robot`."""

    __slots__ = ("_fitted",)

    def __init__(self, robot: Robot, question: str, text: str) -> None:
        super().__init__(robot, question, text)
        self._fitted: Robot | None = None

    def __getitem__(self, name: str | int) -> Any:
        if name == "parameters":
            return Parameters(self._plain()["parameters"])
        if name == "by_row":
            return ByRow(self._plain()["by_row"])
        return super().__getitem__(name)

    @property
    def robot(self) -> Robot:
        """The fitted arm, to be asked right away. Raises `InputError` where there is none: see `status`, `message`."""
        if self._fitted is None:
            text = self._plain().get("file")
            if text is None:
                raise InputError(f"there is no fitted arm: {self.status}{': ' + self.message if self.message else ''}", "no_file", "file")
            from .robot import Robot
            self._fitted = Robot(text)
        return self._fitted

    @property
    def asked(self) -> Robot:
        """The arm that the fit began with."""
        return self._robot

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the fitted arm as the robot file `path`. Raises `InputError` where there is none."""
        self.robot
        with open(path, "w", encoding="utf-8") as file:
            file.write(self._plain()["file"])

    _ERRORS = ("errors [mm]", "rows", "rms", "median", "max", "failed")

    def _error_cells(self) -> list[tuple[str, ...]]:
        return [(name, str(errors["rows"]), *(f"{1e3 * errors[key]:.3f}" if key in errors else "-" for key in ("rms", "median", "max")),
                 str(errors["failed"])) for name, errors in self._plain().get("errors", {}).items()]

    def _flat_cells(self) -> list[tuple[str, ...]]:
        return [(f"{one['deviation']:.1f}" if one.get("deviation", math.inf) < 1e3 else "all", one["along"]) for one in self._plain().get("flat", [])]

    _FLAT = ("assumed deviations", "direction that the rows leave open")

    def __repr__(self) -> str:
        plain = self._plain()
        rms = plain.get("errors", {}).get("fitted", {}).get("rms")
        said = f": {self.message}" if self.message else ""
        found = f", rms {1e3 * rms:.3f} mm" if rms is not None else ""
        return f"<identify of {plain.get('robot')}: {self.status}{said} ({len(plain.get('parameters', []))} parameters, {plain.get('rows', 0)} rows{found})>"

    def __str__(self) -> str:
        parts = [repr(self), str(self["parameters"])] if "parameters" in self._plain() else [repr(self)]
        if self._flat_cells():
            parts.append(_lines(self._FLAT, self._flat_cells()))
        return "\n\n".join([*parts, _lines(self._ERRORS, self._error_cells())])

    def _repr_html_(self) -> str:
        caption = html.escape(repr(self)[1:-1])
        parts = [_table("errors", self._ERRORS, self._error_cells())]
        if "parameters" in self._plain():
            parts.append(self["parameters"]._repr_html_())
        if self._flat_cells():
            parts.append(_table("flat directions", self._FLAT, self._flat_cells()))
        return f"<div><p>{caption}</p>{''.join(parts)}</div>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Identification, (self._robot, self._question, self._text)
