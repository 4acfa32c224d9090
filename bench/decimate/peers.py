"""peers.py PEER IN.ply OUT_PREFIX FACES…: decimate a mesh with one Python peer, to each number of faces.

Prints one line a result, tab-separated: peer, version, parameters, faces asked for, faces made, seconds, file written.
"""

import importlib.metadata
import sys
import time

import numpy as np


def load(path):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix().copy(), mesh.face_matrix().astype(np.int32)


def save(path, vertices, faces):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        np.savetxt(file, vertices, "%.17g")
        np.savetxt(file, np.column_stack([np.full(len(faces), 3), faces]), "%d")


def vcg(vertices, faces, target, **options):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    begin = time.perf_counter()
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=target, **options)
    seconds = time.perf_counter() - begin
    mesh = meshes.current_mesh()
    return seconds, mesh.vertex_matrix(), mesh.face_matrix()


def meshoptimizer(vertices, faces, target):
    import meshoptimizer as library

    points, indices, out = vertices.astype(np.float32), faces.astype(np.uint32).ravel(), np.zeros(faces.size, np.uint32)
    begin = time.perf_counter()
    count = library.simplify(out, indices, points, target_index_count=3 * target, target_error=1e9)
    seconds = time.perf_counter() - begin
    return seconds, vertices, out[: count if np.isscalar(count) else count[0]].reshape(-1, 3)


def fast_simplification(vertices, faces, target):
    import fast_simplification as library

    begin = time.perf_counter()
    out = library.simplify(vertices, faces, target_count=target)
    return time.perf_counter() - begin, *out[:2]


def pyfqmr(vertices, faces, target):
    import pyfqmr as library

    begin = time.perf_counter()
    simplifier = library.Simplify()
    simplifier.setMesh(vertices, faces)
    simplifier.simplify_mesh(target_count=target, aggressiveness=3, preserve_border=False, verbose=False)
    seconds = time.perf_counter() - begin
    return seconds, *simplifier.getMesh()[:2]


def open3d(vertices, faces, target):
    import open3d as library

    mesh = library.geometry.TriangleMesh(
        library.utility.Vector3dVector(vertices), library.utility.Vector3iVector(faces)
    )
    begin = time.perf_counter()
    out = mesh.simplify_quadric_decimation(target)
    seconds = time.perf_counter() - begin
    return seconds, np.asarray(out.vertices), np.asarray(out.triangles)


def libigl(vertices, faces, target):
    import igl

    begin = time.perf_counter()
    out = [part for part in igl.qslim(vertices, faces.astype(np.int64), target) if np.ndim(part) == 2]
    return time.perf_counter() - begin, out[0], out[1]


PEERS = {
    "vcg": ("pymeshlab", "preservenormal=True", lambda v, f, n: vcg(v, f, n, preservenormal=True)),
    "vcg-quality": (
        "pymeshlab",
        "preservenormal=True, qualitythr=1, planarquadric=True",
        lambda v, f, n: vcg(v, f, n, preservenormal=True, qualitythr=1, planarquadric=True),
    ),
    "meshoptimizer": ("meshoptimizer", "target_error=1e9", meshoptimizer),
    "fast-simplification": ("fast-simplification", "defaults", fast_simplification),
    "pyfqmr": ("pyfqmr", "aggressiveness=3", pyfqmr),
    "open3d": ("open3d", "defaults", open3d),
    "libigl": ("libigl", "qslim", libigl),
}


def main():
    peer, source, prefix, *targets = sys.argv[1:]
    package, parameters, simplify = PEERS[peer]
    version = importlib.metadata.version(package)
    vertices, faces = load(source)
    for target in map(int, targets):
        seconds, v, f = simplify(vertices.copy(), faces.copy(), target)
        path = f"{prefix}{peer}_{target}.off"
        save(path, v, f)
        print(peer, version, parameters, target, len(f), f"{seconds:.4f}", path, sep="\t", flush=True)


main()
