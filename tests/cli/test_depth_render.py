# SPDX-License-Identifier: BSD-3-Clause
"""The same scene twice: path-traced through the lens in three dimensions, and imaged in layers from the picture and
the depth that a pinhole in the lens's entrance pupil sees. They share the prescription and nothing else."""

import math
import struct
import unittest

import petzval_cli

NEAR_M, FAR_M, COLUMNS, ROWS = 0.8, 2.0, 60, 40


def quad(left, bottom, right, top, z, light):
    """A square that shines."""
    return (f'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [{light} {light} {light}] "bool twosided" true\n'
            f'Material "diffuse" "rgb reflectance" [0 0 0]\nShape "bilinearmesh" "point3 P" '
            f'[{left} {bottom} {z} {right} {bottom} {z} {left} {top} {z} {right} {top} {z}]\nAttributeEnd\n')


def world(eye_z, checkered):
    """A striped card at NEAR_M that ends in the middle of the picture, before a wall at FAR_M: checkered, or striped
    from side to side. The film, or the pinhole, is at eye_z."""
    text = (f'LookAt 0 0 {eye_z} 0 0 10 0 1 0\nCamera "perspective" "float fov" 10\n'
            'Integrator "path" "integer maxdepth" 1\nWorldBegin\n')
    squares, side = 24, 0.9 / 24
    for j in range(squares):
        for i in range(squares if checkered else 1):
            left = -0.45 + i * side
            text += quad(left, -0.45 + j * side, left + side if checkered else 0.45, -0.45 + (j + 1) * side, FAR_M,
                         1.0 if (i + j) % 2 else 0.3)
    for j in range(10):
        text += quad(-0.3, -0.1 + j * 0.02, 0.01, -0.1 + (j + 1) * 0.02, NEAR_M, 0.8 if j % 2 else 0.1)
    return text


class DepthAgainstRendering(petzval_cli.ProgramTest):
    def floats(self, name):
        data = (self.folder / name).read_bytes()
        start = 10 + struct.unpack("<H", data[8:10])[0]
        return struct.unpack(f"<{(len(data) - start) // 4}f", data[start:])

    def both(self, focus_m, checkered):
        """(layers, rendering) in pixels, and the diameter of the blur of what is out of focus in pixels."""
        lens = ("--lens", "dgauss-50mm", "--sensor", f"{COLUMNS}x{ROWS}@150")
        focus = ("--focus", f"{focus_m}m")
        # Where the entrance pupil is once the lens is focused: any scene with depth tells.
        pupil_m = self.json_of("image", "cards", "--scene-size", "12x8", "--scene-angle", 16, "--surround", "extend",
                               "--wavelengths", 550, "--method", "none", *lens, *focus,
                               "-o", "any.npy")["viewpoint_to_sensor_mm"] / 1000
        self.write("film.pbrt", world(0, checkered))
        self.write("pinhole.pbrt", world(pupil_m, checkered))
        self.assert_succeeds("render", "pinhole.pbrt", "--pinhole", "--size", f"{12 * COLUMNS}x{12 * ROWS}", "--spp", 4,
                             "--wavelengths", 550, "-o", "seen.exr", "--depth", "depth.npy")
        self.assert_succeeds("render", "film.pbrt", "--lens", "dgauss-50mm", "--focus", f"{focus_m}m", "--film-diagonal",
                             math.hypot(COLUMNS, ROWS) * 0.15, "--size", f"{COLUMNS}x{ROWS}", "--spp", 1024,
                             "--wavelengths", 550, "-o", "rendered.npy")
        angle = 2 * math.degrees(math.atan(COLUMNS / ROWS * math.tan(math.radians(5))))
        # Two layers: the pixels on the edge of the card, whose depth is a mean of both, are shared by them.
        report = self.json_of("image", "seen.exr", "--scene-unit", "W.m^-2.sr^-1.nm^-1", "--scene-angle", angle,
                              "--scene-depth", "depth.npy", "--scene-depth-from", "pupil", *lens, *focus,
                              "--layers", 2, "--supersample", 3, "-o", "layers.npy")
        blur = max(abs(layer["blur_um"]) for layer in report["layers"]) / 150
        return self.floats("layers.npy"), self.floats("rendered.npy"), blur

    def error(self, layers, rendered, columns):
        """Relative L2 error over some columns."""
        places = [row * COLUMNS + column for row in range(ROWS) for column in columns]
        return math.sqrt(sum((layers[i] - rendered[i]) ** 2 for i in places) / sum(rendered[i] ** 2 for i in places))

    def test_two_planes_one_before_the_other(self):
        for focus_m in (NEAR_M, FAR_M):
            layers, rendered, blur = self.both(focus_m, checkered=True)
            self.assertGreater(blur, 6)
            edge = 0.01 / (NEAR_M - 0.05) * 50.36 / 0.15 + COLUMNS / 2 + 0.5  # roughly, in pixels
            band = [column for column in range(COLUMNS) if abs(column + 0.5 - edge) < blur / 2 + 2]
            beside = [column for column in range(COLUMNS) if column not in band]
            # The noise of 1024 paths a pixel is 0.5 %, what edges of squares add is as much.
            self.assertLess(self.error(layers, rendered, beside), 0.01, focus_m)
            # About the edge the lens sees squares of the wall that the pinhole does not; they are guessed.
            self.assertLess(self.error(layers, rendered, band), 0.06, focus_m)
            self.assertLess(self.error(layers, rendered, range(COLUMNS)), 0.03, focus_m)

    def test_behind_the_edge_goes_on_what_is_beside_it(self):
        # Stripes from side to side are behind the card what they are beside it: the guess is right.
        for focus_m in (NEAR_M, FAR_M):
            layers, rendered, _ = self.both(focus_m, checkered=False)
            self.assertLess(self.error(layers, rendered, range(COLUMNS)), 0.012, focus_m)


if __name__ == "__main__":
    unittest.main()
