"""What the tests of the package share. The package is the one that is installed; the program is $GAUSSMAP, else
build/release/gaussmap; real files are in $GAUSSMAP_DATA, else ../shared/data beside the project."""

import os
import pathlib
import subprocess

import numpy as np
import pytest
from hypothesis import settings

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("GAUSSMAP", PROJECT / "build/release/gaussmap")).resolve()
DATA = pathlib.Path(os.environ.get("GAUSSMAP_DATA") or PROJECT / "../shared/data").resolve()

settings.register_profile("suite", deadline=None, derandomize=True, max_examples=25)
settings.load_profile("suite")


@pytest.fixture
def data():
    if not DATA.is_dir():
        pytest.skip("no folder of real files (set GAUSSMAP_DATA)")
    return DATA


@pytest.fixture
def program(tmp_path):
    """Run the C++ program in an empty folder: program("info", "x.ply")."""
    if not PROGRAM.exists():
        pytest.fail(f"{PROGRAM} is not built (set GAUSSMAP to the program)")

    def run(*arguments):
        done = subprocess.run(
            [PROGRAM, *map(str, arguments)], cwd=tmp_path, capture_output=True, timeout=120, check=False
        )
        assert done.returncode == 0, done.stderr.decode()
        return done.stdout

    return run


def library(name):
    """The module, or a skip that says what is missing."""
    return pytest.importorskip(name, reason=f"skipped: {name} not installed", exc_type=ImportError)


def same_bits(a, b):
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
