# SPDX-License-Identifier: BSD-3-Clause
"""Scattered light: petzval image --scatter, lens glare, and scatter in lens files."""

import json
import unittest

from petzval_cli import ProgramTest
from test_image import read_npy

SHOT = ["image", "points:3", "--scene-angle", "40", "--lens", "cooke-triplet", "--sensor", "60x40@500", "--wavelengths", "450,650",
        "--method", "none", "--surround", "extend"]
SCATTER = ["--scatter", "roughness=4,dust=0.05"]


class Scatter(ProgramTest):
    def light(self, *options):
        self.assert_succeeds(*SHOT, *options, "-o", "light.npy")
        return read_npy(self.folder / "light.npy")[1]

    def test_the_picture_without_is_the_picture_less_the_layer(self):
        plain = self.light()
        both = self.light(*SCATTER, "--scatter-layer", "layer.npy")
        shape, layer = read_npy(self.folder / "layer.npy")
        self.assertEqual(shape, (40, 60, 2))
        for with_scatter, part, without in zip(both, layer, plain):
            self.assertAlmostEqual(with_scatter - part, without, delta=1e-6 * max(plain))
        # Bright points lose; dark places gain; blue more than red, as the inverse square of the wavelength.
        self.assertLess(min(layer), 0)
        dark = [i for i in range(0, len(plain), 2) if plain[i] == 0]
        self.assertTrue(all(layer[i] > 0 for i in dark))
        said = self.json_of(*SHOT, *SCATTER, "-o", "light.npy")["flare"]["scatter"]
        self.assertGreater(said["scattered_share"], said["returned_share"])

    def test_a_lens_file_says_it_as_the_option_does(self):
        self.assert_succeeds("lens", "convert", "cooke-triplet", "mine.json")
        lens = json.loads((self.folder / "mine.json").read_text())
        lens["scatter"] = {"roughness_nm": 4, "dust_percent": 0.05}
        (self.folder / "mine.json").write_text(json.dumps(lens))
        self.assert_succeeds("lens", "convert", "mine.json", "again.json")
        self.assertEqual(json.loads((self.folder / "again.json").read_text())["scatter"], lens["scatter"])
        by_option = self.light(*SCATTER)
        shot = [each if each != "cooke-triplet" else "again.json" for each in SHOT]
        self.assert_succeeds(*shot, "--scatter", "lens", "-o", "file.npy")
        self.assertEqual(by_option, read_npy(self.folder / "file.npy")[1])
        # A surface's own comes first.
        self.assert_succeeds(*shot, "--scatter", "lens", "--set", 'surfaces[0].scatter={"roughness_nm": 8}', "-o", "own.npy")
        self.assertNotEqual(by_option, read_npy(self.folder / "own.npy")[1])
        self.assert_refused("lens", "info", "again.json", "--set", 'surfaces[0].scatter={"roughness_nm": -1}',
                            words=("surfaces[0].scatter", "more than 0"))
        self.assert_refused("lens", "info", "again.json", "--set", 'scatter={"rough": 1}', words=("roughness_nm",))

    def test_glare_of_a_tilted_lens_turns_with_it(self):
        row = {}
        for azimuth, tilt in ((0, "tilt_x_deg"), (90, "tilt_y_deg")):
            row[azimuth] = self.json_of("lens", "glare", "cooke-triplet", "--set",
                                        f'groups=[{{"surfaces":[2,3],"pose":{{"{tilt}":3}}}}]', "--scatter", "roughness=2",
                                        "--fields", "0,15", "--wavelengths", "550", "--field-azimuth", str(azimuth))["rows"][1]
        for name, value in row[0].items():
            if value is not None:
                # The grids of rays turn into themselves. At 270 degrees 1.5 % less is scattered.
                self.assertAlmostEqual(row[90][name], value, delta=1e-3 * abs(value), msg=name)

    def test_glare_as_a_table_a_drawing_and_for_programs(self):
        said = self.json_of("lens", "glare", "cooke-triplet", "--scatter", "roughness=2", "--fields", "0,15", "--ghosts",
                            "--plot", "glare.svg")
        self.assertIn("<svg", (self.folder / "glare.svg").read_text())
        for row in said["rows"]:
            self.assertGreater(row["scatter_percent"], 0)
            self.assertGreater(row["ghosts_percent"], 0)
            self.assertAlmostEqual(row["veiling_glare_index_percent"], row["scatter_percent"] + row["ghosts_percent"], places=9)
        # Half the roughness, a quarter of the veil (to first order in the share).
        less = self.json_of("lens", "glare", "cooke-triplet", "--scatter", "roughness=1", "--fields", "0,15", "--ghosts")
        self.assertAlmostEqual(said["rows"][0]["scatter_percent"] / less["rows"][0]["scatter_percent"], 4, delta=0.02)
        spread = [row["glare_spread_per_mm2"] for row in said["spread_rows"] if row["field"] == 0]
        self.assertEqual(spread, sorted(spread, reverse=True))

    def test_a_measured_curve(self):
        (self.folder / "bsdf.csv").write_text("angle_deg,bsdf_per_sr\n0.5,0.05\n5,0.002\n60,1e-5\n")
        said = self.json_of("lens", "glare", "cooke-triplet", "--scatter", "table=bsdf.csv,wavelength=550", "--fields", "0,15")
        self.assertGreater(said["rows"][0]["veiling_glare_index_percent"], 0)

    def test_refuses_what_makes_no_sense(self):
        for options, words in ((["--scatter", "2"], "roughness=1.5"), (["--scatter", "roughness=-2"], "more than 0"),
                               (["--scatter", "rough=2"], "roughness"), (["--scatter", "lens"], "roughness=1.5"),
                               (["--scatter", "dust=50"], "0 to 10"), (["--scatter", "table=none.csv"], "none.csv"),
                               (["--scatter-layer", "layer.npy"], "--scatter"), (["--scatter-surround", "mean"], "--scatter"),
                               ([*SCATTER, "--scatter-layer", "layer.png"], ".exr"),
                               (["--scatter", "b0=100,l=1"], "less than all")):
            self.assert_refused(*SHOT, *options, "-o", "light.npy", words=(words,))
        self.assertIn("--scatter", self.assert_succeeds("lens", "glare", "cooke-triplet", "--fields", "0,15"))
        for options, words in ((["--scatter", "roughness=1", "--hole", "60"], "up to 50"),
                               (["--scatter", "roughness=1", "--surround-angle", "85"], "less than 80"),
                               (["--scatter", "roughness=1", "--fields", "0"], "second field")):
            self.assert_refused("lens", "glare", "cooke-triplet", *options, words=(words,))


if __name__ == "__main__":
    unittest.main()
