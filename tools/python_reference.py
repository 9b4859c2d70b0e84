#!/usr/bin/env python3
"""Checks that the docstrings of the Python module say what a user needs, and that docs/python-reference.md has them all.

    PYTHONPATH=build/dev/python tools/python_reference.py

Every public function, class, method and attribute has a sentence that names its parameters. Where numbers go in or come out,
by the types that are written there, it says their shape and their unit, or that of the class around it does. What raises
InputError says so.
"""
import ast
import enum
import inspect
import pathlib
import re
import sys
import textwrap

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "python-reference.md"
NUMBERS = re.compile(r"\b(Any|float|int|complex|Array|Numbers?|Lists|Mapping|dict)\b")
SHAPE = re.compile(r"\((\w+|\.\.\.)(, ?[\w. ]+)*,?\)|\b(numbers?|bool|shapes?|record|dict|text)\b", re.IGNORECASE)
UNIT = re.compile(r"\[[^\]]+\]|\b(SI|units?|number of|whether|bytes|in mm|Status|JSON)\b", re.IGNORECASE)
NO_USERS = {"layout", "run"}  # of the extension, for the package itself
ENTRY = re.compile(r"^    (\w+) \(([^)]*)\)( \[[^\]]+\])?: (.*(?:\n {8}.*)*)", re.M)


def attributes_of(one):
    """Docstrings below attributes, which only the source has."""
    body = ast.parse(textwrap.dedent(inspect.getsource(one))).body[0].body
    for before, after in zip(body, body[1:] + [ast.Pass()]):
        if isinstance(before, (ast.AnnAssign, ast.Assign)):
            name = (before.target if isinstance(before, ast.AnnAssign) else before.targets[0]).id
            type_text = ast.unparse(before.annotation) if isinstance(before, ast.AnnAssign) else ""
            said = ast.literal_eval(after.value) if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
            if not name.startswith("_"):
                yield name, said, type_text


def signature_of(value):
    """(parameters, types as text)"""
    function = value.fget if isinstance(value, property) else value
    try:
        found = inspect.signature(function)
    except (TypeError, ValueError):
        return [], ""
    types = [str(item.annotation) for item in found.parameters.values() if item.annotation is not item.empty]
    types += [str(found.return_annotation)] if found.return_annotation is not found.empty else []
    return [name for name in found.parameters if name != "self"], " ".join(types)


def source_of(value):
    try:
        return inspect.getsource(value.fget if isinstance(value, property) else value)
    except (TypeError, OSError):
        return ""


def members_of(one):
    """(name, what it says, types, parameters, source) of a class's public members."""
    of_source = {}
    for base in reversed(one.__mro__):
        if base.__module__.startswith("sinew.") and base.__module__ != "sinew._sinew":
            of_source.update({name: (said, types) for name, said, types in attributes_of(base)})
    for name, (said, types) in of_source.items():
        if name not in ("__slots__",):
            yield name, said, "" if issubclass(one, enum.Enum) else types, [], ""
    for base in one.__mro__:
        if not base.__module__.startswith("sinew"):
            continue
        for name, value in vars(base).items():
            is_member = callable(value) or isinstance(value, property) or inspect.isgetsetdescriptor(value)
            if not name.startswith("_") and is_member and name not in of_source and name not in NO_USERS:
                of_source[name] = True
                parameters, types = signature_of(value)
                yield name, inspect.getdoc(value) or "", types, parameters, source_of(value)


def lacking(said, around, types, parameters, source):
    """What a docstring lacks, each in words."""
    if not said:
        yield "has no sentence"
        return
    for name in parameters:
        if not re.search(rf"\b{name}\b", said):
            yield f"does not say what {name} is"
    if NUMBERS.search(types):
        if not SHAPE.search(said) and not SHAPE.search(around):
            yield "has numbers without a shape"
        if not UNIT.search(said) and not UNIT.search(around):
            yield "has numbers without a unit"
    if "raise InputError" in source and "InputError" not in said:
        yield "raises InputError and does not say so"


def lacking_of_fields(said):
    """A question's fields that are numbers without a shape or a unit that they have."""
    for name, kind, unit, text in ENTRY.findall(said):
        text = re.sub(r"\s+", " ", text)
        if kind == "numbers" and not re.search(r"\(\w+,.*\)", text):
            yield f"{name} has no shape"
        if kind in ("numbers", "lists of numbers", "pose") and not unit and not re.search(r"sign|side|in which|direction|how far", text):
            yield f"{name} has no unit"


def main():
    import sinew
    from sinew._view import View
    page, told = PAGE.read_text(encoding="utf-8"), []
    things = [(name, getattr(sinew, name)) for name in sinew.__all__] + [("_view.View", View)]
    count = 0
    for name, thing in things:
        if not re.search(rf"^\.\. auto(class|function):: (sinew\.)?{re.escape(name)}$", page, re.M):
            told.append(f"{PAGE.name} does not have {name}")
        around = inspect.getdoc(thing) or ""
        found = [("", around, "", [], "")]
        if inspect.isclass(thing):
            found += members_of(thing)
        else:
            parameters, types = signature_of(thing)
            found = [("", around, types, parameters, source_of(thing))]
        count += len(found)
        for member, said, types, parameters, source in found:
            place = f"sinew.{name}.{member}" if member else f"sinew.{name}"
            told += [f"{place} {what}" for what in lacking(said, around if member else "", types, parameters, source)]
            if inspect.isclass(thing) and "Fields, all by keyword" in said:
                told += [f"{place}: {what}" for what in lacking_of_fields(said)]
    print("\n".join([*told, f"{count} public names, {len(told)} sentences lack"]))
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
