"""A flexible tripod under a load: where it comes to rest, how stiff it is, and how much it bears."""
import sys

import sinew

robot = sinew.load("3pfs-g2")
lengths = [0.4347, 0.4347, 0.4347]

# Force [N] and moment [N m] of the world on the platform, about its reference point, in base axes.
loaded = robot.forward(lengths, wrench=[1, 0, -5, 0, 0, 0], want=["stability", "stiffness", "margins"])
if not loaded.ok:
    sys.exit(f"{loaded.status}: {loaded.message}")
x, _, z = 1e3 * loaded.pose.position
print(f"at rest at x {x:.3f} mm, z {z:.3f} mm, {'stable' if loaded.stable else 'unstable'}")
print(f"stiffness in x {loaded.stiffness[0, 0]:.1f} N/m, in z {loaded.stiffness[2, 2]:.1f} N/m; "
      f"largest strain {100 * loaded.margins.strain:.2f} %")

# The load at which it buckles: a downward newton, times a growing factor.
buckled = robot.forward(lengths, until={"wrench": [0, 0, -1, 0, 0, 0], "limit": 200})
print(f"{buckled.why} at {buckled.load:.1f} N")

# Prints:
#   at rest at x 0.515 mm, z 399.811 mm, stable
#   stiffness in x 2938.6 N/m, in z 25545.3 N/m; largest strain 0.39 %
#   bifurcation at 110.9 N
