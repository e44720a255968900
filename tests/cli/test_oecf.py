# SPDX-License-Identifier: BSD-3-Clause
"""measure oecf: a ColorChecker's greys, photographed twice, against sRGB's curve; and what it refuses."""

import unittest

from petzval_cli import ProgramTest


def decoded(code):
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


class Oecf(ProgramTest):
    def test_greys_of_developed_pictures_lie_on_the_curve_of_srgb(self):
        self.assert_succeeds("image", "colorchecker", "--lens", "edmund-54852", "--sensor", "240x160@3.75", "--method",
                             "none", "--wavelengths", "400:20:700", "--quiet", "-o", "chart.exr")
        for seed in ("1", "2"):
            self.assert_succeeds("sense", "chart.exr", "--sensor", "third-inch-1280x960", "--illuminant", "D65", "--seed",
                                 seed, "--quiet", "-o", f"{seed}.dng")
            self.assert_succeeds("develop", f"{seed}.dng", "--quiet", "-o", f"{seed}.png")
        told = self.json_of("measure", "oecf", "1.png", "2.png", "--csv", "oecf.csv")
        rows = told["rows"]
        self.assertEqual(len(rows), 6)
        # Light over reflectance is the same for all greys: 2 % for the matrix, and half a code of 8 bits.
        levels = [decoded(0.2125 * r["red_level"] + 0.7154 * r["green_level"] + 0.0721 * r["blue_level"]) for r in rows]
        scale = levels[-1] / rows[-1]["exposure"]
        for row, light in zip(rows, levels):
            self.assertAlmostEqual(light / (scale * row["exposure"]), 1, delta=0.02 + 0.002 / row["exposure"])
            self.assertGreater(row["temporal_snr"], 5)
        self.assertEqual(len((self.folder / "oecf.csv").read_text().splitlines()), 7)
        self.assert_refused("measure", "oecf", "1.png", words=("two at least",))
        self.assert_refused("measure", "oecf", "1.dng", "2.dng", words=("--patches",))
        self.assert_refused("measure", "oecf", "1.dng", "2.png", words=("one kind",))


if __name__ == "__main__":
    unittest.main()
