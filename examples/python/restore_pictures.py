# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Restore pictures with a network
# A small network learns to undo the blur of a lens from pairs that the simulator makes: what the camera records, and the
# same without blur. It is held against Wiener's filter with the mean point spread. Needs PyTorch.

# %%
import numpy as np
import torch

import petzval as pz

torch.manual_seed(1)
torch.set_num_threads(2)
lens = pz.Lens("edmund-54852")
columns, rows, pitch_um = 96, 72, 8.0
sensor = f"{columns}x{rows}@{pitch_um:g}"
camera = pz.Camera(lens, f_number=2, defocus_mm=0.08, sensor=sensor)

# %% [markdown]
# Scenes are dead leaves: discs of random size and grey that cover each other, whose statistics are those of
# photographs. The camera that sees sharp is the same without its point spreads, so that both have its distortion and its fall of light.


# %%
def dead_leaves(rng, width, height, count=400):
    y, x = np.mgrid[:height, :width]
    scene = np.full((height, width), 0.5, np.float32)
    for _ in range(count):
        radius = min(2.0 / rng.random() ** 0.6, 60)
        inside = (x - rng.uniform(0, width)) ** 2 + (y - rng.uniform(0, height)) ** 2 < radius ** 2
        scene[inside] = rng.uniform(0.05, 1)
    return scene


def pairs(count, seed):
    rng = np.random.default_rng(seed)
    blurred, sharp = [], []
    for _ in range(count):
        radiance = dead_leaves(rng, 4 * columns // 2, 4 * rows // 2)[:, :, None]
        scene = pz.Scene(radiance, [550], horizontal_angle_deg=ANGLE_DEG, distance_m=1000)
        seen = camera.image(scene, surround="extend", tolerance=1e-2).values[..., 0]
        truth = camera.image(scene, surround="extend", method="none").values[..., 0]
        scale = truth.mean()
        noise = rng.normal(0, 0.01, seen.shape).astype(np.float32)
        blurred.append(seen / scale + noise)
        sharp.append(truth / scale)
    return np.stack(blurred), np.stack(sharp)


half_mm = columns * pitch_um / 2000
ANGLE_DEG = float(2 * np.degrees(np.arctan(half_mm / lens.efl_mm))) * 1.1
train = pairs(24, seed=1)
held_out = pairs(6, seed=2)


def psnr_db(found, truth):
    return float(10 * np.log10(truth.max() ** 2 / np.mean((found - truth) ** 2)))


print(f"recorded: {psnr_db(held_out[0], held_out[1]):.2f} dB")

# %% [markdown]
# Wiener's filter, with the mean of the point spreads over the frame in cells of a pixel.

# %%
stack = camera.psf([0, 0.2, 0.4], field_type="real_image_height_mm", wavelengths_nm=[550], size=32, spacing_um=pitch_um)
psf = stack.values[:, 0].mean(axis=0)
kernel = np.zeros((rows, columns), np.float32)
for i, row in enumerate(psf):
    for j, value in enumerate(row):
        kernel[(i - 16) % rows, (j - 16) % columns] += value
transfer = np.fft.rfft2(kernel)
best = None
for noise_to_signal in (1e-3, 3e-3, 1e-2, 3e-2, 1e-1):
    filtered = np.fft.irfft2(np.fft.rfft2(held_out[0]) * np.conj(transfer) / (np.abs(transfer) ** 2 + noise_to_signal),
                             s=(rows, columns))
    best = max(best or -np.inf, psnr_db(filtered, held_out[1]))
print(f"Wiener: {best:.2f} dB, at the best of five settings")

# %% [markdown]
# The network: five convolutions that add what is missing.

# %%
layers = [torch.nn.Conv2d(1, 16, 5, padding=2), torch.nn.ReLU()]
for _ in range(3):
    layers += [torch.nn.Conv2d(16, 16, 3, padding=1), torch.nn.ReLU()]
network = torch.nn.Sequential(*layers, torch.nn.Conv2d(16, 1, 5, padding=2))
optimiser = torch.optim.Adam(network.parameters(), 2e-3)
blurred, sharp = (torch.from_numpy(part).unsqueeze(1) for part in train)
steps = 300
schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, steps)
for step in range(steps):
    chosen = torch.randint(len(blurred), (4,))
    loss = torch.mean((blurred[chosen] + network(blurred[chosen]) - sharp[chosen]) ** 2)
    optimiser.zero_grad()
    loss.backward()
    optimiser.step()
    schedule.step()

# %%
with torch.no_grad():
    seen = torch.from_numpy(held_out[0]).unsqueeze(1)
    restored = (seen + network(seen)).squeeze(1).numpy()
print(f"network: {psnr_db(restored, held_out[1]):.2f} dB")
assert psnr_db(restored, held_out[1]) > best
