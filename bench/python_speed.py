# SPDX-License-Identifier: BSD-3-Clause
"""Times of the Python package: what docs/ACCURACY.md tells under "Python". Best of several runs, one thread."""

import timeit
import warnings

import petzval as pz

warnings.simplefilter("ignore", pz.Note)


def show(what, call, number=1, repeat=7):
    seconds = min(timeit.repeat(call, number=number, repeat=repeat)) / number
    print(f"{what:<58} {seconds * 1e6:>14.2f} us")


lens = pz.Lens("edmund-54852")
show("lens.first_order()", lens.first_order, 2000)
design = pz.Camera(lens, f_number=4, focus="design")
show("camera.lens_in_use()", design.lens_in_use, 2000)
show("lens.distortion([0], wavelengths_nm=[550])", lambda: lens.distortion([0], wavelengths_nm=[550]), 300)
small = pz.Camera(lens, f_number=4, sensor="8x8@100").plan(
    pz.SceneRequest("checkerboard", columns=32, rows=32, wavelengths_nm=[550]), method="none")
show("plan.image(), 8 x 8 pixels without blur", lambda: small.image(threads=1), 300)
camera = pz.Camera("edmund-54852", focus="1.2m", sensor="640x480@7.5")
studio = pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650])
show("camera.image, 640 x 480 x 3", lambda: camera.image(studio, threads=1), repeat=3)
# Light at f/1.8 (edmund-54852) has finer detail than cells of 1 um, which hold up to 16 samples each; in cells of 0.35 um one
# sample suffices.
for name, widest, spacing_um in (("double-gauss", 14, 1), ("cooke-triplet", 14, 1), ("edmund-54852", 3, 1),
                                 ("edmund-54852", 3, 0.35)):
    other = pz.Lens(name)
    fields = [widest * i / 20 for i in range(21)]
    show(f"PSFs of {name}, 21 x 31 x 128 x 128, {spacing_um} um",
         lambda: other.psf(fields, wavelengths_nm=range(400, 701, 10), size=128, spacing_um=spacing_um, threads=1), repeat=5)
