# SPDX-License-Identifier: BSD-3-Clause
"""Files that the parts share: tables of spectra, NumPy arrays."""
import ast
import csv
import struct


def spectra_of(path):
    """Curves of a table by name; empty cells are left out."""
    rows = list(csv.reader(line for line in path.read_text().splitlines() if not line.startswith("#")))
    return {name: [(float(row[0]), float(row[k])) for row in rows[1:] if row[k]] for k, name in enumerate(rows[0]) if k}


def npy(path):
    """Rows of columns of bands of a NumPy file of floats."""
    data = path.read_bytes()
    length = struct.unpack("<H", data[8:10])[0]
    shape = ast.literal_eval(data[10 : 10 + length].decode())["shape"]
    rows, columns, bands = (*shape, 1)[:3]
    numbers = struct.unpack(f"<{rows * columns * bands}f", data[10 + length :])
    return [[numbers[(r * columns + c) * bands : (r * columns + c + 1) * bands] for c in range(columns)] for r in range(rows)]


def write_npy(path, rows, columns, value):
    """A NumPy file of one band that is the same everywhere."""
    head = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {columns}, 1), }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + struct.pack("<f", value) * (rows * columns))
