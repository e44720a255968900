# SPDX-License-Identifier: BSD-3-Clause
"""Wavelengths in um where nm are wanted: every reader refuses them in the same words, or knows their unit."""

import unittest

import spectral_files
from petzval_cli import ProgramTest
from sample_files import SINGLET, SMALL_BAYER, singlet, singlet_with_surface, spectral_exr

WORDS = ["wavelengths are in nm; 550 would be right for 0.55"]
INFO = ["scene", "info"]
RADIANCE = ["--scene-quantity", "radiance", "--scene-angle", "5"]


class Micrometres(ProgramTest):
    def refused(self, *command, words=()):
        self.assert_refused(*command, words=[*WORDS, *words])

    def test_options(self):
        self.write("cube.npy", spectral_files.npy((2, 2, 2), range(8)))
        self.write("lens.json", SINGLET)
        self.refused(*INFO, "cube.npy", *RADIANCE, "--scene-bands", "0.55,0.65", words=["0.55,0.65"])
        self.refused(*INFO, "wall", "--wavelengths", "0.55:0.05:0.7")
        self.refused("image", "wall", "--lens", "lens.json", "--wavelengths", "0.55,0.65", "-o", "out.png")
        self.refused("optics", "build", "lens.json", "--wavelengths", "0.55", "-o", "table.h5")
        for command in (["lens", "mtf", "lens.json"], ["lens", "spots", "lens.json"], ["glass", "show", "SCHOTT:N-BK7"]):
            self.refused(*command, "--wavelengths", "0.55", words=["--wavelengths 0.55"])
        self.refused("lens", "info", "lens.json", "--wavelength", "0.55", words=["--wavelength 0.55"])
        self.refused("target", "--rectangle", "20x20@5", "--wavelength", "0.55", "-o", "out.png")

    def test_scenes(self):
        self.write("cube.npy", spectral_files.npy((2, 2, 2), range(8)))
        self.write("cube.json", {"quantity": "radiance", "angle_deg": 5, "wavelengths_nm": [0.55, 0.65]})
        self.refused(*INFO, "cube.npy", words=["cube.npy"])
        self.write("cube.exr", spectral_exr(2, 2, [0.55, 0.65], lambda *place: 1))
        self.refused(*INFO, "cube.exr", *RADIANCE, words=["cube.exr"])
        self.write("cube.mat", spectral_files.mat(
            spectral_files.mat_numbers("mcCOEF", (2, 2), [1e17] * 4),
            spectral_files.mat_struct("basis", {
                "basis": lambda name: spectral_files.mat_numbers(name, (2, 1), [1, 1]),
                "wave": lambda name: spectral_files.mat_numbers(name, (1, 2), [0.55, 0.6])})))
        self.refused(*INFO, "cube.mat", "--scene-angle", "4", words=["cube.mat"])

    def test_envi_says_its_unit_or_is_asked_for_it(self):
        for unit, said in (({"wavelength_units": "Micrometers"}, ""), ({}, "450 to 650 nm are taken"),
                           ({"wavelength_units": "Unknown"}, "450 to 650 nm are taken")):
            header, data = spectral_files.envi(2, 2, 3, lambda *place: 1, wavelength=[0.45, 0.55, 0.65], **unit)
            self.write("cube.hdr", header)
            self.write("cube.img", data)
            done = self.petzval(*INFO, "cube.hdr", *RADIANCE)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(said, done.stderr)
            self.assertEqual("unit of its wavelengths" in done.stderr, bool(said))
        header, data = spectral_files.envi(2, 2, 2, lambda *place: 1, wavelength=[0.55, 0.65], wavelength_units="Nanometers")
        self.write("cube.hdr", header)
        self.write("cube.img", data)
        self.refused(*INFO, "cube.hdr", *RADIANCE, words=["cube.hdr"])

    def test_lenses_and_rays(self):
        self.write("lens.json", singlet(wavelengths_nm=[0.55], reference_wavelength_nm=0.55))
        self.refused("lens", "info", "lens.json", words=["lens.json:", "wavelengths_nm[0]"])
        self.write("lens.json", singlet(reference_wavelength_nm=0.55))
        self.refused("lens", "info", "lens.json", words=["reference_wavelength_nm"])
        self.write("lens.json", singlet_with_surface(1, glass={"index_table": {"0.55": 1.5, "0.65": 1.49}}))
        self.refused("lens", "info", "lens.json", words=["lens.json:"])
        self.write("lens.json", SINGLET)
        self.write("rays.csv", "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n0,0.1,-5,0,0,1,0.55\n")
        self.refused("lens", "trace", "lens.json", "--rays", "rays.csv", words=["rays.csv:2"])
        self.write("coating.csv", "wavelength_nm,air_glass\n0.55,0.01\n0.65,0.01\n")
        self.refused("optics", "build", "lens.json", "--coating", "coating.csv", "-o", "table.h5", words=["coating.csv:2"])

    def test_spectra_and_sensors(self):
        self.write("lamp.csv", "wavelength_nm,power\n0.45,1\n0.55,1\n")
        self.refused(*INFO, "wall", "--illuminant", "lamp.csv", words=["lamp.csv:3"])
        sensor = {**SMALL_BAYER, "channels": [{"name": name, "quantum_efficiency": [{"wavelengths_nm": [0.55, 0.65], "values": [1, 1]}]}
                                              for name in ("red", "green", "blue")]}
        self.write("sensor.json", sensor)
        self.refused("image", "wall", "--lens", "edmund-54852", "--sensor", "sensor.json", "-o", "out.png", words=["sensor.json"])

    def test_what_is_right_is_taken(self):
        """From the vacuum ultraviolet to heat."""
        self.assertEqual(self.json_of(*INFO, "wall", "--wavelengths", "120,550,830")["wavelengths_nm"], [120, 550, 830])
        self.write("cube.npy", spectral_files.npy((2, 2, 2), [1] * 8))
        self.assertEqual(self.json_of(*INFO, "cube.npy", *RADIANCE, "--scene-bands", "8000,14000")["wavelengths_nm"], [8000, 14000])


if __name__ == "__main__":
    unittest.main()
