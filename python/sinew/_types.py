"""Types of what questions take."""
import os
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, Union


class Array(Protocol):
    """What has the buffer protocol: arrays of NumPy, array.array, memoryview."""

    def __len__(self) -> int: ...


Number = Union[float, str, Array]
"""SI and radians; or text with a unit, such as "10 mm"; or a column of n numbers."""
Numbers = Union[Sequence[Union[float, str]], Array]
Lists = Union[Sequence[Union[Sequence[Any], Array]], Array]
Pose = Mapping[str, Any]
Rows = Union[Mapping[str, Any], str, "os.PathLike[str]", Any]
"""Measured rows: columns `pulls` (n, tendons) [m], `markers` (n, 3) [m], `time` (n,) [s], `blocks` (n,); or the path or text of a .csv table."""
