"""A robot of your own: a text with units, mistakes in it told by line, then changed and asked; and what an answer says
where there is none."""
import sinew

# Three tendon-driven links between free revolute joints, evenly around two circles: docs/robot-files.md
MINE = """sinew: 1
name: mine
architecture: 3-RFR
base: {radius: 190 mm, angle: 90 deg}
platform: {radius: 50 mm, angle: 30 deg}
defaults:
  link: {length: 200 mm, tendon_offset: 5 mm}
"""

# Every mistake at once, each with its place, what was found, the rule and the way out.
try:
    sinew.load(MINE.replace("length: 200 mm", "length: 0.2 kg").replace("5 mm}", "5 mm, colour: red}"))
except sinew.InputError as error:
    print(error)

# A variant with one length changed. Robots never change: set gives another one.
robot = sinew.load(MINE).set({"defaults.link.length": "180 mm"})
tendons = robot.inverse({"x": 0.005, "y": -0.005, "phi": 0.087}).inputs
print("tendons", ", ".join(f"{1e3 * length:.3f}" for length in tendons), "mm")

# A pose out of reach is an answer, with the reason; a question that does not fit the robot is an error.
print(robot.inverse({"x": 0.3, "y": 0, "phi": 0}).message)
try:
    robot.forward([0.19, 0.19])
except sinew.InputError as error:
    print(error.code, "at", error.where)

# A bound on the work: the best iterate comes back with its residual, and says that it is no solution.
print(robot.forward([0.175, 0.173, 0.171], max_iterations=1).status)

# Prints:
#   robot:7:18: defaults.link.length = "0.2 kg" is a mass; give a length ("0.2 m", "200 mm", or 0.2 for metres).
#   robot:7:47: unknown key "colour" in defaults.link. Known here: type, length, tendon_offset, diameter, joints, material.
#   tendons 174.991, 173.264, 171.762 mm
#   legs[0] needs a chord of 380.895 mm, its backbone is 180 mm long
#   wrong_length at inputs
#   iteration_limit
