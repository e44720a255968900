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
# As it stands this takes a minute, in which the network learns little. `PAIRS=500 STEPS=1500` in the environment is the
# experiment whose figures are in docs/ACCURACY.md; `FOLDER` keeps the data set.

# %%
import os
import tempfile
import time

import numpy as np
import torch
from torch.utils.data import DataLoader

from petzval import dataset

PAIRS, STEPS = int(os.environ.get("PAIRS", 24)), int(os.environ.get("STEPS", 100))
VALIDATION, TEST = max(6, PAIRS // 10), max(6, PAIRS * 22 // 100)
torch.manual_seed(1)
torch.set_num_threads(1)

# %% [markdown]
# Ten lenses, stopped down by up to three stops, out of focus by up to 60 µm, dark and noisy or not. Scenes are dead leaves:
# discs of random size and grey that cover each other, whose statistics are those of photographs.

# %%
recipe = {
    "format": "petzval-dataset/1", "items": PAIRS + VALIDATION + TEST, "items_per_part": 10, "seed": 1,
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
# Three sets: what is learnt from, what decides between states of the network, and what is looked at once, at the end. The
# last two show scenes that no picture before them shows.

# %%
scenes = [items.facts(index)["parameters"]["scene"] for index in range(len(items))]


def unseen(first, end):
    return torch.tensor([index for index in range(first, end) if scenes[index] not in set(scenes[:first])])


train, validation = torch.arange(PAIRS), unseen(PAIRS, PAIRS + VALIDATION)
test = unseen(PAIRS + VALIDATION, len(items))
BORDER = 12  # where light comes in that no filter sees


def psnr_db(found, pictures):
    """The mean over these pictures, each within the border, white 1."""
    inside = (slice(None), slice(None), slice(BORDER, -BORDER), slice(BORDER, -BORDER))
    error = (found - sharp[pictures])[inside].square().mean(dim=(1, 2, 3))
    return float((-10 * torch.log10(error)).mean())


print(f"{len(train)} pairs, {len(validation)} to choose by, {len(test)} to judge by; recorded: {psnr_db(blurred[test], test):.2f} dB")

# %% [markdown]
# Wiener's filter: with the mean PSF of all lenses, and with the mean PSF of each picture, which nobody knows of a camera
# in the hand. The pictures are continued by reflection, and each filter has the best of six settings for the very pictures
# that it is judged by.


# %%
def filtered(pictures, kernels, noise_to_signal):
    pictures = torch.nn.functional.pad(pictures, [24] * 4, mode="reflect")
    rows, columns = pictures.shape[-2:]
    spread = torch.zeros(len(kernels), 1, rows, columns)
    spread[:, 0, :25, :25] = kernels
    transfer = torch.fft.rfft2(torch.roll(spread, (-12, -12), (-2, -1)))
    found = torch.fft.rfft2(pictures) * transfer.conj() / (transfer.abs() ** 2 + noise_to_signal) * (1 + noise_to_signal)
    return torch.fft.irfft2(found, s=(rows, columns))[..., 24:-24, 24:-24]


def wiener(pictures, kernels):
    """The best setting for these pictures, and what it makes of them."""
    settings = (1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1)
    tried = [(setting, filtered(blurred[pictures], kernels, setting)) for setting in settings]
    return max(tried, key=lambda each: psnr_db(each[1], pictures))


mean_psf = psfs[train].mean(dim=0, keepdim=True)
by_mean, by_own = wiener(test, mean_psf)[1], wiener(test, psfs[test])[1]
print(f"Wiener with the mean PSF: {psnr_db(by_mean, test):.2f} dB; with that of each picture: {psnr_db(by_own, test):.2f} dB")

# %% [markdown]
# The network is given what five filters of Wiener make of a picture, for five widths of PSF, and how far from the axis each
# pixel lies. It mixes them pixel by pixel and adds what is missing: convolutions on blocks of 2 × 2 pixels at three sizes;
# the mean over the coarsest tells all places what the whole picture is like.

# %%
across = torch.arange(25) - 12.0
width = (psfs * (across[:, None] ** 2 + across**2)).sum(dim=(1, 2)).sqrt()
channels = [blurred]
for alike in train[width[train].argsort()].chunk(5):
    kernel = psfs[alike].mean(dim=0, keepdim=True)
    channels.append(filtered(blurred, kernel, wiener(alike, kernel)[0]))
rows, columns = blurred.shape[-2:]
y, x = (torch.arange(rows) - (rows - 1) / 2) / (columns / 2), (torch.arange(columns) - (columns - 1) / 2) / (columns / 2)
channels.append((y[:, None] ** 2 + x**2).expand(len(blurred), 1, rows, columns))
given_all, MIXED = torch.cat(channels, dim=1), len(channels) - 1


class Block(torch.nn.Module):
    def __init__(self, width):
        super().__init__()
        self.first, self.second = (torch.nn.Conv2d(width, width, 3, padding=1) for _ in range(2))

    def forward(self, x):
        return x + self.second(torch.relu(self.first(torch.relu(x))))


class Network(torch.nn.Module):
    def __init__(self, width=24):
        super().__init__()
        self.begin = torch.nn.Conv2d(4 * (MIXED + 1), width, 3, padding=1)
        self.fine, self.middle, self.coarse = Block(width), Block(2 * width), Block(3 * width)
        self.down, self.further_down = torch.nn.Conv2d(width, 2 * width, 2, 2), torch.nn.Conv2d(2 * width, 3 * width, 2, 2)
        self.of_all, self.coarse_again = torch.nn.Linear(3 * width, 3 * width), Block(3 * width)
        self.up, self.further_up = torch.nn.ConvTranspose2d(3 * width, 2 * width, 2, 2), torch.nn.ConvTranspose2d(2 * width, width, 2, 2)
        self.middle_again, self.fine_again = Block(2 * width), Block(width)
        self.end = torch.nn.Conv2d(width, 4 * (MIXED + 1), 3, padding=1)
        with torch.no_grad():
            self.end.weight.mul_(0.1)  # begins near the mean of what it mixes

    def forward(self, x):
        fine = self.fine(self.begin(torch.nn.functional.pixel_unshuffle(x, 2)))
        middle = self.middle(self.down(fine))
        coarse = self.coarse(self.further_down(middle))
        coarse = self.coarse_again(coarse + self.of_all(torch.relu(coarse).mean(dim=(2, 3)))[:, :, None, None])
        fine = self.fine_again(fine + self.further_up(self.middle_again(middle + self.up(coarse))))
        out = torch.nn.functional.pixel_shuffle(self.end(torch.relu(fine)), 2)
        return (out[:, :MIXED].softmax(dim=1) * x[:, :MIXED]).sum(dim=1, keepdim=True) + out[:, MIXED:]


def restored_by(network, pictures):
    with torch.no_grad():
        return torch.cat([network(each) for each in given_all[pictures].split(8)])


network = Network()
optimiser = torch.optim.Adam(network.parameters(), 3e-3)
schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, 3e-3, total_steps=STEPS)
SIDE, LOOKS = 64, 10
best, kept = -float("inf"), None
begin, begin_cpu = time.perf_counter(), time.process_time()
for step in range(1, STEPS + 1):
    chosen = train[torch.randint(len(train), (8,))]
    top, left = (int(torch.randint(size - SIDE + 1, ())) for size in blurred.shape[-2:])
    at = (slice(None), slice(None), slice(top, top + SIDE), slice(left, left + SIDE))
    given, wanted = given_all[chosen][at], sharp[chosen][at]
    for axis in (-1, -2):  # lenses know neither left nor right
        if torch.rand(()) < 0.5:
            given, wanted = given.flip(axis), wanted.flip(axis)
    # What is judged: decibels, each picture's alike.
    loss = torch.log10((network(given) - wanted).square().mean(dim=(1, 2, 3)) + 1e-6).mean()
    optimiser.zero_grad()
    loss.backward()
    optimiser.step()
    schedule.step()
    if step % max(1, STEPS // LOOKS) == 0:
        found = psnr_db(restored_by(network, validation), validation)
        print(f"after {step} steps {found:.2f} dB of those to choose by", flush=True)
        if found > best:
            best, kept = found, {name: value.clone() for name, value in network.state_dict().items()}
network.load_state_dict(kept)
print(f"{STEPS} steps in {time.perf_counter() - begin:.0f} s, {time.process_time() - begin_cpu:.0f} s of CPU")

# %%
restored = restored_by(network, test)
better = np.mean([psnr_db(restored[i : i + 1], test[i : i + 1]) > psnr_db(by_mean[i : i + 1], test[i : i + 1]) for i in range(len(test))])
print(f"network: {psnr_db(restored, test):.2f} dB; better than Wiener with the mean PSF in {100 * better:.0f} % of the pictures")

# %% [markdown]
# From the left: recorded, by Wiener with the mean PSF, by the network, without blur.

# %%
sheets = [blurred[test], by_mean, restored, sharp[test]]
sheet = torch.cat([torch.cat(list(each[:4, 0]), dim=0) for each in sheets], dim=1).clamp(0, 1) ** (1 / 2.2)
from PIL import Image  # noqa: E402

Image.fromarray((255 * sheet).round().byte().numpy()).save("restored.png")
assert psnr_db(restored, test) > psnr_db(by_mean if PAIRS >= 500 else blurred[test], test)
