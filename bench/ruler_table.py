#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed and errors of `petzval sfr` on what people photograph, beside the truth, and nine pictures of its own making. MTF Mapper reads
the same pictures where its program is named; else its figures of another day and machine stand beside.
`bench/ruler_table.py build/release/bin/petzval [mtf_mapper]`"""

import csv
import itertools
import json
import math
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile

import numpy as np

from hard_photographs import true_mtf50, write_png

OPTICS = ["--f-number", 8, "--wavelength", 550, "--pixel-pitch", 4.73]


def processor_time():
    """Of all programs that have been run, the time that the system spent for them included [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


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
        return json.loads(self.run("sfr", name, "--json", *more))["edges"]

    def mtf50(self, picture, *more):
        """MTF50 [cycles/pixel] and angle [degrees] of every edge of a PNG, by the table that is printed, and the processor time [s]."""
        before = processor_time()
        table = self.run("sfr", picture, "--transfer", "linear", *more)
        seconds = processor_time() - before
        rows = [line.split() for line in table.splitlines()]
        return [(float(row[3]), float(row[2])) for row in rows if row and row[0].isdigit() and row[3][0].isdigit()], seconds


class MtfMapper:
    def __init__(self, program, folder):
        self.program, self.folder = str(pathlib.Path(program).resolve()), folder

    def mtf50(self, picture, *more):
        before = processor_time()
        values = self.folder / "edge_mtf_values.txt"
        values.write_text("")  # it stops where it finds no edge
        subprocess.run([self.program, picture, ".", "-q", *more], cwd=self.folder, check=False, stdout=subprocess.DEVNULL)
        seconds = processor_time() - before
        rows = [list(map(float, line.split())) for line in values.read_text().splitlines() if line[:1] not in "#"]
        # Beside the middle of an edge stands a corner near its end.
        return [(row[3], math.degrees(math.atan2(row[5] - row[2], row[4] - row[1]))) for row in rows], seconds


def errors(edges):
    """In per cent."""
    return np.array([100 * (mtf50 / true_mtf50(angle_deg) - 1) for mtf50, angle_deg in edges])


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
        for edge in bench.edges("nine.npy"):
            measured = {round(f, 2): value for f, value in zip(edge["frequencies_cpp"], edge["sfr"]) if 0.02 <= f <= 0.5}
            worst = max(worst, min(max(abs(value - truth[f]) for f, value in measured.items() if f in truth) for truth in truths.values()))
    return worst


def main(program, mapper=None):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bench = Bench(program, folder)
        mapper = MtfMapper(mapper, folder) if mapper else None
        print(f"{'what':<58} {'here':>24}   MTF Mapper" + ("" if mapper else " 0.7.38, another day"))
        row = lambda what, here, there="": print(f"{what:<58} {here:>24}   {there}", flush=True)  # noqa: E731

        def both(what, pictures, there, says, here=(), mapped=(), room=0.1, times=3):
            """A row of what is to be said of both measurements of pictures in linear light; of the quickest of so many times."""
            told = {bench: ([], []), mapper: ([], [])}
            for picture in pictures:
                write_png(folder / "photo.png", np.clip(room + (1 - 2 * room) * picture, 0, 1), 16, (b"gAMA", struct.pack(">I", 100000)))
                runs = {bench: [], mapper: []}
                for _ in range(times):  # in turn, so that a busy machine is one for both
                    runs[bench].append(bench.mtf50("photo.png", *here))
                    runs[mapper].append(mapper.mtf50("photo.png", *mapped) if mapper else ([], 0))
                for ruler, (edges, seconds) in told.items():
                    quickest = min(runs[ruler], key=lambda done: done[1])
                    edges += quickest[0]
                    seconds.append(quickest[1])
            row(what, says(told[bench][0], sum(told[bench][1])), says(told[mapper][0], sum(told[mapper][1])) if mapper else there)

        time = lambda edges, seconds: f"{seconds:.2f} s, {len(edges)}"  # noqa: E731
        worst = lambda edges, _: f"{np.abs(errors(edges)).max():.2f} %, {len(edges)}" if edges else "none"  # noqa: E731
        scatter = lambda edges, _: f"{errors(edges).std():.2f} % ({errors(edges).mean():+.2f}), {len(edges)}" if edges else "none"  # noqa: E731
        for across, there in ((3, "0.08 s"), (5, "0.09 s"), (7, "0.14 s"), (20, "")):
            both(f"{4 * across * across} edges of 40 px, processor time", [bench.target("t.npy", squares(across, 40, 80), 80 * across)], there, time)
        random = np.random.default_rng(1)
        noisy = lambda picture, snr, count=1: [picture + random.normal(0, 1 / snr, picture.shape) for _ in range(count)]  # noqa: E731
        both("100 edges at SNR 50, processor time", noisy(bench.target("t.npy", squares(5, 40, 80), 400), 50), "0.12 s", time, times=20)
        bench.run("image", "checkerboard:10", "--lens", "wide-22mm", "--f-number", 8, "--sensor", "1200x900@20", "-o", "board.npy")
        edges, seconds = bench.mtf50("board.npy")
        row("a board through wide-22mm, processor time", f"{seconds:.1f} s, {len(edges)} edges")
        for radius, there in ((4000, "0.340"), (1000, "0.335")):
            arced = bench.target("arc.npy", [arc(radius)], 120)[10:110, 10:110]
            both(f"an edge of radius {radius} px, MTF50 (true 0.337)", [arced], there, lambda edges, _: f"{edges[0][0]:.4f}" if edges else "none",
                 ("--roi", "0,0,100,100"), ("--single-roi",))
        flat = bench.target("flat.npy", [square(120, 120, 100, 5)], 240)
        y, x = np.indices(flat.shape)
        for fall, there in ((0.01, "1.1 %"), (0.05, "1.8 %"), (0.1, "2.3 %")):
            for a in (0, 1, 2.5, 4):
                fading = flat * (1 - fall * (x * math.cos(a) + y * math.sin(a)) / 100)
                both(f"light that falls by {100 * fall:g} % over 100 px towards {a} rad, worst", [fading / fading.max()], there, worst)
        many = bench.target("many.npy", squares(7, 60, 120), 840)
        for snr, room, there in ((100, 0.1, "0.7 %"), (50, 0.1, "1.6 %"), (20, 0.2, "3.8 %"), (10, 0.2, "6.5 %")):
            both(f"SNR {snr}: scatter (bias), edges of 60 px", noisy(many, snr, 8), there, scatter, room=room, times=1)
        near = bench.target("near.npy", squares(8, 40, 80), 640)
        both("40-px squares 80 px apart, worst, edges of 256", [near], "1.7 %, 256", worst)
        both("the same at SNR 50", noisy(near, 50), "6.1 %", worst)
        for angle in (15, 30):
            bench.run("target", "--rectangle", f"100x100@{angle}", *OPTICS, "-o", "iso.npy")
            edges = bench.edges("iso.npy", "--method", "iso")
            row(f"--method iso at {angle} degrees (true {true_mtf50(angle):.3f})", f"{edges[0]['mtf50_cpp']:.4f}")
        row("nine pictures of our own making, worst SFR to Nyquist", f"{nine(bench):.1e}", "4.6e-3 to 9.3e-3, another day")


if __name__ == "__main__":
    main(*sys.argv[1:])
