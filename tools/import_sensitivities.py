#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a spectrum file of a sensor's channels from a camera's spectral sensitivities as rawtoaces-data has them.

    tools/import_sensitivities.py CAMERA.json OUTPUT.csv

https://github.com/AcademySoftwareFoundation/rawtoaces-data (Apache-2.0) holds one JSON a camera: spectral_data, of
R, G and B by wavelength, relative, to the power of the light. Quanta of light carry a power of hc/wavelength, so that
electrons per photon go as sensitivity / wavelength; the greatest becomes 1. A sensor file takes the result by
{"set": "OUTPUT.csv", "spectrum": "red", "scale": 0.5}, scale the quantum efficiency at the peak, which these data do
not tell.
"""
import json
import pathlib
import sys

CHANNELS = {"R": "red", "G": "green", "B": "blue"}


def table_of(document, path):
    spectral = document["spectral_data"]
    names = spectral["index"]["main"]
    if sorted(names) != sorted(CHANNELS):
        sys.exit(f"{path}: channels {names}; R, G and B would be right")
    rows = sorted((float(nm), values) for nm, values in spectral["data"]["main"].items())
    if len(rows) < 2 or any(len(values) != len(names) for _, values in rows):
        sys.exit(f"{path}: two wavelengths or more, each with {len(names)} numbers, would be right")
    order = [names.index(letter) for letter in CHANNELS]
    table = [(nm, [max(0.0, values[i]) / nm for i in order]) for nm, values in rows]
    peak = max(max(values) for _, values in table)
    return [(nm, [value / peak for value in values]) for nm, values in table]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    path, output = sys.argv[1], pathlib.Path(sys.argv[2])
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    header = document["header"]
    camera = f"{header.get('manufacturer') or ''} {header.get('model') or ''}".strip()
    lines = [f"# name: {camera}, red, green and blue response",
             f"# source: rawtoaces-data ({header['license']}), {pathlib.Path(path).name}, measured by "
             f"{header.get('laboratory') or header['document_creator']}; divided by the wavelength",
             "# unit: relative response", "wavelength_nm,red,green,blue"]
    lines += [f"{nm:g}," + ",".join(f"{value:.5g}" for value in values) for nm, values in table_of(document, path)]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
