"""Run in an environment that holds the wheel and NumPy alone: the package, the command, and what is there to import."""

import importlib.metadata
import os
import subprocess
import sys

import gaussmap

torus = gaussmap.shapes.torus()
result = gaussmap.curvature(torus)
print(result)
assert abs(((result.density - torus.density) ** 2).mean() ** 0.5 - 0.0372) < 5e-5
gaussmap.write("torus.ply", torus)
command = os.path.join(os.path.dirname(sys.executable), "gaussmap")
told = subprocess.run(
    [command, "curvature", "torus.ply", "--truth", "exact_density"], capture_output=True, text=True, check=True
)
assert "0.0372" in told.stderr, told.stderr
os.unlink("torus.ply")
installed = {d.name.lower() for d in importlib.metadata.distributions()}
assert installed <= {"gaussmap", "numpy", "pip", "setuptools"}, installed
