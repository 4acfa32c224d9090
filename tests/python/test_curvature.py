"""Curvature and normals: the truth, what results tell, and how they are attached."""

import numpy as np
import pytest
from conftest import same_bits

import gaussmap

TORUS = gaussmap.shapes.torus(around=36, across=36)


def rmse(result, shape):
    return float(np.sqrt(np.mean((result.density - shape.density) ** 2)))


def test_the_papers_torus():
    assert rmse(gaussmap.curvature(TORUS), TORUS) == pytest.approx(0.0372, abs=5e-5)
    assert rmse(gaussmap.curvature(TORUS, estimator="corrected"), TORUS) == pytest.approx(0.0288, abs=5e-5)


def test_the_sphere_is_exact():
    sphere = gaussmap.shapes.sphere(subdivisions=4, radius=3.0)
    result = gaussmap.curvature(sphere.vertices, sphere.faces)
    np.testing.assert_allclose(result.density, 2 / 9, rtol=1e-12)
    np.testing.assert_allclose(result.kappa / result.face_density, np.asarray(areas(sphere)), rtol=1e-12)
    assert result.kappa_sum == pytest.approx(result.kappa.sum())


def areas(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_a_plane_is_exactly_flat():
    plane = gaussmap.shapes.plane()
    assert not gaussmap.curvature(plane).density.any()


def test_clouds_find_their_scale():
    cloud = gaussmap.curvature(TORUS.vertices)
    relative = np.abs(cloud.density / TORUS.density - 1)
    assert cloud.kind == "cloud" and cloud.estimator == "auto" and np.median(relative) < 0.01
    assert sum(cloud.chosen.values()) == len(TORUS.vertices) and cloud.kappa is None


def test_fans_of_clouds_have_kappa():
    cloud = gaussmap.curvature(TORUS.vertices, normals=TORUS.normals, estimator="dirichlet")
    assert cloud.kappa.shape == cloud.density.shape
    assert rmse(cloud, TORUS) < 0.2


def test_geometries_bring_their_normals():
    with_exact = gaussmap.curvature(TORUS)
    assert same_bits(with_exact.density, gaussmap.curvature(TORUS.vertices, TORUS.faces, normals=TORUS.normals).density)
    estimated = gaussmap.curvature(TORUS, normals="estimate")
    assert same_bits(estimated.density, gaussmap.curvature(TORUS.vertices, TORUS.faces).density)
    assert not same_bits(estimated.density, with_exact.density)


def test_a_mesh_taken_as_a_cloud():
    assert same_bits(
        gaussmap.curvature(TORUS, kind="cloud", normals="estimate").density, gaussmap.curvature(TORUS.vertices).density
    )


def test_principal_curvatures():
    result = gaussmap.curvature(TORUS, estimator="jet", tensor=True, confidence=True)
    np.testing.assert_allclose(result.tensor.k1, TORUS.k1, atol=0.07)
    np.testing.assert_allclose(result.tensor.k2, TORUS.k2, atol=0.07)
    np.testing.assert_allclose(result.tensor.k1**2 + result.tensor.k2**2, result.density, rtol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(result.tensor.direction, axis=1), 1)
    np.testing.assert_allclose(result.tensor.mean, (TORUS.k1 + TORUS.k2) / 2, atol=0.07)
    np.testing.assert_allclose(result.tensor.gaussian, TORUS.k1 * TORUS.k2, atol=0.15)
    np.testing.assert_allclose(result.tensor.curvedness**2 * 2, result.density, rtol=1e-12)
    assert (np.abs(result.tensor.shape_index) <= 1).all() and result.error.shape == result.density.shape
    assert repr(result.tensor).startswith("<PrincipalCurvatures: 1,296 elements; k1 1.9")


def test_repr_tells_counts_and_ranges():
    vertices = np.vstack([TORUS.vertices, [[9, 9, 9]]])
    result = gaussmap.curvature(vertices, TORUS.faces)
    text = repr(result)
    assert text.startswith("<Curvature of a mesh: 1,297 vertices; 2,592 faces; density 4")
    assert "undefined 1;" in text and "estimator dirichlet" in text and "median" in text
    html = result._repr_html_()
    assert html.startswith("<table>") and "<td style='text-align:left'>1,297 vertices</td>" in html
    assert "1,296 points" in repr(gaussmap.curvature(TORUS.vertices))
    assert "none defined" in repr(gaussmap.curvature(np.full((3, 3), np.nan)))


def test_results_are_arrays():
    result = gaussmap.curvature(TORUS)
    assert np.asarray(result) is result.density or np.shares_memory(np.asarray(result), result.density)
    assert np.array(result, copy=True).base is None and np.asarray(result, np.float32).dtype == np.float32


def test_undefined_is_nan_and_counted():
    vertices = TORUS.vertices.copy()
    vertices[7] = np.nan
    result = gaussmap.curvature(vertices, TORUS.faces)
    assert result.undefined == 1 and np.isnan(result.density[7]) and np.isnan(result.density).sum() == 1
    assert result.undefined_faces == 6 and "undefined faces 6" in repr(result)
    cloud = gaussmap.curvature(np.vstack([vertices, vertices[:1]]))
    assert cloud.non_finite == 1 and cloud.duplicates == 1


def test_attach_to_a_geometry_is_what_the_command_writes():
    torus = gaussmap.shapes.torus(around=12, across=12)
    result = gaussmap.curvature(torus, attach=True, tensor=True)
    assert list(torus.attributes)[:5] == ["exact_density", "k1", "k2", "scalar_total_curvature", "quality"]
    assert list(torus.face_attributes) == ["kappa", "quality", "k1", "k2", "d1x", "d1y", "d1z"]
    assert same_bits(torus.attributes["quality"], result.density.astype(np.float32))


def test_normals_of_meshes_and_clouds():
    mesh = gaussmap.normals(TORUS.vertices, TORUS.faces)
    assert mesh.method == "max" and (np.einsum("nd,nd->n", mesh.normals, TORUS.normals) > 0.999).all()
    cloud = gaussmap.normals(TORUS.vertices)
    agree = np.einsum("nd,nd->n", cloud.normals, TORUS.normals)
    assert cloud.method == "jet" and (agree > 0.86).all(), "oriented outward"
    free = gaussmap.normals(TORUS.vertices, orient="none", method="pca")
    assert (np.abs(np.einsum("nd,nd->n", free.normals, TORUS.normals)) > 0.95).all()
    assert repr(cloud).startswith("<Normals: 1,296 normals; method jet; undefined 0; lowered ")
    assert gaussmap.normals(np.zeros((2, 3))).undefined == 2


def test_colours():
    rgb = gaussmap.colors([0.0, 1.0, 2.0, np.nan], high=1.0)
    assert rgb.dtype == np.uint8 and (rgb[1] == rgb[2]).all() and rgb[0].sum() < rgb[1].sum()
    signed = gaussmap.colors([-1.0, 0.0, 1.0], high=1.0, diverging=True)
    assert signed[0, 2] > signed[0, 0] and signed[2, 0] > signed[2, 2]
    assert (gaussmap.colors(np.zeros(5)) == gaussmap.colors([0.0], high=1.0)).all()
