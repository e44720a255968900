# SPDX-License-Identifier: BSD-3-Clause
"""What the program prints, against figures that others computed: an independent tracer's (tests/data/*.ref.json), and those
of the lens of Maeda, Catrysse and Wandell (2005), Edmund Optics R54-852."""

import csv
import json
import math
import pathlib
import unittest

from petzval_cli import ProgramTest

REFERENCES = pathlib.Path(__file__).resolve().parent.parent / "data"


class ReferenceLens:
    """Tests shared by the lenses of the independent tracer; `bundled` names the lens, `reference` its file."""

    def setUp(self):
        super().setUp()
        self.figures = json.loads((REFERENCES / self.reference).read_text())

    def assert_relative(self, value, expected, relative):
        self.assertLess(abs(value - expected), relative * abs(expected), f"{value} is not {expected}")

    def test_first_order(self):
        """Both programs work in double precision, and a paraxial trace loses two or three digits of sixteen."""
        primary = self.figures["first_order_primary"]
        self.compare_first_order(self.json_of("lens", "info", self.bundled), primary)
        info = self.json_of("lens", "info", self.bundled)
        self.assert_relative(info["f_number"], primary["fno"], 1e-9)
        self.assert_relative(info["entrance_pupil"]["diameter_mm"], primary["EPD"], 1e-9)
        self.assert_relative(info["exit_pupil"]["diameter_mm"], primary["XPD"], 1e-9)
        for figures in self.figures["first_order_per_wavelength"]:
            nm = repr(figures["wavelength_um"] * 1000)
            self.compare_first_order(self.json_of("lens", "info", self.bundled, "--wavelength", nm), figures)

    def compare_first_order(self, info, figures):
        names = {"efl_mm": "EFL", "bfl_mm": "BFL", "ffl_mm": "FFL"}
        for ours, theirs in names.items():
            if theirs in figures:
                self.assert_relative(info[ours], figures[theirs], 1e-9)
        self.assert_relative(info["entrance_pupil"]["position_mm"], figures["EPL"], 1e-9)
        self.assert_relative(info["exit_pupil"]["position_mm"], figures["XPL_from_image"], 1e-9)

    def test_explicit_rays(self):
        rays = self.figures["rays"]["rows"]
        self.assertGreater(len(rays), 30)
        with open(self.folder / "rays.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow("x_mm y_mm z_mm L M N wavelength_nm".split())
            for ray in rays:
                numbers = [*ray["start"], *ray["dir"], ray["wavelength_um"] * 1000]
                writer.writerow(map(repr, numbers))
        self.assert_succeeds("lens", "trace", self.bundled, "--rays", "rays.csv", "-o", "out.csv", "--ignore-apertures")
        with open(self.folder / "out.csv", newline="") as file:
            traced = list(csv.DictReader(file))
        self.assertEqual(len(traced), len(rays))
        for row, ray in zip(traced, rays):
            self.assertEqual(row["status"], "ok")
            expected = [*ray["image_xyz"], *ray["image_dir"], ray["opl_start_to_image"]]
            for name, number in zip("x_mm y_mm z_mm L M N opl_mm".split(), expected):
                # Issue: 1e-9 mm, 1e-9 in direction; double precision leaves some 1e-13 mm.
                self.assertLess(abs(float(row[name]) - number), 1e-9, name)

    def test_chief_ray_heights(self):
        for row in self.figures["chief_rays"]["rows"]:
            heights = self.json_of("lens", "distortion", self.bundled, "--field-type", "angle_deg",
                                   "--fields", row["field_deg"], "--wavelengths",
                                   ",".join(repr(ray["wavelength_um"] * 1000) for ray in row["per_wl"]))["rows"]
            for ours, ray in zip(heights, row["per_wl"], strict=True):
                # Aiming stops within 1e-7 mm of the centre of the stop or better.
                self.assertLess(abs(ours["image_height_mm"] - ray["y_image"]), 1e-7)


class CookeTriplet(ReferenceLens, ProgramTest):
    bundled, reference = "cooke-triplet", "cooke_triplet_f5.ref.json"


class DoubleGauss(ReferenceLens, ProgramTest):
    bundled, reference = "double-gauss", "double_gauss_f5.ref.json"


class LensOfThePaper(ProgramTest):
    """Figures for an object at 250 mm and 587.56 nm, from an independent calculation with the same glasses; tolerances are
    half of the last digit given."""

    OPTIONS = ("--wavelength", "587.56")

    def test_first_order(self):
        info = self.json_of("lens", "info", "edmund-54852", *self.OPTIONS)
        self.assertAlmostEqual(info["efl_mm"], 6.000, delta=5e-4)
        self.assertAlmostEqual(info["magnification"], -0.02395, delta=5e-6)
        self.assertAlmostEqual(info["entrance_pupil"]["position_mm"], 4.05795, delta=5e-6)

    def rows(self, command, field_type, fields, wavelengths="587.56"):
        return self.json_of("lens", command, "edmund-54852", "--field-type", field_type, "--fields", fields,
                            "--wavelengths", wavelengths)["rows"]

    def test_distortion_at_both_kinds_of_image_height(self):
        """The paper says roughly −10 % at 3 mm."""
        for kind, percent in (("paraxial_image_height_mm", -8.40), ("real_image_height_mm", -10.67)):
            row, = self.rows("distortion", kind, "3")
            self.assertAlmostEqual(row["paraxial_distortion_percent"], percent, delta=0.005)

    def test_lateral_colour(self):
        """The paper: under 15 µm, wavelengths unstated; here between the F and C lines at the corner of its sensor."""
        blue, red = self.rows("distortion", "paraxial_image_height_mm", "3", "486.13,656.27")
        difference_um = 1000 * abs(blue["image_height_mm"] - red["image_height_mm"])
        self.assertLess(difference_um, 15)
        self.assertGreater(difference_um, 0.1)

    def test_illumination(self):
        """g_sensor [sr] by a backward count of rays, whose heights are rounded to 0.01 mm; g rises by up to 0.028 sr/mm
        there, and 0.028 × 0.005 = 1.4e-4."""
        expected = {0: 0.22123, 1.40: 0.21868, 2.37: 0.22200, 2.75: 0.23078}
        rows = self.rows("illumination", "real_image_height_mm", ",".join(map(str, expected)))
        axis, *_ = rows
        for row, (height_mm, g) in zip(rows, expected.items(), strict=True):
            # The field that has this image height is searched for; a nanometre is a five-hundredth of a wavelength.
            self.assertAlmostEqual(row["real_image_height_mm"], height_mm, delta=1e-6)
            self.assertAlmostEqual(row["g_sensor_sr"], g, delta=1.4e-4)
            self.assertTrue(math.isclose(row["relative_illumination"], row["g_sensor_sr"] / axis["g_sensor_sr"]))


if __name__ == "__main__":
    unittest.main()
