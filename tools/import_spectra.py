#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes data/spectra/*.csv from a folder of public spectral tables.

    tools/import_spectra.py FOLDER [OUTPUT]

FOLDER holds the tables as ISETCam distributes them, one CSV each: a comment line, a line of column names
(wavelength_nm, v1, v2, ...), then numbers. The figures are taken over digit by digit; names, units, sources and
the order of columns are those below. The format written: `# name:`, `# source:` and `# unit:` lines, one line of
column names starting with wavelength_nm, then one line a wavelength.
"""
import pathlib
import sys

COLORCHECKER = [  # row by row from the top left, as the chart is held
    "dark skin", "light skin", "blue sky", "foliage", "blue flower", "bluish green",
    "orange", "purplish blue", "moderate red", "purple", "yellow green", "orange yellow",
    "blue", "green", "red", "yellow", "magenta", "cyan",
    "white", "neutral 8", "neutral 6.5", "neutral 5", "neutral 3.5", "black"]

# The source table runs down the columns of the 4 x 6 chart: its column 4 c + r is the patch in row r, column c.
# tests/colour/colorchecker.cpp holds the result against the published colours of the chart.
COLORCHECKER_ORDER = [4 * (patch % 6) + patch // 6 for patch in range(24)]

# The source table of the daylight components goes from 380 to 780 nm; CIE 15 tabulates them from 300 to 830, every 10 nm,
# and lets them run straight in between. tests/colour/illuminants.cpp holds the ends against tables of D50 and D65.
DAYLIGHT_ENDS = {
    300: (0.04, 0.02, 0.0), 310: (6.0, 4.5, 2.0), 320: (29.6, 22.4, 4.0), 330: (55.3, 42.0, 8.5), 340: (57.3, 40.6, 7.8),
    350: (61.8, 41.6, 6.7), 360: (61.5, 38.0, 5.3), 370: (68.8, 42.4, 6.1), 380: (63.4, 38.5, 3.0),
    780: (65.0, -10.4, 6.8), 790: (66.0, -10.6, 7.0), 800: (61.0, -9.7, 6.4), 810: (53.3, -8.3, 5.5),
    820: (58.9, -9.3, 6.1), 830: (61.9, -9.8, 6.5)}

RELATIVE = "relative spectral power"
# output: (input, name, source, unit, columns, order of the input's columns)
TABLES = {
    "cie_1931_xyz": (
        "cie_1931_xyz", "CIE 1931 2-degree standard observer",
        "CIE 15 (colour-matching functions), 370 to 730 nm, as distributed with ISETCam (MIT), XYZEnergy", "1",
        ["x_bar", "y_bar", "z_bar"], None),
    "daylight_basis": (
        "cie_daylight_basis", "CIE daylight: mean and two components",
        "CIE 15 (components S0, S1, S2 of the D illuminants); 380 to 780 nm as distributed with ISETCam (MIT), cieDaylightBasis",
        RELATIVE, ["s0", "s1", "s2"], None),
    "illuminant_a": (
        "illuminant_a", "CIE standard illuminant A (tungsten, 2856 K)",
        "CIE 15, as distributed with ISETCam (MIT), illuminantA", RELATIVE, ["power"], None),
    "illuminant_d50": (
        "illuminant_d50", "daylight of 5000 K (CIE D50 is 5003 K)", "ISETCam (MIT), D50", RELATIVE,
        ["power"], None),
    "illuminant_d65": (
        "illuminant_d65", "daylight of 6500 K (CIE D65 is 6504 K)", "ISETCam (MIT), D65", RELATIVE,
        ["power"], None),
    "illuminant_f11": (
        "illuminant_f11", "CIE illuminant F11 (three-band fluorescent), every 10 nm",
        "CIE 15, as distributed with ISETCam (MIT), Fluorescent11", RELATIVE, ["power"], None),
    "colorchecker_reflectance": (
        "macbeth_24_reflectance", "ColorChecker, 24 patches, row by row from the top left",
        "measurement of one chart, as distributed with ISETCam (MIT), macbethChart", "reflectance", COLORCHECKER,
        COLORCHECKER_ORDER),
    "nikon_d100": (
        "sensor_nikon_d100", "Nikon D100, red, green and blue response",
        "ISETCam (MIT), NikonD100", "relative response", ["red", "green", "blue"], None),
    "ar0132at": (
        "sensor_ar0132at", "AR0132AT sensor, red, green and blue response",
        "read off the maker's data sheet, as distributed with ISETCam (MIT), ar0132atRGB", "relative response",
        ["red", "green", "blue"], None),
    "ir_cut": (
        "ir_cut_filter", "infrared cut filter of a mobile-phone lens (Largan K098-BIR690UV)",
        "ISETCam (MIT), ircf_public", "transmittance", ["transmittance"], None),
}


def read_rows(path):
    """The number fields of a source table, as text, without comment and column names."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines if line and not line.startswith(("#", "wavelength_nm"))]


def with_daylight_ends(rows):
    """The rows, and those of DAYLIGHT_ENDS outside of them every 5 nm."""
    first, last = int(rows[0][0]), int(rows[-1][0])
    for end in (first, last):
        fields, = (row for row in rows if int(row[0]) == end)
        if tuple(map(float, fields[1:])) != DAYLIGHT_ENDS[end]:
            raise SystemExit(f"the daylight components at {end} nm are not those of CIE 15")

    def row(nm):
        known = [DAYLIGHT_ENDS[nm]] if nm in DAYLIGHT_ENDS else [DAYLIGHT_ENDS[nm - 5], DAYLIGHT_ENDS[nm + 5]]
        return [str(nm)] + [f"{sum(values) / len(known):.6g}" for values in zip(*known)]

    return [row(nm) for nm in range(300, first, 5)] + rows + [row(nm) for nm in range(last + 5, 835, 5)]


def converted(folder, table):
    source_file, name, source, unit, columns, order = table
    order = order or range(len(columns))
    lines = [f"# name: {name}", f"# source: {source}", f"# unit: {unit}", ",".join(["wavelength_nm"] + columns)]
    rows = read_rows(folder / f"{source_file}.csv")
    for fields in with_daylight_ends(rows) if source_file == "cie_daylight_basis" else rows:
        if len(fields) != len(columns) + 1:
            raise SystemExit(f"{source_file}.csv: {len(fields)} fields in a line, not {len(columns) + 1}")
        lines.append(",".join([fields[0]] + [fields[1 + column] for column in order]))
    return "\n".join(lines) + "\n"


def main(arguments):
    if len(arguments) not in (1, 2):
        raise SystemExit(__doc__)
    output = pathlib.Path(arguments[1]) if len(arguments) == 2 else (
        pathlib.Path(__file__).resolve().parent.parent / "data" / "spectra")
    for name, table in TABLES.items():
        (output / f"{name}.csv").write_text(converted(pathlib.Path(arguments[0]), table), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
