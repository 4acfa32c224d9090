"""gaussmap compare: what it reports, and what it refuses."""

import math

import pytest

SQUARE = "OFF\n4 2 0\n0 0 {z}\n{s} 0 {z}\n{s} {s} {z}\n0 {s} {z}\n3 0 1 2\n3 0 2 3\n"


def square(path, z=0.0, s=1.0):
    path.write_text(SQUARE.format(z=z, s=s))
    return path.name


def test_parallel_squares(gaussmap, tmp_path):
    a, b = square(tmp_path / "a.off"), square(tmp_path / "b.off", z=0.5)
    report = gaussmap("compare", a, b, "--json").json
    assert report["diagonal"] == pytest.approx(math.sqrt(2))
    for way in ("forward", "backward", "symmetric"):
        assert set(report[way]) == {"max", "rms", "mean"}
        for value in report[way].values():
            assert value == pytest.approx(0.5 / math.sqrt(2), rel=1e-12)
    assert report["samples"] == 2 * (4 + 125000 + 500000)
    assert report["samples_by_kind"]["forward"] == {"vertices": 4, "edges": 125000, "faces": 500000}
    assert "bound" not in report
    assert report["a"] == {"file": a, "kind": "mesh", "vertices": 4, "faces": 2, "non_finite": 0}


def test_is_one_sided_each_way_and_divided_by_the_diagonal_of_a(gaussmap, tmp_path):
    a, b = square(tmp_path / "a.off"), square(tmp_path / "b.off", s=3.0)
    there = gaussmap("compare", a, b, "--json", "--samples", "1000").json
    back = gaussmap("compare", b, a, "--json", "--samples", "1000").json
    assert there["forward"]["max"] < 1e-15
    assert there["backward"]["max"] == pytest.approx(2)
    assert there["symmetric"] == there["backward"]
    assert back["forward"]["max"] == pytest.approx(2 / 3)
    assert back["diagonal"] == pytest.approx(3 * there["diagonal"])


def test_bounds_hold_the_hausdorff_distance(gaussmap, tmp_path):
    square(tmp_path / "a.off")
    (tmp_path / "b.xyz").write_text("0.5 0 0\n0.5 1 0\n0 0.5 0\n1 0.5 0\n")
    report = gaussmap("compare", "a.off", "b.xyz", "--bound", "--tolerance", "1e-6", "--json").json
    bound, diagonal = report["bound"], report["diagonal"]
    assert bound["tolerance"] == 1e-6
    for way, truth in (("forward", 0.5), ("backward", 0.0), ("symmetric", 0.5)):
        assert bound[way]["lower"] <= truth / diagonal <= bound[way]["upper"]
        assert bound[way]["upper"] - bound[way]["lower"] <= 1.01e-6
    assert bound["forward"]["within_tolerance"] is True
    assert len(bound["forward"]["at"]) == 3
    assert report["b"]["kind"] == "cloud"


def test_same_numbers_for_any_threads_and_seed_moves_samples(gaussmap):
    gaussmap("shape", "bumpy", "--subdivisions", "4", "-o", "a.ply")
    gaussmap("shape", "sphere", "--subdivisions", "3", "-o", "b.ply")

    def run(*options):
        report = gaussmap("compare", "a.ply", "b.ply", "--samples", "2000", "--bound", "--json", *options).json
        return [report[key] for key in ("forward", "backward", "symmetric", "bound", "samples", "diagonal")]

    assert run("--threads", "1") == run("--threads", "2") == run("--threads", "5")
    other = run("--seed", "7")
    assert other != run("--seed", "8")
    assert other[0]["rms"] == pytest.approx(run()[0]["rms"], rel=1e-2)


def test_text_goes_to_standard_error(gaussmap, tmp_path):
    a, b = square(tmp_path / "a.off"), square(tmp_path / "b.off", z=0.25)
    run = gaussmap("compare", a, b, "--bound")
    assert run.code == 0 and run.stdout == b""
    for words in ("A to B", "B to A", "max 0.176777, RMS 0.176777, mean 0.176777", "for certain", "the diagonal of A"):
        assert words in run.stderr
    assert gaussmap("compare", a, b, "--quiet").stderr == ""


def test_points_that_are_nowhere_are_left_out_of_clouds(gaussmap, tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0\nnan nan nan\n1 0 0\n")
    (tmp_path / "b.xyz").write_text("0 0 1\n1 0 1\n")
    report = gaussmap("compare", "a.xyz", "b.xyz", "--json").json
    assert report["forward"]["max"] == 1 and report["a"]["non_finite"] == 1 and report["a"]["vertices"] == 2
    assert report["notes"] == ["a.xyz: 1 point left out, being not finite"]


def test_a_single_point_has_no_diagonal(gaussmap, tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0\n")
    square(tmp_path / "b.off", z=1.0)
    report = gaussmap("compare", "a.xyz", "b.off", "--bound", "--json").json
    assert report["diagonal"] == 0 and report["forward"]["max"] is None


def test_reads_one_of_both_from_standard_input(gaussmap, tmp_path):
    a = square(tmp_path / "a.off")
    run = gaussmap("compare", a, "-", "--samples", "100", "--json", stdin=SQUARE.format(z=1, s=1).encode())
    assert run.json["forward"]["max"] == pytest.approx(1 / math.sqrt(2))


@pytest.mark.parametrize(
    "arguments, code, line",
    [
        ("", 2, "compare: A is missing; write: gaussmap compare A B [options]"),
        ("a.off", 2, "compare: B is missing; write: gaussmap compare A B [options]"),
        ("a.off a.off a.off", 2, "unexpected argument 'a.off'; write: gaussmap compare A B [options]"),
        ("- -", 2, "compare: A and B cannot both be standard input; name a file for one"),
        ("a.off a.off --bounds", 2, "unknown option '--bounds'; did you mean '--bound'?"),
        ("a.off a.off --samples 0", 2, "--samples: '0' is not a whole number from 1 to 100000000"),
        ("a.off a.off --tolerance 0", 2, "--tolerance: '0' is not a number above 0"),
        ("a.off none.off", 3, None),
        ("nan.off a.off", 3, "nan.off: vertices[0], of faces[0], is not finite; leave it out first"),
        ("a.off nan.off", 3, "nan.off: vertices[0], of faces[0], is not finite; leave it out first"),
        ("a.off nowhere.xyz", 3, "nowhere.xyz: no point is finite; there is nothing to compare"),
    ],
)
def test_refuses(gaussmap, tmp_path, arguments, code, line):
    square(tmp_path / "a.off")
    (tmp_path / "nan.off").write_text("OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    (tmp_path / "nowhere.xyz").write_text("nan nan nan\nnan 1 2\n")
    run = gaussmap("compare", *arguments.split())
    if line is None:
        assert run.code == code and run.stderr.startswith("gaussmap: none.off: ") and run.stderr.count("\n") == 1
    else:
        run.fails(code, line)
