"""A motion for a serial arm's controller: counts of its motors each millisecond, as whole numbers in a file, checked
against its limits and against the lengths in doubles.

Constants for a controller that computes on its own are exported by the command:
    sinew export nottingham-tpcj --to c-header --set 'motor={"lead": "2 mm", "counts": 4096}' -o robot_table.h
"""
import csv

import numpy as np

import sinew

LEAD, COUNTS = 2e-3, 4096  # a screw of 2 mm [m], counts a turn
arm = sinew.load("nottingham-tpcj").set({"motor": {"lead": LEAD, "counts": COUNTS}})

# A second of a motion, a tick each millisecond: a row a tick, two bends a section.
k, m = np.ogrid[:1000, :5]
bends = np.stack([0.3 * np.sin(0.00628 * k + m), 0.3 * np.cos(0.00628 * k - m)], axis=2)
driven = arm.forward(configuration=bends, outputs=["motors", "changes"])
if not driven.ok.all():
    raise SystemExit(driven.message)

counts = np.rint(driven.motors).astype(np.int32).reshape(1000, -1)
with open("motion.csv", "w", newline="", encoding="ascii") as file:
    table = csv.writer(file)
    table.writerow(f"section{section}_tendon{tendon}" for section in range(5) for tendon in range(3))
    table.writerows(counts.tolist())
off = np.abs(counts * LEAD / COUNTS - driven.changes.reshape(1000, -1)).max()
print(f"1000 ticks of {counts.shape[1]} motors, lengths at most {1e6 * off:.2f} um from those in doubles")
print(f"largest step of a tick {np.abs(np.diff(counts, axis=0)).max()} counts")

# Beyond its limit of 24 degrees the answer says so, and the motion would not be written.
beyond = arm.forward(configuration=[[0, 0], [0, 0], [0.5, 0]])
print(f"0.5 rad in section 2: {beyond.status}")

# Prints:
#   1000 ticks of 15 motors, lengths at most 0.24 um from those in doubles
#   largest step of a tick 98 counts
#   0.5 rad in section 2: left_domain
