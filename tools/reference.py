#!/usr/bin/env python3
"""Makes the reference of the C++ and C interface with Doxygen, and checks that it says what a user needs.

    tools/reference.py FOLDER        writes FOLDER/html/index.html

Doxygen must have nothing to warn of. Every public type, function and constant has a sentence, every field that is a number
too. Where numbers go in or come out, their unit stands in the sentence, or in that of the type or file around it: `[m]`,
`[rad]`, or words of UNIT. Generic code (math, kernel) has no units. Overloads share a sentence; operators need none. Without
Doxygen the exit status is 77.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as tree

ROOT = pathlib.Path(__file__).resolve().parent.parent
NUMBER = re.compile(r"\b(double|float|Numbers|Vec[23]?|Mat|MatrixView|Bend|SpatialWrench|SE[23]|SO3|Polygon|Curve)\b")
UNIT = re.compile(r"\[[^\]]+\]|\b(SI|units?|quaternion|share|ratio|fraction|factor|times|radians|metres|number of)\b", re.IGNORECASE)
C_HEADER = "sinew.h"  # its functions are checked; types are explained in the text around them
GENERIC = re.compile(r"(^|/)(math|kernel)/")
TEXT = re.compile(r"\s+")


def text(element):
    """What the comment of a declaration says."""
    parts = [element.find(name) for name in ("briefdescription", "detaileddescription", "inbodydescription")]
    return TEXT.sub(" ", " ".join("".join(part.itertext()) for part in parts if part is not None)).strip()


def is_special(member, owner):
    """Constructors that copy or move, assignment, destructors: they do what these always do."""
    name, own = member.findtext("name"), owner.split("::")[-1]
    arguments = member.findtext("argsstring") or ""
    if name.startswith("~") or name.startswith("operator"):
        return True
    return name == own and (arguments.startswith("()") or own in arguments)


def wants(member, around, where, owner):
    """What the documentation of a member lacks, or none."""
    kind, said = member.get("kind"), text(member)
    numbers = bool(NUMBER.search("".join(member.find("type").itertext()) if member.find("type") is not None else "") or
                   (kind == "function" and any(NUMBER.search("".join(p.itertext())) for p in member.findall("param/type"))))
    is_field = kind == "variable" and owner and member.get("static") == "no"
    if kind == "function" and is_special(member, owner) or kind != "function" and where.endswith(C_HEADER):
        return None
    if not said and kind == "typedef" and owner:
        return None  # the class around says what it is made of
    if not said:
        return "has no sentence" if numbers or not is_field else None
    if numbers and not GENERIC.search(where) and not UNIT.search(said) and not UNIT.search(around):
        return "has numbers without a unit"
    return None


def lacking_of(compound, files):
    """(file, line, name, what it lacks) of a type, namespace or file, and of its members."""
    name, place = compound.findtext("compoundname"), compound.find("location").get("file")
    is_type = compound.get("kind") in ("struct", "class", "union")
    around = text(compound) if is_type else ""
    is_nested = name.count("::") > (2 if "kernel" in name else 1)
    if is_type and not (around or is_nested or place.endswith(C_HEADER)):
        yield place, int(compound.find("location").get("line")), name, "has no sentence"
    members = [member for member in compound.iter("memberdef") if member.get("prot") == "public" and member.get("kind") != "friend"]
    shared = {member.findtext("name") for member in members if member.get("kind") == "function" and text(member)}
    for member in members:
        where = member.find("location")
        if member.findtext("name") in shared and not text(member):
            continue
        said = wants(member, f"{around} {files.get(where.get('file'), '') if is_type else ''}", where.get("file"), name if is_type else "")
        if said:
            yield where.get("file"), int(where.get("line")), f"{name}::{member.findtext('name')}", said


def main():
    if not shutil.which("doxygen"):
        print("skipped: Doxygen is not installed (Debian: apt-get install --no-install-recommends doxygen)")
        return 77
    folder = pathlib.Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(folder / "xml", ignore_errors=True)
    done = subprocess.run(["doxygen", "docs/api/Doxyfile"], cwd=ROOT, env={**os.environ, "SINEW_API_FOLDER": str(folder)}, check=False)
    files = [file for file in sorted((folder / "xml").glob("*.xml")) if file.name != "index.xml"]
    compounds = [compound for file in files if (compound := tree.parse(file).getroot().find("compounddef")) is not None]
    of_file = {compound.find("location").get("file"): text(compound) for compound in compounds if compound.get("kind") == "file"}
    lacking = set()
    for compound in compounds:
        name = compound.findtext("compoundname")
        if compound.get("kind") not in ("page", "dir") and "detail" not in name and "<" not in name and compound.get("prot") in (None, "public"):
            lacking.update(lacking_of(compound, of_file))
    for file, line, name, said in sorted(lacking):
        print(f"{file}:{line}: {name} {said}")
    print(f"{folder}/html/index.html: {len(of_file)} headers, {len(lacking)} sentences lack")
    return 1 if lacking or done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
