"""A million poses: equilibria of a flexible tripod in the lanes of vector registers and on all cores, and velocity
analyses of arcs."""
import numpy as np

import sinew

MILLION = 1_000_000

# Lengths that go to and fro, under a weight of 5 N. Neighbouring rows are near each other, so each begins where the one
# before ended. The rows are cut into pieces by their number alone: the results do not depend on the threads.
part = np.abs(np.arange(MILLION) % 20000 / 10000 - 1)
lengths = np.stack([0.42 + 0.02 * part, np.full(MILLION, 0.42), 0.42 - 0.02 * part], axis=1)
found = sinew.load("3pfs-g2").forward(inputs=lengths, wrench=[0, 0, -5, 0, 0, 0], path="continue", outputs=["pose.position"])
print(f"{found.ok.sum()} of {MILLION} equilibria, the first at z = {1e3 * found.position[0, 2]:.3f} mm, {found.method}")

# Poses of a 3-RFR on its spot, turned from 0 to 1.2 rad. Only what `outputs` names is computed.
phi = np.linspace(0, 1.2, MILLION, endpoint=False)
turned = sinew.load("3-rfr").velocity(pose={"x": 0, "y": 0, "phi": phi}, outputs=["indices.condition_homogenised"])
condition = turned.condition_homogenised
print(f"condition number at home {condition[0]:.3f}, largest at phi = {phi[np.nanargmax(condition)]:.3f} rad")

# Prints:
#   1000000 of 1000000 equilibria, the first at z = 383.322 mm, rods in lanes
#   condition number at home 1.364, largest at phi = 1.047 rad
