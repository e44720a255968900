# SPDX-License-Identifier: BSD-3-Clause
"""Analyses of a lens as their users meet them: rows by name, pictures, focus and stop, and what is refused."""

import base64
import csv
import json
import math
import pathlib
import re
import unittest
import xml.etree.ElementTree as ElementTree

from petzval_cli import ProgramTest

SENSORS = pathlib.Path(__file__).parents[2] / "data" / "sensors"
ANALYSES = {
    "fans": {"pupil", "x_um", "y_um", "opd_waves", "fan"},
    "zernike": {"index", "n", "m", "name", "coefficient_waves"},
    "field-curvature": {"tangential_mm", "sagittal_mm", "petzval_mm", "real_image_height_mm"},
    "colour": {"lateral_colour_um"},
    "vignetting": {"open_share", "pupil_low", "pupil_high", "low_surface"},
    "polarisation": {"diattenuation_percent", "rms_retardance_nm", "strehl"},
    "chief-ray-angle": {"chief_ray_angle_deg", "mean_ray_angle_deg"},
}


class LensAnalyses(ProgramTest):
    def test_rows_have_field_wavelength_and_their_numbers(self):
        for command, keys in ANALYSES.items():
            with self.subTest(command=command):
                out = self.json_of("lens", command, "cooke-triplet", "--fields", "0,14", "--wavelengths", "550",
                                   "--plot", "plot.svg")
                self.assertEqual(out["field_definition"]["type"], "angle_deg")
                self.assertEqual({row["field"] for row in out["rows"]}, {0, 14})
                for row in out["rows"]:
                    self.assertLessEqual(keys | {"field", "wavelength_nm"}, set(row))
                root = ElementTree.parse(self.folder / "plot.svg").getroot()
                self.assertTrue(root.tag.endswith("svg"))

    def test_ghosts_of_coated_surfaces(self):
        usual = ["lens", "ghosts", "cooke-triplet"]
        bare, coated = (self.json_of(*usual, *more)["rows"] for more in ([], ["--coating", "0.01"]))
        self.assertEqual(len(bare), 15)  # pairs of six surfaces
        self.assertEqual({row["wavelength_nm"] for row in bare}, {550})
        key = lambda row: (row["first_surface"], row["second_surface"])
        for one, other in zip(sorted(bare, key=key), sorted(coated, key=key)):
            self.assertEqual(key(one), key(other))
            self.assertAlmostEqual(one["focus_mm"], other["focus_mm"])
            self.assertLess(other["transmittance"], one["transmittance"])
            # R² of two surfaces, (1 − R) of the others: once, or three times between the two.
            between = int(one["first_surface"]) - int(one["second_surface"]) - 1
            expected = 0.01 ** 2 * 0.99 ** (2 + 3 * between + 4 - between)
            self.assertAlmostEqual(other["transmittance"] / expected, 1, places=12)
        sensor = self.json_of(*usual, "--sensor-reflectance", "0.05", "--wavelengths", "450,650")["rows"]
        self.assertEqual(len(sensor), 2 * 21)
        self.assertEqual(sum(row["first_surface"] == "sensor" for row in sensor), 12)
        self.assert_error(self.petzval(*usual, "--sensor-reflectance", "2"), 2, "0", "1")
        self.assert_error(self.petzval(*usual, "--source-diameter", "200"), 2, "--source-diameter", "180")

    def test_blades_are_part_of_the_lens(self):
        usual = ["--fields", "0,7", "--wavelengths", "550"]
        bladed = self.json_of("lens", "spots", "double-gauss", *usual, "--blades", "5", "--blade-rotation", "10")["rows"]
        self.assert_succeeds("lens", "convert", "double-gauss", "bladed.json", "--set",
                             'surfaces[5].blades={"count": 5, "rotation_deg": 10}')
        lens = json.loads((self.folder / "bladed.json").read_text())
        self.assertEqual(lens["surfaces"][5]["blades"], {"count": 5, "rotation_deg": 10})
        self.assertEqual(self.json_of("lens", "spots", "bladed.json", *usual)["rows"], bladed)
        round_stop = self.json_of("lens", "spots", "double-gauss", *usual)["rows"]
        self.assertEqual(self.json_of("lens", "spots", "bladed.json", "--blades", "0", *usual)["rows"], round_stop)
        self.assertLess(bladed[0]["rms_radius_um"], round_stop[0]["rms_radius_um"])
        # What a field at 90 degrees sees is what the first sees with the blades turned back.
        at_azimuth = self.json_of("lens", "mtf", "bladed.json", *usual, "--frequencies", "30", "--field-azimuth", "90")
        self.assertEqual(at_azimuth.pop("azimuth_deg"), [90])
        self.assertEqual(at_azimuth,
                         self.json_of("lens", "mtf", "bladed.json", *usual, "--frequencies", "30", "--blade-rotation", "-80"))
        share = self.json_of("lens", "vignetting", "bladed.json", *usual)["rows"][0]["open_share"]
        self.assertAlmostEqual(share, 5 / (2 * math.pi) * math.sin(2 * math.pi / 5), places=6)
        for command in (["lens", "wavefront"], ["lens", "zernike"]):
            self.assert_error(self.petzval(*command, "bladed.json"), 2, "5 blades", "blades=null")
        # A table of blades lies over the frame: images take it, programs that know heights only do not.
        self.assert_succeeds("optics", "build", "bladed.json", "--wavelengths", "550", "--image-height", "4", "--places",
                             "5", "-o", "t.h5")
        table = self.json_of("optics", "info", "t.h5")
        self.assertEqual((len(table["image_x_mm"]), len(table["image_y_mm"]), len(table["rows"])), (5, 5, 25))
        self.assert_error(self.petzval("optics", "info", "t.h5", "--fit", "6"), 2, "over the frame")
        self.assert_error(self.petzval("optics", "export", "t.h5", "--to", "iset", "-o", "t.mat"), 2, "over the frame")
        self.assert_succeeds("image", "points:3", "--scene-angle", "10", "--optics", "t.h5", "--sensor", "40x30@100",
                             "--wavelengths", "550", "-o", "x.npy")
        spots = ["lens", "spots", "double-gauss"]
        self.assert_error(self.petzval(*spots, "--blade-rotation", "5"), 2, "--blades")
        self.assert_error(self.petzval(*spots, "--blades", "2"), 2, "3 to 64")

    def test_through_focus_and_over_field(self):
        rows = self.json_of("lens", "mtf", "cooke-triplet", "--fields", "0", "--frequencies", "30",
                            "--polychromatic", "--through-focus", "0.2")["rows"]
        shifts = [row["sensor_shift_mm"] for row in rows]
        self.assertEqual((len(rows), min(shifts), max(shifts)), (33, -0.2, 0.2))
        at_rest, = self.json_of("lens", "mtf", "cooke-triplet", "--fields", "0", "--frequencies", "30",
                                "--polychromatic")["rows"]
        self.assertAlmostEqual(rows[16]["tangential"], at_rest["tangential"], 9)
        over = self.json_of("lens", "mtf", "cooke-triplet", "--over-field", "--polychromatic")["rows"]
        self.assertEqual(len(over), 21 * 3)

    def test_stopping_down_and_focusing_change_the_lens_in_use(self):
        open_ = self.json_of("lens", "info", "double-gauss")
        closed = self.json_of("lens", "info", "double-gauss", "--f-number", "8")
        self.assertAlmostEqual(closed["f_number"], 8, 9)
        self.assertAlmostEqual(closed["efl_mm"], open_["efl_mm"], 9)
        # 1/f = 1/s + 1/s' with the thin lens's planes replaced by Newton's: x x' = f².
        near = self.json_of("lens", "info", "double-gauss", "--focus", "2000mm")
        x = near["object_distance_mm"] + near["ffl_mm"]
        moved = near["total_track_mm"] - open_["total_track_mm"]
        self.assertAlmostEqual(moved, near["efl_mm"] ** 2 / x, 9)
        self.assertAlmostEqual(near["object_distance_mm"] + near["total_track_mm"], 2000, 9)
        pulled = self.json_of("lens", "info", "edmund-54852", "--move-lens", "0.05")
        rest = self.json_of("lens", "info", "edmund-54852")
        self.assertAlmostEqual(pulled["object_distance_mm"], rest["object_distance_mm"] - 0.05, 9)
        self.assertAlmostEqual(pulled["total_track_mm"], rest["total_track_mm"] + 0.05, 9)

    def test_best_focus_is_where_focus_says(self):
        rows = {row["focus"]: row for row in
                self.json_of("lens", "focus", "cooke-triplet", "--frequency", "40", "--fields", "0,14")["rows"]}
        self.assertGreater(rows["best-mtf@40"]["after"], rows["best-mtf@40"]["before"])
        self.assertLess(rows["best-spot"]["after"], rows["best-spot"]["before"])
        again = self.json_of("lens", "focus", "cooke-triplet", "--frequency", "40", "--fields", "0,14", "--focus",
                             "best-spot")["rows"]
        # Derivatives of rays by differences leave the tenth digit.
        self.assertAlmostEqual(again[1]["sensor_shift_mm"], 0, 8)
        self.assertAlmostEqual(again[1]["before"], rows["best-spot"]["after"], 7)

    def test_what_is_refused(self):
        self.assert_refused("lens", "spots", "cooke-triplet", "--focus", "sharp", words=["best-spot"])
        self.assert_refused("lens", "spots", "cooke-triplet", "--focus", "best-mtf@0", words=["cycles/mm"])
        self.assert_refused("lens", "spots", "cooke-triplet", "--f-number", "2", words=["opens to f/5"])
        self.assert_refused("lens", "spots", "cooke-triplet", "--focus", "infinity", "--image-distance", "40",
                            words=["--image-distance"])
        for option in ("--defocus", "--move-lens", "--image-distance"):
            self.assert_refused("lens", "mtf", "cooke-triplet", option, "1e9", words=["1e+09 mm", "1e+06 mm would be right"])
        self.assert_refused("lens", "report", "cooke-triplet", "-o", "report.pdf", words=[".html"])
        self.assert_refused("lens", "zernike", "cooke-triplet", "--terms", "38", words=["37"])
        self.assert_refused("lens", "fans", "cooke-triplet", "--fields", "80", words=["80"])

    def test_report_of_two_lenses_on_a_sensor(self):
        self.assert_succeeds("lens", "report", "cooke-triplet", "edmund-54852", "--wavelengths", "550", "--sensor",
                             "third-inch-vga", "-o", "report.html")
        page = (self.folder / "report.html").read_text()
        self.assertIn("Comparison", page)
        self.assertEqual(page.count("On the sensor 1/3 inch, VGA"), 2)

    def test_report_knows_the_microlenses_of_the_sensor(self):
        sensor = json.loads((SENSORS / "third-inch-1280x960.json").read_text())
        sensor["microlens"] = {"angles_deg": [0, 30], "response": [1, 0.7],
                               "design_heights_mm": [0, 3], "design_angles_deg": [0, 12]}
        (self.folder / "sensor.json").write_text(json.dumps(sensor))
        self.assert_succeeds("lens", "report", "edmund-54852", "--wavelengths", "587.56", "--sensor", "sensor.json",
                             "-o", "report.html")
        page = (self.folder / "report.html").read_text()
        data = re.search('download="sensor.csv" href="data:text/csv;base64,([^"]*)"', page)[1]
        rows = list(csv.DictReader(base64.b64decode(data).decode().splitlines()))
        heights = [float(list(row.values())[0]) for row in rows]
        self.assertEqual(len(rows), 6)
        for height, row in zip(heights, rows):
            *_, angle, designed, mismatch = [float(value) for value in row.values()]
            self.assertAlmostEqual(designed, 4 * height, 9)
            self.assertAlmostEqual(mismatch, angle - designed, 9)
        angles = self.json_of("lens", "chief-ray-angle", "edmund-54852", "--wavelengths", "587.5618", "--field-type",
                              "real_image_height_mm", "--fields", repr(heights[3]))["rows"]
        self.assertAlmostEqual(float(list(rows[3].values())[5]), angles[0]["chief_ray_angle_deg"], 6)

    def test_threads_do_not_matter(self):
        for threads in (1, 3):
            self.assert_succeeds("lens", "report", "cooke-triplet", "--fields", "0,20", "--wavelengths", "550", "--threads", threads, "-o",
                                 f"{threads}.html")
        self.assertEqual((self.folder / "1.html").read_bytes(), (self.folder / "3.html").read_bytes())


if __name__ == "__main__":
    unittest.main()
