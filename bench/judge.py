"""What the Python peers share: reading a shape written by `surfaces`, and the line that judge.h prints too."""

import numpy as np

import ply


def read_shape(path):
    """(vertices n × 3, faces m × 3, normals n × 3, exact density n) of a binary PLY written by `surfaces`."""
    vertices, faces = ply.read(path)
    normals = np.stack([vertices[name] for name in ("nx", "ny", "nz")], 1)
    faces = np.zeros((0, 3), np.int32) if faces is None else faces
    return ply.positions(vertices), faces, normals, vertices["exact_density"].copy()


def report(peer, parameter, density, truth, seconds):
    """Prints peer, parameter, relative RMSE, the same rescaled, undefined, points, seconds."""
    defined = np.isfinite(density)
    d, t = density[defined], truth[: len(density)][defined]
    error = np.sqrt(np.sum((d - t) ** 2) / np.sum(t * t))
    dd = np.sum(d * d)
    rescaled = np.sqrt(max(0.0, np.sum(t * t) - np.sum(d * t) ** 2 / dd) / np.sum(t * t)) if dd > 0 else 1.0
    print(f"{peer},{parameter},{error:.6g},{rescaled:.6g},{np.sum(~defined)},{len(density)},{seconds:.6g}", flush=True)
