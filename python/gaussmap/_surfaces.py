"""Fewer triangles, distances, and points on surfaces."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from gaussmap import _gaussmap, _texture
from gaussmap._arrays import AnyArray, Floats, Ints, one_of, rows, thread_count, whole
from gaussmap._geometry import Geometry, triangulate
from gaussmap._progress import Progress, reported
from gaussmap._results import count
from gaussmap._results import Result
from gaussmap._subject import Subject, subject_of


class SurfacePoints(NamedTuple):
    """Points of a mesh's surface: faces (−1: none), and the weights of their corners."""

    face: Ints  #: (n,)
    weights: Floats  #: (n, 3)


def _mesh(x: Any, faces: Any) -> tuple[Subject, Ints]:
    subject = subject_of(x, faces)
    if subject.faces is None:
        raise ValueError("there are no faces; a mesh is wanted")
    return subject, subject.faces


def _weighted(at: SurfacePoints, faces: Ints, values: AnyArray) -> Floats:
    """Values of vertices at points of the surface, linearly. What is undefined at one corner is left to the others."""
    sums = np.zeros((len(at.face), *values.shape[1:]))
    weights = np.zeros_like(sums)
    for corner in range(3):
        value = values[faces[at.face, corner]].astype(np.float64)
        weight = np.broadcast_to(at.weights[:, corner].reshape(-1, *[1] * (values.ndim - 1)), value.shape)
        counts = (weight > 0) & ~np.isnan(value)
        sums = np.where(counts, sums + weight * np.where(counts, value, 0), sums)
        weights = np.where(counts, weights + weight, weights)
    with np.errstate(invalid="ignore", divide="ignore"):
        out: Floats = np.where(weights > 0, sums / weights, np.nan)
    return out


def _as_type(values: Floats, dtype: np.dtype[Any]) -> AnyArray:
    """Rounded where the type is one of whole numbers, NaN being 0 there."""
    if dtype.kind in "iu":
        limits = np.iinfo(dtype)
        return np.clip(np.round(np.nan_to_num(values)), limits.min, limits.max).astype(dtype)
    return values.astype(dtype)


def _carried(at: SurfacePoints, faces: Ints, attributes: dict[str, AnyArray]) -> dict[str, AnyArray]:
    """Attributes of vertices at the points; lists cannot be interpolated and are left out."""
    flat = {name: np.asarray(values) for name, values in attributes.items()}
    return {
        name: _as_type(_weighted(at, faces, values), values.dtype)
        for name, values in flat.items()
        if values.ndim == 1 and values.dtype.kind in "fiu"
    }


def _unit(normals: Floats) -> Floats:
    with np.errstate(invalid="ignore", divide="ignore"):
        out: Floats = normals / np.sqrt(normals[:, 0] ** 2 + normals[:, 1] ** 2 + normals[:, 2] ** 2)[:, None]
    return out


@dataclass(eq=False, repr=False)
class Decimation(Geometry):
    """A decimated mesh: a Geometry, the normals and attributes of the original carried over."""

    faces_in: int = 0
    face_source: Ints = field(default_factory=lambda: np.empty(0, np.int32))  #: (m,), the input's face of each face
    vertex_source: SurfacePoints | None = None  #: the nearest point of the input's surface of each vertex
    reached: bool = True  #: the target; else no valid step was left
    error_bound: float | None = None  #: proven, over the diagonal of the box, where an error was asked for
    degenerate: int = 0  #: faces of the input left out: a corner repeated
    non_finite: int = 0  #: faces of the input left out: a corner that is not finite
    refused_locked: int = 0  #: edges that could not go: held by borders, seams, features
    refused_topology: int = 0  #: … that would have changed the topology
    refused_folding: int = 0  #: … that would have folded the surface

    def _facts(self) -> list[tuple[str, str]]:
        facts = super()._facts()
        facts.insert(2, ("of", f"{self.faces_in:,}"))
        if not self.reached:
            facts.append(("", "the target was not reached: no valid step was left"))
        if self.error_bound is not None:
            facts.append(("error at most", f"{self.error_bound:.4g} of the diagonal"))
        return facts


def decimate(
    x: Any,
    faces_of: Any = None,
    *,
    faces: int | None = None,
    ratio: float | None = None,
    error: float | None = None,
    method: str = "best",
    objective: str = "both",
    weights: bool = True,
    fast: bool = False,
    preserve_boundary: bool = False,
    lock_border: bool = False,
    feature_angle: float = 180.0,
    allow_topology: bool = False,
    seams: Any = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Decimation:
    """Fewer triangles for the same surface, its features kept. Give one of `faces`, `ratio` and `error`.

    :param x: (n, 3) positions and :param faces_of: (m, 3) indices, or a mesh.
    :param faces: stop at this many, or one or two less.
    :param ratio: the same as a part of m, in (0, 1].
    :param error: as few faces as are found whose two-sided Hausdorff distance is at most this part of the diagonal of the
        box, proven. Costs about ten decimations.
    :param method: "best" (collapses, then a fit to the original), "qem" (Garland and Heckbert 1997) or "edge" (shortest
        first), each weighed by the total curvature unless `weights` is False.
    :param objective: the distance that "best" makes small: "both", "rms" or "max".
    :param fast: "best" without the fit.
    :param feature_angle: in degrees: edges bent by more are features, along which collapses run.
    :param seams: (m, 3) of any type: not 0 where the side opposite to the corner is a seam, kept as borders are. By default
        the seams of texture coordinates (`face_attributes["texcoord"]`), which are carried over on their side.
    :raises ValueError: no target or several, an index outside [0, n), options out of their range.

    Time O(m log m); the same bits for any number of threads.

    >>> sphere = gaussmap.shapes.sphere(subdivisions=4)
    >>> len(gaussmap.decimate(sphere, faces=500).faces)
    500
    """
    if sum(target is not None for target in (faces, ratio, error)) != 1:
        raise ValueError("one of faces, ratio and error is wanted, as the target")
    one_of("method", method, ("best", "qem", "edge"))
    if isinstance(x, Geometry) and x.polygons is not None:
        x = triangulate(x)
    subject, triangles = _mesh(x, faces_of)
    if ratio is not None and not 0 < ratio <= 1:
        raise ValueError(f"ratio = {ratio} is outside (0, 1]")
    if error is not None and not 0 < error < np.inf:
        raise ValueError(f"error = {error} is not above 0")
    target = whole("faces", faces, 0) if faces is not None else int((ratio or 0) * len(triangles))
    texture = _texture.of_corners(subject.face_attributes)
    if seams is not None:
        seams = np.ascontiguousarray(np.asarray(seams) != 0, np.uint8)
    elif texture is not None:
        seams = _texture.seams(triangles, texture)
    carries = subject.normals is not None or bool(subject.attributes) or texture is not None
    with reported(progress, "decimating") as report:
        made = _gaussmap.decimate(
            subject.vertices, triangles, target, error or 0.0, method, objective, weights, fast, preserve_boundary,
            lock_border, feature_angle, allow_topology, carries, seams, thread_count(threads), report,
        )  # fmt: skip
    corner_source = made.pop("corner_source")
    source = made.pop("vertex_source")
    bound = made.pop("error_bound")
    out = Decimation(**made, faces_in=len(triangles), error_bound=None if error is None else bound)
    if source is not None:
        out.vertex_source = SurfacePoints(*source)
        out.attributes = _carried(out.vertex_source, triangles, subject.attributes)
        if subject.normals is not None:
            out.normals = _unit(_weighted(out.vertex_source, triangles, subject.normals))
    out.face_attributes = {
        name: np.asarray(values)[out.face_source] for name, values in subject.face_attributes.items()
    }
    if texture is not None and source is not None:
        corners = made["faces"].reshape(-1)
        at = SurfacePoints(*(corner_source or (values[corners] for values in source)))
        out.face_attributes[_texture.NAME] = _texture.interpolated(at.face, at.weights, texture)
    if isinstance(subject.source, Geometry):
        out.vertex_type, out.normal_type = subject.source.vertex_type, subject.source.normal_type
        out.comments = list(subject.source.comments)
    return out


class Deviation(NamedTuple):
    """Distances from one surface or cloud to another, over the diagonal."""

    max: float
    rms: float
    mean: float


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Result):
    """Distances of two surfaces or clouds, all divided by the diagonal of the box of a, as MeshLab does."""

    forward: Deviation  #: from a to b
    backward: Deviation  #: from b to a
    symmetric: Deviation  #: the larger of both ways
    diagonal: float  #: length
    samples: int
    bound: tuple[float, float] | None = None  #: the two-sided Hausdorff distance lies between these, for certain

    def _facts(self) -> list[tuple[str, str]]:
        facts = [
            (label, f"max {way.max:.4g}, RMS {way.rms:.4g}, mean {way.mean:.4g}")
            for label, way in (("a to b", self.forward), ("b to a", self.backward))
        ]
        if self.bound is not None:
            facts.append(("Hausdorff", f"{self.bound[0]:.4g} to {self.bound[1]:.4g}"))
        return [*facts, ("divided by", f"{self.diagonal:.6g}"), ("", count(self.samples, "sample"))]


def _side(x: Any, name: str) -> tuple[Floats, Ints | None]:
    """Points of a cloud that are not finite are left out."""
    subject = subject_of(x, name=name)
    if subject.faces is not None:
        return subject.vertices, subject.faces
    finite = np.isfinite(subject.vertices).all(axis=1)
    return (subject.vertices if finite.all() else np.ascontiguousarray(subject.vertices[finite])), None


def compare(
    a: Any,
    b: Any,
    *,
    samples: int = 500_000,
    seed: int = 0,
    bound: bool = False,
    tolerance: float = 1e-4,
    threads: int | None = None,
    progress: Progress = None,
) -> Comparison:
    """How far two meshes or clouds are from each other, by exact closest points, both ways.

    :param a: and :param b: a mesh, a cloud, a pair (vertices, faces), or (n, 3) points.
    :param samples: points on the faces of each mesh, and a quarter as many on its edges; all vertices besides.
    :param bound: also bound the Hausdorff distance with certainty, `tolerance` (over the diagonal) apart.
    :raises ValueError: "a: …" or "b: …": an index outside [0, n), a vertex of a face that is not finite, no points.

    Source: Cignoni, Rocchini, Scopigno, "Metro", 1998. Under a microsecond a sample on one thread.
    """
    (va, fa), (vb, fb) = _side(a, "a"), _side(b, "b")
    whole("samples", samples, 1)
    with reported(progress, "comparing") as report:
        run = (thread_count(threads), report)
        found = _gaussmap.surface_distance(va, fa, vb, fb, samples, whole("seed", seed, 0, 2**63 - 1), *run)
        diagonal = found["diagonal"]
        interval = None
        if bound:
            ways = [
                _gaussmap.hausdorff_bound(*pair, tolerance * diagonal, *run)
                for pair in ((va, fa, vb, fb), (vb, fb, va, fa))
            ]
            interval = (max(w[0] for w in ways) / diagonal, max(w[1] for w in ways) / diagonal)
    scaled = {
        way: Deviation(*(np.float64(v) / diagonal for v in found[way])) for way in ("forward", "backward", "symmetric")
    }
    return Comparison(**scaled, diagonal=diagonal, samples=found["samples"], bound=interval)


class Closest(NamedTuple):
    """The closest points of a surface or cloud to some queries."""

    distance: Floats  #: (q,), length
    points: Floats  #: (q, 3)
    element: Ints  #: (q,), the face (of a cloud, the point) that each lies on


def closest(
    x: Any, faces: Any = None, *, queries: Any, threads: int | None = None, progress: Progress = None
) -> Closest:
    """The closest point of a mesh or cloud to each of the (q, 3) queries, exactly.

    :raises ValueError: a query or a vertex of a face that is not finite (which is named), no vertices."""
    subject = subject_of(x, faces)
    with reported(progress, "finding closest points") as report:
        return Closest(
            *_gaussmap.closest(subject.vertices, subject.faces, rows("queries", queries), thread_count(threads), report)
        )


@dataclass(eq=False, repr=False)
class Samples(Geometry):
    """Points on a mesh: a Geometry without faces, with what the vertices carry."""

    face: Ints = field(default_factory=lambda: np.empty(0, np.int32))  #: (n,), the face that each lies on
    weights: Floats = field(default_factory=lambda: np.empty((0, 3)))  #: (n, 3), of its corners
    of: Ints = field(default_factory=lambda: np.empty((0, 3), np.int32))  #: the faces of the mesh

    def interpolate(self, values: Any) -> Floats:
        """Values of the mesh's vertices, (v,) or (v, c), at the points; NaN at a corner is left to the others."""
        return _weighted(SurfacePoints(self.face, self.weights), self.of, np.asarray(values))


def sample(
    x: Any,
    faces: Any = None,
    *,
    count: int = 10_000,
    method: str = "poisson",
    weights: Any = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress = None,
) -> Samples:
    """Exactly `count` points on a mesh, with its normals and attributes interpolated.

    :param method: "poisson" (no two near each other), "nonuniform" (a random half of twice as many), "random" (by area).
    :param weights: (n,), how densely points lie at each vertex, at least 0, NaN counting as 0; the method is then
        "random". `curvature(x).density` (or a root of it) makes points go where the surface bends.
    :param seed: the same seed, the same points, on every machine and for any number of threads.
    :raises ValueError: an index outside [0, n), a surface without area, a count outside [1, 2²⁷].

    Source: Yuksel, "Sample elimination for generating Poisson disk sample sets", 2015.
    """
    subject, triangles = _mesh(x, faces)
    number = whole("count", count, 1, 2**27)
    seeded = whole("seed", seed, 0, 2**63 - 1)
    with reported(progress, "sampling") as report:
        run = (thread_count(threads), report)
        if weights is None:
            found = _gaussmap.sample_surface(subject.vertices, triangles, number, method, seeded, *run)
        else:
            found = _weighted_points(subject.vertices, triangles, weights, number, seeded, run)
    out = Samples(found[0], face=found[1], weights=found[2], of=triangles)
    at = SurfacePoints(out.face, out.weights)
    if subject.normals is not None:
        out.normals = _unit(_weighted(at, triangles, subject.normals))
    nearest = triangles[out.face, np.argmax(out.weights, axis=1)]
    for name, given in subject.attributes.items():
        values = np.asarray(given)
        if values.ndim != 1 or values.dtype.kind not in "fiu":
            continue
        smooth = values.dtype.kind == "f" or name in ("red", "green", "blue", "alpha")
        out.attributes[name] = _as_type(_weighted(at, triangles, values), values.dtype) if smooth else values[nearest]
    if isinstance(subject.source, Geometry):
        out.vertex_type, out.normal_type = subject.source.vertex_type, subject.source.normal_type
    return out


def _weighted_points(
    vertices: Floats, faces: Ints, weights: Any, number: int, seed: int, run: tuple[int, Any]
) -> tuple[Floats, Ints, Floats]:
    """Random points by area, of which each stays as often as its weight: taken in turn, so that a seed is enough."""
    given = np.nan_to_num(np.asarray(weights, np.float64), nan=0.0)
    if given.shape != (len(vertices),):
        raise ValueError(f"weights has shape {given.shape}; ({len(vertices)},) is wanted")
    if given.size and given.min() < 0:
        at = int(np.argmin(given))
        raise ValueError(f"weights[{at}] = {given[at]} is below 0")
    random = np.random.default_rng(seed)
    top = float(given[faces].max(initial=0))
    if not 0 < top < np.inf:
        raise ValueError("weights are 0 on all faces, or not finite; somewhere they must be above 0")
    kept: list[tuple[npt.NDArray[Any], ...]] = []
    missing, tried = number, 0
    while missing > 0:
        batch = min(2**22, max(4096, 4 * missing))
        points, face, corner = _gaussmap.sample_surface(vertices, faces, batch, "random", (seed + tried) % 2**63, *run)
        chance = np.einsum("nc,nc->n", corner, given[faces[face]]) / top
        stays = np.flatnonzero(random.random(batch) < chance)[:missing]
        kept.append((points[stays], face[stays], corner[stays]))
        missing -= len(stays)
        tried += 1
        if tried > 10_000:
            raise ValueError("weights are so uneven that points are hardly ever found; take a root of them")
    points, face, corner = (np.concatenate(parts) for parts in zip(*kept, strict=True))
    return points, face, corner
