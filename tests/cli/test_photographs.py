# SPDX-License-Identifier: BSD-3-Clause
"""Photographs as scenes, from files written byte by byte."""

import unittest

import petzval_cli
import picture_files
import sample_files


def decoded(value):
    """sRGB to linear light (IEC 61966-2-1), 0 to 1."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


class Photographs(petzval_cli.ProgramTest):
    def test_greys_of_every_kind_of_file(self):
        """The darker of two greys has its share of the brighter one's radiance."""
        grey8, grey16 = [255, 100], [65535, 25700]
        rgb8, rgb16 = [255] * 3 + [100] * 3, [65535] * 3 + [25700] * 3
        files = {
            "grey8.png": picture_files.png(2, 1, 1, 8, grey8),
            "grey16.png": picture_files.png(2, 1, 1, 16, grey16),
            "rgb8.png": picture_files.png(2, 1, 3, 8, rgb8),
            "rgb16.png": picture_files.png(2, 1, 3, 16, rgb16),
            "grey8.tif": picture_files.tiff(2, 1, 1, 8, grey8),
            "rgb16.tif": picture_files.tiff(2, 1, 3, 16, rgb16),
            "motorola.tiff": picture_files.tiff(2, 1, 3, 16, rgb16, ">"),
            "grey.jpg": picture_files.grey_jpeg([255, 100]),
        }
        for name, content in files.items():
            with self.subTest(name):
                self.write(name, content)
                facts = self.json_of("scene", "info", name, "--illuminant", "E", "--scene-luminance", 50)
                share = facts["min_radiance"] / facts["max_radiance"]
                self.assertAlmostEqual(share, decoded(100 / 255), delta=1e-6)
                self.assertEqual(facts["bands"], 31)
                self.assertEqual((facts["columns"], facts["rows"]), (16, 8) if name == "grey.jpg" else (2, 1))
                # The bands from 400 to 700 nm hold all but 2e-3 of what the eye sees.
                self.assertAlmostEqual(facts["mean_luminance_cd_m2"], 50, delta=0.1)
                linear = self.json_of("scene", "info", name, "--scene-encoding", "linear", "--illuminant", "E")
                self.assertAlmostEqual(linear["min_radiance"] / linear["max_radiance"], 100 / 255, delta=1e-6)

    def test_a_photograph_through_a_lens(self):
        self.write("lens.json", sample_files.singlet())
        self.write("red.png", picture_files.png(64, 48, 3, 8, [200, 60, 40] * (64 * 48)))
        done = self.petzval("image", "red.png", "--lens", "lens.json", "--sensor", "32x24@20", "--wavelengths",
                            "450,550,650", "--method", "none", "-o", "red.exr", "--illuminant", "A")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        self.assertRegex(done.stdout, r"red, [\d.]+ degrees wide")
        self.assertIn("at infinity", done.stdout)

    def test_what_does_not_fit_is_refused(self):
        self.write("a.png", picture_files.png(2, 1, 1, 8, [255, 100]))
        self.assert_refused("scene", "info", "a.png", "--scene-size", "4x4", words=["--scene-size"])
        self.assert_refused("scene", "info", "wall", "--scene-encoding", "srgb", words=["--scene-encoding"])
        self.assert_refused("scene", "info", "a.png", "--illuminant", "candle", words=["candle"])
        for name in ("black.png", "cut.png", "cut.jpg", "cut.tif", "none.png"):
            if name == "black.png":
                self.write(name, picture_files.png(2, 1, 1, 8, [0, 0]))
            if name == "cut.png":
                self.write(name, picture_files.png(2, 1, 1, 8, [255, 100])[:-20])
            if name == "cut.jpg":
                self.write(name, picture_files.grey_jpeg([255, 100])[:-4])
            if name == "cut.tif":
                self.write(name, picture_files.tiff(2, 1, 1, 8, [255, 100])[:-8])
            self.assert_refused("scene", "info", name, words=[name])


if __name__ == "__main__":
    unittest.main()
