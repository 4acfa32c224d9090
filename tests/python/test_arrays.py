"""What goes in: types, copies, and complaints that name the array, the index and the value."""

import numpy as np
import pytest
from conftest import same_bits

import gaussmap
from gaussmap import _arrays, _gaussmap

TORUS = gaussmap.shapes.torus(around=12, across=10)


def test_native_arrays_are_read_where_they_are():
    vertices = _arrays.rows("vertices", TORUS.vertices)
    faces = _arrays.triangles("faces", TORUS.faces, len(vertices))
    assert _gaussmap.addresses(vertices, faces) == (TORUS.vertices.ctypes.data, TORUS.faces.ctypes.data)


def test_read_only_arrays_are_read_where_they_are():
    vertices = TORUS.vertices.copy()
    vertices.flags.writeable = False
    assert _gaussmap.addresses(_arrays.rows("vertices", vertices), TORUS.faces)[0] == vertices.ctypes.data
    assert same_bits(
        gaussmap.curvature(vertices, TORUS.faces).density, gaussmap.curvature(TORUS.vertices, TORUS.faces).density
    )


def test_the_compiled_part_never_converts():
    with pytest.raises(TypeError):
        _gaussmap.addresses(TORUS.vertices.astype(np.float32), TORUS.faces)
    with pytest.raises(TypeError):
        _gaussmap.addresses(np.asfortranarray(TORUS.vertices), TORUS.faces)


def test_results_own_their_memory():
    result = gaussmap.curvature(TORUS.vertices, TORUS.faces)
    density = result.density
    expected = density.copy()
    del result
    assert density.flags.writeable and not density.flags.owndata  # the vector that C++ filled
    np.testing.assert_array_equal(density, expected)


@pytest.mark.parametrize("floats", [np.float32, np.float64, ">f8", np.float16])
@pytest.mark.parametrize("ints", [np.int32, np.int64, np.uint32, np.uint8, ">i4"])
def test_types_and_layouts(floats, ints):
    vertices, faces = TORUS.vertices.astype(floats), TORUS.faces.astype(ints)
    plain = gaussmap.curvature(vertices.astype(np.float64), TORUS.faces)
    for v, f in (
        (vertices, faces),
        (np.asfortranarray(vertices), np.asfortranarray(faces)),
        (np.repeat(vertices, 2, 0)[::2], faces),
    ):
        assert same_bits(gaussmap.curvature(v, f).density, plain.density)


def test_lists_and_pairs():
    vertices, faces = TORUS.vertices.tolist(), TORUS.faces.tolist()
    plain = gaussmap.curvature(TORUS.vertices, TORUS.faces).density
    assert same_bits(gaussmap.curvature(vertices, faces).density, plain)
    assert same_bits(gaussmap.curvature((TORUS.vertices, TORUS.faces)).density, plain)


V = np.zeros((4, 3))
WRONG = [
    (lambda: gaussmap.curvature(np.zeros((4, 2))), r"vertices has shape \(4, 2\); \(n, 3\) is wanted"),
    (lambda: gaussmap.curvature(np.zeros(12)), r"vertices has shape \(12,\); \(n, 3\) is wanted"),
    (lambda: gaussmap.curvature(np.zeros((4, 3), complex)), "vertices has values of type complex128, not real numbers"),
    (lambda: gaussmap.curvature([["a", "b", "c"]]), "vertices has values of type <U1, not real numbers"),
    (lambda: gaussmap.curvature(V, [[0, 1, 2, 3]]), r"faces has shape \(1, 4\); \(m, 3\) is wanted: triangles"),
    (lambda: gaussmap.curvature(V, [[0.0, 1, 2]]), "faces has values of type float64, not integers"),
    (lambda: gaussmap.curvature(V, [[0, 1, 2], [0, 1, 4]]), r"faces\[1\]\[2\] = 4 is outside \[0, 4\)"),
    (lambda: gaussmap.curvature(V, [[0, -1, 2]]), r"faces\[0\]\[1\] = -1 is outside \[0, 4\)"),
    (lambda: gaussmap.curvature(V, [[0, 1, 2**40]]), rf"faces\[0\]\[2\] = {2**40} is outside \[0, 4\)"),
    (lambda: gaussmap.curvature(V, np.array([[0, 1, 2**63]], np.uint64)), rf"faces\[0\]\[2\] = {2**63} is outside"),
    (lambda: gaussmap.curvature(V, normals=np.zeros((3, 3))), "normals has 3 rows, but there are 4 vertices"),
    (lambda: gaussmap.curvature(V, normals="maxx"), "normals = 'maxx' is not one of auto, file, estimate, max"),
    (lambda: gaussmap.curvature(V, normals="max"), "normals = 'max' is for meshes, and this is a cloud"),
    (lambda: gaussmap.curvature(V, [[0, 1, 2]], normals="pca"), "normals = 'pca' is for clouds, and this is a mesh"),
    (lambda: gaussmap.curvature(V, normals="file"), "normals = 'file', but there are none"),
    (lambda: gaussmap.curvature(V, k=2), r"k = 2 is outside \[3, 1000\]"),
    (lambda: gaussmap.curvature(V, k=3.5), r"k = 3.5 is not a whole number"),
    (lambda: gaussmap.curvature(V, degree=5), r"degree = 5 is outside \[1, 4\]"),
    (lambda: gaussmap.curvature(V, kind="mesh"), "kind = 'mesh', but there are no faces"),
    (lambda: gaussmap.curvature(V, kind="solid"), "kind = 'solid' is not one of auto, mesh, cloud"),
    (
        lambda: gaussmap.curvature(V, estimator="lepski"),
        "estimator = 'lepski' is not one of auto, dirichlet, corrected",
    ),
    (lambda: gaussmap.curvature(V, estimator="corrected"), "estimator = 'corrected' is for meshes"),
    (lambda: gaussmap.curvature(V, orient="mts"), "orient = 'mts' is not one of local, mst, none"),
    (lambda: gaussmap.curvature(V, estimator="dirichlet", confidence=True), "confidence"),
    (lambda: gaussmap.curvature(V, threads=0), r"threads = 0 is outside \[1, 4096\]"),
    (lambda: gaussmap.curvature(V, progress=3), "progress = 3 is neither True, False, None nor a function"),
    (lambda: gaussmap.curvature(V, attach=True), "attach=True is for objects that hold attributes; arrays hold none"),
    (lambda: gaussmap.curvature(object()), "vertices: a builtins.object is neither an array nor a known mesh or cloud"),
    (lambda: gaussmap.knn(V, 0), r"k = 0 is outside \[1, 2147483647\]"),
    (lambda: gaussmap.knn([[0, 0, 0], [0, np.nan, 0]], 1), r"points\[1\]"),
    (lambda: gaussmap.knn(V, 1, queries=np.zeros(3)), r"queries has shape \(3,\)"),
    (lambda: gaussmap.fans(V), "normals are missing"),
    (lambda: gaussmap.fans(V, normals=V, neighbors=[[1], [2], [3], [4]]), r"neighbors"),
    (lambda: gaussmap.decimate(V, [[0, 1, 2]]), "one of faces, ratio and error is wanted"),
    (lambda: gaussmap.decimate(V, [[0, 1, 2]], faces=1, ratio=0.5), "one of faces, ratio and error is wanted"),
    (lambda: gaussmap.decimate(V, faces=3), "there are no faces; a mesh is wanted"),
    (lambda: gaussmap.decimate(V, [[0, 1, 2]], ratio=2), r"ratio = 2 is outside \(0, 1\]"),
    (lambda: gaussmap.decimate(V, [[0, 1, 2]], error=-1), "error = -1 is not above 0"),
    (lambda: gaussmap.decimate(V, [[0, 1, 7]], faces=1), r"faces\[0\]\[2\] = 7 is outside"),
    (
        lambda: gaussmap.decimate(V, [[0, 1, 2]], faces=1, method="bset"),
        "method = 'bset' is not one of best, qem, edge",
    ),
    (lambda: gaussmap.decimate(V, [[0, 1, 2]], faces=1, objective="x"), "objective = 'x' is not one of both, rms, max"),
    (lambda: gaussmap.compare((V, [[0, 1, 9]]), V), r"a: faces\[0\]\[2\] = 9 is outside \[0, 4\)"),
    (lambda: gaussmap.compare(V, np.zeros((0, 3))), "b: "),
    (lambda: gaussmap.compare(V, np.zeros((2, 2))), r"b has shape \(2, 2\)"),
    (lambda: gaussmap.sample(V, [[0, 1, 2]], count=0), r"count = 0 is outside"),
    (lambda: gaussmap.sample(V, [[0, 1, 2]]), "area"),
    (lambda: gaussmap.sample(TORUS, method="x"), "method = 'x' is not one of poisson, nonuniform, random"),
    (lambda: gaussmap.sample(TORUS, weights=np.ones(3)), r"weights has shape \(3,\); \(120,\) is wanted"),
    (lambda: gaussmap.sample(TORUS, weights=-np.ones(120)), r"weights\[0\] = -1.0 is below 0"),
    (lambda: gaussmap.sample(TORUS, weights=np.zeros(120)), "weights are 0 on all faces"),
    (lambda: gaussmap.shapes.torus(major=1, minor=2), "minor"),
    (lambda: gaussmap.shapes.sphere(subdivisions=13), "subdivisions"),
    (lambda: gaussmap.shapes.sphere(noise_unit="x"), "noise_unit = 'x' is not one of edge, diagonal"),
    (lambda: gaussmap.colors([0.0], high=0.0), "high = 0.0 is not above low = 0.0"),
    (lambda: gaussmap.write("x.ply", V, normals=V[:2]), "normals has 2 rows, but there are 4 vertices"),
    (lambda: gaussmap.write("x.ply", V, [[0, 1, 5]]), r"faces\[0\]\[2\] = 5 is outside \[0, 4\)"),
    (lambda: gaussmap.write("x.foo", V), "x.foo: .*extension"),
    (
        lambda: gaussmap.write("x.ply", gaussmap.Geometry(V, attributes={"a": [1, 2]})),
        r"attributes\['a'\] has shape \(2,\)",
    ),
    (lambda: gaussmap.write("x.ply", gaussmap.Geometry(V, attributes={"a": list("abcd")})), "which files do not hold"),
]


@pytest.mark.parametrize(("call", "message"), WRONG, ids=[str(i) for i in range(len(WRONG))])
def test_complaints(call, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=message):
        call()
    assert not list(tmp_path.iterdir())


def test_nothing_is_an_answer():
    empty = gaussmap.curvature(np.zeros((0, 3)))
    assert empty.density.shape == (0,) and empty.undefined == 0
    isolated = gaussmap.curvature(np.ones((5, 3)), np.zeros((0, 3), int))
    assert isolated.undefined == 5 and np.isnan(isolated.density).all()
