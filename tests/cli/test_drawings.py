# SPDX-License-Identifier: BSD-3-Clause
"""Drawings as .svg, and as .png and .pdf where rsvg-convert is installed."""

import os
import shutil
import struct
import unittest

from petzval_cli import ProgramTest

COMMANDS = [["lens", "draw", "cooke-triplet", "-o"], ["lens", "spots", "cooke-triplet", "--fields", "0,14", "--plot"],
            ["lens", "seidel", "cooke-triplet", "--plot"], ["lens", "wavefront", "cooke-triplet", "--fields", "0", "--wavelengths", "550", "--map"],
            ["target", "-o", "edge.png", "--rectangle", "40x40", "--size", "80x80", "--plot"]]


class Drawings(ProgramTest):
    @unittest.skipUnless(shutil.which("rsvg-convert"), "rsvg-convert is not installed")
    def test_are_pictures_and_pages(self):
        for command in COMMANDS:
            for name in ("drawing.svg", "drawing.png", "drawing.pdf"):
                self.assert_succeeds(*command, name)
            png = (self.folder / "drawing.png").read_bytes()
            self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n", command)
            width, height = struct.unpack(">II", png[16:24])
            self.assertGreater(min(width, height), 300, command)
            self.assertEqual((self.folder / "drawing.pdf").read_bytes()[:5], b"%PDF-", command)
            left = {path.name for path in self.folder.iterdir()} - {"edge.png"}
            self.assertEqual(left, {"drawing.svg", "drawing.png", "drawing.pdf"})

    def test_name_the_program_that_is_missing(self):
        bare = dict(os.environ, PATH=str(self.folder))
        for command in COMMANDS:
            self.assert_refused(*command, "x.png", words=["x.png", "rsvg-convert", "librsvg2-bin"], env=bare)
            self.assert_refused(*command, "x.jpg", words=["x.jpg", ".svg", ".pdf"], env=bare)
        self.assert_refused("sweep", "render", "spheres", "--vary", "seed=1,2", "--clip", "x.mp4", "-o", "x", words=["ffmpeg"], env=bare)


if __name__ == "__main__":
    unittest.main()
