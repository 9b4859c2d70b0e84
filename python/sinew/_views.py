"""Columns where NumPy is not installed: memoryviews."""
from __future__ import annotations

import array
import math
from collections.abc import Callable
from typing import Any


def empty(shape: tuple[int, ...]) -> Any:
    size = math.prod(shape)
    flat: Any = memoryview(bytearray(8 * size))
    return flat.cast("d", list(shape)) if size else flat.cast("d")  # views of nothing have one dimension


def _flat(value: Any) -> tuple[list[Any], list[int]]:
    """Numbers of nested lists, and the lists' lengths."""
    if isinstance(value, (bool, str)):
        raise TypeError("no number")
    if not isinstance(value, (list, tuple)):
        return [float(value)], []
    parts = [_flat(item) for item in value]
    if any(part[1] != parts[0][1] for part in parts):
        raise ValueError("uneven")
    return [number for part in parts for number in part[0]], [len(parts), *(parts[0][1] if parts else [])]


def column(value: Any, field: dict[str, Any], refuse: Callable[[dict[str, Any], str], Exception]) -> Any:
    view: Any = None
    if isinstance(value, (bytes, bytearray)):
        raise refuse(field, "is no array of numbers")
    try:
        view = memoryview(value)
    except TypeError:
        pass
    if view is not None and view.format not in tuple("bBhHiIlLqQfd"):
        raise refuse(field, f"has numbers of format {view.format!r}")
    if view is None or view.format != "d":
        try:
            numbers, shape = _flat(value if view is None else view.tolist())
        except (TypeError, ValueError):
            raise refuse(field, "is no array of numbers") from None
        data = memoryview(array.array("d", numbers)).cast("B")
        view = data.cast("d", shape) if shape else data.cast("d", [])
    rank = len(field["shape"])
    if view.ndim not in (rank, rank + 1) or list(view.shape[view.ndim - rank:]) != field["shape"]:
        raise refuse(field, f"has shape {tuple(view.shape)}")
    return view


def repeated(view: Any, rows: int) -> Any:
    numbers = _flat(view.tolist() if view.ndim else [view[()]])[0]
    data = memoryview(array.array("d", numbers * rows)).cast("B")
    return data.cast("d", [rows, *view.shape]) if rows else view


def row_of(view: Any, row: int) -> Any:
    if view.ndim == 1:
        return view[row]
    if view.ndim == 2:
        return [view[row, index] for index in range(view.shape[1])]
    return view.tolist()[row]
