"""Type checkers, stubs, and the table of fields agree."""
import doctest
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import sinew
from sinew._fields import FIELDS, RANKS, VERBS

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent


MEASURED = "from typing import Any\npulls: Any\nmarkers: Any\ntime: Any\nblocks: Any\n"
"""Names that the manual's fits have from elsewhere."""


def manual():
    """The manual's blocks as one program, without what it shows to be refused."""
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    program = [MEASURED]
    for language, block in re.findall(r"```(pycon|python)\n(.*?)```", page, flags=re.S):
        shown = doctest.DocTestParser().get_examples(block)
        program += [block] if language == "python" else [example.source for example in shown if not example.exc_msg]
    return "\n".join(program)


class Stubs(unittest.TestCase):
    def test_are_what_the_table_gives(self):
        subprocess.run([sys.executable, "-B", ROOT / "tools" / "python_stubs.py", "--check"], check=True)


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Checkers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def checked(self, *what):
        package = pathlib.Path(sinew.__file__).parent
        return subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", self.folder, *what], capture_output=True, text=True,
                              cwd=self.folder, env={"MYPYPATH": str(package.parent), "PATH": "/usr/bin:/bin"})

    def clean(self, *what):
        done = self.checked(*what)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def program(self, text):
        path = self.folder / "program.py"
        path.write_text(text, encoding="utf-8")
        return path

    def test_take_the_package_and_programs_strictly(self):
        self.clean("--strict", "-p", "sinew")
        self.clean("--strict", HERE / "user_program.py")

    def test_take_the_manual_strictly(self):
        self.clean("--strict", self.program(manual()))

    def test_take_the_examples(self):
        for example in sorted((ROOT / "examples" / "python").glob("*.py")):
            self.clean("--ignore-missing-imports", example)

    def test_find_a_wrong_keyword(self):
        self.assertIn('"input"', self.checked(self.program('import sinew\nsinew.load("3-rfr").forward(input=[1.0])\n')).stdout)

    def test_know_what_prepare_gives(self):
        text = 'import sinew\nasked = sinew.load("3-rfr").prepare("forward", inputs="$l")\nprint(asked([1.0]).x)\nasked.no_such_thing\n'
        self.assertIn('"Prepared" has no attribute "no_such_thing"', self.checked(self.program(text)).stdout)


class Table(unittest.TestCase):
    """The library says which fields each question knows; the table has them all."""

    def known(self, verb, robot, **fields):
        try:
            self.assertEqual(robot.ask({"query": verb, "no_such_field": 1, **fields}).status, "unsupported")
            return set()  # a question or model that is not for this robot
        except sinew.InputError as error:
            caught = error
        known = re.search(r'unknown key "no_such_field"\. Known here: ([^.]*)\.', str(caught))
        return set(known.group(1).split(", ")) - {"id", "query", "with_respect_to"} if known else set()

    def test_has_what_the_library_knows(self):
        robots = [sinew.load(name) for name in sinew.robots()]
        fields = {name.rstrip("_") for name in FIELDS}  # which verb has which, tests of the library compare
        for verb in VERBS:
            found = set()
            for robot in robots:
                for model in ({}, {"model": "prb"}):
                    found |= self.known(verb, robot, **model)
            self.assertLessEqual(found, fields, verb)

    def test_has_no_field_that_no_verb_has(self):
        self.assertEqual({name for entry in VERBS.values() for name in entry.fields}, set(FIELDS))
        self.assertEqual({0, 1, 2}, set(RANKS.values()))


if __name__ == "__main__":
    unittest.main()
