"""The paper's table of spheres and tori, and the same surfaces made irregular and noisy."""

import math

from runs import BENCH
from table import Check, Table, Value, number

PAPER = {"torus 9 × 9": 0.4759, "torus 18 × 18": 0.1425, "torus 36 × 36": 0.0372}
SPHERES, TORI = (4, 5, 6), (9, 18, 36)
OURS = {
    "ours: `dirichlet`, exact normals (the paper's method)": ["--normals", "file", "--estimator", "dirichlet"],
    "ours: `dirichlet` (default of meshes)": ["--normals", "estimate", "--estimator", "dirichlet"],
    "ours: `corrected`": ["--normals", "estimate", "--estimator", "corrected"],
    "ours: `auto`": ["--normals", "estimate", "--estimator", "auto"],
}
MORE_OF_OURS = {
    "ours: `jet`": ["--normals", "estimate", "--estimator", "jet"],
    "ours: `regression`": ["--normals", "estimate", "--estimator", "regression"],
}
KINDS = {"jittered": ["--jitter", "0.25"], "noise 0.5 %": ["--jitter", "0.25", "--noise", "0.005"],
         "noise 2 %": ["--jitter", "0.25", "--noise", "0.02"]}


def knows_the_truth(row):
    return "exact normals" in row or row.startswith("the paper")


def fill(table, runs, files, settings, radii):
    """Rows of ours and of the peers for {column: file}."""
    rms = {}
    for column, file in files.items():
        for name, options in settings.items():
            rmse, relative, seconds = runs.judged(file, "mesh", *options)
            table.put(name, column, Value(rmse, relative, " ".join(options), seconds))
            if relative > 0:
                rms[column] = rmse / relative
    peers = BENCH / "mesh_curvature/peers.py"
    jobs = [[runs.python, peers, file, *radii] for file in files.values()]
    for column, rows in zip(files, runs.peer_rows(jobs)):
        for row in rows:
            value = Value(row.error * rms[column], row.error, row.parameter, row.seconds)
            table.put(f"{row.peer}, {row.parameter}", column, value)


def sphere_and_torus(runs):
    files = {f"sphere {s}": runs.shape(f"sphere{s}", "sphere", "--subdivisions", s) for s in SPHERES}
    files |= {f"torus {n} × {n}": runs.shape(f"torus{n}", "torus", "--grid", f"{n}x{n}") for n in TORI}
    table = Table("Spheres and tori", list(files), text="""RMSE of the density of a vertex against the exact one there.
Unit spheres are icosahedra split in four 4, 5 and 6 times (density 2), the torus has R = 1, r = 0.5.""")
    for column in files:
        table.put("the paper, its own method", column, Value(PAPER.get(column, 0.0), parameter="as printed"))
    fill(table, runs, files, OURS, ["2", "5"])
    name = next(iter(OURS))
    ours = [table.rows[name][column].error for column in files]
    paper = [table.rows["the paper, its own method"][column].error for column in files]
    same = all(abs(a - b) <= 0.5001e-4 for a, b in zip(ours, paper))
    check = Check("spheres and tori, exact normals: the paper's numbers to four digits",
                  ", ".join(f"{value:.4f}" for value in ours), same)
    return table, check


def irregular(runs):
    size = 4 if runs.quick else 5
    surfaces = {f"sphere {size}": ["sphere", "--subdivisions", size], "torus 36 × 36": ["torus", "--grid", "36x36"]}
    if not runs.quick:
        surfaces["torus 72 × 72"] = ["torus", "--grid", "72x72"]
    files = {f"{name}, {kind}": runs.shape(f"{name}_{kind}".replace(" ", ""), *options, *more)
             for name, options in surfaces.items() for kind, more in KINDS.items()}
    table = Table("Irregular and noisy spheres and tori", list(files), cell=lambda value: number(value.relative),
                  text="""RMSE of the density relative to the RMS of the exact one. Vertices are moved along the surface by up to a quarter of
the edge; noise is Gaussian, relative to the mean edge. Rows with *exact normals* are told a truth that nobody has who measures.""")
    fill(table, runs, files, OURS | MORE_OF_OURS, ["2", "3", "5"])
    worst = 0
    for column in files:
        others = [values[column].relative for name, values in table.rows.items()
                  if not knows_the_truth(name) and column in values and "`auto`" not in name]
        lowest = min((error for error in others if math.isfinite(error)), default=math.nan)
        auto = table.rows["ours: `auto`"][column].relative
        # Below 1e-9 both are rounding.
        worst = max(worst, auto / lowest if auto > 1e-9 else 0)
    check = Check("irregular and noisy meshes: `auto` lowest, or within 10 % of the lowest",
                  f"at most {worst:.2f} × the lowest of all others", worst <= 1.1)
    return table, check
