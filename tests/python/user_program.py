"""A program as users write them, for the type checker."""
import numpy as np

import sinew

robot: sinew.Robot = sinew.load("3pfs-g2")
answer = robot.forward([0.44, 0.42, 0.41], wrench=[0, 0, "-5 N", 0, 0, 0], want=["stiffness"])
if answer.ok:
    print(answer.pose.position, answer.stiffness, answer.units["pose.position"])
else:
    print(answer.status, answer.message.upper())
held = robot.inverse(independent={"z": 0.39, "e1": 0.1, "e2": 0.05}, start=answer.pose)
print(list(held), held["inputs"], held.robot.set({"rod.diameter": "1 mm"}).name)
forward = robot.prepare("forward", inputs="$lengths")
row = forward([0.44, 0.42, 0.41])
print(row.ok, row.position)
found = robot.forward(np.full((2, 3), 0.42), path="continue")
print(found[0].message, [one.ok for one in found])
try:
    robot.track(from_=answer.pose, to=held.pose, samples=10)
except sinew.InputError as error:
    print(error.code, error.where, error.message)
names: list[str] = sinew.robots()
code: int = sinew.Status.converged
