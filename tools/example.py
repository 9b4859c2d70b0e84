#!/usr/bin/env python3
"""Runs an example and compares its standard output with the comment at its end, which begins with `Prints:`.

usage: example.py [--update] SOURCE COMMAND...

The command runs in an empty folder of its own. With --update the comment is written anew, or for the first time.
"""
import re
import subprocess
import sys
import tempfile

import readme


def main():
    arguments = sys.argv[1:]
    update = arguments[:1] == ["--update"]
    source, *command = arguments[update:]
    with open(source, encoding="utf-8") as file:
        text = file.read()
    mark = "#" if source.endswith(".py") else "//"
    code, _, comment = text.partition(f"\n{mark} Prints:\n")
    shown = re.sub(rf"^{mark} {{0,3}}", "", comment, flags=re.M)
    with tempfile.TemporaryDirectory() as here:
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, cwd=here)
    sys.stderr.write(done.stderr)
    if done.returncode != 0:
        print(f"{source} ended with {done.returncode} and printed\n{done.stdout}")
        return 1
    if readme.agrees(shown, done.stdout):
        return 0
    if update:
        with open(source, "w", encoding="utf-8") as file:
            file.write(f"{code.rstrip()}\n\n{mark} Prints:\n")
            file.writelines(f"{mark}   {line}\n" for line in done.stdout.splitlines())
        return 0
    print(f"--- {source} says that it prints\n{shown}--- now\n{done.stdout}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
