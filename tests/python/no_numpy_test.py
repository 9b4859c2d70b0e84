"""Without NumPy: lists in answers, columns of anything that has the buffer protocol, memoryviews out."""
import array
import sys
import unittest

sys.modules["numpy"] = None

import sinew


class NoNumpy(unittest.TestCase):
    def setUp(self):
        self.robot = sinew.load("3-rfr")

    def test_answers_have_lists(self):
        answer = self.robot.inverse({"x": 0.01, "y": 0, "phi": 0})
        self.assertIs(type(answer.inputs), list)
        self.assertTrue(self.robot.forward(answer.inputs).ok)
        self.assertEqual(len(sinew.load("3pfs-g2").velocity(inputs=[0.42] * 3).U), 6)
        self.assertIn("<svg", answer._repr_html_())

    def test_columns_are_memoryviews(self):
        flat = array.array("d", [0.19, 0.19, 0.188] * 5)
        found = self.robot.forward(inputs=memoryview(flat).cast("B").cast("d", [5, 3]))
        self.assertEqual((found.x.shape, found.counts), ((5,), {"converged": 5}))
        self.assertAlmostEqual(found.x[4], self.robot.forward([0.19, 0.19, 0.188]).pose.x, 12)
        self.assertEqual(found[2].status, "converged")
        self.assertEqual(found.ok, [True] * 5)
        self.assertIn("(5,)", repr(found))
        velocity = self.robot.prepare("velocity", pose={"x": "$x", "y": 0, "phi": 0}, outputs=["J"])
        self.assertEqual(velocity(array.array("d", [0.0, 0.01])).J.shape, (2, 3, 3))
        self.assertEqual(len(velocity(0.01).J), 3)

    def test_lists_of_rows_and_other_numbers(self):
        prepared = self.robot.prepare("forward", inputs="$l")
        self.assertEqual(prepared([[0.19, 0.19, 0.19]] * 4).x.shape, (4,))
        self.assertTrue(prepared(array.array("f", [0.1875] * 3)).ok)
        for wrong in ([0.19], [[0.19] * 2], "abc", None, [[0.19], 0.19], b"abc", 1j):
            with self.assertRaises(sinew.InputError):
                prepared(wrong)
        out = array.array("d", [0.0] * 4)
        x = self.robot.prepare("forward", inputs="$l", outputs={"x": "pose.x"})([[0.19, 0.19, 0.188]] * 4, out=out).x
        self.assertEqual(list(out), list(x))

    def test_booleans_and_texts_are_no_numbers(self):
        prepared = self.robot.prepare("forward", inputs="$l")
        for wrong in ([True, 0.19, 0.19], ["0.19"] * 3):
            with self.assertRaisesRegex(sinew.InputError, "no array of numbers"):
                prepared(wrong)

    def test_out_that_shares_memory_is_refused(self):
        prepared = self.robot.prepare("forward", inputs="$l", outputs={"x": "pose.x"})
        flat = array.array("d", [0.19, 0.19, 0.188] * 4)
        rows = memoryview(flat).cast("B").cast("d", [4, 3])
        with self.assertRaisesRegex(sinew.InputError, "shares memory"):
            prepared(rows, out=memoryview(flat)[4:8])
        more = memoryview(array.array("d", [0.19, 0.19, 0.188] * 4 + [0.0] * 4))
        self.assertTrue(all(prepared(more[:12].cast("B").cast("d", [4, 3]), out=more[12:]).ok))
        self.assertEqual(list(more[12:]), list(prepared(rows).x))


if __name__ == "__main__":
    unittest.main()
