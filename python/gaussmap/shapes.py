"""Analytic surfaces as triangle meshes, with exact normals and curvature at every vertex: ground truth.

Each is a `Geometry` with the attributes `exact_density` (k1² + k2², 1/length²), `k1` and `k2`. Defaults are those of
`gaussmap shape`. All take

- `jitter`: vertices move along the surface by up to this part of the edges (0.25 is irregular without folds);
- `noise`: then off it, Gaussian, a part of the mean edge (`noise_unit="edge"`) or of the box (`"diagonal"`); normals and
  curvature stay those of the clean surface;
- `seed`: the same seed, the same numbers, on every machine.

What is out of range is a ValueError that says so.

>>> gaussmap.shapes.sphere(subdivisions=1, radius=2.0).density.tolist()[:2]
[0.5, 0.5]
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gaussmap import _gaussmap
from gaussmap._arrays import Floats, whole
from gaussmap._geometry import Geometry


@dataclass(eq=False, repr=False)
class Shape(Geometry):
    """A mesh of an analytic surface, its normals exact."""

    @property
    def density(self) -> Floats:
        """Exact k1² + k2² of each vertex, 1/length²."""
        return self.attributes["exact_density"]

    @property
    def k1(self) -> Floats:
        """Exact principal curvatures, k1 ≥ k2, 1/length: positive on a sphere."""
        return self.attributes["k1"]

    @property
    def k2(self) -> Floats:
        return self.attributes["k2"]


def _shape(make: Any, *values: Any, jitter: float, noise: float, seed: int, noise_unit: str) -> Shape:
    made = make(*values, float(jitter), float(noise), whole("seed", seed, 0, 2**63 - 1), noise_unit)
    attributes = {"exact_density": made["density"], "k1": made["k1"], "k2": made["k2"]}
    return Shape(made["vertices"], made["faces"], made["normals"], attributes)


def _grid(around: int, across: int) -> tuple[int, int]:
    return whole("around", around, 0), whole("across", across, 0)


def sphere(
    *,
    subdivisions: int = 5,
    radius: float = 1.0,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Of radius `radius`, from an icosahedron whose faces are split in four `subdivisions` times (0 to 12)."""
    return _shape(
        _gaussmap.sphere,
        whole("subdivisions", subdivisions, 0),
        float(radius),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def torus(
    *,
    major: float = 1.0,
    minor: float = 0.5,
    around: int = 36,
    across: int = 36,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Of revolution about z: `major` from the axis to the tube's centre, `minor` the tube's radius, minor < major."""
    return _shape(
        _gaussmap.torus,
        float(major),
        float(minor),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def knot(
    *,
    p: int = 2,
    q: int = 3,
    major: float = 2.0,
    minor: float = 1.0,
    radius: float = 0.25,
    around: int = 400,
    across: int = 40,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Tube of radius `radius` around the (p, q) knot on a torus of radii `major` and `minor`; p and q coprime."""
    return _shape(
        _gaussmap.torus_knot,
        whole("p", p, 0),
        whole("q", q, 0),
        float(major),
        float(minor),
        float(radius),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def figure_eight(
    *,
    scale: float = 1.0,
    radius: float = 0.25,
    around: int = 400,
    across: int = 40,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Tube around the figure-eight knot."""
    return _shape(
        _gaussmap.figure_eight_knot,
        float(scale),
        float(radius),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def ellipsoid(
    *,
    a: float = 1.0,
    b: float = 0.8,
    c: float = 0.6,
    subdivisions: int = 5,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """x²/a² + y²/b² + z²/c² = 1, from the subdivided icosahedron."""
    return _shape(
        _gaussmap.ellipsoid,
        float(a),
        float(b),
        float(c),
        whole("subdivisions", subdivisions, 0),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def bumpy(
    *,
    radius: float = 1.0,
    amplitude: float = 0.1,
    frequency: float = 4.0,
    subdivisions: int = 6,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Sphere with smooth bumps: radius r (1 + amplitude sin(fx) sin(fy) sin(fz)), |amplitude| < 1."""
    return _shape(
        _gaussmap.bumpy_sphere,
        float(radius),
        float(amplitude),
        float(frequency),
        whole("subdivisions", subdivisions, 0),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def catenoid(
    *,
    radius: float = 1.0,
    height: float = 2.0,
    around: int = 72,
    across: int = 36,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """A minimal surface of neck `radius`, open at both ends; k1 = −k2."""
    return _shape(
        _gaussmap.catenoid,
        float(radius),
        float(height),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def cylinder(
    *,
    radius: float = 1.0,
    height: float = 2.0,
    around: int = 72,
    across: int = 36,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """About z, open at both ends; k = {1/r, 0}."""
    return _shape(
        _gaussmap.cylinder,
        float(radius),
        float(height),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def plane(
    *,
    width: float = 1.0,
    depth: float = 1.0,
    around: int = 36,
    across: int = 36,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """A rectangle in z = 0, `around` vertices along x; exactly flat."""
    return _shape(
        _gaussmap.plane,
        float(width),
        float(depth),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )


def waves(
    *,
    width: float = 1.0,
    depth: float = 1.0,
    amplitude: float = 0.05,
    wavelength: float = 0.5,
    around: int = 100,
    across: int = 100,
    jitter: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    noise_unit: str = "edge",
) -> Shape:
    """Height field z = amplitude cos(2πx / wavelength) cos(2πy / wavelength), open."""
    return _shape(
        _gaussmap.waves,
        float(width),
        float(depth),
        float(amplitude),
        float(wavelength),
        *_grid(around, across),
        jitter=jitter,
        noise=noise,
        seed=seed,
        noise_unit=noise_unit,
    )
