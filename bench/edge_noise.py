#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bias and scatter of MTF50 under noise, and the errors over what `petzval sfr` states of them: 196 edges of 49 squares of 60
pixels, each turned by another angle, at three f-numbers. `bench/edge_noise.py build/release/bin/petzval`"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SIDE, PITCH, ACROSS = 60, 120, 7


def squares():
    lines = []
    for i in range(ACROSS * ACROSS):
        x, y = PITCH * (i % ACROSS + 0.5) + 0.13 * (i % 7), PITCH * (i // ACROSS + 0.5) + 0.17 * (i % 5)
        angle = math.radians(2 + 0.25 * i)
        c, s = 0.5 * SIDE * math.cos(angle), 0.5 * SIDE * math.sin(angle)
        corners = [(x - c + s, y - s - c), (x + c + s, y + s - c), (x + c - s, y + s + c), (x - c - s, y - s + c)]
        lines.append("4 " + " ".join(f"{a:.6f} {b:.6f}" for a, b in corners))
    return "\n".join(lines) + "\n"


def mtf50(rows):
    """Where a table's contrast passes one half, and between its rows on a straight line."""
    for (f0, a), (f1, b) in zip(rows, rows[1:]):
        if a >= 0.5 > b:
            return f0 + (f1 - f0) * (a - 0.5) / (a - b)
    return math.nan


def truths(path):
    """MTF50 by the angle against the nearer axis [degrees, to a hundredth]."""
    rows = {}
    for row in csv.DictReader(open(path)):
        angle = float(row["angle_deg"])
        rows.setdefault(round(angle - 90 * round(angle / 90), 2), []).append((float(row["frequency_cpp"]), float(row["sfr"])))
    return {angle: mtf50(table) for angle, table in rows.items()}


def main():
    petzval = str(pathlib.Path(sys.argv[1]).resolve())
    print(f"{'f/':>4} {'step/noise':>11} {'edges':>6} {'bias %':>8} {'scatter %':>10} {'error over stated':>18}")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "squares.txt").write_text(squares())
        size = ACROSS * PITCH
        for f_number in (4, 8, 16):
            for ratio in (None, 100, 50, 20, 10):
                subprocess.run([petzval, "target", "--polygons", "squares.txt", "--size", f"{size}x{size}", "--f-number", str(f_number),
                                "--wavelength", "550", "--pixel-pitch", "4.73", "--noise", str(1 / ratio if ratio else 0), "--seed",
                                str(ratio or 0), "-o", "s.npy", "--exact-sfr", "exact.csv"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
                out = subprocess.run([petzval, "sfr", "s.npy", "--json", "--quiet"], cwd=folder, check=True, capture_output=True, text=True)
                true = truths(folder / "exact.csv")
                errors, relative = [], []
                for edge in json.loads(out.stdout)["edges"]:
                    if edge["mtf50_cpp"] is None:
                        continue
                    nearest = true[min(true, key=lambda angle: abs(angle - edge["angle_deg"]))]
                    errors.append(edge["mtf50_cpp"] / nearest - 1)
                    relative.append(edge["mtf50_cpp"] - nearest)
                    relative[-1] /= edge["mtf50_deviation_cpp"]
                n = len(errors)
                bias = sum(errors) / n
                scatter = math.sqrt(sum((e - bias) ** 2 for e in errors) / n)
                over = math.sqrt(sum(r * r for r in relative) / n)
                print(f"{f_number:>4} {ratio or 'none':>11} {n:>6} {100 * bias:>8.3f} {100 * scatter:>10.3f} {over:>18.2f}", flush=True)


if __name__ == "__main__":
    main()
