"""identify: arrays, files and tables in; a table of parameters and a robot out."""
import contextlib
import csv
import io
import pathlib
import pickle
import tempfile
import time
import unittest

import numpy as np

import sinew

DATA = pathlib.Path(__file__).parents[2] / "data" / "measured" / "ftdcr-v4.csv"
NAMES = "bending,marker,base"


def recorded(stride=20):
    """Columns of a recording, every so many rows."""
    with open(DATA, encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    heading, *rows = list(csv.reader(lines))
    numbers = np.array(rows, float)[::stride]
    of = {name: numbers[:, column] for column, name in enumerate(heading)}
    pulls = np.stack([values for name, values in of.items() if name.startswith("sections")], axis=1) * 1e-3
    markers = np.stack([of[f"{axis}[mm]"] for axis in "xyz"], axis=1) * 1e-3
    return {"pulls": pulls, "markers": markers, "time": of["time[s]"], "blocks": of["block"].astype(int)}


class Identify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = sinew.load("ftdcr-v4")
        cls.rows = recorded()
        cls.found = cls.robot.identify(cls.rows, fit=NAMES, folds=3)

    def test_arrays_give_a_table_and_a_robot(self):
        found = self.found
        self.assertIsInstance(found, sinew.Identification)
        self.assertTrue(found.ok, found.status)
        table = found.parameters
        self.assertEqual(table.name[0], "bending")
        self.assertEqual(table.value.shape, (len(table),))
        self.assertEqual(table["bending"].value, table.value[0])
        self.assertEqual(table[0], next(iter(table)))
        self.assertEqual(table[1:].name, table.name[1:])
        self.assertTrue((table.deviation > 0).all() and (table.prior_share <= 1).all())
        self.assertEqual(len(table.at_bound), len(table))
        with self.assertRaisesRegex(KeyError, "was not fitted"):
            table["lag"]
        self.assertEqual(found.robot.describe().kind, "arm")
        self.assertTrue(found.robot.forward(changes=[[-0.002, 0, 0]], model="cc").ok)
        self.assertEqual(found.asked, self.robot)
        self.assertNotEqual(found.robot, self.robot)
        bent = found.robot.describe().sections[0].backbone.bending[0]
        self.assertAlmostEqual(bent, table["bending"].value, delta=1e-12)

    def test_tells_how_far_it_is(self):
        told, rows = [], recorded(12)
        found = self.robot.identify(rows, fit=NAMES, folds=3, model="subsegment_rod", progress=told.append)
        self.assertTrue(found.ok, found.status)
        self.assertGreater(len(told), 1)
        self.assertEqual({now.part for now in told} - {"fitting", "holding out 3 parts"}, set())
        self.assertTrue(all(now.steps > 0 and now.error > 0 for now in told), told)
        # it changes nothing, and does not disturb what comes after
        again = self.robot.identify(rows, fit=NAMES, folds=3, model="subsegment_rod", progress=False)
        self.assertEqual(found.parameters.value.tolist(), again.parameters.value.tolist())

    def test_what_progress_raises_stops_the_fit(self):
        class Enough(Exception):
            pass

        def stop(now):
            raise Enough(now.part)

        begin = time.monotonic()
        with self.assertRaisesRegex(Enough, "fitting"):
            self.robot.identify(recorded(1), model="subsegment_rod", folds=50, progress=stop)
        self.assertLess(time.monotonic() - begin, 30)
        self.assertTrue(self.robot.forward(changes=[[-0.002, 0, 0]], model="cc").ok)

    def test_says_how_far_it_is_in_a_terminal(self):
        class Terminal(io.StringIO):
            def isatty(self):
                return True

        rows = recorded(12)
        for stream, progress, says in ((Terminal(), None, True), (Terminal(), False, False), (io.StringIO(), None, False), (io.StringIO(), True, True)):
            with contextlib.redirect_stderr(stream):
                self.robot.identify(rows, fit=NAMES, folds=3, model="subsegment_rod", progress=progress)
            self.assertEqual("fitting, step" in stream.getvalue(), says, (stream, progress))
            self.assertTrue(not says or stream.getvalue().endswith("\r\033[K"))
        with self.assertRaisesRegex(sinew.InputError, "progress is a function"):
            self.robot.identify(rows, progress=3)

    def test_rows_are_arrays(self):
        """Errors by another way: of places that are said to be computed."""
        by_row = self.found.by_row
        n = len(self.rows["pulls"])
        self.assertEqual((by_row.distance.shape, by_row.held_out_distance.shape, by_row.computed.shape), ((n,), (n,), (n, 3)))
        distances = np.linalg.norm(by_row.computed - self.rows["markers"], axis=1)
        np.testing.assert_allclose(distances, by_row.distance, atol=1e-5)
        self.assertAlmostEqual(np.sqrt(np.mean(by_row.distance ** 2)), self.found.errors.fitted.rms, delta=1e-12)

    def test_fitting_again_changes_nothing(self):
        again = self.found.robot.identify(self.rows, fit=NAMES, folds=0)
        self.assertAlmostEqual(again.errors.before.rms, self.found.errors.fitted.rms, delta=1e-6)

    def test_a_path_its_text_and_a_table_are_the_same(self):
        whole = self.robot.identify(DATA, fit="bending", folds=0, max_iterations=1)
        self.assertEqual(whole.rows, 810)
        text = DATA.read_text(encoding="utf-8")

        class Table:
            def to_csv(self, index):
                return text

        for rows in (str(DATA), text, Table(), recorded(1)):
            other = self.robot.identify(rows, fit=["bending"], folds=0, max_iterations=1)
            self.assertAlmostEqual(other.errors.fitted.rms, whole.errors.fitted.rms, delta=1e-12)

    def test_is_written_and_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "fitted.yaml"
            self.found.save(path)
            written = sinew.load(path)
        self.assertEqual(written.describe(), self.found.robot.describe())
        copy = pickle.loads(pickle.dumps(self.found))
        self.assertEqual(copy, self.found)
        self.assertEqual(copy.robot, self.found.robot)

    def test_is_shown(self):
        for text in (str(self.found), self.found._repr_html_()):
            for word in ("bending", "N m^2", "held_out", "deviation"):
                self.assertIn(word, text)
        self.assertIn("<td>bending</td>", self.found.parameters._repr_html_())
        self.assertIn("converged", repr(self.found))

    def test_is_the_question_of_the_protocol(self):
        plain = self.robot.ask({"query": "identify", "rows": self.rows, "fit": NAMES, "folds": 3})
        self.assertEqual(plain, self.found)
        self.assertEqual(plain.robot, self.found.robot)

    def test_is_prepared(self):
        prepared = self.robot.prepare("identify", rows={"pulls": [[0.001] + [0] * 8], "markers": [["$x", 0, 0.19]]}, fit="marker")
        row = prepared(0.01)
        self.assertTrue(row.ok)
        self.assertTrue(0 < row.rms < 0.05)
        self.assertEqual(prepared(np.array([0.01, 0.02])).rms.shape, (2,))

    def test_refuses_by_place(self):
        good = {name: values[:2] for name, values in self.rows.items()}
        nan = good["pulls"].copy()
        nan[1, 2] = np.nan
        for rows, code, place in (
                (None, "missing_key", "query"), (np.zeros((2, 12)), "wrong_type", "rows"), (7, "wrong_type", "rows"),
                ("no_such.csv", "file_unreadable", "rows"), ({"pulls": good["pulls"]}, "missing_key", "rows"),
                ({**good, "pulls": nan}, "not_a_number", "rows.pulls[1][2]"),
                ({**good, "pulls": good["pulls"][:, :8]}, "wrong_length", "rows.pulls[0]"),
                ({**good, "markers": good["markers"][:1]}, "wrong_length", "rows.markers"),
                ({**good, "blocks": [0, 0], "time": [1, 0]}, "not_in_order", "rows: row 2"),
                ({**good, "pull": 1}, "unknown_key", "rows.pull")):
            with self.subTest(code=code, place=place), self.assertRaises(sinew.InputError) as raised:
                self.robot.identify(rows, fit="bending")
            self.assertEqual((raised.exception.code, raised.exception.where), (code, place), raised.exception)
        with self.assertRaisesRegex(sinew.InputError, "no quantity of an arm"):
            self.robot.identify(good, fit="bendng")
        other = sinew.load("3-rfr").identify(good)
        self.assertEqual(other.status, "unsupported")
        with self.assertRaisesRegex(sinew.InputError, "unsupported"):
            other.robot


if __name__ == "__main__":
    unittest.main()
