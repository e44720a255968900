# SPDX-License-Identifier: BSD-3-Clause
"""Mirrors and apertures that are closed inside, through the program: closed forms, folds that change nothing, refusals."""

import json
import math
import unittest

from petzval_cli import ProgramTest

WAVELENGTH_MM = 550e-6
PARABOLOID = {
    "format": "petzval-lens/1", "name": "paraboloid", "aperture": {"entrance_pupil_diameter_mm": 100},
    "fields": {"type": "angle_deg", "values": [0]}, "wavelengths_nm": [550],
    "surfaces": [{"radius_mm": -2000, "conic": -1, "mirror": True, "stop": True, "thickness_mm": -1000,
                  "semi_diameter_mm": 50, "apertures": [{"ellipse": [16.5, 16.5], "obscures": True}]}]}
GLASS = {"index": 1.5168}


def doublet(folded):
    """As in trace/mirrors_test.cpp: the same light, straight on or thrown to the side."""
    sign = -1 if folded else 1
    lens = {"format": "petzval-lens/1", "name": "doublet", "aperture": {"entrance_pupil_diameter_mm": 20},
            "fields": {"type": "angle_deg", "values": [0, 2]}, "wavelengths_nm": [550],
            "surfaces": [{"radius_mm": 61, "thickness_mm": 6, "glass": GLASS, "stop": True, "semi_diameter_mm": 12},
                         {"radius_mm": -43, "thickness_mm": 2.5, "glass": {"index": 1.62}},
                         {"radius_mm": -125, "thickness_mm": 40},
                         {"radius_mm": None, "thickness_mm": sign * 30},
                         {"radius_mm": sign * -300, "thickness_mm": sign * 3, "glass": GLASS},
                         {"radius_mm": None, "thickness_mm": sign * 20}]}
    if folded:
        lens["surfaces"][3].update(mirror=True, pose={"tilt_x_deg": 45})
        lens["groups"] = [{"surfaces": [4, 6], "pivot_mm": 30, "pose": {"tilt_x_deg": 90}}]
    return lens


def overlap(a, b, distance):
    """Area that two discs share."""
    if distance >= a + b:
        return 0
    if distance <= abs(a - b):
        return math.pi * min(a, b) ** 2
    alpha = math.acos((distance**2 + a * a - b * b) / (2 * distance * a))
    beta = math.acos((distance**2 + b * b - a * a) / (2 * distance * b))
    return a * a * (alpha - math.sin(2 * alpha) / 2) + b * b * (beta - math.sin(2 * beta) / 2)


def ring_mtf(frequency, hole):
    """Of a perfect pupil with a hole; frequencies in units of the cut-off (O'Neill, J. Opt. Soc. Am. 46, 285, 1956)."""
    s = 2 * frequency
    return (overlap(1, 1, s) - 2 * overlap(1, hole, s) + overlap(hole, hole, s)) / (math.pi * (1 - hole**2))


class Mirrors(ProgramTest):
    def lens(self, name, data):
        (self.folder / name).write_text(json.dumps(data))
        return name

    def rows(self, *arguments):
        return json.loads(self.assert_succeeds("lens", *arguments, "--json"))["rows"]

    def test_ring_pupil_has_o_neills_mtf(self):
        lens = self.lens("p.json", PARABOLOID)
        frequencies = [10, 30, 60, 90, 120, 150]
        rows = self.rows("mtf", lens, "--fields", 0, "--frequencies", ",".join(map(str, frequencies)))
        # sin U' of the rim and of the hole: h/f over 1 + (h/2f)².
        sine = lambda h: h / 1000 / (1 + (h / 2000) ** 2)
        cut_off = 2 * sine(50) / WAVELENGTH_MM
        for row in rows:
            frequency = row["frequency_cpmm"] if "frequency_cpmm" in row else row["frequency"]
            expected = ring_mtf(frequency / cut_off, sine(16.5) / sine(50))
            self.assertAlmostEqual(row["tangential"], expected, delta=5e-4)
            self.assertAlmostEqual(row["sagittal"], expected, delta=5e-4)

    def test_fold_changes_no_spot_and_no_mtf(self):
        straight, folded = self.lens("s.json", doublet(False)), self.lens("f.json", doublet(True))
        for command, close in ((("spots",), 1e-6), (("mtf", "--frequencies", "20,60"), 3e-4)):
            one = self.rows(command[0], straight, "--fields", "0,2", *command[1:])
            other = self.rows(command[0], folded, "--fields", "0,2", *command[1:])
            self.assertEqual(len(one), len(other))
            for a, b in zip(one, other):
                for key, value in a.items():
                    if isinstance(value, float) and key in b:
                        self.assertAlmostEqual(b[key], value, delta=close * max(1, abs(value)), msg=key)

    def test_drawing_has_mirrors(self):
        self.assert_succeeds("lens", "draw", self.lens("p.json", PARABOLOID), "-o", "p.svg")
        self.assertIn('stroke-width="3"', (self.folder / "p.svg").read_text())

    def test_refusals_are_one_line(self):
        lens = self.lens("p.json", PARABOLOID)
        for command in (("lens", "ghosts", lens), ("lens", "reverse", lens, "-o", "r.json"),
                        ("lens", "transfer", lens, "-o", "t.json"), ("lens", "convert", lens, "p.dat")):
            done = self.petzval(*command)
            self.assertEqual(done.returncode, 2, (command, done.stderr))
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn("mirror", done.stderr)

    def test_bad_mirrors_and_apertures_say_where(self):
        for key, value, word in (("glass", "SCHOTT:N-BK7", "surfaces[0].glass"), ("mirror", 3, "mirror"),
                                 ("apertures", [{"ellipse": [1]}], "ellipse"),
                                 ("apertures", [{"ellipse": [1, -1]}], "half_width_y_mm"),
                                 ("apertures", [{"square": [1, 1]}], "square"), ("apertures", 3, "apertures")):
            bad = json.loads(json.dumps(PARABOLOID))
            bad["surfaces"][0][key] = value
            done = self.petzval("lens", "info", self.lens("bad.json", bad))
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(word, done.stderr)


if __name__ == "__main__":
    unittest.main()
