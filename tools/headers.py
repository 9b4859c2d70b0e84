#!/usr/bin/env python3
"""Checks that every public header compiles alone: that it includes what it needs.

    tools/headers.py COMPILER WORK [INCLUDE...]     headers of include/; WORK keeps what passed

A header that reaches Eigen is compiled with Eigen/Core precompiled: that takes half of the time, and hides nothing that
Eigen/Core would not have brought with it anyway. What passed is not compiled again until it, or what it includes of
ours, changes.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = [ROOT / "include", ROOT / "kernel" / "include"]
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def closure(header, known):
    """The headers of ours and the others that a header reaches, itself among them."""
    if header in known:
        return known[header]
    known[header] = ours, others = {header}, set()
    for name in INCLUDE.findall(header.read_text()):
        places = [folder / name for folder in [*FOLDERS, header.parent] if (folder / name).is_file()]
        if places:
            more = closure(places[0], known)
            ours |= more[0]
            others |= more[1]
        else:
            others.add(name)
    return known[header]


def main():
    compiler, work, *more = sys.argv[1:]
    work = pathlib.Path(work)
    work.mkdir(parents=True, exist_ok=True)
    flags = ["-std=c++20", "-DEIGEN_MPL2_ONLY"] + [f"-I{folder}" for folder in FOLDERS]
    flags += [part for folder in more for part in ("-isystem", folder)]
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    core = work / "core.hpp"
    core.write_text("#include <Eigen/Core>\n")

    passed_file = work / "passed.json"
    passed = json.loads(passed_file.read_text()) if passed_file.is_file() else {}
    known = {}

    def name_of(header):
        return str(header.relative_to(ROOT))

    def key_of(header):
        text = version + " ".join(flags) + "".join(file.read_text() for file in sorted(closure(header, known)[0]))
        return hashlib.sha256(text.encode()).hexdigest()

    def check(header):
        others = closure(header, known)[1]
        precompiled = ["-include", core] if "Eigen/Core" in others else []
        result = subprocess.run([compiler, *flags, *precompiled, "-fsyntax-only", "-x", "c++", header],
                                capture_output=True, text=True)
        return None if result.returncode == 0 else result.stderr

    headers = sorted(FOLDERS[0].rglob("*.hpp"))
    keys = {name_of(header): key_of(header) for header in headers}
    changed = [header for header in headers if passed.get(name_of(header)) != keys[name_of(header)]]
    if changed:
        subprocess.run([compiler, *flags, "-x", "c++-header", core, "-o", f"{core}.gch"], check=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = list(pool.map(check, changed))
    failed = {name_of(header): error for header, error in zip(changed, errors) if error is not None}
    passed_file.write_text(json.dumps({name: key for name, key in keys.items() if name not in failed}))
    for name, error in failed.items():
        print(f"{name} does not compile alone:\n{error}")
    print(f"{len(headers)} headers, {len(changed)} of them changed; {len(failed)} do not compile alone")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
