# SPDX-License-Identifier: BSD-3-Clause
"""Pictures for displays of high dynamic range: PNG with Rec. 2100 PQ, read with arithmetic of its own."""

import struct
import unittest
import zlib

import numpy as np

from petzval_cli import ProgramTest


def chunks_of(data):
    at, found = 8, {}
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        found.setdefault(name.decode(), []).append(data[at + 8:at + 8 + length])
        at += 12 + length
    return found


def samples_of(chunks):
    """16 bits, RGB, not interlaced."""
    columns, rows, bits, colour, *rest = struct.unpack(">IIBBBBB", chunks["IHDR"][0])
    assert (bits, colour, rest) == (16, 2, [0, 0, 0]), (bits, colour, rest)
    stride, left = 6 * columns, 6
    stream = np.frombuffer(zlib.decompress(b"".join(chunks["IDAT"])), np.uint8).reshape(rows, stride + 1)
    lines = np.zeros((rows + 1, stride + left), int)
    for row in range(rows):
        method, coded = stream[row, 0], stream[row, 1:].astype(int)
        out, above = lines[row + 1], lines[row]
        for i in range(stride):
            a, b, c = out[i], above[i + left], above[i]
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            out[i + left] = (coded[i] + (0, a, b, (a + b) // 2, paeth)[method]) % 256
    return (lines[1:, left::2] * 256 + lines[1:, left + 1::2]).reshape(rows, columns, 3)


def luminance(code):
    """SMPTE ST 2084:2014, equation 5.1 [cd/m2]."""
    m1, m2, c1, c2, c3 = 2610 / 16384, 2523 / 4096 * 128, 3424 / 4096, 2413 / 4096 * 32, 2392 / 4096 * 32
    root = (code / 65535) ** (1 / m2)
    return 10000 * (np.maximum(root - c1, 0) / (c2 - c3 * root)) ** (1 / m1)


class HighDynamicRange(ProgramTest):
    def test_perceptual_quantisation(self):
        self.assert_succeeds("image", "colorchecker", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960",
                             "--sensor-set", "columns=60", "--sensor-set", "rows=40", "--method", "none",
                             "--wavelengths", "400:50:700", "--quiet", "-o", "raw.dng")
        self.assert_succeeds("develop", "raw.dng", "--space", "rec2100-pq", "--brightness", "3", "--quiet", "-o",
                             "hdr.png", "-o", "linear.npy")
        chunks = chunks_of((self.folder / "hdr.png").read_bytes())
        self.assertEqual(chunks["cICP"], [bytes([9, 16, 0, 1])])  # ITU-T H.273: BT.2020, PQ, RGB, full range
        self.assertEqual(list(chunks).index("IHDR"), 0)
        self.assertLess(list(chunks).index("cICP"), list(chunks).index("IDAT"))
        self.assertIn(b"acsp", zlib.decompress(chunks["iCCP"][0].split(b"\0", 1)[1][1:])[:40])
        self.assertEqual(chunks["eXIf"][0][:4], b"II*\0")
        code = samples_of(chunks)
        linear = np.clip(np.load(self.folder / "linear.npy"), 0, None) * 203  # white of ITU-R BT.2408
        self.assertGreater(linear.max(), 2 * 203)  # beyond white nothing is cut
        seen = luminance(code)
        # Half a code either way.
        self.assertTrue(np.all(luminance(np.maximum(code - 0.51, 0)) <= linear + 1e-4))
        self.assertTrue(np.all(luminance(np.minimum(code + 0.51, 65535)) >= linear - 1e-4))
        self.assertAlmostEqual(seen.mean() / linear.mean(), 1, delta=1e-3)

    def test_other_files_are_refused(self):
        self.assert_succeeds("image", "wall", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960",
                             "--sensor-set", "columns=16", "--sensor-set", "rows=16", "--method", "none",
                             "--wavelengths", "450,550,650", "--quiet", "-o", "raw.dng")
        self.assert_refused("develop", "raw.dng", "--space", "rec2100-pq", "-o", "hdr.jpg", words=("16 bits",))

    def test_an_exposure_read_at_both_gains(self):
        light = ("image", "studio", "--lens", "edmund-54852", "--sensor", "example-vga", "--sensor-set", "columns=32",
                 "--sensor-set", "rows=24", "--method", "none", "--wavelengths", "450,550,650", "--quiet")
        self.assert_succeeds(*light, "--conversion-gain", "dual", "-o", "both.dng")
        self.assert_succeeds("develop", "both.dng", "--quiet", "-o", "both.png")
        self.assert_refused(*light, "--conversion-gain", "dual", "--bracket", "0,2", "-o", "no.dng",
                            words=("bracket",))
        self.assert_refused(*light[:5], "third-inch-1280x960", *light[6:], "--conversion-gain", "dual", "-o",
                            "no.dng", words=("several conversion gains",))


if __name__ == "__main__":
    unittest.main()
