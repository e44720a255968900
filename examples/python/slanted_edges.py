# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Slanted edges: is the camera as sharp as its lens promises?
# The modulation transfer of a lens is computed from rays; that of a camera is measured on the picture of an edge. Both
# must agree, once the pixel is counted in.

# %%
import numpy as np

import petzval as pz

lens = pz.Lens("dgauss-50mm")
pitch_um = 4.0
camera = pz.Camera(lens, f_number=4, focus="2m", sensor=f"240x160@{pitch_um:g}")
edge = pz.SceneRequest("slanted-edge:5", wavelengths_nm=[550], columns=1920, rows=1280, distance_m=2)
light = camera.image(edge, supersample=4)
light

# %%
measured = pz.sfr(light, roi=(80, 40, 80, 80))
print(f"MTF50 {measured.mtf50:.4f} cycles/pixel, {measured.mtf50 / pitch_um * 1e3:.0f} cycles/mm")

# %% [markdown]
# The prediction: the lens in use, on its axis, times the pixel, whose aperture is a square.

# %%
frequencies_cpp = np.array([0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4])
of_lens = camera.mtf([0], wavelengths_nm=[550], frequencies_cpmm=list(frequencies_cpp / pitch_um * 1e3))
predicted = of_lens["sagittal"] * np.sinc(frequencies_cpp)
edge_sfr = np.interp(frequencies_cpp, measured[0].frequencies_cpp, measured[0].sfr)
for frequency, left, right in zip(frequencies_cpp, predicted, edge_sfr):
    print(f"{frequency:.2f} cycles/pixel: predicted {left:.3f}, measured {right:.3f}")
assert np.max(np.abs(predicted - edge_sfr)) < 0.02

# %% [markdown]
# Noise. The same edge as a sensor records it, ten times: how much do the results scatter, and does the deviation that
# is told hold?

# %%
noisy = pz.Camera(lens, f_number=4, focus="2m",
                  sensor=pz.Sensor("icx625-mono", {"columns": 240, "rows": 160, "pitch_um": pitch_um}))
found, told = [], []
for seed in range(10):
    raw = noisy.expose(light, seed=seed)
    edges = pz.sfr(raw.linear_values.astype(np.float32), roi=(80, 40, 80, 80))
    found.append(edges.mtf50)
    told.append(edges[0].mtf50_deviation)
print(f"MTF50 {np.mean(found):.4f} +- {np.std(found, ddof=1):.4f}; told +- {np.mean(told):.4f}")
assert abs(np.mean(found) - measured.mtf50) < 4 * np.std(found, ddof=1)
