# SPDX-License-Identifier: BSD-3-Clause
"""A panorama through a published fisheye of 220 degrees: stars in front, at the side and behind land, wavelength by
wavelength, where `lens distortion` and `lens spots` have the middle of their light.
"""

import math
import unittest

import numpy as np

from petzval_cli import ProgramTest

LENS = "us-3524697"
ROWS = 1800  # of the panorama: samples of 0.1 degrees
PITCH_MM, SIDE = 0.06, 620  # 37.2 mm: the image circle of 107 degrees has 34.1 mm
SIGMA = math.radians(0.5)  # of the stars: one and a half pixels
REACH = 5  # standard deviations that a star has
FIELDS, AZIMUTHS = (35, 70, 89, 96, 103), (20, 95, 165, 240, 310)  # degrees; azimuths from the right upwards
WAVES = (486.1327, 587.5618, 656.2725)


def direction(field, azimuth):
    """Unit vectors x right, y up, z ahead, of angles in radians."""
    return np.stack(np.broadcast_arrays(np.sin(field) * np.cos(azimuth), np.sin(field) * np.sin(azimuth),
                                        np.cos(field)), axis=-1)


def star(directions, field, azimuth):
    """Radiance of a star. By the chord, which keeps its digits at small angles."""
    angle = 2 * np.arcsin(np.linalg.norm(directions - direction(field, azimuth), axis=-1) / 2)
    return np.exp(-(angle / SIGMA) ** 2 / 2) * (angle < REACH * SIGMA)


def panorama():
    step = math.pi / ROWS
    longitude = (np.arange(2 * ROWS) + 0.5) * step - math.pi
    latitude = math.pi / 2 - (np.arange(ROWS)[:, None] + 0.5) * step
    samples = np.stack(np.broadcast_arrays(np.cos(latitude) * np.sin(longitude), np.sin(latitude),
                                           np.cos(latitude) * np.cos(longitude)), axis=-1)
    stars = sum(star(samples, field, azimuth) for field, azimuth in zip(np.radians(FIELDS), np.radians(AZIMUTHS)))
    return np.repeat(stars[:, :, None], len(WAVES), axis=2).astype("f4")


class Fisheye(ProgramTest):
    def curves(self, field):
        """About a field: polynomials in the angle [radians] of where the light of a point has its middle [mm from the axis],
        and of how much it is, for each wavelength."""
        near = field + np.linspace(-1, 1, 9) * math.degrees(REACH * SIGMA)
        ask = ("--fields", ",".join(map(str, near)), "--wavelengths", ",".join(map(str, WAVES)))

        def column(command, key, *options):
            rows = self.json_of("lens", command, LENS, *ask, *options)["rows"]
            return np.array([[row[key] for row in rows if row["wavelength_nm"] == wave] for wave in WAVES])
        middle = column("spots", "centroid_um", "--by-light") / 1000 + column("distortion", "image_height_mm")
        angle = np.radians(near - field)
        return [(np.polyfit(angle, m, 5), np.polyfit(angle, g, 5))
                for m, g in zip(middle, column("illumination", "g_source_sr"))]

    def expected(self, field, azimuth, curves):
        """Centroid of a star's light [mm], x to the right and y up: summed over the sphere about it."""
        height, light = curves
        step = SIGMA / 8
        theta = np.arange(-REACH * SIGMA, REACH * SIGMA, step)[:, None] + step / 2
        phi = azimuth + theta.T / math.sin(field)
        weight = (star(direction(field + theta, phi), field, azimuth) * np.sin(field + theta) * np.polyval(light, theta))
        radius = np.polyval(height, theta)
        return (weight * radius * np.cos(phi)).sum() / weight.sum(), (weight * radius * np.sin(phi)).sum() / weight.sum()

    def test_stars_land_where_rays_do_up_to_103_degrees_from_the_axis(self):
        np.save(self.folder / "stars.npy", panorama())
        self.assert_succeeds("image", "stars.npy", "--scene-projection", "equirectangular", "--scene-quantity", "radiance",
                             "--scene-bands", ",".join(map(str, WAVES)), "--lens", LENS, "--sensor",
                             f"{SIDE}x{SIDE}@{PITCH_MM * 1e3}", "--method", "none", "-o", "seen.npy")
        seen = np.load(self.folder / "seen.npy").astype("f8")
        place = np.arange(SIDE) + 0.5
        for field, azimuth in zip(FIELDS, np.radians(AZIMUTHS)):
            for band, curves in enumerate(self.curves(field)):
                x, y = self.expected(math.radians(field), azimuth, curves)
                column, row = SIDE / 2 + x / PITCH_MM, SIDE / 2 - y / PITCH_MM
                near = np.hypot(place[None, :] - column, place[:, None] - row) < 14
                light = seen[:, :, band] * near
                found = (light.sum(axis=0) @ place / light.sum(), light.sum(axis=1) @ place / light.sum())
                # A hundredth of a pixel; at 103 degrees the colours lie 1.1 pixels apart.
                message = f"{field} degrees, {WAVES[band]} nm"
                self.assertAlmostEqual(found[0], column, delta=0.01, msg=message)
                self.assertAlmostEqual(found[1], row, delta=0.01, msg=message)


if __name__ == "__main__":
    unittest.main()
