#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the frames of a focus pull gain by sharing their paths: CPU time and error, in turn in one run.

    python bench/focus_pull.py [--reference 2048] [--seeds 3] [scene:lens ...]

Twelve frames of 240 x 180 pixels at 32 samples from 1 m to 3 m, by Camera.render() and by render_frames(). The error is
of the frame in the middle, of light in eight bands, against the same frame at --reference samples: the RMS over pixels
and bands, over the mean light, and the median over pixels of the relative error of their sums over bands. `light` is the
sum over that of the reference. Errors and light are means over seeds, CPU of all twelve frames as well."""

import argparse
import time

import numpy as np

import petzval as pz

FRAMES, MIDDLE = 12, 6
KEYWORDS = {"size": (240, 180), "wavelengths_nm": list(range(400, 700, 40))}


def own(cameras, scene, seed):
    return [camera.render(scene, samples_per_pixel=32, seed=seed, **KEYWORDS) for camera in cameras]


def shared(cameras, scene, seed):
    return pz.render_frames(cameras, scene, samples_per_pixel=32, seed=seed, **KEYWORDS)


def errors(light, truth):
    sums, true_sums = light.sum(axis=2), truth.sum(axis=2)
    lit = true_sums > 1e-3 * true_sums.mean()
    return (np.sqrt(np.mean((light - truth) ** 2)) / truth.mean(),
            np.median(np.abs(sums[lit] / true_sums[lit] - 1)), light.sum() / truth.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", nargs="*", default=["spheres:dgauss-50mm", "lamps:dgauss-50mm", "spheres:double-gauss"])
    parser.add_argument("--reference", type=int, default=2048)
    parser.add_argument("--seeds", type=int, default=3)
    asked = parser.parse_args()
    print("scene    lens          frames   CPU [s]  RMS     median  light")
    for pair in asked.pairs:
        scene, lens = pair.split(":")
        cameras = [pz.Camera(pz.Lens(lens), focus=f"{1 + 2 * i / (FRAMES - 1):.9g}m") for i in range(FRAMES)]
        truth = np.array(cameras[MIDDLE].render(scene, samples_per_pixel=asked.reference, seed=99, **KEYWORDS).light)
        for kind in (own, shared):
            rows = []
            for seed in range(1, asked.seeds + 1):
                start = time.process_time()
                frames = kind(cameras, scene, seed)
                rows.append((time.process_time() - start, *errors(np.array(frames[MIDDLE].light), truth)))
            cpu, rms, median, light = np.mean(rows, axis=0)
            print(f"{scene:8} {lens:13} {kind.__name__:7} {cpu:8.1f}  {rms:6.3f}  {median:6.3f}  {light:6.3f}", flush=True)


main()
