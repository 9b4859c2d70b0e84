"""Ctrl-C while sinew computes."""
import signal
import subprocess
import sys
import time
import unittest

COLUMNS = "sinew.load('3pfs-g2').forward(inputs=numpy.random.default_rng(1).uniform(0.41, 0.44, (10**6, 3)))"
ONE = "sinew.load('hexapod-torsion').forward(inputs=[0.53] * 6, all=True)"
FIT = ("sinew.load('ftdcr-v4').identify({'pulls': [[1e-3 * (k % 9 == i) + 1e-4 * (k % 7) for i in range(9)] for k in range(600)],"
       " 'markers': [[1e-3 * (k % 5), 1e-3 * (k % 3), 0.19] for k in range(600)]}, model='subsegment_rod', folds=50)")
HEAD = "import numpy, signal, sinew, sys, threading\n"


class Interrupt(unittest.TestCase):
    def run_and_interrupt(self, code, times=1):
        """What it wrote, and the seconds from the signal to the end."""
        program = subprocess.Popen([sys.executable, "-c", HEAD + code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(program.kill)
        self.assertEqual(program.stdout.readline(), "begins\n", )
        time.sleep(0.3)
        for _ in range(times):
            program.send_signal(signal.SIGINT)
            time.sleep(0.1)
        start = time.monotonic()
        out, errors = program.communicate(timeout=120)
        return out, errors, program.returncode, time.monotonic() - start

    def test_ends_columns_and_single_solves(self):
        for long in (COLUMNS, ONE, FIT):
            out, errors, code, seconds = self.run_and_interrupt(f"print('begins', flush=True)\n{long}\nprint('went on')\n")
            self.assertTrue(errors.rstrip().endswith("KeyboardInterrupt"), errors)
            self.assertEqual((out, code), ("", -signal.SIGINT))
            self.assertLess(seconds, 10)

    def test_that_is_caught_leaves_all_as_it_was(self):
        out, errors, code, _ = self.run_and_interrupt(f"""
robot = sinew.load('3pfs-g2')
print('begins', flush=True)
try:
    {COLUMNS}
except KeyboardInterrupt:
    print(robot.forward(inputs=numpy.full((100, 3), 0.42)).ok.all(), robot.forward([0.42] * 3).ok)
    print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)
""")
        self.assertEqual((out, errors, code), ("True True\nTrue\n", "", 0))

    def test_that_a_handler_takes_does_not_spoil_the_answer(self):
        out, errors, code, _ = self.run_and_interrupt("""
seen = []
signal.signal(signal.SIGINT, lambda *_: seen.append(1))
robot = sinew.load('3pfs-g2')
print('begins', flush=True)
while not seen:
    found = robot.forward(inputs=numpy.full((2000, 3), 0.42))
    one = robot.forward([0.42] * 3)
print(found.counts, one.status, len(seen))
""")
        self.assertEqual((out, errors, code), ("{'converged': 2000} converged 1\n", "", 0))

    def test_that_is_ignored_is_ignored(self):
        out, errors, code, _ = self.run_and_interrupt("""
signal.signal(signal.SIGINT, signal.SIG_IGN)
print('begins', flush=True)
print(sinew.load('3pfs-g2').forward(inputs=numpy.full((6000, 3), 0.42)).counts)
""")
        self.assertEqual((out, errors, code), ("{'converged': 6000}\n", "", 0))

    def test_reaches_the_main_thread_while_others_compute(self):
        out, errors, code, _ = self.run_and_interrupt("""
robot = sinew.load('3pfs-g2')
found = []
thread = threading.Thread(target=lambda: found.append(robot.forward(inputs=numpy.full((6000, 3), 0.42))))
thread.start()
print('begins', flush=True)
try:
    while True:
        robot.forward(inputs=numpy.full((1000, 3), 0.42))
except KeyboardInterrupt:
    thread.join()
    print(found[0].counts)
""")
        self.assertEqual((out, errors, code), ("{'converged': 6000}\n", "", 0))


if __name__ == "__main__":
    unittest.main()
