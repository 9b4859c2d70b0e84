#!/usr/bin/env python3
"""The registry of the papers' equations: each lives in one function, and a test stands behind it.

    tools/equations.py            check the tags and write docs/equations.md
    tools/equations.py --check    check the tags and that docs/equations.md is up to date

Code says `@implements TDPCR (25)`, `@implements TDPCR (26)-(27)`, `@implements LSK (1), (3)`; a test says
`@verifies` the same way. A tag may be broken over comment lines.
"""
import argparse
import collections
import pathlib
import re
import sys

PAPERS = {  # key: number of equations, title
    "TDPCR": (70, "Modelling and Analysis of Tendon-Driven Parallel Continuum Robots under Constant Curvature and "
                  "Pseudo-Rigid-Body Assumptions"),
    "LSK": (24, "Real-Time Kinematics of Continuum Robots: Modelling and Validation"),
    "3PFS": (36, "On constraints and parasitic motions of a tripod parallel continuum manipulator"),
}
PAGE = "docs/equations.md"
CODE = {".hpp", ".h", ".cpp", ".cc", ".py"}

TAG = re.compile(r"@(implements|verifies)\b\s*")
KEY = re.compile(r"([A-Z0-9]{2,})\s+(?=\()")
ITEM = re.compile(r"\((\d+)\)(?:\s*[-–]\s*\((\d+)\))?")
COMMA = re.compile(r"\s*(?:,|\band\b)\s*")
COMMENT = re.compile(r"^\s*(//|\*|/\*|#(?!\s*(include|if|endif|else|define|pragma|undef)\b)|\"\"\")")
TEST = re.compile(r"^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST|TYPED_TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)"
                  r"\(\s*(\w+)\s*,\s*(\w+)")
TYPE = re.compile(r"^\s*(?:template\s*<.*>\s*)?(?:struct|class|union|concept|enum(?:\s+class)?)\s+"
                  r"(?:alignas\(.*?\)\s*)?(?:SINEW_API\s+)?(\w+)")
CONTROL = {"if", "for", "while", "switch", "return", "catch", "else", "do", "sizeof", "alignas", "decltype", "requires",
           "static_assert", "noexcept", "explicit", "assert", "SINEW_EXPECTS"}
CALL = re.compile(r"((?:\w+::)*(?:operator\s*[^\s\w(]+|operator\(\)|~?\w+))\s*\(")

Place = collections.namedtuple("Place", "file line name")


def indent(line):
    return len(line) - len(line.lstrip())


def function_name(text):
    """The name before the first parenthesis that opens a parameter list."""
    text = re.sub(r"\[\[.*?\]\]|__attribute__\s*\(\(.*?\)\)", "", text)
    for match in CALL.finditer(text):
        if match[1] not in CONTROL:
            return match[1].replace(" ", "")
    match = re.search(r"(\w+)\s*(?:\[[^\]]*\]\s*)*(?:=|\{|;)", text)  # a constant
    return match[1] if match else None


def declaration_name(lines, start):
    """Name of what is declared at or after this line, comments, template heads and blank lines skipped."""
    text = ""
    for line in lines[start:start + 12]:
        if COMMENT.match(line) or not line.strip():
            continue
        code = line.split("//")[0].strip()
        if not text and re.match(r"(template\s*<.*>|requires\b[^({]*|\[\[\w+\]\])$", code):
            continue
        if not text and TYPE.match(code):
            return TYPE.match(code)[1]
        match = re.match(r"(?:async\s+)?def\s+(\w+)|class\s+(\w+)", code)
        if match:
            return match[1] or match[2]
        text += " " + re.sub(r"^template\s*<[^()]*?>\s+", "", code)
        if "(" in code or code.endswith((";", "{")):
            return function_name(text)
    return None


def enclosing(lines, index):
    """(types, function) around a line, read from the indentation, which clang-format guarantees."""
    depth, types = indent(lines[index]), []
    for line in reversed(lines[:index]):
        code = line.split("//")[0].rstrip()
        if not code.strip() or COMMENT.match(line) or indent(line) >= depth or code.lstrip().startswith("#"):
            continue
        depth = indent(line)
        stripped = code.strip()
        if TYPE.match(code):
            types.insert(0, TYPE.match(code)[1])
        elif not stripped.endswith((";", ":", "}")) and "(" in stripped:
            name = function_name(stripped)
            if name and not re.match(r"(if|for|while|switch|else|do|catch)\b", stripped):
                return enclosing(lines, lines.index(line))[0] + types, name
    return types, None


def place_name(lines, index):
    """The function, type or test that a tag in this line speaks of."""
    for line in [lines[index]] + [l for l in lines[index + 1:index + 8] if not COMMENT.match(l)][:1]:
        if TEST.match(line):
            return ".".join(TEST.match(line).groups())
    types, function = enclosing(lines, index)
    if function in ("TEST", "TEST_F", "TEST_P", "TYPED_TEST", "RC_GTEST_PROP"):
        function = None
    if function is None and indent(lines[index]):
        for line in reversed(lines[:index]):
            if TEST.match(line):
                return ".".join(TEST.match(line).groups())
            if line.startswith("}"):
                break
    name = function or declaration_name(lines, index)
    return "::".join(types + [name]) if name else "::".join(types) or None


def parse_tag(lines, index, start):
    """([(key, number)], problem) of the tag whose list starts at this column of this line."""
    text = lines[index][start:]
    for line in lines[index + 1:index + 4]:  # clang-format breaks comments where it likes
        if not re.match(r"\s*(//|\*|#)", line) or TAG.search(line):
            break
        text = text.rstrip() + " " + re.sub(r"^\s*(//[/!]?<?|\*|#)\s*", "", line)
    text = text.lstrip()
    equations, key, at = [], None, 0
    while True:
        match = KEY.match(text, at)
        if match:
            key, at = match[1], match.end()
            if key not in PAPERS:
                return [], f"'{key}' is not a paper; the papers are {', '.join(PAPERS)}"
        item = ITEM.match(text, at)
        if not item or key is None:
            return [], "expected a paper and equations, such as TDPCR (26)-(27), (30)"
        first, last = int(item[1]), int(item[2] or item[1])
        if not 1 <= first <= last <= PAPERS[key][0]:
            return [], f"{key} {item[0]}: {key} has equations (1) to ({PAPERS[key][0]})"
        equations += [(key, number) for number in range(first, last + 1)]
        at = item.end()
        comma = COMMA.match(text, at)
        if not comma:
            return equations, None
        if not ITEM.match(text, comma.end()) and not KEY.match(text, comma.end()):
            return equations, None  # the comma belongs to the sentence
        at = comma.end()


def scan(root, folders, kind):
    """({equation: [Place]}, problems) of one kind of tag."""
    places, problems = collections.defaultdict(list), []
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in CODE or path.name in ("tools_test.py",):
                continue
            shown = path.relative_to(root).as_posix()
            lines = path.read_text(encoding="utf-8").splitlines()
            for index, line in enumerate(lines):
                for tag in TAG.finditer(line):
                    if tag[1] != kind:
                        continue
                    equations, problem = parse_tag(lines, index, tag.end())
                    if problem:
                        problems.append(f"{shown}:{index + 1}: @{kind}: {problem}")
                    elif equations:
                        place = Place(shown, index + 1, place_name(lines, index))
                        for equation in dict.fromkeys(equations):
                            places[equation].append(place)
    return places, problems


def order(equation):
    return list(PAPERS).index(equation[0]), equation[1]


def check_tags(implemented, verified):
    problems, open_ends = [], collections.defaultdict(list)
    for equation in sorted(implemented.keys() | verified.keys(), key=order):
        shown = f"{equation[0]} ({equation[1]})"
        there, tests = implemented.get(equation, []), verified.get(equation, [])
        for place in there[1:]:
            problems.append(f"{place.file}:{place.line}: {shown} is already implemented at "
                            f"{there[0].file}:{there[0].line}; an equation lives in one place")
        if there and not tests:
            open_ends[there[0], "no test says @verifies"].append(shown)
        if tests and not there:
            open_ends[tests[0], "nothing says @implements"].append(shown)
    for (place, what), equations in sorted(open_ends.items(), key=lambda item: item[0][0][:2]):
        problems.append(f"{place.file}:{place.line}: {what} {', '.join(equations)}")
    return problems


def cell(places):
    texts = (f"{place.file}: `{place.name}`" if place.name else place.file for place in places)
    return "<br>".join(dict.fromkeys(texts))


def page(implemented, verified):
    lines = ["# Equations", "",
             "Written by `tools/equations.py` from the `@implements` and `@verifies` tags; edit the tags, not this page.",
             "Misprints of the papers are corrected in the code; the places are marked there.", ""]
    for key, (count, title) in PAPERS.items():
        equations = sorted((e for e in implemented if e[0] == key), key=order)
        lines += [f"## [{key}] {title}", "", f"{len(equations)} of {count} numbered equations.", ""]
        if equations:
            lines += ["| paper | equation | implemented in | verified in |", "|---|---|---|---|"]
            lines += [f"| {key} | ({e[1]}) | {cell(implemented[e])} | {cell(verified.get(e, []))} |" for e in equations]
            lines.append("")
    return "\n".join(lines).rstrip("\n") + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--check", action="store_true", help="write nothing; fail if the page is stale")
    options = parser.parse_args()
    root = options.root.resolve()

    implemented, problems = scan(root, ["include", "src", "kernel"], "implements")
    verified, more = scan(root, ["tests"], "verifies")
    problems += more + check_tags(implemented, verified)
    target, text = root / PAGE, page(implemented, verified)
    if not options.check:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    elif not target.exists() or target.read_text(encoding="utf-8") != text:
        problems.append(f"{PAGE} is stale; run tools/equations.py")
    for problem in problems:
        print(problem)
    print(f"equations: {len(implemented)} implemented, {len(verified)} verified, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
