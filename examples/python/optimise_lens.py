# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Optimise a lens with SciPy
# A double Gauss of 50 mm f/2 has its curvatures flattened by one tenth, which blurs it, and is then brought back by
# least squares: the residuals are spot radii over the field, and what the focal length lacks.

# %%
import numpy as np
from scipy.optimize import least_squares, minimize_scalar

import petzval as pz

lens = pz.Lens("dgauss-50mm")
fields, wavelengths_nm = [0, 7, 12], [486, 588, 656]
curved = [surface for surface in lens.surfaces if surface.curvature_per_mm != 0]
designed = np.array([surface.curvature_per_mm for surface in curved])
wanted_mm = lens.efl_mm


def bend(factors):
    """Multiplies the curvatures of the design, and puts the sensor into paraxial focus."""
    for surface, curvature, factor in zip(curved, designed, factors):
        surface.curvature_per_mm = curvature * factor
    lens.surfaces[-1].thickness_mm = lens.first_order().paraxial_image_mm


def spot_radii_um():
    return lens.spots(fields, field_type="angle_deg", wavelengths_nm=wavelengths_nm, ignore_apertures=True)["rms_radius_um"]


def residuals(factors):
    bend(factors)
    return np.append(spot_radii_um(), 100 * (lens.efl_mm - wanted_mm))


# %%
bend(np.ones(len(curved)))
before_um = np.sqrt(np.mean(spot_radii_um() ** 2))
flat = np.full(len(curved), 0.9)
bend(flat)
flat_um, flat_mm = np.sqrt(np.mean(spot_radii_um() ** 2)), lens.efl_mm
found = least_squares(residuals, flat, diff_step=1e-4, max_nfev=30)
bend(found.x)
after_um = np.sqrt(np.mean(spot_radii_um() ** 2))
print(f"design: {before_um:.1f} um RMS, {wanted_mm:.2f} mm")
print(f"flattened: {flat_um:.1f} um RMS, {flat_mm:.2f} mm")
print(f"optimised: {after_um:.1f} um RMS, {lens.efl_mm:.2f} mm")
assert after_um < 1.1 * before_um and abs(lens.efl_mm - wanted_mm) < 0.1

# %% [markdown]
# The picture decides. Diffraction and pixels count in it, and spots do not know them. So the last parameter, the place of the
# sensor, is chosen by the MTF of a picture: the camera photographs a slanted edge, and `sfr` measures it. The same is done
# for the lens as designed.

# %%
edge = pz.SceneRequest("slanted-edge:5", wavelengths_nm=wavelengths_nm)


def sharpest_picture(lens):
    """The largest MTF50 [cycles/pixel] of pictures at full aperture, by the place of the sensor."""
    image_mm = lens.surfaces[-1].thickness_mm

    def blur(shift_mm):
        lens.surfaces[-1].thickness_mm = image_mm + shift_mm
        camera = pz.Camera(lens, focus="design", sensor="64x64@4")
        return -pz.sfr(camera.image(edge, surround="extend", tolerance=1e-2)).mtf50

    return -minimize_scalar(blur, bounds=(-0.15, 0.05), method="bounded", options={"xatol": 0.02}).fun


optimised, design = sharpest_picture(lens), sharpest_picture(pz.Lens("dgauss-50mm"))
print(f"MTF50 at f/2: {optimised:.3f} cycles/pixel, as designed {design:.3f}")
assert optimised > 0.9 * design

# %%
lens  # a notebook shows its drawing
