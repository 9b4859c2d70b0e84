"""Types of what questions take."""
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
