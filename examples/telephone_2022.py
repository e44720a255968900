#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A telephone's lens known only by its ray transfer, against what its design program and its measurements say.

    examples/telephone_2022.py FOLDER [PETZVAL]

FOLDER holds the files of Lyu, Goossens, Wandell and Farrell, "Accurate smartphone camera simulation using 3D scenes"
(2022), from their repository isetcornellbox: pixel4a-rearcamera-ellipse-raytransfer.json, RI.txt, GeometricMTF.txt.
They are not part of Petzval. Prints relative illumination beside the design's, geometric MTF beside the design's at
its six fields, and the MTF of slanted edges at two focus distances and two depths beside the measured telephone's and
the published simulation's. Measured numbers are facts, read off the published figures 5 and 7 to about 0.005.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

PITCH_MM = 0.0014  # IMX363
FILM_MM = 0.465 - 0.464135918  # behind the input plane, as the authors set it
# The file's ellipses are those of f/3.4; its design program states an effective f/1.83 on the axis. Opened so far:
OPENED_MM = 0.3802392 * 3.4412 / 1.8308

ILLUMINATION = {0.5: 0.952, 1: 0.840, 1.5: 0.711, 2: 0.586, 2.5: 0.472, 3: 0.387, 3.5: 0.302}

# Focus [m], edge [m], field height [mm]: frequency [1/mm] -> (measured, published simulation).
EDGES = {
    (0.5, 0.5, 0.8): {25: (0.919, 0.955), 50: (0.777, 0.835), 75: (0.609, 0.658), 100: (0.451, 0.466),
                      125: (0.335, 0.292), 150: (0.226, 0.144), 175: (0.148, 0.065), 200: (0.103, 0.064)},
    (0.5, 0.3, 0.7): {25: (0.744, 0.818), 50: (0.394, 0.433), 75: (0.131, 0.100), 100: (0.062, 0.089)},
    (0.3, 0.3, 0.7): {25: (0.826, 0.911), 50: (0.618, 0.695), 75: (0.441, 0.430), 100: (0.250, 0.202),
                      125: (0.138, 0.095), 150: (0.090, 0.078)},
    (0.3, 0.5, 0.8): {25: (0.671, 0.744), 50: (0.203, 0.267), 75: (0.025, 0.042)},
}


class Telephone:
    def __init__(self, folder, petzval):
        self.lens = str(folder / "pixel4a-rearcamera-ellipse-raytransfer.json")
        self.petzval = petzval

    def ask(self, command, *options):
        run = [self.petzval, "lens", command, self.lens, "--quiet", "--json", *options]
        return json.loads(subprocess.run(run, check=True, capture_output=True, text=True).stdout)

    def illumination(self, heights):
        fields = ",".join(f"{h:g}" for h in heights)
        rows = self.ask("illumination", "--field-type", "real_image_height_mm", "--fields", fields,
                        "--set", f"surfaces[1].thickness_mm={FILM_MM}")["rows"]
        return [row["relative_illumination"] for row in rows]

    def mtf(self, heights, frequencies, *options):
        """(tangential, sagittal) by height and frequency, of the rays alone."""
        rows = self.ask("mtf", "--geometric", "--field-type", "real_image_height_mm",
                        "--fields", ",".join(f"{h:g}" for h in heights),
                        "--frequencies", ",".join(f"{f:g}" for f in frequencies), *options)["rows"]
        return {(row["field"], row["frequency_cpmm"]): (row["tangential"], row["sagittal"]) for row in rows}

    def film_mm(self, focus_m):
        """Behind the rear plane, for an object this far from the film."""
        info = self.ask("info", "--focus", f"{focus_m}m")
        return info["paraxial_image_mm"]


def zemax_illumination(path):
    for line in path.read_text(encoding="latin-1").splitlines():
        words = line.split()
        if len(words) == 3 and words[0][0].isdigit() and all("." in word for word in words):
            yield float(words[0]), float(words[1])


def zemax_mtf(path):
    height, curves = None, {}
    for line in path.read_text(encoding="latin-1").splitlines():
        words = line.split()
        if line.startswith("Field:"):
            height = float(words[1])
        elif height is not None and len(words) == 3 and words[0][0].isdigit():
            curves[height, float(words[0])] = float(words[1]), float(words[2])
    return curves


def print_illumination(phone, folder):
    rows = [row for row in zemax_illumination(folder / "RI.txt")]
    ours = phone.illumination([height for height, _ in rows])
    worst = max(abs(a - b) for a, (_, b) in zip(ours, rows))
    print("relative illumination    height [mm]  ours    design")
    for (height, design), mine in list(zip(rows, ours))[::4]:
        print(f"                         {height:11.3f}  {mine:.4f}  {design:.4f}")
    print(f"  largest difference over {len(rows)} heights: {worst:.4f}")
    print("  against the telephone: design * sensor = measured, so the sensor at its angles lets through")
    for height, measured in ILLUMINATION.items():
        design = min(rows, key=lambda row: abs(row[0] - height))[1]
        print(f"                         {height:11.2f}  measured {measured:.3f} / design {design:.3f} = "
              f"{measured / design:.3f}")


def print_geometric_mtf(phone, folder):
    design = zemax_mtf(folder / "GeometricMTF.txt")
    heights = sorted({height for height, _ in design})
    frequencies = list(range(25, 201, 25))
    best = None
    # The exit distance of the design's film is not in the file: the one at which the axis agrees best.
    for film_um in range(-4, 25):
        option = ["--set", f"surfaces[1].thickness_mm={film_um / 1000 + 1e-9}"]
        axis = phone.mtf([0], frequencies, *option)
        worst = max(abs(axis[0, f][0] - design[0, f][0]) for f in frequencies)
        if best is None or worst < best[0]:
            best = worst, film_um, option
    ours = phone.mtf(heights, frequencies, *best[2])
    print(f"geometric MTF to 200/mm, film {best[1]} um behind the input plane: largest difference from the design's")
    for height in heights:
        for name, which in ("tangential", 0), ("sagittal", 1):
            off = [abs(ours[height, f][which] - design[height, f][which]) for f in frequencies if (height, f) in ours]
            if off:
                print(f"                         {height:11.3f}  {name:10}  {max(off):.3f}")


def pixel(frequency):
    x = math.pi * frequency * PITCH_MM
    return math.sin(x) / x


def edge_difference(phone, focus_m, edge_m, height, points, options):
    film = phone.film_mm(focus_m)
    object_mm = edge_m * 1000 - film - 6.77
    ours = phone.mtf([height], points, "--set", f"object_distance_mm={object_mm:.6f}",
                     "--set", f"surfaces[1].thickness_mm={film:.9f}", *options)
    return sum(abs(sum(ours[height, f]) / 2 * pixel(f) - points[f][0]) for f in points) / len(points)


def print_edges(phone):
    opened = ["--set", f"surfaces[0].semi_diameter_mm={OPENED_MM:.6f}",
              "--set", f"aperture.stop_semi_diameter_mm={OPENED_MM:.6f}"]
    print("MTF of slanted edges: mean absolute difference from the telephone (rays and pixel, in the paraxial focus)")
    for (focus_m, edge_m, height), points in EDGES.items():
        stopped, wide = (edge_difference(phone, focus_m, edge_m, height, points, o) for o in ([], opened))
        published = sum(abs(s - m) for m, s in points.values()) / len(points)
        print(f"  focus {focus_m} m, edge {edge_m} m  as filed, f/3.4: {stopped:.3f}  opened to f/1.83: {wide:.3f}  "
              f"published simulation: {published:.3f}")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    phone = Telephone(folder, sys.argv[2] if len(sys.argv) == 3 else "petzval")
    print_illumination(phone, folder)
    print_geometric_mtf(phone, folder)
    print_edges(phone)


if __name__ == "__main__":
    main()
