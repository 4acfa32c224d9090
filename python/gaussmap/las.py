"""LAS, LAZ and COPC clouds by laspy: every dimension is kept, results become extra bytes.

Needs the extra `las` (laspy with lazrs). `gaussmap.read` and `gaussmap.write` come here by the extension.
"""

from __future__ import annotations

import copy
import os
import tempfile
from dataclasses import dataclass
from typing import Any

import numpy as np

from gaussmap._arrays import AnyArray
from gaussmap._geometry import Geometry, as_geometry

# Dimensions that hold normals: those of PDAL, and those that PLY files call so.
_normals = (("NormalX", "NormalY", "NormalZ"), ("nx", "ny", "nz"))
# Names of results in LAS, where there is no convention of MeshLab or CloudCompare to follow.
_renamed = {"scalar_total_curvature": "total_curvature"}


def _laspy() -> Any:
    try:
        import laspy
    except ImportError:
        raise ImportError("LAS and LAZ files need laspy: pip install 'gaussmap[las]'") from None
    return laspy


@dataclass(eq=False, repr=False)
class LasCloud(Geometry):
    """A cloud as a LAS file gave it; `attributes` holds every dimension by laspy's name."""

    las: Any = None  #: laspy.LasData: header, VLRs and the stored records


def _points(path: str) -> Any:
    """laspy.LasData, read in pieces so that a header which claims too much costs nothing."""
    laspy = _laspy()
    try:
        with laspy.open(path) as reader:
            header = reader.header
            claimed = header.point_count
            parts = [part.array for part in reader.chunk_iterator(1_000_000)]
            evlrs = reader.evlrs
    except Exception as problem:  # laspy and lazrs raise many kinds, none of which name the file
        raise ValueError(f"{path}: not read as LAS: {problem}; is it whole?") from None
    array = np.concatenate(parts) if parts else np.zeros(0, header.point_format.dtype())
    if len(array) != claimed:
        raise ValueError(f"{path}: cut short: the header says {claimed} points, and there are {len(array)}")
    record = laspy.ScaleAwarePointRecord(array, header.point_format, scales=header.scales, offsets=header.offsets)
    las = laspy.LasData(header, record)
    if evlrs:
        las.evlrs = evlrs
    return las


def read(path: str | os.PathLike[str]) -> LasCloud:
    """Read a LAS, LAZ or COPC file.

    :returns: positions in the file's unit (scaled, offset), every dimension in `attributes`; normals where extra bytes
        hold some (NormalX, NormalY, NormalZ, or nx, ny, nz).
    :raises ImportError: laspy is not installed. :raises ValueError: a file that is none, or is cut short.
    """
    las = _points(os.fspath(path))
    vertices = np.ascontiguousarray(las.xyz, np.float64)
    names = [name for name in las.point_format.dimension_names if name not in ("X", "Y", "Z")]
    attributes = {name: np.ascontiguousarray(las[name]) for name in names}
    normals = None
    for axes in _normals:
        if all(axis in attributes for axis in axes):
            normals = np.column_stack([attributes.pop(axis).astype(np.float64) for axis in axes])
            break
    return LasCloud(vertices, None, normals, attributes, format="las", las=las)


def _new(geometry: Geometry) -> Any:
    """A file of our own: the finest round scale that the box allows."""
    laspy = _laspy()
    coloured = all(name in geometry.attributes for name in ("red", "green", "blue"))
    header = laspy.LasHeader(point_format=7 if coloured else 6, version="1.4")
    low = geometry.vertices.min(axis=0) if len(geometry.vertices) else np.zeros(3)
    extent = float((geometry.vertices - low).max(initial=0)) or 1.0
    header.offsets = np.floor(low)
    header.scales = np.full(3, 10.0 ** (np.floor(np.log10(extent / 2**31)) + 1))
    las = laspy.LasData(header)
    las.xyz = geometry.vertices
    return las


def _copy(las: Any, geometry: Geometry) -> Any:
    """The records of the file that the cloud came from; positions that were moved are stored anew."""
    laspy = _laspy()
    points = laspy.ScaleAwarePointRecord(
        las.points.array.copy(), las.point_format, scales=las.header.scales, offsets=las.header.offsets
    )
    out = laspy.LasData(copy.deepcopy(las.header), points)
    # An octree that is not written must not be announced.
    out.vlrs = [vlr for vlr in las.vlrs if vlr.user_id.lower() != "copc"]
    if las.evlrs:
        out.evlrs = [vlr for vlr in las.evlrs if vlr.user_id.lower() != "copc"]
    if not np.array_equal(np.asarray(out.xyz), geometry.vertices):
        out.xyz = geometry.vertices
    coloured = all(name in geometry.attributes for name in ("red", "green", "blue"))
    if coloured and "red" not in out.point_format.dimension_names:
        with_colours = {0: 2, 1: 3, 4: 5, 6: 7, 9: 10}[out.point_format.id]
        out = laspy.convert(out, point_format_id=with_colours)
    return out


def _set(las: Any, name: str, values: AnyArray) -> None:
    """Set a dimension, adding extra bytes where there is none of that name."""
    laspy = _laspy()
    if name in las.point_format.dimension_names:
        have = np.asarray(las[name])
        if have.dtype == values.dtype and np.array_equal(have, values, equal_nan=have.dtype.kind == "f"):
            return
        if name in ("red", "green", "blue") and values.dtype == np.uint8:
            values = values.astype(np.uint16) * 257  # the full range of LAS
        dimension = las.point_format.dimension_by_name(name)
        if dimension.is_standard and values.size:
            low, high = int(dimension.min), int(dimension.max)
            beyond = (
                ~((values >= low) & (values <= high)) if dimension.kind.name != "FloatingPoint" else np.zeros(1, bool)
            )
            if beyond.any():
                at = int(np.argmax(beyond))
                raise ValueError(f"{name}[{at}] = {values[at]} is outside [{low}, {high}], which LAS holds there")
        las[name] = values
        return
    if len(name.encode()) > 32:
        raise ValueError(f"{name!r} is longer than the 32 bytes that LAS allows a name")
    las.add_extra_dim(laspy.ExtraBytesParams(name=name, type=values.dtype.str.lstrip("<>|=")))
    las[name] = values


def write(path: str | os.PathLike[str], x: Any, *, like: Any = None, **values: Any) -> None:
    """Write a LAS or LAZ file, whole or not at all.

    A cloud that came from `read` keeps its header, VLRs and the stored bits of every dimension that was not changed;
    others become LAS 1.4. Attributes that are no dimensions of the file become extra bytes; `scalar_total_curvature`
    (what `curvature(cloud, attach=True)` makes) is called `total_curvature`, and normals NormalX, NormalY, NormalZ, as
    PDAL calls them. Faces and lists have no place.

    :param x: what `read` gave, or anything that `gaussmap.curvature` takes.
    :param like: laspy.LasData of as many points, whose header and dimensions are taken; by default that of x.
    :param values: further dimensions by name, each (n,): `las.write("y.laz", cloud, total_curvature=result.density)`.
    :raises ValueError: a coordinate that is not finite (its point is named), a COPC name (its octree is not written),
        values of the wrong length or that the dimension cannot hold.
    :raises OSError: the system's reason.
    """
    name = os.fspath(path)
    if name.lower().endswith(".copc.laz"):
        raise ValueError(f"{name}: COPC is read, not written; write .laz")
    geometry = as_geometry(x)
    finite = np.isfinite(geometry.vertices).all(axis=1)
    if not finite.all():
        at = int(np.argmin(finite))
        raise ValueError(
            f"vertices[{at}] = {geometry.vertices[at].tolist()} is not finite; LAS holds finite points only"
        )
    source = getattr(x, "las", None) if like is None else like
    las = (
        _copy(source, geometry)
        if source is not None and len(source.points) == len(geometry.vertices)
        else _new(geometry)
    )
    given = {**geometry.attributes, **values}
    if "scalar_total_curvature" in given:
        given.pop("quality", None)  # the same for MeshLab, which reads no LAS
    if geometry.normals is not None:
        given.update({axis: geometry.normals[:, i].astype(np.float32) for i, axis in enumerate(_axes(las))})
    for label, raw in given.items():
        array = np.asarray(raw)
        if array.dtype == object or array.ndim != 1:
            if label in values:
                raise ValueError(f"{label} has shape {array.shape}; ({len(geometry.vertices)},) is wanted")
            continue
        if len(array) != len(geometry.vertices):
            raise ValueError(f"{label} has {len(array)} values, but there are {len(geometry.vertices)} points")
        _set(las, _renamed.get(label, label), array.astype(np.uint8) if array.dtype == bool else array)
    _write_whole(name, las)


def _axes(las: Any) -> tuple[str, str, str]:
    """What the file calls normals, if it has some."""
    return next((axes for axes in _normals if axes[0] in las.point_format.dimension_names), _normals[0])


def _write_whole(name: str, las: Any) -> None:
    folder = os.path.dirname(os.path.abspath(name))
    handle, beside = tempfile.mkstemp(suffix=os.path.splitext(name)[1].lower(), prefix=".gaussmap-", dir=folder)
    try:
        with os.fdopen(handle, "w+b") as file:
            las.write(file, do_compress=name.lower().endswith(".laz"))
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(beside, 0o666 & ~mask)
        os.replace(beside, name)
    except BaseException:
        if os.path.exists(beside):
            os.unlink(beside)
        raise
