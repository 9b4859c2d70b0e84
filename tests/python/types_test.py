"""Type checkers, stubs, and the table of fields agree."""
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


class Stubs(unittest.TestCase):
    def test_are_what_the_table_gives(self):
        subprocess.run([sys.executable, ROOT / "tools" / "python_stubs.py", "--check"], check=True)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_are_clean_under_mypy(self):
        package = pathlib.Path(sinew.__file__).parent
        with tempfile.TemporaryDirectory() as cache:
            for what in ([str(HERE / "user_program.py")], ["-p", "sinew"]):
                done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, *what], capture_output=True, text=True,
                                      cwd=cache, env={"MYPYPATH": str(package.parent), "PATH": "/usr/bin:/bin"})
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_find_a_wrong_keyword(self):
        with tempfile.TemporaryDirectory() as folder:
            wrong = pathlib.Path(folder) / "wrong.py"
            wrong.write_text('import sinew\nsinew.load("3-rfr").forward(input=[1.0])\n')
            done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", folder, str(wrong)], capture_output=True, text=True, cwd=folder,
                                  env={"MYPYPATH": str(pathlib.Path(sinew.__file__).parent.parent), "PATH": "/usr/bin:/bin"})
            self.assertIn('"input"', done.stdout)


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
