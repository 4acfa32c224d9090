"""Files: what the command writes and what the package writes are the same bytes, and the library's the same numbers."""

import os
import subprocess

import numpy as np
import pytest
from conftest import PROGRAM, same_bits

import gaussmap

MESHES = ["meshes/seed/cow.ply", "meshes/seed/torus_res36.ply", "meshes/classic/spot.obj", "meshes/classic/bunny.off",
          "meshes/classic/bunny_poly.ply", "meshes/classic/suzanne.obj", "meshes/classic/horse.ply"]  # fmt: skip
CLOUDS = ["meshes/seed/cow_uniform_points.ply", "clouds/kitten.xyz", "clouds/bun0.pcd", "clouds/colored_cloud.pcd",
          "clouds/lamppost.pcd"]  # fmt: skip


@pytest.mark.parametrize("name", MESHES + CLOUDS)
def test_curvature_of_files_is_the_commands_to_the_byte(name, data, program, tmp_path):
    program("curvature", data / name, "-o", "command.ply", "--color")
    geometry = gaussmap.read(data / name)
    result = gaussmap.curvature(geometry, attach=True)
    for i, colour in enumerate(("red", "green", "blue")):
        geometry.attributes[colour] = gaussmap.colors(result.density)[:, i].copy()
    gaussmap.write(tmp_path / "package.ply", geometry)
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()


@pytest.mark.parametrize(
    "name", ["meshes/seed/cow.ply", "meshes/classic/spot.obj", "clouds/kitten.xyz", "clouds/bunny.pcd"]
)
def test_curvature_of_files_is_the_librarys_to_the_bit(name, data):
    reference = PROGRAM.parent / "tests/python_density"
    if not reference.exists():
        pytest.fail(f"{reference} is not built (cmake --preset release builds it)")
    raw = np.frombuffer(subprocess.run([reference, data / name], capture_output=True, check=True).stdout)
    result = gaussmap.curvature(gaussmap.read(data / name))
    kappa = [] if result.kappa is None else [result.kappa]
    assert same_bits(np.concatenate([result.density, *kappa]), raw)


@pytest.mark.parametrize(
    "name",
    MESHES
    + CLOUDS
    + ["clouds/b9_training.ply", "clouds/fragment_000.ply", "clouds/table_scene_mug_stereo_textured.pcd"],
)
@pytest.mark.parametrize("ending", [".ply", ".pcd", ".obj"])
def test_reading_and_writing_is_the_commands_convert(name, ending, data, program, tmp_path):
    program("convert", data / name, "-o", "command" + ending)
    gaussmap.write(tmp_path / ("package" + ending), gaussmap.read(data / name))
    assert (tmp_path / ("package" + ending)).read_bytes() == (tmp_path / ("command" + ending)).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "make"),
    [
        (("sphere", "--subdivisions", 3), lambda: gaussmap.shapes.sphere(subdivisions=3)),
        (("torus", "--noise", 0.1, "--seed", 7), lambda: gaussmap.shapes.torus(noise=0.1, seed=7)),
        (("knot", "--jitter", 0.2), lambda: gaussmap.shapes.knot(jitter=0.2)),
        (("figure-eight",), gaussmap.shapes.figure_eight),
        (("ellipsoid", "--axes", "1,0.5,0.25"), lambda: gaussmap.shapes.ellipsoid(a=1, b=0.5, c=0.25)),
        (("bumpy", "--subdivisions", 4), lambda: gaussmap.shapes.bumpy(subdivisions=4)),
        (("catenoid",), gaussmap.shapes.catenoid),
        (
            ("cylinder", "--noise-unit", "diagonal", "--noise", 0.01),
            lambda: gaussmap.shapes.cylinder(noise=0.01, noise_unit="diagonal"),
        ),
        (("plane",), gaussmap.shapes.plane),
        (("waves",), gaussmap.shapes.waves),
    ],
    ids=lambda p: p[0] if isinstance(p, tuple) else "",
)
def test_shapes_are_the_commands(arguments, make, program, tmp_path):
    program("shape", *arguments, "-o", "command.ply")
    gaussmap.write(tmp_path / "package.ply", make())
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()


def test_what_is_read(data):
    cow = gaussmap.read(data / "meshes/seed/cow.ply")
    assert cow.vertices.shape == (2761, 3) and cow.faces.shape == (5520, 3) and cow.normals.shape == (2761, 3)
    assert repr(cow).startswith("<Geometry: 2,761 vertices; 5,520 faces; box 1.04") and cow.format == "ply"
    assert cow.faces.dtype == np.int32 and cow.vertices.dtype == np.float64
    horse = gaussmap.read(data / "meshes/classic/horse.ply")
    assert {"confidence", "red"} <= horse.attributes.keys() and horse.attributes["red"].dtype == np.uint8
    points = gaussmap.read(data / "clouds/kitten.xyz")
    assert points.faces is None and points.normals is not None and "5,210 points" in repr(points)


def test_polygons_are_kept_until_they_are_wrong(tmp_path):
    (tmp_path / "square.off").write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
    square = gaussmap.read(tmp_path / "square.off")
    assert square.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and square.polygons.corners.tolist() == [0, 1, 2, 3]
    assert gaussmap.triangulate(square).polygons is None
    square.faces = square.faces[:1]
    with pytest.raises(ValueError, match="polygons belong to other faces than these; set polygons to None"):
        gaussmap.write(tmp_path / "out.ply", square)


def test_lists_and_types_survive(tmp_path):
    ragged = np.empty(3, object)
    ragged[:] = [np.array([1, 2], np.int32), np.array([], np.int32), np.array([3], np.int32)]
    out = gaussmap.Geometry(np.eye(3), attributes={"pair": np.arange(6, dtype=np.float32).reshape(3, 2), "some": ragged,
                                                   "flag": np.array([True, False, True])})  # fmt: skip
    gaussmap.write(tmp_path / "lists.ply", out)
    back = gaussmap.read(tmp_path / "lists.ply").attributes
    assert back["pair"].tolist() == [[0, 1], [2, 3], [4, 5]] and back["flag"].tolist() == [1, 0, 1]
    assert [v.tolist() for v in back["some"]] == [[1, 2], [], [3]]


def test_complaints_of_files(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere.ply"):
        gaussmap.read(tmp_path / "nowhere.ply")
    (tmp_path / "broken.ply").write_text("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n")
    with pytest.raises(ValueError, match="broken.ply: "):
        gaussmap.read(tmp_path / "broken.ply")
    with pytest.raises(OSError, match="none/x.ply"):
        gaussmap.write(tmp_path / "none" / "x.ply", np.eye(3))


def test_arrays_are_written_as_they_are(tmp_path):
    gaussmap.write(tmp_path / "x.ply", np.eye(3, dtype=np.float32), [[0, 1, 2]], normals=np.eye(3))
    header = (tmp_path / "x.ply").read_bytes().split(b"end_header")[0]
    assert b"property float x" in header and b"element face 1" in header and b"nx" in header
    assert gaussmap.read(tmp_path / "x.ply").faces.tolist() == [[0, 1, 2]]


def test_welding():
    mesh = gaussmap.Geometry(
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [1, 1, 0]]), np.array([[0, 1, 2], [3, 1, 4]], np.int32)
    )
    assert len(gaussmap.weld(mesh).vertices) == 4


def test_nasty_files_are_answered(data):
    answered = 0
    for folder, _, names in os.walk(data / "nasty"):
        for name in names:
            path = os.path.join(folder, name)
            if name.lower().endswith((".las", ".laz")) or os.path.getsize(path) > 5_000_000:
                continue
            try:
                gaussmap.curvature(gaussmap.read(path))
            except ValueError as problem:
                assert "\n" not in str(problem)
            answered += 1
    assert answered > 5
