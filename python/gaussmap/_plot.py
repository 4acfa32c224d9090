"""Looking at results in a notebook or on a screen, by PyVista."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from gaussmap._arrays import row_values
from gaussmap._curvature import colors, curvature
from gaussmap._subject import subject_of

if TYPE_CHECKING:
    import pyvista


def plot(
    x: Any,
    faces: Any = None,
    *,
    values: Any = None,
    diverging: bool = False,
    path: str | os.PathLike[str] | None = None,
    window_size: tuple[int, int] = (1024, 768),
) -> pyvista.Plotter:
    """A scene of a mesh or cloud coloured by its total curvature, or by `values`; needs the extra `view` (PyVista).

    :param values: (n,), by default `curvature(x, faces).density`; a `Curvature` will do too. Not finite: grey.
    :param diverging: the values have a sign (see `colors`).
    :param path: write a picture there (.png), no screen needed.
    :returns: the plotter: `.show()` it, or add to it.
    :raises ImportError: PyVista is not installed.
    :raises ValueError: values of another number than the vertices.
    """
    try:
        import pyvista
    except ImportError:
        raise ImportError("gaussmap.plot needs PyVista: pip install 'gaussmap[view]'") from None
    subject = subject_of(x, faces)
    shown = curvature(x, faces).density if values is None else np.asarray(values)
    shown = row_values("values", shown, len(subject.vertices))
    if subject.faces is not None:
        data = pyvista.PolyData.from_regular_faces(subject.vertices, subject.faces)
    else:
        data = pyvista.PolyData(subject.vertices)
    data.point_data["colour"] = colors(shown, diverging=diverging)
    plotter = pyvista.Plotter(off_screen=True if path is not None else None, window_size=list(window_size))
    plotter.add_mesh(data, scalars="colour", rgb=True, render_points_as_spheres=subject.faces is None, point_size=5)
    if path is not None:
        plotter.screenshot(os.fspath(path))
    return plotter
