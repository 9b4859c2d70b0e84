#!/usr/bin/env python3
"""Writes python/sinew/_verbs.pyi, the robots' methods for readers and type checkers, of the table of fields.

usage: python_stubs.py [--check]
"""
import importlib.util
import pathlib
import sys
import types

PACKAGE = pathlib.Path(__file__).resolve().parent.parent / "python" / "sinew"
HEAD = '''"""Written by tools/python_stubs.py of _fields.py."""
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ._types import Lists, Number, Numbers, Pose, Rows
from .answer import Answer, Record
from .identification import Identification

class Verbs:
'''


def loaded(name):
    """A module of the package, without the extension."""
    if "sinew" not in sys.modules:
        sys.modules["sinew"] = types.ModuleType("sinew")
        sys.modules["sinew"].__path__ = [str(PACKAGE)]
    spec = importlib.util.spec_from_file_location(f"sinew.{name}", PACKAGE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[f"sinew.{name}"] = module
    spec.loader.exec_module(module)
    return module


def method(name, fields, verbs):
    parameters = ["self"]
    for index, field in enumerate(fields.VERBS[name].fields):
        if index == 1:
            parameters.append("*")
        parameters.append(f"{field}: {fields.KINDS[fields.FIELDS[field].kind].type} | None = None")
    if name not in fields.SINGLE:
        parameters += ["outputs: Mapping[str, str] | Sequence[str] | None = None", "path: str | None = None",
                       "threads: int | None = None", "out: Any = None"]
    if name == "identify":
        parameters.append("progress: Callable[[Record], Any] | bool | None = None")
    text = "\n".join(("        " + line).rstrip() for line in verbs.document(name).splitlines()).lstrip()
    inside = ",\n        ".join(parameters)
    return f'    def {name}(\n        {inside},\n    ) -> {"Identification" if name == "identify" else "Answer"}:\n        """{text}\n        """\n'


def main():
    fields, verbs = loaded("_fields"), loaded("_verbs")
    text = HEAD + "\n".join(method(name, fields, verbs) for name in fields.VERBS)
    path = PACKAGE / "_verbs.pyi"
    if "--check" in sys.argv[1:]:
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            sys.exit(f"{path.name} is not what the table of fields gives: run tools/python_stubs.py")
    else:
        path.write_text(text, encoding="utf-8")


main()
