#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Denoising of raw files beside BM3D, in one run: photographs of scikit-image, seven stops too dark.

    pip install numpy imageio scikit-image pooch bm3d
    bench/denoise_beside.py build/release/bin/petzval

Peak signal-to-noise ratio [dB] as displayed, of the picture brightened by seven stops against the one that was exposed
without noise, without a border of 8 pixels. BM3D is given the developed picture, and noise levels to choose from.
"""
import argparse
import os
import resource
import subprocess
import tempfile

import bm3d
import imageio.v3 as iio
import numpy as np
import skimage.data

SENSOR = "third-inch-1280x960"
SIZES = {"coffee": "600x400@3.75", "astronaut": "512x512@3.75"}
LEVELS = (0.16, 0.18, 0.2, 0.22, 0.24)


def encoded(light):
    x = np.clip(light, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def decibels(a, b):
    return -10 * np.log10(np.mean(((a - b)[8:-8, 8:-8]) ** 2))


def cpu_s(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def compare(program, name, folder):
    def run(*words):
        subprocess.run([program, *words, "--quiet"], check=True, cwd=folder, stdout=subprocess.DEVNULL)

    def developed(raw, *words):
        start = cpu_s(resource.RUSAGE_CHILDREN)
        run("develop", raw, "-o", "d.npy", *words)
        return encoded(np.load(os.path.join(folder, "d.npy"))), cpu_s(resource.RUSAGE_CHILDREN) - start

    iio.imwrite(os.path.join(folder, "scene.png"), getattr(skimage.data, name)()[..., :3])
    run("image", "scene.png", "--lens", "edmund-54852", "--sensor", SIZES[name], "--method", "none", "--wavelengths",
        "400:20:700", "-o", "light.exr")
    exposed = ["sense", "light.exr", "--sensor", SENSOR, "--illuminant", "D65"]
    run(*exposed, "--without", "shot,dark,read,dsnu,prnu,column,row,defects", "-o", "truth.dng")
    run(*exposed, "--exposure-compensation", "-7", "-o", "noisy.dng")
    truth, _ = developed("truth.dng")
    noisy, _ = developed("noisy.dng", "--brightness", "7")
    print(f"{name}: noisy {decibels(noisy, truth):.2f} dB")
    for strength in ("0.85", "1", "1.2"):
        picture, cpu = developed("noisy.dng", "--brightness", "7", "--denoise", strength)
        print(f"  petzval develop --denoise {strength:5s} {decibels(picture, truth):.2f} dB, {cpu:.2f} CPU s")
    for level in LEVELS:
        start = cpu_s(resource.RUSAGE_SELF)
        picture = np.clip(bm3d.bm3d_rgb(noisy, level), 0, 1)
        cpu = cpu_s(resource.RUSAGE_SELF) - start
        print(f"  bm3d, noise of {level:4.2f}            {decibels(picture, truth):.2f} dB, {cpu:.2f} CPU s", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="petzval")
    program = os.path.abspath(parser.parse_args().program)
    with tempfile.TemporaryDirectory() as folder:
        for name in SIZES:
            compare(program, name, folder)
