"""gaussmap curvature --tensor, --confidence, --choice: properties, reports, what is kept."""

import math
import statistics

import ply
import pytest

VERTEX = ["k1", "k2", "mean", "gaussian", "shape_index", "curvedness", "d1x", "d1y", "d1z"]
FACE = ["k1", "k2", "d1x", "d1y", "d1z"]


def sine(direction, along):
    """Of the angle between two lines."""
    cosine = sum(a * b for a, b in zip(direction, along)) / math.hypot(*along)
    return math.sqrt(max(0, 1 - cosine**2))


def rows(element, names):
    return zip(*(element[name] for name in names))


@pytest.mark.parametrize("options", [[], ["--estimator", "corrected"], ["--as", "cloud"], ["--as", "cloud", "--k", "20"]])
def test_a_torus(gaussmap, tmp_path, options):
    gaussmap("shape", "torus", "--major", 1, "--minor", 0.5, "--grid", "72x48", "-o", "t.ply")
    report = gaussmap("curvature", "t.ply", "--tensor", "-o", "o.ply", "--json", *options).json
    elements, types = ply.read(tmp_path / "o.ply")
    vertex, exact = elements["vertex"], ply.read(tmp_path / "t.ply")[0]["vertex"]
    assert all(types["vertex", name] == "f" for name in VERTEX)
    assert "the vertex properties 'k1' and 'k2' of the input are replaced" in report["notes"]
    for k1, k2, mean, gaussian, index, curved, x, y, z, *d in rows(vertex, VERTEX[:6] + ["x", "y", "z", *VERTEX[6:]]):
        out = math.hypot(x, y)
        assert k1 == pytest.approx(2, abs=0.01)
        assert k2 == pytest.approx((out - 1) / 0.5 / out, abs=0.02)
        assert mean == pytest.approx((k1 + k2) / 2, abs=1e-6) and gaussian == pytest.approx(k1 * k2, abs=1e-5)
        assert curved == pytest.approx(math.sqrt((k1**2 + k2**2) / 2), rel=1e-6)
        assert index == pytest.approx(2 / math.pi * math.atan((k1 + k2) / (k1 - k2)), abs=1e-5)
        cosine, up = (out - 1) / 0.5, z / 0.5
        assert sine(d, (-up * x / out, -up * y / out, cosine)) < 0.01, "around the tube"
    if not options or "cloud" not in options:
        assert all(types["face", name] == "f" for name in FACE)
        for k1, k2, *d in rows(elements["face"], FACE):
            assert k1 == pytest.approx(2, rel=0.02) and -2.1 < k2 < 0.8
            assert math.hypot(*d) == pytest.approx(1, abs=1e-6)
    assert list(report["tensor"]) == ["k1", "k2"]
    for name in ("k1", "k2"):
        assert list(report["tensor"][name]) == ["min", "mean", "rms", "max", "p02", "p50", "p98"]
        assert report["tensor"][name]["mean"] == pytest.approx(statistics.fmean(vertex[name]), abs=1e-5)
        assert report["tensor"][name]["max"] == pytest.approx(max(exact[name]), abs=0.02)
    keys = list(report)
    assert keys[keys.index("density") + 1] == "tensor"


def test_a_catenoid(gaussmap, tmp_path):
    gaussmap("shape", "catenoid", "--grid", "80x40", "-o", "c.ply")
    gaussmap("curvature", "c.ply", "--tensor", "-o", "o.ply")
    vertex = ply.read(tmp_path / "o.ply")[0]["vertex"]
    exact = ply.read(tmp_path / "c.ply")[0]["vertex"]
    scale = max(exact["k1"])
    for k1, k2, true1, mean, gaussian, index, x, y, *d in rows(
        vertex | {"true1": exact["k1"]}, ["k1", "k2", "true1", "mean", "gaussian", "shape_index", "x", "y", *VERTEX[6:]]
    ):
        assert k1 == pytest.approx(true1, abs=0.03 * scale) and k2 == pytest.approx(-true1, abs=0.05 * scale)
        assert abs(mean) < 0.03 * scale and gaussian < 0 and abs(index) < 0.07
        assert sine(d, (-y, x, 0)) < 0.03, "around the axis"


def test_a_plane_has_no_shape(gaussmap, tmp_path):
    gaussmap("shape", "plane", "--grid", "9x9", "-o", "p.ply")
    report = gaussmap("curvature", "p.ply", "--tensor", "-o", "o.ply", "--json").json
    elements, _ = ply.read(tmp_path / "o.ply")
    for name in ("k1", "k2", "mean", "gaussian", "curvedness"):
        assert set(elements["vertex"][name]) == {0}
    assert all(math.isnan(v) for v in elements["vertex"]["shape_index"])
    assert report["tensor"]["k1"]["max"] == 0 and set(elements["face"]["k2"]) == {0}


def test_undefined_is_nan_and_null(gaussmap, tmp_path):
    (tmp_path / "lonely.off").write_bytes(b"OFF\n4 1 0\n0 0 0\n1 0 0\n2 0 0\n5 5 5\n3 0 1 2\n")
    report = gaussmap("curvature", "lonely.off", "--tensor", "-o", "o.ply", "--json").json
    elements, _ = ply.read(tmp_path / "o.ply")
    assert all(math.isnan(v) for name in VERTEX for v in elements["vertex"][name])
    assert all(math.isnan(v) for name in FACE for v in elements["face"][name])
    assert set(report["tensor"]["k1"].values()) == {None}


def test_what_the_input_had_is_kept(gaussmap, tmp_path):
    (tmp_path / "in.ply").write_bytes(
        b"ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        b"property uchar label\nproperty float mean\nelement face 4\nproperty list uchar int vertex_indices\n"
        b"property short k1\nproperty short group\nend_header\n0 0 0 1 9\n1 0 0 2 9\n0 1 0 3 9\n0 0 1 4 9\n"
        b"3 0 2 1 1 10\n3 0 1 3 1 20\n3 1 2 3 1 30\n3 2 0 3 1 40\n"
    )
    report = gaussmap("curvature", "in.ply", "--tensor", "-o", "out.ply", "--json").json
    elements, types = ply.read(tmp_path / "out.ply")
    assert elements["vertex"]["label"] == [1, 2, 3, 4] and elements["face"]["group"] == [10, 20, 30, 40]
    assert types["face", "k1"] == "f" and 9 not in elements["vertex"]["mean"]
    assert "the vertex property 'mean' of the input is replaced" in report["notes"]
    gaussmap("curvature", "out.ply", "--tensor", "-o", "again.ply")
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "out.ply").read_bytes()
    gaussmap("curvature", "in.ply", "-o", "plain.ply")
    assert "k1" not in ply.read(tmp_path / "plain.ply")[0]["vertex"]


def test_clouds_as_text_and_pcd(gaussmap, tmp_path):
    gaussmap("shape", "sphere", "--radius", 2, "-o", "s.ply")
    for name in ("o.xyz", "o.pcd"):
        gaussmap("curvature", "s.ply", "--as", "cloud", "--estimator", "dirichlet", "--tensor", "-o", name)
        gaussmap("convert", name, "-o", "back.ply")
        vertex = ply.read(tmp_path / "back.ply")[0]["vertex"]
        assert set(VERTEX) <= set(vertex)
        assert all(k == pytest.approx(0.5, abs=1e-6) for k in vertex["k1"] + vertex["k2"] + vertex["curvedness"])
        assert all(v == pytest.approx(1) for v in vertex["shape_index"])


def test_signs_follow_the_normals(gaussmap, tmp_path):
    gaussmap("shape", "sphere", "--subdivisions", 4, "--jitter", 0.2, "--seed", 1, "-o", "s.ply")
    options = ["--as", "cloud", "--normals", "estimate", "--tensor", "-o", "o.ply", "--json"]
    words = (
        "each point has its own normal's side, so the signs of k1, k2, mean and shape_index need not agree from point "
        "to point; "
    )
    automatic = words + "normals in the file make them, and gaussmap normals writes such"
    assert automatic in gaussmap("curvature", "s.ply", *options).json["notes"]
    mean = ply.read(tmp_path / "o.ply")[0]["vertex"]["mean"]
    assert min(mean) < -0.9 and max(mean) > 0.9
    report = gaussmap("curvature", "s.ply", "--as", "cloud", "--tensor", "-o", "o.ply", "--json").json
    assert automatic not in report["notes"] and report["estimator"] == "auto"
    assert min(ply.read(tmp_path / "o.ply")[0]["vertex"]["mean"]) > 0.9, "outward as the normals of the file"

    options += ["--estimator", "dirichlet"]
    note = words + "--orient mst makes them"
    assert note in gaussmap("curvature", "s.ply", *options).json["notes"]
    mean = ply.read(tmp_path / "o.ply")[0]["vertex"]["mean"]
    assert min(mean) < -0.9 and max(mean) > 0.9
    assert note not in gaussmap("curvature", "s.ply", "--orient", "mst", *options).json["notes"]
    assert min(ply.read(tmp_path / "o.ply")[0]["vertex"]["mean"]) > 0.9
    assert note not in gaussmap("curvature", "s.ply", "--as", "cloud", "--tensor", "--json").json["notes"]


def test_the_report_in_words(gaussmap):
    gaussmap("shape", "sphere", "--radius", 2, "-o", "s.ply")
    lines = gaussmap("curvature", "s.ply", "--tensor").stderr.splitlines()
    assert "  k1           mean 0.5, rms 0.5, from 0.5 to 0.5 (1/unit)" in lines
    assert "k1" not in gaussmap("curvature", "s.ply").stderr


def test_no_keys_that_were_not_asked_for(gaussmap):
    gaussmap("shape", "sphere", "-o", "s.ply")
    report = gaussmap("curvature", "s.ply", "--json").json
    assert not {"tensor", "confidence", "chosen"} & set(report)
    report = gaussmap("curvature", "s.ply", "--as", "cloud", "--json").json
    assert not {"tensor", "confidence"} & set(report) and report["chosen"] == {"quartic 24": report["vertices"]}


FAMILIES = ("quadric", "half mean quadric", "mean quadric", "half slope", "slope", "quartic free", "sphere", "fine sphere",
            "extrapolated sphere")
NAMES = {"none", "quadric 9", "quartic 24"} | {
    f"{family} {first * 3**level}" for family in FAMILIES for first in (24, 35, 50) for level in range(5)
}


@pytest.mark.parametrize("noise", [0, 0.1])
def test_auto_tells_its_errors_and_choices(gaussmap, tmp_path, noise):
    gaussmap("shape", "torus", "--grid", "72x36", "--jitter", 0.2, "--noise", noise, "--seed", 1, "-o", "t.ply")
    options = ["--as", "cloud", "--estimator", "auto", "--confidence", "--choice", "--truth", "exact_density"]
    report = gaussmap("curvature", "t.ply", *options, "-o", "o.ply", "--json").json
    elements, types = ply.read(tmp_path / "o.ply")
    vertex = elements["vertex"]
    assert [types["vertex", name] for name in ("scalar_total_curvature", "density_error", "choice")] == ["f", "f", "B"]
    assert vertex["scalar_total_curvature"] == vertex["quality"]
    assert all(error > 0 for error in vertex["density_error"]) and "kappa" not in vertex
    assert report["estimator"] == "auto" and report["normals"] == "fitted"
    assert (report["k"], report["orient"], report["boundary"]) == (None, None, None)
    counts = sorted(vertex["choice"].count(choice) for choice in set(vertex["choice"]))
    assert sorted(report["chosen"].values()) == counts and sum(counts) == report["vertices"]
    assert set(report["chosen"]) <= NAMES
    assert (set(report["chosen"]) == {"quartic 24"}) == (noise == 0)
    assert 0.9 <= report["confidence"]["truth_within_two_errors"] <= 1
    relative = statistics.median(e / d for e, d in zip(vertex["density_error"], vertex["quality"]))
    assert report["confidence"]["median_relative_error"] == pytest.approx(relative, rel=1e-5)
    assert report["truth"]["relative_rmse"] < (0.06 if noise else 0.002)

    words = gaussmap("curvature", "t.ply", *options).stderr
    line = " ".join(words.partition("  chosen ")[2].partition("  density ")[0].split())
    most = sorted(report["chosen"].values(), reverse=True)
    told = [int(part.split(": ")[1].replace(",", "")) for part in line.split("; ")]
    assert told[:3] == most[:3] and sum(told) == report["vertices"]
    assert "others: " in line if len(most) > 3 else "others" not in line
    assert "nan" not in words.lower() and "kappa" not in words and "boundary" not in words


@pytest.mark.parametrize("noise", [0, 0.1])
def test_auto_is_the_same_for_any_number_of_threads(gaussmap, tmp_path, noise):
    gaussmap("shape", "torus", "--grid", "60x30", "--jitter", 0.2, "--noise", noise, "--seed", 2, "-o", "t.ply")
    options = ["--as", "cloud", "--confidence", "--choice", "--tensor"]
    written = set()
    for threads in (1, 2, 7):
        assert gaussmap("curvature", "t.ply", *options, "-o", "o.ply", "--threads", threads).code == 0
        written.add((tmp_path / "o.ply").read_bytes())
    assert len(written) == 1
