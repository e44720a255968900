# SPDX-License-Identifier: BSD-3-Clause
"""petzval compare: the numbers of differing pictures, and what cannot be compared."""

import math
import struct
import unittest

import picture_files
import spectral_files
from petzval_cli import ProgramTest


def npy(rows, columns, values, kind="<f4"):
    """The bytes of a NumPy array of one band."""
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}"
    header += " " * (63 - (10 + len(header)) % 64) + "\n"
    packed = struct.pack(f"<{len(values)}{'f' if kind == '<f4' else 'd'}", *values)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + packed


class Compare(ProgramTest):
    def array(self, name, rows, columns, values, kind="<f4"):
        (self.folder / name).write_bytes(npy(rows, columns, values, kind))

    def test_numbers_worked_out_by_hand(self):
        self.array("a.npy", 2, 2, [3, 5, -2, -12])
        self.array("b.npy", 2, 2, [3, 4, 0, -12], "<f8")
        said = self.json_of("compare", "a.npy", "b.npy")
        self.assertAlmostEqual(said["relative_l2"], math.sqrt(5) / 13, delta=1e-15)
        self.assertAlmostEqual(said["max_error_over_peak"], 2 / 12, delta=1e-15)
        self.assertAlmostEqual(said["psnr_db"], 20 * math.log10(12 / math.sqrt(5 / 4)), delta=1e-12)
        self.assertEqual(len(said["rows"]), 1)
        self.assertIn("relative L2 error", self.assert_succeeds("compare", "a.npy", "b.npy"))

    def test_a_picture_against_itself(self):
        self.assert_succeeds("scene", "convert", "colorchecker", "a.exr")
        said = self.json_of("compare", "a.exr", "a.exr")
        self.assertEqual((said["relative_l2"], said["max_error_over_peak"], said["psnr_db"]), (0, 0, None))
        self.assertTrue(said["identical"])
        self.assertEqual(said["rows"][0]["wavelength_nm"], 400)

    def test_every_format_that_image_writes(self):
        image = ["image", "wall", "--lens", "edmund-54852", "--wavelengths", "450,550,650", "--sensor", "32x24@25"]
        self.assert_succeeds(*image, *(word for name in ("a.exr", "a.npy", "a.png") for word in ("-o", name)))
        self.assert_succeeds("image", "wall", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960", "--sensor-set",
                             "columns=32", "--sensor-set", "rows=24", "--method", "none", "-o", "a.tif")
        for name in ("a.exr", "a.npy", "a.png", "a.tif"):
            self.assertEqual(self.json_of("compare", name, name)["relative_l2"], 0)
        self.assertEqual(self.json_of("compare", "a.exr", "a.npy")["relative_l2"], 0)
        self.assert_refused("compare", "a.exr", "a.png", words=["a.png", "display"])

    def test_pictures_of_every_kind(self):
        """The same samples as PNG and TIFF, of 8 and 16 bits; 1/255 is 257/65535."""
        samples = [0, 50, 100, 150, 200, 255] * 2
        wide = [257 * v for v in samples]
        self.write("8.png", picture_files.png(2, 2, 3, 8, samples))
        self.write("16.png", picture_files.png(2, 2, 3, 16, wide))
        self.write("8.tif", picture_files.tiff(2, 2, 3, 8, samples))
        self.write("16.tiff", picture_files.tiff(2, 2, 3, 16, wide, ">"))
        for name in ("16.png", "8.tif", "16.tiff"):
            self.assertTrue(self.json_of("compare", name, "8.png")["identical"], name)
        darker = samples[:-1] + [204]
        self.write("dark.tif", picture_files.tiff(2, 2, 3, 8, darker))
        said = self.json_of("compare", "dark.tif", "8.png")
        self.assertAlmostEqual(said["max_error_over_peak"], 51 / 255, delta=1e-12)
        # Blocks of one level; a decoder's transform rounds to one.
        self.write("a.jpg", picture_files.grey_jpeg([64, 192]))
        self.write("a.png", picture_files.png(16, 8, 1, 8, ([64] * 8 + [192] * 8) * 8))
        self.assertLess(self.json_of("compare", "a.jpg", "a.png")["max_error_over_peak"], 1.5 / 255)
        for name in ("a.jpg", "8.tif"):
            self.write("cut" + name, (self.folder / name).read_bytes()[:40])
            self.assert_refused("compare", "cut" + name, "8.png", words=["cut" + name])

    def test_opacity_counts_only_where_something_shines_through(self):
        rgb = [10, 20, 30, 40, 50, 60]
        self.write("rgb.png", picture_files.png(2, 1, 3, 8, rgb))
        self.write("rgba.png", picture_files.png(2, 1, 4, 8, [10, 20, 30, 255, 40, 50, 60, 255]))
        self.write("glass.png", picture_files.png(2, 1, 4, 8, [10, 20, 30, 255, 40, 50, 60, 254]))
        self.assertTrue(self.json_of("compare", "rgb.png", "rgba.png")["identical"])
        self.assertTrue(self.json_of("compare", "rgba.png", "rgb.png")["identical"])
        self.assertFalse(self.json_of("compare", "glass.png", "rgba.png")["identical"])
        self.assert_refused("compare", "rgb.png", "glass.png", words=["3 bands and 4"])

    def test_arrays_as_numpy_leaves_them(self):
        """int64 in Fortran order, as numpy.asfortranarray([[1, 2, 3], [4, 5, 6]]) is saved."""
        self.array("a.npy", 2, 3, [1, 2, 3, 4, 5, 6])
        self.write("f.npy", spectral_files.npy((2, 3), [1, 4, 2, 5, 3, 6], "<i8", fortran=True))
        self.assertTrue(self.json_of("compare", "f.npy", "a.npy")["identical"])

    def test_refuses_what_cannot_be_compared(self):
        self.array("a.npy", 2, 2, [1, 2, 3, 4])
        self.array("wide.npy", 1, 4, [1, 2, 3, 4])
        self.array("nan.npy", 2, 2, [1, 2, math.nan, 4])
        self.assert_refused("compare", "a.npy", "wide.npy", words=["2 × 2", "4 × 1"])
        self.assert_refused("compare", "a.npy", "nan.npy", words=["nan.npy", "row 1"])
        self.assert_refused("compare", "a.npy", "missing.npy", words=["missing.npy"])
        self.assert_refused("compare", "a.npy", "a.txt", words=["a.txt", ".exr"])
        self.assert_refused("compare", "a.npy")


if __name__ == "__main__":
    unittest.main()
