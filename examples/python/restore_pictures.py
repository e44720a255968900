# SPDX-License-Identifier: BSD-3-Clause
# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
# ---
# %% [markdown]
# # Restore pictures with a network
# A small network learns to undo the blur of ten lenses from pairs of a data set: the picture that a camera takes, and the
# same without blur and noise. It is held against Wiener's filter with the mean PSF. Needs PyTorch and Pillow.
#
# As it stands this takes a minute, in which the network learns less than the filter knows. `PAIRS=500 STEPS=2200` in the
# environment is the experiment whose figures are in docs/ACCURACY.md; `FOLDER` keeps the data set.

# %%
import os
import tempfile
import time

import numpy as np
import torch
from torch.utils.data import DataLoader

from petzval import dataset

PAIRS, STEPS = int(os.environ.get("PAIRS", 24)), int(os.environ.get("STEPS", 200))
HELD_OUT = max(6, PAIRS // 10)
torch.manual_seed(1)
torch.set_num_threads(1)

# %% [markdown]
# Ten lenses, stopped down by up to three stops, out of focus by up to 60 µm, dark and noisy or not. Scenes are dead leaves:
# discs of random size and grey that cover each other, whose statistics are those of photographs.

# %%
recipe = {
    "format": "petzval-dataset/1", "items": PAIRS + HELD_OUT, "items_per_part": 10, "seed": 1,
    "parameters": {
        "lens": {"choose": ["cmount-8mm", "cmount-12mm", "cmount-16mm-f1.8", "cmount-17mm-f1", "cmount-25mm-f1.4",
                            "dgauss-12.5mm", "edmund-54852", "m12-4.5mm", "m12-7mm", "m12-8mm"]},
        "stop_down_ev": {"uniform": [0, 3]}, "focus": "infinity",
        "defocus_mm": {"normal": [0, 0.03], "within": [-0.06, 0.06]},
        "scene": {"choose": [f"dead-leaves:{seed}" for seed in range(1, 1000)]}, "sensor": "imx900-mono",
        "sensor_serial": {"integer": [0, 99]}, "exposure_compensation_ev": {"uniform": [-1.5, 0.3]},
        "analog_gain": {"log_uniform": [1, 4]}},
    "sensor_set": ["columns=160", "rows=120", "pitch_um=8"], "wavelengths_nm": "550", "tolerance": 0.02,
    "truth": ["sharp", "psf"], "psf_grid": {"rows": 2, "columns": 2, "size": 25}}
folder = os.environ.get("FOLDER") or tempfile.mkdtemp()
print(dataset.make(recipe, folder))

# %% [markdown]
# A `Dataset` goes into PyTorch's loader as it is; `transform` makes tensors of what is needed, in linear light.


# %%
def linear(picture):
    grey = picture.reshape(picture.shape[0], picture.shape[1], -1)[:, :, 0] / np.float32(np.iinfo(picture.dtype).max)
    return np.where(grey > 0.04045, ((grey + 0.055) / 1.055) ** 2.4, grey / 12.92).astype(np.float32)


def tensors(item):
    psf = item["psf"].mean(axis=(0, 1, 2))
    return (torch.from_numpy(linear(item["picture"]))[None], torch.from_numpy(linear(item["sharp"]))[None],
            torch.from_numpy(psf / psf.sum()), item["facts"]["item"])


items = dataset.Dataset(folder, only=["picture", "sharp", "psf"], transform=tensors)
for workers in (0, 2):
    begin = time.perf_counter()
    batches = list(DataLoader(items, batch_size=8, num_workers=workers))
    print(f"loader with {workers} workers: {len(items) / (time.perf_counter() - begin):.0f} items a second")
blurred, sharp, psfs, numbers = (torch.cat([batch[part] for batch in batches]) for part in range(4))

# %% [markdown]
# Held out are pictures of scenes that no picture of the training shows.

# %%
scenes = [items.facts(index)["parameters"]["scene"] for index in range(len(items))]
train = torch.arange(min(PAIRS, len(items) - HELD_OUT))
seen = {scenes[index] for index in train}
held_out = torch.tensor([index for index in range(len(train), len(items)) if scenes[index] not in seen])
BORDER = 12  # where light comes in that no filter sees


def psnr_db(found):
    """Of each held-out picture within the border, white 1; their mean."""
    inside = (slice(None), slice(None), slice(BORDER, -BORDER), slice(BORDER, -BORDER))
    error = (found - sharp[held_out])[inside].square().mean(dim=(1, 2, 3))
    return float((-10 * torch.log10(error)).mean())


print(f"{len(train)} pairs, {len(held_out)} held out; recorded: {psnr_db(blurred[held_out]):.2f} dB")

# %% [markdown]
# Wiener's filter: with the mean PSF of all lenses, and with the mean PSF of each picture, which nobody knows of a camera
# in the hand. The pictures are continued by reflection, and each filter has the best of six settings for the pictures
# that it is judged by.


# %%
def wiener(kernels):
    pictures = torch.nn.functional.pad(blurred[held_out], [24] * 4, mode="reflect")
    rows, columns = pictures.shape[-2:]
    spread = torch.zeros(len(kernels), 1, rows, columns)
    spread[:, 0, :25, :25] = kernels
    transfer = torch.fft.rfft2(torch.roll(spread, (-12, -12), (-2, -1)))
    best = None
    for noise_to_signal in (1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1):
        filtered = torch.fft.rfft2(pictures) * transfer.conj() / (transfer.abs() ** 2 + noise_to_signal) * (1 + noise_to_signal)
        restored = torch.fft.irfft2(filtered, s=(rows, columns))[..., 24:-24, 24:-24]
        if best is None or psnr_db(restored) > psnr_db(best):
            best = restored
    return best


by_mean = wiener(psfs[train].mean(dim=0, keepdim=True))
by_own = wiener(psfs[held_out])
print(f"Wiener with the mean PSF: {psnr_db(by_mean):.2f} dB; with that of each picture: {psnr_db(by_own):.2f} dB")

# %% [markdown]
# The network adds what is missing: convolutions on blocks of 2 × 2 pixels.

# %%
layers = [torch.nn.PixelUnshuffle(2), torch.nn.Conv2d(4, 32, 3, padding=1), torch.nn.ReLU()]
for _ in range(5):
    layers += [torch.nn.Conv2d(32, 32, 3, padding=1), torch.nn.ReLU()]
network = torch.nn.Sequential(*layers, torch.nn.Conv2d(32, 4, 3, padding=1), torch.nn.PixelShuffle(2))
optimiser = torch.optim.Adam(network.parameters(), 2e-3)
schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, 2e-3, total_steps=STEPS)
SIDE = 64
begin, begin_cpu = time.perf_counter(), time.process_time()
for step in range(STEPS):
    chosen = train[torch.randint(len(train), (8,))]
    top, left = (int(torch.randint(size - SIDE + 1, ())) for size in blurred.shape[-2:])
    at = (slice(None), slice(None), slice(top, top + SIDE), slice(left, left + SIDE))
    given, wanted = blurred[chosen][at], sharp[chosen][at]
    for axis in (-1, -2):  # lenses know neither left nor right
        if torch.rand(()) < 0.5:
            given, wanted = given.flip(axis), wanted.flip(axis)
    # What is judged: decibels, each picture's alike.
    loss = torch.log10((given + network(given) - wanted).square().mean(dim=(1, 2, 3)) + 1e-6).mean()
    optimiser.zero_grad()
    loss.backward()
    optimiser.step()
    schedule.step()
print(f"{STEPS} steps in {time.perf_counter() - begin:.0f} s, {time.process_time() - begin_cpu:.0f} s of CPU")

# %%
with torch.no_grad():
    restored = torch.cat([each + network(each) for each in blurred[held_out].split(8)])
print(f"network: {psnr_db(restored):.2f} dB")

# %% [markdown]
# From the left: recorded, by Wiener with the mean PSF, by the network, without blur.

# %%
columns = [blurred[held_out], by_mean, restored, sharp[held_out]]
sheet = torch.cat([torch.cat(list(each[:4, 0]), dim=0) for each in columns], dim=1).clamp(0, 1) ** (1 / 2.2)
from PIL import Image  # noqa: E402

Image.fromarray((255 * sheet).round().byte().numpy()).save("restored.png")
assert psnr_db(restored) > psnr_db(by_mean if PAIRS >= 500 else blurred[held_out])
