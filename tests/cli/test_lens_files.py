# SPDX-License-Identifier: BSD-3-Clause
"""petzval lens convert, scale and trace, lists of numbers, and glasses of the user's own."""

import json
import os
import pathlib
import unittest

from petzval_cli import ProgramTest

AGF = """CC one glass
NM BRAND-NEW 5 0 1.7 50 0 1
CD 1.7 0 0 0 0 0
LD 0.3 2.5
"""


class LensFiles(ProgramTest):
    def test_convert_through_every_format(self):
        """A lens of rows of numbers fits all formats once its aperture is an f-number or its stop, as each wants."""
        first = self.json_of("lens", "info", "dgauss-50mm")
        self.assert_succeeds("lens", "convert", "dgauss-50mm", "a.iset.json", "--quiet")
        self.assert_succeeds("lens", "convert", "a.iset.json", "b.dat", "--quiet")
        self.assert_succeeds("lens", "convert", "b.dat", "c.zmx", "--quiet")
        self.assert_refused("lens", "convert", "c.zmx", "d.seq", words=["d.seq", "stop_semi_diameter_mm"])
        diameter = first["entrance_pupil"]["diameter_mm"]
        self.assert_succeeds("lens", "convert", "c.zmx", "d.seq", "--quiet",
                             "--set", f"aperture.entrance_pupil_diameter_mm={diameter!r}")
        last = self.json_of("lens", "info", "d.seq")
        for key in ("efl_mm", "bfl_mm", "f_number", "total_track_mm", "petzval_radius_mm"):
            self.assertAlmostEqual(last[key], first[key], delta=1e-12 * abs(first[key]), msg=key)

    def test_convert_says_what_it_cannot_hold(self):
        self.assert_refused("lens", "convert", "cooke-triplet", "out.dat", words=["out.dat", "dispersion"])
        self.assert_refused("lens", "convert", "cooke-triplet", "out.txt", words=[".seq", ".zmx"])
        self.assertFalse(os.path.exists(self.folder / "out.dat"))

    def test_scale(self):
        """Ten times as large: lengths ten times, f-number and spots by geometry alone unchanged in shape."""
        before = self.json_of("lens", "info", "cooke-triplet")
        self.assert_succeeds("lens", "scale", "cooke-triplet", "--factor", "10", "-o", "large.json", "--quiet")
        after = self.json_of("lens", "info", "large.json")
        for key in ("efl_mm", "bfl_mm", "total_track_mm", "stop_semi_diameter_mm", "petzval_radius_mm"):
            self.assertAlmostEqual(after[key], 10 * before[key], delta=1e-11 * abs(after[key]), msg=key)
        self.assertAlmostEqual(after["f_number"], before["f_number"], delta=1e-12)
        spots = [self.json_of("lens", "spots", lens, "--fields", "14", "--wavelengths", "587.56")["rows"][0]
                 for lens in ("cooke-triplet", "large.json")]
        self.assertAlmostEqual(spots[1]["rms_radius_um"], 10 * spots[0]["rms_radius_um"], delta=1e-6)
        self.assert_refused("lens", "scale", "cooke-triplet", "--factor", "0", "-o", "x.json", words=["--factor"])

    def test_scale_aspheres(self):
        lens = json.loads(self.assert_succeeds_file("lens", "convert", "cooke-triplet", "a.json", "--quiet", "--set",
                                                    "surfaces[0].asphere.4=-1e-6"))
        self.assertEqual(lens["surfaces"][0]["asphere"]["4"], -1e-6)
        scaled = json.loads(self.assert_succeeds_file("lens", "scale", "a.json", "--factor", "2", "--quiet", "-o", "b.json"))
        self.assertAlmostEqual(scaled["surfaces"][0]["asphere"]["4"], -1e-6 / 8, delta=1e-20)

    def assert_succeeds_file(self, *command):
        self.assert_succeeds(*command)
        return (self.folder / (command[-1] if command[-2] == "-o" else command[3])).read_text()

    def test_trace_json(self):
        self.write("rays.csv", "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n0,1,-5,0,0,1,550\n0,500,-5,0,0,1,550\n")
        rows = self.json_of("lens", "trace", "cooke-triplet", "--rays", "rays.csv")["rows"]
        table = self.assert_succeeds("lens", "trace", "cooke-triplet", "--rays", "rays.csv").splitlines()
        self.assertEqual([row["status"] for row in rows], [line.split(",")[0] for line in table[1:]])
        self.assertEqual(rows[0]["y_mm"], float(table[1].split(",")[2]))
        self.assertEqual(rows[0]["opl_mm"], float(table[1].split(",")[7]))
        self.assertIsNone(rows[1]["y_mm"])

    def test_lists_and_ranges(self):
        def wavelengths(text):
            rows = self.json_of("lens", "distortion", "cooke-triplet", "--fields", "5", "--wavelengths", text)["rows"]
            return [row["wavelength_nm"] for row in rows]
        self.assertEqual(wavelengths("500:50:600"), [500, 550, 600])
        self.assertEqual(wavelengths("500,600"), [500, 600])
        self.assertEqual(wavelengths("450,500:40:590"), [450, 500, 540, 580])
        for wrong in ("500:600", "600:10:500", "500:0:600", "a", "500:x:600", "", "-5"):
            self.assert_refused("lens", "distortion", "cooke-triplet", "--wavelengths=" + wrong, words=["--wavelengths"])

    def test_numbers_out_of_range_are_said_shortly(self):
        for command in (("lens", "info", "cooke-triplet", "--seed", "-1"), ("lens", "info", "cooke-triplet", "--seed", "x"),
                        ("lens", "mtf", "cooke-triplet", "--frequencies", "-3")):
            done = self.petzval(*command)
            self.assert_error(done, 2, command[3])
            self.assertLess(len(done.stderr), 200)

    def test_two_stop_radii_have_two_names(self):
        """Another program's real and paraxial heights at the stop (tests/data/cooke_triplet_f5.ref.json)."""
        reference = pathlib.Path(__file__).parent.parent / "data" / "cooke_triplet_f5.ref.json"
        numbers = json.loads(reference.read_text())
        info = self.json_of("lens", "info", "cooke-triplet")
        for key, name in (("stop_semi_diameter_mm", "stop_radius_real"),
                          ("paraxial_stop_semi_diameter_mm", "stop_radius_paraxial")):
            self.assertAlmostEqual(info[key], numbers["first_order_primary"][name], delta=1e-9)  # glass constants agree
        self.assertEqual(self.json_of("lens", "info", "cooke-triplet", "--set", "aperture.stop_semi_diameter_mm=3")
                         ["stop_semi_diameter_mm"], 3)

    def test_convert_solves_missing_apertures(self):
        def apertures(*options):
            self.assert_succeeds("lens", "convert", "us-5831776", "out.json", *options)
            return [surface.get("semi_diameter_mm") for surface in json.loads((self.folder / "out.json").read_text())["surfaces"]]

        given, solved = apertures(), apertures("--apertures", "from-fields")
        self.assertIn(None, given)
        self.assertNotIn(None, solved)
        # What the file gives stays, and so does what the lens is open to.
        self.assertEqual([a for a, b in zip(solved, given) if b is not None], [b for b in given if b is not None])
        before, after = (self.json_of("lens", "info", name)["f_number"] for name in ("us-5831776", "out.json"))
        self.assertAlmostEqual(after, before, places=9)

    def test_a_telecentric_lens_has_no_f_number(self):
        """The stop at the rear focal point of a thin lens of f = 50: the entrance pupil is infinitely far."""
        surfaces = [{"radius_mm": 50, "thickness_mm": 0, "glass": {"index": 1.5}}, {"radius_mm": -50, "thickness_mm": 50},
                    {"radius_mm": None, "thickness_mm": 10, "stop": True}]
        self.write("telecentric.json", json.dumps({
            "format": "petzval-lens/1", "object_distance_mm": 60, "aperture": {"stop_semi_diameter_mm": 1},
            "wavelengths_nm": [550], "surfaces": surfaces}))
        self.assertIsNone(self.json_of("lens", "info", "telecentric.json")["f_number"])
        self.assertRegex(self.assert_succeeds("lens", "info", "telecentric.json"), r"\n  f-number +none")

    def test_infrared_lens(self):
        """All analyses at 8-12 um, and refocused at 3-5 um, where ZnSe and Ge both let light through."""
        for wavelengths, setting in (("8000:2000:12000", "surfaces[3].thickness_mm=49.602"),
                                     ("3000:1000:5000", "reference_wavelength_nm=4000")):
            lens = ("infrared-50mm", "--fields", "0,3", "--wavelengths", wavelengths, "--set", setting)
            spots = self.json_of("lens", "spots", *lens)["rows"]
            self.assertEqual(len(spots), 6)
            for command in ("distortion", "illumination", "wavefront"):
                self.assertEqual(len(self.json_of("lens", command, *lens)["rows"]), 6, command)
            mtf = self.json_of("lens", "mtf", *lens, "--frequencies", "0,10")["rows"]
            self.assertTrue(all(0 <= row["tangential"] <= 1.000001 for row in mtf))
        # And everything else, with the doublet's germanium exchanged for a chalcogenide too.
        for bands, setting in (("8000,12000", "reference_wavelength_nm=10000"), ("3000,5000", "reference_wavelength_nm=4000")):
            lens = ("infrared-50mm", "--set", setting, "--set", f"wavelengths_nm=[{bands}]", "--focus", "best-spot")
            for command in ("psf", "encircled-energy", "fans", "zernike", "field-curvature", "colour", "vignetting", "chief-ray-angle"):
                self.assertTrue(self.json_of("lens", command, *lens, "--fields", "0,3")["rows"], command)
            self.json_of("lens", "seidel", *lens)
            glass = "INFRARED:IRG26" if "12000" in bands else "INFRARED:AS2S3"  # which ends at 11.8 um
            self.assertTrue(self.json_of("lens", "spots", *lens, "--set", f"surfaces[0].glass={glass}")["rows"])
            self.assert_succeeds("lens", "report", *lens, "-o", "infrared.html")
            self.assert_succeeds("optics", "build", *lens[:5], "--fields", "3", "-o", "infrared.h5")
        # Focal lengths by Gullstrand's equation for two thick lenses, with the publications' formulas written out here.
        def germanium(um):
            return (1 + 0.4886331 * um**2 / (um**2 - 1.393959) + 14.5142535 * um**2 / (um**2 - 0.1626427)
                    + 0.0091224 * um**2 / (um**2 - 752.190)) ** 0.5

        def zinc_selenide(um):
            return (1 + 4.45813734 * um**2 / (um**2 - 0.200859853**2) + 0.467216334 * um**2 / (um**2 - 0.391371166**2)
                    + 2.89566290 * um**2 / (um**2 - 47.1362108**2)) ** 0.5

        for um in (3, 4, 5, 8, 10, 12):
            height, angle = 1, 0  # of a ray parallel to the axis; angle is n u
            for index, radius, gap, behind in ((germanium(um), 110.074, 6, germanium(um)), (germanium(um), -505.418, 1, 1),
                                               (zinc_selenide(um), -24.174, 4, zinc_selenide(um)), (zinc_selenide(um), 26.355, 0, 1)):
                angle -= height * (index - 1) / radius
                height += gap * angle / behind
            efl = self.json_of("lens", "info", "infrared-50mm", "--wavelength", 1000 * um)["efl_mm"]
            self.assertAlmostEqual(efl, -1 / angle, delta=1e-9, msg=um)

    def test_own_glasses(self):
        self.write("mine.agf", AGF)
        show = self.json_of("glass", "show", "BRAND-NEW", "--glass-catalogue", "mine.agf", "--wavelengths", "500")
        self.assertEqual((show["name"], show["rows"][0]["index"]), ("MINE:BRAND-NEW", 1.7))
        rows = self.json_of("glass", "list", "--catalogue", "mine", "--glass-catalogue", "mine.agf")["rows"]
        self.assertEqual([row["name"] for row in rows], ["MINE:BRAND-NEW"])
        self.assert_refused("lens", "info", "cooke-triplet", "--set", "surfaces[0].glass=BRAND-NEW", words=["BRAND-NEW"])
        with_it = ("--set", "surfaces[0].glass=BRAND-NEW")
        option = self.json_of("lens", "info", "cooke-triplet", *with_it, "--glass-catalogue", "mine.agf")["efl_mm"]
        plain = self.json_of("lens", "info", "cooke-triplet", "--set", "surfaces[0].glass.index=1.7")["efl_mm"]
        self.assertEqual(option, plain)
        os.environ["PETZVAL_GLASS_CATALOGUES"] = str(self.folder / "mine.agf")
        try:
            self.assertEqual(self.json_of("lens", "info", "cooke-triplet", *with_it)["efl_mm"], plain)
        finally:
            del os.environ["PETZVAL_GLASS_CATALOGUES"]
        self.write("broken.agf", AGF.replace("1.7 0", "1.7x 0"))
        self.assert_refused("glass", "list", "--glass-catalogue", "broken.agf", words=["broken.agf:3"])
        self.assert_refused("glass", "list", "--glass-catalogue", "absent.agf", words=["absent.agf"])


if __name__ == "__main__":
    unittest.main()
