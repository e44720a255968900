# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Choose a lens for a sensor
# A camera reads labels at 400 mm. The sensor is an IMX174 (1936 × 1216 pixels of 5.86 µm), and 220 mm of the conveyor
# belt have to fit into the picture. Which lens?

# %%
import petzval as pz

sensor = pz.Sensor("imx174-colour")
wanted = dict(distance="400mm", width_mm=220)
candidates = pz.match_lenses(sensor, **wanted, f_number=4, wavelengths_nm=[546], scaled=True)
for candidate in candidates[:5]:
    tangential, sagittal = candidate.places[-1]["half_nyquist"]
    print(f"{candidate.lens}, scaled by {candidate.scale:.3f}: "
          f"MTF in the corner {min(tangential, sagittal):.2f} at half of Nyquist")
assert len(candidates) >= 2

# %% [markdown]
# The two C-mount lenses of 16 and 25 mm, as they are, side by side. Distances are those from the sensor plane.
# A line of the table that decides: how much of the corner's contrast is left.

# %%
found = []
for name in ("cmount-16mm", "cmount-25mm"):
    camera = pz.Camera(name, f_number=4, focus="400mm", sensor=sensor)
    found.append(camera.on_sensor("400mm", wavelengths_nm=[486, 546, 656]))
pz.compare_lenses(found)

# %%
for lens in found:
    width, height = lens.seen
    near, far = lens.sharp_to_a_pixel_m
    print(f"{lens.lens}: sees {width:.0f} x {height:.0f} mm, {lens.per_pixel:.3f} mm a pixel, "
          f"sharp over {(far - near) * 1e3:.0f} mm")
assert found[0].seen[0] > found[1].seen[0]  # the shorter lens sees more

# %% [markdown]
# What does the light allow? A belt lit with 500 lux, one millisecond of exposure. The raw file says how many electrons
# a white wall gives, and Poisson's law what that is worth.

# %%
camera = pz.Camera("cmount-16mm", f_number=4, focus="400mm", sensor=sensor)
wall = pz.SceneRequest("wall", wavelengths_nm=range(400, 701, 20), illuminant="D65", illuminance_lx=500, distance_m=0.4)
raw = camera.expose(camera.image(wall, method="none"), exposure=0.001, seed=1)
green = raw.electrons[0::2, 1::2]
rows, columns = green.shape
middle = green[rows // 2 - 50:rows // 2 + 50, columns // 2 - 50:columns // 2 + 50]
print(f"{middle.mean():.0f} electrons in green, signal to noise {middle.mean() / middle.std():.0f}")
assert 20 < middle.mean() / middle.std() < middle.mean() ** 0.5  # the electronics add to Poisson's noise
