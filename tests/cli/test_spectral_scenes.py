# SPDX-License-Identifier: BSD-3-Clause
"""Spectral scenes of other programs' making, from files written byte by byte."""

import itertools
import json
import math
import struct
import unittest

import petzval_cli
import sample_files
import spectral_files

PLANCK, LIGHT, BOLTZMANN = 6.62607015e-34, 299792458.0, 1.380649e-23


def planck(wavelength_nm, kelvin):
    """W/(m2 sr nm)"""
    m = wavelength_nm * 1e-9
    return 2e-9 * PLANCK * LIGHT**2 / m**5 / math.expm1(PLANCK * LIGHT / (m * BOLTZMANN * kelvin))


class SpectralScenes(petzval_cli.ProgramTest):
    def values(self, *scene):
        """What `scene info` says."""
        return self.json_of("scene", "info", *scene)

    def assert_corner(self, *scene):
        """A scene of 4 x 3 samples, 4 degrees wide, whose upper right one alone is bright comes out upright."""
        self.write("lens.json", sample_files.singlet())
        self.assert_succeeds("image", *scene, "--scene-distance", "inf", "--lens", "lens.json", "--method", "none",
                             "--sensor", "8x6@850", "--wavelengths", 550, "-o", "corner.npy")
        pixels = struct.unpack("<48f", (self.folder / "corner.npy").read_bytes()[-48 * 4:])
        brightest = max(range(48), key=pixels.__getitem__)
        self.assertIn(brightest, (6, 7, 14, 15), pixels)  # the first two rows, the last two columns

    def number(self, row, column, band):
        return 1 + column + 10 * row + 60 * band

    def assert_counts(self, name, *options, factor=1.0):
        """The scene is 3 x 2 samples of number(), times a factor, in three bands."""
        facts = self.values(name, "--scene-angle", 10, *options)
        self.assertEqual((facts["columns"], facts["rows"], facts["bands"]), (3, 2, 3))
        for band, mean in enumerate(facts["mean_radiance"]):
            self.assertAlmostEqual(mean / factor, 1 + 1 + 5 + 60 * band, delta=2e-6 * 130)
        self.assertAlmostEqual(facts["min_radiance"] / factor, 1, delta=1e-5)
        self.assertAlmostEqual(facts["max_radiance"] / factor, 133, delta=1e-4)
        return facts

    def test_envi_of_every_kind(self):
        for interleave, data_type, big in itertools.product(("bsq", "bil", "bip"), spectral_files.ENVI_TYPES, (0, 1)):
            with self.subTest(interleave=interleave, data_type=data_type, big_endian=big):
                header, data = spectral_files.envi(3, 2, 3, self.number, data_type, interleave, bool(big), offset=7 * big,
                                                   wavelength=[450, 550, 650], wavelength_units="Nanometers")
                self.write("cube.hdr", header)
                self.write("cube.img", data)
                facts = self.assert_counts("cube.hdr", "--scene-quantity", "radiance")
                self.assertEqual(facts["wavelengths_nm"], [450, 550, 650])
                self.assert_counts("cube.img", "--scene-quantity", "radiance")

    def test_what_lies_where(self):
        def corner(row, column, band):
            return float((row, column) == (0, 3))

        quantity = ("--scene-quantity", "radiance", "--scene-angle", 4)
        for interleave in spectral_files.INTERLEAVES:
            header, data = spectral_files.envi(4, 3, 2, corner, interleave=interleave, wavelength=[550, 600])
            self.write("corner.hdr", header)
            self.write("corner", data)
            self.assert_corner("corner.hdr", *quantity)
        numbers = [corner(row, column, band) for row in range(3) for column in range(4) for band in range(2)]
        self.write("array.npy", spectral_files.npy((3, 4, 2), numbers))
        self.assert_corner("array.npy", *quantity, "--scene-bands", "550,600")
        numbers = [corner(row, column, 0) * 1e17 for column in range(4) for row in range(3)]
        self.write("corner.mat", spectral_files.mat(
            spectral_files.mat_numbers("mcCOEF", (3, 4), numbers),
            spectral_files.mat_struct("basis", {
                "basis": lambda name: spectral_files.mat_numbers(name, (2, 1), [1, 1]),
                "wave": lambda name: spectral_files.mat_numbers(name, (1, 2), [550, 600])})))
        self.assert_corner("corner.mat", "--scene-angle", 4)

    def test_envi_wavelengths_units_and_order(self):
        for unit, scale in (("Nanometers", 1), ("Micrometers", 1e-3), ("um", 1e-3), ("Unknown", 1e-3), ("nm", 1)):
            header, data = spectral_files.envi(3, 2, 3, lambda y, x, b: self.number(y, x, 2 - b),
                                               wavelength=[650 * scale, 550 * scale, 450 * scale], wavelength_units=unit)
            self.write("cube.hdr", header)
            self.write("cube.dat", data)
            facts = self.assert_counts("cube.hdr", "--scene-quantity", "radiance")
            for nm, wanted in zip(facts["wavelengths_nm"], (450, 550, 650)):
                self.assertAlmostEqual(nm, wanted, delta=1e-9)

    def test_envi_calibrations(self):
        bands = {"wavelength": [450, 550, 650]}
        cases = {
            "gain": ({"data_gain_values": [2, 2, 2]}, 2e-3),  # per um
            "units": ({"data_units": "uW/cm2/sr/nm"}, 1e-2),
            "units and gain": ({"data_units": "W m-2 sr-1 nm-1", "data_gain_values": [0.5] * 3}, 0.5),
        }
        for name, (entries, factor) in cases.items():
            with self.subTest(name):
                header, data = spectral_files.envi(3, 2, 3, self.number, 12, **bands, **entries)
                self.write("cube.hdr", header)
                self.write("cube.raw", data)
                self.assert_counts("cube.raw", factor=factor)
                self.assert_counts("cube.raw", "--scene-scale", 3, factor=3 * factor)
        header, data = spectral_files.envi(2, 1, 3, lambda y, x, b: (5000, 10000)[x], 12, **bands,
                                           reflectance_scale_factor=10000)
        self.write("cube.hdr", header)
        self.write("cube.raw", data)
        self.assert_refused("scene", "info", "cube.hdr", "--scene-angle", 10, words=["--illuminant"])
        facts = self.values("cube.hdr", "--scene-angle", 10, "--illuminant", "E")
        self.assertAlmostEqual(facts["min_radiance"] / facts["max_radiance"], 0.5, delta=1e-6)
        self.assertAlmostEqual(facts["mean_luminance_cd_m2"], 100, delta=1e-3)

    def test_what_openexr_files_leave_open_is_said(self):
        """The channels are renamed and an attribute called otherwise, byte by byte."""
        whole = sample_files.spectral_exr(3, 2, [450, 550], self.number)
        ask = ("scene", "info", "s.exr", "--scene-angle", 10)

        def notes(content, *options):
            self.write("s.exr", content)
            done = self.petzval(*ask, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stderr

        self.assertEqual(notes(whole), "")
        unsaid = whole.replace(b"emissiveUnits", b"somethingElse")
        self.assertIn("s.exr: does not say the unit", notes(unsaid))
        self.assertEqual(notes(unsaid, "--quiet"), "")
        self.assertEqual(notes(unsaid, "--scene-unit", "W.m^-2.sr^-1.nm^-1"), "")
        both = whole.replace(b"S0.550,000000nm", b"T.550,0000000nm")
        self.assertIn("the light is taken", notes(both))
        self.assertEqual(self.values(*ask[2:])["wavelengths_nm"], [450])

    def test_reflectances_in_per_cent(self):
        """A perfect white is 1, not 100; the picture would not show it, for the mean of the scene sets its level."""
        self.write("r.npy", spectral_files.npy((1, 2, 1), [80, 20]))
        ask = ("r.npy", "--scene-quantity", "reflectance", "--scene-bands", 550, "--illuminant", "D65", "--scene-angle", 20)
        self.assert_refused("scene", "info", *ask, words=["r.npy", "up to 80", "--scene-scale 0.01"])
        self.assert_refused("image", *ask, "--lens", "edmund-54852", "--sensor", "4x4@6", "-o", "r.png", words=["up to 80"])
        done = self.petzval("scene", "info", *ask, "--scene-scale", 0.01)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("100 cd/m2", done.stderr)
        done = self.petzval("image", *ask, "--scene-scale", 0.01, "--lens", "edmund-54852", "--sensor", "4x4@6", "--method",
                            "none", "--surround", "zero", "-o", "light.npy")
        self.assertIn("r.npy: reflectances have no level of light", done.stderr)

    def test_envi_bad_bands_and_numbers_without_meaning(self):
        header, data = spectral_files.envi(3, 2, 4, lambda y, x, b: -9999 if b == 1 else self.number(y, x, b - (b > 1)),
                                           wavelength=[450, 500, 550, 650], bbl=[1, 0, 1, 1])
        self.write("cube.hdr", header)
        self.write("cube.bsq", data)
        self.assert_counts("cube.hdr", "--scene-quantity", "radiance")
        header, data = spectral_files.envi(2, 1, 1, lambda y, x, b: (-9999, 4)[x], 2, wavelength=[550],
                                           data_ignore_value=-9999)
        self.write("cube.hdr", header)
        self.write("cube.bsq", data)
        facts = self.values("cube.hdr", "--scene-quantity", "radiance", "--scene-angle", 5)
        self.assertEqual((facts["min_radiance"], facts["max_radiance"]), (0, 4))
        # GDAL's: NaN, and the least single-precision number in more or fewer digits than it has.
        for written, number in (("nan", math.nan), ("NaN", math.nan), ("-3.40282347e+38", -(2 - 2**-23) * 2.0**127)):
            header, data = spectral_files.envi(2, 1, 1, lambda y, x, b: (number, 4)[x], 4, wavelength=[550],
                                               data_ignore_value=written)
            self.write("cube.hdr", header)
            self.write("cube.bsq", data)
            facts = self.values("cube.hdr", "--scene-quantity", "radiance", "--scene-angle", 5)
            self.assertEqual((facts["min_radiance"], facts["max_radiance"]), (0, 4), written)

    def test_envi_that_lies(self):
        good = dict(wavelength=[450, 550, 650])
        header, data = spectral_files.envi(3, 2, 3, self.number, **good)
        ask = ("scene", "info", "cube.hdr", "--scene-quantity", "radiance", "--scene-angle", 10)

        def refused(header, data, *words):
            self.write("cube.hdr", header)
            self.write("cube.img", data)
            self.assert_refused(*ask, words=words)

        refused(header, data[:-1], "71 bytes", "72")
        refused(header, data + b"\0", "73 bytes", "72")
        refused(header.replace("samples = 3", "samples = 4"), data, "4 x 2")
        refused(header.replace("samples = 3", "samples = 2000000000").replace("lines   = 2", "lines = 2000000000"), data,
                "GiB")
        refused(header.replace("samples = 3", "samples = 40000").replace("lines   = 2", "lines = 40000"), data, "17.9 GiB")
        refused(header.replace("bands = 3", "bands = 2"), data, "wavelength", "2 bands")
        refused(header.replace("samples = 3", "samples = -3"), data, "cube.hdr:3", "-3")
        refused(header.replace("data type = 4", "data type = 6"), data, "data type 6")
        refused(header.replace("bsq", "bqs"), data, "bsq, bil or bip")
        refused(header.replace("lines   = 2\n", ""), data, "lines")
        refused(header.replace("interleave = bsq\n", ""), data, "has no interleave; bsq, bil or bip")
        refused(header + "Lines = 2\n", data, f"cube.hdr:{header.count(chr(10)) + 1}", "'lines' again, after line 4")
        refused(header.replace("650}", "650"), data, "brace")
        refused(header.replace("550", "450"), data, "two bands")
        refused(header + "wavelength units = Wavenumber\n", data, "nanometers")
        refused(header + "file compression = 1\n", data, "compressed")
        refused("JPEG" + header[4:], data, "ENVI")
        refused(header, struct.pack("<18f", *[1] * 17, math.nan), "650 nm", "row 1, column 2")
        refused(header, struct.pack("<18f", -1, *[1] * 17), "450 nm", "row 0, column 0")
        self.write("cube.img", struct.pack("<18f", -1, *[1] * 17))
        self.assert_succeeds(*ask, "--scene-negative-zero")
        (self.folder / "cube.img").unlink()
        self.assert_refused(*ask, words=["cube.img"])

    def test_numpy_arrays(self):
        numbers = [self.number(y, x, b) for y in range(2) for x in range(3) for b in range(3)]
        for kind, version in itertools.product(("<f4", ">f4", "<f8", ">f8", "<u2", ">u2", "|u1", "<i2", ">i4", "<f2", ">f2",
                                               "<i8", ">i8", "<u8"), (1, 2)):
            with self.subTest(kind=kind, version=version):
                self.write("cube.npy", spectral_files.npy((2, 3, 3), numbers, kind, version=version))
                self.assert_counts("cube.npy", "--scene-quantity", "radiance", "--scene-bands", "450:100:650")
        # The first index fastest, as numpy.asfortranarray leaves it.
        turned = [self.number(y, x, b) for b in range(3) for x in range(3) for y in range(2)]
        ask = ("--scene-quantity", "radiance", "--scene-bands", "450:100:650", "--scene-angle", 10)
        self.assert_succeeds("scene", "convert", "cube.npy", *ask, "straight.exr")
        self.write("cube.npy", spectral_files.npy((2, 3, 3), turned, "<f8", fortran=True))
        self.assert_succeeds("scene", "convert", "cube.npy", *ask, "turned.exr")
        self.assertEqual(self.contents()["turned.exr"], self.contents()["straight.exr"])
        self.assert_refused("scene", "info", "cube.npy", "--scene-quantity", "radiance", "--scene-angle", 10,
                            words=["--scene-bands"])
        self.assert_refused("scene", "info", "cube.npy", "--scene-bands", "450:100:650", "--scene-angle", 10,
                            words=["--scene-quantity"])
        self.assert_refused("scene", "info", "cube.npy", "--scene-bands", "450,550", "--scene-quantity", "radiance",
                            "--scene-angle", 10, words=["3 bands"])
        self.write("cube.json", {"wavelengths_nm": [450, 550, 650], "quantity": "radiance", "unit": "mW/(m^2 sr nm)",
                                 "angle_deg": 21, "distance_m": 1.5, "scale": 2, "name": "bench"})
        facts = self.assert_counts("cube.npy", factor=2e-3)
        self.assertEqual((facts["distance_m"], facts["name"]), (1.5, "bench"))
        self.assertAlmostEqual(self.values("cube.npy")["horizontal_angle_deg"], 21)
        self.write("cube.json", {"wavelength": [450, 550, 650]})
        self.assert_refused("scene", "info", "cube.npy", words=["cube.json", "wavelength"])

    def test_exr_units_in_the_wild(self):
        content = sample_files.spectral_exr(3, 2, [450, 550, 650], self.number)
        for unit, factor in (("W.m^-2.sr^-1", 1), ("mW m-2 sr1 ", None), ("W/m2/sr/um ", 1e-3), ("W*m**-2/sr", 1)):
            old = b"W.m^-2.sr^-1"
            new = unit.encode()
            # The same length keeps the offsets of the file.
            self.assertLessEqual(len(new), len(old))
            self.write("a.exr", content.replace(old, new.ljust(len(old))))
            if factor is None:
                self.assert_refused("scene", "info", "a.exr", "--scene-angle", 10, words=["radiance"])
            else:
                self.assert_counts("a.exr", factor=factor)

    def test_iset_in_its_compressed_form(self):
        """mcCOEF x basis + imgMean, photons to energy; below 0 is 0."""
        waves, functions = [500.0, 600.0], [[1.0, 0.5], [0.0, 2.0]]  # [function][wave]
        coefficients = {(0, 0): (10, 1), (0, 1): (20, 0), (1, 0): (0, 5), (1, 1): (-50, 0), (0, 2): (4, 4), (1, 2): (1, 1)}
        mean = [3.0, 7.0]
        places = [(row, column) for column in range(3) for row in range(2)]  # MATLAB's order
        numbers = [coefficients[place][k] * 1e17 for k in range(2) for place in places]
        variables = [
            spectral_files.mat_numbers("mcCOEF", (2, 3, 2), numbers),
            spectral_files.mat_struct("basis", {
                "basis": lambda name: spectral_files.mat_numbers(name, (2, 2), [v for f in functions for v in f]),
                "wave": lambda name: spectral_files.mat_numbers(name, (1, 2), waves)}),
            spectral_files.mat_numbers("imgMean", (2, 1), [v * 1e17 for v in mean]),
            spectral_files.mat_struct("illuminant", {
                "wavelength": lambda name: spectral_files.mat_numbers(name, (1, 2), waves),
                "data": lambda name: spectral_files.mat_numbers(name, (2, 1), [0.5, 0.25])}),
            spectral_files.mat_numbers("fov", (1, 1), [12]),
            spectral_files.mat_numbers("dist", (1, 1), [1.2]),
            spectral_files.mat_text("name", "church"),
        ]
        self.write("church.mat", spectral_files.mat(*variables))
        facts = self.values("church.mat")
        self.assertEqual((facts["columns"], facts["rows"], facts["wavelengths_nm"]), (3, 2, waves))
        self.assertEqual((facts["name"], facts["distance_m"], facts["has_illuminant"]), ("church", 1.2, True))
        self.assertAlmostEqual(facts["horizontal_angle_deg"], 12)
        for band, nm in enumerate(waves):
            photons = [max(0, mean[band] + sum(c * functions[k][band] for k, c in enumerate(coefficient)))
                       for coefficient in coefficients.values()]
            energy = [1e17 * n * PLANCK * LIGHT / (nm * 1e-9) for n in photons]
            self.assertAlmostEqual(facts["mean_radiance"][band], sum(energy) / 6, delta=1e-6 * sum(energy))
        # Without the mean and without a field of view.
        self.write("plain.mat", spectral_files.mat(*variables[:2]))
        self.assert_refused("scene", "info", "plain.mat", words=["fov", "--scene-angle"])
        self.values("plain.mat", "--scene-angle", 10)
        wrong = spectral_files.mat_numbers("mcCOEF", (2, 3, 1), numbers[:6])
        self.write("wrong.mat", spectral_files.mat(wrong, *variables[1:]))
        self.assert_refused("scene", "info", "wrong.mat", words=["mcCOEF", "2 functions"])
        short = spectral_files.mat_numbers("imgMean", (1, 1), [1])
        self.write("wrong.mat", spectral_files.mat(*variables[:2], short, variables[4]))
        self.assert_refused("scene", "info", "wrong.mat", words=["imgMean"])

    def test_another_light_on_a_scene_that_says_its_own(self):
        self.assert_succeeds("scene", "convert", "wall", "--scene-size", "4x3", "--illuminant", "E", "--wavelengths",
                             "400:10:700", "wall.exr")
        before = self.values("wall.exr")
        after = self.values("wall.exr", "--illuminant", "3000K")
        self.assertAlmostEqual(after["mean_luminance_cd_m2"] / before["mean_luminance_cd_m2"], 1, delta=1e-6)
        # The wall was white: now each band has what a black body, known every 5 nm, sends into it, up to a factor.
        def in_band(nm):
            near = [at for at in (nm - 5, nm, nm + 5) if 400 <= at <= 700]
            weights = [(2.5 if at in (400, 700) else 5) * (1 if at == nm else 0.5) for at in near]
            return sum(w * planck(at, 3000) for w, at in zip(weights, near)) / sum(weights)
        share = [value / in_band(nm) for value, nm in zip(after["mean_radiance"], after["wavelengths_nm"])]
        for each in share:
            self.assertAlmostEqual(each / share[15], 1, delta=1e-4)
        content = sample_files.spectral_exr(3, 2, [450, 550, 650], self.number)
        self.write("unknown.exr", content)
        self.assert_refused("scene", "info", "unknown.exr", "--scene-angle", 10, "--illuminant", "A", words=["light"])

    def test_warm_scenes(self):
        self.write("map.npy", spectral_files.npy((1, 2), [300, 310]))
        ask = ["map.npy", "--scene-quantity", "temperature", "--scene-angle", 10]
        facts = self.values(*ask, "--wavelengths", "8000:2000:12000")
        for nm, mean in zip(facts["wavelengths_nm"], facts["mean_radiance"]):
            self.assertAlmostEqual(mean / ((planck(nm, 300) + planck(nm, 310)) / 2), 1, delta=1e-6)
        facts = self.values(*ask, "--wavelengths", "10000", "--scene-emissivity", 0.9, "--scene-background", 280)
        wanted = 0.9 * (planck(10000, 300) + planck(10000, 310)) / 2 + 0.1 * planck(10000, 280)
        self.assertAlmostEqual(facts["mean_radiance"][0] / wanted, 1, delta=1e-6)
        self.assert_refused("scene", "info", *ask, words=["--wavelengths"])
        self.assert_refused("scene", "info", *ask, "--wavelengths", "9000", "--illuminant", "A", words=["warmth"])
        self.write("cold.npy", spectral_files.npy((1, 2), [300, -3]))
        self.assert_refused("scene", "info", "cold.npy", *ask[1:], "--wavelengths", "9000", words=["column 1"])

        self.write("cube.npy", spectral_files.npy((1, 2, 2), [0.5, 0.6, 1, 0.8]))
        ask = ["cube.npy", "--scene-bands", "9000,11000", "--scene-quantity", "emissivity", "--scene-angle", 10]
        facts = self.values(*ask, "--scene-temperature", 320)
        for nm, mean, emissivity in zip((9000, 11000), facts["mean_radiance"], (0.75, 0.7)):
            self.assertAlmostEqual(mean / (emissivity * planck(nm, 320)), 1, delta=1e-6)
        self.assert_refused("scene", "info", *ask, words=["--scene-temperature"])
        self.assert_refused("scene", "info", "wall", "--scene-temperature", 300, words=["thermal"])

    def test_resampling_keeps_the_radiance(self):
        content = sample_files.spectral_exr(1, 1, list(range(400, 701, 10)), lambda y, x, b: (b * b) % 7)
        self.write("a.exr", content)

        def total(*options):
            facts = self.values("a.exr", "--scene-angle", 5, *options)
            nm, mean = facts["wavelengths_nm"], facts["mean_radiance"]
            return sum((b - a) * (u + v) / 2 for a, b, u, v in zip(nm, nm[1:], mean, mean[1:]))

        for bands in ("400:50:700", "400:7.5:700", "400,430,610,700"):
            self.assertAlmostEqual(total("--wavelengths", bands) / total(), 1, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
