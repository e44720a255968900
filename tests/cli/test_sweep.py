# SPDX-License-Identifier: BSD-3-Clause
"""petzval sweep: every point, its failures, and going on where it was ended."""

import csv
import json
import os
import signal
import subprocess
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest

IMAGE = ["sweep", "image", "checkerboard", "--lens", "edmund-54852", "--wavelengths", "550", "--sensor", "48x36@80"]


class Sweep(ProgramTest):
    def rows(self, folder="out"):
        with open(self.folder / folder / "sweep.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_numbers_are_those_of_the_command_by_itself(self):
        self.assert_succeeds("sweep", "lens", "distortion", "edmund-54852", "--fields", "2", "--wavelengths", "550",
                             "--vary", "surfaces[4].thickness_mm=0.4:0.6:0.1", "-o", "out")
        rows = self.rows()
        self.assertEqual([row["surfaces[4].thickness_mm"] for row in rows], ["0.4", "0.5", "0.6"])
        for row in rows:
            alone, = self.json_of("lens", "distortion", "edmund-54852", "--fields", "2", "--wavelengths", "550", "--set",
                                  f"surfaces[4].thickness_mm={row['surfaces[4].thickness_mm']}")["rows"]
            self.assertEqual(float(row["distortion_percent"]), alone["distortion_percent"])
            self.assertEqual(row["status"], "ok")

    def test_pictures_of_all_combinations_on_one_sheet(self):
        said = self.json_of(*IMAGE, "--vary", "f-number=2,4", "--vary", "surfaces[4].thickness_mm=0.5,0.6", "-o", "out")
        self.assertEqual((said["points"], said["failed"]), (4, 0))
        self.assertEqual([(row["f-number"], row["surfaces[4].thickness_mm"]) for row in said["rows"]],
                         [("2", "0.5"), ("2", "0.6"), ("4", "0.5"), ("4", "0.6")])
        # Two stops less light.
        bright, dark = said["rows"][0]["irradiance_max"], said["rows"][2]["irradiance_max"]
        self.assertAlmostEqual(bright / dark, 4, delta=0.5)
        files = {path.name for path in (self.folder / "out").iterdir()}
        self.assertLessEqual({"contact-sheet.png", "index.html", "sweep.csv", "sweep.json", "point-0003.png"}, files)
        self.assertFalse([name for name in files if name.endswith((".out", ".err"))])

    def test_lenses_side_by_side(self):
        said = self.json_of("sweep", "lens", "info", "--vary", "lens=edmund-54852,cooke-triplet", "-o", "out")
        self.assertEqual([row["lens"] for row in said["rows"]], ["edmund-54852", "cooke-triplet"])
        self.assertAlmostEqual(said["rows"][0]["efl_mm"], 6.0, delta=0.01)
        self.assertAlmostEqual(said["rows"][1]["efl_mm"], 50.0, delta=0.5)

    def test_a_failing_point_is_reported_and_the_rest_goes_on(self):
        done = self.petzval(*IMAGE, "--vary", "f-number=0.5,4", "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("f-number 0.5: ", done.stderr)
        rows = self.rows()
        self.assertEqual([row["status"] for row in rows], ["failed", "ok"])
        self.assertIn("0.5", rows[0]["error"])
        self.assert_error(self.petzval(*IMAGE, "--vary", "f-number=0.5", "-o", "none"), 1, "every point failed")

    def test_goes_on_where_it_was_ended(self):
        sweep = [*IMAGE, "--vary", "f-number=2,4", "-o", "out"]
        self.assert_succeeds(*sweep)
        first = self.folder / "out" / "point-0000.png"
        stamp, bytes_before = first.stat().st_mtime_ns, first.read_bytes()
        (self.folder / "out" / "point-0001.png").unlink()
        self.assert_succeeds(*sweep)
        self.assertEqual(first.stat().st_mtime_ns, stamp, "a finished point is not made again")
        self.assertTrue((self.folder / "out" / "point-0001.png").exists())
        # Another sweep into the same folder makes its own points.
        self.assert_succeeds(*IMAGE, "--vary", "f-number=8", "-o", "out")
        self.assertNotEqual(first.read_bytes(), bytes_before)

    def test_a_killed_sweep_goes_on(self):
        sweep = ["sweep", "lens", "psf", "edmund-54852", "--wavelengths", "550", "--vary", "fields=0:2.8:0.4", "-o", "out"]
        running = subprocess.Popen([PROGRAM, *sweep], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
        first = self.folder / "out" / "point-0000.json"
        while not first.exists() and running.poll() is None:
            time.sleep(0.005)
        os.killpg(running.pid, signal.SIGKILL)  # the point that is being made, too
        running.wait()
        self.assertFalse((self.folder / "out" / "sweep.csv").exists(), "it was killed before its end")
        stamp = first.stat().st_mtime_ns
        said = self.json_of(*sweep)
        self.assertEqual((said["points"], said["failed"]), (8, 0))
        self.assertEqual(first.stat().st_mtime_ns, stamp)
        self.assertFalse([path.name for path in (self.folder / "out").iterdir() if path.name.endswith((".out", ".err"))])

    def test_an_edited_lens_makes_its_points_anew(self):
        self.assert_succeeds("lens", "convert", "edmund-54852", "own.json")
        sweep = ["sweep", "lens", "info", "--vary", "lens=own.json,cooke-triplet", "-o", "out"]
        self.assert_succeeds(*sweep)
        self.assert_succeeds("lens", "convert", "double-gauss", "own.json")
        stamp = (self.folder / "out" / "point-0001.json").stat().st_mtime_ns
        said = self.json_of(*sweep)
        self.assertAlmostEqual(said["rows"][0]["efl_mm"], self.json_of("lens", "info", "double-gauss")["efl_mm"])
        self.assertEqual((self.folder / "out" / "point-0001.json").stat().st_mtime_ns, stamp)

    def test_lenses_and_sensors_side_by_side_and_entries_of_a_sensor(self):
        said = self.json_of("sweep", "image", "checkerboard", "--wavelengths", "550", "--vary",
                            "lens=edmund-54852,cooke-triplet", "--vary", "sensor=48x36@80,64x48@60", "-o", "out")
        self.assertEqual([(row["lens"], row["pitch_um"]) for row in said["rows"]],
                         [("edmund-54852", 80), ("edmund-54852", 60), ("cooke-triplet", 80), ("cooke-triplet", 60)])
        said = self.json_of(*IMAGE, "--vary", "sensor.pitch_um=40:80:20", "--vary", "sensor.columns=24,48", "-o", "of")
        self.assertEqual([(row["pitch_um"], row["columns"]) for row in said["rows"]],
                         [(p, c) for p in (40, 60, 80) for c in (24, 48)])
        self.assert_error(self.petzval(*IMAGE, "--vary", "sensor.pitch=3", "-o", "none"), 1, "pitch")

    def test_refuses_what_cannot_be_swept(self):
        self.assert_refused(*IMAGE, "--vary", "f-number", "-o", "out", words=["KEY=FROM:TO:STEP"])
        self.assert_refused(*IMAGE, "--vary", "f-number=2,,4", "-o", "out", words=["empty"])
        self.assert_refused(*IMAGE, "--vary", "f-number=2", "--vary", "f-number=4", "-o", "out", words=["twice"])
        self.assert_refused(*IMAGE, "--vary", "f-number=0:1e9:1", "-o", "out", words=["10000"])
        self.assert_refused("sweep", "lens", "nonsense", "x", "--vary", "lens=a,b", "-o", "out", words=["nonsense"])


if __name__ == "__main__":
    unittest.main()
