"""Total curvature and normals of meshes and clouds."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from gaussmap import _gaussmap
from gaussmap._arrays import AnyArray, Floats, one_of, row_values, rows, thread_count, whole
from gaussmap._geometry import Geometry, triangulate
from gaussmap._progress import Progress, reported
from gaussmap._results import Result, count, span
from gaussmap._subject import Subject, subject_of

_of_meshes = ("max", "angle", "area")
_of_clouds = ("jet", "pca", "wpca")


@dataclass(frozen=True, eq=False, repr=False)
class PrincipalCurvatures(Result):
    """k1 ≥ k2, 1/length: 1/r on a sphere with outward normals. The signs follow the normals."""

    k1: Floats  #: (n,)
    k2: Floats  #: (n,)
    direction: Floats  #: (n, 3), unit, of k1

    @property
    def mean(self) -> Floats:
        """H = (k1 + k2) / 2, 1/length."""
        return 0.5 * (self.k1 + self.k2)

    @property
    def gaussian(self) -> Floats:
        """K = k1 k2, 1/length²."""
        return self.k1 * self.k2

    @property
    def shape_index(self) -> Floats:
        """2/π · atan((k1 + k2) / (k1 − k2)): 1 a cap, ½ a ridge, 0 a saddle, −½ a rut, −1 a cup; NaN where flat.

        Koenderink and van Doorn, "Surface shape and curvature scales", 1992."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return 2 / np.pi * np.arctan((self.k1 + self.k2) / (self.k1 - self.k2))

    @property
    def curvedness(self) -> Floats:
        """√((k1² + k2²) / 2), 1/length."""
        return np.sqrt(0.5 * (self.k1 * self.k1 + self.k2 * self.k2))

    def _facts(self) -> list[tuple[str, str]]:
        return [("", count(len(self.k1), "element")), ("k1", span(self.k1)), ("k2", span(self.k2))]


@dataclass(frozen=True, eq=False, repr=False)
class Curvature(Result):
    """Total curvature of a mesh or cloud. As an array it is its densities."""

    kind: str  #: "mesh" or "cloud"
    estimator: str
    density: Floats  #: (n,), k1² + k2² of a vertex or point, 1/length²; NaN where undefined
    normals: Floats  #: (n, 3), the unit normals used or fitted; NaN where undefined
    undefined: int  #: vertices or points whose density is NaN
    kappa: Floats | None = None  #: its integral, no unit: (m,) a face; (n,) over the fan of a point, None without fans
    face_density: Floats | None = None  #: (m,), kappa / area, 1/length²; NaN where undefined or of no area
    kappa_sum: float | None = None  #: of a mesh, the integral over the surface
    tensor: PrincipalCurvatures | None = None  #: a vertex or point, where asked for
    face_tensor: PrincipalCurvatures | None = None  #: a face, where asked for
    error: Floats | None = None  #: (n,), the standard error of the density, where asked for (`confidence`)
    choice: npt.NDArray[np.uint8] | None = None  #: (n,), what the estimator "auto" took; see `chosen`
    lowered: int = 0  #: fits that took a lower degree for want of neighbours
    undefined_faces: int = 0
    degenerate_faces: int = 0  #: of no area: kappa 0
    duplicates: int = 0  #: points of a cloud at the position of an earlier one
    non_finite: int = 0  #: points of a cloud with a NaN or infinite coordinate
    boundary: int = 0  #: points of a cloud whose fan is open

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> AnyArray:
        return np.array(self.density, dtype, copy=True if copy else None) if copy else np.asarray(self.density, dtype)

    @property
    def chosen(self) -> dict[str, int]:
        """What the estimator "auto" took, and how often."""
        if self.choice is None:
            return {}
        return {_gaussmap.choice_name(int(c)): n for c, n in sorted(Counter(self.choice.tolist()).items())}

    def _title(self) -> str:
        return f"Curvature of a {self.kind}"

    def _facts(self) -> list[tuple[str, str]]:
        mesh = self.kind == "mesh"
        facts = [("", count(len(self.density), "vertex" if mesh else "point", "vertices" if mesh else "points"))]
        if mesh and self.kappa is not None:
            facts.append(("", count(len(self.kappa), "face")))
        facts += [("density", span(self.density)), ("undefined", f"{self.undefined:,}"), ("estimator", self.estimator)]
        if self.kappa_sum is not None:
            facts.append(("kappa", f"{self.kappa_sum:.6g} in all"))
        for label in ("undefined_faces", "degenerate_faces", "duplicates", "non_finite", "lowered"):
            if getattr(self, label):
                facts.append((label.replace("_", " "), f"{getattr(self, label):,}"))
        return facts

    def values(self) -> tuple[dict[str, AnyArray], dict[str, AnyArray]]:
        """What `gaussmap curvature` writes on vertices and on faces besides the density and kappa, by name."""
        vertex: dict[str, AnyArray] = {}
        face: dict[str, AnyArray] = {}
        if self.error is not None:
            vertex["density_error"] = self.error
        for tensor, values in ((self.tensor, vertex), (self.face_tensor, face)):
            if tensor is None:
                continue
            values.update(k1=tensor.k1, k2=tensor.k2)
            if values is vertex:
                values.update(mean=tensor.mean, gaussian=tensor.gaussian)
                values.update(shape_index=tensor.shape_index, curvedness=tensor.curvedness)
            values.update({f"d1{axis}": tensor.direction[:, i] for i, axis in enumerate("xyz")})
        return vertex, face


def colors(
    values: Any, *, low: float | None = None, high: float | None = None, diverging: bool = False
) -> npt.NDArray[np.uint8]:
    """Colours of values, (n, 3) sRGB bytes: dark violet at `low` (0), bright yellow from `high` (98th percentile) on.

    :param values: (n,); what is not finite is grey.
    :param diverging: values have a sign: blue below 0, light at 0, red above, both ends `high` away (98th percentile of
        the magnitudes).
    :raises ValueError: an empty range.

    >>> gaussmap.colors([0.0, 0.5, 1.0, float("nan")], high=1.0).tolist()[3]
    [128, 128, 128]
    """
    array = row_values("values", values, len(values))
    finite = array[np.isfinite(array)]
    if diverging:
        finite, low = np.abs(finite), 0.0
    bottom = 0.0 if low is None else low
    top = high
    if top is None:
        # The command's percentile: of n sorted values number ⌊0.98 (n − 1)⌋ and its share of the next.
        top = float(np.quantile(finite, 0.98)) if finite.size else 0.0
    elif not top > bottom:
        raise ValueError(f"high = {top} is not above low = {bottom}")
    span_ = top - bottom
    scaled = (array - bottom) / span_ if span_ > 0 else np.where(np.isnan(array), np.nan, 0.0)
    rgb: npt.NDArray[np.uint8] = _gaussmap.colors(np.ascontiguousarray(scaled), diverging)
    return rgb


def _is_usable(normals: Floats | None) -> bool:
    """Has it a normal that is finite and not zero?"""
    return normals is not None and bool((np.isfinite(normals).all(axis=1) & (normals != 0).any(axis=1)).any())


def _given_normals(subject: Subject, normals: Any) -> tuple[Floats | None, str]:
    """The normals to use, or None, and the word that says how to make them."""
    if normals is None or isinstance(normals, str):
        word = one_of("normals", normals or "auto", ("auto", "file", "estimate", *_of_meshes, *_of_clouds))
        if word == "file" and not _is_usable(subject.normals):
            raise ValueError("normals = 'file', but there are none, or all are zero or not finite")
        usable = word in ("auto", "file") and _is_usable(subject.normals)
        return (subject.normals if usable else None), word
    given = rows("normals", normals)
    if len(given) != len(subject.vertices):
        raise ValueError(f"normals has {len(given)} rows, but there are {len(subject.vertices)} vertices")
    return given, "file"


def curvature(
    x: Any,
    faces: Any = None,
    *,
    normals: Any = None,
    k: int | None = None,
    estimator: str | None = None,
    degree: int | None = None,
    orient: str | None = None,
    kind: str = "auto",
    tensor: bool = False,
    confidence: bool = False,
    attach: bool = False,
    threads: int | None = None,
    progress: Progress = None,
) -> Curvature:
    """Total curvature k1² + k2² of every vertex and face of a mesh, or every point of a cloud.

    :param x: (n, 3) positions in any unit, or a mesh or cloud (see the page of the package). Non-finite ones make what
        uses them undefined.
    :param faces: (m, 3) indices of any connectivity; None: a cloud.
    :param normals: (n, 3) of any positive length; or a word: "auto" (None) takes those of x if it has any, "file" wants
        them, "estimate", for meshes "max", "angle", "area" (weights of faces), for clouds "jet", "pca", "wpca".
    :param k: neighbours a point, 3 to 1000 (20), and for the estimators "jet" and "regression" a vertex.
    :param estimator: "dirichlet" (the paper; default of meshes), "auto" (chooses from the data; default of clouds unless
        k, degree, orient or normals of some kind are asked for), "corrected" (meshes), "regression", "jet".
    :param degree: of fitted jets, 1 to 4 (4; 2 under normals="jet").
    :param orient: how estimated normals of clouds are made to agree: "local" (default), "mst", "none".
    :param kind: "mesh" or "cloud" ("auto": a mesh where there are faces).
    :param tensor: make `tensor`: principal curvatures and directions.
    :param confidence: make `error`; for the estimators "auto", "regression" and "jet".
    :param attach: write the result back to x as its own attributes `total_curvature` of vertices and `kappa` of faces;
        to a Geometry those that `gaussmap curvature` writes.
    :param threads: None: all. The same bits for any number.
    :param progress: True: a bar on standard error. A function: called with the fraction done; False cancels.
    :returns: density in 1/length² (2/r² on a sphere of radius r), kappa without unit, NaN where undefined.
    :raises ValueError: an array of the wrong shape or type, an index outside [0, n) (array, index and value are named),
        options that do not exist or do not go together.
    :raises gaussmap.Cancelled: `progress` returned False.

    Source: Crane He Chen, "Estimating Discrete Total Curvature with Per Triangle Normal Variation", SIGGRAPH 2023 Talks;
    docs/method.md. Time O(n + m) for meshes, O(n k log k) for clouds.

    >>> torus = gaussmap.shapes.torus(major=1.0, minor=0.5, around=36, across=36)
    >>> gaussmap.curvature(torus.vertices, torus.faces, normals=torus.normals)  # doctest: +ELLIPSIS
    <Curvature of a mesh: 1,296 vertices; 2,592 faces; density ... undefined 0; estimator dirichlet; kappa ... in all>
    """
    one_of("kind", kind, ("auto", "mesh", "cloud"))
    subject = subject_of(x, faces)
    if kind == "mesh" and subject.faces is None:
        raise ValueError("kind = 'mesh', but there are no faces")
    mesh = subject.faces is not None and kind != "cloud"
    given, word = _given_normals(subject, normals)
    _refuse(mesh, word, estimator, confidence)
    plain = word in ("auto", "estimate", "file")
    asked = (
        k is not None
        or degree is not None
        or orient is not None
        or not (word in ("auto", "estimate") or not isinstance(normals, str))
    )
    taken = estimator or ("dirichlet" if mesh or asked or not plain else "auto")
    neighbors = 20 if k is None else whole("k", k, 3, 1000)
    order = (
        whole("degree", degree, 1, 4)
        if degree is not None
        else 2
        if not mesh and word == "jet" and taken != "jet"
        else 4
    )
    with reported(progress, "measuring curvature") as report:
        run = (thread_count(threads), report)
        if mesh:
            found = _mesh(subject, given, word, taken, neighbors, order, tensor, confidence, run)
        else:
            method = word if word in _of_clouds else "jet"
            found = _gaussmap.cloud_curvature(
                subject.vertices, given, taken, neighbors, method, order, orient or "local", tensor, confidence, *run
            )
    result = _result_of(found, "mesh" if mesh else "cloud", taken)
    if attach:
        _attach(subject, result)
    return result


def _refuse(mesh: bool, word: str, estimator: str | None, confidence: bool) -> None:
    """Options that the other kind alone understands, or that the estimator lacks."""
    if mesh and word in _of_clouds:
        raise ValueError(f"normals = {word!r} is for clouds, and this is a mesh")
    if not mesh and word in _of_meshes:
        raise ValueError(f"normals = {word!r} is for meshes, and this is a cloud")
    if estimator is not None:
        one_of("estimator", estimator, ("auto", "dirichlet", "corrected", "regression", "jet"))
    if not mesh and estimator == "corrected":
        raise ValueError("estimator = 'corrected' is for meshes, and this is a cloud")


def _mesh(
    subject: Subject,
    given: Floats | None,
    word: str,
    estimator: str,
    k: int,
    degree: int,
    tensor: bool,
    confidence: bool,
    run: Any,
) -> dict[str, Any]:
    weights = word if word in _of_meshes else "max"
    assert subject.faces is not None
    if word in _of_meshes and estimator == "regression":
        given = _gaussmap.mesh_normals(subject.vertices, subject.faces, weights, *run)
    return _gaussmap.mesh_curvature(
        subject.vertices, subject.faces, given, estimator, weights, k, degree, tensor, confidence, *run
    )


def _result_of(found: dict[str, Any], kind: str, estimator: str) -> Curvature:
    for name in ("tensor", "face_tensor"):
        if found.get(name) is not None:
            found[name] = PrincipalCurvatures(*found[name])
    if kind == "cloud" and estimator != "dirichlet":
        found["kappa"] = None  # no fans, no integral
    return Curvature(kind=kind, estimator=estimator, **found)


def _attach(subject: Subject, result: Curvature) -> None:
    """Write the result back, to a Geometry as the command writes files."""
    vertex, face = result.values()
    x = subject.source
    faces_fit = result.kind == "mesh"
    if isinstance(x, Geometry):
        if faces_fit and x.polygons is not None:
            made = triangulate(x)
            x.faces, x.polygons, x.face_attributes, x._rest = made.faces, None, made.face_attributes, made._rest
        vertex = {"scalar_total_curvature": result.density, "quality": result.density, **vertex}
        face = {"kappa": result.kappa, "quality": result.face_density, **face} if faces_fit else {}  # type: ignore[dict-item]
        vertex, face = ({name: values.astype(np.float32) for name, values in v.items()} for v in (vertex, face))
    else:
        vertex = {"total_curvature": result.density, **vertex}
        face = {"kappa": result.kappa, **face} if faces_fit else {}  # type: ignore[dict-item]
    subject.attach(vertex, face, colors(result.density))


@dataclass(frozen=True, eq=False, repr=False)
class Normals(Result):
    """Unit normals. As an array it is them."""

    normals: Floats  #: (n, 3), NaN where undefined
    method: str
    undefined: int
    lowered: int = 0  #: points whose jet took a lower degree than asked for
    duplicates: int = 0
    non_finite: int = 0

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> AnyArray:
        return np.array(self.normals, dtype) if copy else np.asarray(self.normals, dtype)

    def _facts(self) -> list[tuple[str, str]]:
        facts = [
            ("", count(len(self.normals), "normal")),
            ("method", self.method),
            ("undefined", f"{self.undefined:,}"),
        ]
        for label in ("lowered", "duplicates", "non_finite"):
            if getattr(self, label):
                facts.append((label.replace("_", " "), f"{getattr(self, label):,}"))
        return facts


def normals(
    x: Any,
    faces: Any = None,
    *,
    method: str | None = None,
    k: int = 20,
    degree: int = 4,
    orient: str = "mst",
    kind: str = "auto",
    threads: int | None = None,
    progress: Progress = None,
) -> Normals:
    """Unit normals of the vertices of a mesh, or of the points of a cloud, oriented.

    :param x: as in `curvature`. :param faces: (m, 3), None: a cloud.
    :param method: meshes: weights of the faces around a vertex: "max" (default; exact on every triangulated sphere, Max
        1999), "angle", "area". Clouds: "jet" (default; a polynomial fitted to k neighbours), "pca", "wpca".
    :param degree: of the jet, 1 to 4.
    :param orient: clouds: "mst": signs that agree along a spanning tree (Hoppe et al. 1992), each part starting at its
        highest point, up. "none": as the fit left them.
    :returns: (n, 3); NaN where nothing defines one.
    :raises ValueError: as `curvature`.
    """
    one_of("kind", kind, ("auto", "mesh", "cloud"))
    one_of("orient", orient, ("mst", "none"))
    subject = subject_of(x, faces)
    if kind == "mesh" and subject.faces is None:
        raise ValueError("kind = 'mesh', but there are no faces")
    count_ = whole("k", k, 3, 1000)
    with reported(progress, "estimating normals") as report:
        run = (thread_count(threads), report)
        if subject.faces is not None and kind != "cloud":
            word = one_of("method", method or "max", _of_meshes)
            found = {"normals": _gaussmap.mesh_normals(subject.vertices, subject.faces, word, *run)}
        else:
            word = one_of("method", method or "jet", _of_clouds)
            order = whole("degree", degree, 1, 4)
            found = _gaussmap.cloud_normals(subject.vertices, count_, word, order, orient == "mst", *run)
    undefined = int(np.isnan(found["normals"][:, 0]).sum())
    return Normals(method=word, undefined=undefined, **found)
