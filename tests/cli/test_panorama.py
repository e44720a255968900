# SPDX-License-Identifier: BSD-3-Clause
"""A panorama through the bundled fisheye: points land where `lens distortion` says."""

import math
import struct
import unittest

import petzval_cli
import spectral_files

ROWS, PITCH_MM, SIDE = 900, 0.1, 300


class Panorama(petzval_cli.ProgramTest):
    def stars(self, directions):
        """An array of 2 ROWS x ROWS samples with a Gaussian star of 0.6 degrees about each (longitude, latitude)."""
        step, sigma = math.pi / ROWS, math.radians(0.6)
        values = [0.0] * (2 * ROWS * ROWS)
        for longitude, latitude in directions:
            star = vector(longitude, latitude)
            middle = round((math.pi / 2 - latitude) / step)
            for row in range(max(0, middle - 20), min(ROWS, middle + 20)):
                for column in range(2 * ROWS):
                    place = vector((column + 0.5) * step - math.pi, math.pi / 2 - (row + 0.5) * step)
                    cosine = sum(a * b for a, b in zip(star, place))
                    if cosine > 0.998:
                        angle = math.acos(min(1, cosine)) / sigma
                        values[row * 2 * ROWS + column] += math.exp(-angle * angle / 2)
        return spectral_files.npy((ROWS, 2 * ROWS), values)

    def test_points_land_where_lens_distortion_says(self):
        azimuths = [math.radians(a) for a in (10, 130, 250)]  # from the right upwards
        fields = [20, 45, 70]
        directions = []
        for field, azimuth in zip(fields, azimuths):
            x, y = math.sin(math.radians(field)) * math.cos(azimuth), math.sin(math.radians(field)) * math.sin(azimuth)
            directions.append((math.atan2(x, math.cos(math.radians(field))), math.asin(y)))
        self.write("stars.npy", self.stars(directions))
        self.assert_succeeds("image", "stars.npy", "--scene-projection", "equirectangular", "--scene-quantity", "radiance",
                             "--scene-bands", 550, "--lens", "fisheye-10mm", "--sensor", f"{SIDE}x{SIDE}@{PITCH_MM * 1e3}",
                             "--method", "none", "-o", "stars_seen.npy")
        pixels = struct.unpack(f"<{SIDE * SIDE}f", (self.folder / "stars_seen.npy").read_bytes()[-4 * SIDE * SIDE:])
        rows = self.json_of("lens", "distortion", "fisheye-10mm", "--fields", ",".join(map(str, fields)),
                            "--wavelengths", 550)["rows"]
        for row, azimuth in zip(rows, azimuths):
            radius = row["image_height_mm"] / PITCH_MM
            column, line = SIDE / 2 + radius * math.cos(azimuth), SIDE / 2 - radius * math.sin(azimuth)
            near = [(pixels[r * SIDE + c], c + 0.5, r + 0.5) for r in range(int(line) - 8, int(line) + 9)
                    for c in range(int(column) - 8, int(column) + 9)]
            light = sum(value for value, _, _ in near)
            # The light of a point has its centre a little beyond its chief ray, and the map is curved.
            self.assertAlmostEqual(sum(v * c for v, c, _ in near) / light, column, delta=0.1, msg=row)
            self.assertAlmostEqual(sum(v * r for v, _, r in near) / light, line, delta=0.1, msg=row)

    def test_what_does_not_fit_is_refused(self):
        self.write("a.npy", spectral_files.npy((2, 4), [1.0] * 8))
        ask = ("image", "a.npy", "--scene-quantity", "radiance", "--scene-bands", 550, "--lens", "fisheye-10mm", "-o", "b.png")
        around = ("--scene-projection", "equirectangular")
        self.assert_refused(*ask, *around, words=["--sensor"])
        self.assert_refused(*ask, *around, "--sensor", "40x40@500", "--scene-angle", 30, words=["--scene-angle"])
        self.assert_refused(*ask, *around, "--sensor", "40x40@500", "--scene-distance", "3m", words=["infinity"])
        self.assert_refused(*ask, "--scene-angle", 30, "--scene-yaw", 3, words=["--scene-yaw"])
        self.assert_refused(*ask, *around, "--scene-pitch", "up", words=["--scene-pitch"])
        self.write("a.npy", spectral_files.npy((2, 3), [1.0] * 6))
        self.assert_refused(*ask, *around, "--sensor", "40x40@500", words=["3 x 2", "twice"])


def vector(longitude, latitude):
    return (math.cos(latitude) * math.sin(longitude), math.sin(latitude), math.cos(latitude) * math.cos(longitude))


if __name__ == "__main__":
    unittest.main()
