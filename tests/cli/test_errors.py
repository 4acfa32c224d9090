"""Every way to be wrong: one line, and the right exit code."""

import os
import resource
import subprocess

import pytest
from conftest import SANITIZED

CUBE = b"""OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""
CLOUD = b"0 0 0\n1 0 0\n0 1 0\n1 1 0.1\n0.5 0.5 0.2\n"
KNOWN = ".ply, .obj, .off, .stl, .xyz, .pwn, .pts, .asc, .txt, .pcd"


@pytest.fixture(autouse=True)
def files(tmp_path):
    (tmp_path / "cube.off").write_bytes(CUBE)
    (tmp_path / "cloud.xyz").write_bytes(CLOUD)


USAGE = [
    ("curvatur x.ply", "unknown verb 'curvatur'; did you mean 'curvature'?"),
    ("inof x.ply", "unknown verb 'inof'; did you mean 'info'?"),
    ("paint x.ply", "unknown verb 'paint'; the verbs are curvature, normals, decimate, compare, sample, shape, view, convert, info"),
    ("--verison", "unknown option '--verison'; did you mean '--version'?; options come after the verb"),
    ("--json", "unknown option '--json'; options come after the verb"),
    ("curvature", "curvature: IN is missing; write: gaussmap curvature IN [-o OUT]… [options]"),
    ("info", "info: IN is missing; write: gaussmap info IN [--json]"),
    ("convert cube.off", "convert: -o OUT is missing; write: gaussmap convert IN -o OUT… [options]"),
    ("normals cube.off", "normals: -o OUT is missing; write: gaussmap normals IN -o OUT… [options]"),
    ("shape torus", "shape: -o OUT is missing; write: gaussmap shape NAME -o OUT… [options]"),
    ("info a.ply b.ply", "unexpected argument 'b.ply'; write: gaussmap info IN [--json]"),
    ("info cube.off --jsn", "unknown option '--jsn'; did you mean '--json'?"),
    ("info --frobnicate=3 cube.off", "unknown option '--frobnicate'"),
    ("curvature cube.off --thread 2", "unknown option '--thread'; did you mean '--threads'?"),
    ("curvature cube.off --norm file", "unknown option '--norm'; did you mean '--normals'?"),
    ("curvature cube.off --truth", "--truth: a value is missing; write one after it"),
    (
        "curvature cube.off --normals maxx",
        "--normals: 'maxx' is not one of auto, file, estimate, area, angle, max, pca, wpca, jet; did you mean 'max'?",
    ),
    (
        "curvature cube.off --estimator lepski",
        "--estimator: 'lepski' is not one of auto, dirichlet, corrected, regression, jet",
    ),
    (
        "curvature cube.off --estimator dirchlet",
        "--estimator: 'dirchlet' is not one of auto, dirichlet, corrected, regression, jet; did you mean 'dirichlet'?",
    ),
    ("curvature cube.off --as meshes", "--as: 'meshes' is not one of auto, mesh, cloud; did you mean 'mesh'?"),
    ("curvature cloud.xyz --orient mts", "--orient: 'mts' is not one of local, mst, none; did you mean 'mst'?"),
    ("curvature cloud.xyz --k 2", "--k: '2' is not a whole number from 3 to 1000"),
    ("curvature cloud.xyz --k 20.5", "--k: '20.5' is not a whole number from 3 to 1000"),
    ("curvature cloud.xyz --degree 5", "--degree: '5' is not a whole number from 1 to 4"),
    ("curvature cloud.xyz --threads 0", "--threads: '0' is not a whole number from 1 to 1024"),
    ("curvature cloud.xyz --threads -2", "--threads: '-2' is not a whole number from 1 to 1024"),
    ("curvature cloud.xyz --seed x", "--seed: 'x' is not a whole number from 0 to 9223372036854775807"),
    (
        "curvature cloud.xyz --normals max",
        "--normals max is for meshes and cloud.xyz is taken as a cloud; use auto, file, estimate, pca, wpca or jet",
    ),
    (
        "curvature cube.off --normals jet",
        "--normals jet is for clouds and cube.off is a mesh; use auto, file, estimate, max, angle or area, or --as cloud",
    ),
    (
        "curvature cube.off --as cloud --estimator corrected",
        "--estimator corrected is for meshes and cube.off is taken as a cloud; use auto, dirichlet, "
        "regression or jet",
    ),
    ("curvature cloud.xyz --estimator jet --degree 1", "--degree 1 has no curvature; --estimator jet takes 2 to 4"),
    ("curvature cube.off --estimator jet --degree 1", "--degree 1 has no curvature; --estimator jet takes 2 to 4"),
    ("curvature cloud.xyz --estimator jet --k 4", "--k 4 is too small; --estimator jet takes at least 5"),
    *[
        (
            f"curvature {name} --confidence --estimator {estimator}",
            f"--confidence comes from the residuals of a fit, and --estimator {estimator} fits nothing; use --estimator "
            "auto, regression or jet",
        )
        for name, estimator in (("cube.off", "dirichlet"), ("cube.off", "corrected"), ("cloud.xyz", "dirichlet"))
    ],
    (
        "curvature cube.off --choice --estimator corrected",
        "--choice is what --estimator auto took, and the estimator is corrected; use --estimator auto",
    ),
    (
        "normals cube.off --method jet -o n.ply",
        "--method jet is for clouds and cube.off is a mesh; use max, angle or area, or --as cloud",
    ),
    (
        "normals cloud.xyz --method max -o n.ply",
        "--method max is for meshes and cloud.xyz is taken as a cloud; use jet, pca or wpca",
    ),
    ("normals cloud.xyz --orient local -o n.ply", "--orient: 'local' is not one of mst, none"),
    ("curvature cube.off -o x.las", f"x.las: unknown extension of an output; the known ones are {KNOWN}, .png, .html"),
    ("curvature cube.off -o x", f"x: unknown extension of an output; the known ones are {KNOWN}, .png, .html"),
    ("curvature cube.off -o a.ply -o a.ply", "-o a.ply: named twice; give each file its own name"),
    ("curvature cube.off -o - --json", "-o - and --json both want standard output; write to a file instead"),
    ("curvature cube.off -o a.ply --format obj", "--format is for -o - alone; the extension of a file decides"),
    (
        "curvature cube.off -o - --format pyl",
        "--format: 'pyl' is not one of ply, obj, off, stl, xyz, pcd; did you mean 'ply'?",
    ),
    ("convert cloud.xyz -o a.stl", "a.stl: STL holds nothing but triangles, and there are none; write .ply"),
    (
        "shape tours -o a.ply",
        "shape: 'tours' is not one of sphere, torus, knot, figure-eight, ellipsoid, bumpy, catenoid, cylinder, plane, "
        "waves; did you mean 'torus'?",
    ),
    ("shape sphere --grid 9x9 -o a.ply", "shape sphere: has no --grid; it has --subdivisions, --radius"),
    ("shape torus --grid 9 -o a.ply", "--grid: '9' is not 2 whole numbers as in AxB"),
    ("shape torus --grid 9x9x9 -o a.ply", "--grid: '9x9x9' is not 2 whole numbers as in AxB"),
    ("shape ellipsoid --axes 1,2 -o a.ply", "--axes: '1,2' is not 3 numbers as in A,B,C"),
    ("shape torus --major one -o a.ply", "--major: 'one' is not a number"),
    ("shape torus --jitter -0.1 -o a.ply", "--jitter: '-0.1' is not a number of at least 0"),
    ("shape torus --minor 2 -o a.ply", "shape: torus: minor = 2 must be less than major = 1"),
    ("shape sphere --radius -1 -o a.ply", "shape: sphere: radius = -1 must be positive and finite"),
    ("shape sphere --subdivisions 40 -o a.ply", "shape: sphere: subdivisions = 40 must be in [0, 12]"),
]


@pytest.mark.parametrize("command, line", USAGE, ids=[c for c, _ in USAGE])
def test_wrong_usage(gaussmap, tmp_path, command, line):
    before = sorted(os.listdir(tmp_path))
    gaussmap(*command.split()).fails(2, line)
    assert sorted(os.listdir(tmp_path)) == before


INPUT = [
    ("no.ply", "info no.ply", "no.ply: cannot read: No such file or directory; check the path"),
    ("no.ply", "curvature no.ply --json", "no.ply: cannot read: No such file or directory; check the path"),
    (b"", "curvature in.ply", "in.ply: the file is empty (0 bytes); write it anew"),
    (b"OFF\n0 0 0\n", "curvature in.off", "in.off: holds no points; there is nothing to measure"),
    (b"OFF\n0 0 0\n", "normals in.off -o x.ply", "in.off: holds no points; there is nothing to measure"),
    (CLOUD, "curvature in.xyz --as mesh", "in.xyz: holds no faces; leave out --as mesh to take it as a cloud"),
    (CLOUD, "curvature in.xyz --normals file", "in.xyz: has no normals; use --normals estimate"),
    (
        b"# x y z nx ny nz\n0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n",
        "curvature in.xyz --normals file",
        "in.xyz: has normals, but all are zero or not finite; use --normals estimate",
    ),
    (
        CLOUD,
        "curvature in.xyz --truth quality",
        "in.xyz: has no vertex property 'quality' to compare with; it has none of one number a vertex",
    ),
    (
        b"# x y z exact mine\n0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\n",
        "curvature in.xyz --truth exakt",
        "in.xyz: has no vertex property 'exakt' to compare with; did you mean 'exact'?",
    ),
    (
        b"# x y z exact mine\n0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\n",
        "curvature in.xyz --truth quality",
        "in.xyz: has no vertex property 'quality' to compare with; it has 'exact' and 'mine'",
    ),
]


@pytest.mark.parametrize("content, command, line", INPUT, ids=[c for _, c, _ in INPUT])
def test_bad_input(gaussmap, tmp_path, content, command, line):
    if isinstance(content, bytes):
        (tmp_path / command.split()[1]).write_bytes(content)
    gaussmap(*command.split()).fails(3, line)
    assert not (tmp_path / "x.ply").exists()


def test_malformed_files_are_one_line_that_names_the_file(gaussmap, tmp_path):
    (tmp_path / "cut.off").write_bytes(CUBE[:60])
    (tmp_path / "junk.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\n")
    for name in ("cut.off", "junk.ply"):
        run = gaussmap("curvature", name, "--json")
        assert run.code == 3 and run.stdout == b""
        assert run.stderr.startswith(f"gaussmap: {name}: ") and run.stderr.count("\n") == 1


def test_a_name_with_a_line_break_is_still_one_line(gaussmap):
    gaussmap("info", "a\nb.ply").fails(3, "a?b.ply: cannot read: No such file or directory; check the path")


def test_missing_folder_is_told_before_the_input_is_read(gaussmap):
    gaussmap("curvature", "no.ply", "-o", "no/such/out.ply").fails(
        1, "no/such/out.ply: the folder 'no/such' does not exist; make it first"
    )


def test_output_that_is_a_folder(gaussmap, tmp_path):
    (tmp_path / "out.ply").mkdir()
    gaussmap("convert", "cube.off", "-o", "out.ply").fails(1, "out.ply: is a folder; name a file in it")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_folder_without_permission(gaussmap, tmp_path):
    (tmp_path / "shut").mkdir(mode=0o500)
    gaussmap("convert", "cube.off", "-o", "shut/out.ply").fails(
        1, "shut/out.ply: no permission to write into the folder 'shut'"
    )


def test_a_full_disk_leaves_nothing(program, tmp_path):
    """A limit on the size of files stands for a disk that is full."""
    done = subprocess.run(
        [program, "shape", "sphere", "--subdivisions", "4", "-o", "out.ply"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)),
    )
    assert done.returncode == 1 and done.stdout == b""
    assert done.stderr.startswith(b"gaussmap: out.ply: cannot write: ") and done.stderr.count(b"\n") == 1
    assert sorted(os.listdir(tmp_path)) == ["cloud.xyz", "cube.off"]


def test_standard_output_that_is_full(program):
    with open("/dev/full", "wb") as full:
        for command in (["info", "-", "--json"], ["convert", "-", "-o", "-"]):
            done = subprocess.run([program, *command], input=CUBE, stdout=full, stderr=subprocess.PIPE, check=False)
            assert done.returncode == 1
            assert b"No space left on device" in done.stderr and done.stderr.count(b"\n") == 1


@pytest.mark.skipif(SANITIZED, reason="a sanitizer reserves more address space than the limit")
def test_out_of_memory_is_one_line(program, tmp_path):
    done = subprocess.run(
        [program, "shape", "sphere", "--subdivisions", "11", "-o", "out.ply"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (500_000_000, 500_000_000)),
    )
    assert (done.returncode, done.stdout) == (1, b"")
    assert done.stderr == b"gaussmap: out of memory; close other programs, or work on a smaller file\n"
    assert not (tmp_path / "out.ply").exists()
