"""gaussmap decimate: targets, what is reported, values carried over, and what it refuses."""

import math

import pytest
from ply import read


def shape(gaussmap, name="bumpy", *options):
    assert gaussmap("shape", name, "-o", "in.ply", "--subdivisions", "4", *options).code == 0


def test_targets(gaussmap):
    shape(gaussmap)
    report = gaussmap("decimate", "in.ply", "-o", "out.ply", "--faces", "500", "--json").json
    assert (report["faces_in"], report["faces_out"], report["vertices_out"]) == (5120, 500, 252)
    assert report["reached"] is True and report["reason"] is None and report["target"] == 500
    assert 0 < report["error"]["rms"] < report["error"]["max"] < 0.02 and report["error"]["bound"] is None
    assert set(report["seconds"]) == {"read", "collapse", "fit", "decimate", "measure", "write", "total"}
    compared = gaussmap("compare", "in.ply", "out.ply", "--json").json["symmetric"]
    assert compared["max"] == pytest.approx(report["error"]["max"], rel=0.1)
    assert compared["rms"] == pytest.approx(report["error"]["rms"], rel=0.02)
    assert gaussmap("decimate", "in.ply", "-o", "out.ply", "--ratio", "0.1", "--fast", "--json").json["faces_out"] == 512


def test_the_error_promised_is_kept(gaussmap):
    shape(gaussmap)
    report = gaussmap("decimate", "in.ply", "-o", "out.ply", "--error", "0.01", "--json").json
    assert report["error"]["max"] <= report["error"]["bound"] <= 0.01 and report["faces_out"] < 1000
    bound = gaussmap("compare", "in.ply", "out.ply", "--bound", "--json").json["bound"]
    assert max(bound["forward"]["lower"], bound["backward"]["lower"]) <= 0.01


def test_says_why_the_target_was_not_reached(gaussmap):
    shape(gaussmap, "sphere")
    run = gaussmap("decimate", "in.ply", "-o", "out.ply", "--faces", "1")
    assert run.code == 0
    assert "stopped" in run.stderr and "no valid collapse is left" in run.stderr


def test_values_of_vertices_are_carried(gaussmap, tmp_path):
    shape(gaussmap, "sphere")
    assert gaussmap("curvature", "in.ply", "-o", "colored.ply", "--color").code == 0
    assert gaussmap("decimate", "colored.ply", "-o", "out.ply", "--faces", "600").code == 0
    elements, types = read(tmp_path / "out.ply")
    vertices = elements["vertex"]
    for p, n in zip(zip(*(vertices[k] for k in "xyz")), zip(*(vertices[k] for k in ("nx", "ny", "nz")))):
        assert math.hypot(*n) == pytest.approx(1, abs=1e-5)
        assert sum(a * b for a, b in zip(p, n)) > 0.99
    assert vertices["quality"] == pytest.approx([2] * 302, rel=0.02)
    assert types["vertex", "red"] == "B" and len(set(vertices["red"])) < 4


def test_texture_coordinates_keep_their_seams(gaussmap, tmp_path):
    # A grid of two charts that meet at x = 10: u is x on the left, x + 100 on the right.
    n = 20
    lines = [f"v {i} {j} {0.02 * (i - 10) ** 2}" for j in range(n + 1) for i in range(n + 1)]
    lines += [f"vt {i + shift} {j}" for shift in (0, 100) for j in range(n + 1) for i in range(n + 1)]
    for j in range(n):
        for i in range(n):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            index = [x + (n + 1) * y + 1 for x, y in corners]
            shift = 0 if i < n // 2 else (n + 1) ** 2
            for a, b, c in ((0, 1, 2), (0, 2, 3)):
                lines.append("f " + " ".join(f"{index[k]}/{index[k] + shift}" for k in (a, b, c)))
    (tmp_path / "in.obj").write_text("\n".join(lines) + "\n")
    assert gaussmap("decimate", "in.obj", "-o", "out.obj", "--ratio", "0.2").code == 0
    v, vt, charts = [], [], set()
    for line in (tmp_path / "out.obj").read_text().splitlines():
        word, *rest = line.split()
        if word == "v":
            v.append([float(x) for x in rest[:3]])
        elif word == "vt":
            vt.append([float(x) for x in rest[:2]])
        elif word == "f":
            corners = [tuple(int(k) - 1 for k in corner.split("/")[:2]) for corner in rest]
            right = {vt[t][0] > 50 for _, t in corners}
            assert len(right) == 1, "a face across the seam"
            charts |= right
            for p, t in corners:
                assert vt[t][0] - (100 if right == {True} else 0) == pytest.approx(v[p][0], abs=0.1)
                assert vt[t][1] == pytest.approx(v[p][1], abs=0.1)
    assert charts == {False, True}


def test_welding_is_told(gaussmap, tmp_path):
    shape(gaussmap, "sphere")
    elements, _ = read(tmp_path / "in.ply")
    xyz = list(zip(*(elements["vertex"][k] for k in "xyz")))
    faces = elements["face"]["vertex_indices"]
    soup = [xyz[v] for face in faces for v in face]
    text = f"OFF\n{len(soup)} {len(faces)} 0\n" + "".join("%.9g %.9g %.9g\n" % p for p in soup)
    (tmp_path / "soup.off").write_text(text + "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(faces))))
    kept = gaussmap("decimate", "soup.off", "-o", "out.off", "--ratio", "0.1", "--json").json
    assert kept["faces_out"] == kept["faces_in"] and "borders" in kept["reason"] or "topology" in kept["reason"]
    welded = gaussmap("decimate", "soup.off", "-o", "out.off", "--ratio", "0.1", "--weld", "--json").json
    assert welded["faces_out"] == 512 and any("merged" in note for note in welded["notes"])


@pytest.mark.parametrize(
    "arguments, line",
    [
        ("", "decimate: a target is missing; give --faces N, --ratio R or --error E"),
        ("--faces 10 --ratio 0.5", "decimate: --faces, --ratio and --error exclude each other"),
        ("--ratio 1.5", "--ratio: '1.5' is more than 1"),
        ("--ratio 0", "--ratio: '0' is not a number above 0"),
        ("--faces 0", "--faces: '0' is not a whole number from 1 to 2147483647"),
        ("--faces 5 --feature-angle 200", "--feature-angle: '200' is more than 180"),
        ("--faces 5 --method bset", "--method: 'bset' is not one of best, qem, edge; did you mean 'best'?"),
        ("--faces 5 --method qem --fast", "--fast is for --method best, and the method is qem"),
        ("--faces 5 --method edge --objective max", "--objective is for --method best, and the method is edge"),
    ],
)
def test_wrong_usage(gaussmap, arguments, line):
    gaussmap("decimate", "in.ply", "-o", "out.ply", *arguments.split()).fails(2, line)


def test_a_cloud_is_refused(gaussmap, tmp_path):
    (tmp_path / "in.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    gaussmap("decimate", "in.xyz", "-o", "out.ply", "--faces", "5").fails(
        3, "in.xyz: holds no faces; decimate takes a mesh"
    )
