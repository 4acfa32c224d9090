"""What functions are given: arrays, or a mesh or cloud of some library, told by what it can do and never imported.

An object is told by its attributes, so that anything that looks like one of these is taken as one:

| object                                    | positions        | attached to                                      |
|-------------------------------------------|------------------|--------------------------------------------------|
| gaussmap.Geometry and all results         | vertices         | attributes, face_attributes                      |
| open3d.geometry.TriangleMesh, PointCloud  | vertices, points | vertex_colors, colors (they hold nothing else)   |
| open3d.t.geometry, both                   | positions        | vertex / point, triangle: total_curvature, kappa |
| trimesh.Trimesh, trimesh.PointCloud       | vertices         | vertex_attributes, face_attributes; metadata     |
| pyvista.PolyData                          | points           | point_data, cell_data                            |
| pymeshlab.Mesh                            | vertex_matrix()  | custom scalar attributes                         |
| meshio.Mesh                               | points           | point_data, cell_data                            |
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gaussmap._arrays import AnyArray, Floats, Ints, rows, triangles

Values = dict[str, AnyArray]


def _no_attaching(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
    raise ValueError("attach=True is for objects that hold attributes; arrays hold none")


@dataclass
class Subject:
    """Positions, triangles and normals as the library takes them, and how to write values back."""

    vertices: Floats
    faces: Ints | None = None
    normals: Floats | None = None
    source: Any = None
    attributes: Values = field(default_factory=dict)
    face_attributes: Values = field(default_factory=dict)
    #: attach(values of vertices, values of faces, colours of vertices)
    attach: Callable[[Values, Values, AnyArray], None] = _no_attaching


def subject_of(x: Any, faces: Any = None, name: str = "vertices") -> Subject:
    """\\throw ValueError naming the array, and what is wrong with it."""
    if isinstance(x, tuple) and len(x) == 2 and faces is None:
        x, faces = x
    if faces is not None or isinstance(x, (np.ndarray, list, tuple)):
        vertices = rows(name, x)
        return Subject(vertices, None if faces is None else triangles("faces", faces, len(vertices)))
    for looks_like, take in _kinds:
        if looks_like(x):
            return take(x)
    if hasattr(x, "__array__"):
        return Subject(rows(name, x))
    raise ValueError(
        f"{name}: a {type(x).__module__}.{type(x).__qualname__} is neither an array nor a known mesh or cloud"
    )


def _made(
    x: Any, vertices: Any, faces: Any, normals: Any, attach: Callable[[Values, Values, AnyArray], None]
) -> Subject:
    """Faces and normals that are empty are none."""
    points = rows("vertices", vertices)
    some_faces = None if faces is None or len(faces) == 0 else triangles("faces", faces, len(points))
    some_normals = None if normals is None or len(normals) == 0 else rows("normals", normals)
    return Subject(points, some_faces, some_normals, x, attach=attach)


def _geometry(x: Any) -> Subject:
    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        if not hasattr(x, "attributes"):
            raise ValueError(f"attach=True: a {type(x).__qualname__} has no attributes to write to")
        x.attributes.update(vertex_values)
        if hasattr(x, "face_attributes"):
            x.face_attributes.update(face_values)

    out = _made(x, x.vertices, getattr(x, "faces", None), getattr(x, "normals", None), attach)
    out.attributes = dict(getattr(x, "attributes", {}))
    out.face_attributes = dict(getattr(x, "face_attributes", {}))
    return out


def _trimesh(x: Any) -> Subject:
    # vertex_normals are not taken: trimesh computes them when asked, by weights that are no better than ours.
    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        if hasattr(x, "vertex_attributes"):
            x.vertex_attributes.update(vertex_values)
            x.face_attributes.update(face_values)
        else:
            x.metadata.update(vertex_values)
            x.colors = colors

    return _made(x, x.vertices, getattr(x, "faces", None), None, attach)


def _open3d(x: Any) -> Subject:
    mesh = hasattr(x, "triangles")
    positions = x.vertices if mesh else x.points

    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        made = type(positions)(colors / 255.0)
        if mesh:
            x.vertex_colors = made
        else:
            x.colors = made

    normals = x.vertex_normals if mesh else x.normals
    return _made(x, np.asarray(positions), np.asarray(x.triangles) if mesh else None, np.asarray(normals), attach)


def _open3d_tensor(x: Any) -> Subject:
    mesh = hasattr(x, "triangle")
    vertex = x.vertex if mesh else x.point
    # Tensors of the same kind as the positions, float32.
    tensor = type(vertex["positions"])

    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        for name, values in vertex_values.items():
            vertex[name] = tensor(np.ascontiguousarray(values, np.float32).reshape(len(values), -1))
        for name, values in face_values.items():
            x.triangle[name] = tensor(np.ascontiguousarray(values, np.float32).reshape(len(values), -1))

    faces = x.triangle["indices"].cpu().numpy() if mesh and "indices" in x.triangle else None
    normals = vertex["normals"].cpu().numpy() if "normals" in vertex else None
    return _made(x, vertex["positions"].cpu().numpy(), faces, normals, attach)


def _pyvista(x: Any) -> Subject:
    # Polygons are triangulated; their faces then have no values to take.
    triangular = x.n_cells == 0 or x.is_all_triangles
    lines = x.n_cells > 0 and x.faces.size == 0
    faces = None if lines or x.n_cells == 0 else (x if triangular else x.triangulate()).faces.reshape(-1, 4)[:, 1:]

    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        for name, values in vertex_values.items():
            x.point_data[name] = values
        if triangular and faces is not None:
            for name, values in face_values.items():
                x.cell_data[name] = values

    return _made(x, x.points, faces, x.point_data.active_normals, attach)


def _pymeshlab(x: Any) -> Subject:
    # MeshLab gives every mesh normals, by areas where the file has none; those of clouds are zero where unknown.
    faces = x.face_matrix()
    normals = x.vertex_normal_matrix() if len(faces) == 0 else None
    known = normals is not None and bool(np.any(normals))

    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        for name, values in vertex_values.items():
            x.add_vertex_custom_scalar_attribute(np.asarray(values, np.float64), name)
        for name, values in face_values.items():
            x.add_face_custom_scalar_attribute(np.asarray(values, np.float64), name)

    return _made(x, x.vertex_matrix(), faces, normals if known else None, attach)


def _meshio(x: Any) -> Subject:
    triangular = [block.type == "triangle" for block in x.cells]
    parts = []
    for block in x.cells:
        if block.type == "triangle":
            parts.append(block.data)
        elif block.type == "quad":
            parts.append(block.data[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))
    faces = np.concatenate(parts) if parts else None
    normals = next((x.point_data[n] for n in ("normals", "Normals") if n in x.point_data), None)

    def attach(vertex_values: Values, face_values: Values, colors: AnyArray) -> None:
        x.point_data.update(vertex_values)
        if not parts or len(parts) != sum(triangular):
            return
        for name, values in face_values.items():
            left = iter(np.split(values, np.cumsum([len(p) for p in parts])[:-1]))
            x.cell_data[name] = [
                next(left) if ours else np.full(len(block.data), np.nan)
                for ours, block in zip(triangular, x.cells, strict=True)
            ]

    # meshio keeps plane coordinates plane.
    points = np.asarray(x.points)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    return _made(x, points, faces, normals, attach)


def _has(*names: str) -> Callable[[Any], bool]:
    return lambda x: all(hasattr(x, name) for name in names)


# In this order: the first that fits.
_kinds: list[tuple[Callable[[Any], bool], Callable[[Any], Subject]]] = [
    (_has("vertex_matrix", "face_matrix"), _pymeshlab),
    (_has("point_data", "cells", "points"), _meshio),
    (_has("point_data", "n_cells", "points"), _pyvista),
    (_has("vertex", "triangle", "device"), _open3d_tensor),
    (_has("point", "device"), _open3d_tensor),
    (_has("vertices", "triangles", "vertex_colors"), _open3d),
    (_has("points", "normals", "has_normals"), _open3d),
    (_has("vertices", "metadata", "visual"), _trimesh),
    (_has("vertices", "metadata", "colors"), _trimesh),
    (_has("vertices"), _geometry),
]
