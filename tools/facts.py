#!/usr/bin/env python3
"""Checks that lists in the documentation are those of the program.

usage: facts.py COMMAND
Built-in robots, kinds of `sinew new`, links and closures (of the schema, which a test of its own holds to the reader),
statuses and queries must each be named, in backquotes, in docs/robot-files.md or docs/protocol.md.
"""
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def text(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def output(*command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
    return done.stdout + done.stderr


def types(schema, key):
    """Every value that the schema allows for link.type or closure.type."""
    found = set()
    if isinstance(schema, dict):
        below = schema.get("properties", {}).get(key, {}).get("properties", {}).get("type", {})
        found |= set(below.get("enum", [])) | ({below["const"]} if "const" in below else set())
        for value in schema.values():
            found |= types(value, key)
    elif isinstance(schema, list):
        for value in schema:
            found |= types(value, key)
    return found


def main():
    sinew = sys.argv[1]
    robots = re.search(r"built-in robot: (.*)\.", output(sinew, "--help")).group(1).split(", ")
    kinds = re.findall(r"^(\S+) {2,}", output(sinew, "new").split("what it is\n")[1], flags=re.M)
    schema = json.loads(text("schema/robot.schema.json"))
    answer = subprocess.run([sinew, "query", "3-rfr"], input='{"query": "?"}\n', capture_output=True, text=True, check=False).stdout
    queries = re.findall(r"[a-z]+", json.loads(answer)["error"]["message"].split(":")[-1]) or ["forward"]
    report = text("include/sinew/solve/report.hpp").split("enum class Status {")[1].split("};")[0]
    statuses = re.findall(r"^  ([a-z_]+)\b", report, flags=re.M)
    files, protocol = text("docs/robot-files.md"), text("docs/protocol.md")
    named = lambda page, word: f"`{word}`" in page
    wrong = [f"docs/robot-files.md does not name the built-in robot {r}" for r in robots if not named(files, r)]
    wrong += [f"docs/robot-files.md does not show the kind {k}" for k in kinds if not re.search(rf"^{re.escape(k)} ", files, re.M)]
    for key in ("link", "closure"):
        wrong += [f"docs/robot-files.md does not name {key}.type {t}" for t in sorted(types(schema, key)) if not named(files, t)]
    wrong += [f"docs/protocol.md does not name the status {s}" for s in statuses if not named(protocol, s)]
    wrong += [f"docs/protocol.md does not name the query {q}" for q in queries if not named(protocol, q)]
    # the public codes' figures that benchmarks print are those of the page
    page, named_times = text("docs/performance.md"), text("benchmarks/hexapod.cpp")
    for time, unit in re.findall(r"(\d+) (ns|us)\b[^\"]*?(?:,| to)", "".join(re.findall(r'"public code[^"]*"', named_times))):
        micro = float(time) / (1000 if unit == "ns" else 1)
        shown = (f"{micro:g} µs", f"{micro / 1000:g} ms")
        wrong += [] if any(s in page for s in shown) else [f"docs/performance.md does not name {time} {unit}"]
    print("\n".join(wrong) or f"{len(robots)} robots, {len(kinds)} kinds, {len(statuses)} statuses, queries {queries}: all there")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
