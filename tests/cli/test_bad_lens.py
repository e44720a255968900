# SPDX-License-Identifier: BSD-3-Clause
"""Lenses that are no lenses: every command that takes one refuses them alike."""

import json
import unittest

from petzval_cli import ProgramTest
from sample_files import SINGLET, singlet, singlet_with_surface


class BadLensFile(ProgramTest):
    def refuse(self, lens, *words, name="bad.json"):
        self.write(name, lens)
        self.assert_refused("lens", "info", name, words=words)

    def test_the_sample_itself_is_right(self):
        self.write("singlet.json", SINGLET)
        efl_mm = self.json_of("lens", "info", "singlet.json")["efl_mm"]
        # 51.68 mm / (n − 1) with n to five decimals: 0.005/0.5168 of a per cent.
        self.assertAlmostEqual(efl_mm, 100.0, delta=0.005)

    def test_missing_file(self):
        self.assert_refused("lens", "info", "nowhere.json", words=["nowhere.json"])

    def test_a_folder(self):
        (self.folder / "folder.json").mkdir()
        self.assert_refused("lens", "info", "folder.json", words=["folder.json"])

    def test_unknown_name_tells_the_nearest(self):
        self.assert_refused("lens", "info", "edmund-54853", words=["edmund-54853", "edmund-54852"])

    def test_every_truncation(self):
        text = json.dumps(SINGLET, indent=1)
        for length in range(0, len(text), 17):
            self.refuse(text[:length], "bad.json")

    def test_noise(self):
        self.refuse(b"\x00\xff\xfe" * 100, "bad.json")
        self.refuse("[" * 100000, "bad.json")
        self.refuse(b"", "bad.zmx", name="bad.zmx")
        self.refuse(b"\x00\xff\xfe" * 100, "bad.dat", name="bad.dat")
        self.refuse("a lens", "bad.txt", name="bad.txt")

    def test_unknown_key_with_its_line(self):
        text = json.dumps(singlet_with_surface(1, radius=5), indent=1)
        line = next(number for number, content in enumerate(text.splitlines(), 1) if '"radius"' in content)
        self.write("bad.json", text)
        self.assert_refused("lens", "info", "bad.json", words=[f"bad.json:{line}:", "radius"])

    def test_missing_keys(self):
        for key in ("surfaces", "aperture", "format"):
            lens = singlet()
            del lens[key]
            self.refuse(lens, "bad.json", key)

    def test_all_missing_keys_at_once(self):
        self.refuse({"surfaces": singlet()["surfaces"]}, '"format"', '"aperture"', '"wavelengths_nm"', "f_number")

    def test_the_last_distance_may_be_left_out(self):
        lens = singlet()
        del lens["surfaces"][-1]["thickness_mm"]
        self.write("open.json", lens)
        info = self.json_of("lens", "info", "open.json")
        self.write("whole.json", SINGLET)
        self.assertAlmostEqual(info["paraxial_image_mm"],
                               self.json_of("lens", "info", "whole.json")["paraxial_image_mm"], delta=1e-9)
        last = len(lens["surfaces"]) - 1
        self.assertAlmostEqual(self.json_of("lens", "info", "whole.json", "--set", f"surfaces[{last}].thickness_mm=paraxial")
                               ["total_track_mm"], info["total_track_mm"], delta=1e-9)
        del lens["surfaces"][0]["thickness_mm"]
        self.refuse(lens, "thickness_mm")

    def test_another_format_version(self):
        self.refuse(singlet(format="petzval-lens/9"), "petzval-lens/1")

    def test_unknown_glass_tells_the_nearest(self):
        self.refuse(singlet_with_surface(1, glass="SCHOTT:N-BK77"), "N-BK77", "N-BK7")

    def test_impossible_numbers(self):
        self.refuse(singlet(surfaces=[]), "bad.json")
        self.refuse(singlet_with_surface(1, radius_mm=0), "bad.json")
        self.refuse(singlet_with_surface(1, radius_mm="51.68"), "bad.json")
        self.refuse(singlet_with_surface(1, semi_diameter_mm=-1), "bad.json")
        self.refuse(singlet_with_surface(1, glass={"index": 0.2}), "bad.json")
        self.refuse(singlet(aperture={"f_number": -1}), "bad.json")
        self.refuse(singlet(aperture={"f_number": 1, "image_na": 0.1}), "bad.json")
        self.refuse(singlet(wavelengths_nm=[]), "bad.json")
        self.refuse(singlet(object_distance_mm=-10), "bad.json")
        self.refuse(json.dumps(SINGLET).replace("51.68", "1e999"), "bad.json")
        self.refuse(json.dumps(SINGLET).replace("51.68", "NaN"), "bad.json")

    def test_no_stop_and_two_stops(self):
        self.refuse(singlet_with_surface(0, stop=False), "stop")
        self.refuse(singlet_with_surface(2, stop=True), "stop")


class BadUse(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("singlet.json", SINGLET)

    def test_wavelength_outside_the_range_of_the_glass(self):
        # SCHOTT gives N-BK7 from 300 nm to 2500 nm.
        self.assert_refused("lens", "info", "singlet.json", "--wavelength", "100", words=["N-BK7", "300", "2500"])
        for wavelength in ("0", "-5", "nan", "inf", "blue"):
            self.assert_refused("lens", "info", "singlet.json", "--wavelength", wavelength)

    def test_settings_that_name_nothing(self):
        for setting in ("surfaces[7].radius_mm=1", "surfaces[1].colour=1", "surfaces[1]", "=", "surfaces[-1].conic=0",
                        "surfaces[1].radius_mm=", "surfaces[99999999999999999999].conic=0"):
            self.assert_refused("lens", "info", "singlet.json", "--set", setting)

    def test_settings_that_make_no_lens(self):
        self.assert_refused("lens", "info", "singlet.json", "--set", "surfaces[1].glass=NO-SUCH", words=["NO-SUCH"])
        self.assert_refused("lens", "info", "singlet.json", "--set", "aperture.f_number=-2")

    def test_substitution(self):
        self.write("unknown.json", singlet_with_surface(1, glass="SECRET-7"))
        self.assert_refused("lens", "info", "unknown.json", words=["SECRET-7", "--substitute"])
        self.assert_succeeds("lens", "info", "unknown.json", "--substitute", "SECRET-7=SCHOTT:N-BK7")
        self.assert_succeeds("lens", "info", "unknown.json", "--substitute", "SECRET-7=1.61025/56.71")
        self.assert_refused("lens", "info", "unknown.json", "--substitute", "SECRET-7=NO-SUCH", words=["NO-SUCH"])
        self.assert_refused("lens", "info", "unknown.json", "--substitute", "SECRET-7", words=["--substitute"])
        self.assert_refused("lens", "info", "singlet.json", "--substitute", "ABSENT=SCHOTT:F2",
                            words=["ABSENT", "no such glass"])

    def test_a_folder(self):
        self.assert_refused("lens", "info", "..", words=["folder"])

    def test_a_stop_that_no_ray_passes(self):
        """A clear aperture of a micrometre before a stop that lies far off axis in no one's way: the rays that would
        fill the stop all end at the rim."""
        blocked = singlet_with_surface(0, semi_diameter_mm=0)
        self.write("blocked.json", blocked)
        for command in ("illumination", "distortion", "psf"):
            self.assert_refused("lens", command, "blocked.json")


class BadTrace(ProgramTest):
    HEADER = "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n"

    def setUp(self):
        super().setUp()
        self.write("singlet.json", SINGLET)

    def refuse(self, text, *words):
        self.write("rays.csv", text)
        self.assert_refused("lens", "trace", "singlet.json", "--rays", "rays.csv", "-o", "out.csv", words=words)

    def test_bad_rays(self):
        self.refuse("", "rays.csv")
        self.refuse("x_mm,y_mm\n1,2\n", "rays.csv")
        self.refuse(self.HEADER + "0,0,0,0,0,1\n", "rays.csv:2:")
        self.refuse(self.HEADER + "0,0,0,0,0,1,587.56\n0,0,zero,0,0,1,587.56\n", "rays.csv:3:")
        self.refuse(self.HEADER + "0,0,nan,0,0,1,587.56\n", "rays.csv:2:")
        self.refuse(self.HEADER + "0,0,0,0,0,0,587.56\n", "rays.csv:2:")
        self.refuse(self.HEADER + "0,0,0,0,0,1,100\n", "N-BK7")

    def test_rays_that_fail_are_rows_not_errors(self):
        self.write("rays.csv", self.HEADER + "0,0,-5,0,0,1,587.56\n0,7,-5,0,0,1,587.56\n0,100,-5,0,0,1,587.56\n")
        self.assert_succeeds("lens", "trace", "singlet.json", "--rays", "rays.csv", "-o", "out.csv")
        rows = (self.folder / "out.csv").read_text().splitlines()
        self.assertEqual(rows[0], "status,x_mm,y_mm,z_mm,L,M,N,opl_mm,ends_at_surface,beyond_aperture_mm")
        self.assertEqual([row.split(",")[0] for row in rows[1:]], ["ok", "vignetted", "vignetted"])
        self.assert_succeeds("lens", "trace", "singlet.json", "--rays", "rays.csv", "-o", "out.csv", "--ignore-apertures")
        rows = (self.folder / "out.csv").read_text().splitlines()
        self.assertEqual([row.split(",")[0] for row in rows[1:]], ["ok", "ok", "missed"])


if __name__ == "__main__":
    unittest.main()
