# SPDX-License-Identifier: BSD-3-Clause
"""Ray transfers and fits of builds from the command line: the same bytes for any number of threads."""
import json
import math
import unittest

from petzval_cli import ProgramTest

THREADS = (1, 2, 5)


class RayTransfer(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assert_succeeds("lens", "transfer", "cooke-triplet", "--bands", "450,550,650", "--tolerance", "2e-3", "-o", "box.json")

    def assert_same_bytes(self, *words, output):
        """Of the command with each number of threads."""
        written = []
        for threads in THREADS:
            self.assert_succeeds(*words, "--quiet", "--threads", threads, "-o", f"{threads}{output}")
            written.append((self.folder / f"{threads}{output}").read_bytes())
        self.assertEqual(written, written[:1] * len(THREADS))

    def test_image_does_not_depend_on_threads(self):
        self.assert_same_bytes("image", "studio", "--lens", "box.json", "--sensor", "90x60@300", "--wavelengths", "450:100:650", output=".exr")

    def test_render_does_not_depend_on_threads(self):
        self.assert_same_bytes("render", "spheres", "--lens", "box.json", "--focus", "1.2m", "--size", "48x36", "--spp", "4",
                               "--wavelengths", "450:100:650", output=".exr")


class FitBuild(ProgramTest):
    def test_does_not_depend_on_threads(self):
        edges = []
        for row in range(3):
            for column in range(4):
                for degrees in (7, 97):
                    # Sharper at the upper left, and no two alike.
                    mtf50 = 0.2 - 0.01 * column - 0.015 * row + 0.004 * math.sin(7 * len(edges))
                    edges.append({"line": {"x_px": 150 + 200 * column, "y_px": 120 + 200 * row, "normal_deg": degrees},
                                  "mtf50_cpp": mtf50, "mtf50_deviation_cpp": 0.004})
        (self.folder / "map.json").write_text(json.dumps({"columns": 900, "rows": 640, "edges": edges}))
        said, written = [], []
        for threads in THREADS:
            said.append(self.assert_succeeds("lens", "fit-build", "cooke-triplet", "--sfr", "map.json", "--pixel-pitch", "16", "--wavelengths", "550",
                                             "--free", "defocus_mm", "--free", "sensor_tilt_deg", "--json", "--quiet", "--threads", threads,
                                             "--csv", f"{threads}.csv", "-o", "built.json"))
            written.append((self.folder / "built.json").read_bytes() + (self.folder / f"{threads}.csv").read_bytes())
        self.assertEqual(said, said[:1] * len(THREADS))
        self.assertEqual(written, written[:1] * len(THREADS))


if __name__ == "__main__":
    unittest.main()
