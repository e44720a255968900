# SPDX-License-Identifier: BSD-3-Clause
"""Raw files in photographers' programs, those of them that are installed: dcraw, LibRaw's dcraw_emu, RawTherapee, darktable.

What undoes the lens is applied by darktable from 4.4 on, by its module "lens correction", and by RawTherapee from 5.11 on, if its profile
asks for it; older versions of both, LibRaw and dcraw do not look for it.
"""

import os
import re
import shutil
import subprocess
import sys
import unittest

import numpy as np
from petzval_cli import ProgramTest
from picture_files import read_png

SKIPPED = 77  # what ctest takes for it
PROGRAMS = [name for name in ("dcraw", "dcraw_emu", "rawtherapee-cli", "darktable-cli") if shutil.which(name)]
# The module with the parameters that it chooses for the file itself: all that the file says of the lens.
LENS_CORRECTION = """<?xml version="1.0" encoding="UTF-8"?>
<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description rdf:about=""
xmlns:darktable="http://darktable.sf.net/" darktable:xmp_version="5" darktable:raw_params="0" darktable:auto_presets_applied="0"
darktable:history_end="1"><darktable:history><rdf:Seq><rdf:li darktable:num="0" darktable:operation="lens" darktable:enabled="1"
darktable:modversion="10" darktable:params="" darktable:multi_name="" darktable:multi_priority="0" darktable:blendop_version="13"
darktable:blendop_params=""/></rdf:Seq></darktable:history></rdf:Description></rdf:RDF></x:xmpmeta>
"""


RAWTHERAPEE_PROFILE = """[LensProfile]
LcMode=metadata
UseDistortion=true
UseVignette=false
UseCA=false
"""
# The first version of each that applies opcodes.
STRAIGHTENING = {"darktable-cli": (4, 4), "rawtherapee-cli": (5, 11)}


def straightens(program):
    if program not in PROGRAMS:
        return False
    words = "--version" if program == "darktable-cli" else "-h"
    said = subprocess.run([program, words], capture_output=True, text=True).stdout
    version = re.search(r"(\d+)\.(\d+)", said)
    return version is not None and (int(version[1]), int(version[2])) >= STRAIGHTENING[program]


def ppm(data):
    head = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
    columns, rows = int(head[1]), int(head[2])
    return np.frombuffer(data, np.uint8, rows * columns * 3, head.end()).reshape(rows, columns, 3)


def discs(picture):
    """Centres of gravity (column, row) of the dark discs that do not touch the border, of 20 pixels or more."""
    darkness = picture.max() - picture.astype(float).mean(axis=2)
    darkness = np.maximum(darkness - darkness.max() / 2, 0)
    rows, columns = darkness.shape
    left, centres = darkness > 0, []
    for start in zip(*np.nonzero(left)):
        if not left[start]:
            continue
        left[start], todo, disc = False, [start], []
        while todo:
            row, column = todo.pop()
            disc.append((row, column))
            for near in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
                if 0 <= near[0] < rows and 0 <= near[1] < columns and left[near]:
                    left[near] = False
                    todo.append(near)
        places = np.array(disc)
        if len(places) < 20:  # a speck of noise
            continue
        if places.min() > 0 and places[:, 0].max() < rows - 1 and places[:, 1].max() < columns - 1:
            weights = darkness[places[:, 0], places[:, 1]]
            centres.append((weights @ places[:, ::-1]) / weights.sum())
    return np.array(centres)


def worst_off_a_line(centres):
    """The greatest distance [pixel] of a disc from the straight line fitted to its row or column; and how many lines there are."""
    middle = centres[np.argmin(np.linalg.norm(centres - centres.mean(axis=0), axis=1))]
    pitch = np.sort(np.linalg.norm(centres - middle, axis=1))[1]
    grid, todo = {(0, 0): middle}, [(0, 0)]
    while todo:
        at = todo.pop()
        for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            place, back = (at[0] + step[0], at[1] + step[1]), (at[0] - step[0], at[1] - step[1])
            guess = 2 * grid[at] - grid[back] if back in grid else grid[at] + pitch * np.array(step)
            away = np.linalg.norm(centres - guess, axis=1)
            if place not in grid and away.min() < 0.3 * pitch:
                grid[place] = centres[away.argmin()]
                todo.append(place)
    worst, lines = 0, 0
    for axis in (0, 1):
        for index in {place[axis] for place in grid}:
            line = np.array([point for place, point in grid.items() if place[axis] == index])
            if len(line) >= 8:
                across = np.linalg.svd(line - line.mean(axis=0))[2][1]
                worst, lines = max(worst, np.abs((line - line.mean(axis=0)) @ across).max()), lines + 1
    return worst, lines


class RawPrograms(ProgramTest):
    def run_program(self, *words):
        done = subprocess.run([str(word) for word in words], cwd=self.folder, capture_output=True, timeout=120,
                              env={**os.environ, "HOME": str(self.folder)})
        self.assertEqual(done.returncode, 0, f"{words}: {done.stderr[-400:]}")
        return done.stdout

    def developed(self, program, raw, *sidecar):
        output = self.folder / f"{program}.png"
        output.unlink(missing_ok=True)
        if program == "dcraw":
            return ppm(self.run_program(program, "-w", "-c", raw))
        if program == "dcraw_emu":
            self.run_program(program, "-w", "-Z", "libraw.ppm", raw)
            return ppm((self.folder / "libraw.ppm").read_bytes())
        if program == "rawtherapee-cli":
            profile = [word for name in sidecar for word in ("-p", name)]
            self.run_program(program, "-Y", "-n", "-b8", "-o", output, *profile, "-c", raw)
        else:
            self.run_program(program, raw, *sidecar, output, "--core", "--configdir", self.folder / "darktable", "--library",
                             ":memory:")
        return np.array(read_png(output), np.uint8)

    def test_mosaics_that_they_do_not_know_are_grey_without_stripes(self):
        """A white wall: neutral within 10 codes of 255, and even within 16 (noise; stripes are 100 and more)."""
        for sensor in ("quad-bayer-1280x960", "rgbw-1280x960", "rccb-1280x960"):
            self.assert_succeeds("image", "wall", "--lens", "edmund-54852", "--sensor", sensor, "--sensor-set", "columns=320",
                                 "--sensor-set", "rows=240", "--method", "none", "--wavelengths", "400:20:700", "--exposure-compensation",
                                 "-1", "--quiet", "-o", "wall.dng")
            for program in PROGRAMS:
                with self.subTest(sensor=sensor, program=program):
                    middle = self.developed(program, "wall.dng")[80:160, 110:210].astype(float)
                    self.assertLess(np.ptp(middle.mean(axis=(0, 1))), 10)
                    self.assertLess(middle.std(axis=(0, 1)).max(), 16)
                    self.assertGreater(middle.mean(), 60)

    @unittest.skipUnless(any(straightens(program) for program in STRAIGHTENING), "neither darktable from 4.4 nor RawTherapee from 5.11 on")
    def test_they_straighten_the_chart(self):
        """Discs in rows through a lens with 5 % of distortion, 640 x 480 pixels: rows are bent by more than 4 pixels as they fall on the
        sensor, and straight to half a pixel after the correction (the fit may be off by a fifth; RawTherapee was off by 0.64 at twice as
        many pixels). The same of a mosaic that they do not know."""
        (self.folder / "lens.xmp").write_text(LENS_CORRECTION)
        (self.folder / "lens.pp3").write_text(RAWTHERAPEE_PROFILE)
        for sensor in ("third-inch-1280x960", "rgbw-1280x960"):
            self.assert_succeeds("image", "dots", "--lens", "edmund-54852", "--sensor", sensor, "--sensor-set",
                                 "columns=640", "--sensor-set", "rows=480", "--sensor-set", "pitch_um=7.5", "--method", "none",
                                 "--wavelengths", "400:20:700", "--quiet", "-o", "dots.dng")
            for program in filter(straightens, STRAIGHTENING):
                with self.subTest(sensor=sensor, program=program):
                    bent, lines = worst_off_a_line(discs(self.developed(program, "dots.dng")))
                    self.assertGreater(bent, 4)
                    sidecar = "lens.xmp" if program == "darktable-cli" else "lens.pp3"
                    straight, as_many = worst_off_a_line(discs(self.developed(program, "dots.dng", sidecar)))
                    self.assertLess(straight, 0.5)
                    self.assertGreaterEqual(min(lines, as_many), 20)
                    print(f"{sensor}, {program}: off a straight line {bent:.2f} pixels, corrected {straight:.2f}")


if __name__ == "__main__":
    if not PROGRAMS:
        sys.exit(SKIPPED)
    unittest.main()
