"""What the Python peers share: reading a shape written by `surfaces`, and the line that judge.h prints too."""

import numpy as np

TYPES = {"double": "<f8", "float": "<f4", "int": "<i4", "uint": "<u4", "uchar": "u1"}


def read_shape(path):
    """(vertices n × 3, faces m × 3, normals n × 3, exact density n) of a binary PLY written by `surfaces`."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts, fields, element = {}, {}, None
    for words in (line.split() for line in data[:end].decode().splitlines()):
        if words[0] == "element":
            element = words[1]
            counts[element] = int(words[2])
            fields[element] = []
        elif words[0] == "property" and words[1] == "list":
            fields[element] += [("corners", TYPES[words[2]]), (words[4], TYPES[words[3]], 3)]
        elif words[0] == "property":
            fields[element].append((words[2], TYPES[words[1]]))
    vertex = np.frombuffer(data, fields["vertex"], counts["vertex"], end)
    columns = [np.stack([vertex[name] for name in names], 1) for names in (("x", "y", "z"), ("nx", "ny", "nz"))]
    faces = np.zeros((0, 3), np.int32)
    if counts.get("face"):
        face = np.frombuffer(data, fields["face"], counts["face"], end + vertex.nbytes)
        faces = face[fields["face"][1][0]].astype(np.int32)
    return columns[0], faces, columns[1], vertex["exact_density"].copy()


def report(peer, parameter, density, truth, seconds):
    """Prints peer, parameter, relative RMSE, the same rescaled, undefined, points, seconds."""
    defined = np.isfinite(density)
    d, t = density[defined], truth[: len(density)][defined]
    error = np.sqrt(np.sum((d - t) ** 2) / np.sum(t * t))
    dd = np.sum(d * d)
    rescaled = np.sqrt(max(0.0, np.sum(t * t) - np.sum(d * t) ** 2 / dd) / np.sum(t * t)) if dd > 0 else 1.0
    print(f"{peer},{parameter},{error:.6g},{rescaled:.6g},{np.sum(~defined)},{len(density)},{seconds:.6g}", flush=True)
