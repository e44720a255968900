#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Packs glass data of refractiveindex.info into the one catalogue file that Petzval reads.

    tools/pack_glass.py DATABASE data/glass/own -o data/glass/catalogue.pgc

Each tree given has one folder a catalogue and one YAML file a glass, as refractiveindex.info lays them out. The
file format is described in data/glass/README.md. Every number is kept as the decimal that the source prints, so
nothing is rounded on the way; the same input gives the same bytes.
"""
import argparse
import os
import pathlib
import re
import struct
import sys
import zlib
from decimal import Decimal

MAGIC = b"PZGLASS1"
STATUSES = ["", "preferred", "standard", "special"]
FORMULAS = {f"formula {number}": number for number in range(1, 10)}

# The polymer files are named after the substance and the first author of the measurement. Command-line names are
# SHORT-AUTHOR; SHORT alone means Sultanova et al. 2009, the one source that measured all four alike at 20 °C.
POLYMERS = {
    "(C5H8O2)n_-_poly(methyl_methacrylate)": "PMMA",
    "(C8H8)n_-_polystyrene": "PS",
    "(C16H14O3)n_-_polycarbonate": "PC",
    "ZeonexE48R": "E48R",
}
REFERENCE_POLYMER_AUTHOR = "Sultanova"


class Glass:
    """One glass; all numbers Decimal, wavelengths in nm."""

    def __init__(self):
        self.names = []  # full names, the proper one first
        self.formula = 0
        self.status = ""
        self.nd = self.vd = Decimal(0)  # as the maker states them, 0 where not
        self.coefficients = []
        self.range_nm = None
        self.n_table = []
        self.k_table = []


def note(text):
    print(f"pack_glass: {text}", file=sys.stderr)


def decimals(text):
    return [Decimal(word) for word in text.split()]


def data_items(text):
    """The entries under DATA: one dictionary each; a block of rows becomes a list of lists of Decimal."""
    items, rows, inside = [], None, False
    for line in text.splitlines():
        if not line.startswith(" "):
            inside, rows = line.rstrip() == "DATA:", None
            continue
        if not inside or not line.strip():
            continue
        match = re.fullmatch(r"(  - |    )(\w+): ?(.*)", line)
        if match:
            if match[1] == "  - ":
                items.append({})
            rows = [] if match[3] == "|" else None
            items[-1][match[2]] = match[3] if rows is None else rows
        elif rows is not None:
            rows.append(decimals(line))
        else:
            raise ValueError(f"cannot read {line!r}")
    return items


def table_of(rows, column, name):
    """(wavelength in nm, value) pairs; a row that repeats the one before it is left out."""
    table = []
    for row in rows:
        entry = (row[0] * 1000, row[column])
        if table and entry == table[-1]:
            note(f"{name}: repeated row at {row[0]} µm left out")
        else:
            table.append(entry)
    if any(b[0] <= a[0] for a, b in zip(table, table[1:])):
        raise ValueError("wavelengths do not increase")
    return table


def set_extinction(glass, table):
    if any(k < 0 for _, k in table):
        note(f"{glass.names[0]}: extinction below zero; its table is left out")
    else:
        glass.k_table = table


def names_of(catalogue, stem):
    prefix = catalogue.upper() + ":"
    if catalogue != "polymers":
        return [prefix + stem]
    substance, author = stem.split("__nk__")
    short = POLYMERS[substance]
    names = [f"{short}-{author.upper()}", stem] + ([short] if author == REFERENCE_POLYMER_AUTHOR else [])
    return [prefix + name for name in names]


def read_glass(path):
    glass = Glass()
    glass.names = names_of(path.parent.name, path.stem)
    text = path.read_text(encoding="utf-8")
    for item in data_items(text):
        if item["type"] in FORMULAS:
            glass.formula = FORMULAS[item["type"]]
            glass.coefficients = decimals(item["coefficients"])
            glass.range_nm = [1000 * end for end in decimals(item["wavelength_range"])]
        elif item["type"] == "tabulated nk":
            glass.n_table = table_of(item["data"], 1, glass.names[0])
            glass.range_nm = [glass.n_table[0][0], glass.n_table[-1][0]]
            set_extinction(glass, table_of(item["data"], 2, glass.names[0]))
        elif item["type"] == "tabulated k":
            set_extinction(glass, table_of(item["data"], 1, glass.names[0]))
        else:
            raise ValueError(f"unknown kind of data: {item['type']}")
    if glass.range_nm is None:
        raise ValueError("no index")
    for key, value in re.findall(r"^    (nd|Vd|glass_status): (\S+)$", text, re.MULTILINE):
        if key == "glass_status":
            glass.status = value
        else:
            setattr(glass, key.lower(), Decimal(value))
    return glass


def varint(value):
    """Unsigned LEB128."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def signed(value):
    """Zigzag: small magnitudes of either sign become small varints."""
    return varint(2 * value if value >= 0 else -2 * value - 1)


def mantissa(value, exponent):
    scaled = value.scaleb(-exponent)
    # Within these bounds one division by a power of ten gives the reader the double nearest to the decimal.
    if scaled != int(scaled) or abs(scaled) >= 2**53 or not -22 <= exponent <= 22:
        raise ValueError(f"{value} does not fit the format")
    return int(scaled)


def exponent_of(value):
    return value.normalize().as_tuple().exponent if value else 0


def number(value):
    exponent = exponent_of(value)
    return signed(mantissa(value, exponent)) + struct.pack("b", exponent)


def column(values):
    """One exponent for all, then the first mantissa and the differences."""
    exponent = min(exponent_of(value) for value in values)
    mantissas = [mantissa(value, exponent) for value in values]
    differences = [b - a for a, b in zip([0] + mantissas, mantissas)]
    return struct.pack("b", exponent) + b"".join(signed(d) for d in differences)


def table(rows):
    return varint(len(rows)) + (column([r[0] for r in rows]) + column([r[1] for r in rows]) if rows else b"")


def record(glass, name_number):
    out = varint(name_number) + bytes([glass.formula, STATUSES.index(glass.status)])
    out += b"".join(number(value) for value in [glass.nd, glass.vd, *glass.range_nm])
    out += varint(len(glass.coefficients)) + b"".join(number(value) for value in glass.coefficients)
    return out + table(glass.n_table) + table(glass.k_table)


def pack(glasses):
    glasses = sorted(glasses, key=lambda glass: glass.names[0].upper())
    names = sorted((name.upper(), name, i) for i, glass in enumerate(glasses) for name in glass.names)
    for before, after in zip(names, names[1:]):
        if before[0] == after[0]:
            raise ValueError(f"two glasses are called {after[1]}")
    number_of = {name: i for i, (_, name, _) in enumerate(names)}
    body = struct.pack("<II", len(glasses), len(names))
    for _, name, glass_number in names:
        text = name.encode("ascii")
        body += varint(len(text)) + text + varint(glass_number)
    for glass in glasses:
        try:
            data = record(glass, number_of[glass.names[0]])
        except ValueError as error:
            raise ValueError(f"{glass.names[0]}: {error}") from error
        body += varint(len(data)) + data
    return MAGIC + struct.pack("<I", zlib.crc32(body)) + body


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("trees", nargs="+", type=pathlib.Path, metavar="TREE", help="folder with a folder a catalogue")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    glasses = []
    for path in sorted(file for tree in arguments.trees for file in tree.glob("*/*.yml")):
        if path.stem.endswith("__about"):
            continue
        try:
            glasses.append(read_glass(path))
        except (ValueError, KeyError, ArithmeticError) as error:
            sys.exit(f"pack_glass: error: {path}: {error}")
    try:
        data = pack(glasses)
    except ValueError as error:
        sys.exit(f"pack_glass: error: {error}")
    aside = arguments.output.with_name(arguments.output.name + ".part")
    aside.write_bytes(data)
    os.replace(aside, arguments.output)
    note(f"{len(glasses)} glasses, {len(data)} bytes")


if __name__ == "__main__":
    main()
