#!/usr/bin/env python3
"""Runs what pages of documentation show and compares: console blocks, and programs with what they print.

usage: readme.py [--update] --command FOLDER [--examples FOLDER --programs FOLDER] [--python PYTHON] [--octave OCTAVE] PAGE...

Console blocks: each `$ command` runs with the command's folder on the path. One page has one folder of its own, where
a yaml block that begins with `# name.yaml` is a file; `data` in it is that of the tree. A shown line `...` stands for any lines, `...` within a line for
any text. Residuals and numbers of iterations are not compared: they differ between processors.
C++ blocks: each is part of one program of the examples; the block without a language that follows the word `prints`
is what this program writes to standard output. After the words `Each prints` it is what every program of the section
writes: of C++, and, where an interpreter is given, blocks of Python and Octave, which are whole programs.
With --update the outputs in the console blocks are rewritten, and keep as many lines around a line `...` as they had.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def run(command, here, path):
    """What a terminal shows of the command: standard output, then messages."""
    environment = dict(os.environ, PATH=os.path.abspath(path) + os.pathsep + os.environ["PATH"])
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment, timeout=60, cwd=here)
    text = (done.stdout + done.stderr).rstrip("\n")
    return text + "\n" if text else ""


def comparable(text):
    """Without what is rounding noise or differs between processors, and without empty lines at the end."""
    text = re.sub(r"residual \S+", "residual", text)
    return re.sub(r"in \d+ iterations?", "in N iterations", text).rstrip("\n") + "\n"


def agrees(shown, now):
    pattern = re.escape(comparable(shown))
    pattern = re.sub(r"(?m)^\\\.\\\.\\\.\\?\n", lambda _: r"(?:.*\\n)*?".replace(r"\\n", "\n"), pattern)
    return re.fullmatch(pattern.replace(r"\.\.\.", ".*?"), comparable(now)) is not None


def shortened(shown, now):
    """The output as it is now, with the line `...` where it was."""
    lines = shown.splitlines()
    if lines.count("...") != 1:
        return now
    head, tail = lines.index("..."), len(lines) - lines.index("...") - 1
    fresh = now.splitlines()
    return "\n".join(fresh[:head] + ["..."] + (fresh[-tail:] if tail else [])) + "\n"


class Page:
    def __init__(self, path, options):
        self.path, self.options, self.wrong = path, options, []
        with open(path, encoding="utf-8") as file:
            self.text = file.read()

    def differs(self, what, shown, now):
        self.wrong.append(f"{what}\n--- {self.path}\n{shown}--- now\n{now}")

    def console(self, block, here):
        """The block with the outputs as they are now; notes what differs."""
        shown = re.split(r"^\$ (.*)\n", block, flags=re.M)[1:]
        fresh = ""
        for command, output in zip(shown[0::2], shown[1::2]):
            now = run(command, here, self.options.command)
            same = agrees(output, now)
            if not same:
                self.differs(f"$ {command}", output, now)
            blank = output[len(output.rstrip("\n")) + 1:]
            fresh += f"$ {command}\n{output if same else shortened(output, now) + blank}"
        return fresh

    def program(self, code):
        """Name of the example that holds these lines."""
        wanted = re.sub(r"\s+", "", code)
        for name in sorted(os.listdir(self.options.examples)):
            if name.endswith(".cpp"):
                with open(os.path.join(self.options.examples, name), encoding="utf-8") as file:
                    if wanted in re.sub(r"\s+", "", file.read()):
                        return name[:-len(".cpp")]
        return None

    def cpp(self, code, printed):
        name = self.program(code)
        if name is None:
            self.wrong.append(f"{self.path}: no program of {self.options.examples} has these lines:\n{code}")
        elif printed is not None:
            program = os.path.abspath(os.path.join(self.options.programs, "example_" + name))
            with tempfile.TemporaryDirectory() as here:
                now = subprocess.run([program], capture_output=True, text=True, check=True, timeout=60, cwd=here).stdout
            if not agrees(printed, now):
                self.differs(program, printed, now)

    def script(self, language, code, printed):
        """A whole program for an interpreter."""
        interpreter = {"python": self.options.python, "octave": self.options.octave}[language]
        if interpreter is None:
            return
        options = ["-B", "-W", "error"] if language == "python" else ["--no-gui", "--quiet", "--no-history", "--no-init-file"]
        with tempfile.TemporaryDirectory() as here:
            path = os.path.join(here, {"python": "shown.py", "octave": "shown.m"}[language])
            with open(path, "w", encoding="utf-8") as file:
                file.write(code)
            done = subprocess.run([interpreter, *options, path], capture_output=True, text=True, timeout=60, cwd=here)
        if done.returncode != 0 or not agrees(printed, done.stdout):
            self.differs(code, printed, done.stdout + done.stderr)

    def each(self):
        """Sections of which each program prints the same."""
        for section in re.split(r"(?m)^## ", self.text):
            printed = re.search(r"\bEach prints\b[^\n]*\n\n```\n(.*?)```", section, flags=re.S)
            for language, code in re.findall(r"```(cpp|python|octave)\n(.*?)```", section if printed else "", flags=re.S):
                if language != "cpp":
                    self.script(language, code, printed.group(1))
                elif self.options.examples:
                    self.cpp(code, printed.group(1))

    def check(self):
        with tempfile.TemporaryDirectory() as here:
            os.symlink(pathlib.Path(__file__).resolve().parents[1] / "data", os.path.join(here, "data"))

            def replayed(match):
                language, block = match.groups()
                name = re.match(r"# (\S+\.yaml)\n", block) if language == "yaml" else None
                if name:
                    with open(os.path.join(here, name.group(1)), "w", encoding="utf-8") as file:
                        file.write(block)
                return f"```{language}\n{self.console(block, here) if language == 'console' else block}```"

            fresh = re.sub(r"```(\w+)\n(.*?)```", replayed, self.text, flags=re.S)
        if self.options.update and fresh != self.text:
            with open(self.path, "w", encoding="utf-8") as file:
                file.write(fresh)
            self.wrong.clear()
        if self.options.examples:
            for code, printed in re.findall(r"```cpp\n(.*?)```(?:\n\n[^\n`]*\bprints\b[^\n]*\n\n```\n(.*?)```)?", self.text, flags=re.S):
                self.cpp(code, printed or None)
        self.each()
        return self.wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--command", required=True, metavar="FOLDER")
    parser.add_argument("--examples", metavar="FOLDER")
    parser.add_argument("--programs", metavar="FOLDER")
    parser.add_argument("--python", metavar="PYTHON")
    parser.add_argument("--octave", metavar="OCTAVE")
    parser.add_argument("pages", nargs="+", metavar="PAGE")
    options = parser.parse_args()
    wrong = [line for page in options.pages for line in Page(page, options).check()]
    print("\n".join(wrong) or "the pages show what happens")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
