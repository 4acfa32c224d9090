"""The paper's tables of point clouds: a torus and tubes around a (2,3) and a figure-eight knot."""

import math
import subprocess

from accuracy import APSS, JETS, best_jets
from runs import BENCH
from table import Check, Table, Value, number

SURFACES = {"torus5": "torus, R = 1, r = 0.5", "knot23": "tube around the (2,3) torus knot",
            "fig8": "tube around the figure-eight knot"}
SAMPLINGS = ["uniform", "nonuniform", "sparse"]
# What the paper prints for its torus; it samples a mesh of it, we the torus.
PAPER = {"the paper, ground-truth normals": [0.0219, 0.0367, 0.0548],
         "the paper, estimated normals": [0.814, 1.345, 0.650]}
FAN = ["--estimator", "dirichlet"]
RECIPE = ["--normals", "pca", "--orient", "mst", *FAN]
DEFAULT = "ours: default"
OURS = {
    "ours: fan, ground-truth normals, k 20": ["--normals", "file", "--k", "20", *FAN],
    "ours: fan, ground-truth normals, k 10": ["--normals", "file", "--k", "10", *FAN],
    "the paper's recipe (PCA, spanning tree, fan), k 20": [*RECIPE, "--k", "20"],
    "the paper's recipe (PCA, spanning tree, fan), k 10": [*RECIPE, "--k", "10"],
    DEFAULT: ["--normals", "estimate"],
}
JET_FAN = {"ours: fan, quadratic-jet normals, k 10": ["--normals", "jet", "--degree", "2", "--k", "10", *FAN]}
PCL = {False: ["10", "15", "20", "30", "50"], True: ["10", "20", "50"]}
VCM = {False: ["2:4", "4:4", "4:6", "8:4", "8:6", "8:8", "12:8"], True: ["2:4", "4:6", "8:6"]}
FIXED_JETS = ["2:10", "2:20"]
SCREENED = 400


def best(rows, key):
    return min((row for row in rows if math.isfinite(key(row))), key=key, default=None)


def jets(runs, file):
    """Jobs on all points: the settings shown always, and the two best of the grid on a part of the points."""
    program = runs.tools / "cgal_jets"
    screened = runs.peer_rows([[program, file, SCREENED, *JETS["clean"].split()]])[0]
    return [program, file, 2500 if runs.quick else 0, *dict.fromkeys([*FIXED_JETS, *best_jets(screened)])]


def put_peers(table, column, rms, pcl, vcm, of_jets, apss):
    def put(name, row, relative):
        if row is not None:
            table.put(name, column, Value(relative * rms, relative, row.parameter, row.seconds))

    for what in ("pc1+pc2", "pc1^2+pc2^2"):
        rows = [row for row in pcl if row.peer.endswith(what)]
        for row in rows:
            if row.parameter in ("k 10", "k 20"):
                put(f"{row.peer}, rescaled, {row.parameter}", row, row.rescaled)
        for scaled, key in (("rescaled", lambda row: row.rescaled), ("as it is", lambda row: row.error)):
            row = best(rows, key)
            if row is not None:
                put(f"{row.peer}, {scaled}, best k", row, key(row))
    for scaled, key in (("as it is", lambda row: row.error), ("rescaled", lambda row: row.rescaled)):
        row = best(vcm, key)
        if row is not None:
            put(f"{row.peer}, {scaled}, best radii", row, key(row))
    for row in of_jets:
        if row.parameter in ("degree 2 k 10", "degree 2 k 20"):
            put(f"{row.peer}, {row.parameter}", row, row.error)
    for rows, parameter in ((of_jets, "best degree and k"), (apss, "best k and scale")):
        row = best(rows, lambda row: row.error)
        if row is not None:
            put(f"{row.peer}, {parameter}", row, row.error)


def open3d_normals(runs, file, k):
    """The cloud with Open3D's normals, or None."""
    out = runs.folder / "shapes" / f"{file.stem}_open3d.ply"
    script = BENCH / "cloud_curvature/open3d_normals.py"
    if runs.python is None or subprocess.run([runs.python, script, file, out, str(k)]).returncode != 0:
        return None
    return out


def tables(runs):
    folder = runs.folder / "surfaces"
    subprocess.run([runs.tools / "surfaces", folder, "1", *SURFACES], check=True)
    version = runs.version("open3d")
    out = []
    for name, title in SURFACES.items():
        table = Table(f"Cloud: {title}", SAMPLINGS, cell=shown)
        if name == "torus5":
            for row, errors in PAPER.items():
                for column, error in zip(SAMPLINGS, errors):
                    table.put(row, column, Value(error, parameter="as printed"))
        rms = {}
        files = {column: folder / "clouds" / f"{name}_{column}.ply" for column in SAMPLINGS}
        for column, file in files.items():
            for row, options in (OURS | JET_FAN).items():
                rmse, relative, seconds = runs.judged(file, "cloud", *options)
                table.put(row, column, Value(rmse, relative, " ".join(options), seconds))
                rms[column] = rmse / relative
            oriented = open3d_normals(runs, file, 20)
            if oriented is not None:
                rmse, relative, seconds = runs.judged(oriented, "cloud", "--normals", "file", "--k", "20", *FAN)
                table.put(f"Open3D {version}: PCA normals, spanning tree; our fan on them, k 20", column, Value(rmse, relative, "k 20", seconds))
        points = "625" if runs.quick else "2500"
        jobs = []
        for file in files.values():
            apss = BENCH / "cloud_curvature/meshlab_apss.py"
            jobs += [[runs.tools / "pcl_curvatures", file, "0", *PCL[runs.quick]],
                     [runs.tools / "cgal_vcm", file, *VCM[runs.quick]], jets(runs, file),
                     [runs.python, apss, file, points, *APSS["clean"].split()[: 1 if runs.quick else 3]]]
        rows = runs.peer_rows(jobs)
        for i, column in enumerate(SAMPLINGS):
            put_peers(table, column, rms[column], *rows[4 * i : 4 * i + 4])
        out.append(table)
    return out, checks(out)


def shown(value):
    parameter = value.parameter if value.parameter and "--" not in value.parameter else ""
    parameter = "" if parameter == "as printed" else parameter
    relative = f" ({number(value.relative)})" if math.isfinite(value.relative) else ""
    return number(value.error) + relative + (f"<br>{parameter}" if parameter else "")


def checks(of):
    def errors(row, samplings=SAMPLINGS):
        return [table.rows[row][column].relative for table in of for column in samplings]

    exact = max(max(errors(name, ["uniform", "nonuniform"])) for name in OURS if "ground-truth" in name and "20" in name)
    recipe = min(a / b for a, b in zip(errors("the paper's recipe (PCA, spanning tree, fan), k 20"), errors(DEFAULT)))
    ratios = []
    for table in of:
        for column in SAMPLINGS:
            peers = [values[column].relative for name, values in table.rows.items()
                     if not name.startswith(("ours", "the ")) and column in values]
            ratios.append(table.rows[DEFAULT][column].relative / min(peers) if peers else math.nan)
    return [
        Check("clouds, ground-truth normals, uniform and nonuniform: relative RMSE ≤ 0.02", f"at most {exact:.4f}",
              exact <= 0.02),
        Check("clouds, estimated normals: our default far below the paper's recipe", f"at least {recipe:.0f} × lower",
              recipe >= 5),
        Check("clouds, estimated normals: our default ≤ 1.1 × the best peer at its best parameters, each cell",
              f"at most {max(ratios):.2f} ×", max(ratios) <= 1.1),
    ]
