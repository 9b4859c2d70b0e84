"""Methods of robots, one a question, made of the table of fields. _verbs.pyi, which tools/python_stubs.py writes of the
same table, has them for readers and type checkers.
"""
from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

from ._fields import BATCH, FIELDS, KINDS, SINGLE, VERBS

_BATCH_HELP = (
    "outputs (dict or list of str): what comes out, as of `Robot.prepare`",
    'path (str): "continue", as of `Robot.prepare`',
    "threads (int): default all cores; the bytes do not depend on it",
    "out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the answer's, by name")
_PROGRESS_HELP = (
    "progress (function or bool): told, from a thread of its own, how far the fit is: a record of `part` (str), `steps` (int) of it and `error`, the root mean square "
    "distance so far [m]; what it raises stops the fit and is raised. True: a line on stderr, the default where that is a terminal; False: nothing",)
_FRAMES = "Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before the angular."
_ARRAYS = "An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of arrays (n, ...). Also by keyword, of n rows alone:"
_SHAPES = {"numbers": "; (k,)", "lists": "; a list each, or an array"}


def _entries(texts: Iterable[str]) -> Iterator[str]:
    """Indented lines `name (kind) [unit]: text`."""
    for text in texts:
        yield from textwrap.wrap(text, 100, initial_indent="    ", subsequent_indent="        ")


def _field(name: str) -> str:
    field = FIELDS[name]
    unit = f" [{field.unit}]" if field.unit else ""
    shape = "" if re.search(r"\(\w+,[^)]*\)", field.text) else _SHAPES.get(field.kind, "")
    return f"{name} ({KINDS[field.kind].text}){unit}: {field.text}{shape}"


def document(name: str) -> str:
    """What help says of a question: all its fields with kinds, shapes and units, and those of its answer."""
    verb = VERBS[name]
    lines = [verb.text, "", *textwrap.wrap(_FRAMES, 100), "", "Fields, all by keyword but the first; which of them a robot takes, it says itself:"]
    lines += _entries(_field(field) for field in verb.fields)
    if name not in SINGLE:
        lines += ["", *textwrap.wrap(_ARRAYS, 100), *_entries(_BATCH_HELP)]
    if name == "identify":
        lines += ["", "Also by keyword:", *_entries(_PROGRESS_HELP)]
    lines += ["", "The answer has `ok`, `status`, `message`, and, as far as the robot has them:", *_entries(verb.answer)]
    lines += ["", "Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`."]
    return "\n".join(lines)


def _signature(name: str) -> inspect.Signature:
    kinds = inspect.Parameter
    parameters = [kinds("self", kinds.POSITIONAL_ONLY)]
    for index, field in enumerate((*VERBS[name].fields, *(BATCH if name not in SINGLE else ()), *(("progress",) if name == "identify" else ()))):
        place = kinds.POSITIONAL_OR_KEYWORD if index == 0 else kinds.KEYWORD_ONLY
        parameters.append(kinds(field, place, default=None))
    return inspect.Signature(parameters)


def _method(name: str) -> Any:
    first = VERBS[name].fields[0]

    def ask(self: Any, value: Any = None, /, **fields: Any) -> Any:
        if value is not None:
            field = self._subject(name, value) if first in ("inputs", "pose") else first
            if field in fields:
                raise TypeError(f"{name}() got {field!r} twice")
            fields[field] = value
        return self._ask(name, fields)

    ask.__name__, ask.__qualname__, ask.__doc__ = name, f"Robot.{name}", document(name)
    ask.__module__ = "sinew"
    ask.__signature__ = _signature(name)  # type: ignore[attr-defined]
    return ask


class Verbs:
    """The questions that can be put to a robot."""


for _name in VERBS:
    setattr(Verbs, _name, _method(_name))
