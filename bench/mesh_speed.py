"""mesh_speed.py BUILD [--repeat N] [--only TEXT]: seconds of `--estimator auto` on meshes against libigl's
principal_curvature with its own radius (5), on the meshes of accuracy.py, clean and noisy.

Both on one thread of one core, turn by turn, the fastest of N (3). Processor time, so that other programs do not count:
of ours the part that its report gives to the curvature, reading left out; of libigl the call alone. Nothing is timed
where ours is far from the truth. Prints microseconds a vertex, the ratio, both relative RMSEs, and the geometric means of the ratios.
"""

import argparse
import json
import math
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parent
KINDS = ["regular", "jittered", "n0.5", "n1", "n2"]


def libigl(path):
    """Prints seconds and relative RMSE; for the Python that has libigl."""
    import igl
    import numpy as np

    from judge import read_shape

    vertices, faces, _, truth = read_shape(path)
    faces = faces.astype(np.int64)
    start = time.process_time()
    k1, k2 = igl.principal_curvature(vertices, faces)[2:4]
    seconds = time.process_time() - start
    error = np.sqrt(np.sum((k1 * k1 + k2 * k2 - truth) ** 2) / np.sum(truth**2))
    print(json.dumps({"seconds": seconds, "error": float(error), "vertices": len(vertices)}))


def run_libigl(python, file):
    done = subprocess.run([python, __file__, "--libigl", file], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def run_ours(program, file):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "curvature", file, "--as", "mesh", "--normals", "estimate", "--estimator", "auto",
                           "--threads", "1", "--json", "--truth", "exact_density"],
                          check=True, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    report = json.loads(done.stdout)
    parts = report["seconds"]
    share = sum(parts[part] for part in ("neighbors", "normals", "curvature")) / parts["total"]
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"seconds": share * processor, "error": report["truth"]["relative_rmse"], "vertices": report["vertices"]}


def faster(found, so_far):
    return found if so_far is None or found["seconds"] < so_far["seconds"] else so_far


def main():
    if sys.argv[1:2] == ["--libigl"]:
        return libigl(sys.argv[2])
    from accuracy import SURFACES, Bench, geometric_mean

    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("build", type=Path)
    line.add_argument("--repeat", type=int, default=3)
    line.add_argument("--only", default="", help="meshes whose name, as waves_n1, contains this")
    options = line.parse_args()
    bench = Bench(options.build.resolve(), quick=True)
    if bench.python is None:
        return 1
    chosen = [(kind, name) for kind in KINDS for name in SURFACES if options.only in f"{name}_{kind}"]
    if not chosen:
        sys.exit(f"mesh_speed: no mesh has {options.only!r} in its name")
    bench.make_shapes(1, [name for name in SURFACES if any(name == other for _, other in chosen)])
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    print("| mesh | ours, µs a vertex | libigl | ours / libigl | relative RMSE | libigl |\n|---|---|---|---|---|---|")
    means = []
    for kind in KINDS:
        ratios = []
        for name in (name for of, name in chosen if of == kind):
            file = bench.shapes / "meshes" / f"{name}_{kind}.ply"
            ours = peer = None
            for _ in range(options.repeat):
                ours = faster(run_ours(bench.program, file), ours)
                peer = faster(run_libigl(bench.python, file), peer)
                if not ours["error"] < 1 or not math.isfinite(peer["error"]):
                    sys.exit(f"mesh_speed: {file.name}: relative RMSE {ours['error']}, libigl's {peer['error']}")
            ratios.append(ours["seconds"] / peer["seconds"])
            rates = [1e6 * found["seconds"] / found["vertices"] for found in (ours, peer)]
            print(f"| {name} {kind} | {rates[0]:.1f} | {rates[1]:.1f} | {ratios[-1]:.2f} | {ours['error']:.3g} | "
                  f"{peer['error']:.3g} |", flush=True)
        if ratios:
            means.append(f"{kind}: geometric mean {geometric_mean(ratios):.2f}, largest {max(ratios):.2f}")
    print("\n" + "\n".join(means))
    return 0


if __name__ == "__main__":
    sys.exit(main())
