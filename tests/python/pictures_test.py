"""Pictures of answers: in a notebook, in a file, by matplotlib, in the viewer."""
import array
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import urllib.request
import xml.etree.ElementTree

import sinew
from sinew import _drawing, _view

try:
    import matplotlib
    matplotlib.use("Agg")
except ImportError:
    matplotlib = None


ARM = {"sinew": 1, "name": "mine", "kind": "serial", "sections": [
    {"type": "neutral", "segments": 1, "joint": 0.06, "tendons": {"count": 3, "radius": 0.004, "angle": 0}}]}


def some_answers():
    """One of each kind, by what was asked."""
    home = {"x": 0.01, "y": 0, "phi": 0.1}
    planar = sinew.load("3-rfr")
    yield planar.forward([0.19, 0.19, 0.188])
    yield planar.inverse(home, bending=[1, -1, 1])
    yield planar.velocity(home)
    yield planar.statics(set_at=home, wrench=[0.01, 0, 0])
    yield planar.shape(home)
    yield planar.forward([0.19, 0.19, 0.188], model="prb", wrench=[0.01, 0, 0])
    rods = sinew.load("3pfs-g2")
    yield rods.forward([0.44, 0.42, 0.41], wrench=[0, 0, -5, 0, 0, 0])
    yield rods.inverse(independent={"z": 0.39, "e1": 0.1, "e2": 0.05})
    spatial = sinew.load("6-ufs")
    yield spatial.inverse(spatial.describe().home)
    yield sinew.load("nottingham-tpcj").forward(changes=[[-0.001, 0.0005, 0.0005]])
    arm = sinew.load("two-segment")
    yield arm.forward(tensions=[[4, 0, 0], [0, 1, 0]], wrench=[0.02, 0, 0, 0, 0, 0])
    yield arm.inverse(position=[0.05, 0.1, 0.36])
    yield arm.statics(tensions=[[2, 0, 0], [0, 0, 0]], position=arm.forward(tensions=[[2, 0, 0], [0, 0, 0]]).tip.position)


class Html(unittest.TestCase):
    def test_of_answers_has_a_picture_and_a_table(self):
        for answer in some_answers():
            page = answer._repr_html_()
            picture = re.search(r"<svg.*?</svg>", page)
            self.assertTrue(picture, answer)
            lines = xml.etree.ElementTree.fromstring(picture.group()).findall("{http://www.w3.org/2000/svg}polyline")
            self.assertGreater(len(lines), 3, answer)
            xml.etree.ElementTree.fromstring(page)
            self.assertNotIn("nan", picture.group())

    def test_of_what_has_no_shape_is_a_table(self):
        page = sinew.load("3-rfr").inverse({"x": 0.31, "y": 0, "phi": 0})._repr_html_()
        self.assertIn("needs a chord", page)
        self.assertNotIn("<svg", page)

    def test_of_every_robot_at_home(self):
        for name in sinew.robots():
            self.assertTrue(_drawing.polylines(_drawing.shape_of(sinew.load(name), None)), name)

    def test_struts_reach_from_links_to_the_platform(self):
        for name, struts in (("3-rfr", 0), ("3pfs-g2", 0), ("3-frr", 3), ("3-rfrr", 3), ("3prs", 3), ("2prs-1pfs", 2)):
            kinds = [kind for kind, _ in _drawing.polylines(_drawing.shape_of(sinew.load(name), None))]
            self.assertEqual(kinds.count("strut"), struts, name)

    def test_of_rows_and_of_columns(self):
        robot = sinew.load("3-rfr")
        self.assertIn("<svg", robot.prepare("forward", inputs="$l")([0.19, 0.19, 0.188])._repr_html_())
        import numpy as np
        self.assertIn("(4,)", robot.forward(inputs=np.full((4, 3), 0.19))._repr_html_())

    def test_of_an_answer_without_a_pose_is_refused(self):
        robot = sinew.load("3-rfr")
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(sinew.InputError, "an answer to describe has no pose"):
            robot.save_html(robot.describe(), os.path.join(folder, "none.html"))

    def test_of_arms_shows_what_tendons_pull(self):
        arm = sinew.load("two-segment")
        answer = arm.forward(tensions=[[4, 0, 0], [0, 1.5, 0]])
        shape = _drawing.shape_of(arm, answer)
        kinds = [kind for kind, _ in _drawing.polylines(shape)]
        self.assertEqual(kinds, ["pull 4", "slack", "slack", "slack", "pull 2", "slack", "backbone"])
        self.assertEqual(_drawing.pulls(shape), [("slack", "slack"), ("pull 2", "up to 2 N"), ("pull 4", "up to 4 N")])
        self.assertRegex(answer._repr_html_(), "up to 4 N")
        self.assertIn('stroke-dasharray="3 3"', answer._repr_html_())
        self.assertEqual(_drawing.pulls(_drawing.shape_of(arm, arm.forward())), [("slack", "slack")])
        for robot in (sinew.load("3-rfr"), sinew.load("nottingham-tpcj")):
            self.assertEqual(_drawing.pulls(_drawing.shape_of(robot, None)), [])

    def test_of_arms_is_where_the_answer_is(self):
        arm = sinew.load("ftdcr-v4")
        for answer in (arm.forward(changes=[[-0.001, 0.001, 0]], loads=[{"place": 0.1, "wrench": [0.05, 0, 0, 0, 0, 0]}]),
                       arm.inverse(position=[0.02, 0.05, 0.15], gravity=[0, 0, 0]), arm.velocity(tensions=[[1, 0, 0]], model="prb")):
            tip = answer.tip.position
            end = _drawing.shape_of(arm, answer)["backbones"][0][-1]
            self.assertLess(max(abs(a - b) for a, b in zip(tip, end)), 1e-9)

    def test_escapes_names(self):
        robot = sinew.load({**ARM, "name": "</script><b>&"})
        page = robot.forward(configuration=[[0.1, 0.1]])._repr_html_()
        self.assertNotIn("<b>", page)

    def test_one_file_that_loads_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            for answer in (*some_answers(), None):
                robot = answer.robot if answer is not None else sinew.load("3pfs-g2")
                path = os.path.join(folder, "pose.html")
                robot.save_html(answer, path)
                with open(path, encoding="utf-8") as file:
                    page = file.read()
                self.assertIn("<canvas", page)
                self.assertNotRegex(page, r"https?://|@\w+@")


@unittest.skipUnless(matplotlib, "matplotlib is not installed")
class Plots(unittest.TestCase):
    def test_have_equal_axes_and_units(self):
        for answer in some_answers():
            ax = answer.robot.plot(answer)
            self.assertEqual(ax.get_xlabel(), "x [mm]")
            if hasattr(ax, "get_zlim"):
                sizes = [high - low for low, high in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
                self.assertAlmostEqual(min(sizes), max(sizes))
            else:
                self.assertEqual(ax.get_aspect(), 1.0)
            ax.figure.canvas.draw()
            matplotlib.pyplot.close(ax.figure)

    def test_into_axes_of_one_s_own(self):
        figure, ax = matplotlib.pyplot.subplots()
        self.assertIs(sinew.load("3-rfr").plot(ax=ax), ax)
        with self.assertRaisesRegex(ValueError, "3d"):
            sinew.load("3pfs-g2").plot(ax=ax)
        matplotlib.pyplot.close(figure)

    def test_side_by_side_to_one_scale(self):
        figure, both = matplotlib.pyplot.subplots(1, 2, sharex=True, sharey=True)
        for ax in both:
            sinew.load("3-rfr").plot(ax=ax)
        figure.canvas.draw()
        matplotlib.pyplot.close(figure)


class Viewer(unittest.TestCase):
    def test_serves_the_robot_and_ends(self):
        try:
            _view.command()
        except sinew.InputError as error:
            self.skipTest(str(error))
        for robot in (sinew.load("3-rfr"), sinew.load(ARM)):
            with robot.view(open_browser=False) as view:
                with urllib.request.urlopen(view.url) as reply:
                    self.assertEqual(reply.status, 200)
                self.assertIn(view.url, view._repr_html_())
            self.assertIsNotNone(view._process.poll())

    def test_serves_the_robot_that_was_changed(self):
        try:
            _view.command()
        except sinew.InputError as error:
            self.skipTest(str(error))
        robot = sinew.load("3-rfr").set({"legs[0].link.length": 0.18, "legs[1].link.length": "170 mm"})
        robot = robot.set({"legs[2].base.point": array.array("d", [0.17, -0.09]), "platform.home": {"x": 0.001, "y": 0, "phi": 0}})
        with robot.view(open_browser=False) as view, urllib.request.urlopen(view.url + "api/robots") as reply:
            opened = json.load(reply)["opened"]
        self.assertEqual(opened["name"], "3-rfr")
        self.assertEqual(opened["changed"]["set"][:2], ["legs[0].link.length=0.18", "legs[1].link.length=170 mm"])
        shown = sinew.load(opened["changed"]["text"]).describe().to_dict()
        self.assertEqual(shown["legs"][0]["link"]["length"], 0.18)
        self.assertEqual(shown, robot.describe().to_dict())

    def test_in_a_notebook_it_may_be_framed(self):
        try:
            _view.command()
        except sinew.InputError as error:
            self.skipTest(str(error))
        for is_notebook, ancestors in ((False, "'none'"), (True, "http://127.0.0.1:* http://localhost:*")):
            with unittest.mock.patch.object(_view, "_in_notebook", lambda is_notebook=is_notebook: is_notebook):
                with sinew.load("3-rfr").view(open_browser=False) as view, urllib.request.urlopen(view.url) as reply:
                    self.assertIn(f"frame-ancestors {ancestors};", reply.headers["Content-Security-Policy"])

    def test_without_the_command_says_so(self):
        code = "import sinew._view\ntry: sinew._view.command()\nexcept sinew.InputError as e: print(e.code)\n"
        environment = {**os.environ, "PATH": "/nowhere"}
        if os.path.exists(os.path.join(os.path.dirname(sinew.__file__), "bin", "sinew")):
            self.skipTest("the command is within the package")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
        self.assertEqual(done.stdout, "program_missing\n")


if __name__ == "__main__":
    unittest.main()
