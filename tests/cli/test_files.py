"""gaussmap shape, convert, info and normals."""

import math

import ply
import pytest

SHAPES = {
    "sphere": (10242, 20480),
    "torus": (1296, 2592),
    "knot": (16000, 32000),
    "figure-eight": (16000, 32000),
    "ellipsoid": (10242, 20480),
    "bumpy": (40962, 81920),
    "catenoid": (2592, 5040),
    "cylinder": (2592, 5040),
    "plane": (1296, 2450),
    "waves": (10000, 19602),
}


@pytest.mark.parametrize("name", SHAPES)
def test_every_shape_by_default(gaussmap, name):
    report = gaussmap("shape", name, "-o", "s.ply", "--json").json
    assert list(report) == "name vertices faces parameters seconds peak_bytes outputs notes".split()
    assert (report["vertices"], report["faces"]) == SHAPES[name]
    truth = gaussmap("curvature", "s.ply", "--truth", "exact_density", "--json").json["truth"]
    assert truth["compared"] == SHAPES[name][0]
    # A flat surface has no error to be relative to.
    assert truth["rmse"] == 0 if name == "plane" else truth["relative_rmse"] < 0.1


def test_shape_carries_its_truth_in_double(gaussmap, tmp_path):
    report = gaussmap("shape", "torus", "--major", 2, "--minor", 0.5, "--grid", "12x9", "-o", "t.ply", "--json").json
    assert report["parameters"] == {"around": 12, "across": 9, "major": 2, "minor": 0.5, "jitter": 0, "noise": 0, "noise_unit": "edge", "seed": 0}
    elements, types = ply.read(tmp_path / "t.ply")
    vertex = elements["vertex"]
    for name in ("x", "y", "z", "nx", "ny", "nz", "exact_density", "k1", "k2"):
        assert types["vertex", name] == "d"
    assert len(elements["face"]["vertex_indices"]) == 216
    for i in range(108):
        x, y, z, nx, ny, nz = (vertex[c][i] for c in ("x", "y", "z", "nx", "ny", "nz"))
        cosine = (math.hypot(x, y) - 2) / 0.5
        assert math.hypot(nx, ny, nz) == pytest.approx(1, abs=1e-14)
        assert nz == pytest.approx(z / 0.5, abs=1e-12)
        assert vertex["k1"][i] == pytest.approx(2) and vertex["k2"][i] == pytest.approx(cosine / (2 + 0.5 * cosine))
        assert vertex["exact_density"][i] == vertex["k1"][i] ** 2 + vertex["k2"][i] ** 2


def test_shape_parameters(gaussmap):
    report = gaussmap("shape", "ellipsoid", "--axes", "3,2,1", "--subdivisions", 2, "-o", "e.ply", "--json").json
    assert report["parameters"] == {"subdivisions": 2, "a": 3, "b": 2, "c": 1, "jitter": 0, "noise": 0, "noise_unit": "edge", "seed": 0}
    assert gaussmap("info", "e.ply", "--json").json["box"]["maximum"][0] == pytest.approx(3, rel=0.02)


def test_noise_of_the_edge_or_of_the_diagonal(gaussmap):
    def off(*options):
        gaussmap("shape", "sphere", "--subdivisions", 4, "-o", "s.ply", "--noise", 0.01, *options)
        gaussmap("convert", "s.ply", "-o", "p.xyz")
        gaussmap("shape", "sphere", "--subdivisions", 7, "-o", "truth.ply")
        return gaussmap("compare", "p.xyz", "truth.ply", "--json", "--samples", 1).json["forward"]["rms"]

    assert off("--noise-unit", "diagonal") == pytest.approx(0.01, rel=0.1)
    assert off("--noise-unit", "edge") == pytest.approx(0.01 * 0.0758 / (2 * math.sqrt(3)), rel=0.1)
    run = gaussmap("shape", "sphere", "-o", "s.ply", "--noise-unit", "edges")
    run.fails(2, "--noise-unit: 'edges' is not one of edge, diagonal; did you mean 'edge'?")


def test_seed_and_threads(gaussmap, tmp_path):
    def made(*options):
        assert gaussmap("shape", "torus", "--jitter", 0.2, "--noise", 0.05, "-o", "t.ply", *options).code == 0
        return (tmp_path / "t.ply").read_bytes()

    assert made("--seed", 1) == made("--seed", 1, "--threads", 7)
    assert made("--seed", 1) != made("--seed", 2)
    assert made() == made("--seed", 0)


@pytest.mark.parametrize("name", ["a.ply", "a.obj", "a.off", "a.stl", "a.xyz", "a.pcd", "a.pwn", "a.PLY"])
def test_formats_lead_back_to_the_same_points(gaussmap, tmp_path, name):
    gaussmap("shape", "torus", "--grid", "9x9", "-o", "t.ply")
    assert gaussmap("convert", "t.ply", "-o", name).code == 0
    assert gaussmap("convert", name, "--weld", "-o", "back.ply").code == 0
    ours, theirs = (ply.read(tmp_path / p)[0]["vertex"] for p in ("t.ply", "back.ply"))
    tolerance = 1e-7 if name == "a.stl" else 0
    first = sorted(zip(ours["x"], ours["y"], ours["z"]))
    second = sorted(zip(theirs["x"], theirs["y"], theirs["z"]))
    if name != "a.stl":
        assert first == second
    else:
        assert len(first) == len(second)
        assert sum(map(math.fsum, first)) == pytest.approx(sum(map(math.fsum, second)), abs=100 * tolerance)


@pytest.mark.parametrize(
    "name, loss",
    [
        ("a.obj", "a.obj has no place for: exact_density, k1, k2; .ply has"),
        ("a.off", "a.off has no place for: exact_density, k1, k2; .ply has"),
        ("a.stl", "a.stl has no place for: normals, exact_density, k1, k2; .ply has"),
        ("a.xyz", "a.xyz has no place for: faces; .ply has"),
        ("a.pcd", "a.pcd has no place for: faces; .ply has"),
        ("a.ply", None),
    ],
)
def test_what_is_lost_is_told_and_true(gaussmap, name, loss):
    gaussmap("shape", "torus", "--grid", "9x9", "-o", "t.ply")
    assert gaussmap("convert", "t.ply", "-o", name, "--json").json["notes"] == ([loss] if loss else [])
    report = gaussmap("info", name, "--json").json
    found = {p["name"] for p in report["vertex_properties"]}
    assert found == (set() if name in ("a.obj", "a.off", "a.stl") else {"exact_density", "k1", "k2"})
    assert (report["normals"] is None) == (name == "a.stl")
    assert (report["faces"] == 0) == (name in ("a.xyz", "a.pcd"))


def test_weld_and_triangulate(gaussmap, data):
    soup = data / "nasty/unit_cube.STL"
    report = gaussmap("convert", soup, "--weld", "-o", "cube.ply", "--json").json
    assert (report["vertices"], report["faces"]) == (8, 12)
    quads = data / "meshes/classic/torus_quad.off"
    assert gaussmap("convert", quads, "-o", "q.ply", "--json").json["polygons"] == 25
    report = gaussmap("convert", quads, "--triangulate", "-o", "t.ply", "--json").json
    assert report["polygons"] is None and report["faces"] == 50


def test_convert_in_a_pipe(gaussmap):
    run = gaussmap("convert", "-", "-o", "-", "--format", "xyz", "-q", stdin=b"OFF\n2 0 0\n0 0 0\n1 2 3\n")
    assert (run.code, run.stdout, run.stderr) == (0, b"0 0 0\n1 2 3\n", "")


def test_info_of_a_mesh(gaussmap):
    gaussmap("shape", "torus", "-o", "t.ply")
    report = gaussmap("info", "t.ply", "--json").json
    expected = {"file": "t.ply", "kind": "mesh", "format": "ply", "vertices": 1296, "faces": 2592, "polygons": None,
                "vertex_type": "float64", "normals": "float64", "edges": 3888, "boundary_edges": 0, "components": 1,
                "non_manifold_edges": 0, "non_manifold_vertices": 0, "degenerate_faces": 0, "duplicate_vertices": 0,
                "isolated_vertices": 0, "inconsistent_edges": 0, "non_finite": 0, "notes": []}
    assert {key: report[key] for key in expected} == expected
    assert {"name": "k1", "type": "float64", "list": False} in report["vertex_properties"]
    assert report["box"]["minimum"] == pytest.approx([-1.5, -1.5, -0.5])
    assert report["area"] == pytest.approx(4 * math.pi**2 * 0.5, rel=0.01)
    run = gaussmap("info", "t.ply")
    assert run.stdout == b"" and "3,888" in run.stderr and "none: closed" in run.stderr


def test_info_of_a_cloud(gaussmap):
    report = gaussmap("info", "-", "--json", stdin=b"0 0 0\n1 2 3\n1 2 3\nnan 0 0\n").json
    assert (report["kind"], report["vertices"], report["faces"]) == ("cloud", 4, 0)
    assert (report["duplicate_vertices"], report["non_finite"]) == (1, 1)
    assert "edges" not in report and report["box"]["diagonal"] == pytest.approx(math.sqrt(14))
    assert gaussmap("info", "-", "--json", stdin=b"nan 0 0\n").json["box"] is None


def test_info_answers_an_empty_file_of_a_known_format(gaussmap):
    assert gaussmap("info", "-", "--json", stdin=b"OFF\n0 0 0\n").json["vertices"] == 0


def test_info_shows_elements_and_comments(gaussmap, tmp_path):
    (tmp_path / "in.ply").write_bytes(
        b"ply\nformat ascii 1.0\ncomment caf\xe9\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        b"property list uchar short tags\nelement camera 2\nproperty double angle\nend_header\n0 0 0 2 7 8\n1\n2\n"
    )
    report = gaussmap("info", "in.ply", "--json").json
    assert report["comments"] == ["caf\ufffd"], "no UTF-8, so replaced: JSON must stay JSON"
    assert report["vertex_properties"] == [{"name": "tags", "type": "int16", "list": True}]
    camera = {"name": "camera", "count": 2, "properties": [{"name": "angle", "type": "float64", "list": False}]}
    assert report["elements"] == [camera]
    assert "tags (list of int16)" in gaussmap("info", "in.ply").stderr


@pytest.mark.parametrize("method", ["max", "angle", "area"])
def test_normals_of_a_mesh(gaussmap, tmp_path, method):
    gaussmap("shape", "torus", "-o", "t.ply")
    report = gaussmap("normals", "t.ply", "--method", method, "-o", "n.ply", "--json").json
    assert (report["kind"], report["method"], report["undefined"]) == ("mesh", method, 0)
    exact, ours = (ply.read(tmp_path / p)[0]["vertex"] for p in ("t.ply", "n.ply"))
    for i in range(0, 1296, 7):
        assert sum(exact[c][i] * ours[c][i] for c in ("nx", "ny", "nz")) > 0.995
    assert ours["nx"] != exact["nx"]


@pytest.mark.parametrize("options, name", [([], "jet 4"), (["--degree", 2], "jet 2"), (["--method", "pca"], "pca"), (["--method", "wpca"], "wpca")])
def test_normals_of_a_cloud(gaussmap, tmp_path, options, name):
    gaussmap("shape", "sphere", "--subdivisions", 4, "-o", "s.ply")
    gaussmap("convert", "s.ply", "-o", "s.xyz")
    report = gaussmap("normals", "s.xyz", "-o", "n.ply", "--json", *options).json
    assert (report["kind"], report["method"], report["k"], report["orient"]) == ("cloud", name, 20, "mst")
    assert report["undefined"] == report["duplicates"] == report["non_finite"] == 0
    vertex = ply.read(tmp_path / "n.ply")[0]["vertex"]
    for i in range(len(vertex["x"])):  # on a unit sphere the outward normal is the position
        assert sum(vertex[c][i] * vertex["n" + c][i] for c in "xyz") > 0.99


def test_normals_that_are_undefined_are_counted(gaussmap, tmp_path):
    (tmp_path / "line.xyz").write_bytes(b"0 0 0\n1 0 0\n2 0 0\n2 0 0\nnan 0 0\n")
    report = gaussmap("normals", "line.xyz", "-o", "n.ply", "--json").json
    assert (report["undefined"], report["duplicates"], report["non_finite"]) == (5, 1, 1)
    assert all(math.isnan(v) for v in ply.read(tmp_path / "n.ply")[0]["vertex"]["nx"])


def test_normals_feed_curvature(gaussmap):
    gaussmap("shape", "sphere", "--subdivisions", 4, "-o", "s.ply")
    gaussmap("normals", "s.ply", "--as", "cloud", "-o", "n.ply")
    report = gaussmap("curvature", "n.ply", "--as", "cloud", "--normals", "file", "--json").json
    assert report["normals"] == "file" and report["density"]["mean"] == pytest.approx(2, rel=0.01)


@pytest.mark.parametrize(
    ("comment", "read"),
    [
        (b'a "quoted" back\\slash', 'a "quoted" back\\slash'),
        (b"a\tb\x01c\x7f", "a\tb\x01c\x7f"),
        ("é€😀\U0010ffff".encode(), "é€😀\U0010ffff"),
        (b"overlong \xc0\xaf \xe0\x80\xaf.", "overlong \ufffd\ufffd \ufffd\ufffd\ufffd."),
        (b"surrogate \xed\xa0\x80.", "surrogate \ufffd\ufffd\ufffd."),
        (b"beyond \xf4\x90\x80\x80.", "beyond \ufffd\ufffd\ufffd\ufffd."),
        (b"cut off \xf0\x9f\x98", "cut off \ufffd"),
    ],
)
def test_any_text_of_a_file_becomes_json(gaussmap, comment, read):
    head = b"ply\nformat ascii 1.0\ncomment " + comment + b"\nelement vertex 1\n"
    file = head + b"property float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n"
    assert gaussmap("info", "-", "--json", stdin=file).json["comments"] == [read]
