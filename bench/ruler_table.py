#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed and errors of `petzval sfr` on what people photograph, beside the truth, and nine pictures of its own making. Figures of
MTF Mapper 0.7.38 on such pictures, from another day and machine, stand beside. `bench/ruler_table.py build/release/bin/petzval`"""

import csv
import itertools
import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np

from hard_photographs import true_mtf50

OPTICS = ["--f-number", 8, "--wavelength", 550, "--pixel-pitch", 4.73]


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = str(pathlib.Path(program).resolve()), folder

    def run(self, *words):
        return subprocess.run([self.program, *map(str, words), "--quiet"], cwd=self.folder, check=True, capture_output=True, text=True).stdout

    def target(self, name, polygons, size, *more):
        (self.folder / "polygons.txt").write_text("\n".join(polygons) + "\n")
        self.run("target", "--polygons", "polygons.txt", "--size", f"{size}x{size}", *OPTICS, "-o", name, *more)
        return np.load(self.folder / name).reshape(size, size)

    def edges(self, name, *more):
        """The measured edges, and the processor time that it took, all threads together [s]."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        edges = json.loads(self.run("sfr", name, "--json", *more))["edges"]
        return edges, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def errors(self, values, *more):
        np.save(self.folder / "photo.npy", values)
        edges, _ = self.edges("photo.npy", *more)
        return np.array([100 * (edge["mtf50_cpp"] / true_mtf50(edge["angle_deg"]) - 1) for edge in edges if edge["mtf50_cpp"]])


def square(x, y, side, angle_deg):
    c, s = (0.5 * side * f(math.radians(angle_deg)) for f in (math.cos, math.sin))
    return "4 " + " ".join(f"{a:.6f} {b:.6f}" for a, b in ((x - c + s, y - s - c), (x + c + s, y + s - c), (x + c - s, y + s + c), (x - c - s, y - s + c)))


def squares(across, side, pitch):
    return [square(pitch * (i % across + 0.5) + 0.13 * (i % 7), pitch * (i // across + 0.5) + 0.17 * (i % 5), side, 3 + i % 9)
            for i in range(across * across)]


def arc(radius):
    """What lies to the right of an arc that leaves an upright line, turned by 5 degrees, by 100 px / (8 R) of 100 px."""
    points = []
    for i in range(-60, 61):
        t = i * 1.2
        x, y = radius - math.sqrt(radius * radius - t * t), t
        c, s = math.cos(math.radians(5)), math.sin(math.radians(5))
        points.append((60.3 + c * x - s * y, 60.1 + s * x + c * y))
    points += [(400, 200), (400, -100)]
    return f"{len(points)} " + " ".join(f"{x:.7f} {y:.7f}" for x, y in points)


def nine(bench):
    worst = 0
    for angle, optics in itertools.product((3.3, 12.7, 33.1), (["--f-number", 4], ["--f-number", 8],
                                                              ["--f-number", 5.6, "--psf", "wavefront", "--w020", 0.6, "--w040", 0.5])):
        bench.run("target", "--rectangle", f"100x100@{angle}", *optics, "--wavelength", 550, "--pixel-pitch", 4.73, "-o", "nine.npy", "--exact-sfr", "nine.csv")
        truths = {}
        for row in csv.DictReader(open(bench.folder / "nine.csv")):
            truths.setdefault(row["edge"], {})[round(float(row["frequency_cpp"]), 2)] = abs(float(row["sfr"]))
        for edge in bench.edges("nine.npy")[0]:
            measured = {round(f, 2): value for f, value in zip(edge["frequencies_cpp"], edge["sfr"]) if 0.02 <= f <= 0.5}
            worst = max(worst, min(max(abs(value - truth[f]) for f, value in measured.items() if f in truth) for truth in truths.values()))
    return worst


def main(program):
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(program, pathlib.Path(name))
        print(f"{'what':<58} {'here':>24}   MTF Mapper 0.7.38")
        row = lambda what, here, there="": print(f"{what:<58} {here:>24}   {there}", flush=True)  # noqa: E731
        for across, there in ((3, "0.08 s"), (5, "0.09 s"), (7, "0.14 s"), (20, "")):
            bench.target("t.npy", squares(across, 40, 80), 80 * across)
            edges, seconds = bench.edges("t.npy")
            row(f"{len(edges)} edges of 40 px, processor time", f"{seconds:.2f} s", there)
        bench.run("image", "checkerboard:10", "--lens", "wide-22mm", "--f-number", 8, "--sensor", "1200x900@20", "-o", "board.npy")
        edges, seconds = bench.edges("board.npy")
        row("a board through wide-22mm, processor time", f"{seconds:.1f} s, {len(edges)} edges")
        for radius, there in ((4000, "0.340"), (1000, "0.335")):
            bench.target("arc.npy", [arc(radius)], 120)
            edges, _ = bench.edges("arc.npy", "--roi", "10,10,100,100")
            row(f"an edge of radius {radius} px, MTF50 (true 0.337)", f"{edges[0]['mtf50_cpp']:.4f}", there)
        flat = bench.target("flat.npy", [square(120, 120, 100, 5)], 240)
        y, x = np.indices(flat.shape)
        for fall, there in ((0.01, "1.1 %"), (0.05, "1.8 %"), (0.1, "2.3 %")):
            worst = max(np.abs(bench.errors(flat * (1 - fall * (x * math.cos(a) + y * math.sin(a)) / 100))).max() for a in (0, 1, 2.5, 4))
            row(f"light that falls by {100 * fall:g} % over 100 px, worst", f"{worst:.2f} %", there)
        many = bench.target("many.npy", squares(7, 60, 120), 840)
        random = np.random.default_rng(1)
        for snr, there in ((100, "0.7 %"), (50, "1.6 %"), (20, "3.8 %"), (10, "6.5 %")):
            errors = bench.errors(many + random.normal(0, 1 / snr, many.shape))
            row(f"SNR {snr}: scatter (bias), {len(errors)} edges of 60 px", f"{errors.std():.2f} % ({errors.mean():+.2f})", there)
        near = bench.target("near.npy", squares(8, 40, 80), 640)
        errors = bench.errors(near)
        row("40-px squares 80 px apart, worst, edges of 256", f"{np.abs(errors).max():.2f} %, {len(errors)}", "1.7 %, 256")
        errors = bench.errors(near + random.normal(0, 0.02, near.shape))
        row("the same at SNR 50", f"{np.abs(errors).max():.2f} %, {len(errors)}", "6.1 %")
        for angle in (15, 30):
            bench.run("target", "--rectangle", f"100x100@{angle}", *OPTICS, "-o", "iso.npy")
            edges, _ = bench.edges("iso.npy", "--method", "iso")
            row(f"--method iso at {angle} degrees (true {true_mtf50(angle):.3f})", f"{edges[0]['mtf50_cpp']:.4f}")
        row("nine pictures of our own making, worst SFR to Nyquist", f"{nine(bench):.1e}", "4.6e-3 to 9.3e-3")


if __name__ == "__main__":
    main(sys.argv[1])
