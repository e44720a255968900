# SPDX-License-Identifier: BSD-3-Clause
"""Spectral files byte by byte, from the published layouts alone: ENVI, NumPy's .npy and MATLAB's MAT 5."""

import itertools
import struct

# ENVI's data types: code, struct letter.
ENVI_TYPES = {1: "B", 2: "h", 3: "i", 4: "f", 5: "d", 12: "H", 13: "I", 14: "q", 15: "Q"}
# The order of the loops, outermost first.
INTERLEAVES = {"bsq": "byx", "bil": "ybx", "bip": "yxb"}


def envi(columns, rows, bands, value, data_type=4, interleave="bsq", big_endian=False, offset=0, **entries):
    """(header text, bytes) of an ENVI image; `value(row, column, band)` fills it. Further entries of the header are
    named with underscores for blanks."""
    sizes = {"x": columns, "y": rows, "b": bands}
    numbers = []
    for place in itertools.product(*(range(sizes[axis]) for axis in INTERLEAVES[interleave])):
        at = dict(zip(INTERLEAVES[interleave], place))
        numbers.append(value(at["y"], at["x"], at["b"]))
    data = b"\xAA" * offset + struct.pack(f"{'>' if big_endian else '<'}{len(numbers)}{ENVI_TYPES[data_type]}", *numbers)
    lines = ["ENVI", "; a comment", f"samples = {columns}", f"lines   = {rows}", f"bands = {bands}",
             f"data type = {data_type}", f"interleave = {interleave}", f"byte order = {int(big_endian)}",
             f"header offset = {offset}"]
    for key, entry in entries.items():
        text = "{" + ",\n  ".join(map(str, entry)) + "}" if isinstance(entry, (list, tuple)) else entry
        lines.append(f"{key.replace('_', ' ')} = {text}")
    return "\n".join(lines) + "\n", data


def npy(shape, numbers, kind="<f4", fortran=False, version=1):
    """A .npy file (NEP 1)."""
    letter = {"f4": "f", "f8": "d", "u1": "B", "u2": "H", "i2": "h", "i4": "i", "f2": "e", "i8": "q", "u8": "Q"}[kind[1:]]
    header = f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {tuple(shape)}, }}".encode()
    size = 10 if version == 1 else 12
    header += b" " * (-(size + len(header) + 1) % 64) + b"\n"
    start = b"\x93NUMPY" + bytes([version, 0]) + struct.pack("<H" if version == 1 else "<I", len(header))
    order = ">" if kind[0] == ">" else "<"
    return start + header + struct.pack(f"{order}{len(numbers)}{letter}", *numbers)


def _element(kind, payload):
    return struct.pack("<II", kind, len(payload)) + payload + b"\0" * (-len(payload) % 8)


def _array(array_class, dimensions, name, rest):
    return _element(14, _element(6, struct.pack("<II", array_class, 0))
                    + _element(5, struct.pack(f"<{len(dimensions)}i", *dimensions))
                    + _element(1, name.encode()) + rest)


def mat_numbers(name, dimensions, numbers):
    """A MATLAB double array; numbers in MATLAB's order, the first index fastest."""
    return _array(6, dimensions, name, _element(9, struct.pack(f"<{len(numbers)}d", *numbers)))


def mat_text(name, text):
    return _array(4, (1, len(text)), name, _element(4, struct.pack(f"<{len(text)}H", *text.encode("latin-1"))))


def mat_struct(name, fields):
    """A 1 x 1 struct of {name: a function that makes the field's array from a name}."""
    names = b"".join(field.encode().ljust(32, b"\0") for field in fields)
    length = struct.pack("<HHI", 5, 4, 32)  # a small element: type 5, four bytes
    return _array(2, (1, 1), name, length + _element(1, names) + b"".join(make("") for make in fields.values()))


def mat(*variables):
    """A MAT file of version 5 of such arrays."""
    return b"MATLAB 5.0 MAT-file, by hand".ljust(116, b" ") + bytes(8) + struct.pack("<H2s", 0x0100, b"IM") + b"".join(
        variables)
