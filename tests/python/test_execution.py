"""How long calls behave: other threads run, Ctrl-C ends them, progress is told, cancelling cancels."""

import os
import signal
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import gaussmap

MESH = gaussmap.shapes.bumpy(subdivisions=6)
CLOUD = gaussmap.shapes.bumpy(subdivisions=4, noise=0.1).vertices
# For what would be done with the smaller ones before a clock is looked at twice.
LARGE_MESH = gaussmap.shapes.bumpy(subdivisions=7)
LARGE_CLOUD = gaussmap.shapes.bumpy(subdivisions=6, noise=0.1).vertices


def test_another_thread_runs_meanwhile():
    running, counted = threading.Event(), [0]
    done = threading.Event()

    def count():
        running.set()
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    running.wait()
    seen = []
    before = counted[0]
    gaussmap.curvature(CLOUD, threads=1, progress=lambda fraction: seen.append(counted[0]))
    during = counted[0] - before
    done.set()
    thread.join()
    assert during > 1000


def test_two_calls_run_side_by_side():
    """Both calls are under way at the same time: each reports while the other has begun and not ended."""
    barrier = threading.Barrier(2, timeout=60)
    results = {}

    def work(name):
        met = []

        def report(fraction):
            if not met:
                met.append(True)
                barrier.wait()

        results[name] = gaussmap.curvature(CLOUD, threads=1, progress=report).density

    threads = [threading.Thread(target=work, args=(name,)) for name in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(results["a"], results["b"])


@pytest.mark.parametrize(
    "call",
    [
        lambda p: gaussmap.curvature(LARGE_CLOUD, progress=p),
        lambda p: gaussmap.decimate(LARGE_MESH, faces=5000, progress=p),
        lambda p: gaussmap.sample(LARGE_MESH, count=60000, progress=p),
        lambda p: gaussmap.compare(MESH, gaussmap.shapes.sphere(subdivisions=6), samples=300_000, progress=p),
    ],
    ids=["curvature", "decimate", "sample", "compare"],
)
def test_progress_rises_to_one_and_cancels(call):
    fractions = []
    call(fractions.append)
    assert fractions == sorted(fractions) and fractions[-1] == 1.0 and all(0 <= f <= 1 for f in fractions)
    assert len(fractions) > 2
    with pytest.raises(gaussmap.Cancelled, match="cancelled"):
        call(lambda fraction: False)


def test_what_progress_raises_is_raised():
    def report(fraction):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        gaussmap.curvature(CLOUD, progress=report)


def test_a_bar(capsys):
    gaussmap.decimate(MESH, faces=50_000, fast=True, progress=True)
    shown = capsys.readouterr().err
    assert shown.startswith("\rdecimating [") and shown.endswith("] 100 %\n")
    gaussmap.decimate(MESH, faces=80_000, fast=True, progress=False)
    assert capsys.readouterr().err == ""


def test_short_calls_report_their_end():
    fractions = []
    gaussmap.curvature(np.eye(3), [[0, 1, 2]], progress=fractions.append)
    assert fractions == [1.0]


@pytest.mark.parametrize("call", ["gaussmap.curvature(points)", "gaussmap.decimate(mesh, faces=1000)"])
def test_ctrl_c(call):
    """SIGINT in the middle of a call that would take long ends it by KeyboardInterrupt, and the process lives on."""
    script = f"""
        import gaussmap, numpy, signal
        signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in what shells run in the background
        mesh = gaussmap.shapes.bumpy(subdivisions=8)
        points = numpy.vstack([mesh.vertices + i for i in range(4)]) + numpy.random.default_rng(0).normal(scale=.01, size=(4 * len(mesh.vertices), 3))
        print("begun", flush=True)
        try:
            {call}
        except KeyboardInterrupt:
            print("interrupted", flush=True)
            print(gaussmap.curvature(numpy.eye(3), [[0, 1, 2]]).undefined)
    """
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    threading.Event().wait(0.5)
    os.kill(child.pid, signal.SIGINT)
    rest, _ = child.communicate(timeout=100)
    assert rest == "interrupted\n0\n" and child.returncode == 0
