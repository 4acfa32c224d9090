"""accuracy.py BUILD [--quick] [--only TEXT]: the program against its peers on analytic surfaces, by cell.

A cell is a surface with a sampling (clouds) or a kind (meshes), written by BUILD/bench/surfaces; the measure is the
relative RMSE of the density, RMSE / RMS(truth), the mean over the seeds (three; --quick: one). Each peer runs over a
grid of its parameters and is judged by the truth: CGAL's jets first on a few of the points, then their two best settings
on all (--quick: on a larger part, as MeshLab's APSS always is). The best of them all is what our defaults, which do not
know the truth, are compared with.

Prints the tables and writes them to BUILD/bench/accuracy.md, every row of every peer to BUILD/bench/accuracy.csv.
Rows of peers are kept in BUILD/bench/peers and made again when the peer's program or its parameters change.
"""

import argparse
import csv
import hashlib
import json
import math
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

from environment import python_of_peers

SOURCE = Path(__file__).resolve().parent
SURFACES = ["torus5", "torus7", "knot23", "knot35", "fig8", "ell", "bumpy", "cube", "waves", "catenoid", "monkey"]
CLEAN = ["uniform", "nonuniform", "sparse"]
NOISY = ["n0.1", "n0.2", "n0.5", "n1"]
MESHES = ["regular", "anisotropic", "jittered", "n0.5", "n1", "n2"]

# Degree:k of CGAL's jets; k of PCL; normals' k:scale of MeshLab's APSS; rings of libigl.
JETS = {
    "clean": "2:8 2:10 2:15 2:20 3:12 3:15 3:20 3:30 4:20 4:25 4:30 4:50",
    "n0.1": "2:20 2:30 2:50 2:100 3:30 3:50 3:100 4:50 4:100 4:200",
    "n0.2": "2:30 2:50 2:100 2:200 3:50 3:100 3:200 4:100 4:200 4:300",
    "n0.5": "2:50 2:100 2:200 2:300 2:500 3:100 3:200 3:300 4:200 4:300 4:500",
    "n1": "2:100 2:200 2:300 2:500 2:700 3:200 3:300 3:500 4:300 4:500",
}
PCL = {"clean": "10 15 20 30 50", "noisy": "20 50 100 200 300"}
APSS = {
    "clean": "10:2 10:3 10:4 20:4",
    "n0.1": "50:7 50:9 50:12 50:16 100:16 100:20",
    "n0.2": "50:6 50:9 50:12 50:16 100:12 100:16 100:20",
    "n0.5": "50:8 50:12 100:16 100:20 200:20 200:24",
    "n1": "50:12 100:16 100:20 200:20 200:24",
}
RINGS = {"clean": "2 3 4 5", "n0.5": "2 3 4 5 6", "n1": "3 4 5 6 8", "n2": "4 5 6 8 10"}  # 5 is libigl's own

# What our own program is asked for; a word it does not know gives no row. The first is what is judged.
OUR_CLOUDS = {
    "ours, defaults": ["--normals", "estimate"],
    "ours, jet": ["--normals", "estimate", "--estimator", "jet"],
    "ours, regression": ["--normals", "estimate", "--estimator", "regression"],
    "ours, dirichlet": ["--normals", "estimate", "--estimator", "dirichlet"],
    "ours, dirichlet, quadratic jets k 10": ["--normals", "jet", "--degree", "2", "--k", "10", "--estimator",
                                             "dirichlet"],
}
FAN = {"fan, true normals": ["--normals", "file", "--estimator", "dirichlet"]}
OUR_MESHES = {
    "ours, auto": ["--normals", "estimate", "--estimator", "auto"],
    "ours, jet": ["--normals", "estimate", "--estimator", "jet"],
    "ours, regression": ["--normals", "estimate", "--estimator", "regression"],
    "ours, dirichlet": ["--normals", "estimate", "--estimator", "dirichlet"],
    "ours, corrected": ["--normals", "estimate", "--estimator", "corrected"],
    "loop, true normals": ["--normals", "file", "--estimator", "dirichlet"],
    "corrected, true normals": ["--normals", "file", "--estimator", "corrected"],
}
SCREEN, PART = 400, 2500  # points


class Row:
    """One setting of one peer on one file: errors relative to the RMS of the truth, and seconds."""

    def __init__(self, peer, parameter, error, rescaled, undefined, points, seconds):
        self.peer, self.parameter = peer, parameter
        self.error = float(error)
        self.rescaled = float(rescaled) if rescaled else math.nan
        self.undefined, self.points = int(undefined), int(points)
        self.seconds = float(seconds)


def rows_of(text):
    """The rows that a peer's program printed, as judge.h and judge.py do."""
    return [Row(*fields) for fields in csv.reader(text.splitlines()) if len(fields) == 7]


def best_jets(rows):
    """The two best settings of CGAL's jets, as the program takes them: DEGREE:K."""
    best = sorted(rows, key=lambda row: row.error)[:2]
    return [row.parameter.replace("degree ", "").replace(" k ", ":") for row in best]


class Bench:
    def __init__(self, build, quick):
        self.quick = quick
        self.program = build / "gaussmap"
        self.folder = build / "bench"
        self.shapes = self.folder / "shapes"
        self.cache = self.folder / "peers"
        self.cache.mkdir(parents=True, exist_ok=True)
        self.python = python_of_peers(self.folder / "venv", SOURCE / "requirements.txt")

    def make_shapes(self, seed, names):
        """The files of a seed, made where one is missing or the generator's sources changed."""
        key = digest(*sorted((SOURCE / "surfaces").glob("*.*")))
        stamp = self.shapes / f"made_{seed}.txt"
        made = set(stamp.read_text().split()) if stamp.exists() else set()
        wanted = [name for name in names if f"{name}:{key}" not in made]
        if wanted:
            subprocess.run([self.folder / "surfaces", self.shapes, str(seed), *wanted], check=True)
            made |= {f"{name}:{key}" for name in wanted}
            stamp.write_text("\n".join(sorted(made)))

    def rows(self, source, command, file, arguments):
        """What a peer's program prints for a file, from the cache if it was asked before. [] where it is missing."""
        shape_key = digest(*sorted((SOURCE / "surfaces").glob("*.*")))
        key = hashlib.sha256(f"{digest(source)} {shape_key} {file.name} {arguments}".encode()).hexdigest()[:16]
        kept = self.cache / f"{file.stem}_{source.stem}_{key}.csv"
        if not kept.exists():
            if command[0] is None or not Path(command[0]).exists():
                return []
            done = subprocess.run(["nice", *command, file, *arguments], stdout=subprocess.PIPE, text=True)
            if done.returncode != 0:
                print(f"accuracy: {source.name} failed on {file.name}; no rows of it there", file=sys.stderr)
                return []
            kept.write_text(done.stdout)
        return rows_of(kept.read_text())

    def jets(self, file, grid):
        source = SOURCE / "cloud_curvature/cgal_jets.cpp"
        command = [self.folder / "cgal_jets"]
        screened = self.rows(source, command, file, [str(SCREEN), *grid.split()])
        settings = best_jets(screened)
        judged = str(PART if self.quick else 0)
        return self.rows(source, command, file, [judged, *settings]) if settings else []

    def cloud_peers(self, file, sampling):
        clean = sampling in CLEAN
        grid = "clean" if clean else sampling
        pcl = SOURCE / "cloud_curvature/pcl_curvatures.cpp"
        apss = SOURCE / "cloud_curvature/meshlab_apss.py"
        rows = self.jets(file, JETS[grid])
        rows += self.rows(pcl, [self.folder / "pcl_curvatures"], file, ["0", *PCL["clean" if clean else "noisy"].split()])
        # All of the points take APSS many minutes a file.
        return rows + self.rows(apss, [self.python, apss], file, [str(PART), *APSS[grid].split()])

    def mesh_peers(self, file, kind):
        peers = SOURCE / "mesh_curvature/peers.py"
        return self.rows(peers, [self.python, peers], file, RINGS.get(kind, RINGS["clean"]).split())

    def ours(self, file, kind, settings):
        """Our program, never from the cache. A setting it refuses as wrong usage gives no row."""
        rows = []
        for name, options in settings.items():
            command = [self.program, "curvature", file, "--as", kind, *options, "--json", "--truth", "exact_density"]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode != 0:
                continue
            report = json.loads(done.stdout)
            seconds = sum(report["seconds"][part] for part in ("neighbors", "normals", "curvature"))
            rows.append(Row(name, " ".join(options), report["truth"]["relative_rmse"], "", report["undefined"],
                            report["vertices"], seconds))
        return rows


def digest(*paths):
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:12]


def geometric_mean(values):
    values = [value for value in values if value > 0 and math.isfinite(value)]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def mean_over_seeds(rows_of_seeds):
    """{(peer, parameter): mean error} of the settings judged in every seed."""
    errors = defaultdict(list)
    for rows in rows_of_seeds:
        for row in rows:
            errors[row.peer, row.parameter].append(row.error if math.isfinite(row.error) else math.inf)
    return {key: sum(e) / len(e) for key, e in errors.items() if len(e) == len(rows_of_seeds)}


def knows_the_truth(key):
    """Rows that are given exact normals: references, no peers."""
    return "exact normals" in key[1] or key[0].endswith("true normals")


class Cell:
    """A surface and a sampling: our errors and the peers', means over the seeds."""

    def __init__(self, name, ours, peers, fan_is_peer):
        self.name, self.ours_rows, self.peer_rows = name, ours, peers
        self.ours = {key[0]: error for key, error in mean_over_seeds(ours).items()}
        errors = mean_over_seeds(peers)
        # A peer whose two best settings differ between the seeds: each seed's best.
        for peer in {row.peer for rows in peers for row in rows}:
            allowed = [[r.error for r in rows if r.peer == peer and not knows_the_truth((peer, r.parameter))]
                       for rows in peers]
            best = [min(errors_of_seed, default=math.inf) for errors_of_seed in allowed]
            errors.setdefault((peer, "each seed's best"), sum(best) / len(best))
        self.peers = {key: e for key, e in errors.items() if not knows_the_truth(key)}
        if fan_is_peer and "fan, true normals" in self.ours:
            self.peers["fan, true normals", "k 20"] = self.ours["fan, true normals"]
        self.best = min(self.peers, key=self.peers.get) if self.peers else None

    def judged(self):
        """Our error that is judged: the first row our program gave."""
        return next(iter(self.ours.values()), math.nan)

    def best_error(self):
        return self.peers[self.best] if self.best else math.nan

    def ratio(self):
        return self.judged() / self.best_error()


def table(title, cells):
    if not cells:
        return []
    lines = [f"## {title}", "",
             "| cell | ours | best peer | ours / best | which, with what the truth chose | other rows of ours |",
             "|---|---|---|---|---|---|"]
    for cell in cells:
        others = ", ".join(f"{name.removeprefix('ours, ')} {error:.3g}" for name, error in list(cell.ours.items())[1:])
        best = " ".join(cell.best) if cell.best else "none"
        figures = f"{cell.judged():.3g} | {cell.best_error():.3g} | {cell.ratio():.2f}"
        lines.append(f"| {cell.name} | {figures} | {best} | {others} |")
    ratios = [cell.ratio() for cell in cells]
    largest = max(ratios)
    mean = f"Geometric mean of ours / best: **{geometric_mean(ratios):.3f}**"
    return [*lines, "", f"{mean}, largest {largest:.2f}, {len(cells)} cells.", ""]


def mesh_tables(cells):
    """A table a kind of mesh, surfaces across: our estimators with estimated normals, libigl at its best radius."""
    kinds = defaultdict(list)
    for cell in cells:
        kinds[cell.name.split()[1]].append(cell)
    lines = []
    for kind, of_kind in kinds.items():
        def row(name, errors):
            return f"| {name} | " + " | ".join(f"{error:.2g}" for error in errors) + " |"

        lines += [f"| {kind} | " + " | ".join(cell.name.split()[0] for cell in of_kind) + " |"]
        lines += ["|---" * (len(of_kind) + 1) + "|"]
        lines += [row(name.removeprefix("ours, "), [cell.ours.get(name, math.nan) for cell in of_kind])
                  for name in OUR_MESHES if any(name in cell.ours for cell in of_kind)]
        libigl = [min((e for key, e in cell.peers.items() if key[0].startswith("libigl")), default=math.nan)
                  for cell in of_kind]
        lines += [row("libigl, best radius", libigl), ""]
    return lines


def against(title, cells, peer):
    """Ratios to the best row of one peer."""
    ratios = []
    for cell in cells:
        errors = [error for key, error in cell.peers.items() if key[0].startswith(peer)]
        if errors:
            ratios.append(cell.judged() / min(errors))
    if not ratios:
        return []
    mean, largest = geometric_mean(ratios), max(ratios)
    return [f"{title} against {peer} at its best: geometric mean {mean:.3f}, largest {largest:.2f}.", ""]


def against_one_ring(cells):
    """Ratios to the better of the paper's loop and `corrected`, both with estimated normals: what grids are judged by."""
    rings = ("ours, dirichlet", "ours, corrected")
    ratios = [cell.judged() / min(cell.ours[r] for r in rings) for cell in cells if all(r in cell.ours for r in rings)]
    if not ratios:
        return []
    mean, largest = geometric_mean(ratios), max(ratios)
    return [f"Grids against the one-ring at its best: geometric mean {mean:.3f}, largest {largest:.2f}.", ""]


def times(cells):
    """Seconds of each peer and of ours, geometric means over the cells."""
    seconds = defaultdict(list)
    for cell in cells:
        for rows in cell.ours_rows + cell.peer_rows:
            for row in rows:
                parameter = "" if row.peer.startswith(("ours", "fan", "loop", "corrected")) else row.parameter
                seconds[row.peer, parameter].append(row.seconds / row.points * 1e6)
    lines = ["| | microseconds a point, geometric mean |", "|---|---|"]
    for (peer, parameter), values in sorted(seconds.items()):
        lines.append(f"| {peer} {parameter} | {geometric_mean(values):.3g} |")
    return lines + [""]


def measure(bench, seeds, names, kind, samplings):
    cells = []
    for sampling in samplings:
        for name in names:
            files = [bench.shapes / kind / f"{name}_{sampling}{'' if s == 1 else f'_s{s}'}.ply" for s in seeds]
            if not all(file.exists() for file in files):
                continue  # no anisotropic icospheres
            if kind == "clouds":
                ours = [bench.ours(file, "cloud", OUR_CLOUDS | FAN) for file in files]
                peers = [bench.cloud_peers(file, sampling) for file in files]
            else:
                ours = [bench.ours(file, "mesh", OUR_MESHES) for file in files]
                peers = [bench.mesh_peers(file, sampling) for file in files]
            cells.append(Cell(f"{name} {sampling}", ours, peers, fan_is_peer=sampling in CLEAN))
            print(f"{cells[-1].name}: {cells[-1].judged():.3g} against {cells[-1].best_error():.3g}", file=sys.stderr)
    return cells


def write_rows(path, cells):
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow("cell seed peer parameter relative_rmse rescaled undefined points seconds".split())
        for cell in cells:
            for rows_of_seeds in (cell.ours_rows, cell.peer_rows):
                for seed, rows in enumerate(rows_of_seeds, 1):
                    for row in rows:
                        out.writerow([cell.name, seed, row.peer, row.parameter, row.error, row.rescaled, row.undefined,
                                      row.points, row.seconds])


def main():
    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("build", type=Path)
    line.add_argument("--quick", action="store_true", help="one seed, fewer points of CGAL's jets")
    line.add_argument("--only", default="", help="surfaces whose name contains this")
    line.add_argument("--kinds", default="clouds,meshes")
    options = line.parse_args()
    bench = Bench(options.build.resolve(), options.quick)
    names = [name for name in SURFACES if options.only in name]
    seeds = [1] if options.quick else [1, 2, 3]
    for seed in seeds:
        bench.make_shapes(seed, names)
    lines = ["# Accuracy", "", "Relative RMSE of the density; peers at the parameters that the truth chose.", ""]
    everything = []
    if "clouds" in options.kinds:
        clean = measure(bench, seeds, names, "clouds", CLEAN)
        noisy = measure(bench, seeds, names, "clouds", NOISY)
        lines += table("Clean clouds", clean) + table("Noisy clouds", noisy)
        lines += ["## Time, clouds", ""] + times(clean + noisy)
        everything += clean + noisy
    if "meshes" in options.kinds:
        grids = measure(bench, seeds, names, "meshes", MESHES[:2])
        irregular = measure(bench, seeds, names, "meshes", MESHES[2:])
        lines += table("Meshes: regular and anisotropic grids", grids) + against_one_ring(grids)
        lines += table("Meshes: irregular, clean and noisy", irregular)
        lines += against("Irregular meshes", irregular, "libigl")
        lines += ["## Meshes, by kind", ""] + mesh_tables(grids + irregular)
        lines += ["## Time, meshes", ""] + times(grids + irregular)
        everything += grids + irregular
    text = "\n".join(lines)
    print(text)
    (bench.folder / "accuracy.md").write_text(text)
    write_rows(bench.folder / "accuracy.csv", everything)


if __name__ == "__main__":
    main()
