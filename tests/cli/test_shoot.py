# SPDX-License-Identifier: BSD-3-Clause
"""Clips: frames in a folder, kept and gone on with, and what is refused."""

import os
import signal
import subprocess
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest

CLIP = ("shoot", "slanted-edge:5", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960", "--sensor-set",
        "columns=64", "--sensor-set", "rows=48", "--method", "none", "--wavelengths", "450,550,650", "--pan", "10",
        "--shutter", "rolling", "--row-time", "100", "--exposure", "1/500", "--flicker", "mains:50:0.5")


class Shoot(ProgramTest):
    def files_of(self, folder):
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir() if not path.is_dir()}

    def test_same_bytes_for_any_number_of_threads(self):
        for threads in ("1", "2"):
            self.assert_succeeds(*CLIP, "--frames", "2", "--format", "png,dng", "--events", "--threads", threads,
                                 "--date-time", "2026-12-31 23:59:59.99", "--quiet", "-o", f"clip{threads}")
        one, two = self.files_of("clip1"), self.files_of("clip2")
        self.assertEqual(sorted(one), ["clip.json", "events.txt", "frame-000000.dng", "frame-000000.png",
                                       "frame-000001.dng", "frame-000001.png"])
        self.assertEqual(one, two)
        self.assertNotEqual(one["frame-000000.dng"], one["frame-000001.dng"])
        for kind in ("dng", "png"):  # a 24th of a second from frame to frame
            self.assertIn(b"2026:12:31 23:59:59\0", one[f"frame-000000.{kind}"])
            self.assertIn(b"2027:01:01 00:00:00\0", one[f"frame-000001.{kind}"])
            self.assertIn(b"031667\0", one[f"frame-000001.{kind}"])
        t, column, row, sign = one["events.txt"].splitlines()[0].split()
        self.assertGreaterEqual(float(t), 0)
        self.assertIn(sign, (b"0", b"1"))
        self.assertLess(int(column), 64)
        self.assertLess(int(row), 48)

    def test_a_killed_clip_goes_on(self):
        words = (*CLIP, "--frames", "16", "--quiet")
        self.assert_succeeds(*words, "-o", "whole")
        running = subprocess.Popen([PROGRAM, *words, "-o", "killed"], cwd=self.folder)
        first = self.folder / "killed" / "frame-000002.png"
        while not first.exists() and running.poll() is None:
            time.sleep(0.005)
        os.kill(running.pid, signal.SIGKILL)
        running.wait()
        self.assertLess(len(list((self.folder / "killed").glob("frame-*.png"))), 16)
        said = self.json_of(*words, "-o", "killed")
        self.assertGreaterEqual(said["frames_kept"], 3)
        self.assertEqual(self.files_of("killed"), self.files_of("whole"))

    def test_a_folder_of_another_clip_is_refused(self):
        self.assert_succeeds(*CLIP, "--frames", "1", "--quiet", "-o", "clip")
        self.assert_refused(*CLIP, "--frames", "1", "--seed", "2", "-o", "clip", words=("another clip",))

    def test_a_lens_that_was_altered_makes_another_clip(self):
        self.assert_succeeds("lens", "convert", "edmund-54852", "mine.json")
        clip = [("mine.json" if word == "edmund-54852" else word) for word in CLIP]
        self.assert_succeeds(*clip, "--frames", "1", "--quiet", "-o", "clip")
        self.assert_succeeds(*clip, "--frames", "1", "--quiet", "-o", "clip")
        self.assert_succeeds("lens", "convert", "edmund-54852", "mine.json", "--set", "surfaces[4].thickness_mm=0.7")
        self.assert_refused(*clip, "--frames", "1", "-o", "clip", words=("another clip",))

    def test_bad_words_are_refused(self):
        for words, said in ((("--flicker", "disco"), ("--flicker", "mains:50:0.4")),
                            (("--exposure", "1"), ("longer than a frame", "--fps")),
                            (("--event-noise", "3"), ("--events",)),
                            (("--path", "none.csv"), ("--pan",)),
                            (("--vibration", "much"), ("0.02@1-20",)),
                            (("--pan", "x"), ("--pan",)),
                            (("--move", "1"), ("--scene-distance",)),
                            (("--move", ",0"), ("--move ,0", "as 0.2,0")),
                            (("--exposure-compensation", "-1e300"), ("--exposure-compensation", "not in range -40")),
                            (("--step", "linear=a.npy"), ("petzval develop",)),
                            (("--row-time", "-1"), ("--row-time",))):
            with self.subTest(words=words):
                at = CLIP.index(words[0]) if words[0] in CLIP else len(CLIP)
                clip = CLIP[:at] + CLIP[at + 2:]
                self.assert_refused(*clip, "--frames", "1", *words, "-o", "clip", words=said)
        self.assert_refused("shoot", "wall", "--lens", "edmund-54852", "--sensor", "64x48@5", "--frames", "1", "-o",
                            "clip", words=("counts photons",))


if __name__ == "__main__":
    unittest.main()
