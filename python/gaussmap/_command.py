"""The command `gaussmap` of the wheel: the program beside this file, and LAS and LAZ around it.

The program knows no LAS. Where an argument names such a file, inputs are handed to it as PLY under the same name (content
goes before extension), and what it makes is put into the LAS afterwards, every dimension of the input kept.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gaussmap._geometry import Geometry

_program = Path(__file__).parent / "bin" / "gaussmap"


def _is_lidar(argument: str) -> bool:
    return argument.lower().endswith((".las", ".laz"))


class _BadInput(Exception):
    pass


def _shown_colours(attributes: dict[str, Any]) -> None:
    """LAS colours have 16 bits; those of other formats 8."""
    for name in ("red", "green", "blue"):
        if name in attributes and attributes[name].dtype.itemsize == 2:
            wide = max(int(attributes[c].max(initial=0)) for c in ("red", "green", "blue") if c in attributes) > 255
            shift = 8 if wide else 0
            for colour in ("red", "green", "blue"):
                if colour in attributes:
                    attributes[colour] = (attributes[colour] >> shift).astype("uint8")
            return


class _Exchange:
    """Files that stand for LAS files while the program runs."""

    def __init__(self, folder: str) -> None:
        self.folder = Path(folder)
        self.sources: list[tuple[Any, dict[str, Any]]] = []  # clouds, and their attributes as the program saw them
        self.outputs: list[tuple[str, str]] = []  # (LAS wanted, what the program wrote)
        self.names: list[tuple[bytes, bytes]] = []  # (stand-in, the name that the person typed)

    def _place(self, name: str, ending: str) -> str:
        own = self.folder / str(len(self.names))
        own.mkdir()
        stand_in = str(own / (Path(name).name + ending))
        self.names.append((os.fsencode(stand_in), os.fsencode(name)))
        return stand_in

    def given(self, name: str) -> str:
        from gaussmap import _geometry, las

        if not os.path.exists(name):
            return name  # the program says so
        try:
            cloud = las.read(name)
        except ValueError as problem:
            raise _BadInput(str(problem)) from None
        seen = _geometry.as_geometry(cloud)
        _shown_colours(seen.attributes)
        self.sources.append((cloud, seen.attributes))
        stand_in = self._place(name, "")
        _geometry.write(stand_in, seen, format="ply")
        return stand_in

    def wanted(self, name: str) -> str:
        if name.lower().endswith(".copc.laz"):
            raise _BadInput(f"{name}: COPC is read, not written; write .laz")
        folder = os.path.dirname(name) or "."
        if not os.path.isdir(folder):
            raise _BadInput(f"{name}: the folder '{folder}' does not exist; make it first")
        stand_in = self._place(name, ".ply")
        self.outputs.append((name, stand_in))
        return stand_in

    def told(self, text: bytes) -> bytes:
        for stand_in, name in self.names:
            text = text.replace(stand_in, name)
        return text

    def finish(self) -> None:
        """Put what the program wrote into LAS files."""
        from gaussmap import _geometry, las

        for name, stand_in in self.outputs:
            made = _geometry.read(stand_in)
            las.write(name, self._joined(made))

    def _joined(self, made: Geometry) -> Geometry:
        """The cloud that went in with what is new or changed; or what came out alone, where points came or went."""
        import numpy as np

        for cloud, seen in self.sources:
            if len(cloud.vertices) != len(made.vertices):
                continue
            for label, values in made.attributes.items():
                same = label in seen and np.array_equal(seen[label], values, equal_nan=values.dtype.kind == "f")
                if not same:
                    cloud.attributes[label] = values
            cloud.normals = made.normals
            return cloud  # type: ignore[no-any-return]
        return made


def _run(arguments: list[str]) -> int:
    with tempfile.TemporaryDirectory(prefix="gaussmap-") as folder:
        exchange = _Exchange(folder)
        command: list[str] = []
        output_next = False
        for argument in arguments:
            option, _, value = argument.partition("=")
            if output_next and _is_lidar(argument):
                command.append(exchange.wanted(argument))
            elif option in ("-o", "--output") and _is_lidar(value):
                command.append(f"{option}={exchange.wanted(value)}")
            elif _is_lidar(argument) and not argument.startswith("-"):
                command.append(exchange.given(argument))
            else:
                command.append(argument)
            output_next = argument in ("-o", "--output")
        done = subprocess.run([_program, *command], capture_output=True, check=False)
        if done.returncode == 0:
            exchange.finish()
        sys.stderr.buffer.write(exchange.told(done.stderr))
        sys.stdout.buffer.write(exchange.told(done.stdout))
        return done.returncode


def main() -> int:
    """Exit codes are the program's: 0 done, 1 failed while running, 2 wrong usage, 3 bad input."""
    arguments = sys.argv[1:]
    if not any(map(_is_lidar, arguments)):
        os.execv(_program, ["gaussmap", *arguments])
    try:
        return _run(arguments)
    except (_BadInput, ValueError) as problem:
        code, text = 3, str(problem)
    except (ImportError, OSError) as problem:
        code, text = 1, str(problem)
    except KeyboardInterrupt:
        return 130
    print(f"gaussmap: {text}", file=sys.stderr)
    return code
