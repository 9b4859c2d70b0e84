#!/usr/bin/env python3
"""Writes what is made of the table of fields (src/query/fields/fields.cpp): the schema of queries, the table of the
protocol page between its markers, and that of the Python module, of which tools/python_stubs.py makes stubs.

    tools/fields.py SINEW            write them
    tools/fields.py SINEW --check    say what is out of date, and end with 1

SINEW is the command, whose `help fields --json` is the table."""
import json
import pathlib
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent

QUANTITY = {"description": "SI, or text with a unit.", "anyOf": [{"type": "number"}, {"type": "string", "pattern": "^\\s*[-+]?[.0-9]"}]}
NUMBERS = {"type": "array", "items": {"$ref": "#/definitions/quantity"}}
LISTS = {"type": "array", "items": {"anyOf": [{"$ref": "#/definitions/quantity"}, {"type": "null"}, NUMBERS,
         {"type": "array", "items": {"anyOf": [{"$ref": "#/definitions/quantity"}, {"type": "null"}]}}]}}


def keyed(*names):
    return {"type": "object", "properties": {name: {"$ref": "#/definitions/quantity"} for name in names},
            "additionalProperties": False}


DEFINITIONS = {
    "quantity": QUANTITY,
    "pose": {"anyOf": [
        {**keyed("x", "y", "phi"), "required": ["x", "y", "phi"]},
        {"type": "object", "required": ["position"], "additionalProperties": False, "properties": {
            "position": {**NUMBERS, "minItems": 3, "maxItems": 3},
            "quaternion": {**NUMBERS, "minItems": 4, "maxItems": 4},
            **{angle: {"$ref": "#/definitions/quantity"} for angle in ("tilt", "azimuth", "torsion")}}}]},
    "independent": {"type": "object", "required": ["z", "e1", "e2"], "additionalProperties": False, "properties": {
        **keyed("z", "e1", "e2")["properties"], "mode": {"enum": ["tilt", "half_turn"]}}},
    "place": {"anyOf": [{"$ref": "#/definitions/pose"}, {"$ref": "#/definitions/independent"}]},
}
# What identify can fit: docs/identify.md.
FITTED = (" *((sections|tendons|passages)\\.)?(bending|torsion|curvature|angle|radius|compliance|pretension|toe|offset|gain|lag|play|gravity|mass|"
          "tip_mass|marker|base|tilt)(\\.[xyz])?")
SHAPES = {
    "flag": {"type": "boolean"},
    "whole": {"$ref": "#/definitions/quantity"},
    "quantity": {"$ref": "#/definitions/quantity"},
    "words": {"type": "array"},
    "point": {**NUMBERS, "minItems": 3, "maxItems": 3},
    "numbers": NUMBERS,
    "inputs": NUMBERS,
    "per_leg": NUMBERS,
    "signs": {"type": "array", "items": {"enum": [1, -1]}},
    "pairs": LISTS,
    "lists": LISTS,
    "pose": {"$ref": "#/definitions/pose"},
    "independent": {"$ref": "#/definitions/independent"},
    "start": {"anyOf": [{"$ref": "#/definitions/place"}, LISTS, {"const": "last"},
                        {"type": "object", "properties": {"pose": {"$ref": "#/definitions/place"}, "curvatures": {"type": "array"}},
                         "required": ["pose", "curvatures"], "additionalProperties": False}]},
    "place": {"$ref": "#/definitions/place"},
    "places": {"type": "array", "items": {"$ref": "#/definitions/place"}},
    "target": {"anyOf": [{"$ref": "#/definitions/place"}, {
        "type": "object", "additionalProperties": False,
        "properties": {"inputs": NUMBERS, "tensions": LISTS, "lengths": LISTS, "wrench": NUMBERS,
                       "pose": {"$ref": "#/definitions/pose"}}}]},
    "wrench": NUMBERS,
    "twist": NUMBERS,
    "growing_load": {"type": "object", "required": ["wrench", "limit"], "additionalProperties": False,
                     "properties": {"wrench": NUMBERS, "limit": {"$ref": "#/definitions/quantity"}}},
    "range": {**NUMBERS, "minItems": 2, "maxItems": 2},
    "text_or_number": {"type": ["string", "number"]},
    "settings": {"type": "object"},
    "path_points": {"type": "array", "minItems": 1, "items": {"type": "object", "additionalProperties": False, "properties": {
        "tensions": LISTS, "changes": LISTS, "wrench": NUMBERS, "following": NUMBERS,
        **{name: {**NUMBERS, "minItems": 3, "maxItems": 3} for name in ("distributed", "distributed_following", "gravity")},
        "loads": {"$ref": "#/properties/loads"}, "pose": {"$ref": "#/properties/pose"}}}},
    "names": {"anyOf": [{"type": "string", "pattern": f"^{FITTED}( *,{FITTED})* *$"},
                        {"type": "array", "minItems": 1, "items": {"type": "string", "pattern": f"^{FITTED} *$"}}]},
    "measured_rows": {"anyOf": [{"type": "string", "pattern": "\\n"}, {
        "type": "object", "required": ["pulls", "markers"], "additionalProperties": False,
        "properties": {**{name: {"type": "array", "items": NUMBERS} for name in ("pulls", "markers")}, "time": NUMBERS,
                       "blocks": {"type": "array", "items": {"type": "integer"}}}}]},
    "point_loads": {"type": "array", "items": {"type": "object", "required": ["place", "wrench"], "additionalProperties": False,
                    "properties": {"place": {"$ref": "#/definitions/quantity"}, "wrench": NUMBERS,
                                   "following": {"type": "boolean"}, "leg": {"type": "integer", "minimum": 0}}}},
}


def schema_of(field):
    schema = dict(SHAPES.get(field["shape"], {}))
    if field["shape"] == "word":
        schema = {"enum": field["words"]}
    if field["shape"] == "words":
        schema["items"] = {"enum": field["words"]}
    if field["name"] == "deviation":  # one for all, or one each
        schema = {"anyOf": [{"$ref": "#/definitions/quantity"}, NUMBERS]}
    unit = f' [{field["unit"]}]' if field["unit"] and field["shape"] in ("quantity", "point", "numbers", "per_leg") else ""
    value = {"anyOf": [schema, {"type": "null"}]} if field["name"] != "query" else schema
    return {"description": plain(field["meaning"]) + unit, **value}


def plain(meaning):
    return meaning.replace("`", "")


def schema(fields):
    kinds = next(field for field in fields if field["name"] == "query")["words"]
    of_kind = [{
        "if": {"properties": {"query": {"const": kind}}, "required": ["query"]},
        "then": {"propertyNames": {"enum": [field["name"] for field in fields if kind in field["uses"]]}},
    } for kind in kinds]
    return json.dumps({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "sinew query, version 1",
        "description": "One question to a robot. Made by tools/fields.py of the table of fields; what the values mean and "
                       "which robots take them: docs/protocol.md.",
        "definitions": DEFINITIONS,
        "type": "object",
        "properties": {field["name"]: schema_of(field) for field in fields},
        "required": ["query"],
        "allOf": of_kind,
    }, indent=2, ensure_ascii=False) + "\n"


def shown(field):
    words = {"flag": "true or false", "whole": "a whole number", "word": "a word", "words": "a list of words",
             "per_leg": "a number a leg", "inputs": "a number an input", "pairs": "two numbers a leg",
             "lists": "a list a leg or section", "growing_load": "`{\"wrench\", \"limit\"}`", "settings": "`{path: value}`", "point_loads": "a list of `{\"place\", \"wrench\"}`", "path_points": "a list of `{\"tensions\", ...}`",
             "measured_rows": "`{\"pulls\", \"markers\", ...}` or text", "names": "names",
             "text_or_number": "text or a number", "independent": "`{\"z\", \"e1\", \"e2\"}`", "places": "a list of places",
             "target": "a place, or a map", "place": "a pose, or `{\"z\", \"e1\", \"e2\"}`", "quantity": "a number",
             "point": "three numbers", "range": "two numbers", "numbers": "numbers"}
    return words.get(field["shape"], field["shape"])


def table(fields):
    everyone = {"kinematic", "chains", "rods", "serial", "arms"}
    lines = ["| field | value | of | meaning |", "|---|---|---|---|"]
    for field in fields:
        uses = field["uses"]
        if uses == fields[0]["uses"]:
            of = "all"
        else:
            of = "; ".join(f'`{kind}`' + ("" if set(takers) == everyone else f' ({", ".join(takers)})')
                           for kind, takers in uses.items())
        unit = f' [{field["unit"]}]' if field["unit"] and field["shape"] in ("quantity", "point", "numbers", "per_leg") else ""
        lines.append(f'| `{field["name"]}` | {shown(field)}{unit} | {of} | {field["meaning"]} |')
    return "\n".join(lines) + "\n"


# Of the Python module: what a field is as a type, what its numbers measure, and how an array of them lies.
PYTHON_KINDS = {
    "flag": "flag", "whole": "count", "quantity": "number", "word": "word", "words": "words", "point": "numbers",
    "numbers": "numbers", "inputs": "numbers", "per_leg": "numbers", "signs": "numbers", "wrench": "numbers",
    "twist": "numbers", "range": "numbers", "pairs": "lists", "lists": "lists", "pose": "pose", "independent": "map",
    "start": "any", "place": "any", "places": "poses", "target": "map", "growing_load": "map", "settings": "map", "point_loads": "any", "path_points": "any",
    "measured_rows": "rows", "names": "names",
    "text_or_number": "any",
}
PYTHON_UNITS = {"inputs": "m, rad", "pose": "m, rad", "independent": "m", "wrench": "N, N m", "twist": "m/s, rad/s",
                "places": "m, rad", "place": "m, rad", "start": "", "target": ""}
UNITS_BY_NAME = {"distributed": "N/m", "distributed_following": "N/m"}  # of no dimension that has a name
PYTHON_ARRAYS = {"inputs": "(k,), or (n, k) for n rows", "point": "(3,)", "per_leg": "(legs,)", "signs": "(legs,)",
                 "pairs": "(legs, 2)", "wrench": "(3,) in the plane, (6,) in space", "twist": "(3,) in the plane, (6,) in space",
                 "range": "(2,)"}
PYTHON_FIRST = {"forward": "inputs", "inverse": "pose", "velocity": "pose", "shape": "pose", "statics": "pose", "track": "poses",
                "diagram": "section", "identify": "rows", "describe": "set"}


def python_table(fields, answers):
    def name_of(field):
        return "from_" if field["name"] == "from" else field["name"]

    fields = [field for field in fields if field["name"] not in ("query", "id")]
    lines = ['"""Fields of questions, and which questions take them. Made by tools/fields.py of the table of fields."""', "", "FIELDS = ("]
    for field in fields:
        shape = field["shape"]
        kind = "any" if field["name"] in ("measured", "deviation") else PYTHON_KINDS[shape]
        unit = "m/s" if field["name"] == "rates" else "rad, m" if field["name"] == "configuration" else UNITS_BY_NAME.get(field["name"], PYTHON_UNITS.get(shape, field["unit"]))
        array = f'; {PYTHON_ARRAYS[shape]}' if shape in PYTHON_ARRAYS else ""
        lines.append(f"    {(name_of(field), kind, unit, field['meaning'] + array)!r},")
    lines += [")", "", "QUESTIONS = {"]
    for kind, first in PYTHON_FIRST.items():
        names = [name_of(field) for field in fields if kind in field["uses"]]
        names.remove(first)
        lines.append(f"    {kind!r}: {(first, *names)!r},")
    lines += ["}", "", "UNITS = {"]
    lines += [f"    {answer['name']!r}: {answer['unit']!r}," for answer in answers if answer["unit"] or "." in answer["name"]]
    return "\n".join(lines) + "\n}\n"


def answer_table(answers):
    lines = ["| field | unit | meaning |", "|---|---|---|"]
    lines += [f"| `{answer['name']}` | {answer['unit']} | {answer['meaning']} |" for answer in answers]
    return "\n".join(lines) + "\n"


def between(text, name, made):
    begin, end = f"<!-- {name}: made by tools/fields.py -->\n", f"<!-- end of {name} -->\n"
    if begin not in text or end not in text:
        sys.exit(f"no markers of {name}")
    return text[:text.index(begin) + len(begin)] + "\n" + made + "\n" + text[text.index(end):]


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    tables = json.loads(subprocess.run([arguments[0], "help", "fields", "--json"], check=True, capture_output=True).stdout)
    fields, answers = tables["questions"], tables["answers"]
    page = root / "docs/protocol.md"
    made = {root / "schema/query.schema.json": schema(fields),
            root / "python/sinew/_table.py": python_table(fields, answers),
            page: between(between(page.read_text(), "fields", table(fields)), "numbers of answers", answer_table(answers))}
    old = [path for path, text in made.items() if not path.exists() or path.read_text() != text]
    if "--check" in sys.argv:
        for path in old:
            print(f"{path.relative_to(root)} is not what the table of fields gives; run tools/fields.py SINEW")
        sys.exit(bool(old))
    for path in old:
        path.write_text(made[path])


main()
