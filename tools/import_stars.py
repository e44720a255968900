#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes data/stars/bright-stars.csv from the star catalogue of d3-celestial (npm, BSD-3-Clause), which is an extract
of the Extended Hipparcos Compilation (Anderson & Francis 2012, VizieR V/137D).

Usage: tools/import_stars.py stars.6.json data/stars/bright-stars.csv
"""
import json
import sys

HEADER = """\
# Stars to magnitude 6: Hipparcos number, right ascension and declination (J2000, degrees), magnitude V, colour B - V.
# From the Extended Hipparcos Compilation (Anderson & Francis 2012, VizieR V/137D), by way of d3-celestial 0.7.35
# (BSD-3-Clause); made by tools/import_stars.py. Where no colour is known it is that of the Sun.
hip,ra_deg,dec_deg,v_mag,b_minus_v
"""
SUN_COLOUR = 0.65


def main():
    source, target = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        features = json.load(file)["features"]
    rows = []
    for feature in features:
        ra, dec = feature["geometry"]["coordinates"]
        colour = feature["properties"]["bv"]
        rows.append((float(feature["properties"]["mag"]), feature["id"], ra % 360, dec,
                     float(colour) if colour else SUN_COLOUR))
    rows.sort()
    with open(target, "w", encoding="utf-8") as file:
        file.write(HEADER)
        for mag, hip, ra, dec, colour in rows:
            file.write(f"{hip},{ra:.4f},{dec:.4f},{mag:.2f},{colour:.3f}\n")


if __name__ == "__main__":
    main()
