# SPDX-License-Identifier: BSD-3-Clause
"""The bundled lenses for machine vision are what their names say."""

import math
import unittest

from petzval_cli import ProgramTest

# Name: focal length [mm], f-number, diagonal of the image circle [mm], as the descriptions promise.
LENSES = {
    "cmount-8mm": (8.5, 3.6, 9.7), "cmount-12mm": (12, 4, 7.7), "cmount-16mm": (16, 2.8, 9.6), "cmount-25mm": (25, 2.8, 11.4),
    "cmount-35mm": (35, 2.8, 11.6), "cmount-50mm": (50, 4, 15.8), "m12-4mm": (4, 2.7, 6.2), "m12-8mm": (8, 2.8, 5.7),
    "m12-12mm": (12, 4, 8.7), "m12-2mm-fisheye": (1.9, 4, 5.0),
}
# Patents, scaled: as sharp as they are.
PATENTS = {
    "cmount-16mm-f1.8": (16, 1.8, 13.5), "cmount-17mm-f1": (17, 1, 13.4), "cmount-20mm-f1.2": (20, 1.2, 16.7),
    "cmount-25mm-f1.4": (25, 1.4, 20.8), "cmount-35mm-f1.4": (35, 1.4, 29.6), "m12-4.5mm": (4.5, 3, 5.6), "m12-7mm": (7.2, 4, 8.0),
}
TELECENTRIC = {"telecentric-0.5x": (0.5, 8, 11.0), "telecentric-0.25x": (0.25, 8, 8.0)}


class MachineVision(ProgramTest):
    def last_field(self, lens, *options):
        return self.json_of("lens", "illumination", lens, "--wavelengths", "587.56", *options)["rows"][-1]

    def test_focal_length_stop_and_image_circle(self):
        """The circle: chief rays of the last field land half of it from the axis, in light. Figures are rounded to two digits."""
        for name, (efl, stop, circle) in (LENSES | PATENTS).items():
            with self.subTest(lens=name):
                info = self.json_of("lens", "info", name)
                self.assertAlmostEqual(info["efl_mm"] / efl, 1, delta=1e-4)
                self.assertAlmostEqual(info["f_number"] / stop, 1, delta=0.02)
                edge = self.last_field(name)
                self.assertAlmostEqual(2 * edge["real_image_height_mm"], circle, delta=0.05)
                self.assertTrue(edge["lit"])

    def test_sharpness_over_the_circle(self):
        """What one buys such a lens for: the RMS spot of the reference wavelength is within two pixels of 3.45 um on the axis,
        and in the field of those that were optimised, within four."""
        for name in LENSES:
            with self.subTest(lens=name):
                rows = self.json_of("lens", "spots", name, "--wavelengths", "587.56")["rows"]
                self.assertLess(rows[0]["rms_radius_um"], 6.9)
                if "scaled to" not in next(row["source"] for row in self.json_of("lens", "list", name)["rows"]):
                    self.assertLess(max(row["rms_radius_um"] for row in rows), 13.8)

    def test_telecentric_lenses_keep_their_scale(self):
        for name, (scale, stop, circle) in TELECENTRIC.items():
            with self.subTest(lens=name):
                info = self.json_of("lens", "info", name)
                self.assertAlmostEqual(abs(info["magnification"]), scale, delta=1e-4 * scale)
                self.assertAlmostEqual(info["working_f_number"], stop, delta=0.01)
                near, far = (self.last_field(name, "--set", f"object_distance_mm={info['object_distance_mm'] + shift}")
                             for shift in (-5, 5))
                self.assertAlmostEqual(2 * abs(near["real_image_height_mm"]), circle, delta=0.05)
                # Chief rays in front of the lens are parallel to the axis within 0.15 degrees; a pinhole's at this place
                # in the field slope by 4 and more.
                slope = (near["real_image_height_mm"] - far["real_image_height_mm"]) / scale / 10
                self.assertLess(abs(math.degrees(math.atan(slope))), 0.15)
                rows = self.json_of("lens", "distortion", name, "--wavelengths", "587.56")["rows"]
                self.assertLess(max(abs(row["distortion_percent"]) for row in rows), 0.1)
        # Refocused by moving the sensor, they see as wide a field at another distance.
        for distance in ("290mm", "298.44mm", "320mm"):
            seen = self.json_of("lens", "for-sensor", "telecentric-0.5x", "--sensor", "icx625-mono", "--distance", distance)["rows"][0]
            # 2448 pixels of 3.45 um, twice as wide in the object; a pinhole would see a tenth more.
            self.assertAlmostEqual(seen["width_mm"] / (2448 * 3.45e-3 * 2), 1, delta=1e-2)
            # A blur of a pixel at f/8 on the sensor, four times as deep in the object (the square of the scale).
            depth = seen["depth_of_field_geometric"]
            self.assertAlmostEqual((depth["far_m"] - depth["near_m"]) / (2 * 3.45e-6 * 8 * 4), 1, delta=0.02)

    def test_list_by_words(self):
        names = {row["name"] for row in self.json_of("lens", "list", "machine vision")["rows"]}
        self.assertEqual(names, set(LENSES) | set(PATENTS) | set(TELECENTRIC))
        self.assertEqual({row["name"] for row in self.json_of("lens", "list", "TELECENTRIC")["rows"]}, set(TELECENTRIC))
        self.assertIn("afocal", self.petzval("lens", "list", "telecentric").stdout)
        afocal = self.json_of("lens", "for-sensor", "telecentric-0.5x", "--sensor", "icx625-mono", "--distance", "298.44mm")["rows"][0]
        self.assertEqual([afocal["efl_mm"], afocal["f_number"], afocal["hyperfocal_m"]], [None, None, None])
        self.assertNotIn("telecentric", self.petzval("lens", "list", "teaching").stdout)
        self.assert_refused("lens", "list", "periscope", words=["machine vision"])


if __name__ == "__main__":
    unittest.main()
