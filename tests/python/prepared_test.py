"""Questions prepared once."""
import array
import copy
import pickle
import unittest

import numpy as np

import sinew
from sinew._fields import UNITS


class Plain(np.ndarray):
    pass


class Length(np.ndarray):
    units = "mm"


class Prepared(unittest.TestCase):
    def setUp(self):
        self.robot = sinew.load("3-rfr")
        self.forward = self.robot.prepare("forward", inputs="$lengths")

    def test_answers_a_row(self):
        row = self.forward([0.19, 0.19, 0.188])
        whole = self.robot.forward([0.19, 0.19, 0.188])
        self.assertTrue(row.ok)
        self.assertEqual((row.status, row.message), ("converged", ""))
        self.assertAlmostEqual(row.x, whole.pose.x, 13)
        self.assertEqual(row.units["phi"], "rad")
        self.assertEqual(row.answer.legs[0].chord, whole.legs[0].chord)
        self.assertEqual(set(row.to_dict()), {"x", "y", "phi", "residual"})
        self.assertIn("converged", repr(row))

    def test_takes_numbers_of_all_kinds(self):
        wanted = self.forward([0.19, 0.19, 0.19]).x
        for same in ((0.19, 0.19, 0.19), np.full(3, 0.19), np.full(6, 0.19)[::2], [np.float64(0.19)] * 3, np.full(3, 0.19, ">f8"),
                     memoryview(np.full(3, 0.19)), array.array("d", [0.19] * 3), np.ma.array([0.19] * 3), np.full(3, 0.19).view(Plain)):
            self.assertEqual(self.forward(same).x, wanted)
        self.assertEqual(self.forward(lengths=[0.19, 0.19, 0.19]).x, wanted)
        self.assertEqual(self.forward([np.float32(0.19)] * 3).x, self.forward([float(np.float32(0.19))] * 3).x)

    def test_and_keywords_take_numbers_of_all_sizes(self):
        for kind in (np.longdouble, np.float16, np.float32):
            one = kind(0.1875)
            for same in ([one] * 3, np.full(3, one)):
                self.assertEqual(self.forward(same).x, self.forward([0.1875] * 3).x)
                self.assertEqual(self.robot.forward(same).pose.x, self.robot.forward([0.1875] * 3).pose.x)
            self.assertEqual(self.robot.inverse({"x": kind(0.0), "y": np.int8(0), "phi": one}), self.robot.inverse({"x": 0.0, "y": 0, "phi": 0.1875}))
        with self.assertRaisesRegex(sinew.InputError, "inputs\\[0\\] is of type c"):
            self.robot.forward([np.clongdouble(1j), 0.19, 0.19])

    def test_takes_rows(self):
        found = self.forward(np.full((5, 3), 0.19))
        self.assertEqual(found.x.shape, (5,))
        self.assertEqual(self.forward([[0.19, 0.19, 0.19], [0.19, 0.19, 0.188]]).x.shape, (2,))
        self.assertEqual(self.forward(np.full((5, 3), 0.19), threads=1).x.tobytes(), found.x.tobytes())

    def test_outputs_that_end_with_the_same_word_are_all_there(self):
        curved = self.robot.prepare("forward", inputs="$l", outputs=["legs[0].curvature", "legs[2].curvature", "pose.x"])
        self.assertEqual([field["name"] for field in curved.outputs], ["legs_0_curvature", "legs_2_curvature", "x"])
        self.assertNotEqual(curved([0.19, 0.19, 0.188]).legs_0_curvature, curved([0.19, 0.19, 0.188]).legs_2_curvature)

    def test_lists_and_matrices_come_out(self):
        velocity = self.robot.prepare("velocity", pose={"x": "$x", "y": 0, "phi": 0}, outputs=["J", "indices.condition"])
        row = velocity(0.01)
        self.assertEqual(row.J.shape, (3, 3))
        self.assertIsInstance(row.condition, float)
        many = velocity(np.linspace(0, 0.01, 7))
        self.assertEqual(many.J.shape, (7, 3, 3))
        np.testing.assert_allclose(many.J[-1], row.J, atol=1e-12)

    def test_refuses_what_is_no_row(self):
        for wrong, why in (([0.19, 0.19], r"shape \(2,\)"), (0.19, r"shape \(\)"), ("abc", "type <U3"), (None, "object"),
                           ([0.19, 0.19, None], "object"), ([[0.19], [0.19, 0.19], 3], "no array"), ([True] * 3, "bool"),
                           ([1j] * 3, "complex"), ([10**400] * 3, "object"), ({}, "object"), (["0.19 m"] * 3, "<U")):
            with self.assertRaisesRegex(sinew.InputError, why):
                self.forward(wrong)
        for wrong, why in ((np.ma.array([0.19] * 3, mask=[0, 1, 0]), "masked"), ([True, 0.19, 0.19], "bool"), ([np.True_, 0.19, 0.19], "bool"),
                           (np.full(3, 190).view(Length), "unit"), (np.full((2, 3), 190).view(Length), "unit")):
            with self.assertRaisesRegex(sinew.InputError, why):
                self.forward(wrong)
        with self.assertRaisesRegex(sinew.InputError, "inputs"):
            self.forward([0.19, float("nan"), 0.19])
        for call, why in ((lambda: self.forward(), "missing"), (lambda: self.forward([1], [2]), "too many"),
                          (lambda: self.forward(length=[1]), "no argument 'length'"), (lambda: self.forward([1], lengths=[1]), "twice")):
            with self.assertRaisesRegex(TypeError, why):
                call()

    def test_refuses_what_cannot_be_prepared(self):
        with self.assertRaisesRegex(sinew.InputError, "nothing goes in"):
            self.robot.prepare("forward", inputs=[0.19, 0.19, 0.19])
        with self.assertRaisesRegex(sinew.InputError, "sideways"):
            self.robot.prepare("forward", inputs="$x", path="sideways")

    def test_refuses_a_question_that_is_wrong_whatever_the_numbers(self):
        for question, why in (({"inputs": "$x", "mode": "cc"}, 'did you mean "model"'), ({"inputs": ["$x"]}, "it must have 3")):
            with self.assertRaisesRegex(sinew.InputError, why):
                prepared = self.robot.prepare("forward", **question)
                prepared(0.19 if isinstance(question["inputs"], list) else [0.19] * 3)
            with self.assertRaisesRegex(sinew.InputError, why):
                prepared = self.robot.prepare("forward", **question)
                prepared(np.full(5, 0.19) if isinstance(question["inputs"], list) else np.full((5, 3), 0.19))
        with self.assertRaisesRegex(sinew.InputError, "did you mean"):
            self.robot.forward(inputs=np.full((5, 3), 0.19), mode="cc")

    def test_of_a_changed_robot(self):
        changed = self.robot.set({"legs[0].link.length": "180 mm"})
        self.assertNotEqual(changed.prepare("forward", inputs="$l")([0.18, 0.19, 0.188]).x, self.forward([0.18, 0.19, 0.188]).x)

    def test_threads_are_a_whole_number(self):
        for call in (lambda: self.forward([0.19] * 3, threads="x"), lambda: self.forward(np.full((5, 3), 0.19), threads=1.5)):
            with self.assertRaisesRegex(sinew.InputError, "threads = .* give a whole number"):
                call()
        self.assertTrue(self.forward([0.19] * 3, threads=1).ok)
        self.assertTrue(self.forward(np.full((5, 3), 0.19), threads=np.int64(2)).ok.all())

    def test_refuses_names_that_answers_have(self):
        for outputs in ({"ok": "pose.x"}, {"to_dict": "pose.x"}, {"keys": "pose.x"}, ["pose.x", "robot"]):
            with self.assertRaisesRegex(sinew.InputError, "of their own; give this one another name"):
                self.robot.prepare("forward", inputs="$x", outputs=outputs)
        with self.assertRaisesRegex(sinew.InputError, "found int; give a dict"):
            self.robot.prepare("forward", inputs="$x", outputs=0)

    def test_names_of_all_answer_fields_are_free(self):
        for name in UNITS:
            word = name.rsplit(".", 1)[-1]
            self.assertFalse(hasattr(sinew.Row, word) or hasattr(sinew.Columns, word), word)

    def test_follows_a_path(self):
        robot = sinew.load("3pfs-g2")
        inputs = np.linspace([0.44, 0.42, 0.41], [0.42, 0.42, 0.42], 50)
        walk = robot.prepare("forward", inputs="$l", path="continue")
        found = walk(inputs)
        self.assertTrue(found.ok.all())
        np.testing.assert_allclose(found.position, robot.forward(inputs=inputs).position, atol=1e-9)

    def test_pickle(self):
        again = pickle.loads(pickle.dumps(self.forward))
        self.assertEqual(again([0.19, 0.19, 0.19]).x, self.forward([0.19, 0.19, 0.19]).x)
        self.assertIn("lengths (3,)", repr(again))
        self.assertEqual(again.inputs[0]["unit"], "m")

    def test_rows_are_copied_and_pickled(self):
        row = self.forward([0.19, 0.19, 0.188])
        self.assertIs(copy.copy(row), row)
        self.assertIs(copy.deepcopy([row])[0], row)
        for one in (row, self.forward([0.19, 0.19, 0.3])):
            again = pickle.loads(pickle.dumps(one))
            self.assertEqual((repr(again), again.status), (repr(one), one.status))
        again = pickle.loads(pickle.dumps(row))
        self.assertEqual((again.x, again.answer), (row.x, row.answer))


if __name__ == "__main__":
    unittest.main()
