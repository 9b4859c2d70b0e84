"""All solutions: assembly modes of given lengths, working modes of a pose, equilibria of elastic rods, and the curve
that leads from one of them to the next."""
import sinew

# Tendon-driven legs of constant curvature: all poses, and all ways to hold one.
arcs = sinew.load("3-rfr")
modes = arcs.forward([0.193, 0.189, 0.187], all=True)
print(modes.count, "assembly modes,", "no more" if modes.complete else "perhaps more")
for mode in modes.solutions:
    print(f"  x {1e3 * mode.pose.x:8.3f} mm, y {1e3 * mode.pose.y:8.3f} mm, phi {mode.pose.phi:7.4f} rad")

working = arcs.inverse({"x": 0.01, "y": 0, "phi": 0}, all=True).solutions
print(len(working), "working modes of one pose")
print("  the last: tendons", ", ".join(f"{1e3 * length:.3f}" for length in working[-1].inputs), "mm")

# Elastic rods: equilibria found from many starts, a lower bound of their number.
rods = sinew.load("3pfs-g2")
print("stable equilibria of the same lengths")
for found in rods.forward([0.44, 0.42, 0.41], all=True).solutions:
    if found.stable:
        print(f"  z {1e3 * found.pose.position[2]:.2f} mm, energy {found.potential:.3f} J")

# The first of them pressed down, by up to 200 N: beyond the fold there is no equilibrium nearby, and the curve leads
# back to an unstable one.
print("pressed down")
pressed = rods.track(inputs=[0.44, 0.42, 0.41], to={"wrench": [0, 0, -200, 0, 0, 0]})
for row in pressed.curves[0].rows:
    if "event" in row:
        print(f"  {row.event} at {200 * row.parameter:.1f} N, z {1e3 * row.pose.position[2]:.2f} mm")

# Prints:
#   2 assembly modes, no more
#     x   12.079 mm, y  -17.443 mm, phi  0.1385 rad
#     x    2.544 mm, y  -21.064 mm, phi  1.9559 rad
#   8 working modes of one pose
#     the last: tendons 190.878, 191.704, 188.835 mm
#   stable equilibria of the same lengths
#     z 387.36 mm, energy 1.023 J
#     z 333.10 mm, energy 2.900 J
#     z 327.57 mm, energy 3.002 J
#     z 317.76 mm, energy 3.149 J
#   pressed down
#     begin at 0.0 N, z 387.36 mm
#     fold at 106.2 N, z 373.80 mm
#     begin at 0.0 N, z 322.31 mm
