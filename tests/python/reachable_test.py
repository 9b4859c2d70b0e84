"""Every question of every robot that comes along, by keywords and, where numbers go in, as columns."""
import unittest

import numpy as np

import sinew
from sinew._fields import VERBS

# What a robot may say of a question that this version has not got for it.
NOT_FOR_THIS_ROBOT = {"not_available", "wrong_kind", "unknown_key", "missing_key", "no_such_leg"}


def questions(robot):
    """Verb and fields that fit the robot: about its home."""
    about = robot.describe()
    yield "describe", {}
    if about.kind == "serial":
        bends = [[0.05] * (3 if "extension" in section else 2) for section in about.sections]
        tip = robot.forward(configuration=bends)
        yield "forward", {"configuration": bends}
        yield "forward", {"changes": tip.changes}
        yield "inverse", {"position": tip.tip.position}
        yield "velocity", {"configuration": bends}
        yield "shape", {"configuration": bends}
        yield "diagram", {"section": 0, "changes": tip.changes[0]}
        return
    if about.kind == "arm":
        rest = robot.forward(changes=[])
        yield "forward", {"changes": rest.changes}
        yield "forward", {"tensions": rest.tensions}
        yield "inverse", {"position": rest.tip.position}
        yield "velocity", {"changes": rest.changes}
        yield "shape", {"changes": rest.changes}
        yield "statics", {"changes": rest.changes, "position": rest.tip.position}
        yield "track", {"points": [{"changes": rest.changes}, {"wrench": [0, 0, 0.01, 0, 0, 0]}], "steps": 1}
        return
    if about.kind == "arm_legs":
        rest = robot.forward(changes=[])
        pose = rest.pose.to_dict()
        for verb in ("forward", "velocity", "shape"):
            yield verb, {"changes": rest.changes}
        yield "forward", {"tensions": rest.tensions}
        yield "inverse", {"pose": pose}
        is_planar = "phi" in pose
        place = [pose["x"], pose["y"]] if is_planar else rest.pose.position
        yield "inverse", {"position": place}
        yield "statics", {"changes": rest.changes, "pose": pose}
        wrench = [0.01, 0, 0] if is_planar else [0, 0, 0.01, 0, 0, 0]
        yield "track", {"points": [{"changes": rest.changes}, {"wrench": wrench}], "steps": 1}
        return
    home = about.home.to_dict()
    yield "inverse", {"pose": home}
    yield "velocity", {"pose": home}
    yield "shape", {"pose": home}
    yield "track", {"from_": home, "to": home, "samples": 2}
    yield "statics", {"set_at": home}
    if "position" in home:
        held = {"z": home["position"][2], "e1": 0.0, "e2": 0.0}
        yield "inverse", {"independent": held}
        yield "velocity", {"independent": held}
        yield "shape", {"independent": held}
    inputs = inputs_at_home(robot)
    for verb in ("forward", "velocity", "shape"):
        yield verb, {"inputs": inputs}
    yield "statics", {"inputs": inputs, "axial_forces": [0.0] * 6}


def inputs_at_home(robot):
    home = robot.describe().home.to_dict()
    for fields in ({"pose": home}, {"independent": {"z": home.get("position", [0] * 3)[-1], "e1": 0.0, "e2": 0.0}}):
        try:
            return robot.inverse(**fields).inputs
        except (sinew.InputError, AttributeError):
            continue
    raise AssertionError(f"no inputs of {robot.name} at home")


def as_columns(fields):
    """The same with two equal rows in each vector."""
    return {name: np.array([value, value]) if name in ("inputs", "position", "configuration") else
            {key: np.array([item, item]) for key, item in value.items()} if name in ("pose", "independent") else value
            for name, value in fields.items()}


class Reachable(unittest.TestCase):
    def test_every_question_of_every_robot(self):
        asked = {verb: set() for verb in VERBS}
        for name in sinew.robots():
            robot = sinew.load(name)
            for verb, fields in questions(robot):
                with self.subTest(robot=name, verb=verb, fields=list(fields)):
                    try:
                        answer = getattr(robot, verb)(**fields)
                    except sinew.InputError as error:
                        self.assertIn(error.code, NOT_FOR_THIS_ROBOT, error)
                        continue
                    self.assertIn(answer.status, sinew.Status.__members__)
                    asked[verb].add(name)
        for verb in ("describe", "forward", "inverse", "velocity", "shape"):
            self.assertEqual(asked[verb], set(sinew.robots()), verb)
        for verb, least in (("track", 8 + 4), ("statics", 6), ("diagram", 4)):
            self.assertGreaterEqual(len(asked[verb]), least, verb)

    def test_columns_answer_what_single_questions_answer(self):
        for name in sinew.robots():
            robot = sinew.load(name)
            for verb, fields in questions(robot):
                many = as_columns(fields)
                if verb in ("describe", "track", "statics", "shape", "diagram") or "changes" in fields or "tensions" in fields:
                    continue
                with self.subTest(robot=name, verb=verb, fields=list(fields)):
                    try:
                        answer = getattr(robot, verb)(**fields)
                    except sinew.InputError:  # the columns are refused, too, or no row is solved
                        try:
                            self.assertFalse(getattr(robot, verb)(**many).ok.any())
                        except sinew.InputError:
                            pass
                        continue
                    found = getattr(robot, verb)(**many)
                    self.assertEqual([sinew.Status(code).name for code in found.status], [answer.status] * 2)


if __name__ == "__main__":
    unittest.main()
