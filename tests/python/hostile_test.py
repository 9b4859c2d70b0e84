"""What nobody should give, and what must not happen: crashes, hangs, leaks."""
import gc
import os
import pathlib
import resource
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import sinew
from sinew import _sinew

LENGTHS = [0.19, 0.19, 0.188]


class Questions(unittest.TestCase):
    def setUp(self):
        self.robot = sinew.load("3-rfr")

    def refused(self, why, code=None, **fields):
        with self.assertRaisesRegex(sinew.InputError, why) as caught:
            self.robot.forward(**fields)
        if code:
            self.assertEqual(caught.exception.code, code)

    def test_sentences_are_the_library_s(self):
        with self.assertRaises(sinew.InputError) as caught:
            self.robot.forward(input=LENGTHS)
        self.assertEqual(caught.exception.code, "missing_key")
        self.assertEqual(caught.exception.where, "query")
        self.assertIn('unknown key "input"; did you mean "inputs"?', str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)

    def test_no_numbers(self):
        self.refused(r"inputs\[1\] is NaN", "not_a_number", inputs=[0.19, float("nan"), 0.19])
        self.refused(r"inputs\[0\] is infinite", "not_a_number", inputs=[float("inf"), 0.19, 0.19])
        self.refused("too large", inputs=[10**400, 0.19, 0.19])
        self.refused("complex", "wrong_type", inputs=[1j, 0.19, 0.19])
        self.refused("bytes", "wrong_type", inputs=b"abc")
        self.refused("object", "wrong_type", inputs=[object(), 0.19, 0.19])
        self.refused("inputs", inputs="abc")
        self.refused("inputs", inputs=[True, 0.19, 0.19])
        self.refused("inputs", inputs={})
        self.refused("inputs", inputs=[])
        self.refused("start", start={1, 2}, inputs=LENGTHS)
        self.refused("1 is no text|no text", inputs=LENGTHS, start={1: 2})

    def test_no_questions(self):
        for question, why in ((None, "found NoneType"), (3, "found int"), ({"query": 3}, "query = 3 is unknown"),
                              ({"query": None}, 'missing key "query"'), ({"query": [1]}, "query"), ({}, 'missing key "query"')):
            with self.assertRaisesRegex(sinew.InputError, why):
                self.robot.ask(question)

    def test_units_and_masks_are_not_lost(self):
        class Length(np.ndarray):
            unit = "mm"

        self.refused(r"inputs has a unit of its own", "wrong_array", inputs=np.full(3, 190).view(Length))
        self.refused(r"inputs\[1\] is empty", inputs=np.ma.array(LENGTHS, mask=[0, 1, 0]))
        self.assertTrue(self.robot.forward(inputs=np.ma.array(LENGTHS)).ok)

    def test_recursion(self):
        deep = []
        for _ in range(100_000):
            deep = [deep]
        self.refused("64 levels", "too_deep", inputs=deep)
        around = {}
        around["x"] = around
        self.refused("64 levels", "too_deep", inputs=LENGTHS, start=around)
        with self.assertRaises(sinew.InputError):
            sinew.load(around)
        with self.assertRaises(sinew.InputError):
            sinew.load({"legs": deep})
        while deep:  # freed level by level
            deep = deep.pop()

    def test_texts(self):
        for text in ("\0", "a\0b", "\ud800", "\u202e\U0001f9be", "ß" * 1000, "\\\"\n\t\x7f", "x" * 2_000_000):
            with self.assertRaises(sinew.InputError):
                self.robot.forward(inputs=LENGTHS, model=text)
            with self.assertRaises(sinew.InputError):
                self.robot.forward(inputs=LENGTHS, **{text: 1})
            with self.assertRaises((sinew.InputError, UnicodeEncodeError)):
                self.robot.ask(text)
            with self.assertRaises((sinew.InputError, UnicodeEncodeError)):
                sinew.load(text)
            with self.assertRaises((sinew.InputError, UnicodeEncodeError)):
                sinew.load(text + "\n" + text)
            with self.assertRaises(sinew.InputError):
                self.robot.prepare("forward", inputs="$a", **{text: 1})(LENGTHS)

    def test_huge_lists(self):
        self.refused("larger than 4 MiB", inputs=[0.19] * 3_000_000)

    def test_no_robots(self):
        for source in ("", "no-such", "/", "/dev/null", "sinew: 1\nlegs: 3\n", {}, {"legs": float("nan")}, {1: 2}):
            with self.assertRaises(sinew.InputError):
                sinew.load(source)
        for text in ('{"sinew": 1}', ' {"sinew": 1, "name":', "{", "{no: yaml"):  # a text, if of one line
            with self.assertRaises(sinew.InputError) as caught:
                sinew.load(text)
            self.assertTrue(caught.exception.where.startswith("robot:1:"), text)
        with self.assertRaisesRegex(sinew.InputError, "no such file"):
            sinew.load(pathlib.Path('{"error": 1}'))
        for source in (None, 3, b"3-rfr", ["3-rfr"]):
            with self.assertRaisesRegex(sinew.InputError, "a robot is a name"):
                sinew.load(source)
        with self.assertRaises(sinew.InputError) as caught:
            sinew.load("sinew: 1\nname: x\nlegs: 3\n")
        self.assertEqual((caught.exception.where, caught.exception.code), ("robot:3:7", "wrong_type"))

    def test_fields_that_change_while_they_are_read(self):
        class Liar:
            def __init__(self, of):
                self.of = of

            def tolist(self):
                self.of.clear()
                gc.collect()
                return 0.19

        inputs = [0.19, 0.19, 0.19]
        inputs[0] = Liar(inputs)
        self.robot.forward(inputs=inputs)
        fields = {"inputs": [0.19, 0.19]}
        fields["inputs"].append(Liar(fields))
        self.robot.forward(**fields)

        class Raises:
            def tolist(self):
                raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            self.robot.forward(inputs=[Raises(), 1, 1])

        class Asks:
            def tolist(inner):
                return 0.19 * self.robot.forward(LENGTHS).ok

        self.assertTrue(self.robot.forward(inputs=[Asks(), 0.19, 0.19]).ok)


class Handles(unittest.TestCase):
    def test_outlive_what_they_came_from(self):
        answer = sinew.load("3-rfr").forward(LENGTHS)
        prepared = sinew.load("3-rfr").prepare("forward", inputs="$l")
        row = sinew.load("3-rfr").prepare("forward", inputs="$l")(LENGTHS)
        session = sinew.load("3-rfr")._handle.session()
        gc.collect()
        self.assertTrue(answer.robot.forward(LENGTHS).ok)
        self.assertTrue(prepared(LENGTHS).ok)
        self.assertTrue(row.answer.ok)
        self.assertIn("pose", session.ask_text('{"query": "forward", "inputs": [0.19, 0.19, 0.19]}'))

    def test_prepare_says_what_it_takes(self):
        for question in ({"query": "forward", "inputs": "$L"}, None, 7):
            with self.assertRaisesRegex(TypeError, "prepare takes the kind of a question"):
                sinew.load("3-rfr").prepare(question)

    def test_are_not_made_by_hand(self):
        for kind in (_sinew.Handle, _sinew.Session, _sinew.Row):
            with self.assertRaises(TypeError):
                kind()
        with self.assertRaises(TypeError):
            _sinew.Question()
        with self.assertRaises(TypeError):
            sinew.Row()
        for arguments in ((), (1,), ("x", "y"), ("x", 7, 8)):
            with self.assertRaises((TypeError, sinew.InputError)):
                _sinew.open(*arguments)

    def test_runs_of_wrong_buffers(self):
        prepared = sinew.load("3-rfr").prepare("forward", inputs="$l")
        good, x, status = np.full((4, 3), 0.19), np.zeros(4), np.zeros(4, np.uint8)
        outputs = [x, x.copy(), x.copy()]
        for arguments in ((4, [good], outputs, status), (4, good, outputs, status, 1), (4, [], outputs, status, 1),
                          (4, [good], outputs[:2], status, 1), (5, [good], outputs, status, 1), (4, [good], outputs, status[:3], 1),
                          (4, [good[:, :2]], outputs, status, 1), (4, [good.astype(int)], outputs, status, 1), (-1, [good], outputs, status, 1),
                          (4, [good], [x, x, np.zeros(3)], status, 1), (4, [good], outputs, b"1234", 1), (4, [None], outputs, status, 1),
                          (4, [good], outputs, status, "1"), (4, [good], outputs, status, 2**70)):
            with self.assertRaises((TypeError, ValueError, BufferError, OverflowError)):
                prepared.run(*arguments)

    def test_layout_is_nobody_s_to_change(self):
        prepared = sinew.load("3-rfr").prepare("forward", inputs="$l")
        prepared.layout["inputs"][0]["shape"].append(10**6)
        prepared.layout["inputs"].clear()
        prepared.layout["outputs"].clear()
        gc.collect()
        try:
            prepared(LENGTHS)
        except Exception:
            pass  # no crash


class Threads(unittest.TestCase):
    def test_ask_one_robot_at_once(self):
        robot = sinew.load("3pfs-g2")
        prepared = robot.prepare("forward", inputs="$l", path="continue")
        wanted = robot.prepare("forward", inputs="$l")([0.44, 0.42, 0.41]).position
        wrong = []

        def work(seed):
            inputs = np.random.default_rng(seed).uniform(0.41, 0.44, (200, 3))
            for _ in range(5):
                if abs(robot.forward([0.44, 0.42, 0.41]).pose.position - wanted).max() > 1e-9:
                    wrong.append("forward")
                if not prepared(inputs, threads=2).ok.all():
                    wrong.append("columns")
                if abs(prepared([0.44, 0.42, 0.41]).position - wanted).max() > 1e-9:
                    wrong.append("row")

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(20)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_stop_ends_what_another_computes(self):
        robot = sinew.load("3pfs-g2")
        prepared = robot.prepare("forward", inputs="$l")
        found = []
        inputs = np.random.default_rng(0).uniform(0.41, 0.44, (10**6, 3))
        thread = threading.Thread(target=lambda: found.append(prepared(inputs)))
        thread.start()
        while thread.is_alive():
            prepared.stop()
            thread.join(0.05)
        self.assertGreater(found[0].counts["stopped"], 0)
        self.assertTrue(prepared([0.44, 0.42, 0.41]).ok)

    def test_stop_ends_what_all_others_compute(self):
        prepared = sinew.load("3pfs-g2").prepare("forward", inputs="$l")
        found = []
        inputs = np.random.default_rng(0).uniform(0.41, 0.44, (10**5, 3))
        threads = [threading.Thread(target=lambda: found.append(prepared(inputs, threads=1))) for _ in range(20)]
        for thread in threads:
            thread.start()
        time.sleep(0.05)
        while any(thread.is_alive() for thread in threads):
            prepared.stop()
            time.sleep(0.01)
        self.assertEqual([columns.counts.get("stopped", 0) > 0 for columns in found], 20 * [True])

    def test_die_with_the_process_while_they_compute(self):
        code = ("import sinew, threading, time, numpy as np\n"
                "r = sinew.load('3pfs-g2')\n"
                "threading.Thread(target=lambda: r.forward(inputs=np.full((10**7, 3), 0.42)), daemon=True).start()\n"
                "threading.Thread(target=lambda: [r.forward([0.42, 0.42, 0.42]) for _ in range(10**6)], daemon=True).start()\n"
                "time.sleep(0.2)\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_forked_child_computes(self):
        robot = sinew.load("3-rfr")
        robot.forward(LENGTHS)
        child = os.fork()
        if child == 0:
            fine = robot.forward(LENGTHS).ok and robot.forward(inputs=np.full((100, 3), 0.19)).ok.all()
            os._exit(0 if fine else 1)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)


class Memory(unittest.TestCase):
    def grows(self, work, times):
        """Bytes that `times` more calls take, once what is kept is kept."""
        for _ in range(times // 2):
            work()
        gc.collect()
        before = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
        for _ in range(times):
            work()
        gc.collect()
        return (int(pathlib.Path("/proc/self/statm").read_text().split()[1]) - before) * resource.getpagesize()

    def test_does_not_leak(self):
        robot = sinew.load("3-rfr")
        prepared = robot.prepare("forward", inputs="$l")
        inputs = np.full((50, 3), 0.19)

        def refused():
            for call in (lambda: robot.forward(inputs=[float("nan")] * 3), lambda: robot.forward(inputs=[1]), lambda: prepared([1]),
                         lambda: prepared(inputs, out=inputs), lambda: sinew.load("none"), lambda: robot.prepare("x", y="$z")(1.0)):
                try:
                    call()
                except sinew.InputError:
                    continue
                self.fail("not refused")

        for work, times in ((lambda: robot.forward(LENGTHS).pose.x, 4000), (lambda: prepared(LENGTHS).x, 4000),
                            (lambda: robot.forward(inputs=inputs).x, 400), (refused, 400), (lambda: sinew.load("3-rfr"), 200),
                            (lambda: robot.prepare("forward", inputs="$l")(LENGTHS), 200), (lambda: str(robot.forward(LENGTHS)), 400)):
            self.assertLess(self.grows(work, times), 1_500_000)

    def test_objects_are_freed(self):
        class Marked(list):
            pass

        robot = sinew.load("3-rfr")
        prepared = robot.prepare("forward", inputs="$l")
        given = Marked(LENGTHS)
        before = sys.getrefcount(given), sys.getrefcount(0.5), sys.getrefcount(None)
        for _ in range(100):
            robot.forward(inputs=given)
            prepared(given)
        self.assertEqual(sys.getrefcount(given), before[0])
        self.assertLess(abs(sys.getrefcount(None) - before[2]), 50)


if __name__ == "__main__":
    unittest.main()
