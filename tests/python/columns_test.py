"""Arrays in, arrays out."""
import array
import json
import pickle
import tracemalloc
import unittest

import numpy as np

import sinew

RNG = np.random.default_rng(7)


def rows(n):
    return RNG.uniform(0.185, 0.195, (n, 3))


class Columns(unittest.TestCase):
    def setUp(self):
        self.robot = sinew.load("3-rfr")

    def test_are_the_answers_of_rows(self):
        inputs = rows(20)
        found = self.robot.forward(inputs=inputs)
        self.assertIsInstance(found, sinew.Columns)
        self.assertEqual(len(found), 20)
        self.assertTrue(found.ok.all())
        self.assertEqual(found.units["x"], "m")
        for index, row in enumerate(inputs):
            one = self.robot.forward(row)
            self.assertAlmostEqual(found.x[index], one.pose.x, 12)
            self.assertAlmostEqual(found["phi"][index], one.pose.phi, 12)
        self.assertAlmostEqual(found[3].pose.x, found.x[3], 12)
        self.assertEqual([answer.status for answer in found], ["converged"] * 20)
        with self.assertRaises(IndexError):
            found[20]

    def test_of_arms_are_rows_of_all_tendons_or_lists_of_sections(self):
        arm = sinew.load("two-segment")
        pulls = RNG.uniform(0, 3, (12, 2, 3))
        flat, nested = arm.forward(tensions=pulls.reshape(12, 6)), arm.forward(tensions=pulls)
        np.testing.assert_array_equal(flat.position, nested.position)
        self.assertEqual(flat.tensions.shape, (12, 6))
        for index in (0, 7):
            one = arm.forward(tensions=pulls[index])
            np.testing.assert_allclose(flat.position[index], one.tip.position, atol=1e-7)
        np.testing.assert_allclose(nested[7].tip.position, nested.position[7], atol=1e-7)
        with self.assertRaises(sinew.InputError):
            arm.forward(tensions=RNG.uniform(0, 3, (12, 5)))

    def check_no_copies(self, prepared, *columns):
        prepared(*(column[:10] for column in columns))  # what is allocated once
        tracemalloc.start()
        found = prepared(*columns)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        wanted = sum(found[field["name"]].nbytes for field in prepared.outputs) + found.status.nbytes
        self.assertLess(most, wanted + 100_000)
        for held, column in zip(found._inputs, columns):
            self.assertTrue(np.shares_memory(held, column))
        self.assertTrue(found.ok.all())

    def test_are_read_and_written_where_they_lie(self):
        """Of a million rows nothing is allocated but what is answered."""
        walk = sinew.load("3pfs-g2").prepare("forward", inputs="$lengths", path="continue")
        self.check_no_copies(walk, np.full((10**6, 3), 0.42))
        poses = np.zeros((10**6, 3))
        inverse = self.robot.prepare("inverse", pose={"x": "$x", "y": "$y", "phi": "$phi"})
        self.check_no_copies(inverse, poses[:, 0], poses[:, 1], poses[:, 2])

    def test_any_strides(self):
        inputs = rows(30)
        wanted = self.robot.forward(inputs=inputs).x
        wide = np.zeros((30, 9))
        wide[:, 1:7:2] = inputs
        for same in (np.asfortranarray(inputs), wide[:, 1:7:2], inputs[::-1][::-1], inputs.T.copy().T):
            np.testing.assert_array_equal(self.robot.forward(inputs=same).x, wanted)
        np.testing.assert_array_equal(self.robot.forward(inputs=inputs[::-1]).x, wanted[::-1])
        np.testing.assert_array_equal(self.robot.forward(inputs=inputs[::2]).x, wanted[::2])
        np.testing.assert_array_equal(self.robot.forward(inputs=np.broadcast_to(inputs[0], (5, 3))).x, wanted[[0] * 5])
        one = self.robot.forward(inputs=inputs[:1])
        self.assertEqual(one.x.shape, (1,))
        none = self.robot.forward(inputs=inputs[:0])
        self.assertEqual((none.x.shape, none.message), ((0,), ""))

    def test_other_numbers_are_converted_where_nothing_is_lost(self):
        wanted = self.robot.forward(inputs=np.full((4, 3), 0.1875)).x
        exact = np.full((4, 3), 0.1875)
        unaligned = np.frombuffer(b"\0" + exact.tobytes(), np.uint8)[1:].view(np.float64).reshape(4, 3)
        read_only = exact.copy()
        read_only.flags.writeable = False
        for same in (exact.astype(np.float32), exact.astype(np.float16), exact.astype(">f8"), exact.astype("<f8"), unaligned,
                     read_only, exact.astype(np.longdouble), np.ma.masked_array(exact)):
            np.testing.assert_array_equal(self.robot.forward(inputs=same).x, wanted)
        whole = self.robot.inverse(pose={"x": np.zeros(3, int), "y": 0, "phi": np.zeros(3, np.int8)})
        self.assertTrue(whole.ok.all())

    def test_other_numbers_are_refused_where_something_would_be(self):
        exact = np.full((4, 3), 0.19)
        masked = np.ma.masked_array(exact, exact > 1)
        masked[0, 0] = np.ma.masked
        for wrong, why in ((exact.astype(complex), "complex128"), (exact.astype(object), "object"), (exact.astype(str), "<U"),
                           (exact > 0, "bool"), (masked, "masked"), (np.zeros((4, 2)), r"shape \(4, 2\)"),
                           (np.zeros((4, 3, 1)), r"shape \(4, 3, 1\)"), (np.zeros((0, 4)), r"shape \(0, 4\)")):
            with self.assertRaisesRegex(sinew.InputError, why):
                self.robot.forward(inputs=wrong)

    def test_rows_that_are_no_input_say_so_by_themselves(self):
        inputs = rows(5)
        inputs[2, 1] = np.nan
        inputs[3, 0] = np.inf
        found = self.robot.forward(inputs=inputs)
        self.assertEqual(found.ok.tolist(), [True, True, False, False, True])
        self.assertEqual(found.status[2], sinew.Status.bad_input)
        self.assertTrue(np.isnan(found.x[2]))
        self.assertIn("1 bad_input of 5 rows", found.message)
        self.assertEqual(found.counts, {"left_domain": 1, "converged": 3, "bad_input": 1})
        of_rods = sinew.load("3pfs-g2").forward(np.array([[np.inf, 0.42, 0.41]]))
        self.assertEqual((of_rods.status[0], of_rods.message),
                         (sinew.Status.bad_input, "1 bad_input of 1 rows: inputs[0] is not a length a rod can have; it must be positive"))

    def test_constants_and_columns_mix(self):
        robot = sinew.load("3pfs-g2")
        inputs = RNG.uniform(0.41, 0.43, (6, 3))
        loads = np.zeros((6, 6))
        loads[:, 2] = -np.arange(6)
        found = robot.forward(inputs=inputs, wrench=loads)
        self.assertEqual(found.position.shape, (6, 3))
        np.testing.assert_allclose(found.position[4], robot.forward(inputs[4], wrench=loads[4]).pose.position, atol=1e-9)
        same = robot.forward(inputs=[0.42, 0.42, 0.42], wrench=loads)
        np.testing.assert_allclose(same.position[0], robot.forward([0.42, 0.42, 0.42]).pose.position, atol=1e-9)
        with self.assertRaisesRegex(sinew.InputError, "different lengths"):
            robot.forward(inputs=inputs, wrench=loads[:3])

    def test_of_poses_in_space(self):
        robot = sinew.load("6-ufs")
        position = RNG.uniform(-0.005, 0.005, (4, 3)) + robot.describe().home.position
        found = robot.inverse(pose={"position": position})
        self.assertEqual(found.inputs.shape, (4, 6))
        self.assertTrue(found.ok.all(), found.message)

    def test_of_serial_robots(self):
        arm = sinew.load("nottingham-tpcj")
        bends = RNG.uniform(-0.1, 0.1, (3, 5, 2))
        found = arm.forward(configuration=bends)
        self.assertEqual(found.changes.shape, (3, 15))
        np.testing.assert_allclose(found.position[1], arm.forward(configuration=bends[1]).tip.position, atol=1e-12)
        back = arm.forward(changes=found.changes.reshape(3, 5, 3))
        self.assertEqual(arm.forward(changes=found.changes).position.tobytes(), back.position.tobytes())
        self.assertEqual(arm.forward(changes=found.changes[0].reshape(5, 3)).status, "converged")
        one = sinew.load({"sinew": 1, "name": "one", "kind": "serial", "sections": [
            {"type": "neutral", "segments": 1, "joint": 0.06, "tendons": {"count": 3, "radius": 0.004, "angle": 0}}]})
        self.assertEqual(len(one.forward(changes=np.zeros((4, 3)))), 4)
        self.assertTrue(one.forward(changes=np.zeros((1, 3))).tip)
        np.testing.assert_allclose(back.position, found.position, atol=1e-9)
        self.assertEqual(back[0].status, "converged")

    def test_bytes_do_not_depend_on_threads(self):
        inputs = rows(3000)
        one, two = (self.robot.forward(inputs=inputs, threads=threads).x for threads in (1, 2))
        self.assertEqual(one.tobytes(), two.tobytes())
        for wrong in (-1, 1.5, "2", 2**40):
            with self.assertRaisesRegex(sinew.InputError, "threads"):
                self.robot.forward(inputs=inputs, threads=wrong)

    def test_out_is_filled(self):
        inputs = rows(8)
        x = np.zeros(8)
        found = self.robot.forward(inputs=inputs, out={"x": x})
        self.assertIs(found.x, x)
        np.testing.assert_array_equal(x, self.robot.forward(inputs=inputs).x)
        whole = np.zeros((8, 5))
        self.robot.forward(inputs=inputs, outputs={"phi": "pose.phi"}, out=whole[:, 2])
        self.assertTrue((whole[:, 2] != 0).any() and not whole[:, [0, 1, 3, 4]].any())

    def test_keywords_of_many_rows_stand_anywhere(self):
        """`out` is no part of the question, whatever is in it."""
        inputs, wanted = rows(5), ["residual"]
        for fields in ({"out": np.full(5, np.nan), "inputs": inputs, "outputs": wanted}, {"threads": 1, "out": np.full(5, np.nan),
                       "outputs": wanted, "inputs": inputs}):
            out = fields["out"]
            self.assertIs(self.robot.forward(**fields).residual, out)
            self.assertFalse(np.isnan(out).any())
        out = np.full(5, np.nan)
        self.assertIs(self.robot.forward(inputs, outputs=wanted, out=out).residual, out)

    def test_keywords_of_many_rows_are_not_of_one(self):
        for name, value in (("threads", 1), ("path", "continue"), ("outputs", ["pose.x"]), ("out", np.full(1, np.nan))):
            with self.assertRaisesRegex(sinew.InputError, f"{name} is for questions of many rows"):
                self.robot.forward([0.19] * 3, **{name: value})
        self.assertTrue(self.robot.forward([0.19] * 3, threads=None).ok)
        with self.assertRaisesRegex(sinew.InputError, 'unknown key "threads"'):
            self.robot.describe(threads=1)

    def test_out_has_any_strides(self):
        speed = self.robot.prepare("velocity", pose={"x": "$x", "y": 0, "phi": 0}, outputs=["J"])
        x = np.linspace(0, 0.02, 5)
        wanted = speed(x).J
        wide = np.zeros((5, 6, 6))
        for out in (np.zeros((5, 3, 3), order="F"), np.zeros((3, 3, 5)).T, np.zeros((5, 3, 3)).transpose(0, 2, 1), wide[:, ::2, ::2], wide[::-1, 1::2, ::-2]):
            self.assertIs(speed(x, out=out).J, out)
            np.testing.assert_array_equal(out, wanted)

    def test_columns_of_one_table_may_be_in_and_out(self):
        table = np.zeros((5, 4))
        table[:, :3] = rows(5)
        wanted = self.robot.forward(table[:, :3], outputs=["pose.x"]).x
        self.robot.forward(table[:, :3], outputs=["pose.x"], out=table[:, 3])
        np.testing.assert_array_equal(table[:, 3], wanted)

    def test_out_of_other_packages_has_a_shape(self):
        out = array.array("d", [0.0] * 5)
        found = self.robot.forward(rows(5), outputs=["pose.x"], out=out)
        self.assertEqual(list(out), list(found.x))
        self.assertIn("x (5,)", repr(found))

    def test_of_no_rows_of_tendons(self):
        arm = sinew.load("nottingham-tpcj")
        for none in (np.zeros((0, 15)), np.zeros((0, 5, 3))):
            self.assertEqual(arm.forward(changes=none).changes.shape, (0, 15))

    def test_rows_of_a_path_begin_at_their_own_solutions(self):
        for name, first in (("3-rfr", [0.19, 0.19, 0.188]), ("3pfs-g2", [0.44, 0.42, 0.41])):
            robot = sinew.load(name)
            inputs = np.array(first) + np.linspace(0, 2e-3, 9)[:, None] * np.arange(3)
            mode = robot.forward(first, all=True).solutions[1].pose  # where a search from home does not end
            found = robot.forward(inputs, start=mode, path="continue")
            self.assertTrue(found.ok.all())
            for name, numbers in found.items():
                if name in mode:
                    np.testing.assert_allclose([one.pose[name] for one in found], numbers, atol=1e-8)
                    self.assertGreater(np.abs(robot.forward(inputs[4]).pose[name] - numbers[4]).max(), 1e-4)
        named = {"a": "pose.x", "b": "pose.y", "c": "pose.phi"}
        planar = self.robot.forward(rows(3), path="continue", outputs=named)
        self.assertAlmostEqual(planar[1].pose.phi, planar.c[1], 12)

    def test_rows_of_a_path_that_are_not_solved_say_why(self):
        found = self.robot.forward(np.linspace([0.19, 0.19, 0.188], [0.15, 0.19, 0.25], 30), path="continue")
        self.assertEqual([one.ok for one in found], found.ok.tolist())
        self.assertFalse(found.ok.all())
        self.assertIn("no pose closes", found[10].message)

    def test_rows_of_a_path_whose_pose_is_not_known_are_refused(self):
        arm = sinew.load("two-segment")
        for found in (self.robot.forward(rows(3), path="continue", outputs=["pose.x"]), arm.forward(tensions=np.ones((3, 6)), path="continue"),
                      self.robot.inverse({"x": np.zeros(3), "y": 0, "phi": 0}, path="continue")):
            with self.assertRaisesRegex(sinew.InputError, "take it from the arrays"):
                found[1]

    def test_a_row_has_a_number(self):
        found = self.robot.forward(rows(5))
        self.assertEqual(found[np.int64(-1)], found[4])
        self.assertEqual(sinew.load("3pfs-g2").forward(np.full((2, 3), 0.42), outputs=["stiffness"])[1].stiffness.shape, (6, 6))
        for wrong in (slice(1, 3), 1.0, None, np.arange(2)):
            with self.assertRaisesRegex(TypeError, "a whole number; found"):
                found[wrong]

    def test_what_takes_no_rows_names_the_array(self):
        arm = sinew.load("nottingham-tpcj")
        for ask, why in ((lambda: arm.diagram(section=0, changes=np.zeros((4, 15))), r"changes has shape \(4, 15\), rows of values; diagram takes one"),
                         (lambda: self.robot.track(poses=np.zeros((3, 3))), r"poses has shape \(3, 3\); give a list of poses"),
                         (lambda: self.robot.inverse(pose=np.zeros(3)), r"pose has shape \(3,\); give a pose"),
                         (lambda: self.robot.forward(np.zeros((2, 2, 3))), "1 dimension for one value, or an array of 2 dimensions for a row each"),
                         (lambda: self.robot.forward(rows(3), path=[1]), "path is a list"),
                         (lambda: self.robot.forward(rows(3), outputs=0), "outputs: found int")):
            with self.assertRaisesRegex(sinew.InputError, why):
                ask()

    def test_out_that_does_not_fit_is_refused(self):
        inputs = rows(8)
        read_only = np.zeros(8)
        read_only.flags.writeable = False
        for wrong in (np.zeros(7), np.zeros(8, np.float32), np.zeros(8, ">f8"), np.zeros((8, 1)), read_only, [0.0] * 8, inputs[:, 0]):
            with self.assertRaises(sinew.InputError):
                self.robot.forward(inputs=inputs, out={"x": wrong})
        shared = np.zeros(8)
        with self.assertRaisesRegex(sinew.InputError, "shares memory"):
            self.robot.forward(inputs=inputs, out={"x": shared, "y": shared})
        with self.assertRaisesRegex(sinew.InputError, "there is no 'z'"):
            self.robot.forward(inputs=inputs, out={"z": shared})
        with self.assertRaisesRegex(sinew.InputError, "give a dict"):
            self.robot.forward(inputs=inputs, out=shared)

    def test_pickle(self):
        found = self.robot.forward(inputs=rows(4))
        again = pickle.loads(pickle.dumps(found))
        np.testing.assert_array_equal(again.x, found.x)
        self.assertEqual(again[2].pose.x, found[2].pose.x)
        self.assertIn("4 rows", repr(again))


class Told(unittest.TestCase):
    def test_question_and_json(self):
        x = np.array([0.0, 0.31])
        found = sinew.load("3-rfr").inverse(pose={"x": x, "y": 0, "phi": 0})
        self.assertEqual(found.question.to_dict(), {"query": "inverse", "pose": {"x": "$pose.x", "y": 0, "phi": 0}})
        self.assertEqual(json.loads(found.to_json())["inputs"][1], [None] * 3)
        self.assertEqual(json.loads(found.to_json())["status"], found.status.tolist())


if __name__ == "__main__":
    unittest.main()
