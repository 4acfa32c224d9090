"""Files in and out: meshes and clouds with everything that a file holds."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from gaussmap import _gaussmap
from gaussmap._arrays import AnyArray, Floats, Ints, rows, thread_count, triangles
from gaussmap._progress import Progress, reported
from gaussmap._results import Result, count
from gaussmap._subject import subject_of

Path = str | os.PathLike[str]


class Polygons(NamedTuple):
    """The faces as a file had them, where one of them is no triangle."""

    offsets: npt.NDArray[np.uint64]  #: polygon i has the corners offsets[i] … offsets[i + 1] − 1
    corners: Ints  #: vertex indices
    of: Ints  #: triangle → polygon
    corner: Ints  #: 3 a triangle: which corners of that polygon


def empty_rest() -> dict[str, Any]:
    """What a file may hold besides, carried from PLY to PLY and PCD to PCD."""
    return {"elements": [], "width": 0, "count_types": {}}


@dataclass(eq=False, repr=False)
class Geometry(Result):
    """A mesh or a cloud with its attributes.

    `attributes` holds one value a vertex by name (`red`, `intensity`, `quality`, …), (n,), of the type that is written;
    lists of one length are (n, length), others an object array of arrays. `face_attributes` the same of triangles, or of
    polygons where `polygons` is kept.
    """

    vertices: Floats  #: (n, 3)
    faces: Ints | None = None  #: (m, 3), None: a cloud
    normals: Floats | None = None  #: (n, 3), as given
    attributes: dict[str, AnyArray] = field(default_factory=dict)
    face_attributes: dict[str, AnyArray] = field(default_factory=dict)
    polygons: Polygons | None = None
    comments: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)  #: what reading had to do, each a sentence
    format: str = ""  #: of the file it was read from
    vertex_type: str = "float64"  #: of the coordinates when written
    normal_type: str = "float64"
    _rest: dict[str, Any] = field(default_factory=empty_rest)

    def _facts(self) -> list[tuple[str, str]]:
        facts = [
            (
                "",
                count(len(self.vertices), "vertex", "vertices")
                if self.faces is not None
                else count(len(self.vertices), "point"),
            )
        ]
        if self.faces is not None:
            facts.append(("", count(len(self.faces), "face")))
        if len(self.vertices) and np.isfinite(self.vertices).any():
            low, high = np.nanmin(self.vertices, axis=0), np.nanmax(self.vertices, axis=0)
            facts.append(("box", " × ".join(f"{side:.4g}" for side in high - low)))
        if self.normals is not None:
            facts.append(("with", "normals"))
        if self.attributes:
            facts.append(("attributes", ", ".join(self.attributes)))
        if self.face_attributes:
            facts.append(("face attributes", ", ".join(self.face_attributes)))
        return facts


def _values_in(properties: list[Any], counts: dict[str, str]) -> dict[str, AnyArray]:
    out: dict[str, AnyArray] = {}
    for name, values, offsets, count_type in properties:
        if offsets is None:
            out[name] = values
            continue
        counts[name] = count_type
        lengths = np.diff(offsets)
        if len(lengths) and (lengths == lengths[0]).all():
            out[name] = values.reshape(len(lengths), int(lengths[0]))
        else:
            out[name] = np.empty(len(lengths), object)
            out[name][:] = np.split(values, offsets[1:-1].astype(np.intp)) if len(lengths) else []
    return out


def _values_out(what: str, attributes: dict[str, AnyArray], expected: int, counts: dict[str, str]) -> list[Any]:
    out = []
    for name, given in attributes.items():
        values = np.asarray(given)
        if values.ndim == 0 or len(values) != expected:
            raise ValueError(f"{what}[{name!r}] has shape {values.shape}; one value of each of {expected} is wanted")
        offsets = None
        if values.dtype == object:
            offsets = np.concatenate([[0], np.cumsum([len(v) for v in values])]).astype(np.uint64)
            values = np.concatenate([np.asarray(v) for v in values]) if len(values) else np.empty(0, np.int32)
        elif values.ndim == 2:
            offsets = (np.arange(len(values) + 1) * values.shape[1]).astype(np.uint64)
            values = values.reshape(-1)
        if values.dtype == bool:
            values = values.astype(np.uint8)
        if (
            values.dtype.kind not in "fiu"
            or values.dtype.itemsize > 8
            or values.dtype == np.float16
            or values.ndim != 1
        ):
            raise ValueError(f"{what}[{name!r}] has values of type {values.dtype}, which files do not hold")
        longest = int(np.diff(offsets.astype(np.int64)).max(initial=0)) if offsets is not None else 0
        count_type = counts.get(name, "uint8" if longest < 256 else "int32")
        values = np.ascontiguousarray(values, values.dtype.newbyteorder("="))
        out.append((name, values, offsets, count_type))
    return out


def geometry_from(record: dict[str, Any]) -> Geometry:
    counts: dict[str, str] = {}
    face_counts: dict[str, str] = {}
    return Geometry(
        record["vertices"],
        record["faces"],
        record["normals"],
        _values_in(record["vertex_properties"], counts),
        _values_in(record["face_properties"], face_counts),
        None if record["polygons"] is None else Polygons(*record["polygons"]),
        record["comments"],
        record["notes"],
        record["format"],
        record["vertex_type"],
        record["normal_type"],
        {
            "elements": record["elements"],
            "width": record["width"],
            "count_types": {"vertex": counts, "face": face_counts},
        },
    )


def record_of(g: Geometry) -> dict[str, Any]:
    """What the compiled part writes; everything is checked here."""
    vertices = rows("vertices", g.vertices)
    n = len(vertices)
    faces = None if g.faces is None else triangles("faces", g.faces, n)
    if faces is not None and len(faces) and (faces.min() < 0 or faces.max() >= n):
        f, corner = (int(i) for i in np.argwhere((faces < 0) | (faces >= n))[0])
        raise ValueError(f"faces[{f}][{corner}] = {int(faces[f, corner])} is outside [0, {n})")
    normals = None if g.normals is None else rows("normals", g.normals)
    if normals is not None and len(normals) != n:
        raise ValueError(f"normals has {len(normals)} rows, but there are {n} vertices")
    polygons = g.polygons
    if polygons is not None and (faces is None or len(polygons.of) != len(faces)):
        raise ValueError("polygons belong to other faces than these; set polygons to None")
    elements = len(polygons.offsets) - 1 if polygons is not None else 0 if faces is None else len(faces)
    counts = g._rest["count_types"]
    return {
        "vertices": vertices,
        "faces": faces,
        "normals": normals,
        "vertex_type": g.vertex_type,
        "normal_type": g.normal_type,
        "vertex_properties": _values_out("attributes", g.attributes, n, counts.get("vertex", {})),
        "face_properties": _values_out("face_attributes", g.face_attributes, elements, counts.get("face", {})),
        "polygons": None if polygons is None else tuple(polygons),
        "elements": g._rest["elements"],
        "comments": g.comments,
        "width": g._rest["width"],
    }


def _is_lidar(path: str) -> bool:
    return path.lower().endswith((".las", ".laz"))


def read(path: Path, *, format: str | None = None, threads: int | None = None, progress: Progress = None) -> Geometry:
    """Read a PLY, OBJ, OFF, STL, XYZ/PWN/PTS or PCD file, and with the extra `las` LAS, LAZ and COPC.

    :param path: the content tells the format before the extension does; `format` ("ply", …) overrules both.
    :returns: a `Geometry`; polygons and strips become triangles, everything else is kept.
    :raises FileNotFoundError: there is no such file.
    :raises ValueError: one line: the file, where in it, what is wrong, what to do.
    """
    name = os.fspath(path)
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    if format is None and _is_lidar(name):
        from gaussmap import las

        return las.read(name)
    with reported(progress, "reading") as report:
        return geometry_from(_gaussmap.read(name, format or "", thread_count(threads), report))


def as_geometry(x: Any, faces: Any = None) -> Geometry:
    """Anything that functions take, as a geometry of its own: attributes may be added without touching x."""
    if isinstance(x, Geometry) and faces is None:
        out = Geometry(**{name: getattr(x, name) for name in Geometry.__dataclass_fields__})
        out.attributes, out.face_attributes = dict(x.attributes), dict(x.face_attributes)
        return out
    subject = subject_of(x, faces)
    out = Geometry(subject.vertices, subject.faces, subject.normals, subject.attributes, subject.face_attributes)
    given = getattr(x, "dtype", None)
    if given == np.float32:
        out.vertex_type = out.normal_type = "float32"
    return out


def write(
    path: Path, x: Any, faces: Any = None, *, normals: Any = None, format: str | None = None, ascii: bool = False
) -> None:
    """Write a mesh or cloud; the extension (or `format`) decides. LAS and LAZ with the extra `las`.

    Written beside its place and renamed when whole: a crash leaves the old file or none. What the format has no place
    for is left out: PLY holds everything.

    :param x: what `read` gives, or anything that the other functions take.
    :param normals: (n, 3), in place of those of x.
    :raises ValueError: an unknown extension, or arrays that do not fit together (which one is named).
    :raises OSError: the system's reason, with the path.
    """
    geometry = as_geometry(x, faces)
    if normals is not None:
        geometry.normals = rows("normals", normals)
    name = os.fspath(path)
    if format is None and _is_lidar(name):
        from gaussmap import las

        las.write(name, geometry, like=getattr(x, "las", None))
        return
    record = record_of(geometry)
    try:
        _gaussmap.write(name, record, format or "", ascii)
    except RuntimeError as problem:
        raise OSError(str(problem)) from None


def triangulate(geometry: Geometry) -> Geometry:
    """The triangles as the faces: polygons forgotten, face attributes repeated for each triangle of a polygon."""
    return geometry_from({**_gaussmap.triangulate(record_of(geometry)), "format": geometry.format})


def weld(geometry: Geometry) -> Geometry:
    """Vertices at exactly the same position become one (the first); triangles that lose a corner go."""
    return geometry_from({**_gaussmap.weld(record_of(geometry)), "format": geometry.format})
