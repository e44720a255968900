# SPDX-License-Identifier: BSD-3-Clause
"""Scenes that are no scenes, and pictures that cannot be taken."""

import math
import os
import re
import unittest

from petzval_cli import ProgramTest
from sample_files import spectral_exr

SENSOR = "32x24@20"
LENS = ["--lens", "edmund-54852"]


def grey(row, column, band):
    return 0.01


class BadScene(ProgramTest):
    def refuse(self, scene, *words, options=(), output="out.png"):
        self.assert_refused("image", scene, *LENS, "--sensor", SENSOR, *options, "-o", output, words=words)

    def exr(self, value, columns=40, rows=30):
        self.write("scene.exr", spectral_exr(columns, rows, [500, 550, 600], value))
        return ["scene.exr"]

    def angle(self):
        return ["--scene-angle", "30", "--scene-distance", "0.25m"]

    def test_the_sample_itself_is_right(self):
        self.exr(grey)
        self.assert_succeeds("image", "scene.exr", *LENS, "--sensor", SENSOR, *self.angle(), "-o", "out.exr")
        self.assertIn("out.exr", self.contents())

    def test_not_a_number_in_a_scene(self):
        for bad in (float("nan"), float("inf"), float("-inf"), -1.0):
            self.exr(lambda row, column, band: bad if (row, column, band) == (7, 11, 1) else 0.01)
            self.refuse("scene.exr", "scene.exr", "7", "11", options=self.angle())

    def test_missing_file_and_unknown_name(self):
        self.refuse("nowhere.exr", "nowhere.exr")
        self.refuse("studioo", "studioo", "studio")

    def test_what_is_there_and_no_file(self):
        os.mkfifo(self.folder / "pipe.exr")
        self.refuse("pipe.exr", "pipe.exr", "is a pipe or a device")
        self.refuse("/dev/zero", "/dev/zero", "is a pipe or a device")
        (self.folder / "scenes").mkdir()
        self.refuse("scenes", "scenes", "is a folder")

    def test_options_that_would_do_nothing(self):
        self.refuse("wall", "--scene-depth", options=["--scene-depth", ""])
        self.assert_succeeds("optics", "build", "edmund-54852", "--wavelengths", "550", "--fields", "3", "-o", "t.h5")
        self.assert_refused("image", "wall", "--optics", "t.h5", "--sensor", SENSOR, "--glass-catalogue", "x.agf", "-o", "o.png",
                            words=["--glass-catalogue has no effect on a lens data table"])

    def test_truncated_exr(self):
        whole = spectral_exr(40, 30, [500, 550, 600], grey)
        for length in (0, 1, 4, 8, 50, 200, 400, 500, 900, len(whole) // 2, len(whole) - 1):
            self.write("cut.exr", whole[:length])
            self.refuse("cut.exr", "cut.exr", options=self.angle())

    def test_noise(self):
        self.write("noise.exr", b"\x76\x2f\x31\x01" + bytes(range(256)) * 8)
        self.refuse("noise.exr", "noise.exr")
        self.write("noise.mat", b"MATLAB 5.0 MAT-file" + b"\xff" * 2000)
        self.refuse("noise.mat", "noise.mat")
        self.write("empty.mat", b"")
        self.refuse("empty.mat", "empty.mat")

    def test_a_scene_too_small_says_by_how_many_degrees(self):
        # The frame is 0.64 mm wide, 6.15 mm behind a thin lens of 6 mm, and the scene 243.85 mm before it; 2 % beyond
        # count too. From the sensor, 250 mm away, that is 5.93 degrees; the scene has 2.
        self.exr(grey)
        done = self.petzval("image", "scene.exr", *LENS, "--sensor", SENSOR, "--scene-angle", "2", "--scene-distance",
                            "0.25m", "--supersample", 1, "-o", "out.png")
        self.assert_error(done, 2, "falls short by")
        short = re.search(r"falls short by ([\d.]+)° horizontally, ([\d.]+)° vertically", done.stderr)
        needed = 2 * math.degrees(math.atan(1.02 * 0.32 * 243.85 / 6.15 / 250))
        self.assertAlmostEqual(float(short[1]), needed - 2.0, delta=0.05)

    def test_impossible_options(self):
        self.exr(grey)
        for option in (["--scene-angle", "180"], ["--scene-angle", "0"], ["--scene-angle", "nan"],
                       ["--scene-distance", "-1m"], ["--scene-distance", "1"], ["--scene-luminance", "0"], ["--scene-luminance", "inf"]):
            self.refuse("scene.exr", options=option)

    def test_impossible_sensors(self):
        for sensor in ("0x24@20", "32x24@0", "32x24@-1", "32x24", "32x24@nan", "-32x24@20", "nosuch",
                       "99999999999x24@20", "2000000000x2000000000@1"):
            self.assert_refused("image", "wall", *LENS, f"--sensor={sensor}", "-o", "out.png")

    def test_bands_that_the_glasses_do_not_pass(self):
        self.refuse("wall", "nm", options=["--wavelengths", "100:10:150"])

    def test_outputs_are_checked_before_the_work(self):
        self.refuse("wall", "nonsense", output="out.nonsense")
        self.refuse("wall", "nowhere", output="nowhere/out.png")


class BadTable(ProgramTest):
    def test_files_that_are_no_tables(self):
        for name, content in (("empty.h5", b""), ("noise.h5", b"\x89HDF\r\n\x1a\n" + b"\xff" * 500),
                              ("text.h5", b"a table")):
            self.write(name, content)
            self.assert_refused("optics", "info", name, words=[name])
            self.assert_refused("image", "wall", "--optics", name, "--sensor", SENSOR, "-o", "out.png", words=[name])
        self.assert_refused("optics", "info", "nowhere.h5", words=["nowhere.h5"])

    def test_every_kind_of_truncation(self):
        self.assert_succeeds("optics", "build", "edmund-54852", "--wavelengths", "587.56", "--sensor", SENSOR,
                             "--fields", "3", "-o", "table.h5")
        whole = (self.folder / "table.h5").read_bytes()
        for tenth in range(10):
            self.write("cut.h5", whole[: len(whole) * tenth // 10])
            self.assert_refused("optics", "info", "cut.h5", words=["cut.h5"])

    def test_lens_and_table_together(self):
        self.assert_refused("image", "wall", "--sensor", SENSOR, "-o", "out.png")


if __name__ == "__main__":
    unittest.main()
