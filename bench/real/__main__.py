"""real BUILD OUT: real scans, outliers, sheets and edges: what the defaults say where no exact value is known.

Writes OUT/README.md and pictures. Needs the folder ../shared/data beside the project; a file that is missing has no row.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parent
sys.path.insert(1, str(SOURCE.parent))
from environment import python_of_peers  # noqa: E402

DATA = SOURCE.parents[1] / "../shared/data"
RECIPE = ["--normals", "pca", "--orient", "mst", "--estimator", "dirichlet"]
ESTIMATE = ["--normals", "estimate"]


class Real:
    def __init__(self, build, out):
        self.program, self.out, self.folder = build / "gaussmap", out, build / "bench/real"
        self.folder.mkdir(parents=True, exist_ok=True)
        out.mkdir(parents=True, exist_ok=True)

    def measured(self, source, name, *options):
        """(vertices, report) of the density of a file."""
        path = self.folder / f"{name}.ply"
        command = [self.program, "curvature", source, *options, "-o", path, "--json", "--quiet"]
        report = json.loads(subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout)
        return ply.read(path)[0], report

    def sheet(self, name, columns, span, up=None):
        """{caption: measured name} as one row of pictures."""
        pictures = []
        for measured in columns.values():
            picture = self.folder / f"{measured}.png"
            command = [self.program, "view", self.folder / f"{measured}.ply", "--field", "scalar_total_curvature",
                       "--range", span, "--size", "400x320", "-o", picture, "--quiet", *(["--up", up] if up else [])]
            subprocess.run(list(map(str, command)), check=True)
            pictures.append(str(picture))
        plan = {"columns": list(columns), "rows": {"": pictures}}
        subprocess.run([sys.executable, SOURCE.parent / "paper/sheet.py", self.out / f"{name}.png"],
                       input=json.dumps(plan), text=True, check=True)
        return ["", f"![{name}]({name}.png)", ""]


def density(vertices):
    return vertices["scalar_total_curvature"].astype(float)


def percentiles(values):
    return " / ".join(f"{p:.3g}" for p in np.nanpercentile(values, [2, 50, 98]))


def row(*cells):
    return "| " + " | ".join(map(str, cells)) + " |"


def scans(real):
    lines = ["## Scans", "", row("file", "points", "2nd / 50th / 98th percentile, default", "the paper's recipe", "seconds"),
             "|---" * 5 + "|"]
    pictures = []
    for name, path, span, up in (("kitten", "clouds/kitten.xyz", "0,800", "0,1,0"), ("cturtle", "clouds/cturtle.pcd", "0,1", None),
                                 ("lion", "large/lion_takanawa.ply", "0,2000", None)):
        if not (DATA / path).exists():
            continue
        ours, report = real.measured(DATA / path, name, *ESTIMATE)
        recipe, _ = real.measured(DATA / path, f"{name}_recipe", *RECIPE)
        lines.append(row(path, f"{len(ours):,}", percentiles(density(ours)), percentiles(density(recipe)),
                         f"{report['seconds']['total']:.1f}"))
        pictures += real.sheet(name, {"default": name, "PCA, spanning tree, fan": f"{name}_recipe"}, span, up)
    return lines + pictures


def lion_normals(real):
    path = DATA / "large/lion_takanawa.ply"
    if not path.exists():
        return []
    theirs, _ = real.measured(path, "lion_file", "--normals", "file", "--estimator", "dirichlet")
    estimated = real.folder / "lion_normals.ply"
    subprocess.run([real.program, "normals", path, "-o", estimated, "--quiet"], check=True)
    ours = ply.read(estimated)[0]
    given, found = (np.stack([v[n].astype(float) for n in ("nx", "ny", "nz")], 1) for v in (theirs, ours))
    lengths = np.linalg.norm(given, axis=1) * np.linalg.norm(found, axis=1)
    cosine = np.abs(np.sum(given * found, 1)) / np.where(lengths > 0, lengths, 1)
    angles = np.degrees(np.arccos(np.clip(cosine[lengths > 0], 0, 1)))
    return ["", "The lion's own normals (of 8 + 8 bits) and those of `gaussmap normals` are "
            f"{np.median(angles):.1f}° apart in the median, {np.percentile(angles, 90):.1f}° at the 90th percentile. "
            f"The fan on its own normals has a median density of {np.nanmedian(density(theirs)):.3g}, our default "
            f"{np.nanmedian(density(ply.read(real.folder / 'lion.ply')[0])):.3g}.", ""]


def noisy_sphere(real):
    path = DATA / "clouds/sphere_20k_normal.xyz"
    if not path.exists():
        return []
    rows = {"default": real.measured(path, "sphere", *ESTIMATE)[0], "the paper's recipe": real.measured(path, "sphere_recipe", *RECIPE)[0],
            "fan, normals of the file": real.measured(path, "sphere_file", "--normals", "file", "--estimator", "dirichlet")[0]}
    points = ply.positions(rows["default"])
    columns = np.column_stack([2 * points, np.ones(len(points))])
    x = np.linalg.lstsq(columns, np.sum(points * points, 1), rcond=None)[0]
    radius = np.sqrt(x[3] + x[:3] @ x[:3])
    apart = np.linalg.norm(points - x[:3], axis=1) - radius
    truth = 2 / radius**2
    lines = ["## A noisy sphere", "", f"`sphere_20k_normal.xyz`: {len(points):,} points about a sphere of radius {radius:.3f}, "
             f"{100 * apart.std() / radius:.1f} % of it off (standard deviation); the density of the sphere is {truth:.3f}.", "",
             row("", "relative RMSE", "2nd / 50th / 98th percentile"), "|---" * 3 + "|"]
    for name, vertices in rows.items():
        error = np.sqrt(np.nanmean((density(vertices) - truth) ** 2)) / truth
        lines.append(row(name, f"{error:.3g}", percentiles(density(vertices))))
    return lines + [""]


def noisy_meshes(real):
    lines = ["## Meshes with noise added", "", "Gaussian noise of a fraction of the mean edge on each coordinate; median change of the "
             "density relative to the same estimator without noise, and the 98th percentile before and after.", "",
             row("mesh", "noise", "`auto`", "98 %", "`dirichlet`", "98 %"), "|---" * 6 + "|"]
    for name, path in (("igea", "meshes/classic/igea.ply"), ("bunny", "meshes/classic/bunny.off")):
        if not (DATA / path).exists():
            continue
        whole = real.folder / f"{name}_mesh.ply"
        subprocess.run([real.program, "convert", DATA / path, "-o", whole, "--triangulate", "--quiet"], check=True)
        vertices, faces = ply.read(whole)
        points = ply.positions(vertices)
        edge = np.mean([np.linalg.norm(points[faces[:, k]] - points[faces[:, k - 1]], axis=1).mean() for k in range(3)])
        clean = {e: density(real.measured(whole, f"{name}_{e}", *ESTIMATE, "--estimator", e)[0]) for e in ("auto", "dirichlet")}
        for percent in (1, 2):
            noisy = real.folder / f"{name}_n{percent}.ply"
            dice = np.random.default_rng(percent)
            ply.write(noisy, points + percent / 100 * edge * dice.standard_normal(points.shape), faces)
            cells = []
            for estimator, before in clean.items():
                after = density(real.measured(noisy, f"{name}_{estimator}_n{percent}", *ESTIMATE, "--estimator", estimator)[0])
                change = np.nanmedian(np.abs(after - before) / np.where(before > 0, before, np.nan))
                cells += [f"{100 * change:.0f} %", f"{np.nanpercentile(before, 98):.3g} → {np.nanpercentile(after, 98):.3g}"]
            lines.append(row(name, f"{percent} %", *cells))
    return lines + [""]


def on_torus(dice, count):
    """Uniform random points of the torus R = 1, r = 0.5, and their densities."""
    u, v, keep = dice.random((3, 3 * count)) * [[2 * np.pi], [2 * np.pi], [1.5]]
    u, v = u[keep < 1 + 0.5 * np.cos(v)][:count], v[keep < 1 + 0.5 * np.cos(v)][:count]
    ring = 1 + 0.5 * np.cos(v)
    return np.stack([ring * np.cos(u), ring * np.sin(u), 0.5 * np.sin(v)], 1), 4 + (np.cos(v) / ring) ** 2


def made_up(real):
    dice = np.random.default_rng(1)
    lines = ["## Outliers, sheets, edges", ""]
    points, truth = on_torus(dice, 20000)
    outliers = dice.uniform(points.min(0), points.max(0), (200, 3))
    ply.write(real.folder / "torus.ply", points, exact_density=truth)
    ply.write(real.folder / "torus_outliers.ply", np.vstack([points, outliers]))
    plain = density(real.measured(real.folder / "torus.ply", "torus_out", *ESTIMATE)[0])
    mixed = density(real.measured(real.folder / "torus_outliers.ply", "torus_mixed", *ESTIMATE)[0])[:20000]
    recipe = density(real.measured(real.folder / "torus_outliers.ply", "torus_mixed_recipe", *RECIPE)[0])[:20000]
    scale = np.sqrt(np.mean(truth**2))
    off = [np.abs(d - truth) / truth for d in (plain, mixed, recipe)]
    lines += ["**1 % outliers** anywhere in the box, among 20,000 random points of the torus; errors of the points that are on it:", "",
              row("", "relative RMSE", "median error", "90th percentile", "points off by more than 10 %"), "|---" * 5 + "|"]
    for name, d, o in zip(("default, no outliers", "default", "the paper's recipe"), (plain, mixed, recipe), off):
        error = np.sqrt(np.nanmean((d - truth) ** 2)) / scale
        lines.append(row(name, f"{error:.3g}", f"{np.nanmedian(o):.2g}", f"{np.nanpercentile(o, 90):.2g}", f"{100 * np.nanmean(o > 0.1):.1f} %"))
    lines += ["", "**Two spherical sheets** of radius 1 and 1 + d, 20,000 random points each, d in mean spacings (√(area / points)):", "",
              row("d", "median error, default", "points off by more than 10 %", "the paper's recipe", ""), "|---" * 5 + "|"]
    spacing = np.sqrt(4 * np.pi / 20000)
    directions = dice.standard_normal((2, 20000, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    for d in (5, 3, 2, 1, 0.5):
        radii = 1, 1 + d * spacing
        ply.write(real.folder / "sheets.ply", np.vstack([r * s for r, s in zip(radii, directions)]))
        exact = np.repeat([2 / r**2 for r in radii], 20000)
        cells = []
        for options in (ESTIMATE, RECIPE):
            off = np.abs(density(real.measured(real.folder / "sheets.ply", "sheets_out", *options)[0]) - exact) / exact
            cells += [f"{np.nanmedian(off):.2g}", f"{100 * np.nanmean(off > 0.1):.1f} %"]
        lines.append(row(f"{d:g}", *cells))
    return lines + [""] + cube(real, dice)


def cube(real, dice):
    count = 20000
    face, uv = dice.integers(0, 6, count), dice.random((count, 2)) * 2 - 1
    points = np.zeros((count, 3))
    for f in range(6):
        rows = face == f
        points[rows, f % 3] = 1 if f < 3 else -1
        points[np.ix_(rows, [(f + 1) % 3, (f + 2) % 3])] = uv[rows]
    spacing = np.sqrt(24 / count)
    away = (1 - np.sort(np.abs(points), 1)[:, 1]) / spacing  # from the nearest edge, in spacings
    ply.write(real.folder / "cube.ply", points)
    found = density(real.measured(real.folder / "cube.ply", "cube_out", *ESTIMATE)[0])
    lines = ["**A cube** of side 2, 20,000 random points, flat but for its edges; mean density by the distance from the nearest edge in "
             "spacings. An edge turned over a width of w spacings s would have (π / 2 w s)².", "",
             row("from the edge", *(f"{a}–{a + 1}" for a in range(6)), "over 6"), "|---" * 8 + "|"]
    bands = [(away >= a) & (away < a + 1) for a in range(6)] + [away >= 6]
    lines.append(row("mean density", *(f"{np.nanmean(found[band]):.3g}" for band in bands)))
    return lines + real.sheet("cube", {"default": "cube_out"}, "0,400")


def main():
    real = Real(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
    lines = ["# Where no exact value is known", "", "Made by `make bench-real`: scans of `../shared/data`, and surfaces made to be hard. "
             "*Default* is `--normals estimate`; *the paper's recipe* PCA normals oriented by a spanning tree and fans, k = 20. Densities in 1/unit².", ""]
    for part in (scans, lion_normals, noisy_sphere, noisy_meshes, made_up):
        lines += part(real)
        print(f"real: {part.__name__}", file=sys.stderr, flush=True)
    (real.out / "README.md").write_text("\n".join(lines) + "\n")
    print(f"Written: {real.out}/README.md")


try:
    import numpy as np

    import ply
except ImportError:
    python = python_of_peers(Path(sys.argv[1]).resolve() / "bench/real/venv", SOURCE / "requirements.txt")
    os.execv(python, [str(python), str(SOURCE), *sys.argv[1:]])

if __name__ == "__main__":
    main()
