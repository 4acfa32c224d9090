"""What the tests of the program share. The program is $GAUSSMAP, else build/release/gaussmap; real files are in
$GAUSSMAP_DATA, else ../shared/data beside the project."""

import json
import os
import pathlib
import signal
import subprocess

import pytest

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("GAUSSMAP", PROJECT / "build/release/gaussmap")).resolve()
DATA = pathlib.Path(os.environ.get("GAUSSMAP_DATA") or PROJECT / "../shared/data").resolve()
# A sanitizer makes the program slower, and its memory no measure.
SANITIZED = PROGRAM.exists() and any(word in PROGRAM.read_bytes() for word in (b"__asan_init", b"__tsan_init"))

# Ignored in what a script started in the background, and so by the programs that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)


class Run:
    """One finished run: its exit code and what it said."""

    def __init__(self, code, stdout, stderr):
        self.code = code
        self.stdout = stdout
        self.stderr = stderr.decode("utf-8", "replace")

    @property
    def json(self):
        assert self.code == 0, self.stderr
        return json.loads(self.stdout, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))

    def fails(self, code, line):
        """Exactly one line on standard error, nothing on standard output."""
        assert (self.code, self.stderr, self.stdout) == (code, f"gaussmap: {line}\n", b"")


@pytest.fixture
def gaussmap(tmp_path):
    """Run the program in an empty folder: gaussmap("info", "x.ply", stdin=b"…")."""
    if not PROGRAM.exists():
        pytest.fail(f"{PROGRAM} is not built (set GAUSSMAP to the program)")

    def run(*arguments, stdin=b"", timeout=120, **environment):
        done = subprocess.run(
            [PROGRAM, *map(str, arguments)],
            input=stdin,
            capture_output=True,
            timeout=timeout,
            cwd=tmp_path,
            env={**os.environ, **environment},
            check=False,
        )
        return Run(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture
def data():
    if not DATA.is_dir():
        pytest.skip("no folder of real files (set GAUSSMAP_DATA)")
    return DATA


@pytest.fixture
def program():
    if not PROGRAM.exists():
        pytest.fail(f"{PROGRAM} is not built (set GAUSSMAP to the program)")
    return PROGRAM
