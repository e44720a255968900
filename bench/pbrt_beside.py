#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Noise and time beside pbrt-v4: the same scene files through both programs, in turn.

    python3 bench/pbrt_beside.py build/release/bin/petzval PBRT [--threads 1] [--spp 16] [--seeds 12] [--pictures FOLDER]
        [--references 0]

PBRT is the program of a build of https://github.com/mmp/pbrt-v4. Three scenes are bundled ones, three are made here in
pbrt's words; the last rows are through the lens `dgauss-50mm`, pbrt's by its camera "realistic". Both programs render the
luminance (ours from 31 bands), with box filters as large as a pixel and their own samplers (pbrt's `zsobol`). For each
pixel, the variance over the seeds over its squared mean; of it the root of the mean over pixels (rms) and the root of the
median. CPU time is user time a picture less that of a picture of one sample, in ms. `faster` is how many times sooner
petzval reaches pbrt's noise: the ratio of time times variance, for the rms and for the median. `means` is ours over
pbrt's, over what that is in the first row of the same camera: both state light in units of their own. With
`--references 1024`, `means` is that of two pictures of so many samples by each program, and `apart` how far these stand apart
pixel by pixel: the root of the mean square of the relative difference, and what of it the noise of the pictures explains."""

import argparse
import pathlib
import re
import tempfile

import light_noise
import numpy as np
from programs_beside import Pbrt, Petzval

SIZE = light_noise.SIZE
DATA = pathlib.Path(__file__).parent.parent / "data" / "scenes"


# ---------------------------------------------------------------------------------------------------------- scenes
def indirect():
    """A room that a lamp lights by way of its ceiling, and the next room through a door."""
    scene = light_noise.Scene((1.6, 1.4, -1.8), (-0.8, 1, 1.2), 60)
    scene.box((-2, 0, -2), (2, 2.6, 3), 0.7)
    scene.quad((-2, 0, 0.6), (0, 2.6, 0), (2.6, 0, 0), 0.7)  # a wall across, seen from its lit side
    scene.quad((1.35, 1.9, -1.6), (0, 0, 0.5), (0.5, 0, 0), 0, 25)  # shines up
    scene.quad((1.3, 1.88, -1.65), (0.6, 0, 0), (0, 0, 0.6), 0.7)  # its shade
    scene.sphere((-0.9, 0.45, -0.4), 0.45, 0.7)
    scene.sphere((0.3, 0.3, 0.2), 0.3, 0.4)
    return scene


def garden():
    """Sun and sky, and small lamps on posts below a roof."""
    scene = light_noise.day()
    for x in range(6):
        scene.sphere((-1.8 + 0.3 * x, 0.9, 0.2 + 0.25 * (x % 3)), 0.02, 0, 300)
    return scene


BALLS = """
AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0.9 0.6 4
Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.1
Translate -2.6 0.8 6
Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k"
Translate 2.6 0.5 6
Shape "sphere" "float radius" 0.5
AttributeEnd
"""


def texts(folder):
    """Name, text and lens of each row."""
    bundled = {name: (DATA / f"{name}.pbrt").read_text() for name in ("spheres", "lamps", "fog")}
    for name, text in bundled.items():
        yield name, text, False
    yield "indirect light", indirect().pbrt(folder).read_text(), False
    yield "sun, sky and lamps", garden().pbrt(folder).read_text(), False
    yield "400 lamps, glass, metal", light_noise.hall().pbrt(folder).read_text() + BALLS, False
    yield "spheres, lens", bundled["spheres"], True
    yield "lamps, lens", bundled["lamps"], True


def for_both(text):
    """Of our size."""
    for name, pixels in zip("xy", SIZE):
        text = re.sub(rf'"integer {name}resolution" \d+', f'"integer {name}resolution" {pixels}', text)
    return text


# -------------------------------------------------------------------------------------------------------- figures
def measured(programs, text, lens, options, folder):
    """Pictures and the time of one, program by program, in turn."""
    pictures, times = [[] for _ in programs], [[] for _ in programs]
    for seed in range(1, options.seeds + 1):
        for i, program in enumerate(programs):
            picture, time = program.render(text, lens, options.spp, seed, folder)
            pictures[i].append(picture)
            times[i].append(time - program.render(text, lens, 1, seed, folder)[1])
    return pictures, [float(np.median(each)) * 1e3 * options.spp / (options.spp - 1) for each in times]


def apart(ours, theirs):
    """Relative difference of two mean pictures of the same mean, and what it would be by noise."""
    ours, theirs = ([each / np.mean(of) for each in of] for of in (ours, theirs))
    one, other = np.mean(ours, 0), np.mean(theirs, 0)
    scale = np.maximum(other, 0.1)
    noise = (np.var(ours, 0, ddof=1) + np.var(theirs, 0, ddof=1)) / len(ours)
    return np.sqrt(np.mean(((one - other) / scale) ** 2)), np.sqrt(np.mean(noise / scale ** 2))


def save(pictures, path):
    """Side by side, ours on the left, each as bright as its mean asks for."""
    import imageio.v3 as imageio
    sides = [np.mean(each, 0) for each in pictures]
    grey = np.concatenate([np.clip(0.4 * each / each.mean(), 0, 1) ** (1 / 2.2) for each in sides], 1)
    imageio.imwrite(path, np.round(255 * grey).astype(np.uint8).repeat(4, 0).repeat(4, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("petzval", type=pathlib.Path)
    parser.add_argument("pbrt", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--spp", type=int, default=16, help="2 or more")
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--references", type=int, default=0, help="samples of converged pictures")
    parser.add_argument("--only", help="scenes whose name has this in it")
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for the mean pictures, side by side (takes imageio)")
    options = parser.parse_args()
    programs = [Petzval(options.petzval.resolve(), options.threads), Pbrt(options.pbrt.resolve(), options.threads)]
    print(f"{'scene':<24}{'rms: ours':>10}{'pbrt':>7}{'median: ours':>14}{'pbrt':>7}{'ms: ours':>10}{'pbrt':>7}{'faster: rms':>13}{'median':>8}{'means':>8} +-"
          + (f"{'apart':>11}{'noise':>8}" if options.references else ""))
    unit = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        programs[0].write_lens(folder)
        for title, text, lens in texts(folder):
            if options.only and options.only not in title:
                continue
            pictures, times = measured(programs, for_both(text), lens, options, folder)
            (rms, median, mean, error), (rms2, median2, mean2, error2) = map(light_noise.figures, pictures)
            if options.references:
                pictures = [[program.render(for_both(text), lens, options.references, seed, folder)[0] for seed in (101, 102)] for program in programs]
                (*_, mean, error), (*_, mean2, error2) = map(light_noise.figures, pictures)
            ratio = mean / mean2
            one = unit.setdefault(lens, ratio)
            slower = times[1] / times[0]
            print(f"{title:<24}{rms:>10.3f}{rms2:>7.3f}{median:>14.4f}{median2:>7.4f}{times[0]:>10.0f}{times[1]:>7.0f}"
                  f"{slower * (rms2 / rms) ** 2:>13.1f}{slower * (median2 / median) ** 2:>8.1f}{ratio / one:>8.3f} {ratio / one * np.hypot(error / mean, error2 / mean2):.3f}"
                  + ("{:>9.4f}{:>8.4f}".format(*apart(*pictures)) if options.references else ""), flush=True)
            if options.pictures:
                options.pictures.mkdir(exist_ok=True, parents=True)
                save(pictures, options.pictures / f"{title.replace(', ', '-').replace(' ', '-')}.png")


if __name__ == "__main__":
    main()
