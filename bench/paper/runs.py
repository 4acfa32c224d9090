"""Runs of our program and of the peers' programs: nothing is kept from an earlier run."""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from accuracy import rows_of
from environment import python_of_peers

SOURCE = Path(__file__).resolve().parent
BENCH = SOURCE.parent
DATA = BENCH.parent / "../shared/data"


class Runs:
    def __init__(self, build, quick):
        self.build, self.quick = build, quick
        self.program = build / "gaussmap"
        self.tools = build / "bench"
        self.folder = self.tools / "paper"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.python = python_of_peers(self.folder / "venv", SOURCE / "requirements.txt")

    def ours(self, verb, *arguments):
        """The report of our program; what it could not do ends the run with its own words."""
        command = [self.program, verb, *map(str, arguments), "--json", "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"paper: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def judged(self, file, kind, *options):
        """(RMSE, relative RMSE, seconds) of our density against the file's exact_density."""
        report = self.ours("curvature", file, "--as", kind, *options, "--truth", "exact_density")
        seconds = sum(report["seconds"][part] for part in ("normals", "neighbors", "curvature"))
        return report["truth"]["rmse"], report["truth"]["relative_rmse"], seconds

    def shape(self, name, *options):
        """A surface of our own program, with exact normals and density."""
        path = self.folder / "shapes" / f"{name}.ply"
        path.parent.mkdir(exist_ok=True)
        self.ours("shape", *options, "-o", path)
        return path

    def version(self, package):
        """Of a package among the peers in Python."""
        ask = f"import importlib.metadata; print(importlib.metadata.version({package!r}))"
        done = subprocess.run([self.python or sys.executable, "-c", ask], capture_output=True, text=True)
        return done.stdout.strip()

    def peer_rows(self, jobs):
        """The rows that the peers' programs print, [] of a peer that is missing; two at a time, in the order of jobs."""
        with ThreadPoolExecutor(2) as pool:
            return list(pool.map(self._rows, jobs))

    def _rows(self, command):
        if command[0] is None or not Path(command[0]).exists():
            print(f"paper: {command[0] or command[1]} is not there; no rows of it", file=sys.stderr)
            return []
        done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            print(f"paper: {Path(command[0]).name} failed; no rows of it", file=sys.stderr)
            return []
        return rows_of(done.stdout)
