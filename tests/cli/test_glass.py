# SPDX-License-Identifier: BSD-3-Clause
"""petzval glass list, show and find."""

import os
import unittest

from petzval_cli import ProgramTest


class Glass(ProgramTest):
    def test_list(self):
        rows = self.json_of("glass", "list")["rows"]
        self.assertEqual(len(rows), 1636)
        schott = self.json_of("glass", "list", "--catalogue", "schott")["rows"]
        self.assertEqual(len(schott), 156)
        self.assertEqual([row["name"] for row in schott], [row["name"] for row in rows if row["name"].startswith("SCHOTT:")])
        self.assertIn("SCHOTT:N-BK7", self.assert_succeeds("glass", "list"))

    def test_show(self):
        glass = self.json_of("glass", "show", "n-bk7", "--wavelengths", "486.1327,587.5618")
        self.assertEqual(glass["name"], "SCHOTT:N-BK7")
        self.assertEqual(glass["formula"], 2)
        self.assertEqual(glass["coefficients"][1], 1.03961212)
        self.assertEqual((glass["shortest_nm"], glass["longest_nm"]), (300, 2500))
        # Five decimals of the data sheet.
        self.assertAlmostEqual(glass["rows"][0]["index"], 1.52238, delta=0.51e-5)
        self.assertAlmostEqual(glass["rows"][1]["index"], 1.51680, delta=0.51e-5)
        self.assertAlmostEqual(glass["vd"], 64.17, delta=0.0051)
        text = self.assert_succeeds("glass", "show", "SCHOTT:N-BK7", "--wavelengths", "486.1327")
        self.assertIn("1.522376", text)

    def test_absorption_that_nobody_states_is_not_zero(self):
        row = self.json_of("glass", "show", "MISC:SILICA", "--wavelengths", "500")["rows"][0]
        self.assertIsNone(row["extinction"])

    def test_infrared_materials_have_the_indices_of_other_publications(self):
        """Ge and Si at 4 um: C. D. Salzberg and J. J. Villa, J. Opt. Soc. Am. 47, 244 (1957), two samples of which differ by 5e-4.
        ZnSe at 10.6 um: 2.4028, as makers of laser windows state it; ZnS there: 2.192; As2S3 at 5 um: 2.4073 (Rodney's own table). No second
        publication of IRG26 is at hand: the equation of its maker, reckoned here once more, shows that it was packed right."""
        def irg26(um):
            square = um * um
            return (1 + 3.1934 + 3.5854 * square / (square - 0.1852) + 2.2337 * square / (square - 3398.08)) ** 0.5

        for name, nm, index, tolerance in (("GE", 4000, 4.0246, 5e-4), ("SI", 4000, 3.4257, 5e-4), ("ZNSE", 10600, 2.4028, 5e-5),
                                           ("ZNS", 10600, 2.192, 1e-3), ("AS2S3", 5000, 2.4073, 5e-5), ("IRG26", 4000, irg26(4), 1e-6),
                                           ("IRG26", 10000, irg26(10), 1e-6)):
            glass = self.json_of("glass", "show", "INFRARED:" + name, "--wavelengths", nm)
            self.assertAlmostEqual(glass["rows"][0]["index"], index, delta=tolerance, msg=name)
        table = self.json_of("glass", "show", "INFRARED:AMTIR-1", "--wavelengths", "10000")
        self.assertEqual(table["rows"][0]["index"], 2.4981)
        self.assertIsNone(table["nd"])

    def test_find_ranks_by_the_stated_distance(self):
        rows = self.json_of("glass", "find", "--nd", "1.5168", "--vd", "64.17", "--count", "7")["rows"]
        self.assertEqual(len(rows), 7)
        distances = [((row["nd"] - 1.5168) ** 2 + (0.01 * (row["vd"] - 64.17)) ** 2) ** 0.5 for row in rows]
        self.assertEqual(distances, sorted(distances))
        for row, distance in zip(rows, distances):
            self.assertAlmostEqual(row["distance"], distance, delta=1e-12)
        self.assertIn("SCHOTT:N-BK7", [row["name"] for row in rows])
        every = self.json_of("glass", "list")["rows"]
        nearer = [row for row in every if row["nd"] is not None
                  and ((row["nd"] - 1.5168) ** 2 + (0.01 * (row["vd"] - 64.17)) ** 2) ** 0.5 < distances[-1] - 1e-12]
        self.assertEqual(len(nearer), 6)

    def test_find_by_one_number_in_one_catalogue(self):
        rows = self.json_of("glass", "find", "--vd", "60", "--catalogue", "hoya", "--count", "3")["rows"]
        self.assertTrue(all(row["name"].startswith("HOYA:") for row in rows))

    def test_refusals(self):
        self.assert_refused("glass", "show", "BK7", words=["unknown glass BK7", "SCHOTT:N-BK7"])
        self.assert_refused("glass", "show", "F2", words=["ambiguous", "SCHOTT:F2", "CDGM:F2"])
        self.assert_refused("glass", "show", "N-BK7", "--wavelengths", "500,299.9", words=["SCHOTT:N-BK7", "299.9", "300"])
        self.assert_refused("glass", "show", "N-BK7", "--wavelengths", "green", words=["--wavelengths"])
        self.assert_refused("glass", "show", "N-BK7", "--wavelengths", "nan", words=["nan"])
        self.assert_refused("glass", "show", "x" * 100000, words=["not the name of a glass"])
        self.assert_refused("glass", "list", "--catalogue", "NIKON", words=["NIKON", "HIKARI"])
        self.assert_refused("glass", "find", words=["--nd", "--vd"])
        self.assert_refused("glass", "find", "--nd", "inf", words=["--nd"])
        self.assert_refused("glass", "find", "--nd", "1.5", "--count", "0", words=["--count"])

    def test_damaged_catalogue(self):
        (self.folder / "glass").mkdir()
        self.write("glass/catalogue.pgc", b"PZGLASS1 and then something else")
        self.assert_refused("glass", "list", words=["catalogue.pgc", "damaged"],
                            env={**os.environ, "PETZVAL_DATA": str(self.folder)})


if __name__ == "__main__":
    unittest.main()
