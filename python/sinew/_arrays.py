"""Lists of numbers as arrays. NumPy is imported when the first one is wanted, and only if it is installed."""
from __future__ import annotations

import functools
from typing import Any


@functools.cache
def numpy() -> Any:
    """The module, or None."""
    try:
        import numpy as found
    except ImportError:
        return None
    return found


def to_array(values: list[Any]) -> Any:
    """An array where there is NumPy, else the list as it is."""
    np = numpy()
    return values if np is None else np.array(values)


def depth(value: Any) -> int:
    """How many levels of lists of numbers this is; 0 where lists are uneven, empty, or hold anything else."""
    if type(value) is not list or not value:
        return 0
    first = value[0]
    if type(first) is list:
        below = depth(first)
        same = below > 0 and all(type(item) is list and len(item) == len(first) and depth(item) == below for item in value)
        return below + 1 if same else 0
    return int(all(type(item) in (float, int) for item in value))
