# SPDX-License-Identifier: BSD-3-Clause
"""Scenes that are kept in a file: what reading them takes of memory is a small part of what they hold."""

import os
import subprocess
import unittest

import numpy as np

from petzval_cli import PROGRAM, ProgramTest

# A byte a number makes 550 MB of radiance, and scenes of more than 512 MiB are kept in a file.
SIDE, BANDS = 2100, 31
HELD_MB = SIDE * SIDE * BANDS * 4 / 1e6
# The program and its libraries take 40 MB. Reading takes a band at a time, on each thread a second one, and a piece of the file.
BOUND_MB = 250
AXES = {"bsq": (2, 0, 1), "bil": (0, 2, 1), "bip": (0, 1, 2)}


def peak_mb(*arguments, **options):
    """Peak resident memory of the program [MB], and what it printed."""
    # The usage of all children of a process of our own, which has one.
    code = ("import resource, subprocess, sys; done = subprocess.run(sys.argv[1:]);"
            "print('PEAK', resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(done.returncode)")
    done = subprocess.run(["/usr/bin/env", "python3", "-c", code, PROGRAM, *map(str, arguments)], text=True, check=True,
                          stdout=subprocess.PIPE, **options)
    return int(done.stdout.split("PEAK")[-1]) / 1000, done.stdout


class Large(ProgramTest):
    def cube(self):
        row, column = np.ogrid[0:SIDE, 0:SIDE]
        plane = ((row * 7 + column * 3) % 199 + 1).astype("u1")
        return np.stack([plane + np.uint8(band) for band in range(BANDS)], axis=2)

    def facts(self, name, *options):
        taken, text = peak_mb("scene", "info", name, "--scene-angle", 20, "--scene-quantity", "radiance", "--threads", 2, *options,
                              cwd=self.folder, env={**os.environ, "TMPDIR": str(self.folder)})
        if "PETZVAL_SANITIZED" not in os.environ:
            self.assertLess(taken, BOUND_MB)
        self.assertGreater(HELD_MB, 2 * BOUND_MB)
        return [line for line in text.splitlines() if "luminance" in line or "radiance" in line]

    def test_all_interleaves_stay_within_bounds_and_are_one_scene(self):
        cube = self.cube()
        facts = []
        for interleave, axes in AXES.items():
            np.ascontiguousarray(cube.transpose(axes)).tofile(self.folder / "cube.img")
            (self.folder / "cube.hdr").write_text(
                f"ENVI\nsamples = {SIDE}\nlines = {SIDE}\nbands = {BANDS}\ndata type = 1\ninterleave = {interleave}\n"
                f"wavelength = {{{', '.join(str(400 + 10 * band) for band in range(BANDS))}}}\n")
            facts.append(self.facts("cube.hdr"))
        self.assertEqual(len(facts[0]), 2)
        self.assertTrue(all(each == facts[0] for each in facts), facts)

    def test_so_do_arrays_and_other_wavelengths(self):
        np.save(self.folder / "cube.npy", self.cube())
        straight = self.facts("cube.npy", "--scene-bands", "400:10:700", "--wavelengths", "400:10:690,699")
        np.save(self.folder / "cube.npy", np.asfortranarray(self.cube()))
        turned = self.facts("cube.npy", "--scene-bands", "400:10:700", "--wavelengths", "400:10:690,699")
        self.assertEqual(turned, straight)


if __name__ == "__main__":
    unittest.main()
