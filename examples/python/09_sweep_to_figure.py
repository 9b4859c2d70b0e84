"""A sweep over the workspace of a robot on all cores, as arrays, and its figure."""
import importlib.util

import numpy as np

import sinew

robot = sinew.load("3-rfr")

# One question at a grid of poses: every place of the plane at seven turns.
side = np.linspace(-0.1, 0.1, 41)
turns = np.radians(np.linspace(-15, 15, 7))
y, x, phi = np.meshgrid(side, side, turns, indexing="ij")
swept = robot.velocity(pose={"x": x.ravel(), "y": y.ravel(), "phi": phi.ravel()}, outputs=["indices.condition_homogenised"])
print(f"{len(swept)} samples, {swept.method}")

# Worst condition number over the turns, where all of them can be reached. What a row does not have is NaN.
condition = swept.condition_homogenised.reshape(x.shape)
worst = condition.max(axis=2)
row, column = np.unravel_index(np.nanargmin(worst), worst.shape)
print(f"{np.isfinite(worst).sum()} of {worst.size} places allow all turns")
print(f"best at x {1e3 * side[column] + 0:.0f} mm, y {1e3 * side[row] + 0:.0f} mm: condition number {worst[row, column]:.3f} at worst")

if importlib.util.find_spec("matplotlib"):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    axes = robot.plot()
    drawn = axes.pcolormesh(1e3 * side, 1e3 * side, worst, cmap="cividis", shading="nearest", zorder=0)
    axes.figure.colorbar(drawn, label="worst condition number")
    plt.savefig("workspace.svg")

# Prints:
#   11767 samples, poses in lanes
#   52 of 1681 places allow all turns
#   best at x 0 mm, y 0 mm: condition number 1.414 at worst
