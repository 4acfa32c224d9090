"""Where the peers in Python and JavaScript live: folders of their own, made by the bench that needs them."""

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


def folder_of_npm(folder, package):
    """The folder with the npm package "NAME@VERSION" installed, or None with a word."""
    stamp = folder / "installed.txt"
    if not stamp.exists() or stamp.read_text() != package:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            subprocess.run(["npm", "install", "--silent", "--prefix", folder, package], check=True)
            stamp.write_text(package)
        except (subprocess.CalledProcessError, OSError) as problem:
            print(f"no peer in JavaScript, {package} did not install ({problem})", file=sys.stderr)
            return None
    return folder
