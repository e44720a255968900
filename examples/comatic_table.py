#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the lens data table of a lens that does not exist: third-order coma and nothing else, as strong as you like.

    pip install h5py numpy
    comatic_table.py made.h5 [flare in um at the corner, 45 by default]
    petzval optics import made.h5 --from hdf5 -o comatic.h5
    petzval image points:9 --optics comatic.h5 --sensor 160x120@5 --wavelengths 550 -o comatic.png

The zone ρ of the pupil lands on a circle of radius A ρ² whose centre lies 2 A ρ² beyond the chief ray (Welford,
Aberrations of Optical Systems, 1986, section 7.3), so the flare is 3 A long; A grows with the image height.
"""

import math
import sys

import h5py
import numpy as np

FOCAL_MM, LARGEST_MM, F_NUMBER = 10.0, 0.56, 2.0
SIZE, SPACING_UM, SPOT_UM = 129, 0.75, 1.5
FIELDS = 15


def coma(a_um):
    """Light of the rays of a pupil, each blurred to a Gaussian spot: [tangential, sagittal], sum 1."""
    place = (np.arange(SIZE) - SIZE // 2) * SPACING_UM
    psf = np.zeros((SIZE, SIZE))
    for square in (np.arange(48) + 0.5) / 48:  # of the zone: rings of equal area
        angle = 2 * math.pi * (np.arange(96) + 0.5) / 96
        t = a_um * square * (2 + np.cos(angle))
        s = a_um * square * np.sin(angle)
        along, across = (np.exp(-((place[:, None] - centre) / SPOT_UM) ** 2 / 2) for centre in (t, s))
        psf += along @ across.T
    return psf / psf.sum()


def main(path, flare_um=45.0):
    heights = np.linspace(0, LARGEST_MM, FIELDS)
    psf = np.array([coma(flare_um / 3 * height / LARGEST_MM) for height in heights])
    one = (FIELDS, 1)
    with h5py.File(path, "w") as file:
        file.attrs.update(format="petzval-optics/1", lens_name="pure coma", lens_json="",
                          provenance="examples/comatic_table.py", object_distance_mm=math.inf, vertex_to_sensor_mm=0.0)
        file.create_group("first_order").attrs.update(
            wavelength_nm=550.0, efl_mm=FOCAL_MM, f_number=F_NUMBER, working_f_number=F_NUMBER, magnification=0.0)
        file["object_field"] = np.degrees(np.arctan(heights / FOCAL_MM))
        file["wavelength"] = [550.0]
        file["real_image_height"] = heights.reshape(one)
        file["g_source"] = file["g_sensor"] = np.full(one, math.pi / (4 * F_NUMBER ** 2))
        file["psf"] = psf[:, None].astype("f4")
        file["psf_size"] = np.full(one, SIZE)
        file["psf_spacing"] = np.full(one, SPACING_UM)
        file["psf_captured"] = np.ones(one)


if __name__ == "__main__":
    main(sys.argv[1], *map(float, sys.argv[2:]))
