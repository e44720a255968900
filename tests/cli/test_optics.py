# SPDX-License-Identifier: BSD-3-Clause
"""petzval optics: building a lens data table and looking at it."""

import math
import unittest

from petzval_cli import ProgramTest

SMALL = ("--wavelengths", "550", "--fields", "6", "--image-height", "1")


class Optics(ProgramTest):
    def build(self, *arguments, output="t.h5"):
        self.assert_succeeds("optics", "build", "edmund-54852", *arguments, "-o", output)
        return self.json_of("optics", "info", output)

    def test_the_papers_lens(self):
        info = self.build("--sensor", "768x576@6.25", "--wavelengths", "587.5618", "--fields", "21")
        self.assertEqual(info["field_definition"]["type"], "object_height_mm")
        self.assertEqual(info["object_distance_mm"], 250)
        # Focal length, magnification and pupil as the lens's published data have them, to the digits given there.
        self.assertAlmostEqual(info["first_order"]["efl_mm"], 6.000, delta=0.0005)
        self.assertAlmostEqual(info["first_order"]["magnification"], -0.02395, delta=0.000005)
        self.assertAlmostEqual(info["first_order"]["entrance_pupil"]["position_mm"], 4.05795, delta=0.000005)
        rows = info["rows"]
        self.assertEqual(len(rows), 21)
        # Half the diagonal of 768 x 576 pixels of 6.25 um is 3 mm: the table reaches it.
        self.assertGreaterEqual(rows[-1]["real_image_height_mm"], 3.0)
        # -8.40 % at paraxial 3 mm, i.e. at an object height of 3 / 0.023954 = 125.2 mm: between its neighbours.
        before = max((row for row in rows if row["field"] <= 125.2), key=lambda row: row["field"])
        after = min((row for row in rows if row["field"] > 125.2), key=lambda row: row["field"])
        self.assertGreater(before["distortion_percent"], -8.40)
        self.assertLess(after["distortion_percent"], -8.40)
        self.assertAlmostEqual(rows[0]["g_sensor_sr"], 0.22123, delta=0.22123e-3)  # an independent ray count
        self.assertEqual(rows[0]["relative_illumination"], 1)

    def test_compares_the_light_on_the_axis_with_formulas(self):
        info = self.build("--wavelengths", "587.5618", "--fields", "2", "--image-height", "1")
        first, light = info["first_order"], info["axial_light"]
        for key, n in (("by_f_number_sr", first["f_number"]), ("by_isetcam_sr", first["working_f_number"])):
            self.assertAlmostEqual(light[key], math.pi / (1 + 4 * n ** 2 * (1 - first["magnification"]) ** 2), delta=1e-12)
        self.assertEqual(light["g_sensor_sr"], info["rows"][0]["g_sensor_sr"])
        self.assertIn("ISETCam", self.assert_succeeds("optics", "info", "t.h5"))

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in ("1", "2"):
            self.build(*SMALL, "--threads", threads, output=f"{threads}.h5")
        self.assertEqual((self.folder / "1.h5").read_bytes(), (self.folder / "2.h5").read_bytes())

    def test_focus(self):
        designed = self.build(*SMALL)
        # The object stands 250 mm before vertex 1, so that much and the length of the lens from the sensor.
        distance = 250 + designed["vertex_to_sensor_mm"]
        self.assertEqual(self.build(*SMALL, "--focus", f"{distance:.12f}mm")["rows"], designed["rows"])
        infinity = self.build(*SMALL, "--focus", "infinity")
        self.assertEqual(infinity["field_definition"]["type"], "angle_deg")
        self.assertIsNone(infinity["object_distance_mm"])
        # x' = f²/x moves the sensor by f |m| = 0.1437 mm.
        self.assertAlmostEqual(designed["vertex_to_sensor_mm"] - infinity["vertex_to_sensor_mm"], 0.14373, delta=2e-5)

    def test_stopping_down(self):
        # Beyond the aberrations of the pupil, g goes with the inverse square of the f-number.
        wide, narrow = (self.build(*SMALL, "--f-number", n)["rows"][0]["g_sensor_sr"] for n in (8, 16))
        self.assertAlmostEqual(wide / narrow, 4, delta=0.02)

    def test_fits(self):
        self.build("--wavelengths", "550", "--sensor", "768x576@6.25")
        residuals = [self.json_of("optics", "info", "t.h5", "--fit", order)["fit"]["residuals"][0]["height_max_um"]
                     for order in (4, 6, 8)]
        self.assertEqual(residuals, sorted(residuals, reverse=True))
        self.assertGreater(residuals[-1], 0)
        text = self.assert_succeeds("optics", "info", "t.h5", "--fit", "6")
        self.assertIn("polynomials of order 6", text)
        self.assertIn("efl_mm", text)

    def test_wrong_usage(self):
        build = ("optics", "build", "edmund-54852")
        self.assert_refused(*build, words=["--output"])
        self.assert_refused(*build, "-o", "no/folder/t.h5", words=["no/folder"])
        for option, value, word in (("--wavelengths", "blue", "blue"), ("--fields", "1", "fields"),
                                    ("--focus", "near", "design, infinity"), ("--focus", "5", "5m or 5mm"), ("--focus", "5mm", "m"),
                                    ("--f-number", "1.2", "f/1.775"), ("--image-height", "-3", "an image height of -3 mm"),
                                    ("--sensor", "768x", "768x"), ("--wavelengths", "100", "nm")):
            with self.subTest(option=option, value=value):
                self.assert_refused(*build, option, value, "-o", "t.h5", words=[word])
        self.assert_refused(*build, "--sensor", "64x48@6", "--image-height", "1", "-o", "t.h5")
        self.assert_refused(*build, "--sensor", "64x48@6", "--tolerance", "0", "-o", "t.h5", words=["tolerance of 0"])
        self.assert_refused(*build, "--tolerance", "1e-3", "-o", "t.h5", words=["--sensor"])
        self.assert_refused(*build, "--sensor", "64x48@6", "--tolerance", "1e-3", "--fields", "9", "-o", "t.h5", words=["--fields"])

    def test_bad_files(self):
        self.assert_refused("optics", "info", "absent.h5", words=["absent.h5"])
        self.write("notes.h5", "radius 12\n")
        self.assert_refused("optics", "info", "notes.h5", words=["notes.h5", "not an HDF5 file"])
        self.build(*SMALL)
        whole = (self.folder / "t.h5").read_bytes()
        self.write("cut.h5", whole[: len(whole) // 2])
        self.assert_refused("optics", "info", "cut.h5", words=["cut.h5", "damaged"])
        for order in ("3", "9", "cubic"):
            self.assert_refused("optics", "info", "t.h5", "--fit", order, words=["monotone"])
        self.assert_refused("optics", "info", "t.h5", "--fit", "6", words=["fields"])


if __name__ == "__main__":
    unittest.main()
