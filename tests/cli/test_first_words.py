# SPDX-License-Identifier: BSD-3-Clause
"""What people type first works, or the error names what would."""

import unittest

from petzval_cli import ProgramTest


class FirstWords(ProgramTest):
    def test_the_name_alone_prints_the_help(self):
        done = self.petzval()
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout, self.petzval("--help").stdout)

    def test_what_works(self):
        self.assert_succeeds("lens", "scale", "double-gauss", "--efl", "12", "-o", "small.json")
        self.assertAlmostEqual(self.json_of("lens", "info", "small.json")["efl_mm"], 12, delta=1e-9)
        self.assert_succeeds("lens", "convert", "double-gauss", "near.json", "--focus", "4m")
        near = self.json_of("lens", "info", "near.json")
        self.assertAlmostEqual(near["object_distance_mm"] + near["total_track_mm"], 4000, delta=1e-6)
        self.assert_succeeds("lens", "draw", "double-gauss")
        self.assertTrue((self.folder / "double-gauss.svg").exists())
        names = [row["name"] for row in self.json_of("glass", "list", "sk16")["rows"]]
        self.assertTrue(names and all("SK16" in name for name in names), names)
        rows = self.json_of("lens", "mtf", "cooke-triplet", "--sensor", "320x240@5", "--wavelengths", "550")["rows"]
        self.assertEqual(sorted({row["frequency_cpmm"] for row in rows}), [25, 50, 100], "Nyquist is 1 / (2 x 5 um)")
        self.assertEqual(sorted({row["field"] for row in rows}), [0, 0.5, 1])
        seen = self.json_of("lens", "info", "edmund-54852", "--sensor", "320x240@5")["sensor_view"]
        # 1.6 mm at |m| = 0.02395 is 66.8 mm, and a barrel sees more.
        self.assertTrue(66.8 < seen["width_mm"] < 1.06 * 66.8, seen)

    def test_times_of_exposure(self):
        shot = ["image", "wall", "--lens", "dgauss-50mm", "--sensor", "third-inch-1280x960", "--method", "none",
                "--wavelengths", "450,550,650", "--scene-size", "8x6", "--scene-angle", "40", "-o", "shot.dng"]
        for word, seconds in (("1ms", 1e-3), ("1/1000", 1e-3), ("500us", 5e-4), ("0.25s", 0.25), ("1/4s", 0.25)):
            self.assertAlmostEqual(self.json_of(*shot, "--exposure", word)["exposure_s"], seconds, delta=1e-12)
        for word in ("1min", "1/0", "/2", "ms"):
            self.assert_refused(*shot, "--exposure", word, words=["10ms", "1/100"])

    def test_image_prints_what_sense_prints(self):
        shot = ["image", "wall", "--lens", "dgauss-50mm", "--sensor", "third-inch-1280x960", "--method", "none",
                "--wavelengths", "450,550,650", "--scene-size", "8x6", "--scene-angle", "40", "--exposure", "10ms"]
        levels = self.json_of(*shot, "-o", "shot.dng", "-o", "light.exr")["levels"]
        sensed = self.json_of("sense", "light.exr", "--sensor", "third-inch-1280x960", "--exposure", "10ms", "-o", "again.dng")
        self.assertEqual(levels, sensed["rows"])

    def test_what_would_be_right_is_named(self):
        for words, right in ((["lens", "mtf", "double-gauss", "--object-distance", "400"], "--focus 400mm"),
                             (["render", "spheres", "--scale", "2", "-o", "x.png"], "--size"),
                             (["image", "simens", "--lens", "double-gauss", "-o", "x.png"], "siemens"),
                             (["image", "usaf1951", "--lens", "double-gauss", "--scene-width", "24mm", "-o", "x.png"],
                              "--scene-distance"),
                             (["image", "wall", "--lens", "double-gauss", "--sensor", "64x48@4", "--exposure", "1ms",
                               "-o", "x.exr"], "third-inch-1280x960"),
                             (["lens", "scale", "double-gauss", "-o", "x.json"], "--efl")):
            self.assert_refused(*words, words=[right])

    def test_other_trades_words(self):
        self.write("room.pbrt", "WorldBegin\n")
        self.assert_refused("image", "room.pbrt", "--lens", "double-gauss", "-o", "x.png", words=["petzval render"])
        rows = self.json_of("lens", "steps", "double-gauss", "--wavelength", "450,550")["rows"]
        self.assertEqual({row["wavelength_nm"] for row in rows}, {450, 550})
        backwards = self.json_of("lens", "steps", "dgauss-50mm", "--film-height", "10", "--stop", "0,0.5")["rows"]
        self.assertEqual([row["surface"] for row in backwards], [str(i) for i in range(10, -1, -1)])
        self.assert_refused("lens", "steps", "dgauss-50mm", "--stop", "0,0.95", words=["surfaces[6]", "mm beyond its clear aperture"])
        self.assert_refused("lens", "steps", "dgauss-50mm", "--wavelength", "blue", words=["blue"])
        self.assert_refused("lens", "steps", "dgauss-50mm", "--field", "40", words=["smaller field"])

    def test_an_object_that_moves_alone_is_noted(self):
        done = self.petzval("lens", "info", "cooke-triplet", "--set", "object_distance_mm=400")
        self.assertIn("--focus", done.stderr)
        done = self.petzval("lens", "info", "edmund-54852", "--set", "object_distance_mm=251")
        self.assertNotIn("object has moved", done.stderr)

    def test_the_sensor_in_the_paraxial_image(self):
        last = 10  # its last surface
        info = self.json_of("lens", "info", "double-gauss", "--set", f"surfaces[{last}].thickness_mm=paraxial")
        other = self.json_of("lens", "info", "double-gauss", "--focus", "paraxial")
        self.assertAlmostEqual(info["total_track_mm"], other["total_track_mm"], delta=1e-9)
        self.assert_refused("lens", "info", "double-gauss", "--set", "surfaces[2].thickness_mm=paraxial",
                            words=[f"surfaces[{last}]"])

    def test_sensors(self):
        rows = self.json_of("sensor", "list")["rows"]
        self.assertIn("icx625-mono", [row["name"] for row in rows])
        info = self.json_of("sensor", "info", "icx625-mono")
        # The EMVA 1288 figures of the sheet: 57 %, 5903 e, 8.28 e; 20 log(5903/8.28) = 57.06 dB.
        self.assertEqual(info["rows"][0]["peak_quantum_efficiency"], 0.57)
        self.assertEqual(info["gain_modes"][0]["saturation_e"], 5903)
        self.assertAlmostEqual(info["gain_modes"][0]["dynamic_range_db"], 57.06, delta=0.02)
        self.assertFalse(self.json_of("sensor", "info", "64x48@4")["counts_photons"])
        self.assert_refused("sensor", "info", "icx62-mono", words=["icx625-mono"])


if __name__ == "__main__":
    unittest.main()
