"""Stiffness, angles, offsets and more of an arm from 810 measured rows of a real one: data/measured/README.md."""
import pathlib
import sys

import sinew

rows = pathlib.Path(__file__).resolve().parents[2] / "data" / "measured" / "ftdcr-v4.csv"
fitted = sinew.load("ftdcr-v4").identify(rows, folds=3)
if not fitted.ok:
    sys.exit(f"{fitted.status}: {fitted.message}")
print(fitted.parameters[:6])  # of 45
print("left open:", fitted.flat[0].along)
for name in ("before", "fitted", "held_out"):
    print(f"{name:9} rms {1e3 * fitted.errors[name].rms:.2f} mm")

tip = fitted.robot.forward(changes=[[-3e-3, 0, 0]], model="cc").tip  # the fitted arm answers like any other
print("tip [mm]", (1e3 * tip.position).round(2))

# Prints:
#   parameter            unit   start       value       deviation    from rows [%]  note
#   sections[0].bending  N m^2  0.00245437  0.00252754  0.000899445  74
#   sections[1].bending  N m^2  0.00245437  0.00231148  0.000804276  75
#   sections[2].bending  N m^2  0.00245437  0.00218781  0.000808242  72
#   sections[0].angle    rad    -3.0589     -3.01449    0.0220785    94
#   sections[1].angle    rad    -2.5615     -2.55997    0.0163637    96
#   sections[2].angle    rad    -2.0506     -2.06671    0.0162748    97
#   left open: 0.6 tendons[5].toe + 0.5 tendons[4].toe - 0.5 sections[1].compliance + 0.4 tendons[3].toe
#   before    rms 28.39 mm
#   fitted    rms 3.58 mm
#   held_out  rms 4.87 mm
#   tip [mm] [-23.13  -2.47 183.91]
