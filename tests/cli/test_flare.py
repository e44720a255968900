# SPDX-License-Identifier: BSD-3-Clause
"""Light that goes astray: petzval image --ghosts, --sun and their layers."""

import math
import unittest

from petzval_cli import ProgramTest
from test_image import read_npy

SHOT = ["image", "wall", "--lens", "cooke-triplet", "--sensor", "60x40@500", "--wavelengths", "450,550,650", "--method", "none",
        "--surround", "extend"]
PIXEL_M2 = (500e-6)**2


class Flare(ProgramTest):
    def light(self, *options):
        self.assert_succeeds(*SHOT, *options, "-o", "light.npy")
        return read_npy(self.folder / "light.npy")[1]

    def test_the_picture_without_is_the_picture_less_the_layer(self):
        plain = self.light()
        sun = self.light("--sun", "8,5")
        both = self.light("--sun", "8,5", "--ghosts", "--ghost-layer", "ghosts.npy")
        shape, ghosts = read_npy(self.folder / "ghosts.npy")
        self.assertEqual(shape, (40, 60, 3))
        self.assertGreater(sum(ghosts), 0)
        for with_ghosts, layer, without in zip(both, ghosts, sun):
            self.assertAlmostEqual(with_ghosts - layer, without, delta=1e-6 * with_ghosts)
        # The same command without the options gives the same light as ever where there is no sun.
        self.assertGreater(sum(a == b for a, b in zip(plain, sun)), 0.99 * len(plain))

    def test_a_sun_sheds_what_the_entrance_pupil_takes(self):
        plain, sun = self.light(), self.light("--sun", "8,5:50000")
        taken = (sum(sun) - sum(plain)) * PIXEL_M2
        info = self.json_of("lens", "info", "cooke-triplet")
        radius_m = info["entrance_pupil"]["diameter_mm"] / 2e3
        cosine = 1 / math.sqrt(1 + math.tan(math.radians(8))**2 + math.tan(math.radians(5))**2)
        pupil_m2 = math.pi * radius_m**2 * cosine
        # Planck's law at 5772 K, scaled to 50000 lx: the bands of the program against 380 to 780 nm by Gauss curves of the
        # observer (Wyman, Sloan & Shirley 2013), which are good to a per cent; vignetting and pupil aberration take some more.
        def planck(nm):
            return nm**-5 / (math.exp(14387.77e3 / (nm * 5772)) - 1)

        def y_bar(nm):
            def lobe(middle, left, right):
                return math.exp(-0.5 * ((nm - middle) / (left if nm < middle else right))**2)
            return 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1)
        lux = 683 * sum(planck(nm) * y_bar(nm) for nm in range(380, 781))
        # Each band shares the light between it and its neighbours out in hats, at its middle one per nm.
        expected = sum(planck(nm) * 50000 / lux for nm in (450, 550, 650)) * pupil_m2
        self.assertAlmostEqual(taken / expected, 1, delta=0.08)

    def test_a_bright_sample_of_the_scene_is_found(self):
        said = self.json_of("image", "points:5", "--scene-angle", "30", "--lens", "cooke-triplet", "--sensor", "60x40@500",
                            "--wavelengths", "550", "--surround", "extend", "--ghosts", "--ghost-threshold", "20", "-o", "points.npy")
        flare = said["flare"]
        self.assertGreater(len(flare["sources"]), 0)
        self.assertLessEqual(flare["neglected_share"], 1e-4)
        self.assertGreater(len(flare["pairs"]), 5)
        # The most light first.
        light = [pair["flux_w_per_nm"] for pair in flare["pairs"]]
        self.assertEqual(light, sorted(light, reverse=True))
        self.assertAlmostEqual(sum(light) / flare["flux_w_per_nm"], 1, delta=1e-9)

    def test_refuses_what_makes_no_sense(self):
        for options, words in ((["--sun", "8"], "20,15"), (["--sun", "95,0"], "80"), (["--sun", "3,4:0"], "more than 0"),
                               (["--sun", "3,4", "--sun-light", "850nm"], "no eye sees"), (["--sun-diameter", "1"], "--sun"),
                               (["--ghost-neglect", "0.5"], "--ghosts"), (["--ghost-threshold", "5"], "--starburst"), (["--ghosts", "--ghost-neglect", "2"], "0 to less than 1"),
                               (["--ghost-reflections", "4"], "--ghosts"), (["--ghosts", "--ghost-reflections", "3"], "2,4"),
                               (["--ghost-layer", "ghosts.png"], ".exr")):
            self.assert_refused(*SHOT, *options, "-o", "light.npy", words=(words,))

    def test_a_table_has_no_surfaces_that_reflect(self):
        self.assert_succeeds("optics", "build", "cooke-triplet", "--wavelengths", "550", "--sensor", "60x40@500", "-o", "t.h5")
        self.assert_refused("image", "wall", "--optics", "t.h5", "--sensor", "60x40@500", "--wavelengths", "550", "--ghosts", "-o",
                            "light.npy", words=("--lens",))

    def test_a_way_of_four_reflections_is_listed_and_drawn(self):
        rows = self.json_of("lens", "ghosts", "cooke-triplet", "--ghost-reflections", "4", "--wavelengths", "550")["rows"]
        four = [row for row in rows if row["third_surface"] != "-"]
        self.assertGreater(len(four), 0)
        self.assertEqual(len(rows) - len(four), 15)
        self.assertLess(max(row["irradiance"] for row in four), max(row["irradiance"] for row in rows))
        self.assert_succeeds("lens", "ghosts", "cooke-triplet", "--draw", "5,0,4,1", "--fields", "0", "-o", "way.svg")
        self.assertIn("5, 0, 4 and 1", (self.folder / "way.svg").read_text())
        for way in ("5,0,4", "5,0,0,1", "0,5", "5,0,4,4", "5,x"):
            self.assert_refused("lens", "ghosts", "cooke-triplet", "--draw", way, "-o", "way.svg", words=("two such pairs",))


if __name__ == "__main__":
    unittest.main()
