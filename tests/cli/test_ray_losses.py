# SPDX-License-Identifier: BSD-3-Clause
"""Losses of light on the command line, and fields that no light reaches."""

import cmath
import json
import math
import unittest

from petzval_cli import ProgramTest

RAYS = "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n0,0,-5,0,0,1,400\n0,3,-5,0,0,1,400\n0,60,-5,0,0,1,400\n"
PLATE = {
    "format": "petzval-lens/1", "name": "plate of SF6",
    "aperture": {"stop_semi_diameter_mm": 5}, "fields": {"type": "angle_deg", "values": [0]},
    "wavelengths_nm": [400], "reference_wavelength_nm": 400,
    "surfaces": [{"radius_mm": None, "thickness_mm": 10, "glass": "SCHOTT:SF6", "stop": True},
                 {"radius_mm": -100, "thickness_mm": 20}]}


class Losses(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "rays.csv").write_text(RAYS)
        (self.folder / "plate.json").write_text(json.dumps(PLATE))

    def column(self, *options):
        result = self.petzval("lens", "trace", self.folder / "plate.json", "--rays", self.folder / "rays.csv", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        header, *lines = result.stdout.splitlines()
        column = header.split(",").index("transmittance")
        return [float(line.split(",")[column]) for line in lines]

    def test_absorption_is_the_makers_k(self):
        # k = 2.8412e-7 at 400 nm in the maker's data: exp(-4 pi k 10 mm / 400 nm).
        self.assertAlmostEqual(self.column("--absorption")[0], math.exp(-4 * math.pi * 2.8412e-7 * 10 / 400e-6), 9)

    def test_fresnel_on_the_axis(self):
        c = [1.72448482, 0.0134871947, 0.390104889, 0.0569318095, 1.04572858, 118.557185]  # Schott's SF6
        n = math.sqrt(1 + sum(c[i] * 0.16 / (0.16 - c[i + 1]) for i in (0, 2, 4)))
        self.assertAlmostEqual(self.column("--fresnel")[0], (1 - ((n - 1) / (n + 1)) ** 2) ** 2, 12)

    def test_coatings(self):
        self.assertAlmostEqual(self.column("--coating", "0.01")[0], 0.99 ** 2, 14)
        table = self.folder / "coating.csv"
        table.write_text("wavelength_nm,surfaces[0],surfaces[1]\n300,0.1,0\n500,0.2,0\n")
        self.assertAlmostEqual(self.column("--coating", table)[1], 0.85, 14)
        self.assertTrue(math.isnan(self.column("--coating", table)[2]))

    def test_coatings_of_single_surfaces(self):
        self.assertAlmostEqual(self.column("--coating", "surfaces[1]=0.2")[0], 0.8, 14)
        self.assertAlmostEqual(self.column("--coating", "0.01,surfaces[0]=0.2")[0], 0.8 * 0.99, 14)
        both, all_at_once = (self.column("--coating", text)[0] for text in ("surfaces[0]=mgf2,surfaces[1]=mgf2", "mgf2"))
        self.assertEqual(both, all_at_once)
        for wrong, words in [("surfaces[0]=0.1,surfaces[0]=0.2", "each surface once"), ("mgf2,0.1,surfaces[0]=0.2", "'0.1'"), ("surfaces[7]=0.1", "surfaces[7]"),
                             ("surfaces[x]=0.1", "surfaces[x]"), ("surfaces[0]=mgf3", "mgf2"), ("surfaces[0]=1.5", "0 to 1")]:
            with self.subTest(wrong):
                self.assert_error(self.petzval("lens", "trace", self.folder / "plate.json", "--rays", self.folder / "rays.csv", "--coating", wrong), 2, words)

    def test_thin_films_on_the_axis(self):
        c = [1.72448482, 0.0134871947, 0.390104889, 0.0569318095, 1.04572858, 118.557185]  # Schott's SF6
        n = math.sqrt(1 + sum(c[i] * 0.16 / (0.16 - c[i + 1]) for i in (0, 2, 4)))
        front, back = (1 - 1.38) / (1 + 1.38), (1.38 - n) / (1.38 + n)
        turn = cmath.exp(-2j * math.pi / 2 * 550 / 400)  # there and back, a quarter wave at 550 nm each way
        transmitted = 1 - abs((front + back * turn) / (1 + front * back * turn)) ** 2
        self.assertAlmostEqual(self.column("--coating", "mgf2")[0], transmitted ** 2, 12)
        own = self.folder / "own.json"
        own.write_text(json.dumps({"format": "petzval-coating/1", "name": "mgf2 again",
                                   "layers": [{"index": 1.38, "thickness_nm": 550 / 4 / 1.38}]}))
        self.assertAlmostEqual(self.column("--coating", own)[0], transmitted ** 2, 12)

    def test_bad_films_say_what_would_be_right(self):
        layer = {"index": 1.38, "quarter_waves": 1}
        for changed, words in [({"format": "petzval-coating/2"}, ["petzval-coating/1"]), ({"layers": []}, ["layers"]),
                               ({"layers": [{**layer, "quarter_waves": -1}]}, ["layers[0]", "thick"]),
                               ({"layers": [{"index": 1.38}]}, ["quarter_waves"]),
                               ({"layers": [{"material": "N-BK77", "thickness_nm": 10}]}, ["N-BK7"]),
                               ({"colour": "blue"}, ["colour"]), ({"design_wavelength_nm": 0.5}, ["500"])]:
            bad = self.folder / "bad.json"
            bad.write_text(json.dumps({"format": "petzval-coating/1", "name": "bad", "layers": [layer], **changed}))
            result = self.petzval("lens", "trace", self.folder / "plate.json", "--rays", self.folder / "rays.csv",
                                  "--coating", bad)
            self.assert_error(result, 2, "bad.json", *words)
        self.assert_error(self.petzval("lens", "trace", self.folder / "plate.json", "--rays", self.folder / "rays.csv",
                                       "--coating", "mgf3"), 2, "mgf2")

    def test_bad_coatings_say_where(self):
        for text, line in [("a,b\n", 1), ("wavelength_nm,surfaces[7]\n400,0.1\n", None),
                           ("wavelength_nm,air_glass\n400,1.5\n", 2), ("wavelength_nm,air_glass\n400\n", 2),
                           ("wavelength_nm,air_glass\n500,0.1\n400,0.1\n", 3), ("", None)]:
            table = self.folder / "bad.csv"
            table.write_text(text)
            result = self.petzval("lens", "trace", self.folder / "plate.json", "--rays", self.folder / "rays.csv",
                         "--coating", table)
            self.assertEqual(result.returncode, 2, text)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            if line:
                self.assertIn(f"bad.csv:{line}:", result.stderr)

    def test_illumination_counts_them(self):
        def g(*options):
            result = self.petzval("lens", "illumination", self.folder / "plate.json", "--json", "--quiet", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)["rows"][0]["g_sensor_sr"]
        # The same coating on both surfaces takes the same from every ray.
        self.assertAlmostEqual(g("--coating", "0.01") / g(), 0.99 ** 2, 9)


class FieldsWithoutLight(ProgramTest):
    def test_are_said_to_have_none(self):
        result = self.petzval("lens", "distortion", "fisheye-10mm", "--fields", "75,80,120", "--wavelengths", "587.56",
                              "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = json.loads(result.stdout)["rows"]
        self.assertEqual([row["lit"] for row in rows], [True, False, False])
        self.assertGreater(rows[0]["image_height_mm"], 13)
        for row in rows[1:]:
            self.assertIsNone(row["image_height_mm"])
            self.assertIsNone(row["distortion_percent"])
        self.assertIn("no ray passes", self.petzval("lens", "distortion", "fisheye-10mm", "--fields", "75,80").stdout)

    def test_are_an_error_when_there_are_no_others(self):
        for command in ("distortion", "illumination"):
            result = self.petzval("lens", command, "fisheye-10mm", "--fields", "80,90,120")
            self.assertEqual(result.returncode, 2)
            self.assertIn("no ray passes at field 80", result.stderr)


if __name__ == "__main__":
    unittest.main()
