"""Where the peers in Python live: an environment of their own, made by the bench that needs it."""

import subprocess
import sys


def python_of_peers(venv, wanted):
    """The Python of the folder `venv` with the packages of the file `wanted`, or None with a word."""
    stamp = venv / "installed.txt"
    if not stamp.exists() or stamp.read_text() != wanted.read_text():
        try:
            subprocess.run([sys.executable, "-m", "venv", venv], check=True)
            subprocess.run([venv / "bin/pip", "install", "-q", "-r", wanted], check=True)
            stamp.write_text(wanted.read_text())
        except (subprocess.CalledProcessError, OSError) as problem:
            print(f"no peers in Python, {wanted.name} did not install ({problem})", file=sys.stderr)
            return None
    return venv / "bin/python"
