"""The package as such: stubs, types, doctests, the gallery of the documentation, the command."""

import contextlib
import doctest
import importlib
import io
import os
import pathlib
import pkgutil
import re
import subprocess
import sys

import pytest
from conftest import library, PROGRAM, PROJECT

import gaussmap

HOME = pathlib.Path(gaussmap.__file__).parent
MODULES = ["gaussmap", *(f"gaussmap.{m.name}" for m in pkgutil.iter_modules([str(HOME)]) if m.name != "_gaussmap")]


def test_all_names_are_there():
    for name in gaussmap.__all__:
        assert getattr(gaussmap, name) is not None
    assert set(gaussmap.__all__) <= set(dir(gaussmap))
    with pytest.raises(AttributeError, match="no attribute 'curvatur'"):
        gaussmap.curvatur
    assert re.match(r"\d+\.\d+\.\d+", gaussmap.__version__)


def test_numpy_is_enough(tmp_path):
    """Importing and measuring work where nothing but NumPy can be imported."""
    code = """
import sys
class OnlyNumpy:
    def find_spec(self, name, path=None, target=None):
        if name.split('.')[0] in ('laspy', 'pyvista', 'trimesh', 'meshio', 'pymeshlab', 'open3d', 'dask', 'rich', 'scipy', 'vtk'):
            raise ImportError(name)
sys.meta_path.insert(0, OnlyNumpy())
import gaussmap
assert gaussmap.curvature(gaussmap.shapes.sphere()).undefined == 0
for call, extra in ((lambda: gaussmap.read(sys.argv[1]), 'las'), (lambda: gaussmap.plot(gaussmap.shapes.sphere()), 'view')):
    try:
        call()
    except ImportError as problem:
        assert f"pip install 'gaussmap[{extra}]'" in str(problem), problem
    else:
        raise SystemExit('no complaint')
"""
    (tmp_path / "x.las").write_bytes(b"")
    subprocess.run([sys.executable, "-c", code, tmp_path / "x.las"], check=True)


def test_importing_waits_for_nothing():
    done = subprocess.run(
        [sys.executable, "-c", "import gaussmap, sys; print('numpy' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "False\n"


def test_stubs_are_those_of_the_module(tmp_path):
    stubgen = library("nanobind.stubgen")
    with contextlib.redirect_stdout(io.StringIO()):
        stubgen.main(["-m", "gaussmap._gaussmap", "-o", str(tmp_path / "_gaussmap.pyi")])
    committed = PROJECT / "python/gaussmap/_gaussmap.pyi"
    assert committed.read_text() == (tmp_path / "_gaussmap.pyi").read_text(), "run make python-stubs"


def test_types():
    library("mypy")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", PROJECT / "pyproject.toml", "--cache-dir", os.devnull],
        cwd=PROJECT / "python", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("name", MODULES)
def test_doctests(name):
    module = importlib.import_module(name)
    assert doctest.testmod(module, extraglobs={"gaussmap": gaussmap}).failed == 0


def test_there_are_doctests():
    assert (
        sum(
            len(test.examples)
            for name in MODULES
            for test in doctest.DocTestFinder().find(importlib.import_module(name))
        )
        >= 8
    )


def blocks(page):
    return re.findall(r"^```python\n(.*?)^```", (PROJECT / page).read_text(), re.M | re.S)


@pytest.mark.parametrize("page", ["docs/python.md", "README.md"])
def test_the_documentation_runs(page, tmp_path, monkeypatch, data):
    """Every example, in order, in one folder. What `print(…)  # text` prints is the text."""
    library("pyvista")
    monkeypatch.chdir(tmp_path)
    for name in ("cow.ply", "bunny.ply"):
        os.symlink(data / "meshes/seed" / name, name)
    os.symlink(data / "clouds/simple.las", "scan.las")
    codes = blocks(page)
    assert codes
    names = {}
    for code in codes:
        expected = [
            line.split("  # ", 1)[1] for line in code.splitlines() if line.startswith("print(") and "  # " in line
        ]
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            exec(compile(code, page, "exec"), names)
        assert told.getvalue().splitlines() == expected


def command(*arguments):
    program = os.path.join(os.path.dirname(sys.executable), "gaussmap")
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=False)


def test_the_command_is_the_program(tmp_path):
    assert command("--version").stdout == f"gaussmap {gaussmap.__version__}\n"
    assert command().returncode == 2
    out = tmp_path / "torus.ply"
    assert command("shape", "torus", "-o", out).returncode == 0
    subprocess.run([PROGRAM, "shape", "torus", "-o", tmp_path / "program.ply"], check=True, capture_output=True)
    assert out.read_bytes() == (tmp_path / "program.ply").read_bytes()


def test_a_picture(tmp_path):
    library("pyvista")
    gaussmap.plot(gaussmap.shapes.torus(), path=tmp_path / "torus.png", window_size=(200, 150))
    assert (tmp_path / "torus.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    with pytest.raises(ValueError, match=r"values has shape \(2,\)"):
        gaussmap.plot(gaussmap.shapes.torus(), values=[1, 2])


def test_a_page(tmp_path):
    torus = gaussmap.shapes.torus()
    try:
        page = gaussmap.to_html(torus, values=gaussmap.curvature(torus, tensor=True), path=tmp_path / "torus.html")
    except RuntimeError as problem:
        pytest.skip(f"skipped: {problem}")
    assert page == (tmp_path / "torus.html").read_text() and page.startswith("<!") and "k1" in page
    assert page._repr_html_().startswith('<iframe srcdoc="&lt;!') and repr(page).startswith("<Page: ")
    assert len(gaussmap.to_html(torus, beside=gaussmap.shapes.sphere())) > len(page) / 2
    with pytest.raises(ValueError, match=r"value has shape \(2,\); \(1296,\) is wanted"):
        gaussmap.to_html(torus, values=[1, 2])
