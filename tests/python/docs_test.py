"""What docs/python.md shows is what happens."""
import doctest
import importlib.util
import os
import pathlib
import re
import tempfile
import unittest

import sinew
from sinew import _view

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md"


def has_command():
    try:
        return bool(_view.command())
    except sinew.InputError:
        return False


class Manual(unittest.TestCase):
    def test_shows_what_happens(self):
        blocks = re.findall(r"```pycon\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.S)
        self.assertGreater(len(blocks), 5)
        if importlib.util.find_spec("matplotlib"):
            import matplotlib
            matplotlib.use("Agg")
        else:
            blocks = [re.sub(r">>> .*robot\.plot\(.*\n", "", block) for block in blocks]
        if not has_command():
            blocks = [re.sub(r">>> with robot\.view.*", "", block, flags=re.S) for block in blocks]
        test = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, PAGE.name, str(PAGE), 0)
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL)
        told = []
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                runner.run(test, out=told.append)
            finally:
                os.chdir(before)
        self.assertEqual(runner.failures, 0, "".join(told))


if __name__ == "__main__":
    unittest.main()
