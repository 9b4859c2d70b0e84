"""A control loop of 1 kHz: forward kinematics of a flexible tripod whose rods are fed a little each tick; bounded in
work, and stopped from outside."""
import math
import sys
import threading
import time

import sinew

robot = sinew.load("3pfs-g2")

# Once, before the loop: from home to the lengths at which it begins, where the next question goes on.
assert robot.forward([0.42, 0.42, 0.42], start="last").ok

# In the loop: from the equilibrium of the tick before. A handful of Newton steps, bounded.
failures, slowest, height = 0, 0.0, math.nan
begin = time.perf_counter()
for tick in range(1000):
    t = tick / 1000
    lengths = [0.42 + 0.01 * math.sin(2 * math.pi * t + 2 * math.pi / 3 * rod) for rod in range(3)]

    before = time.perf_counter()
    now = robot.forward(lengths, start="last", max_iterations=10)
    if now.ok:
        height = now.pose.position[2]  # else keep the last good pose, and count
    failures += not now.ok
    slowest = max(slowest, time.perf_counter() - before)

    time.sleep(max(0.0, begin + (tick + 1) / 1000 - time.perf_counter()))
print(f"1000 ticks, {failures} without a solution, z at last {1e3 * height:.1f} mm")
print(f"slowest solve {1e6 * slowest:.0f} us", file=sys.stderr)

# Another thread, or a signal handler, may end what is computed: whoever has the prepared question.
search = sinew.load("hexapod-torsion").prepare("forward", inputs="$lengths", all=True, outputs=["count"])
timer = threading.Timer(0.3, search.stop)
timer.start()
print(search([0.53] * 6).status)
timer.join()

# Prints:
#   1000 ticks, 0 without a solution, z at last 383.9 mm
#   stopped
