#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a lens data table and prints what it says of one wavelength.

pip install h5py numpy
petzval optics build edmund-54852 --wavelengths 587.56 --sensor third-inch-768x576 -o edmund.h5
python3 read_table.py edmund.h5
"""

import sys

import h5py
import numpy

with h5py.File(sys.argv[1]) as table:
    print(table.attrs["lens_name"])
    band = len(table["wavelength"]) // 2
    print(f"at {table['wavelength'][band]:g} {table['wavelength'].attrs['units']}")
    field = table["object_field"]
    height_mm = table["real_image_height"][:, band]
    g_sensor = table["g_sensor"][:, band]
    spacing_um = table["psf_spacing"][:, band]
    psf = table["psf"][:, band]

    print(f"{'field [' + field.attrs['units'] + ']':>12} {'height [mm]':>12} {'relative illumination':>22} {'PSF rms [um]':>13}")
    for f, value in enumerate(field):
        x = (numpy.arange(psf.shape[-1]) - (psf.shape[-1] - 1) / 2) * spacing_um[f]
        weight = psf[f] / psf[f].sum()
        mean_t, mean_s = weight.sum(1) @ x, weight.sum(0) @ x
        rms_um = (weight.sum(1) @ (x - mean_t) ** 2 + weight.sum(0) @ (x - mean_s) ** 2) ** 0.5
        print(f"{value:12.3f} {height_mm[f]:12.4f} {g_sensor[f] / g_sensor[0]:22.4f} {rms_um:13.2f}")
