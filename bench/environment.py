"""Where the peers in Python and JavaScript live: folders of their own, made by the bench that needs them."""

import subprocess
import sys


def _installed(folder, wanted, what, *commands):
    """Whether the commands have run for what is wanted now, in this folder; a word if they fail."""
    stamp = folder / "installed.txt"
    if stamp.exists() and stamp.read_text() == wanted:
        return True
    try:
        for command in commands:
            subprocess.run(command, check=True)
        stamp.write_text(wanted)
        return True
    except (subprocess.CalledProcessError, OSError) as problem:
        print(f"no peers of {what}, which did not install ({problem})", file=sys.stderr)
        return False


def python_of_peers(venv, wanted):
    """The Python of the folder `venv` with the packages of the file `wanted`, or None with a word."""
    make = [sys.executable, "-m", "venv", venv], [venv / "bin/pip", "install", "-q", "-r", wanted]
    return venv / "bin/python" if _installed(venv, wanted.read_text(), wanted.name, *make) else None


def folder_of_npm(folder, package):
    """The folder with the npm package "NAME@VERSION" installed, or None with a word."""
    make = ["npm", "install", "--silent", "--prefix", folder, package]
    folder.mkdir(parents=True, exist_ok=True)
    return folder if _installed(folder, package, package, make) else None
