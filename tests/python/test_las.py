"""LAS and LAZ: every dimension is kept, results are extra bytes, the command works on them."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import library, same_bits

import gaussmap

laspy = library("laspy")

FILES = ["urban.las", "simple.las", "1.2-with-color.las", "extrabytes.las", "test1_4.las", "autzen_trim.laz"]


def command(*arguments, cwd):
    """The command that the wheel installs."""
    program = os.path.join(os.path.dirname(sys.executable), "gaussmap")
    return subprocess.run(
        [program, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=200, check=False
    )


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("ending", [".las", ".laz"])
def test_everything_is_kept(name, ending, data, tmp_path):
    cloud = gaussmap.read(data / "clouds" / name)
    values = np.linspace(0, 1, len(cloud.vertices))
    values[3] = np.nan
    out = tmp_path / ("out" + ending)
    gaussmap.las.write(out, cloud, total_curvature=values)
    before, after = laspy.read(data / "clouds" / name), laspy.read(out)
    for dimension in before.point_format.dimension_names:
        assert same_bits(np.asarray(before[dimension]), np.asarray(after[dimension])), dimension
    assert same_bits(np.asarray(after["total_curvature"]), values)
    assert [v.record_data_bytes() for v in before.vlrs if v.record_id != 4 and v.user_id != "laszip encoded"] == [
        v.record_data_bytes() for v in after.vlrs if v.record_id != 4 and v.user_id != "laszip encoded"
    ]
    assert before.header.version == after.header.version and (before.header.scales == after.header.scales).all()
    assert list(tmp_path.iterdir()) == [out]


def test_curvature_of_a_cloud(data, tmp_path):
    cloud = gaussmap.read(data / "clouds/simple.las")
    assert "points" in repr(cloud) and cloud.attributes["red"].dtype == np.uint16
    result = gaussmap.curvature(cloud, attach=True)
    gaussmap.write(tmp_path / "out.laz", cloud)
    back = gaussmap.read(tmp_path / "out.laz")
    assert same_bits(back.attributes["total_curvature"], result.density.astype(np.float32))
    assert "quality" not in back.attributes and same_bits(back.vertices, cloud.vertices)


def test_new_files(tmp_path):
    torus = gaussmap.shapes.torus()
    torus.attributes["red"] = torus.attributes["green"] = torus.attributes["blue"] = np.full(
        len(torus.vertices), 200, np.uint8
    )
    gaussmap.write(tmp_path / "torus.laz", torus)
    back = gaussmap.read(tmp_path / "torus.laz")
    np.testing.assert_allclose(back.vertices, torus.vertices, atol=1e-8)
    np.testing.assert_allclose(back.normals, torus.normals, atol=1e-7)
    assert same_bits(back.attributes["k1"], torus.k1) and (back.attributes["red"] == 200 * 257).all()


def test_an_octree_that_is_not_written_is_not_announced(data, tmp_path):
    cloud = gaussmap.read(data / "clouds/test1_4.las")
    cloud.las.vlrs.append(laspy.VLR(user_id="copc", record_id=1, description="", record_data=b"\0" * 160))
    gaussmap.las.write(tmp_path / "out.laz", cloud)
    assert "copc" not in [vlr.user_id for vlr in laspy.read(tmp_path / "out.laz").vlrs]
    with pytest.raises(ValueError, match="x.copc.laz: COPC is read, not written; write .laz"):
        gaussmap.las.write(tmp_path / "x.copc.laz", cloud)


def test_complaints(data, tmp_path):
    with pytest.raises(ValueError, match=r"1.2-with-color-clipped.las: (cut short|not read)"):
        gaussmap.read(data / "nasty/1.2-with-color-clipped.las")
    with pytest.raises(ValueError, match="broken_size.laz: "):
        gaussmap.read(data / "nasty/broken_size.laz")
    (tmp_path / "no.las").write_bytes(b"not a LAS file")
    with pytest.raises(ValueError, match="no.las: not read as LAS"):
        gaussmap.read(tmp_path / "no.las")
    with pytest.raises(ValueError, match=r"vertices\[1\] = .* is not finite"):
        gaussmap.write(tmp_path / "x.las", np.array([[0, 0, 0], [np.nan, 0, 0]]))
    cloud = gaussmap.read(data / "clouds/simple.las")
    with pytest.raises(ValueError, match="short has 3 values, but there are 1065 points"):
        gaussmap.las.write(tmp_path / "x.las", cloud, short=np.zeros(3))
    with pytest.raises(ValueError, match="longer than the 32 bytes"):
        gaussmap.las.write(tmp_path / "x.las", cloud, **{"n" * 33: np.zeros(1065)})
    with pytest.raises(ValueError, match=r"classification\[0\] = 300 is outside \[0, "):
        gaussmap.las.write(tmp_path / "x.las", cloud, classification=np.full(1065, 300))
    assert not list(tmp_path.glob("x.las")) and not list(tmp_path.glob(".gaussmap-*"))


def test_no_points(data):
    assert len(gaussmap.read(data / "nasty/no-points.las").vertices) == 0


def test_the_command(data, tmp_path):
    source = data / "clouds/simple.las"
    done = command("curvature", source, "-o", "y.laz", "-o", "y.ply", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["outputs"] == ["y.laz", "y.ply"] and report["file"] == str(source) and report["kind"] == "cloud"
    back, before = laspy.read(tmp_path / "y.laz"), laspy.read(source)
    for dimension in before.point_format.dimension_names:
        assert same_bits(np.asarray(before[dimension]), np.asarray(back[dimension])), dimension
    expected = gaussmap.curvature(gaussmap.read(source)).density.astype(np.float32)
    assert same_bits(np.asarray(back["total_curvature"]), expected)
    assert same_bits(gaussmap.read(tmp_path / "y.ply").attributes["scalar_total_curvature"], expected)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["y.laz", "y.ply"]


def test_other_verbs(data, tmp_path):
    assert "1,065" in command("info", data / "clouds/simple.las", cwd=tmp_path).stderr
    done = command("shape", "torus", "-o", "torus.laz", cwd=tmp_path)
    assert done.returncode == 0 and "wrote" in done.stderr and "torus.laz.ply" not in done.stderr
    assert gaussmap.read(tmp_path / "torus.laz").vertices.shape == (1296, 3)
    done = command("convert", data / "clouds/simple.las", "-o", "simple.ply", cwd=tmp_path)
    assert gaussmap.read(tmp_path / "simple.ply").attributes["red"].dtype == np.uint8
    done = command("normals", "torus.laz", "--output=n.las", cwd=tmp_path)
    assert done.returncode == 0 and gaussmap.read(tmp_path / "n.las").normals is not None


def test_the_commands_complaints(data, tmp_path):
    (tmp_path / "no.las").write_bytes(b"not a LAS file")
    done = command("info", "no.las", cwd=tmp_path)
    assert (
        done.returncode == 3
        and done.stderr.startswith("gaussmap: no.las: not read as LAS")
        and done.stderr.count("\n") == 1
    )
    done = command("info", "nowhere.laz", cwd=tmp_path)
    assert done.returncode == 3 and "nowhere.laz" in done.stderr
    done = command("curvature", data / "clouds/simple.las", "--k", "2", cwd=tmp_path)
    assert done.returncode == 2 and done.stderr == "gaussmap: --k: '2' is not a whole number from 3 to 1000\n"
    done = command("curvature", data / "clouds/simple.las", "-o", "none/y.laz", cwd=tmp_path)
    assert done.returncode == 3 and "none/y.laz: the folder 'none' does not exist" in done.stderr
    done = command("convert", data / "clouds/simple.las", "-o", "y.copc.laz", cwd=tmp_path)
    assert done.returncode == 3 and "COPC is read, not written" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["no.las"]
