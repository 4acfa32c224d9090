"""Every real file through info and curvature: an answer or one clear line, soon, never a crash.
With GAUSSMAP_SWEEP=path a table of all of them is written there."""

import json
import os
import time

import pytest
from conftest import DATA, SANITIZED

FILES = sorted(p for folder in ("meshes", "clouds", "nasty") for p in (DATA / folder).rglob("*") if p.is_file())
SECONDS_ALLOWED = 240 if SANITIZED else 30
# Noise costs the default estimator of clouds about a millisecond a point: larger files go through the fans.
BYTES_FOR_AUTO = 60_000 if SANITIZED else 250_000


@pytest.fixture(scope="module")
def table():
    rows = []
    yield rows
    if path := os.environ.get("GAUSSMAP_SWEEP"):
        with open(path, "w", encoding="utf-8") as file:
            file.write("| file | verb | exit | seconds | result |\n|---|---|---|---|---|\n")
            file.writelines("| " + " | ".join(row) + " |\n" for row in rows)


def summary(verb, report):
    counts = ["undefined", "duplicates", "non_finite"] if verb == "curvature" else ["duplicate_vertices", "non_finite"]
    text = f"{report['kind']} {report['vertices']}/{report['faces']}"
    text += "".join(f", {key} {report[key]}" for key in counts if report[key])
    if verb == "curvature" and report["density"]["p50"] is not None:
        text += f", median {report['density']['p50']:.4g}"
    return text


@pytest.mark.skipif(not FILES, reason="no folder of real files (set GAUSSMAP_DATA)")
@pytest.mark.parametrize("verb", ["info", "curvature"])
@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(DATA)))
def test_file(gaussmap, table, path, verb):
    fans = ["--estimator", "dirichlet"] if verb == "curvature" and path.stat().st_size > BYTES_FOR_AUTO else []
    begin = time.monotonic()
    run = gaussmap(verb, path, "--json", *fans, timeout=SECONDS_ALLOWED)
    duration = time.monotonic() - begin
    assert run.code in (0, 3), f"exit {run.code}: {run.stderr[:2000]}"
    if run.code == 0:
        assert run.stderr == ""
        report = run.json
        assert report["file"] == str(path) and report["vertices"] >= 0
        result = summary(verb, report)
        # Nothing but what the file justifies: the program itself, and some hundred times the bytes of the file.
        if not SANITIZED:
            assert report["peak_bytes"] < 50_000_000 + 300 * path.stat().st_size
    else:
        assert run.stdout == b""
        assert run.stderr.startswith(f"gaussmap: {path}: ") and run.stderr.count("\n") == 1
        assert run.stderr.endswith("\n")
        result = json.dumps(run.stderr[len("gaussmap: ") + len(str(path.parent)) + 1 : -1], ensure_ascii=False)[1:-1]
    table.append([str(path.relative_to(DATA)), verb, str(run.code), f"{duration:.2f}", result.replace("|", "\\|")])
