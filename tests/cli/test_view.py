"""Pictures and pages: view, and -o picture.png or page.html of curvature and shape."""

import base64
import json
import re
import struct
import zlib

import ply
import pytest

PLANE = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"


def decode(content):
    """(width, height, rows of bytes) of an 8-bit RGB PNG, independent of what wrote it."""
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    at, data, header = 8, b"", None
    while at < len(content):
        (length,) = struct.unpack_from(">I", content, at)
        kind, body = content[at + 4 : at + 8], content[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack_from(">I", content, at + 8 + length)[0]
        header = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else header
        data += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, *rest = header
    assert rest == [8, 2, 0, 0, 0]
    raw, rows, above, stride = zlib.decompress(data), [], bytes(3 * width), 3 * width + 1
    for y in range(height):
        kind, row = raw[y * stride], bytearray(raw[y * stride + 1 : (y + 1) * stride])
        for i in range(len(row)):
            left, corner = (row[i - 3], above[i - 3]) if i >= 3 else (0, 0)
            up = above[i]
            estimate = left + up - corner
            nearest = min((left, up, corner), key=lambda v: abs(estimate - v))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


def picture(path):
    return decode(path.read_bytes())


def colours(rows):
    return {row[i : i + 3] for row in rows for i in range(0, len(row), 3)}


@pytest.fixture(autouse=True)
def files(tmp_path, gaussmap):
    assert gaussmap("shape", "torus", "-o", "t.ply").code == 0
    (tmp_path / "plane.off").write_bytes(PLANE)


def test_a_mesh(gaussmap, tmp_path):
    report = gaussmap("view", "t.ply", "-o", "t.png", "--size", "320x240", "--json").json
    assert (report["kind"], report["field"], report["width"], report["height"]) == ("mesh", "total curvature", 320, 240)
    assert report["low"] == 0 and 6 < report["high"] < 9 and report["undefined"] == 0
    assert report["outputs"] == ["t.png"]
    width, height, rows = picture(tmp_path / "t.png")
    assert (width, height) == (320, 240)
    assert len(colours(rows)) > 500
    assert rows[0] == rows[-1] == b"\xff" * (3 * 320), "an empty border"


def test_the_default_size(gaussmap, tmp_path):
    assert gaussmap("view", "t.ply", "-o", "t.png").code == 0
    assert struct.unpack(">II", (tmp_path / "t.png").read_bytes()[16:24]) == (1600, 1200)


@pytest.mark.parametrize("kind", ["mesh", "cloud"])
def test_same_bytes_for_any_number_of_threads(gaussmap, tmp_path, kind):
    for threads in (1, 2, 7):
        options = ["--as", kind, "--size", "400x300", "--views", "4", "--threads", threads, "--quiet"]
        assert gaussmap("view", "t.ply", "-o", f"{threads}.png", *options).code == 0
    first = (tmp_path / "1.png").read_bytes()
    assert all((tmp_path / f"{t}.png").read_bytes() == first for t in (2, 7))


def test_a_field_and_its_range(gaussmap):
    report = gaussmap("view", "t.ply", "--field", "k2", "-o", "a.png", "--size", "64x64", "--json").json
    assert report["field"] == "k2" and report["low"] < 0
    options = ["--range", "-1.5,2", "--size", "64x64", "--json"]
    report = gaussmap("view", "t.ply", "--field", "k2", "-o", "a.png", *options).json
    assert (report["low"], report["high"]) == (-1.5, 2)


def test_signed_curvatures_reach_as_far_either_way(gaussmap, tmp_path):
    gaussmap("curvature", "t.ply", "--tensor", "-o", "o.ply")
    for field in ("k2", "gaussian", "mean", "shape_index"):
        report = gaussmap("view", "o.ply", "--field", field, "-o", "a.png", "--size", "300x200", "--json").json
        low = -report["high"] if field in ("k2", "gaussian") else 0  # of both signs, or positive everywhere
        assert report["low"] == low and report["high"] > 0, field
    options = ["--field", "k2", "--from", "0,0,1", "--size", "300x300"]
    gaussmap("view", "o.ply", "-o", "k2.png", *options)
    seen = colours(picture(tmp_path / "k2.png")[2])
    assert any(c[2] > c[0] + 60 for c in seen), "blue inside"
    assert any(c[0] > c[2] + 30 for c in seen), "red outside"


def test_the_direction_changes_the_picture(gaussmap, tmp_path):
    for name, options in {"auto": [], "top": ["--from", "0,0,1"], "side": ["--from", "0,-1,0", "--up", "0,0,1"]}.items():
        assert gaussmap("view", "t.ply", "-o", f"{name}.png", "--size", "99x99", *options).code == 0
    top = picture(tmp_path / "top.png")[2]
    assert top[49][3 * 49 : 3 * 50] == b"\xff\xff\xff", "through the hole"
    assert picture(tmp_path / "side.png")[2][49][3 * 49 : 3 * 50] != b"\xff\xff\xff"
    assert len({(tmp_path / f"{n}.png").read_bytes() for n in ("auto", "top", "side")}) == 3


def test_a_plane_looks_like_a_plane(gaussmap, tmp_path):
    options = ["--from", "0,0,1", "--size", "100x100"]
    report = gaussmap("view", "plane.off", "-o", "p.png", *options, "--json").json
    assert report["low"] == 0
    inside = {row[i : i + 3] for row in picture(tmp_path / "p.png")[2][8:92] for i in range(24, 276, 3)}
    assert len(inside) == 1


def test_several_outputs_of_one_run(gaussmap, tmp_path):
    assert gaussmap("curvature", "t.ply", "-o", "a.ply", "-o", "a.png", "-o", "b.PNG", "--quiet").code == 0
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.PNG").read_bytes()
    assert (tmp_path / "a.ply").read_bytes().startswith(b"ply")
    assert gaussmap("view", "t.ply", "-o", "view.png").code == 0
    assert (tmp_path / "view.png").read_bytes() == (tmp_path / "a.png").read_bytes()
    assert gaussmap("shape", "knot", "-o", "knot.png", "-o", "knot.stl").code == 0
    assert picture(tmp_path / "knot.png")[:2] == (1600, 1200)


def test_a_picture_alone_writes_no_geometry(gaussmap, tmp_path):
    run = gaussmap("curvature", "t.ply", "-o", "only.png", "--json")
    assert run.json["notes"] == [] and run.stderr == ""
    assert sorted(p.name for p in tmp_path.iterdir()) == ["only.png", "plane.off", "t.ply"]


def test_standard_output(gaussmap):
    run = gaussmap("view", "-", "-o", "-", "--size", "50x40", stdin=PLANE)
    assert run.code == 0 and decode(run.stdout)[:2] == (50, 40)


class Page:
    """What a page holds, decoded independently of the viewer."""

    def __init__(self, path):
        self.text = path.read_text()
        self.head = json.loads(re.search(r'id="gaussmap">(.*?)</script>', self.text).group(1))
        self.scenes = self.head["scenes"]

    def array(self, about):
        columns, rows, kind = about["columns"], about["rows"], about["type"]
        width = {"float64": 8, "octahedral": 2}.get(kind, 4)
        mask, out = 256**width - 1, []
        for block, begin in enumerate(range(0, rows, self.head["rows_a_block"]), about["block"]):
            n = min(rows - begin, self.head["rows_a_block"])
            text = re.search(rf'id="gaussmap-{block}">([^<]*)<', self.text).group(1)
            planes = zlib.decompress(base64.b64decode(text))
            assert len(planes) == n * columns * width
            before = [0] * columns
            for r in range(n):
                for c in range(columns):
                    coded = sum(planes[(c * width + b) * n + r] << (8 * b) for b in range(width))
                    base = before[0] if kind == "triangles" and c > 0 else before[c]
                    before[c] = (base + ((coded >> 1) ^ -(coded & 1))) & mask
                out.extend(before)
        if kind.startswith("float"):
            out = list(struct.unpack(f"<{len(out)}{'d' if width == 8 else 'f'}", b"".join(v.to_bytes(width, "little") for v in out)))
        return out

    def fields(self, scene=0):
        return {(f["name"], f["of"]): f for f in self.scenes[scene]["fields"]}

    def values(self, name, of="vertex", scene=0):
        return self.array(self.fields(scene)[name, of]["values"])


def test_a_page_holds_the_numbers_of_the_ply(gaussmap, tmp_path):
    run = gaussmap("curvature", "t.ply", "--tensor", "--truth", "exact_density", "-o", "t.html", "-o", "out.ply", "--json")
    assert run.json["outputs"] == ["t.html", "out.ply"]
    page, (written, _) = Page(tmp_path / "t.html"), ply.read(tmp_path / "out.ply")
    assert page.head["title"] == "t.ply" and page.scenes[0]["name"] == "t.ply"
    assert page.values("density") == written["vertex"]["scalar_total_curvature"]
    assert page.values("kappa", "face") == written["face"]["kappa"]
    for name in ("k1", "k2", "mean", "gaussian", "shape_index", "curvedness", "exact_density"):
        assert page.values(name) == written["vertex"][name], name
    assert page.array(page.scenes[0]["triangles"]) == [v for f in written["face"]["vertex_indices"] for v in f]
    known = page.fields()
    assert known["k2", "vertex"]["diverging"] and known["k2", "vertex"]["unit"] == "1/unit"
    assert ("quality", "vertex") not in known and ("d1x", "vertex") not in known


def test_confidence_of_a_cloud_on_a_page(gaussmap, tmp_path):
    options = ["--as", "cloud", "--confidence", "-o", "t.html", "-o", "out.ply", "-q"]
    assert gaussmap("curvature", "t.ply", *options).code == 0
    page, (written, _) = Page(tmp_path / "t.html"), ply.read(tmp_path / "out.ply")
    assert page.scenes[0]["triangles"] is None and page.scenes[0]["spacing"] > 0
    assert page.values("density_error") == written["vertex"]["density_error"]


def test_a_page_and_a_picture_of_one_run(gaussmap, tmp_path):
    report = gaussmap("view", "t.ply", "-o", "t.html", "-o", "t.PNG", "--size", "64x64", "--json").json
    assert report["width"] == 64 and report["field"] == "total curvature"
    page = Page(tmp_path / "t.html")
    assert page.text.startswith("<!doctype html>") and page.text.rstrip().endswith("</html>")
    # Nothing that would load from elsewhere: code and styles stand in the page.
    assert not re.search(r"<(script|link|img|iframe)[^>]* (src|href)=(?!\"data:,)", page.text)
    assert {("density", "vertex"), ("kappa", "face"), ("k1", "vertex"), ("exact_density", "vertex")} <= set(page.fields())
    report = gaussmap("view", "t.ply", "-o", "t.html", "--json").json
    assert report["width"] is None and report["low"] is None and report["undefined"] == 0


def test_a_page_of_two(gaussmap, tmp_path):
    report = gaussmap("view", "t.ply", "plane.off", "-o", "two.html", "--range", "0,5", "--json").json
    assert (report["file"], report["second"]["file"], report["second"]["faces"]) == ("t.ply", "plane.off", 2)
    page = Page(tmp_path / "two.html")
    assert [s["name"] for s in page.scenes] == ["t.ply", "plane.off"]
    assert (page.head["low"], page.head["high"]) == (0, 5)
    assert page.values("density", scene=1) == [0, 0, 0, 0]


def test_a_field_of_a_page_comes_first(gaussmap, tmp_path):
    assert gaussmap("view", "t.ply", "--field", "k2", "--from", "0,0,2", "-o", "t.html").code == 0
    page = Page(tmp_path / "t.html")
    assert page.head["field"] == "k2" and page.scenes[0]["toward"] == [0, 0, 1]
    written, types = ply.read(tmp_path / "t.ply")
    assert types["vertex", "k2"] == "d" and page.fields()["k2", "vertex"]["values"]["type"] == "float64"
    assert page.values("k2") == written["vertex"]["k2"]


def test_same_page_for_any_number_of_threads(gaussmap, tmp_path):
    for threads in (1, 3):
        assert gaussmap("view", "t.ply", "-o", f"{threads}.html", "--threads", threads, "-q").code == 0
    assert (tmp_path / "1.html").read_bytes() == (tmp_path / "3.html").read_bytes()


USAGE = [
    ("view t.ply", "view: -o OUT is missing; write: gaussmap view IN [IN2] -o OUT… [options]"),
    ("view t.ply -o t.ply", "t.ply: unknown extension of an output; the known ones are .png, .html"),
    ("view t.ply t.ply -o t.png", "two inputs stand side by side on a page; a .png shows one"),
    ("view - - -o t.html", "both inputs are standard input; name a file for one"),
    ("view t.ply t.ply t.ply -o t.html", "unexpected argument 't.ply'; write: gaussmap view IN [IN2] -o OUT… [options]"),
    ("view t.ply -o none/t.html", None),
    ("view t.ply -o t.png --views 3", "--views: '3' is not 1 or 4"),
    ("view t.ply -o t.png --size 800", "--size: '800' is not a size as in 1600x1200, each 16 to 16384"),
    ("view t.ply -o t.png --size 8x800", "--size: '8x800' is not a size as in 1600x1200, each 16 to 16384"),
    ("view t.ply -o t.png --from 1,2", "--from: '1,2' is not 3 numbers as in 1,-2,1"),
    ("view t.ply -o t.png --from 0,0,0", "--from: '0,0,0' is no direction; one number must not be 0"),
    ("view t.ply -o t.png --from 0,1,0 --up 0,2,0", "--up: '0,2,0' is parallel to --from; give another"),
    ("view t.ply -o t.png --range 2,1", "--range: '2,1' is empty; the first must be less"),
    ("view t.ply -o t.png --range x", "--range: 'x' is not 2 numbers as in 0,100"),
    ("convert t.ply -o t.png", None),
]


@pytest.mark.parametrize("arguments, line", USAGE)
def test_wrong_usage(gaussmap, tmp_path, arguments, line):
    run = gaussmap(*arguments.split())
    if line:
        run.fails(2, line)
    elif "none/" in arguments:
        run.fails(1, "none/t.html: the folder 'none' does not exist; make it first")
    else:
        assert run.code == 2 and ".png" not in run.stderr.split("known ones are")[1]
    assert not list(tmp_path.glob("*.png")) and not list(tmp_path.glob("*.html"))


def test_bad_input(gaussmap, tmp_path):
    run = gaussmap("view", "t.ply", "--field", "k3", "-o", "t.png")
    run.fails(3, "t.ply: has no vertex property 'k3' to draw; did you mean 'k1'?")
    run = gaussmap("view", "t.ply", "plane.off", "--field", "k1", "-o", "t.html")
    run.fails(3, "plane.off: has no vertex property 'k1' to draw; it has none of one number a vertex")
    (tmp_path / "empty.off").write_bytes(b"OFF\n0 0 0\n")
    assert gaussmap("view", "empty.off", "-o", "t.png").code == 3
    (tmp_path / "nan.xyz").write_bytes(b"nan 0 0\n")
    assert gaussmap("view", "nan.xyz", "-o", "t.png").code == 3
    assert gaussmap("view", "nan.xyz", "-o", "t.html").code == 3
    assert not (tmp_path / "t.png").exists() and not (tmp_path / "t.html").exists()
