"""distance.py BUILD [FROM TO]: closest points per second and distances against libigl, Open3D and MeshLab, on two meshes of
200,000 triangles made on the spot, and on two files where they are named. See distance/peers.py for what is measured."""

import subprocess
import sys
from pathlib import Path

from environment import python_of_peers

SOURCE = Path(__file__).resolve().parent


def main():
    build = Path(sys.argv[1]).resolve()
    folder = build / "bench/distance"
    folder.mkdir(parents=True, exist_ok=True)
    python = python_of_peers(folder / "venv", SOURCE / "distance/requirements.txt")
    if python is None:
        return 1
    pairs = [sys.argv[2:4]] if len(sys.argv) > 2 else []
    for grid, seed in (("400x250", 1), ("250x400", 2)):
        subprocess.run([build / "gaussmap", "shape", "torus", "--grid", grid, "--jitter", "0.25", "--noise", "0.1",
                        "--seed", str(seed), "--quiet", "-o", folder / f"torus{seed}.ply"], check=True)
    pairs.insert(0, [folder / "torus1.ply", folder / "torus2.ply"])
    for source, target in pairs:
        print(f"\n## {Path(source).name} to {Path(target).name}\n", flush=True)
        subprocess.run([python, SOURCE / "distance/peers.py", build, source, target], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
