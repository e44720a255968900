# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # The first ten minutes
# A lens of 6 mm f/1.8, what it does to light, and what a camera with it records.

# %%
import petzval as pz

lens = pz.Lens("edmund-54852")
lens  # its drawing

# %% [markdown]
# Its distortion and illumination at the corner of the sensor of the 2005 paper, 3 mm from the axis. An opened air gap
# alters both.

# %%
for gap_mm in (0.6, 0.7):
    opened = lens.altered("surfaces[4].thickness_mm", gap_mm)
    corner = dict(fields=[3], field_type="real_image_height_mm", wavelengths_nm=[587.56])
    distortion = opened.distortion(**corner)["distortion_percent"][0]
    illumination = opened.illumination(**corner)["relative_illumination"][0]
    print(f"gap {gap_mm} mm: distortion {distortion:.2f} %, relative illumination {illumination:.3f}")

# %% [markdown]
# The camera: stopped down, focused at 1.2 m, with a sensor. Its light is irradiance by wavelength.

# %%
sensor = pz.Sensor("example-vga", {"columns": 160, "rows": 120, "pitch_um": 22.4})
camera = pz.Camera(lens, f_number=2.8, focus="1.2m", sensor=sensor)
light = camera.image(pz.SceneRequest("studio", wavelengths_nm=range(400, 701, 20)))
light

# %%
raw = camera.expose(light, seed=1)
picture = pz.develop(raw)
picture

# %% [markdown]
# How sharp is it? A slanted edge in the middle of smaller pixels tells.

# %%
camera.sensor = pz.Sensor("160x120@5.6")
edge = pz.SceneRequest("slanted-edge:5", wavelengths_nm=[550], columns=960, rows=720)
edges = pz.sfr(camera.image(edge, supersample=3), roi=(50, 30, 60, 60))
print(f"MTF50 {edges.mtf50:.3f} cycles/pixel, {edges.mtf50 / 5.6e-3:.0f} cycles/mm")
assert 0.2 < edges.mtf50 < 0.8
