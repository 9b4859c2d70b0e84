"""Lists of numbers as arrays. NumPy is imported when the first array is wanted, and only if it is installed; without it
columns are what has the buffer protocol (array.array, memoryview) and answers have memoryviews: _views.py.
"""
from __future__ import annotations

import functools
import math
from typing import Any

from ._errors import InputError


@functools.cache
def numpy() -> Any:
    """The module, or None."""
    try:
        import numpy as found
    except ImportError:
        return None
    return found


def to_array(values: list[Any]) -> Any:
    """An array where there is NumPy, else the list as it is."""
    np = numpy()
    return values if np is None else np.array(values)


def depth(value: Any) -> int:
    """How many levels of lists of numbers this is; 0 where lists are uneven, empty, or hold anything else."""
    return len(_sizes(value))


def _sizes(value: Any) -> tuple[int, ...]:
    if type(value) is not list or not value:
        return ()
    if type(value[0]) is list:
        below = _sizes(value[0])
        return (len(value), *below) if below and all(_sizes(item) == below for item in value) else ()
    return (len(value),) if all(type(item) in (float, int) for item in value) else ()


def shape_text(shape: Any) -> str:
    return "(" + ", ".join(str(size) for size in shape) + ("," if len(shape) == 1 else "") + ")"


def shape(array: Any) -> str:
    return shape_text(array.shape)


def _refuse(field: dict[str, Any], found: str) -> InputError:
    rest = ", ".join(str(size) for size in field["shape"])
    one, many = f"({rest}{',' if len(field['shape']) == 1 else ''})", f"(n, {rest})" if rest else "(n,)"
    return InputError(f"{field['name']} {found}; give numbers of shape {one}, or {many} for n rows", "wrong_array", field["name"])


def column(value: Any, field: dict[str, Any]) -> Any:
    """The argument as doubles that the library can read where they lie: itself where it is an array of such, else a copy.

    Whole numbers and other floating point numbers are converted. What might lose something is refused: complex numbers,
    objects, texts, masks, units.
    """
    np = numpy()
    if np is None:
        from ._views import column as of_buffer
        return of_buffer(value, field, _refuse)
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        raise _refuse(field, "is no array of numbers") from None
    if array.dtype.kind not in "fiu":
        raise _refuse(field, f"has numbers of type {array.dtype}")
    lost = _lost(value)
    if lost:
        raise _refuse(field, lost)
    if array.dtype != np.float64 or not array.dtype.isnative or not array.flags.aligned:
        array = np.require(array, np.float64, "A")
    rank = len(field["shape"])
    if array.ndim not in (rank, rank + 1) or list(array.shape[array.ndim - rank:]) != list(field["shape"]):
        raise _refuse(field, f"has shape {shape(array)}")
    return array


def _lost(value: Any) -> str:
    """What an array of doubles would lose of this, in words; also of one number in lists. Empty: nothing."""
    np = numpy()
    if isinstance(value, (list, tuple)):
        return next(filter(None, map(_lost, value)), "")
    if type(value) in (float, int, np.ndarray):
        return ""
    if isinstance(value, (bool, np.bool_)):
        return "has numbers of type bool"
    if hasattr(value, "units") or hasattr(value, "unit"):
        return "has a unit of its own, which would be lost: convert it to SI and leave the unit out"
    return "has masked numbers: fill them" if np.ma.is_masked(value) else ""


def flat_rows(array: Any) -> Any:
    """(n, a, b) as (n, a b)."""
    return array.reshape(array.shape[0], math.prod(array.shape[1:]))


def repeated(array: Any, rows: int) -> Any:
    """One value for all rows, without copies of it."""
    np = numpy()
    if np is None:
        from ._views import repeated as of_buffer
        return of_buffer(array, rows)
    return np.broadcast_to(array, (rows, *array.shape))


def _is_evenly_spaced(array: Any) -> bool:
    """Whether the numbers of a row are, as the library reads and writes them. Views without NumPy are."""
    return bool(numpy() is None or array.ndim < 3 or array.strides[1] == array.shape[2] * array.strides[2])


def as_it_lies(array: Any) -> Any:
    """Where the numbers of a row are not evenly spaced a copy, in which they are."""
    return array if _is_evenly_spaced(array) else numpy().ascontiguousarray(array)


def to_be_filled(array: Any) -> Any:
    """The same of an array that is written: a new one, of which `fill` copies the numbers."""
    return array if _is_evenly_spaced(array) else numpy().empty(array.shape)


def fill(array: Any, numbers: Any) -> None:
    if numbers is not array:
        np = numpy()
        np.copyto(np.asarray(array), numbers)


def bytes_of(rows: int) -> Any:
    np = numpy()
    return memoryview(bytearray(rows)) if np is None else np.empty(rows, np.uint8)


def outputs(fields: list[dict[str, Any]], rows: int, out: Any, inputs: list[Any]) -> dict[str, Any]:
    """The arrays that the answer fills, by name: `out` where the user has some, else new ones."""
    given = _given(fields, out)
    arrays = {}
    for field in fields:
        wanted = (rows, *field["shape"])
        array = given.get(field["name"])
        if array is None:
            arrays[field["name"]] = _empty(wanted)
            continue
        array = _checked_output(field["name"], array, wanted)
        if any(_share_memory(array, other) for other in [*inputs, *arrays.values()]):
            raise InputError(f"out: {field['name']} shares memory with another array of this call; give one of its own",
                             "wrong_array", "out")
        arrays[field["name"]] = array
    return arrays


def _given(fields: list[dict[str, Any]], out: Any) -> dict[str, Any]:
    names = [field["name"] for field in fields]
    if out is None:
        return {}
    if not isinstance(out, dict):
        if len(names) != 1:
            raise InputError(f"out: the answer has {', '.join(names)}; give a dict of arrays by these names", "wrong_type", "out")
        return {names[0]: out}
    for name in out:
        if name not in names:
            raise InputError(f"out: there is no {name!r} in the answer; it has {', '.join(names)}", "unknown_key", "out")
    return out


_MOST_WORK = 10_000
"""Of NumPy's search for a number that two arrays share; columns of one table take next to none."""


def _share_memory(one: Any, other: Any) -> bool:
    from ._sinew import overlap  # late: the extension imports this module
    np = numpy()
    if np is None or not overlap(one, other):
        return overlap(one, other)
    try:
        return bool(np.shares_memory(np.asarray(one), np.asarray(other), max_work=_MOST_WORK))
    except RuntimeError:  # too hard: taken as shared
        return True


def _checked_output(name: str, array: Any, wanted: tuple[int, ...]) -> Any:
    """The array, or a view of it where it knows no shape, such as array.array."""
    rule = f"out: {name} has to be a writable array of native doubles of shape {shape_text(wanted)}"
    try:
        view = memoryview(array)
    except (TypeError, ValueError):
        raise InputError(f"{rule}; found {type(array).__name__}", "wrong_array", "out") from None
    if view.format.lstrip("@=") != "d" or view.readonly or view.shape != wanted:
        found = f"{'read-only ' if view.readonly else ''}numbers of format {view.format!r}, shape {shape_text(view.shape)}"
        raise InputError(f"{rule}; found {found}", "wrong_array", "out")
    return array if hasattr(array, "shape") else view


def _empty(wanted: tuple[int, ...]) -> Any:
    np = numpy()
    if np is None:
        from ._views import empty
        return empty(wanted)
    return np.empty(wanted)


def row_of(array: Any, row: int) -> Any:
    if numpy() is None:
        from ._views import row_of as of_buffer
        return of_buffer(array, row)
    return array[row].tolist()


def equal(statuses: Any, code: int) -> Any:
    return [one == code for one in statuses] if numpy() is None else statuses == code


def counts(statuses: Any) -> list[tuple[int, int]]:
    np = numpy()
    if np is None:
        import collections
        return sorted(collections.Counter(statuses).items())
    codes = np.bincount(statuses, minlength=1)
    return [(int(code), int(codes[code])) for code in np.flatnonzero(codes)]
