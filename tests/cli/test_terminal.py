"""On a terminal, off it, and when interrupted."""

import os
import pty
import signal
import subprocess
import time

import pytest


def on_terminal(program, arguments, folder, **environment):
    """Standard error of a run on a terminal."""
    master, slave = pty.openpty()
    base = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "TERM")}
    process = subprocess.Popen(
        [program, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=slave,
        env={**base, "TERM": "xterm", **environment},
    )
    os.close(slave)
    seen = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # Linux tells the end of a terminal so
            break
        if not part:
            break
        seen += part
    os.close(master)
    process.communicate()
    assert process.returncode == 0
    return seen.decode()


@pytest.fixture
def big(gaussmap, tmp_path):
    """A cloud that takes over a second."""
    gaussmap("shape", "sphere", "--subdivisions", 8, "-o", "big.ply")
    return ["curvature", "big.ply", "--as", "cloud", "--normals", "estimate", "--orient", "mst", "--threads", 1]


def test_bar_and_bold_on_a_terminal_for_long_work(program, tmp_path, big):
    seen = on_terminal(program, big, tmp_path)
    assert "\rmeasuring curvature [#" in seen and " %" in seen
    bar, _, report = seen.rpartition("\r\x1b[K")
    assert report.startswith("\x1b[1mbig.ply: a cloud of 655,362 points\x1b[0m"), "the bar is wiped out first"
    assert "[#" not in report


@pytest.mark.parametrize("environment", [{"NO_COLOR": "1"}, {"TERM": "dumb"}])
def test_no_bar_and_no_colour_where_not_wanted(program, tmp_path, big, environment):
    seen = on_terminal(program, big, tmp_path, **environment)
    assert "[" not in seen.replace("[0, 1]", "") and "\x1b" not in seen


def test_no_bar_when_quiet(program, tmp_path, big):
    assert on_terminal(program, [*big, "--quiet"], tmp_path) == ""


def test_no_bar_for_short_work(program, tmp_path):
    seen = on_terminal(program, ["shape", "torus", "-o", "t.ply"], tmp_path)
    assert seen.startswith("\x1b[1mtorus\x1b[0m") and "\r\x1b" not in seen


def test_no_bar_and_no_colour_off_a_terminal(gaussmap, big):
    run = gaussmap(*big)
    assert run.code == 0 and "\r" not in run.stderr and "\x1b" not in run.stderr


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("pause", [0.05, 0.5, 1.2])
def test_interrupted_promptly_with_nothing_left_behind(program, tmp_path, big, number, code, pause):
    process = subprocess.Popen([program, *map(str, big), "-o", "out.ply"], cwd=tmp_path, stderr=subprocess.PIPE)
    time.sleep(pause)
    process.send_signal(number)
    begin = time.monotonic()
    _, said = process.communicate(timeout=30)
    # A signal that comes before the program has begun ends it as the system does; shells say the same of both.
    assert process.returncode in (code, -number) and said == b""
    assert time.monotonic() - begin < 1
    assert os.listdir(tmp_path) == ["big.ply"]


def test_interrupted_while_waiting_for_standard_input(program):
    process = subprocess.Popen([program, "info", "-"], stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=5) == 130
    process.communicate()


def test_interrupted_while_writing(program, gaussmap, tmp_path):
    """Again and again at moments all over the run: the old file, or the new one, and nothing beside it."""
    command = ["shape", "sphere", "--subdivisions", "7", "-o", "s.ply"]
    gaussmap(*command)
    begin = time.monotonic()
    gaussmap(*command)
    duration = time.monotonic() - begin
    whole = (tmp_path / "s.ply").read_bytes()
    (tmp_path / "s.ply").write_bytes(b"old")
    for step in range(40):
        process = subprocess.Popen([program, *command], cwd=tmp_path, stderr=subprocess.DEVNULL)
        time.sleep(duration * step / 40)
        process.send_signal(signal.SIGTERM)
        # The very first moment may come before the program has set up anything: then the system ends it.
        assert process.wait(timeout=30) in (143, 0, -signal.SIGTERM)
        assert os.listdir(tmp_path) == ["s.ply"]
        assert (tmp_path / "s.ply").read_bytes() in (b"old", whole)
