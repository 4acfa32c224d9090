"""Total curvature k1² + k2² of triangle meshes and point clouds, and feature-aware decimation.

>>> import gaussmap
>>> sphere = gaussmap.shapes.sphere(subdivisions=4, radius=2.0)
>>> result = gaussmap.curvature(sphere)
>>> float(result.density.mean().round(6))      # 2 / r²
0.5

Arrays go in as they are (C-contiguous float64 and int32 without a copy; float32, int64 and others are converted), and
results come out as small objects that hold arrays. Options are keyword-only. Undefined values are NaN, and counted.
The same bits for any number of threads. What is wrong with an array is a ValueError that names it, the index and the
value. Long calls can be interrupted by Ctrl-C, and take `progress=True` (a bar) or `progress=f` (called as
f(fraction); f cancels by returning False, which raises `gaussmap.Cancelled`).

Wherever a function takes `x, faces=None`, x is an (n, 3) array of positions, or an object: what `gaussmap.read` or any
other function here gives, a mesh or cloud of Open3D, trimesh, PyVista, PyMeshLab or meshio, or a pair (vertices, faces).
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gaussmap import las, shapes
    from gaussmap._curvature import Curvature, Normals, PrincipalCurvatures, colors, curvature, normals
    from gaussmap._gaussmap import Cancelled
    from gaussmap._geometry import Geometry, Polygons, read, triangulate, weld, write
    from gaussmap._neighbors import Fans, Neighbors, fans, knn
    from gaussmap._page import Page, to_html
    from gaussmap._plot import plot
    from gaussmap._surfaces import Comparison, Decimation, Deviation, Samples, closest, compare, decimate, sample

__version__: str

# Everything is found on first use: `import gaussmap`, and the command of that name, wait for nothing.
_homes = {
    "_curvature": ("Curvature", "Normals", "PrincipalCurvatures", "colors", "curvature", "normals"),
    "_gaussmap": ("Cancelled",),
    "_geometry": ("Geometry", "Polygons", "read", "triangulate", "weld", "write"),
    "_neighbors": ("Fans", "Neighbors", "fans", "knn"),
    "_page": ("Page", "to_html"),
    "_plot": ("plot",),
    "_surfaces": ("Comparison", "Decimation", "Deviation", "Samples", "closest", "compare", "decimate", "sample"),
}
_home_of = {name: home for home, names in _homes.items() for name in names}
_modules = ("las", "shapes")

__all__ = [
    "Cancelled",
    "Comparison",
    "Curvature",
    "Decimation",
    "Deviation",
    "Fans",
    "Geometry",
    "Neighbors",
    "Normals",
    "Page",
    "Polygons",
    "PrincipalCurvatures",
    "Samples",
    "closest",
    "colors",
    "compare",
    "curvature",
    "decimate",
    "fans",
    "knn",
    "las",
    "normals",
    "plot",
    "read",
    "sample",
    "shapes",
    "to_html",
    "triangulate",
    "weld",
    "write",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        found: Any = version("gaussmap")
    elif name in _modules:
        found = importlib.import_module(f"gaussmap.{name}")
    elif name in _home_of:
        found = getattr(importlib.import_module(f"gaussmap.{_home_of[name]}"), name)
    else:
        raise AttributeError(f"module 'gaussmap' has no attribute {name!r}")
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
