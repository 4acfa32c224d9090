"""Meshes and clouds of other libraries, the real ones where they are installed."""

import numpy as np
import pytest
from conftest import library, same_bits

import gaussmap

TORUS = gaussmap.shapes.torus(around=24, across=16)
V, F, N = TORUS.vertices, TORUS.faces, TORUS.normals
MESH = gaussmap.curvature(V, F)
CLOUD = gaussmap.curvature(V)


def test_trimesh():
    trimesh = library("trimesh")
    mesh = trimesh.Trimesh(V, F, process=False)
    result = gaussmap.curvature(mesh, attach=True)
    assert same_bits(result.density, MESH.density)
    assert same_bits(mesh.vertex_attributes["total_curvature"], MESH.density)
    assert same_bits(mesh.face_attributes["kappa"], MESH.kappa)
    cloud = trimesh.PointCloud(V)
    assert same_bits(gaussmap.curvature(cloud, attach=True).density, CLOUD.density)
    assert same_bits(cloud.metadata["total_curvature"], CLOUD.density) and len(cloud.colors) == len(V)
    assert len(gaussmap.decimate(mesh, faces=100).faces) <= 100


def test_pyvista():
    pyvista = library("pyvista")
    mesh = pyvista.PolyData.from_regular_faces(V, F)
    assert same_bits(gaussmap.curvature(mesh, attach=True).density, MESH.density)
    assert same_bits(mesh.point_data["total_curvature"], MESH.density)
    assert same_bits(mesh.cell_data["kappa"], MESH.kappa)
    cloud = pyvista.PolyData(V)
    assert same_bits(gaussmap.curvature(cloud, attach=True).density, CLOUD.density)
    assert "total_curvature" in cloud.point_data and "kappa" not in cloud.cell_data
    quads = pyvista.PolyData(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), np.array([4, 0, 1, 2, 3]))
    flat = gaussmap.curvature(quads, attach=True)
    assert len(flat.kappa) == 2 and not flat.density.any() and "kappa" not in quads.cell_data
    mesh.point_data.active_normals = N
    assert same_bits(gaussmap.curvature(mesh).density, gaussmap.curvature(V, F, normals=N).density)


def test_meshio():
    meshio = library("meshio")
    mesh = meshio.Mesh(V, [("triangle", F[:100]), ("line", [[0, 1]]), ("triangle", F[100:])])
    assert same_bits(gaussmap.curvature(mesh, attach=True).density, MESH.density)
    assert same_bits(mesh.point_data["total_curvature"], MESH.density)
    assert same_bits(np.concatenate([mesh.cell_data["kappa"][0], mesh.cell_data["kappa"][2]]), MESH.kappa)
    assert np.isnan(mesh.cell_data["kappa"][1]).all()
    quads = meshio.Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [("quad", [[0, 1, 2, 3]])])
    assert not gaussmap.curvature(quads).density.any()


def test_pymeshlab():
    pymeshlab = library("pymeshlab")
    mesh = pymeshlab.Mesh(V, F)
    assert same_bits(gaussmap.curvature(mesh, attach=True).density, MESH.density)
    np.testing.assert_array_equal(mesh.vertex_custom_scalar_attribute_array("total_curvature"), MESH.density)
    np.testing.assert_array_equal(mesh.face_custom_scalar_attribute_array("kappa"), MESH.kappa)
    assert same_bits(gaussmap.curvature(pymeshlab.Mesh(V)).density, CLOUD.density)
    oriented = pymeshlab.Mesh(V, v_normals_matrix=N)
    expected = gaussmap.curvature(V, normals=N, estimator="dirichlet")
    assert same_bits(gaussmap.curvature(oriented, estimator="dirichlet").density, expected.density)


def test_open3d():
    open3d = library("open3d")
    mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(V), open3d.utility.Vector3iVector(F))
    assert same_bits(gaussmap.curvature(mesh, attach=True).density, MESH.density)
    assert (np.asarray(mesh.vertex_colors) * 255).round().astype(int).tolist() == gaussmap.colors(MESH.density).tolist()
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(V))
    assert same_bits(gaussmap.curvature(cloud, attach=True).density, CLOUD.density) and cloud.has_colors()


def test_open3d_tensors():
    open3d = library("open3d")
    tensor = open3d.core.Tensor
    mesh = open3d.t.geometry.TriangleMesh(tensor(V), tensor(F))
    assert same_bits(gaussmap.curvature(mesh, attach=True).density, MESH.density)
    np.testing.assert_array_equal(mesh.vertex["total_curvature"].numpy().ravel(), MESH.density.astype(np.float32))
    np.testing.assert_array_equal(mesh.triangle["kappa"].numpy().ravel(), MESH.kappa.astype(np.float32))
    cloud = open3d.t.geometry.PointCloud(tensor(V))
    assert same_bits(gaussmap.curvature(cloud, attach=True).density, CLOUD.density)
    assert "total_curvature" in cloud.point


def test_anything_that_looks_like_a_mesh():
    class Plain:
        vertices = V.tolist()
        faces = F.tolist()

    assert same_bits(gaussmap.curvature(Plain()).density, MESH.density)
    with pytest.raises(ValueError, match="attach=True: a .*Plain has no attributes to write to"):
        gaussmap.curvature(Plain(), attach=True)


def test_no_library_is_imported():
    import subprocess
    import sys

    code = "import sys, numpy, gaussmap; gaussmap.curvature(gaussmap.shapes.torus()); print([m for m in sys.modules if m in ('trimesh', 'pyvista', 'open3d', 'meshio', 'pymeshlab', 'laspy')])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
