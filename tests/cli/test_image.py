# SPDX-License-Identifier: BSD-3-Clause
"""petzval image: from a scene and a lens to irradiance and picture, and what it refuses."""

import math
import struct
import unittest

from petzval_cli import ProgramTest

SMALL = ["--wavelengths", "587.5618", "--sensor", "64x48@25"]


def read_npy(path):
    """(shape, values) of a little-endian float32 array in C order."""
    data = path.read_bytes()
    length, = struct.unpack_from("<H", data, 8)
    header = eval(data[10:10 + length].decode(), {"__builtins__": {}})  # a literal that we wrote
    assert header["descr"] == "<f4" and not header["fortran_order"]
    count = 1
    for size in header["shape"]:
        count *= size
    return header["shape"], struct.unpack_from(f"<{count}f", data, 10 + length)


class Image(ProgramTest):
    def test_writes_every_format_and_says_what_it_made(self):
        said = self.json_of("image", "studio", "--lens", "edmund-54852", "--wavelengths", "450,550,650", "--sensor",
                            "64x48@25", "-o", "a.exr", "-o", "a.npy", "-o", "a.png", "--bits", "16")
        self.assertEqual((said["columns"], said["rows"], said["pitch_um"]), (64, 48, 25))
        self.assertEqual(said["wavelengths_nm"], [450, 550, 650])
        self.assertEqual(said["outputs"], ["a.exr", "a.npy", "a.png"])
        self.assertEqual(sorted(self.contents()), ["a.exr", "a.npy", "a.png"])
        shape, values = read_npy(self.folder / "a.npy")
        self.assertEqual(shape, (48, 64, 3))
        self.assertAlmostEqual(max(values), said["irradiance_max"], delta=1e-6 * said["irradiance_max"])
        self.assertEqual((self.folder / "a.png").read_bytes()[24], 16)

    def test_stored_table_gives_the_same_picture_as_the_lens(self):
        self.assert_succeeds("optics", "build", "edmund-54852", *SMALL, "-o", "t.h5")
        self.assert_succeeds("image", "points:5", "--lens", "edmund-54852", "--focus", "design", *SMALL,
                             "--scene-angle", "60", "-o", "lens.npy")
        self.assert_succeeds("image", "points:5", "--optics", "t.h5", *SMALL, "--scene-angle", "60", "-o", "table.npy")
        _, lens = read_npy(self.folder / "lens.npy")
        _, table = read_npy(self.folder / "table.npy")
        # The two tables end at slightly different heights, and so have their fields at different places.
        difference = sum(abs(a - b) for a, b in zip(lens, table)) / sum(lens)
        self.assertLess(difference, 0.02)

    def test_pictures_of_lights_in_darkness_keep_the_tolerance(self):
        """Beside the same with 12 cells a pixel, and a tenth of the tolerance or less."""
        for scene, lens, pitch_um, tolerance in (("stars", "dgauss-50mm", 54, 1e-2), ("points", "wide-22mm", 54, 1e-2), ("points", "edmund-54852", 7.5, 1e-3)):
            with self.subTest(scene=scene, lens=lens, tolerance=tolerance):
                common = ["image", scene, "--lens", lens, "--sensor", f"320x240@{pitch_um}", "--wavelengths", 550]
                self.assert_succeeds(*common, "--tolerance", tolerance, "-o", "asked.npy")
                self.assert_succeeds(*common, "--supersample", 12, "--tolerance", 1e-4, "-o", "finer.npy")
                (_, asked), (_, finer) = (read_npy(self.folder / name) for name in ("asked.npy", "finer.npy"))
                self.assertLess(math.dist(asked, finer), tolerance * math.hypot(*finer))

    def test_a_wall_far_away_is_one_at_infinity(self):
        def wall(lens, distance_m):
            self.assert_succeeds("image", "wall", "--lens", lens, "--sensor", "16x12@60", "--wavelengths", 550,
                                 "--scene-distance", distance_m if distance_m == "inf" else f"{distance_m}m", "-o", "wall.npy")
            return read_npy(self.folder / "wall.npy")[1]

        for lens in ("edmund-54852", "dgauss-50mm"):
            infinite = wall(lens, "inf")
            for distance_m in (50, 1e3, 1e5, 1e9):
                for got, wanted in zip(wall(lens, distance_m), infinite):
                    # Of a wall at 50 m the lens sees a thousandth less: f-numbers grow by the magnification.
                    self.assertAlmostEqual(got / wanted, 1, delta=2e-3 if distance_m < 1e3 else 2e-4, msg=distance_m)

    def test_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.assert_succeeds("image", "studio", "--lens", "double-gauss", *SMALL, "--threads", threads,
                                 "-o", f"{threads}.exr")
        files = self.contents()
        self.assertEqual(files["1.exr"], files["2.exr"])

    def test_without_a_sensor_pixels_are_the_scenes_samples(self):
        said = self.json_of("image", "checkerboard", "--lens", "double-gauss", "--wavelengths", "550", "--scene-size",
                            "120x90", "--scene-angle", "10", "-o", "a.png")
        info = self.json_of("lens", "info", "double-gauss")
        tangent = 0.08748866352592401  # tan 5°
        # The lens is refocused and used at another wavelength than its own.
        self.assertAlmostEqual(said["pitch_um"] / (info["efl_mm"] * 1000 * 2 * tangent / 120), 1, delta=0.01)
        self.assertLessEqual(said["columns"], 120)
        self.assertGreater(said["columns"], 90)

    def test_refuses_what_does_not_fit_before_it_works(self):
        lens = ["image", "studio", "--lens", "edmund-54852", *SMALL]
        self.assert_refused(*lens, "-o", "a.jpg", words=["a.jpg", ".png"])
        self.assert_refused(*lens, "-o", "nowhere/a.png", words=["nowhere"])
        self.assert_refused("image", "studio", *SMALL, "-o", "a.png", words=["--lens", "--optics"])
        self.assert_refused(*lens, "--optics", "t.h5", "-o", "a.png", words=["either"])
        self.assert_refused(*lens, "--focus", "sideways", "-o", "a.png", words=["sideways", "auto"])
        self.assert_refused(*lens, "--method", "sections", "--section", "0", "-o", "a.png", words=["sections of 0"])
        self.assert_refused(*lens, "--method", "blended", "--transform", "18", "-o", "a.png",
                            words=["transforms of 18"])
        self.assert_refused(*lens, "--transform", "64", "-o", "a.png", words=["--transform", "--method sections"])
        self.assert_refused(*lens, "--method", "exact", "--tolerance", "1e-4", "-o", "a.png",
                            words=["--tolerance", "product"])
        self.assert_refused(*lens, "--tolerance", "0", "-o", "a.png", words=["tolerance of 0"])
        self.assert_refused(*lens, "--supersample", "99", "-o", "a.png", words=["99"])
        self.assert_refused(*lens, "--fit", "17", "-o", "a.png", words=["17"])
        self.assert_refused(*lens, "--f-number", "0.5", "-o", "a.png", words=["0.5"])
        self.assert_refused(*lens, "--scene-angle", "10", "-o", "a.png", words=["falls short by", "--surround"])
        self.assert_refused("image", "studio", "--optics", "missing.h5", *SMALL, "-o", "a.png", words=["missing.h5"])
        self.assert_refused("image", "studio", "--lens", "edmund-54852", "--sensor", "0x4@6", "-o", "a.png",
                            words=["0x4@6"])

    def test_a_surround_lets_a_small_scene_pass_and_says_so(self):
        done = self.petzval("image", "wall", "--lens", "edmund-54852", *SMALL, "--scene-angle", "5", "--surround",
                            "zero", "-o", "a.npy")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("falls short by", done.stderr)
        _, values = read_npy(self.folder / "a.npy")
        self.assertLess(abs(values[0]), 1e-6 * max(values))

    def test_a_least_width_of_what_fills_the_frame(self):
        image = ["image", "wall", "--lens", "edmund-54852", *SMALL, "-o", "a.npy"]
        fills = self.json_of(*image)["scene_angle_deg"]
        self.assertEqual(self.json_of(*image, "--scene-angle-least", f"{fills - 1}")["scene_angle_deg"], fills)
        self.assertEqual(self.json_of(*image, "--scene-angle-least", f"{fills + 1}")["scene_angle_deg"], fills + 1)
        for fixed in (["--scene-angle", "60"], ["--surround", "zero"]):
            self.assert_refused(*image, *fixed, "--scene-angle-least", "50", words=["--scene-angle-least", "--scene-angle"])
        self.assert_refused(*image, "--scene-angle-least", "0", words=["--scene-angle-least", "above 0"])
        self.assert_refused(*image, "--scene-angle-least", "180", words=["180"])


if __name__ == "__main__":
    unittest.main()
