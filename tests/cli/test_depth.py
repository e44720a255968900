# SPDX-License-Identifier: BSD-3-Clause
"""Scenes with depth: maps from files, focus, layers, bad maps."""

import math
import struct
import unittest

import petzval_cli
import spectral_files

COLUMNS, ROWS = 48, 32


def floats_of(path):
    data = path.read_bytes()
    start = 10 + struct.unpack("<H", data[8:10])[0]
    return struct.unpack(f"<{(len(data) - start) // 4}f", data[start:])


class Depth(petzval_cli.ProgramTest):
    # Light that is not even, on 48 x 32 samples of one band.
    CHART = ("checkerboard:9", "--scene-size", f"{COLUMNS}x{ROWS}", "--scene-angle", 8, "--wavelengths", 550)
    LENS = ("--lens", "dgauss-50mm", "--sensor", "24x16@150", "--surround", "extend")

    def depth_file(self, name, depth):
        return self.write(name, spectral_files.npy((ROWS, COLUMNS), [depth(i % COLUMNS, i // COLUMNS)
                                                                    for i in range(ROWS * COLUMNS)]))

    def image(self, name, *arguments, scene=CHART):
        self.assert_succeeds("image", *scene, *self.LENS, *arguments, "-o", name)
        return floats_of(self.folder / name)

    def test_one_depth_is_a_plane_there(self):
        self.depth_file("even.npy", lambda *_: 1.5)
        plane = self.image("plane.npy", "--scene-distance", "1.5m")
        deep = self.image("deep.npy", "--scene-distance", "1.5m", "--scene-depth", "even.npy")
        # The chart's angle is found from the pupil, or from the sensor: rounding of floats.
        self.assertLess(max(abs(a - b) for a, b in zip(deep, plane)), 1e-6 * max(plane))
        self.assertNotEqual(self.image("near.npy", "--scene-distance", "1.5m", "--scene-depth", "even.npy", "--focus", "900mm"),
                            plane)

    def test_a_map_goes_with_the_scene_into_a_file_and_back(self):
        self.depth_file("steps.npy", lambda column, _: 0.8 if column < 20 else math.inf)
        scene = (*self.CHART, "--scene-distance", "1m", "--scene-depth", "steps.npy", "--scene-depth-from", "pupil")
        direct = self.image("direct.npy", scene=scene)
        self.assert_succeeds("scene", "convert", *scene, "kept.exr")
        facts = self.json_of("scene", "info", "kept.exr")
        self.assertEqual((facts["depth_from"], facts["depth_empty_samples"]), ("pupil", 28 * ROWS))
        self.assertAlmostEqual(facts["depth_max_m"], 0.8, places=6)
        self.assertEqual(self.image("again.npy", scene=("kept.exr",)), direct)
        # The map alone, and in the file of another scene of that size.
        self.assert_succeeds("scene", "convert", "kept.exr", "--depth", "map.npy")
        self.assertEqual(floats_of(self.folder / "map.npy"), floats_of(self.folder / "steps.npy"))
        other = (*self.CHART, "--scene-distance", "1m", "--scene-depth", "kept.exr", "--scene-depth-from", "pupil")
        self.assertEqual(self.image("other.npy", scene=other), direct)
        self.assert_succeeds("scene", "convert", "kept.exr", "--depth", "map.png")

    # The middle of the map is what --focus auto sees; contrast is highest where it focuses.
    def test_focus_is_on_the_middle_of_the_map_or_where_it_is_told(self):
        self.depth_file("steps.npy", lambda column, _: 0.7 if column < 16 else 1.0 if column < 32 else 2.0)

        def contrasts(*focus):
            pixels = self.image("picture.npy", "--scene-distance", "1m", "--scene-depth", "steps.npy", *focus)
            parts = [[pixels[row * 24 + column] for row in range(16) for column in range(first, first + 5)]
                     for first in (1, 9, 18)]
            return [(max(part) - min(part)) / (max(part) + min(part)) for part in parts]

        for sharpest, focus in enumerate((("700mm",), (), ("2m",))):
            found = contrasts(*(("--focus", *focus) if focus else ()))
            self.assertEqual(max(range(3), key=lambda part: found[part]), sharpest, found)

    def test_what_is_far_away_is_not_dark(self):
        # An even wall whose right half is far away: behind a lens that is focused there it is as light as a plane.
        wall = ("wall", *self.CHART[1:])
        plane = self.image("plane.npy", "--scene-distance", "inf", scene=wall)
        for far in (1000, 65535, 1e10):
            self.depth_file("halves.npy", lambda x, _, far=far: 1 if x < COLUMNS // 2 else far)
            deep = self.image("deep.npy", "--scene-distance", "inf", "--scene-depth", "halves.npy", "--focus",
                              "infinity", scene=wall)
            right = [row * 24 + 20 for row in range(4, 12)]
            for at in right:
                self.assertAlmostEqual(deep[at] / plane[at], 1, delta=2e-3, msg=far)

    def test_layers_are_reported(self):
        report = self.json_of("image", "slanted-plane", "--scene-size", "60x40", "--wavelengths", 550, *self.LENS,
                              "--layers", 5, "-o", "slanted.npy")
        layers = report["layers"]
        self.assertEqual(len(layers), 5)
        distances = [layer["distance_m"] for layer in layers]
        self.assertEqual(distances, sorted(distances, reverse=True))
        self.assertAlmostEqual(sum(layer["share"] for layer in layers), 1, places=6)
        # Blur is linear in 1/(distance from the entrance pupil).
        pupil_m = report["viewpoint_to_sensor_mm"] / 1000
        slopes = [(a["blur_um"] - b["blur_um"]) / (1 / (a["distance_m"] - pupil_m) - 1 / (b["distance_m"] - pupil_m))
                  for a, b in zip(layers, layers[1:])]
        for slope in slopes:
            self.assertAlmostEqual(slope / slopes[0], 1, places=6)

    def test_same_bytes_for_any_number_of_threads(self):
        scene = ("cards", "--scene-size", "48x36", "--scene-angle", 30, "--wavelengths", "450,600")
        one = self.image("one.npy", "--threads", 1, scene=scene)
        self.assertEqual(self.image("two.npy", "--threads", 2, scene=scene), one)

    def test_bad_maps_are_refused(self):
        def refused(name, *words, arguments=()):
            self.assert_refused("image", *self.CHART, *self.LENS, "--scene-depth", name, *arguments, "-o", "x.npy",
                                words=words)

        self.depth_file("nan.npy", lambda column, row: math.nan if (column, row) == (5, 7) else 1.0)
        refused("nan.npy", "nan.npy", "row 7, column 5", "infinity")
        self.depth_file("negative.npy", lambda column, row: -1.0)
        refused("negative.npy", "negative.npy", "-1 m")
        self.depth_file("inside.npy", lambda column, row: 0.03)
        refused("inside.npy", "--scene-depth-scale")
        refused("inside.npy", "--scene-depth-scale", arguments=("--focus", "1m"))
        self.write("small.npy", spectral_files.npy((3, 4), [1.0] * 12))
        refused("small.npy", "small.npy", "4 x 3", f"{COLUMNS} x {ROWS}")
        self.write("line.npy", spectral_files.npy((12,), [1.0] * 12))
        refused("line.npy", "dimensions")
        self.write("text.txt", "1 2 3")
        refused("text.txt", ".npy")
        refused("missing.npy", "missing.npy")
        self.depth_file("even.npy", lambda *_: 1.5)
        refused("even.npy", "layers", arguments=("--layers", -1))
        whole = (self.folder / "even.npy").read_bytes()
        self.write("cut.npy", whole[:-100])
        refused("cut.npy", "cut.npy")
        self.assert_succeeds("scene", "convert", *self.CHART, "flat.exr")
        refused("flat.exr", "channel Z")
        self.assert_refused("image", *self.CHART, *self.LENS, "--layers", 4, "-o", "x.npy", words=["--scene-depth"])
        self.assert_refused("image", *self.CHART, *self.LENS, "--scene-depth-scale", 2, "-o", "x.npy",
                            words=["has no depth map"])
        self.assert_refused("scene", "convert", *self.CHART, "--depth", "map.png", words=["--scene-depth"])
        self.assert_refused("scene", "info", "cards", "--scene-distance", "inf", words=["finite"])
        self.assert_refused("scene", "info", "wall", "--scene-size", "8x4", "--scene-projection", "equirectangular",
                            "--scene-depth", "even.npy", words=["even.npy"])

    def test_a_stored_table_is_for_one_distance(self):
        self.assert_succeeds("optics", "build", "dgauss-50mm", "--focus", "1m", "--wavelengths", 550, "--fields", 5,
                             "-o", "table.h5")
        table = ("--optics", "table.h5", "--sensor", "24x16@150", "--surround", "extend", "-o", "x.npy")
        scene = ("cards", "--scene-size", "48x36", "--scene-angle", 8, "--wavelengths", 550)
        self.assert_refused("image", *scene, *table, "--layers", 3, words=["--layers"])
        done = self.petzval("image", *scene, *table, "--scene-distance", "1m")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("depth map is not used", done.stderr)


if __name__ == "__main__":
    unittest.main()
