"""components.py BUILD FOLDER: libigl's own octree, search and triangulation, what the author's program is made of, on the cloud
and the neighbourhoods of `cloud_speed author`: the same results, and microseconds of work a point beside those of the parts
built like them.

Python's calls are taken off: of the search a call for one point, which reads the octree as a list of lists; of the triangulation
a call for three points. What making those lists costs `octree` is in its figure. Everything runs on one core, and processor
time is counted, since libigl's search takes threads where it may."""

import os
import subprocess
import sys
import time
from pathlib import Path

import igl
import igl.copyleft.cgal
import numpy as np

POINTS, QUERIES, K, TURNS = 1_000_000, 5_000, 20, 3


def least_work(run, turns=TURNS):
    """The result, and the least processor time in microseconds."""
    least = np.inf
    for _ in range(turns):
        start = time.process_time()
        result = run()
        least = min(least, time.process_time() - start)
    return result, 1e6 * least


def canonical(triangles):
    return sorted(map(tuple, np.sort(triangles, axis=1)))


def must(holds, what):
    if not holds:
        sys.exit(f"components.py: {what}")


def main():
    build, folder = Path(sys.argv[1]), Path(sys.argv[2])
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    rebuilt = []
    for _ in range(TURNS):
        subprocess.run([build / "bench/cloud_speed", "author", folder, str(POINTS), str(QUERIES), str(K)], check=True)
        rebuilt.append(np.fromfile(folder / "work.f64"))
    rebuilt = np.min(rebuilt, axis=0)
    points = np.asfortranarray(np.fromfile(folder / "points.f64").reshape(-1, 3))
    neighbors = np.fromfile(folder / "neighbors.i32", dtype=np.int32).reshape(-1, K)
    planes = np.asfortranarray(np.fromfile(folder / "planes.f64")).reshape(-1, K, 2)
    counts = np.fromfile(folder / "triangle_counts.i32", dtype=np.int32)
    triangles = np.split(np.fromfile(folder / "triangles.i32", dtype=np.int32).reshape(-1, 3), np.cumsum(counts)[:-1])

    tree, octree = least_work(lambda: igl.octree(points), 1)
    queries = np.asfortranarray(points[: len(neighbors)])
    search_of = lambda some: least_work(lambda: igl.knn(some, points, K, *tree))
    found, search = search_of(queries)
    _, one = search_of(queries[:1])
    must((found == neighbors).all(), "igl.knn has other neighbours")

    corner = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    delaunay = igl.copyleft.cgal.delaunay_triangulation
    made, triangulation = least_work(lambda: [delaunay(plane) for plane in planes])
    _, call = least_work(lambda: [delaunay(corner) for _ in planes])
    must(all(canonical(a) == canonical(b) for a, b in zip(made, triangles, strict=True)), "other triangulations")

    theirs = octree / len(points), (search - one) / (len(queries) - 1), (triangulation - call) / len(planes)
    print(f"\nThe same {K} neighbours and the same triangles at {len(queries)} of {len(points)} points.\n")
    print("| microseconds of work a point | libigl | built like it |\n|---|---|---|")
    for name, a, b in zip(("octree", "search", "Delaunay triangulation"), theirs, rebuilt, strict=True):
        print(f"| {name} | {a:.1f} | {b:.1f} |")
    print(f"\nTaken off: {one / 1e6:.2f} s a call of the search, {call / len(planes):.1f} a call of the triangulation.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
