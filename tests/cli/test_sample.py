"""gaussmap sample: what it writes, and what it refuses."""

import math

import ply
import pytest

TRIANGLE = b"""ply
format ascii 1.0
element vertex 3
property double x
property double y
property double z
property float nx
property float ny
property float nz
property uchar red
property int label
property float heat
element face 1
property list uchar int vertex_indices
property float kappa
end_header
0 0 2 0 0 1 0 7 1
4 0 2 0 1 1 100 8 5
0 4 2 0 0 1 200 9 1
3 0 1 2 0.5
"""


@pytest.fixture
def triangle(tmp_path):
    (tmp_path / "t.ply").write_bytes(TRIANGLE)
    return "t.ply"


@pytest.mark.parametrize("method", ["poisson", "nonuniform", "random"])
def test_carries_what_the_vertices_have(gaussmap, tmp_path, triangle, method):
    run = gaussmap("sample", triangle, "-o", "p.ply", "--count", "321", "--method", method, "--json")
    report = run.json
    assert (report["points"], report["vertices"], report["faces"], report["method"]) == (321, 3, 1, method)
    assert report["notes"] == ["points do not carry 'kappa of the faces'"]
    elements, types = ply.parse((tmp_path / "p.ply").read_bytes())
    points = elements["vertex"]
    assert len(points["x"]) == 321 and not elements.get("face", {}).get("vertex_indices")
    assert types["vertex", "x"] == "d" and types["vertex", "red"] == "B" and types["vertex", "label"] == "i"
    for x, y, z, nx, ny, nz, red, label, heat in zip(
        *(points[name] for name in ("x", "y", "z", "nx", "ny", "nz", "red", "label", "heat"))
    ):
        assert z == 2 and x >= 0 and y >= 0 and x + y <= 4 * (1 + 1e-15)
        assert math.hypot(nx, ny, nz) == pytest.approx(1, abs=1e-6) and ny == pytest.approx(nz * x / 4, abs=1e-6)
        assert abs(red - (25 * x + 50 * y)) <= 0.5 + 1e-9
        assert heat == pytest.approx(1 + x, abs=1e-5)
        assert label == (8 if x > max(y, 4 - x - y) else 9 if y > max(x, 4 - x - y) else 7)


def test_same_file_for_a_seed_and_any_threads(gaussmap, tmp_path):
    gaussmap("shape", "torus", "-o", "t.ply")

    def points(*options):
        run = gaussmap("sample", "t.ply", "-o", "-", "--count", "500", *options)
        assert run.code == 0
        return run.stdout

    assert points("--threads", "1") == points("--threads", "3") == points("--seed", "0")
    assert points() != points("--seed", "1")
    assert points("--method", "random") != points()


def test_truth_goes_from_shape_to_cloud(gaussmap):
    gaussmap("shape", "torus", "--grid", "400x200", "-o", "t.ply")
    gaussmap("sample", "t.ply", "-o", "p.ply", "--count", "4000")
    report = gaussmap("curvature", "p.ply", "--truth", "exact_density", "--json").json
    assert report["kind"] == "cloud" and report["vertices"] == 4000
    assert report["truth"]["relative_rmse"] < 0.02


def test_no_normals_without_normals(gaussmap, tmp_path):
    (tmp_path / "t.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    gaussmap("sample", "t.off", "-o", "p.ply")
    points = ply.parse((tmp_path / "p.ply").read_bytes())[0]["vertex"]
    assert set(points) == {"x", "y", "z"} and len(points["x"]) == 10000


def test_text_goes_to_standard_error(gaussmap, triangle):
    run = gaussmap("sample", triangle, "-o", "p.xyz", "--count", "50", "--seed", "3")
    assert run.code == 0 and run.stdout == b""
    assert "50, poisson, seed 3" in run.stderr and "p.xyz" in run.stderr


@pytest.mark.parametrize(
    "arguments, code, line",
    [
        ("", 2, "sample: MESH is missing; write: gaussmap sample MESH -o OUT… [options]"),
        ("t.ply", 2, "sample: -o OUT is missing; write: gaussmap sample MESH -o OUT… [options]"),
        ("t.ply -o p.ply --count 0", 2, "--count: '0' is not a whole number from 1 to 100000000"),
        ("t.ply -o p.ply --count 1.5", 2, "--count: '1.5' is not a whole number from 1 to 100000000"),
        (
            "t.ply -o p.ply --method poison",
            2,
            "--method: 'poison' is not one of poisson, nonuniform, random; did you mean 'poisson'?",
        ),
        ("flat.off -o p.ply", 3, "flat.off: faces have no area; there is nothing to sample"),
        ("nan.off -o p.ply", 3, "nan.off: vertices[0], of faces[0], is not finite; leave it out first"),
        ("cloud.xyz -o p.ply", 3, None),
    ],
)
def test_refuses(gaussmap, tmp_path, triangle, arguments, code, line):
    (tmp_path / "flat.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")
    (tmp_path / "nan.off").write_text("OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    (tmp_path / "cloud.xyz").write_text("0 0 0\n1 0 0\n")
    run = gaussmap("sample", *arguments.split())
    if line is None:
        assert run.code == code and run.stderr.startswith("gaussmap: cloud.xyz: ") and run.stderr.count("\n") == 1
    else:
        run.fails(code, line)
    assert not (tmp_path / "p.ply").exists()
