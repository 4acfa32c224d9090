"""python.py BUILD WHEELS: the Python package against the library and against peers in Python. See python/overhead.py and
python/peers.py for what is measured."""

import subprocess
import sys
from pathlib import Path

from environment import python_of_peers

SOURCE = Path(__file__).resolve().parent


def main():
    build, wheels = (Path(argument).resolve() for argument in sys.argv[1:3])
    folder = build / "bench/python"
    folder.mkdir(parents=True, exist_ok=True)
    python = python_of_peers(folder / "venv", SOURCE / "python/requirements.txt")
    if python is None:
        return 1
    subprocess.run(
        [python, "-m", "pip", "install", "-q", "--force-reinstall", "--no-deps", *wheels.glob("*.whl")], check=True
    )
    mesh = folder / "bumpy.ply"  # 1,310,720 triangles
    subprocess.run([build / "gaussmap", "shape", "bumpy", "--subdivisions", "8", "--quiet", "-o", mesh], check=True)
    print("\n## The binding\n", flush=True)
    subprocess.run([python, SOURCE / "python/overhead.py", build, mesh], check=True)
    print("\n## Peers", flush=True)
    subprocess.run([python, SOURCE / "python/peers.py"], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
