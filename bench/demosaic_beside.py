#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Demosaicing beside LibRaw and Menon's method, in one run: quality on photographs, and time on 12 megapixels.

    pip install numpy scipy tifffile rawpy scikit-image pooch colour-demosaicing
    bench/demosaic_beside.py build/release/bin/petzval

Each photograph is taken as light (its sRGB curve undone), sampled as RGGB in 16 bits and interpolated back.
What is printed is the peak signal-to-noise ratio [dB] of all channels without a border of 8 pixels: in linear
light, and as displayed (sRGB curve). "blurred" is the photograph behind a lens: light blurred by a Gaussian of
0.7 pixels. LibRaw runs through rawpy, Menon's method is that of colour-demosaicing. `root` beside a peer is that
peer in the root of the light, decoded again: what part of the lead the root alone makes.
"""
import argparse
import os
import resource
import subprocess
import tempfile
import time
import warnings

import numpy as np
import rawpy
import skimage.data
import tifffile
from scipy.ndimage import gaussian_filter

warnings.filterwarnings("ignore")
from colour_demosaicing import demosaicing_CFA_Bayer_Menon2007  # noqa: E402

PHOTOGRAPHS = ("astronaut", "coffee", "retina")
LIBRAW = ("LINEAR", "PPG", "AHD", "AAHD", "DHT")
OURS = ("bilinear", "malvar", "hamilton-adams", "gradient", "root-gradient")
BORDER = 8


def decoded(codes):
    v = codes / 255
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def encoded(light):
    x = np.clip(light, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def photograph(name):
    picture = getattr(skimage.data, name)()[..., :3]
    rows, columns = picture.shape[0] // 2 * 2, picture.shape[1] // 2 * 2
    return decoded(picture[:rows, :columns].astype(float))


def sampled(light):
    """RGGB in 16 bits."""
    mosaic = light[..., 1].copy()
    mosaic[0::2, 0::2] = light[0::2, 0::2, 0]
    mosaic[1::2, 1::2] = light[1::2, 1::2, 2]
    return np.round(mosaic.clip(0, 1) * 65535) / 65535


def write_dng(path, mosaic):
    identity = tuple(v for i in range(9) for v in (int(i % 4 == 0), 1))
    tags = [(33421, 3, 2, (2, 2), True), (33422, 1, 4, bytes([0, 1, 1, 2]), True),
            (50706, 1, 4, bytes([1, 4, 0, 0]), True), (50708, 2, 0, "demosaic_beside", True),
            (50714, 3, 1, 0, True), (50717, 3, 1, 65535, True), (50721, 10, 9, identity, True),
            (50728, 5, 3, (1, 1, 1, 1, 1, 1), True), (50778, 3, 1, 21, True)]
    tifffile.imwrite(path, np.round(mosaic * 65535).astype(np.uint16), photometric=32803, extratags=tags,
                     metadata=None, planarconfig=None)


def by_petzval(program, mosaic, method, folder):
    raw, planes = os.path.join(folder, "a.dng"), os.path.join(folder, "a.npy")
    write_dng(raw, mosaic)
    subprocess.run([program, "develop", raw, "--demosaic", method, "--keep-defects", "--matrix", "none",
                    "--quiet", "--step", "demosaic=" + planes, "-o", os.path.join(folder, "a.tif")], check=True)
    return np.load(planes)


def by_libraw(mosaic, method, folder):
    path = os.path.join(folder, "a.dng")
    write_dng(path, mosaic)
    with rawpy.imread(path) as raw:
        return raw.postprocess(demosaic_algorithm=getattr(rawpy.DemosaicAlgorithm, method),
                               output_color=rawpy.ColorSpace.raw, user_wb=[1, 1, 1, 1], gamma=(1, 1),
                               no_auto_bright=True, output_bps=16, user_flip=0, user_black=0, user_sat=65535,
                               adjust_maximum_thr=0) / 65535


def by_menon(mosaic):
    return demosaicing_CFA_Bayer_Menon2007(mosaic, "RGGB")


def in_the_root(method):
    return lambda mosaic: np.clip(method(np.sqrt(mosaic)), 0, 1) ** 2


def decibels(a, b):
    return -10 * np.log10(np.mean(((a - b)[BORDER:-BORDER, BORDER:-BORDER]) ** 2))


def methods(program, folder):
    rows = [("LibRaw " + m, lambda x, m=m: by_libraw(x, m, folder)) for m in LIBRAW]
    rows.append(("Menon 2007", by_menon))
    rows.append(("LibRaw AAHD, root", in_the_root(lambda x: by_libraw(x, "AAHD", folder))))
    rows.append(("Menon 2007, root", in_the_root(by_menon)))
    return rows + [("petzval " + m, lambda x, m=m: by_petzval(program, x, m, folder)) for m in OURS]


def quality(program, folder):
    scenes = {name: photograph(name) for name in PHOTOGRAPHS}
    for name in PHOTOGRAPHS:
        scenes[name + " blurred"] = np.stack([gaussian_filter(scenes[name][..., k], 0.7) for k in range(3)], -1)
    print(f"{'linear / displayed [dB]':24s}" + "".join(f"{name:>19s}" for name in scenes))
    for name, method in methods(program, folder):
        line = f"{name:24s}"
        for light in scenes.values():
            found = np.clip(method(sampled(light)), 0, 1)
            line += f"{decibels(found, light):11.2f} {decibels(encoded(found), encoded(light)):7.2f}"
        print(line, flush=True)


def cpu_s(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def best_of(rounds, who, work):
    """CPU seconds and seconds of the quickest round."""
    found = []
    for _ in range(rounds):
        cpu, wall = cpu_s(who), time.time()
        work()
        found.append((cpu_s(who) - cpu, time.time() - wall))
    return min(found)


def speed(program, folder):
    coffee = photograph("coffee")
    noise = np.random.default_rng(1).normal(0, 0.01, (3040, 4056))
    mosaic = np.clip(sampled(np.tile(coffee, (8, 7, 1))[:3040, :4056]) + noise, 0, 1)
    path = os.path.join(folder, "big.dng")
    write_dng(path, mosaic)

    def libraw(method):
        with rawpy.imread(path) as raw:
            raw.postprocess(demosaic_algorithm=getattr(rawpy.DemosaicAlgorithm, method), use_camera_wb=True,
                            no_auto_bright=True)

    print("\nraw file of 12 megapixels to 8 bits: CPU s (s)")
    for method in LIBRAW:
        cpu, wall = best_of(3, resource.RUSAGE_SELF, lambda: libraw(method))
        print(f"LibRaw {method:17s}{cpu:7.2f} ({wall:.2f}), into memory")
    for method in OURS:
        cpu, wall = best_of(3, resource.RUSAGE_CHILDREN, lambda: subprocess.run(
            [program, "develop", path, "--demosaic", method, "--quiet", "-o", os.path.join(folder, "a.tif")], check=True))
        print(f"petzval {method:16s}{cpu:7.2f} ({wall:.2f}), into a TIFF file, defects corrected")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="petzval")
    program = parser.parse_args().program
    with tempfile.TemporaryDirectory() as folder:
        quality(program, folder)
        speed(program, folder)
