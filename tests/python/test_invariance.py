"""What must not change: curvature under motions, scale, order, flips and threads; for any input, garbage included."""

import numpy as np
from conftest import same_bits
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gaussmap

seeds = st.integers(0, 2**32 - 1)
scales = st.integers(-20, 20).map(lambda e: 2.0**e)  # powers of two: exact


def random_mesh(seed):
    random = np.random.default_rng(seed)
    shape = gaussmap.shapes.ellipsoid(
        a=1, b=random.uniform(0.4, 1), c=random.uniform(0.4, 1), subdivisions=2, jitter=0.25, seed=int(seed)
    )
    kept = random.random(len(shape.faces)) < 0.95  # with holes
    return shape.vertices, shape.faces[kept], random


def rotation(random):
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return q if np.linalg.det(q) > 0 else -q


def close(a, b, tolerance=1e-6):
    np.testing.assert_array_equal(np.isnan(a), np.isnan(b))
    scale = np.nanmax(np.abs(b), initial=1e-300)
    np.testing.assert_allclose(a, b, rtol=tolerance, atol=tolerance * scale)


@given(seeds)
def test_meshes_moved(seed):
    vertices, faces, random = random_mesh(seed)
    before = gaussmap.curvature(vertices, faces)
    after = gaussmap.curvature(vertices @ rotation(random).T + random.uniform(-5, 5, 3), faces)
    close(after.density, before.density)
    close(after.kappa, before.kappa)


@given(seeds)
def test_clouds_moved(seed):
    vertices, _, random = random_mesh(seed)
    options = {"estimator": "jet", "k": 24}
    close(
        gaussmap.curvature(vertices @ rotation(random).T + random.uniform(-1, 1, 3), **options).density,
        gaussmap.curvature(vertices, **options).density,
        1e-5,
    )


@given(seeds, scales)
def test_scaled_exactly(seed, scale):
    vertices, faces, _ = random_mesh(seed)
    before, after = gaussmap.curvature(vertices, faces), gaussmap.curvature(scale * vertices, faces)
    close(after.density * scale**2, before.density, 1e-12)
    close(after.kappa, before.kappa, 1e-12)
    close(gaussmap.curvature(scale * vertices).density * scale**2, gaussmap.curvature(vertices).density, 1e-6)


@given(seeds)
def test_vertices_in_another_order(seed):
    vertices, faces, random = random_mesh(seed)
    order = random.permutation(len(vertices))
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    close(
        gaussmap.curvature(vertices[order], place[faces]).density,
        gaussmap.curvature(vertices, faces).density[order],
        1e-9,
    )
    close(gaussmap.curvature(vertices[order]).density, gaussmap.curvature(vertices).density[order], 1e-6)


@given(seeds)
def test_faces_in_another_order_and_turned(seed):
    vertices, faces, random = random_mesh(seed)
    shuffled = random.permutation(len(faces))
    before = gaussmap.curvature(vertices, faces)
    after = gaussmap.curvature(vertices, np.roll(faces, 1, axis=1)[shuffled])
    close(after.density, before.density, 1e-9)
    close(after.kappa, before.kappa[shuffled], 1e-9)


@given(seeds)
def test_flips(seed):
    vertices, faces, _ = random_mesh(seed)
    before = gaussmap.curvature(vertices, faces)
    close(gaussmap.curvature(vertices, faces[:, ::-1]).density, before.density, 1e-9)
    assert same_bits(
        gaussmap.curvature(vertices, faces, normals=-before.normals).density,
        gaussmap.curvature(vertices, faces, normals=before.normals).density,
    )


@given(seeds, st.integers(2, 5))
def test_threads_give_the_same_bits(seed, threads):
    vertices, faces, _ = random_mesh(seed)
    for arguments in ((vertices, faces), (vertices,)):
        one = gaussmap.curvature(*arguments, tensor=True, threads=1)
        many = gaussmap.curvature(*arguments, tensor=True, threads=threads)
        assert same_bits(one.density, many.density) and same_bits(one.tensor.k1, many.tensor.k1)


values = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324, 1e-160]), st.floats(width=64)
)
garbage = st.integers(0, 40).flatmap(lambda n: arrays(np.float64, (n, 3), elements=values))


@given(garbage, st.data())
def test_garbage_is_answered(vertices, data):
    n = len(vertices)
    faces = np.empty((0, 3), np.int32)
    if n:
        faces = data.draw(arrays(np.int32, st.tuples(st.integers(0, 30), st.just(3)), elements=st.integers(0, n - 1)))
    with np.errstate(all="ignore"):
        for result in (
            gaussmap.curvature(vertices, faces),
            gaussmap.curvature(vertices, faces, estimator="auto"),
            gaussmap.curvature(vertices),
            gaussmap.curvature(vertices, estimator="dirichlet"),
        ):
            assert result.density.shape == (n,) and result.undefined == np.isnan(result.density).sum()
            assert not (result.density < 0).any()
            assert repr(result)
        assert gaussmap.normals(vertices, faces).normals.shape == (n, 3)
        assert len(gaussmap.decimate(vertices, faces, faces=4).faces) <= len(faces)


@given(garbage, st.integers(1, 8))
def test_garbage_has_neighbours_or_a_clear_complaint(points, k):
    try:
        found = gaussmap.knn(points, k)
    except ValueError as problem:
        first = int(np.argmin(np.isfinite(points).all(axis=1)))
        assert f"points[{first}]" in str(problem)
    else:
        assert np.isfinite(points).all() and found.index.shape == (len(points), k)
