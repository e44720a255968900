# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Autofocus
# A camera that sees only its own pictures has to find where they are sharp. Here it looks at a three-dimensional scene
# through every surface of a double Gauss.

# %%
import petzval as pz

camera = pz.Camera("dgauss-50mm")
scene = dict(scene="spheres", size=(160, 120))

# %% [markdown]
# Once on the floor in front, once on the floor behind the spheres. A zone is (left, right, top, bottom) of the picture,
# 0 to 1.

# %%
zones = {"front": (0.05, 0.4, 0.8, 1), "back": (0.25, 0.55, 0.28, 0.38)}
runs = {name: camera.autofocus(**scene, zones=[zone], seed=1) for name, zone in zones.items()}
for name, run in runs.items():
    print(f"{name}: sharp at {run.distance_m:.2f} m, film {run.film_distance_mm:.2f} mm behind the lens, "
          f"after {len(run.evaluations)} pictures")

# %% [markdown]
# What it measured, and where. The measure of sharpness has its peak where the camera ends.

# %%
for film_mm, measure, stage in sorted(runs["front"].evaluations):
    print(f"{film_mm:8.3f} mm  {measure:10.4g}  {stage}")
best = max(runs["front"].evaluations, key=lambda evaluation: evaluation[1])
assert abs(best[0] - runs["front"].film_distance_mm) < 0.2
assert runs["front"].distance_m < 1.5 < runs["back"].distance_m

# %% [markdown]
# The picture at each of the two.

# %%
pictures = {}
for name, run in runs.items():
    focused = pz.Camera("dgauss-50mm", image_distance_mm=run.film_distance_mm)
    pictures[name] = focused.render(**scene, wavelengths_nm=[450, 550, 650], samples_per_pixel=32, seed=1).light
pictures["front"]

# %%
pictures["back"]
