"""peers.py FILE [RADIUS …]: the densities of libigl, MeshLab and Rusinkiewicz's estimator on a mesh, against its truth.

libigl: principal_curvature (quadrics fitted over RADIUS rings, Panozzo et al. 2010), density k1² + k2².
MeshLab: its quadric fitting and Taubin's approximation as curvedness c (density 2 c²), and the discrete mean and
Gaussian curvature of Meyer et al. 2003 (4 H² − 2 K, not below 0).
Rusinkiewicz 2004: our own reading, with normals weighted by Max 1999 as his trimesh2 does and with the exact ones.
A library that is not installed gives no row and a word on the standard error.
"""

import importlib.metadata
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from judge import read_shape, report  # noqa: E402


def libigl(vertices, faces, truth, radii):
    import igl

    version = importlib.metadata.version("libigl")
    for radius in radii:
        start = time.perf_counter()
        k1, k2 = igl.principal_curvature(vertices, faces.astype(np.int64), radius=radius)[2:4]
        report(f"libigl {version}", f"radius {radius}", k1 * k1 + k2 * k2, truth, time.perf_counter() - start)


def meshlab(vertices, faces, truth):
    import pymeshlab

    version = importlib.metadata.version("pymeshlab")

    def scalars(function, **options):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        start = time.perf_counter()
        getattr(meshes, function)(**options)
        return meshes.current_mesh().vertex_scalar_array(), time.perf_counter() - start

    for method in ("Quadric Fitting", "Taubin approximation"):
        curvedness, seconds = scalars("compute_curvature_principal_directions_per_vertex", method=method,
                                      curvcolormethod="CurvedNess", autoclean=False)
        report(f"MeshLab {version}", method.lower(), 2 * curvedness**2, truth, seconds)
    name = "compute_scalar_by_discrete_curvature_per_vertex"
    mean, first = scalars(name, curvaturetype="Mean Curvature")
    gauss, second = scalars(name, curvaturetype="Gaussian Curvature")
    report(f"MeshLab {version}", "discrete", np.maximum(4 * mean**2 - 2 * gauss, 0), truth, first + second)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def max_normals(vertices, faces):
    """Vertex normals, faces weighted by area / (squared lengths of the two sides at the vertex) (Max 1999)."""
    sums = np.zeros_like(vertices)
    for corner in range(3):
        here, after, before = (vertices[faces[:, (corner + s) % 3]] for s in range(3))
        u, v = after - here, before - here
        weight = np.sum(u * u, 1) * np.sum(v * v, 1)
        np.add.at(sums, faces[:, corner], np.cross(u, v) / weight[:, None])
    return unit(sums)


def voronoi_areas(points):
    """Area of each corner's Voronoi cell in its triangle, m × 3, as Meyer et al. 2003 treat obtuse ones."""
    sides = np.stack([points[:, (c + 2) % 3] - points[:, (c + 1) % 3] for c in range(3)], 1)  # opposite corner c
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    squares = np.sum(sides**2, 2)
    cosines = np.stack([-np.sum(sides[:, (c + 1) % 3] * sides[:, (c + 2) % 3], 1) for c in range(3)], 1)
    cotangents = cosines / (2 * area[:, None])
    cells = np.stack([(squares[:, (c + 1) % 3] * cotangents[:, (c + 1) % 3] +
                       squares[:, (c + 2) % 3] * cotangents[:, (c + 2) % 3]) / 8 for c in range(3)], 1)
    obtuse = cosines < 0
    any_obtuse = obtuse.any(1)
    cells[any_obtuse] = np.where(obtuse[any_obtuse], area[any_obtuse, None] / 2, area[any_obtuse, None] / 4)
    return cells


def rusinkiewicz_density(vertices, faces, normals):
    """Squared Frobenius norm of the curvature tensor at each vertex (Rusinkiewicz 2004).

    In each face the tensor (e, f, g) is the least-squares solution of II·(side in the face's frame) = difference of the
    normals in that frame, over the three sides; it is turned into the tangent plane of each corner by the smallest
    rotation between the normals, and averaged with the Voronoi areas as weights.
    """
    points, ns = vertices[faces], normals[faces]
    sides = np.stack([points[:, (c + 2) % 3] - points[:, (c + 1) % 3] for c in range(3)], 1)
    turns = np.stack([ns[:, (c + 2) % 3] - ns[:, (c + 1) % 3] for c in range(3)], 1)
    u = unit(sides[:, 0])
    face_normal = unit(np.cross(sides[:, 0], sides[:, 1]))
    v = np.cross(face_normal, u)
    a, b = np.einsum("mcd,md->mc", sides, u), np.einsum("mcd,md->mc", sides, v)
    p, q = np.einsum("mcd,md->mc", turns, u), np.einsum("mcd,md->mc", turns, v)
    aa, ab, bb = (a * a).sum(1), (a * b).sum(1), (b * b).sum(1)
    zero = np.zeros_like(aa)
    matrix = np.stack([np.stack([aa, ab, zero], 1), np.stack([ab, aa + bb, ab], 1), np.stack([zero, ab, bb], 1)], 1)
    right = np.stack([(a * p).sum(1), (b * p + a * q).sum(1), (b * q).sum(1)], 1)
    e, f, g = np.linalg.solve(matrix, right[:, :, None])[:, :, 0].T

    # A fixed frame at each vertex, and the tensor there.
    axis = np.eye(3)[np.argmin(np.abs(normals), 1)]
    right_of = unit(np.cross(normals, axis))
    up_of = np.cross(normals, right_of)
    weights = voronoi_areas(points)
    tensors, total = np.zeros((len(vertices), 3)), np.zeros(len(vertices))
    for corner in range(3):
        at = faces[:, corner]
        normal = normals[at]
        along = face_normal + normal
        scale = 1 / (1 + np.sum(face_normal * normal, 1))

        def turned(vector):  # from the face's plane into the vertex's
            return vector - (np.sum(vector * normal, 1) * scale)[:, None] * along

        tu, tv = turned(u), turned(v)
        r, s = right_of[at], up_of[at]
        ru, rv, su, sv = (np.sum(x * y, 1) for x, y in ((r, tu), (r, tv), (s, tu), (s, tv)))
        rr = ru * ru * e + 2 * ru * rv * f + rv * rv * g
        rs = ru * su * e + (ru * sv + rv * su) * f + rv * sv * g
        ss = su * su * e + 2 * su * sv * f + sv * sv * g
        np.add.at(tensors, at, weights[:, corner, None] * np.stack([rr, rs, ss], 1))
        np.add.at(total, at, weights[:, corner])
    tensors /= total[:, None]
    return tensors[:, 0] ** 2 + 2 * tensors[:, 1] ** 2 + tensors[:, 2] ** 2


def rusinkiewicz(vertices, faces, exact, truth):
    for name in ("Max normals", "exact normals"):
        start = time.perf_counter()
        normals = exact if name == "exact normals" else max_normals(vertices, faces)
        density = rusinkiewicz_density(vertices, faces, normals)
        report("Rusinkiewicz 2004", name, density, truth, time.perf_counter() - start)


def main(path, *radii):
    vertices, faces, normals, truth = read_shape(path)
    rusinkiewicz(vertices, faces, normals, truth)
    for peer, run in (("libigl", lambda: libigl(vertices, faces, truth, [int(r) for r in radii or (2, 3, 4, 5)])),
                      ("MeshLab", lambda: meshlab(vertices, faces, truth))):
        try:
            run()
        except ImportError as missing:
            print(f"peers.py: {peer} is not installed ({missing}); no rows of it", file=sys.stderr)


if __name__ == "__main__":
    main(*sys.argv[1:])
