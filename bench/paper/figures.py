"""The paper's pictures as sheets: rows and columns of small pictures with one range of colours, captioned."""

import json
import subprocess
from pathlib import Path

from runs import DATA, SOURCE

CLOUDS = {"torus5": ("torus", "0,6.5"), "knot23": ("(2,3) torus knot", "0,80"), "fig8": ("figure-eight knot", "0,200")}
FAN = ["--estimator", "dirichlet"]
WAYS = {
    "exact": None,
    "fan, ground-truth normals": ["--normals", "file", *FAN],
    "fan, PCA normals, spanning tree": ["--normals", "pca", "--orient", "mst", *FAN],
    "our default, estimated normals": ["--normals", "estimate"],
}
SIZE = "360x270"


class Sheets:
    def __init__(self, runs, out):
        self.runs, self.out = runs, out
        self.folder = runs.folder / "pictures"
        self.folder.mkdir(exist_ok=True)

    def picture(self, file, name, field=None, span=None, up=None):
        path = self.folder / f"{name}.png"
        options = (["--field", field] if field else []) + (["--range", span] if span else []) + (["--up", up] if up else [])
        self.runs.ours("view", file, *options, "--size", SIZE, "-o", path)
        return path

    def measured(self, file, name, options, span=None, up=None):
        """The picture of a density computed with these options."""
        path = self.folder / f"{name}.ply"
        self.runs.ours("curvature", file, *options, "-o", path)
        return self.picture(path, name, "scalar_total_curvature", span, up)

    def sheet(self, name, columns, rows):
        """rows: {caption: [picture of each column]}. The sheet's name, or None without the drawing library."""
        plan = {"columns": columns, "rows": {row: list(map(str, pictures)) for row, pictures in rows.items()}}
        if self.runs.python is None:
            return None
        subprocess.run([self.runs.python, SOURCE / "sheet.py", self.out / f"{name}.png"], input=json.dumps(plan),
                       text=True, check=True)
        return name


def figures(runs, out):
    """{file name: caption} of the sheets written to the folder `out`."""
    sheets = Sheets(runs, out)
    made = {}

    def add(name, caption, columns, rows):
        if sheets.sheet(name, columns, rows):
            made[name] = caption

    for surface, (title, span) in CLOUDS.items():
        samplings = ["uniform", "nonuniform", "sparse"]
        rows = {}
        for way, options in WAYS.items():
            rows[way] = []
            for sampling in samplings:
                file, name = runs.folder / "surfaces/clouds" / f"{surface}_{sampling}.ply", f"{surface}_{sampling}"
                stem = f"{name}_{len(rows)}"
                rows[way].append(sheets.picture(file, stem, "exact_density", span) if options is None
                                 else sheets.measured(file, stem, options, span))
        add(f"cloud-{surface}", f"Density of points on the {title}, one range of colours", samplings, rows)
    tori = {n: runs.folder / "shapes" / f"torus{n}.ply" for n in (9, 18, 36)}
    add("tori", "The paper's tori: exact density, and ours with exact normals", [f"{n} x {n}" for n in tori], {
        "exact": [sheets.picture(file, f"torus{n}_exact", "exact_density", "0,8") for n, file in tori.items()],
        "ours": [sheets.measured(file, f"torus{n}_ours", ["--normals", "file"], "0,8") for n, file in tori.items()]})
    real_figures(sheets, add)
    return made


def real_figures(sheets, add):
    """Cow, bunny and lion, where the paper's files are."""
    def of(path):
        return DATA / path

    cow, bunny = of("meshes/seed/cow.ply"), of("meshes/seed/bunny.ply")
    if cow.exists() and bunny.exists():
        spans = {cow: "0,8000", bunny: "0,1500"}
        ways = {"dirichlet (default)": FAN, "auto": ["--normals", "estimate", "--estimator", "auto"]}
        if sheets.runs.quick:
            del ways["auto"]
        add("meshes", "Cow and bunny, meshes", ["cow", "bunny"], {
            way: [sheets.measured(file, f"{file.stem}_{i}", options, span, "0,1,0") for file, span in spans.items()]
            for i, (way, options) in enumerate(ways.items())})
    lion = of("large/lion_takanawa.ply")
    if lion.exists() and not sheets.runs.quick:
        ways = {"normals of the file, fan": ["--normals", "file", *FAN], "PCA normals, spanning tree, fan": WAYS[
            "fan, PCA normals, spanning tree"], "our default": ["--normals", "estimate"]}
        add("lion", "The lion, a photogrammetric cloud of 272,768 points", list(ways), {
            "density": [sheets.measured(lion, f"lion{i}", options, "0,2000") for i, options in enumerate(ways.values())]})
