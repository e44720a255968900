#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""One lens at one field point, three ways to its MTF, in one plot.

`lens mtf` predicts it; `target` and `image` form a slanted edge through the lens, and `sfr` measures both pictures. Writes closed-loop.svg and
the tables behind it into the folder it is run in.

python3 closed_loop.py
"""

import json
import math
import os
import subprocess
import sys

PETZVAL = os.environ.get("PETZVAL_PROGRAM", "petzval")
LENS, FIELD_DEG, WAVELENGTH_NM, PITCH_UM = "us-2532751", 5, 550, 5
TILT_DEG = 2  # of the edge, whose normal then points nearly along the sagittal direction
FREQUENCIES_CPP = [k / 100 for k in range(2, 51)]


def petzval(*arguments):
    return subprocess.run([PETZVAL, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def photosite(cpp):
    """What a square pixel passes along the normal of the edge."""
    x, y = (math.pi * cpp * part(math.radians(TILT_DEG)) for part in (math.cos, math.sin))
    return math.sin(x) / x * math.sin(y) / y


def measured(picture, roi):
    edge, = json.loads(petzval("sfr", picture, "--roi", roi, "--json"))["edges"]
    by_frequency = {round(f, 2): value for f, value in zip(edge["frequencies_cpp"], edge["sfr"])}
    return [by_frequency[f] for f in FREQUENCIES_CPP]


# Predicted: the MTF of the lens, times that of the photosite.
cpmm = ",".join(f"{1e3 * f / PITCH_UM:g}" for f in FREQUENCIES_CPP)
rows = json.loads(petzval("lens", "mtf", LENS, "--fields", FIELD_DEG, "--wavelengths", WAVELENGTH_NM, "--frequencies", cpmm, "--as-psf", "--json"))["rows"]
predicted = [row["sagittal"] * photosite(f) for row, f in zip(rows, FREQUENCIES_CPP)]
with open("predicted.csv", "w") as file:
    file.write("frequency_cpp,sfr\n" + "".join(f"{f:.2f},{value:.8f}\n" for f, value in zip(FREQUENCIES_CPP, predicted)))

# A half-plane through the PSF of that field point.
petzval("target", "--half-plane", TILT_DEG, "--size", "160x160", "--psf", "lens", "--lens", LENS, "--field", FIELD_DEG,
        "--wavelength", WAVELENGTH_NM, "--pixel-pitch", PITCH_UM, "-o", "target.npy")
target = measured("target.npy", "0,0,160,160")
petzval("sfr", "target.npy", "--roi", "0,0,160,160", "--csv", "target.csv")

# A scene of an edge through the whole lens. The field point lies 2.396 mm above the middle: 479 of 530 rows.
petzval("image", f"slanted-edge:{TILT_DEG}", "--lens", LENS, "--focus", "design", "--sensor", f"120x1060@{PITCH_UM}",
        "--wavelengths", WAVELENGTH_NM, "--scene-size", "960x8480", "--supersample", 4, "--quiet", "-o", "image.exr")
roi = "36,13,76,74"
image = measured("image.exr", roi)
petzval("sfr", "image.exr", "--roi", roi, "--against", "predicted.csv", "--against", "target.csv", "--plot", "closed-loop.svg")

print("cycles/pixel  lens mtf    target     image")
for k in range(3, len(FREQUENCIES_CPP), 5):
    print(f"{FREQUENCIES_CPP[k]:12.2f} {predicted[k]:9.4f} {target[k]:9.4f} {image[k]:9.4f}")
for name, values in (("target", target), ("image", image)):
    worst = max(abs(a - b) for a, b in zip(values, predicted))
    print(f"{name}: within {worst:.4f} of lens mtf up to Nyquist")
    if worst > 0.01:
        sys.exit(f"{name} is farther from lens mtf than 0.01")
