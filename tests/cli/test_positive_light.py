# SPDX-License-Identifier: BSD-3-Clause
"""Light is never negative and none is lost: points of light through every bundled lens."""

import unittest

import numpy

from petzval_cli import ProgramTest


class PositiveLight(ProgramTest):
    def camera(self, name):
        """A lens with a small frame that takes seven tenths of its field, in light of its own wavelength."""
        info = self.json_of("lens", "info", name)
        nm = info["wavelength_nm"]
        last = self.json_of("lens", "illumination", name, "--wavelengths", nm, "--apertures", "from-fields")["rows"][-1]
        share = 0.7 if info["field_of_view_deg"] < 100 else 0.3
        pitch_um = share * abs(last["real_image_height_mm"]) / 30 * 1000  # 30 pixels from the middle of 48 x 36 to a corner
        words = ["--lens", name, "--sensor", f"48x36@{pitch_um:.4g}", "--wavelengths", nm, "--illuminant", "6000K", "--apertures",
                 "from-fields"]
        return words if info["object_distance_mm"] is None else words + ["--focus", "design"]

    def light(self, scene, *words):
        said = self.json_of("image", scene, *words, "-o", "light.npy")
        return numpy.load(self.folder / "light.npy").astype(float), said

    def test_of_every_bundled_lens(self):
        for row in self.json_of("lens", "list")["rows"]:
            with self.subTest(lens=row["name"]):
                camera = self.camera(row["name"])
                light, said = self.light("points:5", *camera, "--tolerance", 1e-2)
                # 1e-6 of the peak is the rounding of numbers of 32 bits that are added up.
                self.assertGreaterEqual(light.min(), -1e-6 * light.max())
                self.assertGreater(light.max(), 0)
                # Points well within the frame: what arrives with blur is what arrives without, for a PSF sums to 1. Outside the
                # PSF's window there is nothing to lose; vignetting is given to the light before. A part in a thousand is the
                # tolerance of the blur.
                within = [*camera, "--scene-angle", 0.4 * said["scene_angle_deg"], "--surround", "zero"]
                blurred, _ = self.light("points:3", *within, "--tolerance", 1e-3)
                sharp, _ = self.light("points:3", *within, "--method", "none", "--supersample", 3)
                self.assertAlmostEqual(blurred.sum() / sharp.sum(), 1, delta=1e-3)
                self.assertGreaterEqual(blurred.min(), -1e-6 * blurred.max())

    def test_of_a_students_lens_at_any_tolerance(self):
        """Plain coma with a core: the lens whose light went down to -1 % of its peak."""
        self.write("sing.json", """{"format": "petzval-lens/1", "name": "s", "source": "s", "object_distance_mm": null,
            "aperture": {"f_number": 4}, "fields": {"type": "angle_deg", "values": [0, 2]}, "wavelengths_nm": [587],
            "reference_wavelength_nm": 587, "surfaces": [
            {"radius_mm": null, "thickness_mm": 1, "stop": true},
            {"radius_mm": 51.5, "conic": -0.6, "thickness_mm": 4, "glass": "SCHOTT:N-BK7", "semi_diameter_mm": 14},
            {"radius_mm": null, "thickness_mm": 97.02, "semi_diameter_mm": 14}]}""")
        for tolerance in (3e-2, 1e-2, 3e-3, 1e-3, 3e-4):
            with self.subTest(tolerance=tolerance):
                light, said = self.light("points:5", "--lens", "sing.json", "--sensor", "160x120@8", "--wavelengths", 587,
                                         "--tolerance", tolerance)
                self.assertGreaterEqual(light.min(), -1e-6 * light.max())
                self.assertLessEqual(said["estimated_error"], tolerance)


if __name__ == "__main__":
    unittest.main()
