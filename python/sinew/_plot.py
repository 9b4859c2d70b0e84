"""Pictures by matplotlib."""
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from ._drawing import polylines, pulls, shape_of

if TYPE_CHECKING:
    from .robot import Robot

STYLES = {
    "base": {"color": "0.6", "linewidth": 1.0, "linestyle": "--"},
    "platform": {"color": "#1f5fa8", "linewidth": 2.0},
    "tendon": {"color": "#c8642c", "linewidth": 0.8},
    "backbone": {"color": "#222222", "linewidth": 2.2},
    "strut": {"color": "#7a7a7a", "linewidth": 2.2},
    "slack": {"color": "#7c7b78", "linewidth": 0.8, "linestyle": "--"},
    "pull 1": {"color": "#7c7b78", "linewidth": 1.0},
    "pull 2": {"color": "#4f6f9f", "linewidth": 1.3},
    "pull 3": {"color": "#1f55a5", "linewidth": 1.6},
    "pull 4": {"color": "#00224e", "linewidth": 2.0},
}


def plot(robot: Robot, answer: Any, ax: Any) -> Any:
    try:
        plt: Any = importlib.import_module("matplotlib.pyplot")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("plot needs matplotlib, which is not installed; save_html needs nothing", name=error.name) from None
    shape = shape_of(robot, answer)
    lines = polylines(shape)
    is_planar = all(len(point) == 2 for _, line in lines for point in line)
    if ax is None:
        ax = plt.figure().add_subplot(projection=None if is_planar else "3d")
    elif not is_planar and not hasattr(ax, "set_zlim"):
        raise ValueError('this robot is in space: give axes made with projection="3d"')
    for kind, line in lines:
        ax.plot(*([1000.0 * point[axis] for point in line] for axis in range(2 if is_planar else 3)), **STYLES[kind])
    words = pulls(shape)
    if words:
        handles = [ax.plot([], [], *([[]] if not is_planar else []), **STYLES[kind])[0] for kind, _ in words]
        ax.legend(handles, [word for _, word in words], title="tension", loc="upper left", fontsize="small")
    ax.set_xlabel("x [mm]")
    ax.set_ylabel("y [mm]")
    ax.set_title(robot.name)
    if is_planar:
        is_shared = any(len(axes.get_siblings(ax)) > 1 for axes in (ax.get_shared_x_axes(), ax.get_shared_y_axes()))
        ax.set_aspect("equal", adjustable="box" if is_shared else "datalim")
    else:
        ax.set_zlabel("z [mm]")
        _equal_axes(ax, [point for _, line in lines for point in line])
    return ax


def _equal_axes(ax: Any, points: list[list[float]]) -> None:
    """A cube around all points: a millimetre is as long along each axis."""
    lowest = [1000.0 * min(point[axis] for point in points) for axis in range(3)]
    highest = [1000.0 * max(point[axis] for point in points) for axis in range(3)]
    half = max(high - low for low, high in zip(lowest, highest)) / 2 or 1.0
    for name, low, high in zip("xyz", lowest, highest):
        getattr(ax, f"set_{name}lim")((low + high) / 2 - half, (low + high) / 2 + half)
    ax.set_box_aspect((1, 1, 1), zoom=0.85)  # else labels are cut off at the edge of the figure
    ax.locator_params(nbins=4)
