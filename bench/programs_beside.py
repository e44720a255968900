# SPDX-License-Identifier: BSD-3-Clause
"""petzval and pbrt-v4 as the scripts that measure them side by side call them: the same text in, the luminance and the time out."""

import re
import resource
import subprocess

import numpy as np

LENS = "dgauss-50mm"


def for_pbrt(text, seed, lens, sampler):
    """With a box filter as large as a pixel, and the lens as pbrt's camera "realistic" reads it."""
    if lens:
        distance = re.search(r'"float focaldistance" ([\d.]+)', text).group(1)
        text = re.sub(r'Camera "perspective".*', f'Camera "realistic" "string lensfile" "{LENS}.dat" "float aperturediameter" 17.1 '
                      f'"float focusdistance" {distance}', text)
    return text.replace("WorldBegin", f'PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5\nSampler "{sampler}" "integer seed" {seed}\nWorldBegin', 1)


def timed(command, folder):
    """User time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(list(map(str, command)), check=True, cwd=folder, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def luminous_efficiency(nm):
    """Wyman, Sloan & Shirley, J. Comput. Graph. Tech. 2 (2013) 2, table 1."""
    def lobe(height, centre, below, above):
        return height * np.exp(-0.5 * ((nm - centre) / np.where(nm < centre, below, above)) ** 2)
    return lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1)


class Petzval:
    """`threads`: None for as many as there are."""

    def __init__(self, program, threads=None):
        self.program, self.threads = program, threads

    def write_lens(self, folder):
        subprocess.run([self.program, "lens", "convert", LENS, folder / f"{LENS}.dat"], check=True, capture_output=True)

    def render(self, text, lens, samples, seed, folder):
        (folder / "ours.pbrt").write_text(text)
        camera = ["--lens", LENS] if lens else ["--pinhole"]
        threads = ["--threads", self.threads] if self.threads else []
        time = timed([self.program, "render", "ours.pbrt", *camera, "--wavelengths", "400:10:700", "--spp", samples,
                      "--seed", seed, *threads, "--quiet", "-o", "ours.npy"], folder)
        return np.load(folder / "ours.npy") @ luminous_efficiency(np.arange(400, 701, 10)), time


class Pbrt:
    def __init__(self, program, threads=None, sampler="zsobol"):
        self.program, self.threads, self.sampler = program, threads, sampler

    def render(self, text, lens, samples, seed, folder):
        (folder / "theirs.pbrt").write_text(for_pbrt(text, seed, lens, self.sampler))
        threads = ["--nthreads", self.threads] if self.threads else []
        time = timed([self.program, "--spp", samples, *threads, "--quiet", "--outfile", "theirs.pfm", "theirs.pbrt"], folder)
        # PFM: three lines of text, then floats, the lowest row first.
        _, size, _, data = (folder / "theirs.pfm").read_bytes().split(b"\n", 3)
        width, height = map(int, size.split())
        return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1] @ [0.2126, 0.7152, 0.0722], time
