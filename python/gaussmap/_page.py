"""A page to look at a result: one HTML file with the viewer and the data."""

from __future__ import annotations

import html
import os
from typing import Any

import numpy as np

from gaussmap import _gaussmap
from gaussmap._arrays import row_values, thread_count
from gaussmap._curvature import Curvature, curvature
from gaussmap._progress import Progress, reported
from gaussmap._subject import Subject, subject_of


class Page(str):
    """The text of an HTML file; a notebook shows the page itself."""

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self, quote=True)}" style="width: 100%; height: 600px; border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<Page: {len(self):,} characters>"


def _of_curvature(result: Curvature) -> list[tuple[str, Any, bool]]:
    vertex, face = result.values()
    fields: list[tuple[str, Any, bool]] = [("density", result.density, False)]
    fields += [(name, values, False) for name, values in vertex.items()]
    if result.kind == "mesh":
        fields += [("kappa", result.kappa, True), *((name, values, True) for name, values in face.items())]
    return fields


def _scene(name: str, x: Any, faces: Any, values: Any) -> tuple[Any, ...]:
    subject: Subject = subject_of(x, faces)
    found = curvature(x, faces) if values is None else values
    if isinstance(found, Curvature):
        fields = _of_curvature(found)
    else:
        given = found if isinstance(found, dict) else {"value": found}
        fields = [(label, array, False) for label, array in given.items()]
    count, triangles = len(subject.vertices), 0 if subject.faces is None else len(subject.faces)
    checked = [(label, row_values(label, np.asarray(a), triangles if of else count), of) for label, a, of in fields]
    normals = found.normals if isinstance(found, Curvature) else subject.normals
    return name, subject.vertices, subject.faces, normals, checked


def to_html(
    x: Any,
    faces: Any = None,
    *,
    values: Any = None,
    beside: Any = None,
    path: str | os.PathLike[str] | None = None,
    title: str = "gaussmap",
    threads: int | None = None,
    progress: Progress = None,
) -> Page:
    """A page to turn, colour and pick a mesh or cloud: one HTML text with viewer and data, no server, no network.

    :param values: a `Curvature` (all that it holds can be chosen on the page), (n,) numbers, or a dict of such by name;
        by default `curvature(x, faces)` is measured.
    :param beside: a second mesh or cloud, shown next to the first with its own curvature.
    :param path: also write the page there, whole or not at all.
    :returns: the text; a notebook shows it as the page.
    :raises ValueError: values of another number than the vertices, nothing to draw.
    :raises RuntimeError: the wheel was built without node; the message says what to do.
    """
    scenes = [_scene("a" if beside is not None else title, x, faces, values)]
    if beside is not None:
        scenes.append(_scene("b", beside, None, None))
    with reported(progress, "making a page") as report:
        page = Page(_gaussmap.page_html(scenes, title, thread_count(threads), report))
    if path is not None:
        try:
            _gaussmap.write_file(os.fspath(path), page)
        except RuntimeError as problem:
            raise OSError(str(problem)) from None
    return page
