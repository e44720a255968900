# SPDX-License-Identifier: BSD-3-Clause
"""`petzval image`, from a file that no part of Petzval wrote to files that no part of Petzval reads."""

import struct
import unittest

import numpy

from petzval_cli import ProgramTest
from sample_files import spectral_exr

BANDS = [500, 550, 600]
CAMERA = ["--lens", "edmund-54852", "--sensor", "64x48@10"]
# 250 mm before vertex 1, which is 14.3085 mm before the sensor: where the prescription has its object.
SCENE = ["--scene-angle", "12", "--scene-distance", "0.26430847m"]


class Pictures(ProgramTest):
    def take(self, value, *options, outputs=("out.npy",)):
        """The picture of a 120 x 90 scene, (rows, columns, bands), in W m⁻² nm⁻¹."""
        self.write("scene.exr", spectral_exr(120, 90, BANDS, value))
        arguments = [word for output in outputs for word in ("-o", output)]
        self.assert_succeeds("image", "scene.exr", *CAMERA, *SCENE, *options, *arguments)
        return numpy.load(self.folder / outputs[0])

    def test_a_uniform_scene_gives_radiance_times_g(self):
        """Irradiance = L · g_sensor, band by band. Here it is about the level that leaves the program: the tolerance is small
        against every factor that could be forgotten (π, n², (1 − m)² = 1.05); tests/physics is about the digits."""
        radiance = [0.02, 0.05, 0.03]
        picture = self.take(lambda row, column, band: radiance[band])
        self.assertEqual(picture.shape, (48, 64, 3))
        axis = self.json_of("lens", "illumination", "edmund-54852", "--field-type", "real_image_height_mm", "--fields", "0",
                            "--wavelengths", "500,550,600")["rows"]
        for band, row in enumerate(axis):
            self.assertAlmostEqual(picture[:, :, band].mean() / (radiance[band] * row["g_sensor_sr"]), 1, delta=4e-3)

    def test_pictures_are_upright(self):
        """A bright patch in the upper left of the scene, blue-green on the left and red on the right, stays there."""

        def value(row, column, band):
            upper = 20 <= row < 40
            left = 30 <= column < 50
            right = 70 <= column < 90
            return 1.0 if upper and ((left and band == 0) or (right and band == 2)) else 0.001

        picture = self.take(value)
        for band, is_left in ((0, True), (2, False)):
            row, column = numpy.unravel_index(picture[:, :, band].argmax(), picture.shape[:2])
            self.assertLess(row, 24)
            self.assertEqual(column < 32, is_left)

    def test_the_same_bytes_for_any_number_of_threads(self):
        outputs = ("out.npy", "out.exr", "out.png")
        made = []
        for threads in ("1", "2"):
            self.take(lambda row, column, band: 0.01 + 0.001 * ((row * 7 + column * 3 + band) % 11), "--threads", threads,
                      outputs=outputs)
            made.append({name: self.contents()[name] for name in outputs})
        self.assertEqual(made[0], made[1])

    def test_png_of_both_depths(self):
        for bits in (8, 16):
            self.take(lambda row, column, band: 0.01, "--bits", str(bits), outputs=("out.npy", "out.png"))
            header = (self.folder / "out.png").read_bytes()[:26]
            self.assertEqual(header[:8], b"\x89PNG\r\n\x1a\n")
            width, height, depth, colour_type = struct.unpack(">IIBB", header[16:26])
            self.assertEqual((width, height, depth, colour_type), (64, 48, bits, 2))

    def test_lens_and_stored_table_agree(self):
        """A picture through a table on disk is the picture through the lens that the table was built from."""

        def value(row, column, band):
            return 0.01 if (row // 8 + column // 8) % 2 else 0.05

        direct = self.take(value)
        self.assert_succeeds("optics", "build", "edmund-54852", "--sensor", "64x48@10", "--wavelengths",
                             ",".join(map(str, BANDS)), "-o", "table.h5")
        self.assert_succeeds("image", "scene.exr", "--optics", "table.h5", "--sensor", "64x48@10", *SCENE,
                             "-o", "stored.npy")
        stored = numpy.load(self.folder / "stored.npy")
        # The tables may reach to different fields, so that their PSFs lie at different heights.
        self.assertLess(numpy.abs(stored - direct).max() / direct.max(), 2e-3)

    def test_nodes_and_tiles_are_heeded_or_said_not_to_be(self):
        shot = ["image", "siemens", "--lens", "edmund-54852", "--sensor", "64x48@10", "--wavelengths", "550", "-o", "light.npy"]
        method = lambda *options: self.json_of(*shot, *options)["method"]
        self.assertIn("4 x 4 nodes in tiles of 60 x 60", method("--nodes", "4", "--tile", "60"))
        self.assertIn("5 x 5 nodes", method("--nodes", "5"))
        done = self.petzval(*shot, "--tile", "1000")
        self.assertIn("blended sections", done.stdout)
        self.assertIn("--tile had no effect", done.stderr)
        self.assertNotIn("no effect", self.petzval(*shot).stderr)

    def test_insets_stand_beside_the_picture(self):
        shot = ["image", "points:3", *CAMERA, "--wavelengths", "550"]
        self.assert_succeeds(*shot, "-o", "plain.png")
        self.assert_succeeds(*shot, "--inset", "centre,8", "--inset", "bottom-left", "-o", "beside.png")
        size = lambda name: struct.unpack(">II", (self.folder / name).read_bytes()[16:24])
        self.assertEqual(size("plain.png"), (64, 48))
        columns, rows = size("beside.png")
        self.assertGreater(columns, 64 + 120)
        self.assertGreater(rows, 240, "two insets, one above the other")
        self.assert_refused(*shot, "--inset", "centre", "-o", "light.exr", words=["--inset", ".png"])
        self.assert_refused(*shot, "--inset", "70,10", "-o", "x.png", words=["70,10", "64 x 48"])
        self.assert_refused(*shot, "--inset", "up", "-o", "x.png", words=["310,20", "top-right"])
        raw = ["image", "wall", "--lens", "dgauss-50mm", "--sensor", "third-inch-1280x960", "--sensor-set", "columns=64",
               "--sensor-set", "rows=48", "--wavelengths", "450,550,650"]
        self.assert_succeeds(*raw, "--inset", "10,10", "-o", "shot.png", "-o", "shot.dng")
        self.assert_succeeds("develop", "shot.dng", "--inset", "10,10", "-o", "again.png", "-o", "plain.npy")
        self.assertEqual(size("shot.png"), size("again.png"))
        self.assertEqual(numpy.load(self.folder / "plain.npy").shape[:2], (48, 64), "numbers stay what they are")
        self.assert_refused("develop", "shot.dng", "--inset", "10,10", "-o", "x.npy", words=["--inset"])


if __name__ == "__main__":
    unittest.main()
