# SPDX-License-Identifier: BSD-3-Clause
"""The example in the help of every command runs as it stands, in a folder with the files that it names."""

import re
import shlex
import unittest

from petzval_cli import ProgramTest, leaf_commands

RAYS = "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n0,0,-10,0,0,1,587.56\n0,1,-10,0,0,1,587.56\n"
# Commands that take long for what they do: tests of their own run them.
SLOW = [["demo"], ["lens", "match"]]
# Pieces of a picture of 16 x 12 pixels, for petzval merge.
PIECES = {"left.sums": "0,0,8,12", "right.sums": "8,0,8,12"}


class HelpExamples(ProgramTest):
    def example(self, command):
        """The example of a command's help, as words."""
        text = self.assert_succeeds(*command, "--help")
        line, = re.findall(r"^Example:\n((?:  .*\n?)+)", text, re.MULTILINE)
        words = shlex.split(line.replace("\\\n", " "))
        self.assertEqual(words[: 1 + len(command)], ["petzval", *command])
        return words[1:]

    def provide(self, word):
        """Makes the input file `word`, if it is one and is not there."""
        if (self.folder / word).exists():
            return
        if word.endswith(".csv"):
            self.write(word, RAYS)
        elif word.endswith((".zmx", ".dat")):
            self.assert_succeeds("lens", "convert", "us-2532751" if word.endswith(".zmx") else "wide-22mm", word)
        elif word in PIECES:
            self.assert_succeeds("render", "spheres", "--lens", "dgauss-50mm", "--size", "16x12", "--spp", "4", "--wavelengths", "550",
                                 "--region", PIECES[word], "--checkpoint", word, "-o", "pieces.npy")
        elif word.endswith((".h5", ".hdf5")):
            self.assert_succeeds("optics", "build", "edmund-54852", "--sensor", "64x48@6.25", "-o", word)
        elif word.endswith(".mat"):
            self.provide("of_mat.h5")
            self.assert_succeeds("optics", "export", "of_mat.h5", "--to", "iset", "--resample", "-o", word)
        elif word == "edges.png":
            self.assert_succeeds("target", "--rectangle", "100x100@5", "-o", word)
        elif word == "map.json":
            self.assert_succeeds("target", "--chart", "slanted-edges", "--size", "300x300", "--f-number", "4", "--wavelength", "550",
                                 "--pixel-pitch", "4.73", "-o", "chart.npy")
            self.write(word, self.assert_succeeds("sfr", "chart.npy", "--json"))
        elif word == "light.exr":
            self.assert_succeeds("image", "studio", "--lens", "edmund-54852", "--sensor", "320x240@3.75", "--method", "none",
                                 "--wavelengths", "400:20:700", "-o", word)
        elif word.endswith(".dng"):
            self.provide("light.exr")
            exposure = {"dar": "0", "dim": "0.002", "bri": "0.005"}.get(word[:3], "auto")
            self.assert_succeeds("sense", "light.exr", "--sensor", "third-inch-1280x960", "--exposure", exposure,
                                 "--seed", str(sum(word.encode())), "-o", word)
        elif word.endswith(".png"):
            self.assert_succeeds("scene", "convert", "colorchecker", word)
        elif word.endswith(".exr"):
            self.assert_succeeds("scene", "convert", "studio", word)

    def test_examples(self):
        outputs = {"-o", "--output", "--plot", "--csv"}
        for command in leaf_commands():
            if command in SLOW:
                continue
            with self.subTest(command=" ".join(command)):
                words = self.example(command)
                made = words[-1:] if command[-1] == "convert" else []
                for previous, word in zip(words, words[1:]):
                    if previous not in outputs and word not in made:
                        self.provide(word)
                self.assert_succeeds(*words)


if __name__ == "__main__":
    unittest.main()
