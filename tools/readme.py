#!/usr/bin/env python3
"""Runs what the README shows and compares: every `$ command` of a console block, and the C++ program.

usage: readme.py [--update] README.md COMMAND_FOLDER EXAMPLE_SOURCE EXAMPLE_PROGRAM
With --update the outputs in the console blocks are rewritten.
"""
import os
import re
import subprocess
import sys
import tempfile


def run(command, folder):
    """What a terminal shows of the command, in a folder of its own: standard output, then messages."""
    environment = dict(os.environ, PATH=os.path.abspath(folder) + os.pathsep + os.environ["PATH"])
    with tempfile.TemporaryDirectory() as here:
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment, timeout=60, cwd=here)
    return (done.stdout + done.stderr).rstrip("\n") + "\n"


def comparable(text):
    """Without the residuals, which are rounding noise and differ between compilers."""
    return re.sub(r"residual \S+", "residual", text)


def console(block, folder, wrong):
    """The block with the outputs as they are now; notes what differs."""
    shown = re.split(r"^\$ (.*)\n", block, flags=re.M)[1:]
    fresh = ""
    for command, output in zip(shown[0::2], shown[1::2]):
        now = run(command, folder)
        if comparable(now) != comparable(output):
            wrong.append(f"$ {command}\n--- README\n{output}--- now\n{now}")
        fresh += f"$ {command}\n{output if comparable(now) == comparable(output) else now}"
    return fresh


def without_space(text):
    return re.sub(r"\s+", "", text)


def main():
    update = "--update" in sys.argv
    readme, folder, source, program = [a for a in sys.argv[1:] if a != "--update"]
    text = open(readme, encoding="utf-8").read()
    wrong = []
    fresh = re.sub(r"(?<=```console\n)(.*?)(?=```)", lambda m: console(m.group(1), folder, wrong), text, flags=re.S)
    if update:
        open(readme, "w", encoding="utf-8").write(fresh)
        wrong.clear()
    code, printed = re.search(r"```cpp\n(.*?)```\n\nprints\n\n```\n(.*?)```", text, flags=re.S).groups()
    if without_space(code) not in without_space(open(source, encoding="utf-8").read()):
        wrong.append(f"the C++ lines of the README are not those of {source}")
    now = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    if now != printed:
        wrong.append(f"{program}\n--- README\n{printed}--- now\n{now}")
    print("\n".join(wrong) or "the README shows what happens")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
