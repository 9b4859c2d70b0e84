"""sinew: mechanics of continuum robots, robots whose bodies bend.

    import sinew
    robot = sinew.load("3pfs-g2")
    answer = robot.forward(inputs=[0.44, 0.42, 0.41], wrench=[0, 0, -5, 0, 0, 0])
    answer.ok, answer.pose.position

Numbers are SI and radians, or text with a unit ("10 mm"). Vectors are in base axes; a twist and a wrench have the linear
part first. docs/python.md is the manual.
"""
from ._errors import InputError
from ._sinew import version as __version__
from .answer import Answer, Record
from .columns import Columns, Status
from .identification import ByRow, Identification, Parameters
from .prepared import Prepared, Row
from .robot import Robot, Source, robots

__all__ = ["Answer", "ByRow", "Columns", "Identification", "InputError", "Parameters", "Prepared", "Record", "Robot", "Row", "Status", "load",
           "robots"]


def load(source: Source) -> Robot:
    """Opens a robot: by the name of one that comes with sinew (`robots()`), the path of a robot file, the text of one
    (YAML of more than one line, or JSON, which begins with "{"), or a dict of what a robot file has.

    Of a dict numbers are SI (lengths [m], angles [rad], forces [N]), or text with a unit ("60 mm"); docs/robot-files.md has
    all that `source` may say. Raises `InputError` with all that is wrong with it, a line each.
    """
    return Robot(source)
