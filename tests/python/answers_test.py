"""Robots and answers: what a user of one pose meets."""
import copy
import json
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import sinew

ROOT = pathlib.Path(__file__).resolve().parents[2]
LENGTHS = [0.44, 0.42, 0.41]


class Robots(unittest.TestCase):
    def test_all_that_come_along_open_and_describe_themselves(self):
        names = sinew.robots()
        self.assertEqual(names, sorted(path.stem for path in (ROOT / "robots").glob("*.yaml")))
        for name in names:
            robot = sinew.load(name)
            self.assertTrue(robot.describe().ok, name)
            self.assertEqual(robot.inputs[0].unit, "rad" if "theta" in robot.inputs[0].name else "m")

    def test_open_from_file_text_and_dict_alike(self):
        path = ROOT / "robots" / "3-rfr.yaml"
        named, text = sinew.load("3-rfr"), path.read_text()
        asked = {"inputs": [0.19, 0.19, 0.188]}
        for source in (path, str(path), text, named):
            self.assertEqual(sinew.load(source).forward(**asked), named.forward(**asked))
        spec = {"sinew": 1, "name": "mine", "kind": "serial", "sections": [
            {"type": "neutral", "segments": 1, "joint": "60 mm", "tendons": {"count": 3, "radius": "4 mm", "angle": 0}}]}
        mine = sinew.load(spec)
        self.assertEqual(mine.name, "mine")
        self.assertTrue(mine.forward(configuration=[[0.3, 0.1]]).ok)

    def test_open_from_json_of_one_line(self):
        spec = {"sinew": 1, "name": "mine", "kind": "serial", "sections": [
            {"type": "neutral", "segments": 1, "joint": "60 mm", "tendons": {"count": 3, "radius": "4 mm", "angle": 0}}]}
        for text in (json.dumps(spec), "  " + json.dumps(spec)):
            self.assertEqual(sinew.load(text).name, "mine")

    def test_copies_pickles_and_equality(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.yaml")
            pathlib.Path(path).write_text((ROOT / "robots" / "3-rfr.yaml").read_text())
            mine = sinew.load(path)
            packed = pickle.dumps(mine)
        again = pickle.loads(packed)  # where the file is no longer
        self.assertEqual(again, mine)
        self.assertEqual(hash(again), hash(mine))
        self.assertEqual(again.forward([0.19, 0.19, 0.19]), mine.forward([0.19, 0.19, 0.19]))
        named = sinew.load("3-rfr")
        self.assertEqual(repr(pickle.loads(pickle.dumps(named))), repr(named))
        self.assertEqual(eval(repr(named), {"sinew": sinew}), named)
        self.assertIs(copy.copy(named), named)
        self.assertIs(copy.deepcopy(named), named)
        self.assertNotEqual(named, sinew.load("3-frr"))
        self.assertNotEqual(named, "3-rfr")

    def test_changed_ones_are_others(self):
        robot = sinew.load("3-rfr")
        changed = robot.set({"legs[0].link.length": "180 mm"})
        self.assertEqual(changed.describe().legs[0].link.length, 0.18)
        self.assertEqual(robot.describe().legs[0].link.length, 0.2)
        self.assertNotEqual(changed, robot)
        twice = changed.set({"legs[1].link.length": 0.19})
        self.assertEqual([leg.link.length for leg in twice.describe().legs], [0.18, 0.19, 0.2])
        self.assertEqual(pickle.loads(pickle.dumps(twice)), twice)
        own = {"set": {"legs[0].link.length": 0.18}}
        self.assertEqual(changed.forward([0.19, 0.19, 0.188]).pose, robot.forward([0.19, 0.19, 0.188], **own).pose)
        with self.assertRaisesRegex(sinew.InputError, "legs"):
            robot.set({"legs[9].link.length": 1})
        for values in ({"legs": {"0": [1.0, float("nan")]}}, {"legs[0]": [np.array([1, np.inf])]}):
            with self.assertRaisesRegex(sinew.InputError, r"^legs.* is (nan|inf); give a finite number"):
                robot.set(values)


class Answers(unittest.TestCase):
    def setUp(self):
        self.robot = sinew.load("3pfs-g2")

    def test_are_what_the_library_wrote(self):
        answer = self.robot.forward(inputs=LENGTHS, wrench=[0, 0, -5, 0, 0, 0], want=["stiffness", "stability"])
        plain = json.loads(answer.to_json())
        self.assertTrue(answer.ok)
        self.assertEqual((answer.status, answer.message), ("converged", ""))
        self.assertEqual(list(answer.pose.position), plain["pose"]["position"])
        self.assertEqual(answer["pose"]["quaternion"].shape, (4,))
        self.assertEqual(answer.stiffness.shape, (6, 6))
        self.assertEqual(answer.legs[2].length, 0.42)
        self.assertEqual(answer.units["pose.position"], "m")
        self.assertEqual(answer.units["legs[].force"], "N")
        self.assertEqual(answer.units["inputs"], "m")
        self.assertEqual(answer.to_dict(), plain)
        self.assertEqual(answer.question.wrench.tolist(), [0, 0, -5, 0, 0, 0])
        self.assertIn("stiffness", dir(answer))

    def test_can_be_asked_with(self):
        found = self.robot.forward(LENGTHS)
        again = self.robot.shape(inputs=found.inputs, start=found.pose, samples=5)
        self.assertEqual(again.backbones[0].shape, (5, 3))
        planar = sinew.load("3-rfr")
        pose = planar.forward([0.19, 0.19, 0.188]).pose
        self.assertAlmostEqual(planar.inverse(pose, bending=[1, 1, 1]).inputs[2], 0.188)

    def test_of_what_has_no_solution_are_no_errors(self):
        answer = sinew.load("3-rfr").inverse(pose={"x": "310 mm", "y": 0, "phi": 0})
        self.assertFalse(answer.ok)
        self.assertEqual(answer.status, "unreachable")
        self.assertIn("legs[0] needs a chord of 389.932 mm", answer.message)
        with self.assertRaisesRegex(AttributeError, "no 'inputs'; it has"):
            answer.inputs

    def test_say_the_way_to_what_they_have_not(self):
        robot = sinew.load("3pfs-g2")
        with self.assertRaisesRegex(AttributeError, r'want=\["stiffness"\]$'):
            robot.forward([0.42] * 3).stiffness
        with self.assertRaisesRegex(sinew.InputError, r"Rows are given as an array: inputs=numpy.array"):
            robot.forward(inputs=[[0.42] * 3] * 4)

    def test_have_names_that_are_words_of_python(self):
        robot = sinew.load("3-rfr")
        home = {"x": 0, "y": 0, "phi": 0}
        self.assertEqual(robot.velocity(pose=home).type_2.class_, "regular")
        path = robot.track(from_=home, to={"x": 0.01, "y": 0, "phi": 0}, samples=3)
        self.assertEqual(len(path.rows), 3)

    def test_every_question_is_a_method(self):
        home = {"x": 0, "y": 0, "phi": 0}
        robot, arm = sinew.load("3-rfr"), sinew.load("nottingham-tpcj")
        self.assertTrue(robot.velocity(home).ok)
        self.assertTrue(robot.statics(set_at=home, wrench=[0, 0.01, 0]).ok)
        self.assertTrue(robot.shape(pose=home).ok)
        self.assertTrue(arm.diagram(section=0, changes=[-0.0011, 0.002, -0.0005])["class"])
        self.assertTrue(arm.velocity(configuration=[[0.1, 0.1]]).ok)
        self.assertEqual(arm.velocity([[0.1, 0.1]]), arm.velocity(configuration=[[0.1, 0.1]]))
        self.assertEqual(arm.inverse([0.05, 0.02, 0.12]).question.position.tolist(), [0.05, 0.02, 0.12])
        elastic = sinew.load("two-segment")
        self.assertEqual(elastic.forward([[1, 0, 0], [0, 1, 0]]), elastic.forward(tensions=[[1, 0, 0], [0, 1, 0]]))
        with self.assertRaisesRegex(TypeError, "'tensions' twice"):
            elastic.forward([[1, 0, 0], [0, 1, 0]], tensions=[[1, 0, 0], [0, 1, 0]])
        self.assertEqual(robot.ask({"query": "inverse", "pose": home}), robot.inverse(home))
        self.assertEqual(robot.ask('{"id": 7, "query": "inverse", "pose": {"x": 0, "y": 0, "phi": 0}}')["id"], 7)

    def test_last_is_the_last_of_this_thread(self):
        walk = [self.robot.forward([0.44 - 0.001 * k, 0.42, 0.41], start="last").iterations for k in range(4)]
        self.assertLess(walk[-1], self.robot.forward([0.40, 0.42, 0.41]).iterations + 1)

    def test_copies_pickles_and_texts(self):
        answer = self.robot.forward(LENGTHS)
        again = pickle.loads(pickle.dumps(answer))
        self.assertEqual(again, answer)
        self.assertEqual(again.pose.position.tolist(), answer.pose.position.tolist())
        self.assertEqual(copy.deepcopy(answer), answer)
        self.assertEqual(pickle.loads(pickle.dumps(answer.pose)), answer.pose)
        self.assertTrue(repr(answer).startswith("<forward of 3PFS-G2: converged"))
        self.assertIn("pose.position", str(answer))
        self.assertEqual(dict(answer)["status"], "converged")
        self.assertEqual(len({answer, again}), 1)


class Units(unittest.TestCase):
    def test_are_those_of_the_place(self):
        arm, planar = sinew.load("nottingham-tpcj"), sinew.load("3-rfr")
        diagram = arm.diagram(0, changes=[[0, 0, 0]]).units
        self.assertEqual((diagram["point"], diagram["area"], diagram["margin"]), ("rad", "rad^2", "m"))
        tip = arm.forward(configuration=[[0.1, 0.1]]).units
        self.assertEqual((tip["tip.position"], tip["tip.quaternion"], "tip" in tip), ("m", "", False))
        track = planar.track([{"x": 0, "y": 0, "phi": 0}, {"x": 0.01, "y": 0, "phi": 0}]).units
        self.assertEqual((track["rows[].pose.x"], "rows[].indices.position" in track), ("m", False))
        self.assertNotIn("freedoms.platform", planar.describe().units)
        self.assertEqual(planar.velocity(pose={"x": 0, "y": 0, "phi": 1.0471975511965976}).units.get("type_2.point"), "m")

    def test_are_those_of_columns(self):
        robot, wants = sinew.load("3pfs-g2"), ["stiffness", "velocity", "sensitivity", "margins"]
        places = ["stiffness", "J", "K", "U", "sensitivity", "margins.fold", "margins.strain", "pose.position", "energy"]
        one = robot.forward(LENGTHS, want=wants).units
        self.assertEqual((one["margins.fold"], one["margins.strain"]), ("", ""))
        many = robot.prepare("forward", inputs="$l", want=wants, outputs={f"out_{index}": place for index, place in enumerate(places)}).outputs
        for place, field in zip(places, many):
            self.assertEqual(one[place], field["unit"], place)

    def test_are_those_of_the_robot(self):
        planar, arm = sinew.load("3-rfr"), sinew.load("two-segment")
        units = planar.velocity([0.193, 0.189, 0.187]).units
        self.assertEqual((units["J"], units["K"], units["U"]), ("m, m^2", "m", "1, rad/m"))
        self.assertEqual(planar.velocity(pose={"x": 0, "y": 0, "phi": 0}).units["J"], "m, m^2")
        units = arm.forward([[1, 0, 0], [0, 0, 0]], want=["velocity", "stiffness"]).units
        self.assertEqual((units["U"], units["stiffness"]), ("m/N, rad/N", "N/m, N, N m"))


class Paths(unittest.TestCase):
    def test_of_an_arm_whose_tendons_rub(self):
        arm = sinew.load("tendon-rod").set({"sections[0].tendons.friction": 0.3})
        path = arm.track(points=[{"tensions": [[3, 0, 0, 0]]}, {"tensions": [[1, 0, 0, 0]]}], steps=4)
        self.assertEqual((path.status, len(path.rows), path.rows[3].point, path.rows[3].part), ("converged", 8, 0, 1))
        pulled = arm.track(points=[{"tensions": [[1, 0, 0, 0]]}], steps=4)
        self.assertGreater(path.tip.position[0], pulled.tip.position[0] + 1e-4)
        self.assertLess(path.rows[3].end_tensions[0][0], 3)
        self.assertGreater(path.friction_loss, 0)
        self.assertEqual((path.units["rows[].friction_loss"], path.units["rows[].changes"], path.units["rows[].point"]), ("J", "m", ""))
        moves = arm.track(points=[{"tensions": [[3, 0, 0, 0]]}], steps=4, want=["velocity"], motions=[[1, 0, 0, 0]])
        units = moves.units
        self.assertEqual((units["in_motion.changes"], "one_sided[].growing.changes" in units), ("m/s", False))
        rows = arm.prepare("track", points=[{"tensions": "$T"}], path="continue", outputs={"x": "tip.position[0]"})
        out = rows([[3, 0, 0, 0], [1, 0, 0, 0]])
        self.assertAlmostEqual(out.x[1], path.tip.position[0], 4)


class Uneven(unittest.TestCase):
    def test_lists_stay_lists(self):
        shape = sinew.load("nottingham-tpcj").shape(configuration=[[0.1, 0.1]])
        self.assertEqual(len(shape.tendons), 5)
        self.assertEqual(shape.backbones.shape[2], 3)


class Help(unittest.TestCase):
    def test_names_fields_shapes_units_and_frames(self):
        for verb in ("forward", "inverse", "velocity", "statics", "track", "diagram", "shape", "describe"):
            text = getattr(sinew.Robot, verb).__doc__
            self.assertIn("The answer has", text)
        self.assertIn("(6,)", sinew.Robot.forward.__doc__)
        self.assertIn("base axes", sinew.Robot.forward.__doc__)
        self.assertIn("[N, N m]", sinew.Robot.forward.__doc__)

    def test_version(self):
        self.assertEqual(sinew.__version__, sinew.load("3-rfr").describe().versions.sinew)


if __name__ == "__main__":
    unittest.main()
