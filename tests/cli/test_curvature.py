"""gaussmap curvature: figures, reports, files."""

import math
import struct

import ply
import pytest

KEYS_MESH = (
    "kind file vertices faces normals estimator k orient threads kappa density undefined undefined_faces "
    "degenerate_faces duplicates non_finite lowered seconds peak_bytes outputs notes"
).split()
KEYS_CLOUD = (
    "kind file vertices faces normals estimator k orient threads density undefined duplicates non_finite boundary "
    "lowered seconds peak_bytes outputs notes"
).split()


def torus_density(x, y, z, major=1.0, minor=0.5):
    """Exact k1² + k2² of the torus about z at a point on it."""
    cosine = (math.hypot(x, y) - major) / minor
    return 1 / minor**2 + (cosine / (major + minor * cosine)) ** 2


def rms_of_errors(values, truth):
    return math.sqrt(math.fsum((a - b) ** 2 for a, b in zip(values, truth, strict=True)) / len(values))


# The figures are of the paper's table; "corrected" is of Lachaud et al. 2020 on the same meshes.
@pytest.mark.parametrize(
    "estimator, grid, figure",
    [
        ("dirichlet", 9, 0.4759),
        ("dirichlet", 18, 0.1425),
        ("dirichlet", 36, 0.0372),
        ("corrected", 9, 0.382),
        ("corrected", 18, 0.111),
        ("corrected", 36, 0.0288),
    ],
)
def test_torus_of_the_paper(gaussmap, data, tmp_path, estimator, grid, figure):
    path = data / f"meshes/seed/torus_res{grid}.ply"
    report = gaussmap("curvature", path, "--estimator", estimator, "--normals", "max", "-o", "o.ply", "--json").json
    vertex = ply.read(tmp_path / "o.ply")[0]["vertex"]
    truth = [torus_density(*xyz) for xyz in zip(vertex["x"], vertex["y"], vertex["z"])]
    digits = 4 if estimator == "dirichlet" or grid == 36 else 3
    assert round(rms_of_errors(vertex["quality"], truth), digits) == figure
    assert vertex["quality"] == vertex["scalar_total_curvature"]
    assert report["estimator"] == estimator and report["vertices"] == grid * grid


@pytest.mark.parametrize("level", [4, 5, 6])
def test_spheres_are_exact(gaussmap, data, tmp_path, level):
    path = data / f"meshes/seed/icosahedron_subdivide_{level}.ply"
    header, _, body = path.read_bytes().partition(b"end_header\n")
    rows = body.splitlines(keepends=True)
    vertices = int(header.split(b"element vertex ")[1].split()[0])
    for i in range(vertices):  # analytic normals: the positions, to be made unit by the program
        rows[i] = rows[i].rstrip() + b" " + rows[i]
    named = header.replace(b"element face", b"property double nx\nproperty double ny\nproperty double nz\nelement face")
    (tmp_path / "s.ply").write_bytes(named + b"end_header\n" + b"".join(rows))
    gaussmap("curvature", "s.ply", "-o", "o.ply", "--normals", "file")
    density = ply.read(tmp_path / "o.ply")[0]["vertex"]["quality"]
    assert round(rms_of_errors(density, [2.0] * vertices), 4) == 0

    # Normals from the faces feel the six digits of these files; Max weights are exact beyond them.
    density = gaussmap("curvature", path, "--json").json["density"]
    assert density["mean"] == pytest.approx(2, abs=1e-5)


def test_the_issues_own_commands(gaussmap):
    gaussmap("shape", "torus", "--major", 1, "--minor", 0.5, "--grid", "36x36", "-o", "t.ply")
    report = gaussmap("curvature", "t.ply", "--normals", "file", "--truth", "exact_density", "--json").json
    truth = report["truth"]
    assert round(truth["rmse"], 4) == 0.0372
    assert truth["relative_rmse"] == pytest.approx(truth["rmse"] / 5.0675, rel=1e-2)
    assert 0 < truth["median_relative_error"] < 0.01
    assert truth["property"] == "exact_density" and truth["compared"] == 1296


def test_report_of_a_mesh(gaussmap):
    gaussmap("shape", "sphere", "--subdivisions", 3, "-o", "s.ply")
    report = gaussmap("curvature", "s.ply", "--normals", "estimate", "--json").json
    assert list(report) == KEYS_MESH
    assert report["kind"] == "mesh" and report["file"] == "s.ply" and report["normals"] == "max"
    assert report["vertices"] == 642 and report["faces"] == 1280
    assert report["k"] is None and report["orient"] is None
    assert report["kappa"]["sum"] == pytest.approx(8 * math.pi, rel=0.01)
    assert list(report["density"]) == ["min", "mean", "rms", "max", "p02", "p50", "p98"]
    assert all(report[key] == 0 for key in ("undefined", "undefined_faces", "degenerate_faces", "duplicates"))
    assert list(report["seconds"]) == ["read", "normals", "neighbors", "curvature", "write", "total"]
    assert report["peak_bytes"] > 1_000_000 and report["outputs"] == [] and report["notes"] == []
    assert report["threads"] >= 1


def test_report_of_a_cloud(gaussmap):
    gaussmap("shape", "sphere", "--subdivisions", 4, "-o", "s.ply")
    options = ["--as", "cloud", "--normals", "estimate", "--estimator", "dirichlet", "--json", "--threads", 2]
    report = gaussmap("curvature", "s.ply", *options).json
    assert list(report) == KEYS_CLOUD
    assert report["kind"] == "cloud" and report["normals"] == "jet 4"
    assert (report["k"], report["orient"], report["threads"], report["estimator"]) == (20, "local", 2, "dirichlet")
    assert report["density"]["mean"] == pytest.approx(2, rel=0.01)
    assert report["undefined"] == 0 and report["boundary"] == 0


@pytest.mark.parametrize(
    "options, normals",
    [
        (["--normals", "jet"], "jet 2"),
        (["--normals", "jet", "--degree", "3"], "jet 3"),
        (["--normals", "estimate", "--degree", "1"], "jet 1"),
        (["--normals", "pca"], "pca"),
        (["--normals", "wpca"], "wpca"),
        (["--normals", "auto"], "file"),
        (["--normals", "file"], "file"),
    ],
)
@pytest.mark.parametrize("orient", ["local", "mst", "none"])
def test_normals_of_a_cloud(gaussmap, options, normals, orient):
    gaussmap("shape", "sphere", "--subdivisions", 4, "--jitter", 0.2, "--seed", 1, "-o", "s.ply")
    options = ["--as", "cloud", "--estimator", "dirichlet", "--orient", orient, "--json", *options]
    report = gaussmap("curvature", "s.ply", *options).json
    assert report["normals"] == normals
    assert report["orient"] == (None if normals == "file" else orient)
    if orient != "none" or normals == "file":
        rough = normals in ("pca", "wpca", "jet 1")
        assert report["density"]["p50"] == pytest.approx(2, rel=0.2 if rough else 0.1)
    else:
        assert report["density"]["mean"] > 10, "signs as the fit left them disagree somewhere on a sphere"


@pytest.mark.parametrize("weights", ["max", "angle", "area"])
def test_normals_of_a_mesh(gaussmap, weights):
    gaussmap("shape", "sphere", "--subdivisions", 4, "--jitter", 0.25, "--seed", 1, "-o", "s.ply")
    report = gaussmap("curvature", "s.ply", "--normals", weights, "--truth", "exact_density", "--json").json
    assert report["normals"] == weights
    error = report["truth"]["rmse"]
    assert error < 1e-4 if weights == "max" else error > 1e-3, "Max weights alone are exact on a sphere"


def test_properties_are_kept_and_results_added(gaussmap, tmp_path):
    (tmp_path / "in.ply").write_bytes(
        b"ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty double x\nproperty double y\n"
        b"property double z\nproperty uchar label\nproperty float quality\nelement face 4\n"
        b"property list uchar int vertex_indices\nproperty short group\nelement camera 1\nproperty float angle\n"
        b"end_header\n0 0 0 1 9\n1 0 0 2 9\n0 1 0 3 9\n0 0 1 4 9\n"
        b"3 0 2 1 10\n3 0 1 3 20\n3 1 2 3 30\n3 2 0 3 40\n0.5\n"
    )
    report = gaussmap("curvature", "in.ply", "-o", "out.ply", "--json").json
    elements, types = ply.read(tmp_path / "out.ply")
    assert elements["vertex"]["label"] == [1, 2, 3, 4] and types["vertex", "label"] == "B"
    assert elements["face"]["group"] == [10, 20, 30, 40] and types["face", "group"] == "h"
    assert elements["camera"]["angle"] == [0.5]
    assert b"comment by hand\n" in (tmp_path / "out.ply").read_bytes()
    assert types["vertex", "x"] == "d"
    for where in (("vertex", "scalar_total_curvature"), ("vertex", "quality"), ("face", "kappa"), ("face", "quality")):
        assert types[where] == "f"
    assert max(elements["vertex"]["quality"]) != 9
    assert math.fsum(elements["face"]["kappa"]) == pytest.approx(report["kappa"]["sum"], rel=1e-6)
    assert "the vertex property 'quality' of the input is replaced" in report["notes"]
    assert "nx" not in elements["vertex"], "normals that were not in the file are not written"


def test_a_second_run_replaces_its_own_results(gaussmap, tmp_path):
    gaussmap("shape", "torus", "-o", "t.ply")
    gaussmap("curvature", "t.ply", "-o", "a.ply", "--color")
    gaussmap("curvature", "a.ply", "-o", "b.ply", "--color")
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_the_output_may_be_the_input(gaussmap, tmp_path):
    gaussmap("shape", "torus", "-o", "t.ply")
    gaussmap("curvature", "t.ply", "-o", "other.ply")
    assert gaussmap("curvature", "t.ply", "-o", "t.ply").code == 0
    assert (tmp_path / "t.ply").read_bytes() == (tmp_path / "other.ply").read_bytes()
    assert len(list(tmp_path.iterdir())) == 2


def test_polygons_become_triangles_with_their_own_kappa(gaussmap, tmp_path, data):
    report = gaussmap("curvature", data / "meshes/classic/torus_quad.off", "-o", "o.ply", "--json").json
    elements, _ = ply.read(tmp_path / "o.ply")
    assert report["faces"] == 50 and len(elements["face"]["kappa"]) == 50
    assert all(len(corners) == 3 for corners in elements["face"]["vertex_indices"])
    assert "polygons are written as triangles, each with its own kappa" in report["notes"]


def test_undefined_is_nan_in_the_file_null_in_json_and_counted(gaussmap, tmp_path):
    (tmp_path / "lonely.off").write_bytes(b"OFF\n3 0 0\n0 0 0\n1 0 0\n2 0 0\n")
    report = gaussmap("curvature", "lonely.off", "-o", "o.ply", "--color", "--json").json
    assert report["undefined"] == 3 and set(report["density"].values()) == {None}
    vertex = ply.read(tmp_path / "o.ply")[0]["vertex"]
    assert all(math.isnan(v) for v in vertex["quality"])
    assert [vertex[c] for c in ("red", "green", "blue")] == [[128] * 3] * 3

    (tmp_path / "nan.xyz").write_bytes(b"nan 0 0\n0 nan 0\n0 0 inf\n")
    report = gaussmap("curvature", "nan.xyz", "--json").json
    assert (report["non_finite"], report["undefined"]) == (3, 3)


def test_a_plane_is_exactly_flat(gaussmap, tmp_path):
    gaussmap("shape", "plane", "--grid", "9x9", "-o", "p.ply")
    for kind in ("mesh", "cloud"):
        report = gaussmap("curvature", "p.ply", "--as", kind, "-o", "o.ply", "--color", "--json").json
        assert report["density"]["max"] == 0 and report["density"]["min"] == 0
        red = ply.read(tmp_path / "o.ply")[0]["vertex"]["red"]
        assert len(set(red)) == 1 and red[0] != 128, "defined, so not grey"


def test_colours_grow_lighter_with_density(gaussmap, tmp_path):
    gaussmap("shape", "torus", "-o", "t.ply")
    gaussmap("curvature", "t.ply", "-o", "o.ply", "--color")
    elements, types = ply.read(tmp_path / "o.ply")
    vertex = elements["vertex"]
    assert {types["vertex", c] for c in ("red", "green", "blue")} == {"B"}
    light = [0.2 * r + 0.7 * g + 0.1 * b for r, g, b in zip(vertex["red"], vertex["green"], vertex["blue"])]
    by_density = [light for _, light in sorted(zip(vertex["quality"], light))]
    assert by_density[0] < by_density[len(light) // 2] < by_density[-1]
    assert by_density[-1] > by_density[0] + 80


@pytest.mark.parametrize(
    "options, estimator, normals",
    [
        ([], "auto", "fitted"),
        (["--normals", "auto"], "auto", "fitted"),
        (["--normals", "estimate"], "auto", "fitted"),
        (["--normals", "file", "--estimator", "auto"], "auto", "fitted"),
        (["--normals", "jet", "--k", "9", "--estimator", "auto"], "auto", "fitted"),
        (["--normals", "file"], "dirichlet", "file"),
        (["--normals", "pca"], "dirichlet", "pca"),
        (["--normals", "wpca"], "dirichlet", "wpca"),
        (["--normals", "jet"], "dirichlet", "jet 2"),
        (["--k", "20"], "dirichlet", "file"),
        (["--normals", "estimate", "--k", "12"], "dirichlet", "jet 4"),
        (["--normals", "estimate", "--degree", "3"], "dirichlet", "jet 3"),
        (["--normals", "estimate", "--orient", "local"], "dirichlet", "jet 4"),
        (["--estimator", "dirichlet"], "dirichlet", "file"),
    ],
)
def test_what_a_cloud_is_measured_with(gaussmap, options, estimator, normals):
    gaussmap("shape", "torus", "--jitter", 0.2, "--seed", 1, "-o", "t.ply")
    report = gaussmap("curvature", "t.ply", "--as", "cloud", "--json", *options).json
    assert (report["estimator"], report["normals"]) == (estimator, normals)
    fans = estimator != "auto"
    assert ("chosen" in report, report["k"] is None, report["boundary"] is None) == (not fans, not fans, not fans)
    assert (report["orient"] is None) == (not fans or normals == "file")
    assert gaussmap("curvature", "t.ply", "--json").json["estimator"] == "dirichlet", "meshes"


@pytest.mark.parametrize("kind", ["mesh", "cloud"])
@pytest.mark.parametrize("orient", ["local", "mst"])
def test_threads_change_no_byte(gaussmap, tmp_path, kind, orient):
    gaussmap("shape", "knot", "--jitter", 0.2, "--noise", 0.01, "--seed", 5, "-o", "k.ply")
    written = set()
    for threads in (1, 2, 7):
        options = ["--as", kind, "--orient", orient, "--normals", "estimate", "--color", "--threads", threads]
        assert gaussmap("curvature", "k.ply", "-o", "o.ply", *options).code == 0
        written.add((tmp_path / "o.ply").read_bytes())
    assert len(written) == 1


def test_several_outputs_hold_the_same(gaussmap, tmp_path):
    gaussmap("shape", "torus", "--grid", "9x9", "-o", "t.ply")
    names = ["o.ply", "o.obj", "o.off", "o.stl", "o.xyz", "o.pcd"]
    outputs = [word for name in names for word in ("-o", name)]
    report = gaussmap("curvature", "t.ply", "--color", "--json", *outputs).json
    assert report["outputs"] == names and all((tmp_path / name).stat().st_size > 500 for name in names)
    notes = "\n".join(report["notes"])
    for name in ("o.obj", "o.off", "o.stl"):
        assert f"{name} has no place for: " in notes
    assert "o.ply" not in notes
    density = ply.read(tmp_path / "o.ply")[0]["vertex"]["quality"]
    rows = (tmp_path / "o.xyz").read_text().splitlines()
    column = rows[0].lstrip("# ").split().index("scalar_total_curvature")
    assert [struct.pack("<f", float(row.split()[column])) for row in rows[1:]] == [struct.pack("<f", v) for v in density]
    assert (tmp_path / "o.off").read_text().startswith("CNOFF\n")
    assert gaussmap("curvature", "o.pcd", "--truth", "scalar_total_curvature", "--json").json["truth"]["compared"] == 81


def test_standard_input_and_output(gaussmap, tmp_path):
    gaussmap("shape", "torus", "-o", "t.ply")
    gaussmap("curvature", "t.ply", "-o", "file.ply")
    content = (tmp_path / "t.ply").read_bytes()
    run = gaussmap("curvature", "-", "-o", "-", stdin=content)
    assert run.code == 0 and run.stdout == (tmp_path / "file.ply").read_bytes()
    assert run.stderr.startswith("-: a mesh of 1,296 vertices")
    run = gaussmap("curvature", "-", "-o", "-", "--format", "obj", "-o", "also.off", "--quiet", stdin=content)
    assert run.stdout.startswith(b"v ") and run.stderr == "" and (tmp_path / "also.off").exists()
    assert gaussmap("curvature", "-", "--json", stdin=content).json["file"] == "-"


def test_ascii(gaussmap, tmp_path):
    gaussmap("shape", "torus", "--grid", "9x9", "-o", "t.ply")
    gaussmap("curvature", "t.ply", "-o", "text.ply", "--ascii")
    gaussmap("curvature", "t.ply", "-o", "binary.ply")
    assert b"\nformat ascii 1.0\n" in (tmp_path / "text.ply").read_bytes()
    assert ply.read(tmp_path / "text.ply")[0]["vertex"]["x"] == ply.read(tmp_path / "binary.ply")[0]["vertex"]["x"]


def test_unused_options_are_told(gaussmap):
    gaussmap("shape", "torus", "-o", "t.ply")
    options = ["--estimator", "dirichlet", "--k", 9, "--orient", "mst", "--degree", 2, "--json"]
    notes = gaussmap("curvature", "t.ply", *options).json["notes"]
    fits = "it is for --estimator jet and regression"
    assert notes == [f"{o} is not used: {why}" for o, why in zip(("--k", "--orient", "--degree"), (fits, "this is a mesh", fits))]
    notes = gaussmap("curvature", "t.ply", "--as", "cloud", "--k", 9, "--orient", "mst", "--json").json["notes"]
    assert notes == ["--orient is not used: the normals come from the file"]
    options = ["--as", "cloud", "--normals", "pca", "--degree", 2, "--json"]
    assert gaussmap("curvature", "t.ply", *options).json["notes"] == ["--degree is not used: a plane is fitted"]
    options = ["--as", "cloud", "--estimator", "auto", "--k", 9, "--orient", "mst", "--degree", 2, "--json"]
    names = ["--k", "--orient", "--degree"]
    notes = gaussmap("curvature", "t.ply", "--normals", "pca", *options).json["notes"]
    assert notes == [f"{o} is not used: --estimator auto chooses for itself" for o in [*names, "--normals"]]
    notes = gaussmap("curvature", "t.ply", "--normals", "file", *options).json["notes"]
    assert notes[3:] == ["--normals file tells the signs alone: --estimator auto fits its own"]


def test_a_cut_surface_is_told(gaussmap, data):
    report = gaussmap("curvature", data / "nasty/suzanne.ply", "--json").json
    assert report["duplicates"] == 1461
    (hint,) = [note for note in report["notes"] if "repeat the position" in note]
    assert hint == (
        "1,461 vertices repeat the position of another: the surface is cut there; gaussmap convert --weld joins it"
    )


def test_human_report(gaussmap):
    gaussmap("shape", "torus", "--grid", "9x9", "-o", "t.ply")
    run = gaussmap("curvature", "t.ply", "-o", "o.ply", "--truth", "exact_density")
    assert run.code == 0 and run.stdout == b""
    lines = run.stderr.splitlines()
    assert lines[0] == "t.ply: a mesh of 81 vertices and 162 faces"
    labels = [line[2:14].rstrip() for line in lines[1:] if line[2] != " "]
    assert labels == "normals estimator density percentiles kappa undefined degenerate duplicate non-finite truth time wrote".split()
    assert "(1/unit²)" in run.stderr and "\x1b" not in run.stderr
    assert gaussmap("curvature", "t.ply", "-o", "o.ply", "--quiet").stderr == ""


@pytest.mark.parametrize(
    "options, normals, rmse",
    [
        (["--estimator", "jet"], "jet 4", 0.003),
        (["--estimator", "jet", "--degree", 3, "--k", 14], "jet 3", 0.05),
        (["--estimator", "jet", "--degree", 2, "--k", 10, "--normals", "estimate"], "jet 2", 0.05),
        (["--estimator", "regression"], "file", 0.02),
        (["--estimator", "regression", "--k", 8], "file", 0.01),
        (["--estimator", "regression", "--normals", "jet", "--degree", 4], "jet 4", 0.03),
    ],
)
def test_fits_of_a_cloud(gaussmap, tmp_path, options, normals, rmse):
    gaussmap("shape", "torus", "--grid", "90x90", "--jitter", 0.2, "--seed", 1, "-o", "t.ply")
    truth = ["--as", "cloud", "--truth", "exact_density", "--confidence", "--json"]
    report = gaussmap("curvature", "t.ply", *truth, *options, "-o", "o.ply").json
    assert list(report)[:7] == KEYS_CLOUD[:7]
    assert (report["estimator"], report["normals"], report["notes"]) == (options[1], normals, [])
    assert report["undefined"] == report["lowered"] == report["boundary"] == 0
    assert report["truth"]["relative_rmse"] < rmse
    assert 0 < report["confidence"]["median_relative_error"] < 2 * rmse
    vertex = ply.read(tmp_path / "o.ply")[0]["vertex"]
    assert min(vertex["density_error"]) > 0 and min(vertex["scalar_total_curvature"]) > 0


@pytest.mark.parametrize(
    "options, normals, rmse",
    [
        (["--estimator", "jet"], "jet 4", 0.003),
        (["--estimator", "jet", "--degree", 2, "--k", 10], "jet 2", 0.05),
        (["--estimator", "regression"], "file", 0.02),
        (["--estimator", "regression", "--normals", "estimate"], "jet 4", 0.02),
        (["--estimator", "regression", "--normals", "estimate", "--degree", 3], "jet 3", 0.03),
        (["--estimator", "regression", "--normals", "angle"], "angle", 0.2),
    ],
)
def test_fits_of_a_mesh(gaussmap, tmp_path, options, normals, rmse):
    gaussmap("shape", "torus", "--grid", "90x90", "--jitter", 0.2, "--seed", 1, "-o", "t.ply")
    truth = ["--truth", "exact_density", "--confidence", "--tensor", "--json"]
    report = gaussmap("curvature", "t.ply", *truth, *options, "-o", "o.ply").json
    assert (report["estimator"], report["normals"]) == (options[1], normals)
    assert report["notes"] == ["the vertex properties 'k1' and 'k2' of the input are replaced"]
    assert report["k"] == (10 if "--k" in options else 20)
    assert report["undefined"] == report["lowered"] == 0
    assert report["truth"]["relative_rmse"] < rmse
    elements, _ = ply.read(tmp_path / "o.ply")
    assert min(elements["vertex"]["density_error"]) > 0 and min(elements["vertex"]["k1"]) > 0
    assert min(elements["face"]["kappa"]) > 0


def test_what_fits_of_a_mesh_do_not_use_is_told(gaussmap):
    gaussmap("shape", "torus", "-o", "t.ply")
    options = ["--estimator", "regression", "--degree", 3, "--json"]
    assert gaussmap("curvature", "t.ply", *options).json["notes"] == ["--degree is not used: the normals are not fitted"]


def test_what_fits_do_not_use_is_told(gaussmap):
    gaussmap("shape", "torus", "-o", "t.ply")

    def notes(*options):
        return gaussmap("curvature", "t.ply", "--as", "cloud", "--json", *options).json["notes"]

    estimate = ["--normals", "estimate"]
    dirichlet_only = "--orient is not used: it is for --estimator dirichlet"
    for options in (["--estimator", "jet"], ["--estimator", "regression"]):
        assert notes(*options, "--k", 14, "--degree", 3, "--orient", "mst", *estimate) == [dirichlet_only]
    assert notes("--estimator", "regression", "--degree", 3) == ["--degree is not used: the normals come from the file"]
    assert notes("--estimator", "jet", "--degree", 3) == []
    assert notes("--estimator", "jet", "--normals", "pca") == ["--normals is not used: the jet has a normal of its own"]
    (sides,) = notes("--estimator", "jet", "--tensor", *estimate)
    assert sides.endswith("need not agree from point to point; normals in the file make them")
    assert notes("--estimator", "jet", "--tensor") == []
