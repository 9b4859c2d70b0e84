"""Methods of robots, one a question, made of the table of fields. _verbs.pyi, which tools/python_stubs.py writes of the
same table, has them for readers and type checkers.
"""
from __future__ import annotations

import inspect
import textwrap
from typing import Any

from ._fields import FIELDS, VERBS

BATCH = ("outputs", "path", "threads", "out")
_BATCH_HELP = """\
threads: of n rows, default all cores; the bytes do not depend on it
out: arrays of your own that become the answer's, by name
outputs, path: as of Robot.prepare
Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row."""


def document(name: str) -> str:
    verb = VERBS[name]
    lines = [verb.text, "", "Fields, all by keyword but the first; which of them a robot takes, it says itself:"]
    for field in verb.fields:
        entry = FIELDS[field]
        unit = f" [{entry.unit}]" if entry.unit else ""
        lines += textwrap.wrap(f"{field}{unit}: {entry.text}", 100, initial_indent="    ", subsequent_indent="        ")
    lines += ["", *textwrap.wrap(f"The answer has `ok`, `status`, `message`, and {verb.answer}.", 100)]
    if name != "describe":
        lines += ["", "With arrays of one dimension more than one value needs:", *("    " + line for line in _BATCH_HELP.splitlines())]
    lines += ["", "Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`."]
    return "\n".join(lines)


def _signature(name: str) -> inspect.Signature:
    kinds = inspect.Parameter
    parameters = [kinds("self", kinds.POSITIONAL_ONLY)]
    for index, field in enumerate((*VERBS[name].fields, *(BATCH if name != "describe" else ()))):
        place = kinds.POSITIONAL_OR_KEYWORD if index == 0 else kinds.KEYWORD_ONLY
        parameters.append(kinds(field, place, default=None))
    return inspect.Signature(parameters)


def _method(name: str) -> Any:
    first = VERBS[name].fields[0]

    def ask(self: Any, value: Any = None, /, **fields: Any) -> Any:
        if value is not None:
            if first in fields:
                raise TypeError(f"{name}() got {first!r} twice")
            fields[first] = value
        return self._ask(name, fields)

    ask.__name__, ask.__qualname__, ask.__doc__ = name, f"Robot.{name}", document(name)
    ask.__module__ = "sinew"
    ask.__signature__ = _signature(name)  # type: ignore[attr-defined]
    return ask


class Verbs:
    """The questions that can be put to a robot."""


for _name in VERBS:
    setattr(Verbs, _name, _method(_name))
