"""Binary PLY of our own program, whole, as arrays; and back."""

import numpy as np

TYPES = {"double": "<f8", "float": "<f4", "int": "<i4", "uint": "<u4", "uchar": "u1", "ushort": "<u2", "short": "<i2",
         "char": "i1"}


def read(path):
    """(vertices as a structured array, faces m × 3 or None) of a binary little-endian PLY whose faces are triangles."""
    data = open(path, "rb").read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    fields, counts, element = {}, {}, None
    for words in (line.split() for line in data[:end].decode().splitlines()):
        if words[0] == "element":
            element, counts[words[1]] = words[1], int(words[2])
            fields[element] = []
        elif words[0] == "property" and words[1] == "list":
            fields[element] += [("corners", TYPES[words[2]]), (words[4], TYPES[words[3]], 3)]
        elif words[0] == "property":
            fields[element].append((words[2], TYPES[words[1]]))
    vertices = np.frombuffer(data, fields["vertex"], counts["vertex"], end)
    if not counts.get("face"):
        return vertices, None
    faces = np.frombuffer(data, fields["face"], counts["face"], end + vertices.nbytes)
    return vertices, faces[fields["face"][1][0]].astype(np.int32)


def positions(vertices):
    return np.stack([vertices[axis].astype(float) for axis in "xyz"], 1)


def write(path, points, faces=None, **columns):
    """Points, triangles, and more columns, all as doubles."""
    table = np.column_stack([points, *columns.values()]).astype("<f8")
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(table)}",
              *(f"property double {name}" for name in ["x", "y", "z", *columns])]
    body = table.tobytes()
    if faces is not None:
        header += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        rows = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
        rows["count"], rows["corners"] = 3, faces
        body += rows.tobytes()
    with open(path, "wb") as file:
        file.write("\n".join([*header, "end_header", ""]).encode() + body)
