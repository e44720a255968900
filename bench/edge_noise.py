#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bias and scatter of MTF50 under noise, and the errors over what `petzval sfr` states of them: 196 edges of 49 squares of 60
pixels, each turned by another angle, through pupils with and without aberrations [waves]. `bench/edge_noise.py build/release/bin/petzval`"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SIDE, PITCH, ACROSS = 60, 120, 7
PUPILS = [(4,), (8,), (16,), (8, "--w020", 0.3), (4, "--w020", 0.5), (4, "--w040", 0.5), (8, "--w020", 1.5),
          (5.6, "--w020", 0.4), (11, "--w020", 0.8), (8, "--w020", 1), (5.6, "--w040", 0.3), (4, "--w040", 0.8), (8, "--w040", 1),
          (5.6,), (11,), (5.6, "--w020", 0.6), (8, "--w020", 1.2), (5.6, "--w020", 2), (16, "--w020", 0.5), (5.6, "--w040", 0.7),
          (8, "--w040", 0.5), (11, "--w040", 0.4), (4, "--w020", 1, "--w040", -0.8), (8, "--w020", -0.5, "--w040", 0.7)]


def squares():
    lines = []
    for i in range(ACROSS * ACROSS):
        x, y = PITCH * (i % ACROSS + 0.5) + 0.13 * (i % 7), PITCH * (i // ACROSS + 0.5) + 0.17 * (i % 5)
        angle = math.radians(2 + 0.25 * i)
        c, s = 0.5 * SIDE * math.cos(angle), 0.5 * SIDE * math.sin(angle)
        corners = [(x - c + s, y - s - c), (x + c + s, y + s - c), (x + c - s, y + s + c), (x - c - s, y - s + c)]
        lines.append("4 " + " ".join(f"{a:.6f} {b:.6f}" for a, b in corners))
    return "\n".join(lines) + "\n"


def cubic(rows, f):
    """At a frequency, of the polynomial through four rows (Lagrange's form)."""
    return sum(value * math.prod((f - other) / (at - other) for other, _ in rows if other != at) for at, value in rows)


def mtf50(rows):
    """Where a table's contrast passes one half for the first time; on a straight line an error of 2e-4 would be left."""
    for i, ((f0, a), (f1, b)) in enumerate(zip(rows, rows[1:])):
        if a >= 0.5 > b:
            about = rows[max(0, i - 1):max(0, i - 1) + 4]
            for _ in range(40):
                middle = (f0 + f1) / 2
                f0, f1 = (middle, f1) if cubic(about, middle) >= 0.5 else (f0, middle)
            return f0
    return math.nan


def truths(path):
    """MTF50 by the angle against the nearer axis [degrees, to a hundredth]."""
    rows = {}
    for row in csv.DictReader(open(path)):
        angle = float(row["angle_deg"])
        rows.setdefault(round(angle - 90 * round(angle / 90), 2), []).append((float(row["frequency_cpp"]), float(row["sfr"])))
    return {angle: mtf50(table) for angle, table in rows.items()}


def measured(petzval, folder, f_number, aberration, ratio):
    """Of each edge of the chart: the error of MTF50 over the truth, and over the deviation that is stated.
    `aberration`: options of `petzval target`; `ratio`: the step of an edge over the noise, or None."""
    (folder / "squares.txt").write_text(squares())
    size = ACROSS * PITCH
    wavefront = ["--psf", "wavefront", *map(str, aberration)] if aberration else []
    subprocess.run([petzval, "target", "--polygons", "squares.txt", "--size", f"{size}x{size}", "--f-number", str(f_number), *wavefront,
                    "--wavelength", "550", "--pixel-pitch", "4.73", "--noise", str(1 / ratio if ratio else 0), "--seed",
                    str(ratio or 0), "-o", "s.npy", "--exact-sfr", "exact.csv"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    out = subprocess.run([petzval, "sfr", "s.npy", "--json", "--quiet"], cwd=folder, check=True, capture_output=True, text=True)
    true = truths(folder / "exact.csv")
    errors, over_stated = [], []
    for edge in json.loads(out.stdout)["edges"]:
        if edge["mtf50_cpp"] is None:
            continue
        nearest = true[min(true, key=lambda angle: abs(angle - edge["angle_deg"]))]
        errors.append(edge["mtf50_cpp"] / nearest - 1)
        over_stated.append((edge["mtf50_cpp"] - nearest) / edge["mtf50_deviation_cpp"])
    return errors, over_stated


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values))


def main():
    petzval = str(pathlib.Path(sys.argv[1]).resolve())
    print(f"{'f/':>4} {'aberration':>26} {'step/noise':>11} {'edges':>6} {'bias %':>8} {'scatter %':>10} {'error over stated':>18}")
    with tempfile.TemporaryDirectory() as folder:
        for f_number, *aberration in PUPILS:
            for ratio in (None, 5000, 1000, 100, 50, 20, 10):
                errors, over_stated = measured(petzval, pathlib.Path(folder), f_number, aberration, ratio)
                n = len(errors)
                bias = sum(errors) / n
                scatter = rms([error - bias for error in errors])
                print(f"{f_number:>4} {' '.join(map(str, aberration)):>26} {ratio or 'none':>11} {n:>6} {100 * bias:>8.3f} "
                      f"{100 * scatter:>10.3f} {rms(over_stated):>18.2f}", flush=True)


if __name__ == "__main__":
    main()
