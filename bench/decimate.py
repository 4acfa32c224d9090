"""decimate.py BUILD [--quick] [MESH…]: decimation against peers at equal numbers of faces, judged by our own `compare`.

Each mesh goes to 50, 10, 5, 2 and 1 % of its faces, as it is and with its vertices moved by 1e-6 of the diagonal, three
times in all, since a maximum is one point of one mesh and moves by up to a fifth with that; values are geometric means of
the three. The distances are the larger of both ways over the diagonal of the box.
A cell is a mesh with a ratio: its best peer in RMS and its best in the maximum, which need not be the same, are what ours
is held against. Cells that a peer
solves exactly (RMS below 5e-7 of the diagonal) are not part of the means. Peers that make over 2 % more faces than asked for have no result in that cell. Results of peers are kept
in BUILD/bench/decimate and judged once. Prints a table a mode of ours, what curvature
weights do to the paper's two pipelines, MeshLab's distances beside ours on one cell a mesh, and the speed on a large mesh; and writes it to BUILD/bench/decimate/decimate.md. --quick: no moved meshes, two ratios, no speed.
"""

import json
import math
import random
import subprocess
import sys
from pathlib import Path

from environment import folder_of_npm, python_of_peers

SOURCE = Path(__file__).resolve().parent / "decimate"
DATA = SOURCE.parents[1] / "../shared/data/meshes"
MESHES = ["seed/bunny.ply", "seed/cow.ply", "classic/armadillo.off", "classic/horse.ply", "classic/igea.ply",
          "classic/fandisk.obj", "classic/rocker-arm.obj", "classic/ChineseDragon-10kv.off"]
RATIOS = [0.5, 0.1, 0.05, 0.02, 0.01]
CHECKED = 0.1  # the ratio at which MeshLab measures too
JITTER, JITTERS = 1e-6, 3
PYTHON_PEERS = ["vcg", "vcg-quality", "meshoptimizer", "fast-simplification", "pyfqmr", "libigl", "open3d"]
MESHOPTIMIZER = "meshoptimizer@1.3.0"
OURS = {
    "best": [],
    "best, objective max": ["--objective", "max"],
    "fast": ["--fast"],
}
WEIGHTED = {"bunny", "cow", "armadillo"}  # the paper's, where weights are tried
WEIGHTED_RATIOS = [0.1, 0.05, 0.02]


def run(command, folder=None):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode:
        print(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stderr[-500:]}", file=sys.stderr, flush=True)
    return done.stdout if done.returncode == 0 else ""


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def means_of(rows):
    """The geometric mean of each column."""
    return tuple(geometric_mean(axis) for axis in zip(*rows))


def moved(path, out, seed):
    """The OFF file with its vertices moved by up to JITTER of the diagonal in each coordinate."""
    head, counts, *lines = path.read_text().splitlines()
    n = int(counts.split()[0])
    points = [tuple(map(float, line.split()[:3])) for line in lines[:n]]
    step = JITTER * math.dist(*(tuple(pick(axis) for axis in zip(*points)) for pick in (min, max)))
    rng = random.Random(seed)
    new = (" ".join([*(f"{x + rng.uniform(-step, step):.17g}" for x in point), *line.split()[3:]])
           for point, line in zip(points, lines))
    out.write_text("\n".join([head, counts, *new, *lines[n:]]) + "\n")


def without_normals(path):
    """The OFF file with the coordinates of its vertices alone: what all of them decimate."""
    head, counts, *lines = path.read_text().splitlines()
    n = int(counts.split()[0])
    points = (" ".join(line.split()[:3]) for line in lines[:n])
    path.write_text("\n".join(["OFF", counts, *points, *lines[n:]]) + "\n")


class Bench:
    def __init__(self, build, folder, python, peers):
        self.build, self.program = build, build / "gaussmap"
        self.folder, self.python, self.python_peers = folder, python, peers
        self.npm = folder_of_npm(build / "bench/npm", MESHOPTIMIZER)
        kept = self.folder / "judged.json"
        self.judged = json.loads(kept.read_text()) if kept.exists() else {}

    def judge(self, reference, path, keep=True):
        """(RMS, maximum) both ways over the diagonal, × 1e5."""
        key = str(path.relative_to(self.build))
        if key not in self.judged or not keep:
            report = run([self.program, "compare", reference, path, "--json", "--samples", 200000])
            distance = json.loads(report)["symmetric"] if report else {"rms": math.inf, "max": math.inf}
            self.judged[key] = [1e5 * distance["rms"], 1e5 * distance["max"]]
            (self.folder / "judged.json").write_text(json.dumps(self.judged))
        return self.judged[key]

    def commands(self):
        """A command each peer, to which mesh, prefix and numbers of faces are added, and its folder."""
        found = {peer: ([self.python, SOURCE / "peers.py", peer], None) for peer in self.python_peers if self.python}
        tools = self.build / "bench"
        for name, command in (("cgal-lt", [tools / "decimate_cgal", "lt"]), ("cgal-gh", [tools / "decimate_cgal", "gh"]),
                              ("openmesh", [tools / "decimate_openmesh"])):
            if command[0].exists():
                found[name] = command, None
        if self.npm:
            for name, mode in (("meshoptimizer-npm", "keep"), ("meshoptimizer-moving", "update")):
                found[name] = ["node", SOURCE / "meshoptimizer.mjs", mode], self.npm
        return found

    def peers(self, mesh, targets):
        """Rows peer, version, parameters, asked, made, seconds, path of every peer on the mesh."""
        kept = self.folder / f"{mesh.stem}_{'_'.join(map(str, targets))}.tsv"
        if not kept.exists():
            prefix = self.folder / f"{mesh.stem}_"
            kept.write_text("".join(run([*command, mesh, prefix, *targets], folder)
                                    for command, folder in self.commands().values()))
        return [line.split("\t") for line in kept.read_text().splitlines()]

    def ours(self, mesh, target, options):
        """(RMS, maximum, seconds) of one mode of ours; the mesh stays in ours.off."""
        out = self.folder / "ours.off"
        report = run([self.program, "decimate", mesh, "-o", out, "--faces", target, "--json", *options])
        return *self.judge(mesh, out, keep=False), json.loads(report)["seconds"]["decimate"]

    def meshes(self, path, count):
        """The mesh as it is, and moved."""
        plain = self.folder / f"{path.stem}.off"
        run([self.program, "convert", path, "-o", plain, "--triangulate"])
        others = [self.folder / f"{path.stem}~{seed}.off" for seed in range(1, count)]
        for seed, other in enumerate(others, 1):
            if not other.exists():
                moved(plain, other, seed)
        return [plain, *others]

    def cells(self, path, ratios, count):
        """(meshes, ratio, number of faces, {peer: (RMS, maximum, seconds), means over the meshes}) of each ratio."""
        meshes = self.meshes(path, count)
        faces = json.loads(run([self.program, "info", meshes[0], "--json"]))["faces"]
        targets = [int(faces * ratio) for ratio in ratios]
        rows = [self.peers(mesh, targets) for mesh in meshes]
        for ratio, target in zip(ratios, targets):
            found = {}
            for mesh, results in zip(meshes, rows):
                for peer, _, _, asked, made, seconds, file in results:
                    if int(asked) == target and 0 < int(made) <= 1.02 * target + 2:
                        found.setdefault(peer, []).append((*self.judge(mesh, Path(file)), max(float(seconds), 1e-4)))
            # Who fails on one of the meshes has no result.
            means = {peer: means_of(values)
                     for peer, values in found.items() if len(values) == len(meshes)}
            yield meshes, ratio, target, means

    def settings(self):
        """{(peer, version, parameters)} of the rows there are."""
        return {tuple(line.split("\t")[:3]) for kept in self.folder.glob("*.tsv") for line in kept.open()}

    def versions(self):
        return {peer: version for peer, version, _ in self.settings()}


def table_of_mode(bench, mode, options, cells):
    lines = ["", f"## {mode}", "", "| mesh | % | RMS | best peer | ratio | max | best peer | ratio |",
             "|---|---|---|---|---|---|---|---|"]
    ratios = ([], [])
    for meshes, ratio, target, results in cells:
        if not results:
            continue
        own = means_of(bench.ours(mesh, target, options) for mesh in meshes)
        row = f"| {meshes[0].stem} | {100 * ratio:g} "
        exact = min(rms for rms, *_ in results.values()) < 0.05  # a flat or subdivided mesh: a ratio of rounding errors
        for axis in range(2):
            peer = min(results, key=lambda name: results[name][axis])
            best = results[peer][axis]
            if not exact:
                ratios[axis].append(own[axis] / best)
            row += f"| {own[axis]:.1f} | {peer} {best:.1f} | " + ("exact " if exact else f"{own[axis] / best:.2f} ")
        lines.append(row + "|")
    lines.append(f"| geometric mean of {len(ratios[0])} | | | | **{geometric_mean(ratios[0]):.3f}** "
                 f"| | | **{geometric_mean(ratios[1]):.3f}** |")
    return lines


def table_of_weights(bench, cells):
    """The paper's two pipelines with curvature weights and without."""
    lines = ["", "## What the curvature weights do", "",
             "| method | mesh | % | RMS, none | RMS, weights | ratio | max, none | max, weights | ratio |",
             "|---|---|---|---|---|---|---|---|---|"]
    for method in ("edge", "qem"):
        ratios = ([], [])
        for meshes, ratio, target, _ in cells:
            if meshes[0].stem not in WEIGHTED or ratio not in WEIGHTED_RATIOS:
                continue
            plain, weighted = (means_of(bench.ours(mesh, target, options) for mesh in meshes)
                               for options in (["--method", method, "--weight", "none"], ["--method", method]))
            row = f"| {method} | {meshes[0].stem} | {100 * ratio:g} "
            for axis in range(2):
                ratios[axis].append(weighted[axis] / plain[axis])
                row += f"| {plain[axis]:.1f} | {weighted[axis]:.1f} | {ratios[axis][-1]:.2f} "
            lines.append(row + "|")
        if ratios[0]:
            lines.append(f"| geometric mean, {method} | | | | | **{geometric_mean(ratios[0]):.2f}** "
                         f"| | | **{geometric_mean(ratios[1]):.2f}** |")
    return lines


def spot_checks(bench, cells):
    """Our distances of the default's result beside MeshLab's."""
    lines = ["", "## The judge beside MeshLab's Hausdorff filter", "",
             "| mesh | % | RMS | MeshLab's | max | MeshLab's |", "|---|---|---|---|---|---|"]
    for meshes, ratio, target, _ in cells:
        if ratio != CHECKED or not bench.python:
            continue
        own = bench.ours(meshes[0], target, [])
        words = run([bench.python, SOURCE / "meshlab.py", meshes[0], bench.folder / "ours.off"]).split()
        if len(words) < 2:
            continue
        theirs = [1e5 * float(word) for word in words[-2:]]
        lines.append(f"| {meshes[0].stem} | {100 * ratio:g} | {own[0]:.1f} | {theirs[0]:.1f} "
                     f"| {own[1]:.1f} | {theirs[1]:.1f} |")
    return lines


def speed(bench):
    """Seconds and distances on 1,310,720 triangles to 10 %, in turns; ours with one thread, then with two."""
    folder = bench.folder / "speed"
    folder.mkdir(exist_ok=True)
    made, mesh = folder / "made.ply", folder / "bumpy.off"
    run([bench.program, "shape", "bumpy", "--subdivisions", 8, "-o", made])
    run([bench.program, "convert", made, "-o", mesh])
    without_normals(mesh)  # peers would not carry them over, which is part of our time
    target, fastest, parts = 131072, {}, {}
    peers = {name: command for name, command in bench.commands().items()
             if name in ("meshoptimizer", "meshoptimizer-npm", "meshoptimizer-moving", "vcg", "cgal-lt")}
    slow = ("vcg", "cgal-lt")
    for turn in range(3):
        for name, (command, where) in peers.items():
            if turn and name in slow:
                continue
            rows = run([*command, mesh, folder / "", target], where).splitlines()
            if rows:
                _, _, _, _, _, seconds, file = rows[0].split("\t")
                fastest[name] = min(fastest.get(name, math.inf), float(seconds))
                parts[name] = bench.judge(mesh, Path(file)), None
        for name, options in (("--fast", ["--fast"]), ("the default", [])):
            for threads in (1, 2):
                out = folder / "ours.off"
                report = json.loads(run([bench.program, "decimate", mesh, "-o", out, "--faces", target, "--threads",
                                         threads, "--json", *options]))
                label = name if threads == 1 else f"{name}, two threads"
                fastest[label] = min(fastest.get(label, math.inf), report["seconds"]["decimate"])
                if turn == 0:
                    parts[label] = bench.judge(mesh, out, keep=False), report["peak_bytes"] / 1310720
    lines = ["", "## Speed: 1,310,720 triangles to 10 %, the decimation alone", "",
             "| | s | RMS | max | peak of the command, bytes a triangle |", "|---|---|---|---|---|"]
    for name, seconds in sorted(fastest.items(), key=lambda item: item[1]):
        (rms, most), peak = parts[name]
        lines.append(f"| {name} | {seconds:.2f} | {rms:.2f} | {most:.1f} | {'' if peak is None else f'{peak:.0f}'} |")
    return lines


def main():
    build, *names = sys.argv[1:]
    quick = "--quick" in names
    names = [name for name in names if name != "--quick"]
    build = Path(build).resolve()
    folder = build / "bench/decimate"
    folder.mkdir(parents=True, exist_ok=True)
    bench = Bench(build, folder, python_of_peers(folder / "venv", SOURCE / "requirements.txt"), PYTHON_PEERS)
    meshes = [Path(name) if Path(name).exists() else DATA / name for name in names or MESHES]
    ratios, count = ([0.1, 0.02], 1) if quick else (RATIOS, JITTERS)
    cells = [cell for mesh in meshes for cell in bench.cells(mesh, ratios, count)]
    lines = ["| peer | version | parameters |", "|---|---|---|"]
    lines += ["| " + " | ".join(setting) + " |" for setting in sorted(bench.settings())]
    for mode, options in OURS.items():
        lines += table_of_mode(bench, mode, options, cells)
    lines += table_of_weights(bench, cells)
    lines += spot_checks(bench, cells)
    if not quick:
        lines += speed(bench)
    page = "\n".join(lines) + "\n"
    (bench.folder / "decimate.md").write_text(page)
    print(page)


if __name__ == "__main__":
    main()
