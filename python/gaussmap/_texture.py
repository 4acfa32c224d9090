"""Texture coordinates of corners: where they tear, and how a decimated mesh gets its own."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from gaussmap import _gaussmap
from gaussmap._arrays import AnyArray, Floats, Ints

#: MeshLab's list of a face: u v of each of its three corners.
NAME = "texcoord"


def of_corners(face_attributes: dict[str, AnyArray]) -> AnyArray | None:
    """(m, 6), or None where the faces have none."""
    values = face_attributes.get(NAME)
    return values if values is not None and values.dtype != object and values.shape[1:] == (6,) else None


def seams(faces: Ints, texture: AnyArray) -> npt.NDArray[np.uint8] | None:
    """(m, 3), 1 where the side opposite to the corner has other coordinates in its next face; None where there is none."""
    found: npt.NDArray[np.uint8] | None = _gaussmap.corner_seams(faces, np.ascontiguousarray(texture, np.float64))
    return found


def interpolated(face: Ints, weights: Floats, texture: AnyArray) -> AnyArray:
    """(m, 6) from the points (3 m of them) of the original's surface that the corners came from."""
    coordinates = texture.reshape(-1, 3, 2)[face].astype(np.float64)
    out = np.zeros((len(face), 2))
    for corner in range(3):
        out += np.where(weights[:, corner : corner + 1] > 0, weights[:, corner : corner + 1] * coordinates[:, corner], 0)
    return out.reshape(-1, 6).astype(texture.dtype)
