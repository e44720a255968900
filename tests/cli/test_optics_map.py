# SPDX-License-Identifier: BSD-3-Clause
"""petzval optics import of maps: PSFs over the frame as NumPy arrays."""

import unittest

import h5py
import numpy as np

from petzval_cli import ProgramTest

PITCH_UM, SPACING_UM = 5, 1.25
X_MM, Y_MM = np.array([-0.3, 0, 0.3]), np.array([-0.25, 0, 0.25])


def windows(share):
    """A Gaussian of one pixel at the place, and a share of it one pixel below and two to the right. share: (rows, columns)."""
    down, right = (np.indices((49, 49)) - 24) * SPACING_UM / PITCH_UM
    here, there = (np.exp(-((down - d) ** 2 + (right - r) ** 2) / 2) for d, r in ((0, 0), (1, 2)))
    return ((1 - share)[..., None, None] * here + share[..., None, None] * there)[:, :, None]


class Map(ProgramTest):
    def write_map(self, name, share=np.zeros((3, 3)), **arrays):
        numbers = {"psf": windows(share), "x_mm": X_MM, "y_mm": Y_MM, "wavelengths_nm": [550.0], "spacing_um": SPACING_UM,
                   "focal_length_mm": 8, "f_number": 4, **arrays}
        np.savez(self.folder / name, **{key: value for key, value in numbers.items() if value is not None})

    def picture(self, name, scene="points:9", take=(), words=()):
        self.assert_succeeds("optics", "import", name + ".npz", *take, "--quiet", "-o", name + ".h5")
        angle = () if scene == "wall" else ("--scene-angle", "2", "--surround", "zero")
        self.assert_succeeds("image", scene, "--optics", name + ".h5", "--sensor", f"64x48@{PITCH_UM}", "--wavelengths", "550",
                             *angle, *words, "--quiet", "-o", name + ".npy")
        return np.load(self.folder / (name + ".npy")).astype("f8").reshape(48, 64)

    def assert_close(self, one, other, bound):
        inner = np.s_[4:-4, 4:-4]
        self.assertLess(np.linalg.norm((one - other)[inner]), bound * np.linalg.norm(other[inner]))

    def test_light_lies_as_in_the_picture(self):
        self.write_map("sharp.npz")
        self.write_map("moved.npz", np.full((3, 3), 0.3))
        # Wavelengths may be left out of the shape where there is one; only sums of light are relative.
        self.write_map("again.npz", psf=7 * windows(np.full((3, 3), 0.3))[:, :, 0])
        sharp, moved = self.picture("sharp"), self.picture("moved")
        self.assertGreater(sharp.max(), 10 * np.median(sharp), "stars")
        self.assert_close(moved, 0.7 * sharp + 0.3 * np.roll(sharp, (1, 2), (0, 1)), 2e-3)  # the tolerance of either
        self.assert_succeeds("optics", "import", "again.npz", "--quiet", "-o", "again.h5")
        one, other = (h5py.File(self.folder / (name + ".h5"))["psf"][...] for name in ("again", "moved"))
        self.assertLess(np.abs(one - other).max(), 1e-6 * other.max())

    def test_places_lie_as_in_the_picture(self):
        # Between places PSFs are mixed about the centres of their light: many places make that small.
        x_mm, y_mm = np.linspace(-0.3, 0.3, 13), np.linspace(-0.25, 0.25, 11)
        self.write_map("sharp.npz")
        self.write_map("varied.npz", 0.5 + 0.2 / 0.3 * x_mm[None, :] + 0.2 / 0.25 * y_mm[:, None], x_mm=x_mm, y_mm=y_mm)
        cells = ("--supersample", "3")
        sharp = self.picture("sharp", words=cells)
        x, y = (((np.arange(n) + 0.5) - n / 2) * PITCH_UM * 1e-3 for n in (64, 48))
        of_pixel = 0.5 + 0.2 / 0.3 * x[None, :] + 0.2 / 0.25 * y[:, None]
        # A star spreads over a pixel, over which the share changes by 0.005.
        self.assert_close(self.picture("varied", words=cells), (1 - of_pixel) * sharp + np.roll(of_pixel * sharp, (1, 2), (0, 1)), 7e-3)

    def test_a_wall_is_lit_as_the_map_says(self):
        share = np.tile([0.1, 0.5, 0.9], (3, 1))
        light = np.tile([1.0, 0.8, 0.6], (3, 1))
        self.write_map("wall.npz", share, relative_illumination=light)
        wall = self.picture("wall", scene="wall")
        x = ((np.arange(64) + 0.5) - 32) * PITCH_UM * 1e-3
        relative = wall / (0.8 - 0.2 / 0.3 * x)
        # Light moves by up to 0.01 mm, by 0.013 of a mm more for every mm; the rest is of second order.
        self.assertLess(np.ptp(relative[4:-4, 4:-4]), 1e-3 * relative.mean())
        # Of object points, the light goes where the PSFs send it.
        points = self.picture("wall", scene="wall", take=("--relative-illumination", "source"))
        stretch = (points / wall)[4:-4, 4:-4].mean()
        self.assertAlmostEqual(stretch, 1 - 0.01 * 0.8 / 0.6 + 0.01 * 0.5 * 0.2 / 0.3 / 0.8, delta=1e-3)

    def test_distortion(self):
        self.write_map("plain.npz")
        y, x = np.meshgrid(Y_MM, X_MM, indexing="ij")
        self.write_map("small.npz", paraxial_x_mm=1.1 * x, paraxial_y_mm=1.1 * y)
        cells = ("--supersample", "2")
        rows, columns = np.indices((48, 64)) - np.array([23.5, 31.5])[:, None, None]

        def radius(picture):
            return np.sqrt((picture * (rows ** 2 + columns ** 2)).sum() / picture.sum())

        self.assertAlmostEqual(radius(self.picture("plain", words=cells)) / radius(self.picture("small", words=cells)), 1.1, delta=0.003)

    def test_refusals_name_the_array(self):
        bad = windows(np.zeros((3, 3)))
        bad[0, 2, 0, 1, 1] = -1
        for arrays, words in (({"spacing_um": None}, ["spacing_um"]), ({"spacing_um": 0.0}, ["spacing_um", "above 0"]),
                              ({"x_mm": X_MM[::-1]}, ["x_mm", "increase"]), ({"x_mm": X_MM[:2]}, ["psf", "(3, 2, 1, height, width)"]),
                              ({"psf": bad}, ["psf", "[0, 2, 0]", "row 2, column 2"]),
                              ({"psf": bad * np.nan}, ["psf", "finite"]), ({"psf": 0 * bad}, ["[0, 0, 0]"]),
                              ({"f_number": None}, ["f-number"]), ({"focal_length_mm": None}, ["focal_length_mm"]),
                              ({"relative_illumination": np.ones(3)}, ["relative_illumination", "(3, 3"]),
                              ({"wavelengths_nm": [0.55]}, ["nm"])):
            self.write_map("bad.npz", **arrays)
            self.assert_refused("optics", "import", "bad.npz", "-o", "bad.h5", words=["bad.npz", *words])
        self.write_map("bad.npz")
        self.assert_refused("optics", "import", "bad.npz", "--psf-away", "up", "-o", "bad.h5", words=["psf-away"])
        self.write("bad.npz", "no archive")
        self.assert_refused("optics", "import", "bad.npz", "-o", "bad.h5", words=["bad.npz"])


if __name__ == "__main__":
    unittest.main()
