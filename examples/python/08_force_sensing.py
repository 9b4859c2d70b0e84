"""The load on a hexapod's platform from the axial forces of its six rods, as load cells measure them."""
import sys

import numpy as np

import sinew

robot = sinew.load("hexapod")
sensed = robot.statics(inputs=[0.410, 0.410, 0.405, 0.405, 0.405, 0.405],
                       axial_forces=[0.1, -0.2, 0.1, 0, 0.1, 0],  # [N], pull > 0
                       deviation=0.01)
if not sensed.ok:
    sys.exit(f"{sensed.status}: {sensed.message}")
deviations = np.sqrt(np.diag(sensed.covariance))
for name, value, deviation in zip(["fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]"], sensed.wrench, deviations):
    print(f"{name:8} {value:9.5f} +- {deviation:.5f}")

# Prints:
#   fx [N]    -0.28583 +- 0.00336
#   fy [N]    -0.03158 +- 0.00320
#   fz [N]     0.10000 +- 0.02449
#   mx [N m]  -0.01445 +- 0.00155
#   my [N m]   0.05585 +- 0.00156
#   mz [N m]  -0.00804 +- 0.00037
