"""meshlab_apss.py FILE POINTS K:SCALE …: MeshLab's algebraic point set surfaces (Guennebaud, Gross 2007).

Normals by MeshLab with K neighbours (K = 0: the exact ones of the file), filter scale SCALE, the rest its defaults.
What MeshLab calls the mean curvature there is k1 + k2 =: s (inferred from an ellipsoid with exact values); density = s² − 2 K, not below 0.
POINTS: how many of the first points are judged (0: all). Without pymeshlab: no row, and a word on the standard error.
"""

import importlib.metadata
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from judge import read_shape, report  # noqa: E402


def density(pymeshlab, points, normals, count, k, scale):
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, v_normals_matrix=normals) if k == 0 else pymeshlab.Mesh(points))
    start = time.perf_counter()
    if k > 0:
        meshes.compute_normal_for_point_clouds(k=k)
    meshes.compute_selection_by_condition_per_vertex(condselect=f"vi < {count}")
    values = []
    for kind in ("Mean", "Gauss"):
        meshes.compute_curvature_and_color_apss_per_vertex(curvaturetype=kind, filterscale=scale, selectiononly=True)
        values.append(meshes.current_mesh().vertex_scalar_array()[:count].copy())
    sums, products = values
    return np.maximum(sums**2 - 2 * products, 0), time.perf_counter() - start


def main(path, count, *settings):
    points, _, normals, truth = read_shape(path)
    try:
        import pymeshlab
    except ImportError as missing:
        print(f"meshlab_apss.py: pymeshlab is not installed ({missing}); no rows of it", file=sys.stderr)
        return
    count = min(int(count) or len(truth), len(truth))
    name = f"MeshLab {importlib.metadata.version('pymeshlab')} APSS"
    for setting in settings:
        k, scale = setting.split(":")
        values, seconds = density(pymeshlab, points, normals, count, int(k), float(scale))
        of_normals = f"normals {k}" if int(k) else "exact normals"
        report(name, f"{of_normals} scale {scale}", values, truth, seconds)


if __name__ == "__main__":
    main(*sys.argv[1:])
