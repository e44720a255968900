# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # The paper of 2005
# Maeda, Catrysse and Wandell, "Integrating lens design with digital camera simulation": a micro video lens of 6 mm is
# described by its distortion, its illumination and its point spreads; together they turn a scene into what reaches the
# sensor. `petzval demo` draws all figures; here are their numbers.

# %%
import numpy as np

import petzval as pz

lens = pz.Lens("edmund-54852")
heights_mm = [0, 1, 2, 3]
at = dict(fields=heights_mm, field_type="real_image_height_mm", wavelengths_nm=[587.56])

# %% [markdown]
# Distortion (the paper reads about −10 % at the corner off its graph):

# %%
lens.distortion(**at)

# %% [markdown]
# Illumination, from all rays that the real apertures pass. A thin lens would follow cos⁴; this one does not.

# %%
illumination = lens.illumination(**at)
illumination

# %% [markdown]
# Point spreads, each centred on its chief ray:

# %%
stack = lens.psf(heights_mm, field_type="real_image_height_mm", wavelengths_nm=[450, 550, 650])
rms_um = []
for psf in stack.values[:, 1]:
    y, x = np.meshgrid(stack.y_um, stack.x_um, indexing="ij")
    centre = (psf * x).sum(), (psf * y).sum()
    rms_um.append(float(np.sqrt((psf * ((x - centre[0]) ** 2 + (y - centre[1]) ** 2)).sum())))
print("RMS radius of the point spread at 550 nm [um]:", np.round(rms_um, 1))

# %% [markdown]
# All three at once: a checkerboard on the paper's sensor.

# %%
camera = pz.Camera(lens, sensor="320x240@15")
light = camera.image(pz.SceneRequest("checkerboard", wavelengths_nm=[450, 550, 650]))
light

# %%
assert -11 < lens.distortion(**at)["distortion_percent"][-1] < -9
assert illumination["relative_illumination"][0] == 1
