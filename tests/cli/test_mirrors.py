# SPDX-License-Identifier: BSD-3-Clause
"""Mirrors and apertures that are closed inside, through the program: closed forms, folds that change nothing, refusals."""

import ast
import json
import math
import struct
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


def bessel_j1(x):
    """Bessel's integral; the midpoint rule is exact for x far below the number of its points."""
    angles = [math.pi * (i + 0.5) / 200 for i in range(200)]
    return sum(math.cos(u - x * math.sin(u)) for u in angles) / 200


def ring_psf(radius_um, hole=0.33, wavelength_f_number_um=5.5):
    """Of a perfect pupil with a hole, 1 in the middle (Born and Wolf, Principles of Optics, 8.6.2)."""
    x = math.pi * radius_um / wavelength_f_number_um
    if x < 1e-9:
        return 1
    return ((2 * bessel_j1(x) / x - hole * 2 * bessel_j1(hole * x) / x) / (1 - hole**2)) ** 2


def read_npy(path):
    """Shape and numbers of an array in C order (NEP 1)."""
    data = path.read_bytes()
    length = struct.unpack("<H", data[8:10])[0]
    header = ast.literal_eval(data[10:10 + length].decode())
    count = math.prod(header["shape"])
    kind = {"<f4": "f", "<f8": "d"}[header["descr"]]
    return header["shape"], struct.unpack(f"<{count}{kind}", data[10 + length:])


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

    def test_image_of_a_star_is_the_ring_pupil_s_diffraction(self):
        """A square of 2/3 um on the axis, on pixels of 2 um: the closed form over squares of both sizes. Bound: 1 % of
        the peak; the blur is promised to 0.1 % of all light, of which a pixel holds a ninth at the peak. (0.6 % seen.)"""
        size, pitch_um, fine = 21, 2.0, 3
        samples = size * fine
        star = [0.0] * samples**2
        star[(samples // 2) * samples + samples // 2] = 1.0
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({samples}, {samples}, 1), }}"
        header += " " * (63 - (10 + len(header)) % 64) + "\n"
        (self.folder / "star.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
                                               + struct.pack(f"<{len(star)}d", *star))
        (self.folder / "star.json").write_text(json.dumps(
            {"quantity": "radiance", "unit": "W.m^-2.sr^-1.nm^-1", "wavelengths_nm": [550],
             "angle_deg": 2 * math.degrees(math.atan(size * pitch_um / 2e6))}))
        self.assert_succeeds("image", "star.npy", "--lens", self.lens("p.json", PARABOLOID), "--sensor",
                             f"{size}x{size}@{pitch_um}", "--band-width", 1, "--focus", "design", "--surround", "zero",
                             "--quiet", "-o", "image.npy")
        shape, light = read_npy(self.folder / "image.npy")
        self.assertEqual(shape, (size, size, 1))
        # Both squares together: nine points a pixel, each as often as it is reached from within the star.
        step = pitch_um / 9
        weights = {i: sum(abs(i - j) <= 4 for j in (-1, 0, 1)) for i in range(-5, 6)}
        known = {}

        def psf(i, j):
            key = (min(abs(i), abs(j)), max(abs(i), abs(j)))
            if key not in known:
                known[key] = ring_psf(math.hypot(*key) * step)
            return known[key]

        expected = [sum(wx * wy * psf(9 * (column - 10) + dx, 9 * (row - 10) + dy)
                        for dx, wx in weights.items() for dy, wy in weights.items())
                    for row in range(size) for column in range(size)]
        peak = max(expected) / sum(expected)
        for a, b in zip(light, expected):
            self.assertAlmostEqual(a / sum(light), b / sum(expected), delta=0.01 * peak)

    def test_spider_s_psf_is_the_transform_of_its_pupil(self):
        """Along the arms the pupil's transform needs one integral: how high it is open at each x. Bound: 0.5 % of the
        peak (0.28 % seen), for the ends of the arms and of the ring are edges that samples meet in part."""
        data = json.loads(json.dumps(PARABOLOID))
        data["surfaces"][0]["apertures"] += [{"rectangle": half, "obscures": True} for half in ([50, 1], [1, 50])]
        row = self.rows("psf", self.lens("spider.json", data), "--fields", 0, "--wavelengths", 550, "-o", "psf.npy")[0]
        (rows, columns), psf = read_npy(self.folder / "psf.npy")
        middle = rows // 2
        steps = [100 * (i + 0.5) / 4000 - 50 for i in range(4000)]

        def chord(radius, x):
            return 2 * math.sqrt(max(radius * radius - x * x, 0))

        opening = [(x / 1000 / (1 + (x / 2000) ** 2), 0 if abs(x) < 1 else chord(50, x) - max(chord(16.5, x), 2))
                   for x in steps]
        amplitude = lambda u_mm: sum(w * math.cos(2 * math.pi * u_mm * s / WAVELENGTH_MM) for s, w in opening)
        for i in range(20):
            expected = (amplitude(i * row["spacing_um"] / 1000) / amplitude(0)) ** 2
            at = middle * columns + columns // 2
            for seen in (psf[at + i], psf[at + i * columns], psf[at - i]):
                self.assertAlmostEqual(seen / psf[at], expected, delta=5e-3)

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
        for command in (("lens", "reverse", lens, "-o", "r.json"), ("lens", "transfer", lens, "-o", "t.json"), ("lens", "convert", lens, "p.dat")):
            done = self.petzval(*command)
            self.assertEqual(done.returncode, 2, (command, done.stderr))
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn("mirror", done.stderr)

    def test_ghosts_are_those_of_glass(self):
        """A mirror makes none of its own, and what it folds has those that it had: as in flare/ghost_table_test.cpp."""
        self.assertEqual(self.rows("ghosts", self.lens("p.json", PARABOLOID)), [])
        straight, folded = (self.rows("ghosts", self.lens("d.json", doublet(is_folded))) for is_folded in (False, True))
        self.assertEqual(len(straight), 10)  # pairs of five faces
        by_pair = {(row["first_surface"], row["second_surface"]): row for row in folded}
        self.assertEqual(len(by_pair), 10)
        for row in straight:
            same = by_pair[(row["first_surface"], row["second_surface"])]
            self.assertAlmostEqual(same["diameter_mm"], row["diameter_mm"], delta=1e-3 * row["diameter_mm"])

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
