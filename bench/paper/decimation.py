"""The paper's decimation table: both of its pipelines with and without curvature weights, our default, and peers."""

import math
import shutil

from decimate import Bench, geometric_mean
from runs import DATA
from table import Check, Table, Value

MESHES = {"bunny": "seed/bunny.ply", "cow": "seed/cow.ply", "armadillo": "classic/armadillo.off"}
RATIOS = [0.1, 0.05, 0.02]
PEERS = ["libigl", "vcg", "open3d"]
NAMES = {"libigl": "libigl {} qslim", "vcg": "MeshLab {}", "open3d": "Open3D {}", "cgal-lt": "CGAL {} Lindstrom–Turk",
         "meshoptimizer-npm": "meshoptimizer {}",
         "meshoptimizer-moving": "meshoptimizer {} with moving vertices", "cgal-gh": "CGAL {} Garland–Heckbert", "openmesh": "OpenMesh {}"}
OURS = {
    "shortest edge to its midpoint": ["--method", "edge", "--weight", "none"],
    "the same, weighted by curvature (the paper's first)": ["--method", "edge"],
    "quadrics": ["--method", "qem", "--weight", "none"],
    "quadrics weighted by curvature (the paper's second)": ["--method", "qem"],
    "ours: default": [],
}
AXES = {"RMS": 0, "maximum": 1}


def tables(runs):
    """A table of RMS and of maxima, and the check; none where the paper's meshes are not there."""
    names = [name for name in MESHES if not (runs.quick and name == "bunny")]
    missing = [name for name in names if not (DATA / "meshes" / MESHES[name]).exists()]
    if missing:
        print(f"paper: no decimation table: {', '.join(missing)} not in ../shared/data/meshes", flush=True)
        return [], []
    folder = runs.folder / "decimation"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    bench = Bench(runs.build, folder, runs.python, PEERS)
    text = ("Two-sided {} of `gaussmap compare` to the original over the diagonal of its box, × 10⁻⁵. The paper states\n"
            "neither ratio nor normalisation, so its numbers have no column: it is its claim that is tried.")
    columns = [f"{name} {100 * ratio:g} %" for name in names for ratio in RATIOS]
    out = {axis: Table(f"Decimation: {axis}", columns, text=text.format(axis), cell=shown)
           for axis in AXES}
    for name in names:
        for (mesh,), ratio, target, results in bench.cells(DATA / "meshes" / MESHES[name], RATIOS, 1):
            versions = bench.versions()
            rows = {NAMES[peer].format(versions[peer]): (result, "") for peer, result in results.items()}
            for row, options in OURS.items():
                rows[row] = bench.ours(mesh, target, options), " ".join(options)
            for row, (result, parameter) in sorted(rows.items(), key=lambda item: item[0] not in OURS):
                for axis, index in AXES.items():
                    out[axis].put(row, f"{name} {100 * ratio:g} %", Value(result[index], math.nan, parameter, result[2]))
    return list(out.values()), checks(out["maximum"], out["RMS"])


def shown(value):
    return f"{value.error:.1f}" if value.error < 100 else f"{value.error:.0f}"


def checks(maximum, rms):
    rows = list(OURS)
    out = []
    for plain, weighted in ((rows[0], rows[1]), (rows[2], rows[3])):
        def mean(table):
            return geometric_mean([table.rows[weighted][c].error / table.rows[plain][c].error for c in table.columns])

        out.append(Check(f"curvature weights lower the maximum in the mean: {plain}",
                         f"{mean(maximum):.2f} × (RMS {mean(rms):.2f} ×)", mean(maximum) < 1))
    for table in (rms, maximum):
        ratios = []
        for column in table.columns:
            peers = [values[column].error for row, values in table.rows.items() if row not in OURS and column in values]
            ratios += [table.rows["ours: default"][column].error / min(peers)] if peers else []
        mean = geometric_mean(ratios)
        out.append(Check(f"{table.title}: our default against the best peer of each cell, geometric mean ≤ 0.90 ×",
                         f"{mean:.2f} ×", mean <= 0.9))
    return out
