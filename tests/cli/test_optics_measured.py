# SPDX-License-Identifier: BSD-3-Clause
"""petzval optics import of measurements: PSFs and MTFs of a real lens from CSV files."""

import math
import unittest

import h5py
import numpy as np

import iset_files
from petzval_cli import ProgramTest

HEAD = "# name: measured\n# focal_length_mm: 8\n# f_number: 2.5\n"


def mtf_csv(rows, head=HEAD):
    return head + "field_mm,wavelength_nm,frequency_cpmm,tangential,sagittal\n" + "".join(
        ",".join(repr(float(v)) for v in row) + "\n" for row in rows)


def psf_csv(rows, head=HEAD):
    return head + "field_mm,wavelength_nm,x_mm,y_mm,value\n" + "".join(
        ",".join(repr(float(v)) for v in row) + "\n" for row in rows)


class Measured(ProgramTest):
    def take(self, text, *options, curves=None):
        self.write("m.csv", text)
        if curves:
            self.write("curves.csv", curves)
            options = (*options, "--curves", "curves.csv")
        done = self.petzval("optics", "import", "m.csv", *options, "-o", "m.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.notes = done.stderr
        with h5py.File(self.folder / "m.h5") as file:
            return {key: file[key][...].astype("f8") for key in file if key != "first_order"}

    def psf(self, table, field, wave=0):
        """The PSF's own samples, and their places along one axis [um]."""
        size, side = int(table["psf_size"][field, wave]), table["psf"].shape[2]
        start = side // 2 - size // 2
        inner = table["psf"][field, wave, start:start + size, start:start + size]
        return inner, (np.arange(size) - size // 2) * table["psf_spacing"][field, wave]


class Mtf(Measured):
    def test_a_gaussian(self):
        """exp(-2 π² σ² f²) is the transform of a Gaussian of width σ: round on the axis, long along t off it."""
        frequencies = np.arange(5, 205, 5)
        rows = [(field, 550, f, *(math.exp(-2 * (math.pi * sigma * f / 1000) ** 2) for sigma in sigmas))
                for field, sigmas in ((0, (2, 2)), (1, (3, 2))) for f in frequencies]
        table = self.take(mtf_csv(rows))
        self.assertIn("--curves", self.notes)
        psf, places = self.psf(table, 0)
        spacing = places[1] - places[0]
        t, s = np.meshgrid(places, places, indexing="ij")
        gaussian = spacing ** 2 / (2 * math.pi * 2 ** 2) * np.exp(-(s ** 2 + t ** 2) / (2 * 2 ** 2))
        # Between contrasts 5 cycles/mm apart a curve is drawn; samples are squares, a little sharper than the light.
        self.assertLess(np.abs(psf - gaussian).max(), 2e-2 * gaussian.max())
        # Off the axis: the transform of each line spread, added up here, is the contrast that went in.
        psf, places = self.psf(table, 1)
        for axis, sigma in ((1, 3), (0, 2)):
            lines = psf.sum(axis=axis)
            for f in frequencies:
                square = np.sinc(f / 1000 * (places[1] - places[0]))
                contrast = square * abs((lines * np.exp(-2j * math.pi * f / 1000 * places)).sum())
                self.assertAlmostEqual(contrast, math.exp(-2 * (math.pi * sigma * f / 1000) ** 2), delta=5e-3)

    def test_a_perfect_lens(self):
        """The contrast of a circular pupil gives the Airy disc: its peak is π/4 per (λN)², its dark ring lies at 1.22 λN."""
        cutoff = 1000 / (0.55 * 4)  # λN = 2.2 um
        frequencies = np.linspace(0, cutoff, 61)
        x = frequencies / cutoff
        contrast = 2 / math.pi * (np.arccos(x) - x * np.sqrt(1 - x * x))
        table = self.take(mtf_csv([(field, 550, f, c, c) for field in (0, 1) for f, c in zip(frequencies, contrast)]))
        psf, places = self.psf(table, 0)
        spacing, middle = places[1] - places[0], len(places) // 2
        # Square samples of a quarter of λN are 1 % sharper each way, and light below zero, cut off, is 1 % of it.
        self.assertAlmostEqual(psf[middle, middle] / spacing ** 2 * 2.2 ** 2, math.pi / 4, delta=0.04 * math.pi / 4)
        line = psf[middle, middle:]
        ring = 1.22 * 2.2
        self.assertLess(np.interp(ring, places[middle:], line), 0.004 * line[0])
        self.assertGreater(np.interp(0.75 * ring, places[middle:], line), 0.05 * line[0])

    def test_the_picture_of_an_edge_has_the_mtf_that_went_in(self):
        """A bench's MTF, a table, a picture of a slanted edge, and `sfr` on it: the bench's MTF times the pixel."""
        pitch_um, tilt = 5.0, math.radians(5)
        frequencies = np.arange(10, 210, 10)
        contrast = np.exp(-frequencies / 90)  # as a bench might find it: no Gaussian, long tails of light
        self.take(mtf_csv([(field, 550, f, c, c) for field in (0, 1) for f, c in zip(frequencies, contrast)]))
        self.assert_succeeds("image", "slanted-edge:5", "--optics", "m.h5", "--sensor", "160x160@5", "--wavelengths", "550",
                             "--scene-size", "2400x2400", "--scene-angle", "8", "--supersample", 4, "-o", "edge.exr")
        edge, = self.json_of("sfr", "edge.exr", "--roi", "40,20,80,120")["edges"]
        sfr = {round(f, 2): value for f, value in zip(edge["frequencies_cpp"], edge["sfr"])}
        for cpp in (0.1, 0.2, 0.3, 0.4, 0.5):
            pixel = np.sinc(cpp * math.cos(tilt)) * np.sinc(cpp * math.sin(tilt))
            wanted = np.exp(-1000 * cpp / pitch_um / 90) * pixel
            # 0.01 as in test_closed_loop: what lies beyond the windows of PSF and edge.
            self.assertAlmostEqual(sfr[cpp], wanted, delta=0.01, msg=cpp)

    def test_says_how_well_it_meets_what_no_light_can_do(self):
        # Contrast that stays at 1 and falls off a cliff: its PSF would be negative in rings.
        rows = [(field, 550, f, c, c) for field in (0, 1) for f, c in ((10, 1), (50, 1), (51, 0), (100, 0))]
        self.take(mtf_csv(rows))
        misfit = float(self.notes.split("meet them to ")[1].split()[0])
        self.assertGreater(misfit, 0.05)


class Psf(Measured):
    def rows(self, shift_um, fields=(0.0, 1.0, 2.0), waves=(500, 600), size=96):
        places = np.arange(size) - size // 2 + shift_um
        return [(field, nm, s / 1000, t / 1000, 1e4 * iset_files.light(s, t, field))
                for field in fields for nm in waves for t in places for s in places]

    def test_the_formula_comes_back(self):
        table = self.take(psf_csv(self.rows(0)))
        psf, places = self.psf(table, 2)
        t, s = np.meshgrid(places, places, indexing="ij")
        right = iset_files.light(s, t, 2.0)
        # Window of 96 um: the tail beyond it is 1e-4 of the light.
        self.assertLess(np.abs(psf[1:-1, 1:-1] - right[1:-1, 1:-1]).max(), 1e-4 * right.max())
        np.testing.assert_allclose(table["real_image_height"][:, 1], [0, 1, 2])

    def test_samples_beside_the_chief_ray_keep_the_centre_of_light(self):
        for shift in (0.5, 0.3):
            table = self.take(psf_csv(self.rows(shift, waves=(500,))))
            psf, places = self.psf(table, 1)
            self.assertAlmostEqual((psf.sum(axis=1) * places).sum(), 1000 * iset_files.OFFSET, delta=0.01)
            self.assertAlmostEqual((psf.sum(axis=0) * places).sum(), 500 * iset_files.OFFSET, delta=0.01)

    def test_curves(self):
        curves = "field_mm,paraxial_height_mm,relative_illumination\n" + "".join(
            f"{h},{h * (1 + 0.01 * h * h)!r},{1 - 0.05 * h * h!r}\n" for h in np.linspace(0, 3, 13))
        table = self.take(psf_csv(self.rows(0, waves=(500,), size=32)), "--g-axis", "0.2", curves=curves)
        np.testing.assert_allclose(table["g_sensor"][:, 0], 0.2 * (1 - 0.05 * np.array([0, 1, 4])), rtol=1e-6)
        fields = np.degrees(np.arctan(np.array([0, 1.01, 2.08]) / 8))
        np.testing.assert_allclose(table["object_field"], fields, rtol=1e-6)

    def test_pictures_are_made_with_it(self):
        self.take(psf_csv(self.rows(0)))
        said = self.json_of("image", "points:5", "--optics", "m.h5", "--sensor", "40x40@50", "--wavelengths", "550",
                            "-o", "p.npy")
        self.assertEqual(said["lens"], "measured")


class Refusals(Measured):
    def test_bad_files(self):
        good = [(f, 550, x, y, 1) for f in (0, 1) for x in (-0.001, 0, 0.001) for y in (-0.001, 0, 0.001)]
        self.take(psf_csv(good))
        contrast = [(f, 550, c, 0.5, 0.5) for f in (0, 1) for c in (10, 20)]
        self.take(mtf_csv(contrast))
        for text, words in (
                ("", ["column names"]), ("# name: a\n", ["column names"]), (psf_csv([]), ["no numbers"]),
                (psf_csv(good, "# f_number: 2\n"), ["focal_length_mm"]),
                (psf_csv(good, HEAD.replace("8", "long")), ["focal_length_mm", "long"]),
                (psf_csv(good[:-1]), ["1 mm and 550 nm", "8 samples", "make 9"]),
                (psf_csv(good + good[-1:]), ["10 samples"]),
                (psf_csv(good[9:]), ["field_mm 0"]),
                (psf_csv([row for row in good] + [(0, 600, 0, 0, 1)]), ["missing"]),
                (psf_csv([(f, w, x, y, -v) for f, w, x, y, v in good]), [":5", "--clip-negative"]),
                (psf_csv([(f, w, x, 2 * y, v) for f, w, x, y, v in good]), ["equal"]),
                (psf_csv([(f, w, x, y + 5 * y * y * 100, v) for f, w, x, y, v in good]), ["even steps"]),
                (psf_csv([(f, w, x + 1e3, y, v) for f, w, x, y, v in good]), ["too many"]),
                (psf_csv([(f, w, x, y, 0) for f, w, x, y, v in good]), ["no light"]),
                (psf_csv([(f, w, x, y, math.nan) for f, w, x, y, v in good]), [":5", "value", "nan"]),
                (psf_csv(good).replace("value", "light"), ["bad.csv: has no column value"]),
                (mtf_csv(contrast).replace("tangential", "radial"), ["bad.csv: has no column tangential"]),
                (psf_csv([(f, 0.55, x, y, v) for f, w, x, y, v in good]), ["550 would be right for 0.55"]),
                (psf_csv(good, HEAD.replace("f_number", "number")), ["does not say the f-number"]),
                (psf_csv(good, HEAD + "# object_distance_mm: -100\n"), ["object distance is -100 mm"]),
                (psf_csv(good) + "0,550,1\n", [":23", "3 values"]),
                (mtf_csv(contrast[::2]), ["two frequencies"]),
                (mtf_csv([(f, w, c, 1.2, s) for f, w, c, t, s in contrast]), ["1.2", "10 cycles/mm"]),
                (mtf_csv([(f, w, c, t, -s) for f, w, c, t, s in contrast]), ["-0.5"]),
                (mtf_csv(contrast + contrast), ["increase"])):
            with self.subTest(words=words):
                self.write("bad.csv", text)
                self.assert_refused("optics", "import", "bad.csv", "-o", "x.h5", words=["bad.csv", *words])
        self.write("good.csv", psf_csv(good))
        for text, words in (("", ["curves.csv", "is empty"]), ("field_mm,x\n0,1\n", ["relative_illumination"]),
                            ("field_mm,relative_illumination\n0,1\n0.5,1\n", ["0 to 1"]),
                            ("field_mm,relative_illumination\n0,1\n2,1\n1,1\n", ["curves.csv"])):
            with self.subTest(words=words):
                self.write("curves.csv", text)
                self.assert_refused("optics", "import", "good.csv", "--curves", "curves.csv", "-o", "x.h5", words=words)

    def test_noise_below_zero_is_clipped_when_asked(self):
        rows = [(f, 550, x, y, 1 - 3 * abs(x) * 1000) for f in (0, 1) for x in (-0.001, 0, 0.001)
                for y in (-0.001, 0, 0.001)]
        table = self.take(psf_csv(rows), "--clip-negative")
        np.testing.assert_allclose(self.psf(table, 0)[0], np.outer([1, 1, 1], [0, 1, 0]) / 3, atol=1e-7)


if __name__ == "__main__":
    unittest.main()
