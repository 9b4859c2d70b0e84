"""A serial arm with tendons: bends to tendon lengths and tip, encoders back to bends, and bends for a target."""
import sys

import numpy as np

import sinew

arm = sinew.load("nottingham-tpcj")

# Five sections, each bent by (beta_1, beta_2) a joint [rad]: what every tendon has to do, and where the tip is. The
# model is piecewise constant curvature; model="lsk" is its linearisation.
bent = arm.forward(configuration=[[0.1, 0], [0.1, 0.1], [0, 0.2], [0, 0], [-0.2, 0]])
print("section 0 pays out", ", ".join(f"{1e3 * change:.3f}" for change in bent.changes[0]), "mm")
print("tip at", ", ".join(f"{1e3 * place:.2f}" for place in bent.tip.position), "mm")

# From encoders: one tendon of section 1 has 0.4 mm too much. The bends that come nearest, and what is wrong.
measured = np.array(bent.changes)
measured[1, 0] += 0.4e-3
read = arm.forward(changes=measured)
print(f"{read.status}: tendon 0 of section 1 has {1e3 * read.slack[1][0]:.3f} mm too much")
print("section 1 bends by {:.4f}, {:.4f} rad".format(*read.configuration[1]))

# A target for the tip and its axis, within the limits of all sections.
target = np.array([0.04, 0.02, 0.15])
found = arm.inverse(position=target, direction=[0, 0, 1])
if not found.ok:
    sys.exit(f"{found.status}: {found.message}")
for section, bend in enumerate(found.configuration):
    print("section {}: {:7.4f}, {:7.4f} rad".format(section, *bend))
print(f"tip off by {1e6 * np.linalg.norm(found.tip.position - target):.3f} um")

# Prints:
#   section 0 pays out -0.899, 0.789, 0.098 mm
#   tip at 55.87, 96.40, 98.17 mm
#   slack: tendon 0 of section 1 has 0.131 mm too much
#   section 1 bends by 0.0818, 0.0798 rad
#   section 0: -0.0884, -0.0334 rad
#   section 1:  0.2775,  0.1393 rad
#   section 2:  0.0450,  0.0179 rad
#   section 3: -0.2432, -0.1324 rad
#   section 4:  0.0173, -0.0036 rad
#   tip off by 0.000 um
