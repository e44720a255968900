# SPDX-License-Identifier: BSD-3-Clause
"""petzval sweep: every point, its failures, and going on where it was ended."""

import csv
import json
import math
import os
import re
import signal
import subprocess
import time
import unittest

import picture_files
from petzval_cli import PROGRAM, ProgramTest

IMAGE = ["sweep", "image", "checkerboard", "--lens", "edmund-54852", "--wavelengths", "550", "--sensor", "48x36@80"]


class Sweep(ProgramTest):
    def rows(self, folder="out"):
        with open(self.folder / folder / "sweep.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_numbers_are_those_of_the_command_by_itself(self):
        self.assert_succeeds("sweep", "lens", "distortion", "edmund-54852", "--fields", "2", "--wavelengths", "550",
                             "--vary", "surfaces[4].thickness_mm=0.4:0.1:0.6", "-o", "out")
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
                         [(2, 0.5), (2, 0.6), (4, 0.5), (4, 0.6)])
        self.assertEqual([type(row["f-number"]) for row in said["rows"]], [int] * 4, "numbers are numbers, as they were written")
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

    def test_yield_in_the_picture(self):
        # A sensor turned about y: one side is sharper, and turned the other way the other side.
        self.assert_succeeds("lens", "scale", "cooke-triplet", "--factor", "0.2", "-o", "small.json", "--quiet")
        board = ["sweep", "image", "slanted-board:6", "--lens", "small.json", "--sensor", "icx625-mono", "--sensor-set",
                 "columns=200", "--sensor-set", "rows=150", "--wavelengths", "550", "--focus", "design", "--vary",
                 "sensor_pose.tilt_y_deg=-4,0,4", "--corners", "-o", "out"]
        said = self.json_of(*board, "--accept", "corners.symmetry>=0.9", "--accept", "corners.least_cpp>=0.01")
        corners = [{key.split(".")[1]: row[key] for key in row if key.startswith("corners.")} for row in said["rows"]]
        left, middle, right = ((each["top_left_cpp"], each["top_right_cpp"]) for each in corners)
        for one, other in zip(left, reversed(right)):
            self.assertAlmostEqual(one / other, 1, delta=0.05)
        self.assertGreater(abs(math.log(left[0] / left[1])), 0.2)
        self.assertAlmostEqual(middle[0] / middle[1], 1, delta=0.05)
        self.assertEqual(said["good"], [False, True, False])
        self.assertAlmostEqual(said["yield"], 1 / 3)
        low, high = said["yield_interval_95"]
        # One of three: 1 - (1 - p)^3 = 0.025, and the same from above.
        self.assertAlmostEqual(low, 1 - 0.975 ** (1 / 3), places=6)
        self.assertAlmostEqual(high ** 3 + 3 * high ** 2 * (1 - high), 0.975, places=6)
        text = self.assert_succeeds("sweep", "lens", "info", "cooke-triplet", "--vary", "f-number=5,8,11", "-o", "info", "--accept", "f_number<=6")
        self.assertIn("yield: 1 of 3, 33.3 % (95 % interval", text)
        # What is refused after the first point leaves the sweep before as it was.
        before = {path.name: path.read_bytes() for path in (self.folder / "info").iterdir()}
        again = ("sweep", "lens", "info", "cooke-triplet", "--vary", "f-number=11,8", "-o", "info")
        self.assert_refused(*again, "--accept", "number>=6", words=("f_number",))
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "info").iterdir()}, before)
        self.assert_succeeds(*again, "--accept", "f_number>=6")
        self.assertEqual({path.name for path in (self.folder / "info").iterdir()}, set(before) - {"point-0002.json"})
        other = ("sweep", "lens", "info", "cooke-triplet", "--vary", "f-number=5,8", "-o", "other")
        self.assert_refused(*other, "--accept", "f_number=6", words=("COLUMN>=VALUE",))
        # In a folder without an older sweep the point stays, and is not made again.
        self.assert_error(self.petzval(*other, "--accept", "number>=6"), 1, "f_number", "is kept")
        made = self.folder / "other" / "point-0000.json"
        stamp = made.stat().st_mtime_ns
        self.assert_refused(*other, "--accept", "numbers>=6", code=1, words=("f_number", "is kept"))
        self.assert_succeeds(*other, "--accept", "f_number>=6")
        self.assertEqual(made.stat().st_mtime_ns, stamp)
        # Of corners it is known before.
        self.assert_refused(*board, "--accept", "corners.symetry>=0.9", words=("corners.symmetry",))
        self.assert_refused(*[word for word in board[:-1] if word != "--corners"], "unmade", "--accept", "corners.symmetry>=0.9", words=("--corners",))
        self.assertFalse((self.folder / "unmade").exists())

    def test_a_plot_of_what_was_measured(self):
        self.assert_succeeds("sweep", "lens", "spots", "cooke-triplet", "--fields", "0,14", "--wavelengths", "550", "--vary",
                             "f-number=5,8", "--vary", "focus=1m,2m,4m", "-o", "out", "--plot", "spots.svg")
        plot = (self.folder / "spots.svg").read_text()
        self.assertIn("f-number", plot)
        self.assertIn("rms radius [µm]", plot)
        for focus in ("1m", "2m", "4m"):
            for field in (0, 14):
                self.assertIn(f"focus {focus}, field {field}", plot)
        self.assertIn("Plot", (self.folder / "out" / "index.html").read_text())
        dark = ["sweep", "image", "wall", "--lens", "dgauss-50mm", "--sensor", "third-inch-1280x960", "--sensor-set", "columns=16",
                "--sensor-set", "rows=12", "--wavelengths", "450,550,650", "--vary", "exposure=1ms,2ms", "-o", "dark"]
        self.assert_succeeds(*dark, "--plot", "light.svg", "--plot-of", "levels.green.mean_e,levels.red.mean_e")
        first, second = self.rows("dark")
        self.assertAlmostEqual(float(second["levels.green.mean_e"]) / float(first["levels.green.mean_e"]), 2, delta=0.02)
        self.assertIn("exposure [ms]", (self.folder / "light.svg").read_text())
        lens = ["sweep", "lens", "info", "cooke-triplet", "-o", "no", "--vary"]
        self.assert_refused(*lens, "lens=tessar,telephoto-250mm", "--plot", "x.svg", words=["lens"])
        self.assert_refused("sweep", "lens", "info", "-o", "no", "--vary", "lens=tessar,telephoto-250mm", "--plot", "x.svg",
                            words=["cannot be an axis", "f-number=4,5.6,8"])
        self.assert_refused(*lens, "f-number=5,8", "--plot", "x.txt", words=[".svg"])
        self.assert_refused(*lens, "f-number=5,8", "--plot-of", "efl_mm", words=["--plot FILE.svg"])
        self.assert_error(self.petzval(*lens, "f-number=5,8", "--plot", "x.svg", "--plot-of", "efl"), 1, "efl_mm")

    def test_a_failing_point_is_reported_and_the_rest_goes_on(self):
        done = self.petzval(*IMAGE, "--vary", "f-number=0.5,4", "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("f-number 0.5: ", done.stderr)
        rows = self.rows()
        self.assertEqual([row["status"] for row in rows], ["failed", "ok"])
        self.assertIn("0.5", rows[0]["error"])

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
        sweep = ["sweep", "lens", "psf", "edmund-54852", "--wavelengths", "550", "--vary", "fields=0,0.4,0.8,1.2,1.6,2,2.4,2.8", "-o", "out"]
        running = subprocess.Popen([PROGRAM, *sweep], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
        first = self.folder / "out" / "point-0000.json"
        while not first.exists() and running.poll() is None:
            time.sleep(0.005)
        os.killpg(running.pid, signal.SIGKILL)  # the point that is being made, too
        running.wait()
        self.assertFalse((self.folder / "out" / "sweep.csv").exists(), "it was killed before its end")
        self.assertFalse(json.loads((self.folder / "out" / "sweep.json").read_text())["finished"])
        stamp = first.stat().st_mtime_ns
        said = self.json_of(*sweep)
        self.assertEqual((said["points"], said["failed"]), (8, 0))
        self.assertEqual(first.stat().st_mtime_ns, stamp)
        self.assertFalse([path.name for path in (self.folder / "out").iterdir() if path.name.endswith((".out", ".err"))])

    def test_an_interrupted_sweep_says_what_it_keeps(self):
        sweep = [*IMAGE, "--vary", "f-number=2:0.1:6", "-o", "out"]
        running = subprocess.Popen([PROGRAM, *sweep], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        second = self.folder / "out" / "point-0001.json"
        while not second.exists() and running.poll() is None:
            time.sleep(0.005)
        running.send_signal(signal.SIGINT)
        said = running.communicate()[1]
        self.assertEqual(running.returncode, 130)
        done = int(re.search(r"stopped after (\d+) of 41 points; the same command goes on with the rest", said).group(1))
        self.assertGreaterEqual(done, 2)
        self.assertTrue((self.folder / "out" / f"point-{done - 1:04}.json").exists())

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
        said = self.json_of(*IMAGE, "--vary", "sensor.pitch_um=40:20:80", "--vary", "sensor.columns=24,48", "-o", "of")
        self.assertEqual([(row["pitch_um"], row["columns"]) for row in said["rows"]],
                         [(p, c) for p in (40, 60, 80) for c in (24, 48)])
        self.assert_refused(*IMAGE, "--vary", "sensor.pitch=3", "-o", "none", words=["pitch"])

    STOPS = ["sweep", "image", "points:5", "--lens", "edmund-54852", "--wavelengths", "450,550,650", "--sensor", "64x48@60"]

    def angles(self, *command):
        said = self.json_of(*command)
        self.assertEqual(said["failed"], 0)
        return [row["scene_angle_deg"] for row in said["rows"]]

    def test_one_scene_for_all_points(self):
        """A higher frame sees more of a chart of the other's shape; the scene is as wide as the higher one needs."""
        sweep = [*self.STOPS, "--vary", "sensor.rows=48,50"]
        each = self.angles(*sweep, "--scene-width", "each", "-o", "each")
        self.assertGreater(max(each) / min(each), 1.02)
        done = self.petzval(*sweep, "-o", "same", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        first, second = [row["scene_angle_deg"] for row in json.loads(done.stdout)["rows"]]
        self.assertEqual(first, second)
        self.assertAlmostEqual(first, 1.01 * max(each), delta=0.01 * max(each))
        self.assertGreater(first, max(each))
        self.assertIn(f"the scene is made {first:.4g} degrees wide at all points", done.stderr)
        self.assertIn(f"the narrowest would need {min(each):.3g}", done.stderr)
        # The points of the chart lie as far from the middle as in the other frame.
        brightest = {of: [[row - middle for row in self.brightest_rows(f"{of}/point-000{i}.png")]
                          for i, middle in enumerate((24, 25))] for of in ("same", "each")}
        self.assertEqual(*brightest["same"])
        self.assertNotEqual(*brightest["each"])

    def brightest_rows(self, name):
        """The five rows of pixels in which the points of the chart lie: brighter than those beside them."""
        sums = [sum(sum(pixel) for pixel in row) for row in picture_files.read_png(self.folder / name)]
        peaks = [at for at in range(1, len(sums) - 1) if sums[at - 1] <= sums[at] > sums[at + 1]]
        return sorted(sorted(peaks, key=lambda at: -sums[at])[:5])

    def test_scenes_with_a_width_of_their_own_keep_it(self):
        self.assertEqual(self.angles(*self.STOPS, "--vary", "scene-angle=60,70", "-o", "own"), [60, 70])
        self.assertEqual(self.angles(*self.STOPS, "--scene-angle", "65", "--vary", "f-number=2,22", "-o", "fixed"), [65, 65])
        natural = [word for word in self.STOPS if word not in ("--sensor", "64x48@60")]
        wide, same = self.angles(*natural, "--scene-size", "40x30", "--vary", "f-number=4,8", "-o", "natural")
        self.assertEqual(wide, same, "that of the fields of the lens, at every stop")
        # Of two scenes only the chart follows the frame.
        self.assert_succeeds("scene", "convert", "wall", "wall.exr", "--scene-angle", "66", "--scene-size", "32x24",
                             "--wavelengths", "450,550,650")
        words = [word for word in self.STOPS if word != "points:5"]
        wall, chart, other = self.angles(*words, "--vary", "scene=wall.exr,points:5,checkerboard", "-o", "scenes")
        self.assertEqual((wall, chart), (66, other))

    def test_lenses_of_other_focal_lengths_see_one_scene(self):
        words = [word for word in self.STOPS if word not in ("--lens", "edmund-54852")]
        sweep = [*words, "--vary", "lens=edmund-54852,cooke-triplet"]
        wide, narrow = self.angles(*sweep, "-o", "same")
        self.assertEqual(wide, narrow)
        wide, narrow = self.angles(*sweep, "--scene-width", "each", "-o", "each")
        self.assertGreater(wide / narrow, 5)

    def test_a_point_that_fails_has_no_say_in_the_width(self):
        done = self.petzval(*self.STOPS, "--vary", "f-number=0.5,2,4", "-o", "out", "--json")
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([row["status"] for row in rows], ["failed", "ok", "ok"])
        self.assertEqual(rows[1]["scene_angle_deg"], rows[2]["scene_angle_deg"])

    def test_the_width_is_found_once(self):
        sweep = [*self.STOPS, "--vary", "f-number=2,22", "-o", "out"]
        self.assert_succeeds(*sweep)
        record = self.folder / "out" / "sweep.json"
        kept = json.loads(record.read_text())
        stamp = (self.folder / "out" / "point-0000.json").stat().st_mtime_ns
        # Nothing but the record could make it wider now.
        kept["scene"]["greatest_deg"] *= 1.2
        record.write_text(json.dumps(kept))
        wider = self.angles(*sweep)
        self.assertAlmostEqual(wider[0], 1.01 * kept["scene"]["greatest_deg"], delta=0.01)
        for damaged in ({}, [], 3, {"points": 3, "least_deg": "x"}, {**kept["scene"], "greatest_deg": None}):
            kept["scene"] = damaged
            record.write_text(json.dumps(kept))
            self.assertLess(self.angles(*sweep)[0], wider[0])
        self.assertNotEqual((self.folder / "out" / "point-0000.json").stat().st_mtime_ns, stamp)

    def test_refuses_what_cannot_be_swept(self):
        self.assert_refused(*IMAGE, "--vary", "f-number", "-o", "out", words=["KEY=START:STEP:STOP"])
        self.assert_refused(*IMAGE, "--vary", "f-number=2,,4", "-o", "out", words=["empty"])
        self.assert_refused(*IMAGE, "--vary", "f-number=2", "--vary", "f-number=4", "-o", "out", words=["twice"])
        self.assert_refused(*IMAGE, "--vary", "f-number=0:1:1e9", "-o", "out", words=["10000"])
        self.assert_refused("sweep", "lens", "nonsense", "x", "--vary", "lens=a,b", "-o", "out", words=["nonsense"])

    def assert_nothing_made(self, *command, words):
        """Refused for what the user wrote, in those words; no folder, no record of it."""
        self.assert_refused("sweep", *command, "-o", "out", words=words)
        self.assertFalse((self.folder / "out").exists())

    def test_ranges_that_lead_nowhere(self):
        for values, right in [("4:1:2", "4:-1:2"), ("2:-1:4", "2:1:4"), ("2:0:4", "other than 0"), ("2:nan:1", "three numbers"),
                              ("2:8:0.5", "2:0.5:8"), 
                              ("2:x:1", "three numbers")]:
            self.assert_nothing_made(*IMAGE[1:], "--vary", f"f-number={values}", words=[f"--vary f-number={values}: ", right])
        self.assert_nothing_made(*IMAGE[1:], "--vary", "surfaces[4].thickness_mm=0.6:0.1:0.4", words=["0.6:-0.1:0.4"])

    def test_command_lines_are_checked_before_the_first_point(self):
        for vary, words in [("f-number=abc", ["--vary f-number=abc: ", "abc is not a number above 0"]),
                            ("method=none,foo", ["--vary method=foo: ", "product"]),
                            ("foo=1,2", ["--vary foo=1: ", "no option --foo"]),
                            ("surfaces[99].thickness_mm=1,2", ["--vary surfaces[99].thickness_mm=1: "]),
                            ("scene=wall,studio", ["scene", "fixed", "varied"]),
                            ("lens=edmund-54852,cooke-triplet", ["lens", "fixed", "varied"])]:
            self.assert_nothing_made(*IMAGE[1:], "--vary", vary, words=words)
        self.assert_nothing_made(*IMAGE[1:], "--vary", "f-number=2,4", "--vary", "scene=wall,studio", words=["scene", "fixed", "varied"])
        good = ["--vary", "f-number=2,4"]
        self.assert_nothing_made(*IMAGE[1:], *good, "--bogus", words=["--bogus", "petzval image --help"])
        self.assert_nothing_made(*IMAGE[1:], *good, "--f-number", "3", words=["f-number", "fixed", "varied"])
        self.assert_nothing_made(*IMAGE[1:], "--set", "surfaces[4].thickness_mm=0.5", "--vary", "surfaces[4].thickness_mm=0.5,0.6",
                                 words=["surfaces[4].thickness_mm", "fixed", "varied"])
        self.assert_nothing_made("lens", "mtf", "edmund-54852", *good, "--csv", "mtf.csv", words=["--csv", "same file"])
        for option in ("help", "output", "threads", "quiet", "json", "vary"):
            self.assert_nothing_made(*IMAGE[1:], "--vary", f"{option}=1,2", words=[f"--vary {option}", f"--{option}"])

    def test_a_sweep_whose_points_are_all_refused_leaves_nothing(self):
        good = ["--vary", "f-number=2,4"]
        self.assert_nothing_made("image", "nosuch", *IMAGE[3:], *good, words=["nosuch"])
        self.assert_nothing_made("image", "wall", "--lens", "nosuch", *good, words=["nosuch"])
        self.assert_nothing_made(*IMAGE[1:], "--vary", "f-number=0.5", words=["f/0.5"])
        self.assert_refused("sweep", *IMAGE[1:], "--vary", "f-number=0.5,0.6", "-o", "a/b/c", words=["f-number 0.5: ", "other points"])
        self.assertFalse((self.folder / "a").exists())
        # Into the folder of another sweep: that one stays, and can go on.
        self.assert_succeeds(*IMAGE, *good, "-o", "out")
        self.assert_refused(*IMAGE, "--vary", "f-number=0.5", "-o", "out", words=["f/0.5"])
        self.assert_succeeds(*IMAGE, *good, "-o", "out")

    def test_values_of_other_kinds(self):
        said = self.json_of(*IMAGE, "--vary", "seed=1,2", "--vary", "ignore-apertures=true,false", "-o", "out")
        self.assertEqual([row["seed"] for row in said["rows"]], [1, 1, 2, 2])
        self.assertEqual(said["failed"], 0)
        done = self.petzval(*IMAGE[:5], *IMAGE[7:], "--vary", "wavelengths=450:100:650,550", "-o", "lists")
        self.assertEqual((done.returncode, "2 points, 0 failed" in done.stdout), (0, True), done.stderr)

    def test_says_which_values_a_range_has(self):
        done = self.petzval(*IMAGE, "--vary", "f-number=2:0.3:3", "-o", "out")
        self.assertIn("note: --vary f-number=2:0.3:3: the last value is 2.9", done.stderr)
        self.assertEqual([row["f-number"] for row in self.rows()], ["2", "2.3", "2.6", "2.9"])
        done = self.petzval(*IMAGE, "--vary", "f-number=2,4,2.0", "-o", "twice")
        self.assertIn("note: --vary f-number: 2.0 stands there twice", done.stderr)
        self.assertEqual([row["f-number"] for row in self.rows("twice")], ["2", "4"])


class ContactSheet(ProgramTest):
    GAP, THUMBNAIL, PAPER, SHADE = 12, 320, 245, 225

    def test_small_pictures_are_enlarged_and_failures_shown(self):
        """Each pixel of a picture of 48 x 36 is a square of 6 x 6: the largest that fits 320."""
        self.assert_succeeds(*IMAGE, "--vary", "f-number=2,0.5", "-o", "out")
        sheet = picture_files.read_png(self.folder / "out" / "contact-sheet.png")
        picture = picture_files.read_png(self.folder / "out" / "point-0000.png")
        self.assertEqual((len(picture), len(picture[0])), (36, 48))
        factor = self.THUMBNAIL // 48
        for row in range(36 * factor):
            for column in range(0, 48 * factor):
                self.assertEqual(sheet[self.GAP + row][self.GAP + column], picture[row // factor][column // factor])
        self.assertEqual(set(sheet[self.GAP + 4][self.GAP + 48 * factor]), {self.PAPER}, "the picture ends there")
        failed = 2 * self.GAP + self.THUMBNAIL
        self.assertEqual(set(sheet[self.GAP + 4][failed + 4]), {self.SHADE})
        inside = {sum(pixel) for line in sheet[self.GAP + 1:self.GAP + 40] for pixel in line[failed + 1:failed + 200]}
        self.assertLess(min(inside), 3 * 100, "it is written there that it failed")


class SweepFolders(ProgramTest):
    SWEEP = [*IMAGE, "--vary", "f-number=2,4,8", "-o", "out"]

    def names(self):
        return sorted(path.name for path in (self.folder / "out").iterdir())

    def test_damaged_points_are_made_again(self):
        sweep = [*self.SWEEP, "--irradiance", "npy"]
        self.assert_succeeds(*sweep)
        whole = self.contents()
        for damaged, said in [("point-0001.png", "not as it was written"), ("point-0002.npy", "not as it was written")]:
            self.write(f"out/{damaged}", "broken")
            done = self.petzval(*sweep)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"note: {damaged} is {said}", done.stderr)
        (self.folder / "out" / "point-0000.npy").unlink()
        self.assertIn("note: point-0000.npy is gone", self.petzval(*sweep).stderr)
        for record in ("{", "[]", '{"version": 3}', '{"version": null, "written": []}'):
            self.write("out/point-0001.json", record)
            self.assert_succeeds(*sweep)
        again = self.contents()
        self.assertEqual(again.keys(), whole.keys())
        for name in whole:
            if name.endswith((".png", ".npy")):
                self.assertEqual(again[name], whole[name], name)

    def test_files_of_the_user_stay(self):
        (self.folder / "out").mkdir()
        for name in ("index.html", "point-0000.png", "point-0002.json", "sweep.csv", "sweep.json"):
            path = self.write(f"out/{name}", '{"rows": []}')
            self.assert_refused(*self.SWEEP, words=[name, "another folder"])
            path.unlink()
        self.write("out/notes.txt", "mine")
        self.write("out/point-0007.png", "mine")
        self.assert_succeeds(*self.SWEEP)
        self.assertEqual((self.folder / "out" / "notes.txt").read_text(), "mine")
        # A picture of the user in the place of a point of a larger sweep, in a folder of ours.
        self.assert_refused(*IMAGE, "--vary", "f-number=2:1:9", "-o", "out", words=["point-0007.png"])

    def test_a_smaller_sweep_takes_away_what_the_larger_one_left(self):
        self.assert_succeeds(*self.SWEEP)
        self.write("out/point-0009.png", "mine")
        self.assert_succeeds(*IMAGE, "--vary", "f-number=2,4", "-o", "out")
        self.assertEqual(self.names(), ["contact-sheet.png", "index.html", "point-0000.json", "point-0000.png", "point-0001.json",
                                        "point-0001.png", "point-0009.png", "sweep.csv", "sweep.json"])
        listed = json.loads((self.folder / "out" / "sweep.json").read_text())
        self.assertEqual((listed["finished"], set(listed["files"])), (True, set(self.names()) - {"point-0009.png"}))
        # A point that fails now has no picture of an older one.
        self.petzval(*IMAGE, "--vary", "f-number=2,0.5", "-o", "out")
        self.assertNotIn("point-0001.png", self.names())

    def test_what_is_listed_is_removed_by_name_only(self):
        """A sweep.json from somewhere else must not tell us to remove other files."""
        self.assert_succeeds(*self.SWEEP)
        self.write("precious.png", "mine")
        self.write("out/notes.txt", "mine")
        listed = json.loads((self.folder / "out" / "sweep.json").read_text())
        listed["files"] += ["../precious.png", "notes.txt", str(self.folder / "precious.png"), 3]
        self.write("out/sweep.json", listed)
        self.assert_succeeds(*IMAGE, "--vary", "f-number=2", "-o", "out")
        self.assertEqual(((self.folder / "precious.png").read_text(), (self.folder / "out" / "notes.txt").read_text()), ("mine",) * 2)

    def test_a_sweep_over_what_it_reads(self):
        self.assert_succeeds(*self.SWEEP, "--irradiance", "exr")
        self.assert_refused("sweep", "image", "out/point-0000.png", *IMAGE[3:], "--vary", "f-number=2,4", "-o", "out",
                            words=["would overwrite", "point-0000.png"])

    SHOT = ["sweep", "image", "--lens", "double-gauss", "--sensor", "icx625-mono", "--sensor-set", "columns=60", "--sensor-set",
            "rows=48", "--scene-distance", "1m", "--wavelengths", "660", "--illuminant", "660nm/20", "--method", "none"]

    def test_points_of_a_table_with_the_raw_files_of_the_command(self):
        self.write("points.csv", "label,scene,exposure,seed\nbright one,qr:A,5ms,7\n\"dark, other\",qr:B,1ms,8\n")
        said = self.json_of(*self.SHOT, "--points", "points.csv", "--keep", "dng,exr", "-o", "out")
        self.assertEqual([(row["label"], row["exposure"], row["seed"]) for row in said["rows"]],
                         [("bright one", "5ms", 7), ("dark, other", "1ms", 8)])
        angle = said["rows"][0]["scene_angle_deg"]
        for index, (scene, exposure, seed) in enumerate((("qr:A", "5ms", "7"), ("qr:B", "1ms", "8"))):
            self.assert_succeeds("image", scene, *self.SHOT[2:], "--exposure", exposure, "--seed", seed, "--scene-angle",
                                 repr(angle), "-o", "alone.dng", "-o", "alone.npy", "--quiet")
            alone = (self.folder / "alone.dng").read_bytes()
            self.assertEqual((self.folder / "out" / f"point-000{index}.dng").read_bytes(), alone, scene)
        # With --vary: each of the one with each of the other.
        said = self.json_of(*self.SHOT, "--points", "points.csv", "--vary", "f-number=8,11", "-o", "out")
        self.assertFalse([*(self.folder / "out").glob("*.dng")], "those of the sweep before go with it")
        self.assertEqual([(row["label"], row["f-number"]) for row in said["rows"]],
                         [("bright one", 8), ("bright one", 11), ("dark, other", 8), ("dark, other", 11)])

    def test_tables_of_points_that_are_none(self):
        for text, word in (("", "no points"), ("seed\n", "no points"), ("seed,seed\n1,2\n", "each once"),
                           ("seed,exposure\n1\n", "points.csv:2"), ("foo\n1\n", "foo")):
            self.write("points.csv", text)
            self.assert_refused(*self.SHOT[:2], "wall", *self.SHOT[2:], "--points", "points.csv", "-o", "out", words=[word])
        self.write("points.csv", "seed\n1\n")
        self.assert_refused(*self.SHOT[:2], "wall", *self.SHOT[2:], "--points", "points.csv", "--vary", "seed=1,2", "-o", "out",
                            words=["one of the two"])
        self.assert_refused(*self.SHOT[:2], "wall", *self.SHOT[2:], "-o", "out", words=["--vary", "--points"])

    def test_sheets_are_about_as_wide_as_tall_and_bright_enough_to_see(self):
        done = self.petzval(*self.SHOT[:2], "checkerboard", *self.SHOT[2:], "--vary", "exposure=1us:1us:20us", "-o", "out")
        self.assertIn("times as bright", done.stderr)
        sheet = picture_files.read_png(self.folder / "out" / "contact-sheet.png")
        self.assertTrue(0.5 < len(sheet[0]) / len(sheet) < 2, (len(sheet[0]), len(sheet)))
        brightest = max(max(pixel) for row in picture_files.read_png(self.folder / "out" / "point-0019.png") for pixel in row)
        self.assertLess(brightest, 100, "the pictures themselves stay as dark as they are")


if __name__ == "__main__":
    unittest.main()
