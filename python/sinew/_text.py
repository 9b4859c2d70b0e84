"""Answers as lines for a terminal."""
from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .answer import Answer

_WIDTH = 100


def number(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def short(value: Any) -> str:
    """Numbers to six digits, long lists by their size."""
    if type(value) is list:
        text = "[" + ", ".join(short(item) for item in value) + "]"
        return text if len(text) <= _WIDTH else f"list of {len(value)}"
    if type(value) is dict:
        return "{" + ", ".join(f"{name}: {short(item)}" for name, item in value.items()) + "}"
    return number(value)


def rows_of(answer: Answer) -> Iterator[tuple[str, str, str]]:
    """Name, value, unit of what fits on a line."""
    units = answer.units
    for name, value in answer._plain().items():
        if name in ("query", "robot", "status", "message", "id"):
            continue
        members = value.items() if type(value) is dict else [("", value)]
        for member, item in members:
            place = f"{name}.{member}" if member else name
            unit = units.get(place, units.get(name, "")) if not isinstance(item, (bool, str)) else ""
            yield place, short(item), unit


def lines_of(answer: Answer) -> list[str]:
    rows = list(rows_of(answer))
    width = max((len(place) for place, _, _ in rows), default=0)
    return [f"  {place:<{width}}  {value if len(value) <= _WIDTH else value[:_WIDTH] + '...'}{' ' + unit if unit else ''}"
            for place, value, unit in rows]
