"""Just enough PLY to look at what the program wrote, independent of its own reader."""

import struct

CODES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f",
         "float64": "d"}


def parse(content):
    """{element: {property: [values]}}, types as {(element, property): code}, of a binary little-endian or ascii file."""
    header, _, body = content.partition(b"end_header\n")
    elements, types, order, ascii_text = {}, {}, [], False
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "format":
            assert words[1] in ("ascii", "binary_little_endian"), line
            ascii_text = words[1] == "ascii"
        elif words[0] == "element":
            order.append((words[1], int(words[2])))
            elements[words[1]] = {}
        elif words[0] == "property":
            name = words[-1]
            elements[order[-1][0]][name] = []
            types[order[-1][0], name] = tuple(CODES[w] for w in words[2:-1]) if words[1] == "list" else CODES[words[1]]
    tokens = iter(body.split()) if ascii_text else None
    at = 0

    def take(code):
        nonlocal at
        if ascii_text:
            return (float if code in "fd" else int)(next(tokens))
        (value,) = struct.unpack_from("<" + code, body, at)
        at += struct.calcsize("<" + code)
        return value

    for element, count in order:
        for _ in range(count):
            for name, values in elements[element].items():
                code = types[element, name]
                values.append([take(code[1]) for _ in range(take(code[0]))] if isinstance(code, tuple) else take(code))
    assert (next(tokens, None) is None) if ascii_text else at == len(body)
    return elements, types


def read(path):
    with open(path, "rb") as file:
        return parse(file.read())
