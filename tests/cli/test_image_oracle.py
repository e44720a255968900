# SPDX-License-Identifier: BSD-3-Clause
"""petzval image against a sum over the PSFs of its table, written here: numpy and the HDF5 file, nothing of the library.

Light that falls on a place q of the sensor is the integral over the image x of the chief rays of
L(scene at x) g_source(x) PSF_x(q - x), and a pixel has its mean. Fields lie so close that PSFs between two are mixed linearly."""

import math
import unittest

import h5py
import numpy as np

from petzval_cli import ProgramTest

COLUMNS, ROWS, PITCH_UM = 240, 180, 7.5
SCENE_COLUMNS, SCENE_ROWS, SCENE_DEG = 400, 300, 22.0
PIXELS = 60
# The sum's own error: with steps of 0.5 and points of 5 it is 1.1e-3, which steps and points of these sizes make four times
# smaller.
STEP_UM, POINTS, SUM_ERROR = 0.3, 8, 5e-4


class Oracle:
    def __init__(self, path):
        with h5py.File(path) as file:
            self.height_um = 1e3 * file["real_image_height"][:, 0]
            self.tangent = np.tan(np.radians(file["object_field"][...]))
            self.g_source = file["g_source"][:, 0]
            self.psf = file["psf"][:, 0].astype(float)
            self.spacing_um = file["psf_spacing"][:, 0]
        self.psf /= self.psf.sum(axis=(1, 2), keepdims=True) * self.spacing_um[:, None, None] ** 2  # per um2
        self.half = self.psf.shape[-1] // 2
        self.reach_um = self.half * self.spacing_um.max()

    def spread(self, field, s, t):
        """PSF [1/um2] of each field at (s, t), bilinear between samples."""
        size = self.psf.shape[-1]
        i, j = t / self.spacing_um[field] + self.half, s / self.spacing_um[field] + self.half
        inside = (i >= 0) & (j >= 0) & (i < size - 1) & (j < size - 1)
        i, j, field = i[inside], j[inside], field[inside]
        row, column = i.astype(int), j.astype(int)
        a, b = i - row, j - column
        values = np.zeros(inside.shape)
        values[inside] = ((1 - a) * ((1 - b) * self.psf[field, row, column] + b * self.psf[field, row, column + 1])
                          + a * ((1 - b) * self.psf[field, row + 1, column] + b * self.psf[field, row + 1, column + 1]))
        return values

    def pixel(self, column, row, radiance, step_um=STEP_UM, points=POINTS):
        """Irradiance of a pixel. Along columns and rows of the picture; PSFs turn with the azimuth."""
        def centre(at, count):
            return (at + 0.5 - count / 2) * PITCH_UM
        x0, y0 = centre(column, COLUMNS), centre(row, ROWS)
        reach = self.reach_um + PITCH_UM
        offsets = (np.arange(-reach, reach, step_um)) + step_um / 2
        x, y = (v.ravel() for v in np.meshgrid(x0 + offsets, y0 + offsets))
        height = np.hypot(x, y)
        # Over height, both cubic enough between 121 fields to be linear in its square and in itself.
        tangent = np.interp(height, self.height_um, self.tangent / np.maximum(self.height_um, 1e-9)
                            * (self.height_um > 0) + (self.height_um == 0) * self.tangent[1] / self.height_um[1])
        light = radiance(x * tangent, y * tangent) * np.interp(height, self.height_um, self.g_source) * step_um ** 2
        low = np.clip(np.searchsorted(self.height_um, height) - 1, 0, len(self.height_um) - 2)
        share = np.clip((height - self.height_um[low]) / (self.height_um[low + 1] - self.height_um[low]), 0, 1)
        away = np.where(height > 0, x / height, 0), np.where(height > 0, y / height, 1)
        nodes, weights = np.polynomial.legendre.leggauss(points)
        total = 0.0
        for dx, wx in zip(nodes, weights):
            for dy, wy in zip(nodes, weights):
                u, v = x0 + dx * PITCH_UM / 2 - x, y0 + dy * PITCH_UM / 2 - y
                t, s = u * away[0] + v * away[1], u * away[1] - v * away[0]  # PSFs are mirror symmetric about t
                spread = (1 - share) * self.spread(low, s, t) + share * self.spread(low + 1, s, t)
                total += wx * wy / 4 * (light * spread).sum()
        return total


class ImageOracle(ProgramTest):
    def scene(self):
        """Fine texture and coarse steps; bilinear between the middles of samples, as SCENES.md defines it."""
        rng = np.random.default_rng(18)
        rows, columns = np.mgrid[:SCENE_ROWS, :SCENE_COLUMNS]
        values = 0.2 + 0.6 * ((rows // 7 + columns // 5) % 2) + 0.4 * rng.random((SCENE_ROWS, SCENE_COLUMNS))
        np.save(self.folder / "scene.npy", values.astype(np.float32)[:, :, None])
        tangent_per_sample = 2 * math.tan(math.radians(SCENE_DEG / 2)) / SCENE_COLUMNS

        def radiance(across, down):
            i = np.clip(down / tangent_per_sample + SCENE_ROWS / 2 - 0.5, 0, SCENE_ROWS - 1.001)
            j = np.clip(across / tangent_per_sample + SCENE_COLUMNS / 2 - 0.5, 0, SCENE_COLUMNS - 1.001)
            row, column = i.astype(int), j.astype(int)
            a, b = i - row, j - column
            return ((1 - a) * ((1 - b) * values[row, column] + b * values[row, column + 1])
                    + a * ((1 - b) * values[row + 1, column] + b * values[row + 1, column + 1]))
        return radiance

    def test_picture_is_the_sum_over_psfs(self):
        radiance = self.scene()
        self.assert_succeeds("optics", "build", "edmund-54852", "--wavelengths", "550", "--fields", "121", "--focus", "infinity",
                             "--sensor", f"{COLUMNS}x{ROWS}@{PITCH_UM}", "-o", "table.h5")
        oracle = Oracle(self.folder / "table.h5")
        rng = np.random.default_rng(1)
        places = [(int(rng.integers(COLUMNS)), int(rng.integers(ROWS))) for _ in range(PIXELS)]
        expected = np.array([oracle.pixel(*place, radiance) for place in places])
        for tolerance in (1e-2, 1e-3, 3e-4):
            self.assert_succeeds("image", "scene.npy", "--scene-bands", "550", "--scene-quantity", "radiance", "--scene-angle",
                                 str(SCENE_DEG), "--optics", "table.h5", "--sensor", f"{COLUMNS}x{ROWS}@{PITCH_UM}",
                                 "--tolerance", str(tolerance), "-o", "image.npy")
            image = np.load(self.folder / "image.npy")[:, :, 0].astype(float)
            found = np.array([image[row, column] for column, row in places])
            off = np.sqrt(((found - expected) ** 2).sum() / (expected ** 2).sum())
            self.assertLess(off, tolerance + SUM_ERROR)


if __name__ == "__main__":
    unittest.main()
