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
                             (["image", "wall", "--lens", "double-gauss", "--sensor", "imx363", "--size", "200x150", "-o", "x.png"],
                              "--sensor-set columns=200"),
                             (["lens", "for-sensor", "double-gauss", "--sensor", "imx250", "--distance", "1m"], "2448x2048@3.45"),
                             (["lens", "dof", "double-gauss"], "lens for-sensor"),
                             (["mtf", "double-gauss"], "lens mtf"),
                             (["lens", "scale", "double-gauss", "-o", "x.json"], "--efl")):
            self.assert_refused(*words, words=[right])

    def test_sharpness_of_a_sweep(self):
        """The folder of a sweep is measured picture by picture, and its contact sheet is none of them."""
        self.assert_succeeds("sweep", "image", "slanted-edge", "--lens", "double-gauss", "--sensor", "64x48@5", "--wavelengths", "550",
                             "--method", "none", "--vary", "f-number=5.6,8", "-o", "edges")
        self.assertTrue((self.folder / "edges" / "contact-sheet.png").exists())
        self.assert_refused("sfr", "edges", words=["none of the 2 pictures", "clipped"])  # white is the brightest pixel

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

    def test_the_light_that_glasses_are_known_for(self):
        """Within the range of the list the index is known, beyond its ends it is not."""
        rows = {row["name"]: row for row in self.json_of("lens", "list")["rows"]}
        self.assertIsNone(rows["tessar"]["longest_nm"], "one index a glass: any light")
        for name in ("cooke-triplet", "edmund-54852", "infrared-50mm"):
            shortest, longest = rows[name]["shortest_nm"], rows[name]["longest_nm"]
            for nm in (shortest, longest):
                self.assert_succeeds("lens", "info", name, "--wavelength", nm)
            for nm in (shortest - 1, longest + 1):
                self.assert_refused("lens", "info", name, "--wavelength", nm, words=["valid from"])

    def test_light_that_a_sensor_is_blind_to(self):
        shot = ["image", "wall", "--lens", "double-gauss", "--sensor", "icx625-mono", "--sensor-set", "columns=8", "--sensor-set",
                "rows=6", "--method", "none", "--exposure", "1ms", "-o", "shot.dng"]
        self.assertIn("does not see the light at 850 nm", self.petzval(*shot, "--wavelengths", "850", "--illuminant", "LED-850").stderr)
        self.assertNotIn("does not see", self.petzval(*shot, "--wavelengths", "660", "--illuminant", "660nm/20").stderr)

    def test_the_report_has_the_table_of_for_sensor(self):
        common = ["--sensor", "320x240@5", "--wavelengths", "550"]
        self.assert_succeeds("lens", "report", "double-gauss", "--distance", "1m", "--fields", "0", *common, "-o", "r.html")
        page = (self.folder / "r.html").read_text()
        self.assertIn("Which lens for", page)
        row, = self.json_of("lens", "for-sensor", "double-gauss", "--distance", "1m", "--sensor", "320x240@5")["rows"]
        self.assertIn(f"{row['width_mm']:.4g} x {row['height_mm']:.4g}", page)
        self.assertIn(f"{row['per_pixel'] if 'per_pixel' in row else row['mm_per_pixel']:.4g}", page)
        self.assert_refused("lens", "report", "double-gauss", "--distance", "1m", "-o", "r.html", words=["--sensor"])

    def test_glasses_are_substituted_in_the_lens_that_has_them(self):
        two = ["lens", "for-sensor", "double-gauss", "cooke-triplet", "--sensor", "64x48@50", "--distance", "2m", "--wavelengths", "850"]
        self.assert_refused(*two, words=["--substitute HIKARI:SK16="])
        self.assert_succeeds(*two, "--substitute", "HIKARI:SK16=SUMITA:K-SK16RH")
        self.assert_refused(*two[:-2], "--substitute", "FOO=SCHOTT:N-BK7", words=["none of the lenses", "FOO"])

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

    def test_machine_vision_sensors_give_their_sheets_back(self):
        """EMVA 1288 sheets: of the IMX900 by FRAMOS, of the IMX174 by Point Grey. Dynamic range and greatest SNR are no entries
        of the files: they follow. The variance turns up to 6 % below the full well, and the noise in the dark is known to 1 %."""
        for sensor, mode, gain, noise_e, full_e, range_db, snr_db in (
                ("imx900-mono", "low", 0.399, 5.560, 9458, 63.8, 39.76),
                ("imx900-mono", "high", 1.673, 1.954, 2183, 59.0, 33.39),
                ("imx174-colour", "base", 1 / 0.51 / 16, 6.83, 32691, 73, 45.12)):
            with self.subTest(sensor=sensor, mode=mode):
                found = self.json_of("measure", "sensor", sensor, "--conversion-gain", mode, "--quiet")
                self.assertAlmostEqual(found["dn_per_e"] / gain, 1, delta=0.01)
                self.assertAlmostEqual(found["dark_noise_e"] / noise_e, 1, delta=0.02)
                self.assertTrue(0.94 * full_e < found["saturation_e"] <= 1.01 * full_e, found["saturation_e"])
                self.assertAlmostEqual(found["dynamic_range_db"], range_db, delta=1)
                self.assertAlmostEqual(found["snr_max_db"], snr_db, delta=0.3)
        # The sheet has 91.25 % at 536 nm; a colour camera's green is the monochrome 77 % behind a filter that passes 98 %.
        grey = self.json_of("sensor", "info", "imx900-mono")["rows"][0]
        self.assertAlmostEqual(grey["peak_quantum_efficiency"], 0.9125, delta=0.02)
        green = [row for row in self.json_of("sensor", "info", "imx174-colour")["rows"] if row["channel"] == "green"]
        self.assertAlmostEqual(green[0]["peak_quantum_efficiency"], 0.77 * 0.98, delta=0.01)


if __name__ == "__main__":
    unittest.main()
