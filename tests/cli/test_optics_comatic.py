# SPDX-License-Identifier: BSD-3-Clause
"""A strongly comatic lens, examples/comatic_table.py: the error that `image --tolerance` allows, against the exact method."""

import math
import pathlib
import subprocess
import sys
import unittest

import numpy as np

from petzval_cli import ProgramTest
from sample_files import spectral_exr

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "comatic_table.py"
ROWS, COLUMNS = 120, 160
# The flare is 45 um long in the corners, nine pixels.
OPTIONS = ["--optics", "comatic.h5", "--sensor", "128x96@5", "--wavelengths", "550", "--scene-angle", "5",
           "--scene-distance", "inf", "--quiet"]


class Comatic(ProgramTest):
    def setUp(self):
        super().setUp()
        subprocess.run([sys.executable, EXAMPLE, "made.h5"], cwd=self.folder, check=True)
        self.assert_succeeds("optics", "import", "made.h5", "-o", "comatic.h5")

    def check(self, values):
        self.write("scene.exr", spectral_exr(COLUMNS, ROWS, [550], lambda row, column, band: values[row, column]))
        cells = ["--supersample", 2]  # the same for both: what the blur alone misses
        self.assert_succeeds("image", "scene.exr", *OPTIONS, *cells, "--method", "exact", "-o", "exact.npy")
        for tolerance in (1e-2, 1e-3, 1e-4):
            self.assert_succeeds("image", "scene.exr", *OPTIONS, *cells, "--tolerance", tolerance, "-o", "product.npy")
            error = self.json_of("compare", "product.npy", "exact.npy")["relative_l2"]
            self.assertLessEqual(error, tolerance)

    def test_texture(self):
        self.check(np.random.default_rng(1857).random((ROWS, COLUMNS)))

    def test_tilted_checkerboard(self):
        row, column = np.indices((ROWS, COLUMNS))
        across, down = 0.97 * column - 0.25 * row, 0.25 * column + 0.97 * row
        self.check(np.where((np.rint(across / 9) + np.rint(down / 9)) % 2 == 0, 1.0, 0.02))

    def test_a_wall_shows_no_ring(self):
        """g is the same at every height and the flare grows in proportion to it: nothing may show on a wall."""
        self.write("wall.exr", spectral_exr(COLUMNS, ROWS, [550], lambda row, column, band: 1.0))
        for method in (["--method", "exact"], ["--tolerance", "1e-4"]):
            self.assert_succeeds("image", "wall.exr", *OPTIONS, *method, "-o", "wall.npy")
            wall = np.load(self.folder / "wall.npy")
            self.assertLess(np.ptp(wall) / wall.mean(), 1e-3)  # the aim for walls

    def test_the_flare_points_away_and_opens(self):
        """A star to the right: the centre of its light lies A beyond the chief ray, and it is wider behind than before."""
        values = np.zeros((121, 161))
        values[60, 120] = 1
        self.write("star.exr", spectral_exr(161, 121, [550], lambda row, column, band: values[row, column]))
        self.assert_succeeds("image", "star.exr", *OPTIONS, "-o", "s.npy")
        picture = np.load(self.folder / "s.npy")[:, :, 0]
        rows, columns = np.indices(picture.shape) + 0.5
        middle = (columns * picture).sum() / picture.sum()
        chief_mm = 10 * math.tan(math.radians(2.5)) * (120.5 - 80.5) / 80.5
        flare_mm = 0.045 * chief_mm / 0.56  # 3 A
        # In pixels, to a twentieth: the star is one sample of the scene, seen through cells of another size.
        self.assertAlmostEqual(middle, 64 + (chief_mm + flare_mm / 3) / 0.005, delta=0.05)
        self.assertAlmostEqual((rows * picture).sum() / picture.sum(), 48, delta=0.05)
        before, behind = columns < middle, columns >= middle
        spread = [np.sqrt((picture * (rows - 48) ** 2)[part].sum() / picture[part].sum()) for part in (before, behind)]
        self.assertGreater(spread[1], 1.2 * spread[0])


if __name__ == "__main__":
    unittest.main()
