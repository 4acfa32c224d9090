"""Neighbours, fans, decimation, comparison and sampling."""

import json

import numpy as np
import pytest
from conftest import same_bits

import gaussmap

SPHERE = gaussmap.shapes.sphere(subdivisions=4)
CLOUD = np.random.default_rng(1).normal(size=(300, 3))


def test_knn_against_all_distances():
    found = gaussmap.knn(CLOUD, 7)
    distances = np.linalg.norm(CLOUD[:, None] - CLOUD[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    np.testing.assert_array_equal(found.index, np.argsort(distances, axis=1, kind="stable")[:, :7])
    np.testing.assert_allclose(found.distance, np.sort(distances, axis=1)[:, :7])
    asked = gaussmap.knn(CLOUD, 3, queries=CLOUD[:5] + 1e-9)
    assert asked.index[:, 0].tolist() == [0, 1, 2, 3, 4] and (asked.distance[:, 0] < 1e-8).all()
    assert repr(found) == "<Neighbors: 300 rows of 7; missing 0>"


def test_knn_of_few():
    found = gaussmap.knn(np.eye(3)[:2], 4)
    assert found.index.tolist() == [[1, -1, -1, -1], [0, -1, -1, -1]] and np.isinf(found.distance[:, 1:]).all()
    assert gaussmap.knn(np.zeros((0, 3)), 2).index.shape == (0, 2)


def test_fans_of_a_sphere_are_its_faces():
    fans = gaussmap.fans(SPHERE.vertices, normals=SPHERE.normals)
    assert fans.closed.all() and repr(fans) == "<Fans: 2,562 fans; open 0>"
    faces = {tuple(sorted(f)) for f in SPHERE.faces.tolist()}
    of_fans = {tuple(sorted(t)) for i in range(len(fans.closed)) for t in fans.triangles(i).tolist()}
    assert faces <= of_fans
    plane = gaussmap.shapes.plane(around=5, across=5)
    assert (~gaussmap.fans(plane).closed).sum() == 16
    again = gaussmap.fans(SPHERE.vertices, normals=SPHERE.normals, neighbors=gaussmap.knn(SPHERE.vertices, 20))
    assert same_bits(again.index, fans.index)


@pytest.mark.parametrize("options", [("--ratio", "0.1"), ("--ratio", "0.2", "--fast"), ("--faces", "700", "--method", "qem")])
def test_decimation_is_the_commands_to_the_byte(options, program, tmp_path):
    mesh = gaussmap.shapes.sphere(subdivisions=4, noise=0.1, seed=3)
    mesh.attributes["label"] = np.arange(len(mesh.vertices), dtype=np.int16)
    gaussmap.write(tmp_path / "in.ply", mesh)
    program("decimate", "in.ply", *options, "-o", "command.ply")
    words = {"--ratio": "ratio", "--faces": "faces", "--method": "method", "--fast": "fast"}
    values = dict(zip(options[::2], options[1::2], strict=False)) | ({"--fast": True} if "--fast" in options else {})
    numbers = {"--ratio": float, "--faces": int}
    asked = {words[name]: numbers.get(name, lambda same: same)(value) for name, value in values.items()}
    made = gaussmap.decimate(gaussmap.read(tmp_path / "in.ply"), **asked)
    gaussmap.write(tmp_path / "package.ply", made)
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()


def test_texture_coordinates_keep_to_their_side_of_a_seam(program, tmp_path):
    # A tube unrolled: u runs around once and jumps back at the seam, v runs along.
    tube = gaussmap.shapes.cylinder(around=40, across=30)
    angle = np.arctan2(tube.vertices[:, 1], tube.vertices[:, 0]) / (2 * np.pi) % 1
    u = angle[tube.faces]
    u = np.where((u.max(axis=1) - u.min(axis=1) > 0.5)[:, None] & (u < 0.5), u + 1, u)
    v = tube.vertices[:, 2][tube.faces]
    mesh = gaussmap.Geometry(tube.vertices, tube.faces)
    mesh.face_attributes["texcoord"] = np.stack([u, v], axis=2).reshape(-1, 6).astype(np.float32)
    gaussmap.write(tmp_path / "in.ply", mesh)
    program("decimate", "in.ply", "--ratio", "0.3", "-o", "command.ply")
    made = gaussmap.decimate(gaussmap.read(tmp_path / "in.ply"), ratio=0.3)
    gaussmap.write(tmp_path / "package.ply", made)
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()
    at = made.face_attributes["texcoord"].reshape(-1, 2)
    corners = made.vertices[made.faces.reshape(-1)]
    off = at[:, 0] - np.arctan2(corners[:, 1], corners[:, 0]) / (2 * np.pi)
    assert np.abs(off - np.round(off)).max() < 0.01 and np.abs(at[:, 1] - corners[:, 2]).max() < 0.02
    assert np.ptp(at.reshape(-1, 3, 2)[:, :, 0], axis=1).max() < 0.5
    with_none = gaussmap.decimate(mesh, ratio=0.3, seams=np.zeros((len(mesh.faces), 3)))
    assert not same_bits(with_none.faces, made.faces)


def test_polygons_are_decimated_as_triangles(program, tmp_path):
    (tmp_path / "in.obj").write_text(
        "".join(f"v {x} {y} 0\n" for y in range(9) for x in range(9))
        + "".join(f"vt {x / 8} {y / 8}\n" for y in range(9) for x in range(9))
        + "".join(
            "f " + " ".join(f"{c}/{c}" for c in (a, a + 1, a + 10, a + 9)) + "\n"
            for a in (9 * y + x + 1 for y in range(8) for x in range(8))
        )
    )
    program("decimate", "in.obj", "--faces", "16", "-o", "command.ply")
    mesh = gaussmap.read(tmp_path / "in.obj")
    assert mesh.polygons is not None
    made = gaussmap.decimate(mesh, faces=16)
    gaussmap.write(tmp_path / "package.ply", made)
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()
    at = made.face_attributes["texcoord"].reshape(-1, 2)
    np.testing.assert_allclose(at, made.vertices[made.faces.reshape(-1), :2] / 8, atol=1e-6)


def test_decimation_carries_values_and_proves_errors():
    mesh = gaussmap.shapes.torus()
    mesh.attributes["label"] = np.arange(len(mesh.vertices), dtype=np.int16)
    mesh.face_attributes["part"] = np.arange(len(mesh.faces))
    made = gaussmap.decimate(mesh, faces=600, fast=True)
    assert len(made.faces) in (599, 600) or len(made.faces) == 598
    assert made.attributes["label"].dtype == np.int16
    np.testing.assert_allclose(np.linalg.norm(made.normals, axis=1), 1)
    assert (made.face_attributes["part"] == made.face_source).all() and made.reached
    np.testing.assert_allclose(made.attributes["k1"], 2, atol=0.1)
    bounded = gaussmap.decimate(mesh, error=0.02, fast=True)
    assert bounded.error_bound <= 0.02 and "error at most" in repr(bounded)
    found = gaussmap.compare(mesh, bounded, bound=True, samples=1000)
    assert found.bound[0] <= bounded.error_bound + 1e-12
    assert "of 2,592" in repr(made)


def test_a_target_out_of_reach_is_said():
    tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    made = gaussmap.decimate(tetrahedron, faces, faces=1)
    assert not made.reached and "the target was not reached" in repr(made) and len(made.faces) == 4


def test_comparison_is_the_commands(program, tmp_path):
    other = gaussmap.shapes.sphere(subdivisions=3, radius=1.1)
    gaussmap.write(tmp_path / "a.ply", SPHERE)
    gaussmap.write(tmp_path / "b.ply", other)
    told = json.loads(program("compare", "a.ply", "b.ply", "--json", "--samples", 5000, "--bound"))
    found = gaussmap.compare(SPHERE, other, samples=5000, bound=True)
    for way in ("forward", "backward", "symmetric"):
        assert getattr(found, way)._asdict() == {key: told[way][key] for key in ("max", "rms", "mean")}
    assert found.diagonal == told["diagonal"] and found.samples == told["samples"]
    assert found.bound == (told["bound"]["symmetric"]["lower"], told["bound"]["symmetric"]["upper"])
    assert found.bound[0] * found.diagonal == pytest.approx(0.1, abs=0.01) and "Hausdorff" in repr(found)


def test_comparing_clouds_leaves_out_what_has_no_place():
    cloud = np.vstack([SPHERE.vertices, [[np.nan, 0, 0]]])
    assert gaussmap.compare(cloud, SPHERE.vertices).symmetric.max == 0


def test_closest_points():
    found = gaussmap.closest(SPHERE, queries=[[2.0, 0, 0], [0, 0, 0.0]])
    assert found.distance[0] == pytest.approx(1, abs=1e-3) and found.points.shape == (2, 3)
    assert gaussmap.closest(SPHERE.vertices, queries=SPHERE.vertices[5:6]).element.tolist() == [5]


@pytest.mark.parametrize("method", ["poisson", "nonuniform", "random"])
def test_samples_are_the_commands(method, program, tmp_path):
    gaussmap.write(tmp_path / "in.ply", SPHERE)
    program("sample", "in.ply", "-o", "out.ply", "--count", 500, "--method", method, "--seed", 3)
    theirs, ours = gaussmap.read(tmp_path / "out.ply"), gaussmap.sample(SPHERE, count=500, method=method, seed=3)
    assert same_bits(ours.vertices, theirs.vertices)
    np.testing.assert_allclose(ours.normals, theirs.normals, rtol=0, atol=1e-15)
    np.testing.assert_allclose(ours.attributes["k1"], theirs.attributes["k1"], rtol=1e-14)


def test_samples_carry_what_vertices_have():
    points = gaussmap.sample(gaussmap.shapes.torus(), count=400)
    assert points.faces is None and len(points.vertices) == 400 and (points.weights >= 0).all()
    np.testing.assert_allclose(points.interpolate(gaussmap.shapes.torus().vertices), points.vertices, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(points.normals, axis=1), 1)


def test_weighted_samples_go_where_the_weight_is():
    torus = gaussmap.shapes.torus()
    weights = torus.density**2
    points = gaussmap.sample(torus, count=20000, weights=weights, seed=5)
    everywhere = gaussmap.sample(torus, count=20000, method="random", seed=6)
    found = points.interpolate(weights).mean()
    uniform = everywhere.interpolate(weights)
    assert found == pytest.approx((uniform**2).mean() / uniform.mean(), rel=0.02)
    assert same_bits(points.vertices, gaussmap.sample(torus, count=20000, weights=weights, seed=5).vertices)
    assert not same_bits(points.vertices, gaussmap.sample(torus, count=20000, weights=weights, seed=6).vertices)


@pytest.mark.parametrize(
    "shape",
    [gaussmap.shapes.sphere, gaussmap.shapes.torus, gaussmap.shapes.knot, gaussmap.shapes.figure_eight, gaussmap.shapes.ellipsoid,
     gaussmap.shapes.bumpy, gaussmap.shapes.catenoid, gaussmap.shapes.cylinder, gaussmap.shapes.plane, gaussmap.shapes.waves],
)  # fmt: skip
def test_shapes_are_exact(shape):
    made = shape()
    np.testing.assert_allclose(made.density, made.k1**2 + made.k2**2, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(made.normals, axis=1), 1)
    assert (made.k1 >= made.k2).all() and "face" in repr(made)
