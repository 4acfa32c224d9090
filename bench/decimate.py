"""decimate.py BUILD [MESH…]: decimation against peers at equal numbers of faces, judged by our own `compare`.

Each mesh goes to 50, 10, 5, 2 and 1 % of its faces; the distances are the larger of both ways over the diagonal of the box.
A cell is a mesh with a ratio: its best peer in RMS and its best in the maximum, which need not be the same, are what ours
is held against. Cells that a peer
solves exactly (RMS below 5e-7 of the diagonal) are not part of the means. Peers that make over 2 % more faces than asked for have no result in that cell. Results of peers are kept
in BUILD/bench/decimate and judged once. Prints a table a mode of ours, and writes it to BUILD/bench/decimate/decimate.md.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

from environment import folder_of_npm, python_of_peers

SOURCE = Path(__file__).resolve().parent / "decimate"
DATA = SOURCE.parents[1] / "../shared/data/meshes"
MESHES = ["seed/bunny.ply", "seed/cow.ply", "classic/armadillo.off", "classic/horse.ply", "classic/igea.ply",
          "classic/fandisk.obj", "classic/rocker-arm.obj", "classic/ChineseDragon-10kv.off"]
RATIOS = [0.5, 0.1, 0.05, 0.02, 0.01]
PYTHON_PEERS = ["vcg", "vcg-quality", "meshoptimizer", "fast-simplification", "pyfqmr", "libigl", "open3d"]
MESHOPTIMIZER = "meshoptimizer@1.3.0"
OURS = {
    "best": [],
    "best, objective max": ["--objective", "max"],
    "best, objective rms": ["--objective", "rms"],
    "fast": ["--fast"],
    "qem": ["--method", "qem"],
    "qem, no weights": ["--method", "qem", "--weight", "none"],
    "edge": ["--method", "edge"],
    "edge, no weights": ["--method", "edge", "--weight", "none"],
}


def run(command, folder=None):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, cwd=folder)
    return done.stdout if done.returncode == 0 else ""


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

    def peers(self, mesh, targets):
        """Rows peer, version, parameters, asked, made, seconds, path of every peer on the mesh."""
        kept = self.folder / f"{mesh.stem}.tsv"
        if not kept.exists():
            prefix = self.folder / f"{mesh.stem}_"
            commands = [[self.python, SOURCE / "peers.py", peer] for peer in self.python_peers if self.python]
            tools = self.build / "bench"
            commands += [[tools / "decimate_cgal", method] for method in ("lt", "gh") if (tools / "decimate_cgal").exists()]
            commands += [[tools / "decimate_openmesh"]] if (tools / "decimate_openmesh").exists() else []
            lines = [run([*command, mesh, prefix, *targets]) for command in commands]
            if self.npm:
                lines += [run(["node", SOURCE / "meshoptimizer.mjs", mode, mesh, prefix, *targets], self.npm)
                          for mode in ("keep", "update")]
            kept.write_text("".join(lines))
        return [line.split("\t") for line in kept.read_text().splitlines()]

    def ours(self, mesh, target, options):
        out = self.folder / "ours.off"
        report = run([self.program, "decimate", mesh, "-o", out, "--faces", target, "--threads", 1, "--json", *options])
        made = json.loads(report)
        return made["faces_out"], made["seconds"]["decimate"], *self.judge(mesh, out, keep=False)

    def cells(self, path, ratios):
        mesh = self.folder / f"{path.stem}.off"
        run([self.program, "convert", path, "-o", mesh, "--triangulate"])
        faces = json.loads(run([self.program, "info", mesh, "--json"]))["faces"]
        targets = [int(faces * ratio) for ratio in ratios]
        rows = self.peers(mesh, targets)
        for ratio, target in zip(ratios, targets):
            results = {}
            for peer, _, _, asked, made, seconds, file in rows:
                if int(asked) == target and 0 < int(made) <= 1.02 * target + 2:
                    results[peer] = (*self.judge(mesh, Path(file)), float(seconds))
            yield mesh, ratio, target, results

    def settings(self):
        """{(peer, version, parameters)} of the rows there are."""
        return {tuple(line.split("\t")[:3]) for kept in self.folder.glob("*.tsv") for line in kept.open()}

    def versions(self):
        return {peer: version for peer, version, _ in self.settings()}


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def main():
    build = Path(sys.argv[1]).resolve()
    folder = build / "bench/decimate"
    folder.mkdir(parents=True, exist_ok=True)
    bench = Bench(build, folder, python_of_peers(folder / "venv", SOURCE / "requirements.txt"), PYTHON_PEERS)
    meshes = [Path(name) if Path(name).exists() else DATA / name for name in sys.argv[2:] or MESHES]
    cells = [cell for mesh in meshes for cell in bench.cells(mesh, RATIOS)]
    lines = ["| peer | version | parameters |", "|---|---|---|"]
    lines += ["| " + " | ".join(setting) + " |" for setting in sorted(bench.settings())]
    for mode, options in OURS.items():
        lines += ["", f"## {mode}", "", "| mesh | % | RMS | best peer | ratio | max | best peer | ratio |",
                  "|---|---|---|---|---|---|---|---|"]
        ratios = ([], [])
        for mesh, ratio, target, results in cells:
            if not results:
                continue
            _, _, *own = bench.ours(mesh, target, options)
            row = f"| {mesh.stem} | {100 * ratio:g} "
            for axis in range(2):
                peer = min(results, key=lambda name: results[name][axis])
                best = results[peer][axis]
                exact = best < 0.05  # a flat or subdivided mesh: a ratio of rounding errors says nothing
                if not exact:
                    ratios[axis].append(own[axis] / best)
                row += f"| {own[axis]:.1f} | {peer} {best:.1f} | " + ("exact " if exact else f"{own[axis] / best:.2f} ")
            lines.append(row + "|")
        lines.append("| geometric mean | | | | " + f"{geometric_mean(ratios[0]):.3f} | | | {geometric_mean(ratios[1]):.3f} |")
    page = "\n".join(lines) + "\n"
    (bench.folder / "decimate.md").write_text(page)
    print(page)


if __name__ == "__main__":
    main()
