"""Nearest neighbours, and the fans of triangles around points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from gaussmap import _gaussmap
from gaussmap._arrays import Floats, Ints, indices, rows, thread_count, whole
from gaussmap._progress import Progress, reported
from gaussmap._results import Result, count
from gaussmap._subject import subject_of


@dataclass(frozen=True, eq=False, repr=False)
class Neighbors(Result):
    """Rows of neighbours, nearest first, equal distances by smaller index."""

    index: Ints  #: (n, k), −1 where there are fewer
    distance: Floats  #: (n, k), infinite where the index is −1

    def _facts(self) -> list[tuple[str, str]]:
        rows_, k = self.index.shape
        return [("", f"{count(rows_, 'row')} of {k}"), ("missing", f"{int((self.index < 0).sum()):,}")]


def knn(
    points: Any, k: int = 20, *, queries: Any = None, threads: int | None = None, progress: Progress = None
) -> Neighbors:
    """The k nearest others of every point; of `queries`, the k nearest points.

    :param points: (n, 3) or anything that `curvature` takes; finite.
    :param queries: (q, 3), finite. A query that is itself a point finds that point; a point is not its own neighbour.
    :returns: exact, ties by smaller index, the same for any number of threads.
    :raises ValueError: k < 1, a non-finite point or query (its index is named).

    Time O(n k log k) for points on surfaces.

    >>> gaussmap.knn([[0, 0, 0], [1, 0, 0], [3, 0, 0]], 2).index.tolist()
    [[1, 2], [0, 2], [1, 0]]
    """
    cloud = subject_of(points, name="points").vertices
    count_ = whole("k", k, 1)
    with reported(progress, "finding neighbours") as report:
        run = (thread_count(threads), report)
        if queries is not None:
            index, squared = _gaussmap.nearest_points(cloud, rows("queries", queries), count_, *run)
            return Neighbors(index.reshape(-1, count_), np.sqrt(squared).reshape(-1, count_))
        index = _gaussmap.nearest_neighbors(cloud, count_, *run).reshape(-1, count_)
    if not len(cloud):
        return Neighbors(index, np.empty((0, count_)))
    away = cloud[index] - cloud[:, None, :]
    distance = np.where(index < 0, np.inf, np.sqrt(np.einsum("nkd,nkd->nk", away, away)))
    return Neighbors(index, distance)


@dataclass(frozen=True, eq=False, repr=False)
class Fans(Result):
    """The triangles (i, index[j], index[j + 1]) around each point i, j from begin[i] to begin[i + 1] − 2, and the one that
    closes the fan where `closed`."""

    begin: npt.NDArray[np.uint64]  #: (n + 1,)
    index: Ints
    closed: npt.NDArray[np.bool_]  #: (n,), False: a boundary point

    def triangles(self, i: int) -> Ints:
        """(t, 3): the fan of point i."""
        chain = self.index[int(self.begin[i]) : int(self.begin[i + 1])]
        after = np.roll(chain, -1) if self.closed[i] else chain[1:]
        chain = chain[: len(after)]
        return np.column_stack([np.full(len(chain), i, np.int32), chain, after])

    def _facts(self) -> list[tuple[str, str]]:
        return [("", count(len(self.closed), "fan")), ("open", f"{int((~self.closed).sum()):,}")]


def fans(
    points: Any,
    *,
    normals: Any = None,
    neighbors: Any = None,
    k: int = 20,
    threads: int | None = None,
    progress: Progress = None,
) -> Fans:
    """The Delaunay triangles incident on each point among its neighbours projected along its normal.

    :param points: (n, 3), finite, or anything that `curvature` takes.
    :param normals: (n, 3) of any positive length; None: those of `points`, which must have some. NaN or zero gives an
        empty fan.
    :param neighbors: (n, k) as `knn` gives them, −1 at the ends of rows; None: finds the k nearest.
    :raises ValueError: arrays of different lengths, a neighbour that is no point (its row is named).

    Source: inversion and one convex hull a point, eq. (7) of docs/method.md. Time O(n k log k).
    """
    subject = subject_of(points, name="points")
    given = subject.normals if normals is None else rows("normals", normals)
    if given is None:
        raise ValueError("normals are missing; gaussmap.normals(points) makes some")
    if neighbors is None:
        table = knn(subject.vertices, k, threads=threads).index
    else:
        table = indices("neighbors", getattr(neighbors, "index", neighbors), len(subject.vertices))
        if table.ndim != 2:
            raise ValueError(f"neighbors has shape {table.shape}; (n, k) is wanted")
    with reported(progress, "making fans") as report:
        begin, index, closed = _gaussmap.fans(subject.vertices, given, table, thread_count(threads), report)
    return Fans(begin, index, closed.astype(bool))
