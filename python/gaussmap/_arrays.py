"""Arrays and options as the compiled part takes them; what cannot be taken is a ValueError that names it."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
AnyArray = npt.NDArray[Any]


def numbers(name: str, value: Any) -> AnyArray:
    """An array of real numbers, or a ValueError."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" and array.size:
        raise ValueError(f"{name} has values of type {array.dtype}, not real numbers")
    return array


def rows(name: str, value: Any) -> Floats:
    """(n, 3) float64, C-contiguous; the same memory where it is so already."""
    array = numbers(name, value)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has shape {array.shape}; (n, 3) is wanted")
    return np.ascontiguousarray(array, np.float64)


def row_values(name: str, value: Any, count: int) -> Floats:
    """(count,) float64."""
    array = numbers(name, value)
    if array.shape != (count,):
        raise ValueError(f"{name} has shape {array.shape}; ({count},) is wanted")
    return np.ascontiguousarray(array, np.float64)


def triangles(name: str, value: Any, vertices: int) -> Ints:
    """(m, 3) int32, C-contiguous; the same memory where it is so already."""
    array = np.asarray(value)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has shape {array.shape}; (m, 3) is wanted: triangles")
    return indices(name, array, vertices)


def indices(name: str, value: Any, vertices: int) -> Ints:
    """Indices as int32, C-contiguous. Those beyond int32 are told here, others outside [0, vertices) by the library."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu" and array.size:
        raise ValueError(f"{name} has values of type {array.dtype}, not integers")
    if array.dtype.kind == "u" or array.dtype.itemsize > 4:
        limit = np.iinfo(np.int32)
        beyond = (array > limit.max) | (array < limit.min)
        if beyond.any():
            at = np.unravel_index(int(np.argmax(beyond)), array.shape)
            place = "".join(f"[{int(i)}]" for i in at)
            raise ValueError(f"{name}{place} = {int(array[at])} is outside [0, {vertices})")
    return np.ascontiguousarray(array, np.int32)


def whole(name: str, value: Any, least: int, most: int = 2**31 - 1) -> int:
    """A whole number in [least, most], or a ValueError."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ValueError(f"{name} = {value!r} is not a whole number") from None
    if not least <= number <= most:
        raise ValueError(f"{name} = {number} is outside [{least}, {most}]")
    return number


def thread_count(threads: int | None) -> int:
    """0 for None: what the machine offers."""
    return 0 if threads is None else whole("threads", threads, 1, 4096)


def one_of(name: str, value: str, words: tuple[str, ...]) -> str:
    if value not in words:
        raise ValueError(f"{name} = {value!r} is not one of {', '.join(words)}")
    return value
