"""The compiled kernel (core/binding.c). Absent where it could not be compiled at install."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.classify import classify as classify
from hypcheck.kernel.classify import classify_scene as classify_scene
from hypcheck.kernel.scalar import PositionFunction

def ask(question: int, rows: NDArray[np.generic], answers: NDArray[np.generic], /) -> int: ...
def ask_scene(
    question: int,
    sizes: tuple[float, float, float, float],
    x: NDArray[np.generic],
    y: NDArray[np.generic],
    z: NDArray[np.generic],
    answers: NDArray[np.generic],
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
    /,
) -> int: ...
def keep_scene(
    question: int,
    sizes: tuple[float, float, float, float],
    x: NDArray[np.generic],
    y: NDArray[np.generic],
    z: NDArray[np.generic],
    kept: NDArray[np.generic],
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
    /,
) -> int: ...
def spread(kept: NDArray[np.generic], answers: NDArray[np.generic], /) -> None: ...
def prepare(
    sizes: tuple[float, float, float, float],
    axis: tuple[float, float, float],
    x: NDArray[np.generic],
    y: NDArray[np.generic],
    z: NDArray[np.generic],
    /,
) -> bytes: ...
def use_arrays(array: type, empty: Callable[..., object], int8: np.dtype[np.int8], rows: int, /) -> None: ...
def set_slow_calls(
    classify: Callable[..., object], classify_scene: Callable[..., object], prepared: type, /
) -> None: ...
def take(sizes: object, x: object, y: object, z: object, out: object, /) -> None: ...
def nothing(*arguments: object, **keywords: object) -> None: ...
def passage(
    rows: NDArray[np.generic], hits: NDArray[np.generic], times: NDArray[np.generic] | None = None, /
) -> None: ...
def clearance(rows: NDArray[np.generic], positions: NDArray[np.generic], found: NDArray[np.generic], /) -> int: ...

position: PositionFunction

def set_slow_position(function: Callable[..., int], /) -> None: ...
def level() -> str: ...
def use_level(name: str, /) -> bool: ...
