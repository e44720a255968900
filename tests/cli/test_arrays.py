# SPDX-License-Identifier: BSD-3-Clause
"""Arrays that NumPy reads and writes: PSFs with their axes, irradiance to be sensed."""

import unittest

import numpy as np
from petzval_cli import ProgramTest


class Arrays(ProgramTest):
    def test_psfs_of_all_fields_and_wavelengths_with_their_axes(self):
        self.assert_succeeds("lens", "psf", "edmund-54852", "--fields", "0,3", "--wavelengths", "486,587,656", "-o", "psf.npz")
        with np.load(self.folder / "psf.npz") as stack:
            arrays = dict(stack)
        psf = arrays["psf"]
        np.testing.assert_allclose(psf.sum(axis=(2, 3)), 1, atol=1e-5)
        self.assertEqual(list(arrays["wavelengths_nm"]), [486, 587, 656])
        fields, = [name for name in arrays if name.startswith("paraxial_image_height")]
        self.assertEqual(list(arrays[fields]), [0, 3])
        self.assertEqual(psf.shape, (2, 3, len(arrays["tangential_um"]), len(arrays["sagittal_um"])))
        self.assertEqual(arrays["tangential_um"][psf.shape[2] // 2], 0)
        # Each is the PSF that the same grid gives alone.
        row, = self.json_of("lens", "psf", "edmund-54852", "--fields", "3", "--wavelengths", "587", "--size", str(psf.shape[2]),
                            "--spacing", repr(float(arrays["tangential_um"][1] - arrays["tangential_um"][0])), "-o", "one.npy")["rows"]
        np.testing.assert_allclose(psf[1, 1], np.load(self.folder / "one.npy"), atol=1e-6 * psf.max())
        self.assertAlmostEqual(arrays["real_image_height_mm"][1, 1], row["real_image_height_mm"], delta=1e-9)

    def test_light_made_by_numpy_is_sensed(self):
        """25 x 20 pixels of E at 550 nm: electrons by hand are E A t λ QE/(hc)."""
        sensor = ["--sensor", "icx625-mono", "--exposure", "0.01", "--seed", "3", "-o", "raw.npy", "--json"]
        light = np.full((20, 25, 3), 1e-4)
        np.save(self.folder / "light.npy", light)
        np.savez_compressed(self.folder / "light.npz", irradiance=light, wavelengths_nm=[540, 550, 560], pitch_um=3.45)
        bare = self.json_of("sense", "light.npy", "--wavelengths", "540,550,560", *sensor[:-1])
        raw = np.load(self.folder / "raw.npy")
        packed = self.json_of("sense", "light.npz", *sensor[:-1])
        np.testing.assert_array_equal(raw, np.load(self.folder / "raw.npy"))
        self.assertEqual(bare["rows"], packed["rows"])
        self.assertGreater(raw.mean(), 10)
        # image writes the same archive; what is sensed from it is what is sensed from OpenEXR.
        self.assert_succeeds("image", "wall", "--lens", "double-gauss", "--sensor", "icx625-mono", "--sensor-set", "columns=12",
                             "--sensor-set", "rows=9", "--wavelengths", "540,550,560", "--method", "none", "-o", "a.npz", "-o",
                             "a.exr", "--quiet")
        raws = []
        for name in ("a.npz", "a.exr"):
            self.assert_succeeds("sense", name, *sensor)
            raws.append(np.load(self.folder / "raw.npy"))
        np.testing.assert_array_equal(*raws)

    def test_text_beside_the_light_is_left_out(self):
        light = {"irradiance": np.full((4, 5, 1), 1e-4), "wavelengths_nm": [550], "pitch_um": 3.45}
        sense = ["sense", "light.npz", "--sensor", "icx625-mono", "-o", "raw.npy"]
        for text in ("night", b"night", np.array(["night"], ">U5"), np.array([b"a", b"bc"])):
            np.savez(self.folder / "light.npz", note=text, **light)
            self.assert_succeeds(*sense)
        np.savez(self.folder / "light.npz", **{**light, "irradiance": np.array([b"night"])})
        self.assert_refused(*sense, words=["light.npz", "irradiance"])

    def test_arrays_that_are_no_light(self):
        sense = ["--sensor", "icx625-mono", "-o", "raw.npy"]
        np.save(self.folder / "light.npy", np.ones((4, 5, 3)))
        self.assert_refused("sense", "light.npy", *sense, words=["--wavelengths"])
        self.assert_refused("sense", "light.npy", "--wavelengths", "500,600", *sense, words=["3 bands", "2 wavelengths"])
        np.savez(self.folder / "light.npz", radiance=np.ones((4, 5, 3)))
        self.assert_refused("sense", "light.npz", *sense, words=["irradiance", "radiance"])
        np.savez(self.folder / "light.npz", irradiance=np.full((4, 5, 1), np.nan), wavelengths_nm=[550])
        self.assert_refused("sense", "light.npz", *sense, words=["row"])
        self.write("light.npz", "no archive")
        self.assert_refused("sense", "light.npz", *sense, words=["light.npz"])


if __name__ == "__main__":
    unittest.main()
