"""cloud.py BUILD: the parts of the program built like the author's against libigl's own. See cloud_speed/components.py."""

import subprocess
import sys
from pathlib import Path

from environment import python_of_peers

SOURCE = Path(__file__).resolve().parent


def main():
    build = Path(sys.argv[1]).resolve()
    folder = build / "bench/cloud"
    folder.mkdir(parents=True, exist_ok=True)
    python = python_of_peers(folder / "venv", SOURCE / "cloud_speed/requirements.txt")
    if python is None:
        return 1
    subprocess.run([python, SOURCE / "cloud_speed/components.py", build, folder], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
