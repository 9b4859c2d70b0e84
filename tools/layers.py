#!/usr/bin/env python3
"""Checks that includes go only downwards through the layers, and warns of files that grow too large.

    tools/layers.py             check; exit status 1 if a rule is broken
    tools/layers.py --graph     print the layers and what each of them includes
"""
import argparse
import collections
import pathlib
import re
import sys

# Top to bottom. A layer includes itself and everything in the rows below it; layers in one row do not include
# each other, but for the pairs in SIBLINGS.
ROWS = [
    ["cli", "server", "python", "octave", "firmware"],
    ["study", "abi"],
    ["query"],
    ["plan"],
    ["io"],
    ["analysis"],
    ["kinematics"],
    ["robot"],
    ["leg"],
    ["link", "tendon", "strain"],
    ["math", "solve"],
    ["kernel", "base"],
]
SIBLINGS = {("solve", "math"), ("cli", "server")}
# Headers at the top of include/sinew that are themselves what a layer has to say; the others there list headers.
TOP = {"session.hpp": "query", "batch.hpp": "query", "units.hpp": "base"}
APPS = set(ROWS[0])
LAYERS = [layer for row in ROWS for layer in row]
HEIGHT = {layer: len(ROWS) - i for i, row in enumerate(ROWS) for layer in row}

# What a user of the installed library has: any other library in a public header breaks his build.
PUBLIC_LIBRARIES = ("Eigen/", "tl/expected.hpp")
# Vectors need these; decompositions and the slow rest of Eigen belongs behind functions in few .cpp files.
PUBLIC_EIGEN = {"Eigen/Core", "Eigen/Geometry"}

HEADER_LINES = 300
FOLDER_FILES = 15
SUFFIXES = {".hpp", ".h", ".cpp", ".cc"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def source_files(root):
    """(path, layer) of every file that lives in a layer; the layer is None for one at the top of include/sinew that lists others."""
    for folder in ["include/sinew", "src", "kernel/include/sinew", *sorted(APPS)]:
        for path in sorted((root / folder).rglob("*")):
            inside = path.relative_to(root / folder)
            if path.suffix not in SUFFIXES or "build" in inside.parts or "node_modules" in inside.parts:
                continue
            if folder in APPS:
                yield path, folder
            elif len(inside.parts) > 1:
                yield path, inside.parts[0]
            elif folder == "include/sinew":
                yield path, TOP.get(path.name)


def included_layer(target):
    """The layer of `sinew/robot/robot.hpp` or of a private `robot/assembly.hpp`; '' at the top of include/sinew."""
    parts = target.split("/")
    if parts[0] == "sinew":
        return parts[1] if len(parts) > 2 else TOP.get(parts[1], "")
    return parts[0] if len(parts) > 1 and parts[0] in HEIGHT else None


def may_include(upper, lower):
    return upper == lower or HEIGHT[upper] > HEIGHT[lower] or (upper, lower) in SIBLINGS


def broken_rule(path, layer, bracket, target, root):
    """What is wrong with this include, or None."""
    public = root / "include" in path.parents
    if layer == "kernel" and root / "kernel" in path.parents:
        if not target.startswith("sinew/kernel/"):
            return "the kernel is freestanding: a kernel header includes only other kernel headers"
    lower = included_layer(target)
    if lower is None:
        library = bracket == "<" and ("/" in target or target.endswith((".h", ".hpp")))
        if public and library and not target.startswith(PUBLIC_LIBRARIES):
            return "a public header includes only the standard library, Eigen and tl/expected.hpp"
        return None
    if lower == "":
        if layer is not None and layer not in APPS:
            return "no layer includes a header that stands above all layers"
        return None
    if lower not in HEIGHT:
        return f"'{lower}' is not a layer (layers are named in tools/layers.py)"
    if public and not target.startswith("sinew/"):
        return "a public header includes no private one"
    if layer is None or may_include(layer, lower):
        return None
    if lower in APPS:
        return f"nothing includes {lower}, it is an application"
    if HEIGHT[layer] == HEIGHT[lower]:
        return f"{layer} and {lower} are siblings and do not include each other"
    return f"{layer} is below {lower}: includes go downwards only"


def check(root):
    """(violations, warnings, counts of includes between layers)"""
    violations, warnings = [], []
    edges = collections.Counter()
    folders = collections.Counter()
    for path, layer in source_files(root):
        shown = path.relative_to(root).as_posix()
        lines = path.read_text(encoding="utf-8").splitlines()
        folders[path.parent, path.suffix] += 1
        if path.suffix in {".hpp", ".h"} and len(lines) > HEADER_LINES:
            warnings.append(f"{shown}: {len(lines)} lines; a header stays under {HEADER_LINES}")
        if layer is not None and layer not in HEIGHT:
            violations.append(f"{shown}:1: '{layer}' is not a layer (layers are named in tools/layers.py)")
            continue
        for number, line in enumerate(lines, 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            if match[2].startswith("Eigen/") and match[2] not in PUBLIC_EIGEN and root / "include" in path.parents:
                warnings.append(f"{shown}:{number}: {match[2]} is slow to compile; keep it in a .cpp file")
            rule = broken_rule(path, layer, *match.groups(), root)
            if rule:
                violations.append(f'{shown}:{number}: includes "{match[2]}": {rule}')
            lower = included_layer(match[2])
            if layer and lower and lower != layer:
                edges[layer, lower] += 1
    for (folder, suffix), count in sorted(folders.items()):
        if count > FOLDER_FILES:
            warnings.append(f"{folder.relative_to(root).as_posix()}: {count} {suffix} files; "
                            f"a folder stays under {FOLDER_FILES}")
    return violations, warnings, edges


def print_graph(edges):
    for row in ROWS:
        print("  |  ".join(row))
        for upper in row:
            below = [f"{lower} ({edges[upper, lower]})" for lower in LAYERS if edges[upper, lower]]
            if below:
                print(f"    {upper} -> {', '.join(below)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--graph", action="store_true", help="print the layers and what each of them includes")
    options = parser.parse_args()

    violations, warnings, edges = check(options.root.resolve())
    if options.graph:
        print_graph(edges)
        return 0
    for warning in warnings:
        print(f"warning: {warning}")
    for violation in violations:
        print(violation)
    print(f"layers: {sum(edges.values())} includes between layers, {len(violations)} violations, "
          f"{len(warnings)} warnings")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
