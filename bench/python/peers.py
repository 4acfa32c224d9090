"""peers.py: total curvature by what Python has, on a torus and a knot, as meshes and as clouds: error and time in one run.

Every mesh and cloud is made here, its curvature known. The error is the RMSE of k1² + k2² over that of the truth about 0
(relative RMSE). Whoever gives mean and Gaussian curvature, as measures or densities, is read as 4 H² − 2 K; principal
curvatures as k1² + k2². Surface variation (Open3D's covariances, pgeof) has no unit that could be compared: it is scaled by
the factor that suits the truth best, an advantage that nobody has in practice. Each is run in turn, three turns of
a tenth of a second or one call if that takes longer; the fastest call counts. What is not installed has no row."""

import math
import time

import numpy as np

import gaussmap

TURNS = 3
TURN_SECONDS = 0.1


def igl_principal(radius):
    import igl

    def run(v, f):
        d1, d2, k1, k2, *_ = igl.principal_curvature(v, f, radius, True)
        return k1**2 + k2**2

    return run


def trimesh_measures():
    import trimesh

    def run(v, f):
        mesh = trimesh.Trimesh(v, f, process=False)
        radius = 1.5 * mesh.edges_unique_length.mean()
        area = math.pi * radius**2
        gauss = trimesh.curvature.discrete_gaussian_curvature_measure(mesh, v, radius) / area
        mean = trimesh.curvature.discrete_mean_curvature_measure(mesh, v, radius) / area
        return 4 * mean**2 - 2 * gauss

    return run


def pyvista_filter():
    import pyvista

    def run(v, f):
        mesh = pyvista.PolyData.from_regular_faces(v, f)
        return 4 * mesh.curvature("mean") ** 2 - 2 * mesh.curvature("gaussian")

    return run


def meshlab(method):
    import pymeshlab

    def run(v, f):
        scalars = {}
        for scalar in ("Mean Curvature", "Gaussian Curvature"):
            meshes = pymeshlab.MeshSet()
            meshes.add_mesh(pymeshlab.Mesh(v, f))
            meshes.compute_curvature_principal_directions_per_vertex(
                method=method, curvcolormethod=scalar, autoclean=False
            )
            scalars[scalar] = meshes.current_mesh().vertex_scalar_array()
        return 4 * scalars["Mean Curvature"] ** 2 - 2 * scalars["Gaussian Curvature"]

    return run


def open3d_covariances():
    import open3d

    def run(v, _):
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(v))
        cloud.estimate_covariances(open3d.geometry.KDTreeSearchParamKNN(20))
        values = np.linalg.eigvalsh(np.asarray(cloud.covariances))
        return values[:, 0] / values.sum(axis=1)

    return run


def pgeof_variation():
    import pgeof

    def run(v, _):
        points = v.astype(np.float32)
        neighbours, _ = pgeof.knn_search(points, points, 20)
        offsets = np.arange(len(v) + 1, dtype=np.uint32) * 20
        features = pgeof.compute_features(points, neighbours.ravel().astype(np.uint32), offsets)
        return features[:, pgeof.EFeatureID.Curvature.value]

    return run


def ours(**options):
    return lambda v, f: gaussmap.curvature(v, f, **options).density


MESHES = {
    "gaussmap": lambda: ours(),
    "gaussmap, estimator corrected": lambda: ours(estimator="corrected"),
    "gaussmap, estimator auto": lambda: ours(estimator="auto"),
    "libigl principal_curvature, radius 5": lambda: igl_principal(5),
    "libigl principal_curvature, radius 2": lambda: igl_principal(2),
    "trimesh curvature": trimesh_measures,
    "pyvista curvature": pyvista_filter,
    "pymeshlab, Taubin": lambda: meshlab("Taubin approximation"),
    "pymeshlab, Normal Cycles": lambda: meshlab("Normal Cycles"),
    "pymeshlab, Quadric Fitting": lambda: meshlab("Quadric Fitting"),
}
CLOUDS = {
    "gaussmap": lambda: ours(),
    "Open3D covariances, best scale": open3d_covariances,
    "pgeof surface variation, best scale": pgeof_variation,
}


def available(makers):
    out = {}
    for name, make in makers.items():
        try:
            out[name] = make()
        except ImportError as problem:
            print(f"({name}: not installed: {problem})")
    return out


def error(found, truth, scaled):
    found = np.where(np.isfinite(found), found, 0)
    if scaled:
        found = found * (found @ truth) / (found @ found)
    return math.sqrt(np.mean((found - truth) ** 2) / np.mean(truth**2))


def fastest_of_a_turn(run, v, f):
    fastest, begin = math.inf, time.perf_counter()
    while fastest == math.inf or time.perf_counter() - begin < TURN_SECONDS:
        start = time.perf_counter()
        found = run(v, f)
        fastest = min(fastest, time.perf_counter() - start)
    return fastest, found


def table(title, runs, v, f, truth):
    print(f"\n**{title}**\n\n| | relative RMSE | ms | × gaussmap |\n|---|---|---|---|")
    times, errors = {name: math.inf for name in runs}, {}
    for _ in range(TURNS):
        for name, run in runs.items():
            try:
                seconds, found = fastest_of_a_turn(run, v, f)
            except Exception as problem:  # a peer may refuse its own input
                errors[name] = f"{type(problem).__name__}"
                continue
            times[name] = min(times[name], seconds)
            values = np.asarray(found, float)
            made = np.isfinite(values) & (values != 0)
            errors[name] = f"{error(values, truth, 'best scale' in name):.5f}" if made.any() else "no values"
    for name in runs:
        ratio = times[name] / times["gaussmap"]
        print(f"| {name} | {errors[name]} | {1e3 * times[name]:.1f} | {ratio:.1f} |")


def main():
    shapes = {
        "torus 1, 0.5, 200 × 100": gaussmap.shapes.torus(around=200, across=100),
        "knot (2, 3), 600 × 40": gaussmap.shapes.knot(around=600, across=40),
        "torus, vertices moved by a quarter of the grid": gaussmap.shapes.torus(
            around=200, across=100, jitter=0.25, seed=1
        ),
    }
    meshes, clouds = available(MESHES), available(CLOUDS)
    for name, shape in shapes.items():
        table(f"Mesh: {name}", meshes, shape.vertices, shape.faces, shape.density)
    for name, shape in shapes.items():
        table(f"Cloud: {name}", clouds, shape.vertices, None, shape.density)


if __name__ == "__main__":
    main()
