"""tools/notebook.py fails where a notebook does."""
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "notebook.py"


@unittest.skipUnless(importlib.util.find_spec("nbconvert") and importlib.util.find_spec("ipykernel"), "Jupyter is not installed")
class Notebook(unittest.TestCase):
    def run_tool(self, *sources, outputs=()):
        cells = [{"cell_type": "code", "id": f"cell-{place}", "metadata": {}, "source": source, "outputs": list(outputs),
                  "execution_count": None} for place, source in enumerate(sources)]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "shown.ipynb")
            path.write_text(json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}), encoding="utf-8")
            done = subprocess.run([sys.executable, "-B", TOOL, folder, path], capture_output=True, text=True, check=False)
            page = pathlib.Path(folder, "shown.md")
            return done.returncode, done.stdout + done.stderr, page.read_text(encoding="utf-8") if page.exists() else ""

    def test_of_what_runs_is_a_page(self):
        code, told, page = self.run_tool("6 * 7")
        self.assertEqual(code, 0, told)
        self.assertIn("    42", page)

    def test_of_an_exception_ends(self):
        code, told, _ = self.run_tool("1 / 0", "print('went on')")
        self.assertNotEqual(code, 0)
        self.assertIn("ZeroDivisionError", told)

    def test_of_a_picture_that_cannot_be_drawn_fails(self):
        code, told, _ = self.run_tool("class Picture:\n    def _repr_html_(self):\n        raise ValueError('no ink')\n\nPicture()")
        self.assertEqual(code, 1, told)
        self.assertIn("no ink", told)

    def test_with_outputs_is_not_taken(self):
        code, told, _ = self.run_tool("1", outputs=[{"output_type": "stream", "name": "stdout", "text": "1"}])
        self.assertEqual(code, 1)
        self.assertIn("clear them", told)


if __name__ == "__main__":
    unittest.main()
