"""peers.py PROGRAMS FROM TO [--count N] [--rounds N]: closest points and Hausdorff distances, ours against libigl, Open3D
and MeshLab, on one core, in rounds that take turns; processor seconds, the fastest round of each.

Ours and the peers answer the same queries: random points on FROM, the closest of TO. Before anything is timed the answers
are compared with libigl's (double precision) and Open3D's (single precision).
"""

import argparse
import importlib.metadata
import json
import math
import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["IGL_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np  # noqa: E402


def timed(work):
    begin = time.process_time()
    result = work()
    return result, time.process_time() - begin


class Libigl:
    name = "libigl " + importlib.metadata.version("libigl")

    def __init__(self, vertices, faces, queries):
        self.vertices, self.faces, self.queries = vertices, faces.astype(np.int64), queries

    def measure(self):
        import igl

        tree = igl.AABB()
        _, build = timed(lambda: tree.init(self.vertices, self.faces))
        found, ask = timed(lambda: tree.squared_distance(self.vertices, self.faces, self.queries))
        return np.sqrt(found[0] if isinstance(found, tuple) else found), build, ask


class Open3d:
    name = "Open3D " + importlib.metadata.version("open3d")

    def __init__(self, vertices, faces, queries):
        self.vertices, self.faces = vertices.astype(np.float32), faces.astype(np.uint32)
        self.queries = queries.astype(np.float32)

    def measure(self):
        import open3d

        scene = open3d.t.geometry.RaycastingScene(nthreads=1)

        def make():
            scene.add_triangles(open3d.core.Tensor(self.vertices), open3d.core.Tensor(self.faces))
            scene.compute_distance(open3d.core.Tensor(self.queries[:1]), nthreads=1)  # the first query builds

        _, build = timed(make)
        found, ask = timed(lambda: scene.compute_distance(open3d.core.Tensor(self.queries), nthreads=1).numpy())
        return found, build, ask


class Ours:
    name = "gaussmap"

    def __init__(self, program):
        self.program = program

    def measure(self):
        self.program.stdin.write("again\n")
        self.program.stdin.flush()
        return (None, *map(float, self.program.stdout.readline().split()))


def closest(arguments, folder):
    command = [arguments.programs / "bench/closest", arguments.source, arguments.target, str(arguments.count), folder]
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "ready\n"
    vertices = np.fromfile(f"{folder}/vertices.f64").reshape(-1, 3)
    faces = np.fromfile(f"{folder}/faces.i32", np.int32).reshape(-1, 3)
    queries = np.fromfile(f"{folder}/queries.f64").reshape(-1, 3)
    contestants = [Ours(program), Libigl(vertices, faces, queries), Open3d(vertices, faces, queries)]
    answers, seconds = {}, {c.name: [] for c in contestants}
    for _ in range(arguments.rounds):
        for contestant in contestants:
            answers[contestant.name], build, ask = contestant.measure()
            seconds[contestant.name].append((ask, build))
    program.communicate()
    ours = np.fromfile(f"{folder}/distances.f64")
    diagonal = np.linalg.norm(vertices.max(0) - vertices.min(0))
    print(f"{len(queries):,} queries, {len(faces):,} triangles\n")
    print("| | ask, s | M/s | make, s | × ours | largest difference from ours, of the diagonal |")
    print("|---|---|---|---|---|---|")
    best = min(seconds["gaussmap"])[0]
    for contestant in contestants:
        ask, build = min(seconds[contestant.name])
        other = answers[contestant.name]
        apart = "" if other is None else f"{np.abs(other - ours).max() / diagonal:.1e}"
        print(f"| {contestant.name} | {ask:.3f} | {len(queries) / ask / 1e6:.2f} | {build:.3f} | {ask / best:.1f} | {apart} |")
        assert other is None or np.abs(other - ours).max() < (1e-9 if "igl" in contestant.name else 1e-5) * diagonal


def meshlab(arguments):
    """MeshLab's Hausdorff filter both ways, from samples on faces alone, as our mean and RMS are."""
    import pymeshlab

    command = [arguments.programs / "gaussmap", "compare", arguments.source, arguments.target]
    ours = json.loads(subprocess.check_output(
        [*command, "--samples", str(arguments.count), "--json", "--bound", "--threads", "1"], text=True))
    meshes = pymeshlab.MeshSet()
    for path in (arguments.source, arguments.target):
        meshes.load_new_mesh(str(path))
        meshes.meshing_remove_unreferenced_vertices()  # which it would sample: they are no part of a surface
    print("\n| | | max | RMS | mean | s |\n|---|---|---|---|---|---|")
    name = "MeshLab " + importlib.metadata.version("pymeshlab")
    for way, one, other in (("forward", 0, 1), ("backward", 1, 0)):
        options = {"sampledmesh": one, "targetmesh": other, "samplenum": arguments.count,
                   "maxdist": pymeshlab.PercentageValue(100)}
        (faces, seconds) = timed(lambda: meshes.get_hausdorff_distance(samplevert=False, sampleface=True, **options))
        all_kinds = meshes.get_hausdorff_distance(samplevert=True, sampleedge=True, sampleface=True, **options)
        theirs = {"max": all_kinds["max"], "rms": faces["RMS"], "mean": faces["mean"]}
        theirs = {key: value / ours["diagonal"] for key, value in theirs.items()}
        for label, row in ((f"gaussmap, {way}", ours[way]), (f"{name}, {way}", theirs)):
            spent = ours["seconds"]["compare"] / 2 if row is ours[way] else seconds
            print(f"| {label} | | {row['max']:.6g} | {row['rms']:.6g} | {row['mean']:.6g} | {spent:.2f} |")
        bound = ours["bound"][way]
        print(f"| gaussmap --bound, {way} | | {bound['lower']:.6g} to {bound['upper']:.6g} | | | |")
        # Theirs are in single precision, and independent samples: five standard errors of their mean.
        assert theirs["max"] <= bound["upper"] * (1 + 1e-5) + 1e-6
        spread = math.sqrt(max(0, ours[way]["rms"] ** 2 - ours[way]["mean"] ** 2) / arguments.count)
        assert abs(theirs["mean"] - ours[way]["mean"]) <= 5 * spread + 1e-6, (way, theirs["mean"], ours[way]["mean"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("target", type=Path)
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    with tempfile.TemporaryDirectory() as folder:
        closest(arguments, folder)
    meshlab(arguments)


if __name__ == "__main__":
    main()
