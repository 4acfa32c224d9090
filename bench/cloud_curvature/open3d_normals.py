"""open3d_normals.py FILE OUT K: a cloud with Open3D's normals, as the author's Open3D program makes them.

Principal component analysis of K neighbours, oriented along the minimum spanning tree of Hoppe et al. 1992
(orient_normals_consistent_tangent_plane), both Open3D's. OUT is a PLY with the file's points and exact densities.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import ply  # noqa: E402
from judge import read_shape  # noqa: E402


def main(path, out, k):
    import open3d

    points, _, _, truth = read_shape(path)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(int(k) + 1))  # Open3D counts the point itself
    cloud.orient_normals_consistent_tangent_plane(int(k))
    nx, ny, nz = np.asarray(cloud.normals).T
    ply.write(out, points, nx=nx, ny=ny, nz=nz, exact_density=truth)


if __name__ == "__main__":
    main(*sys.argv[1:])
