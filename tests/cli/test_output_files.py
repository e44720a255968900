# SPDX-License-Identifier: BSD-3-Clause
"""Outputs appear whole or not at all: a full disk, a folder that is not there, a name that is taken."""

import filecmp
import os
import resource
import shutil
import signal
import stat
import subprocess
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest
from sample_files import SINGLET

IMAGE = ["image", "colorchecker", "--lens", "edmund-54852", "--sensor", "64x48@10", "--wavelengths", "450,550,600"]
PSF = ["lens", "psf", "edmund-54852", "--fields", "0", "--wavelengths", "587.56"]
# Commands that write a file, its name as the last word.
WRITERS = [
    ["lens", "convert", "singlet.json", "lens.json"],
    ["lens", "draw", "edmund-54852", "-o", "drawing.svg"],
    ["lens", "trace", "singlet.json", "--rays", "rays.csv", "-o", "traced.csv"],
    ["lens", "illumination", "edmund-54852", "--plot", "plot.svg"],
    [*PSF, "-o", "psf.npy"],
    [*PSF, "-o", "psf.png"],
    ["scene", "convert", "colorchecker", "scene.exr"],
    ["optics", "build", "edmund-54852", "--sensor", "64x48@10", "--fields", "3", "--wavelengths", "587.56", "-o", "table.h5"],
    [*IMAGE, "-o", "picture.exr"],
    [*IMAGE, "-o", "picture.npy"],
    [*IMAGE, "-o", "picture.png"],
]


def one_kilobyte_at_most():
    """In the child: writing beyond 1024 bytes fails as on a full disk (EFBIG for ENOSPC), and the signal that comes
    with it would end a program that does not expect it."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))


class OutputFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("singlet.json", SINGLET)
        rays = "".join(f"0,{0.01 * i},-5,0,0,1,587.56\n" for i in range(400))
        self.write("rays.csv", "x_mm,y_mm,z_mm,L,M,N,wavelength_nm\n" + rays)

    def large_writers(self):
        """Those whose output is over a kilobyte, with that output removed again."""
        for writer in WRITERS:
            self.assert_succeeds(*writer)
            output = self.folder / writer[-1]
            size = output.stat().st_size
            output.unlink()
            if size > 1024:
                yield writer

    def test_a_full_disk(self):
        writers = list(self.large_writers())
        self.assertTrue(writers)
        for writer in writers:
            with self.subTest(writer=writer):
                self.assert_refused(*writer, code=1, words=[f"error: {writer[-1]}: "], preexec_fn=one_kilobyte_at_most)

    def test_a_full_disk_keeps_what_was_there(self):
        for writer in self.large_writers():
            self.write(writer[-1], "precious")
            with self.subTest(writer=writer):
                self.assert_refused(*writer, code=1, preexec_fn=one_kilobyte_at_most)

    def test_a_really_full_disk(self):
        """A file system of 16 kB of our own, where the machine lets a user make one."""
        disk = self.folder / "disk"
        disk.mkdir()
        script = ('mount -t tmpfs -o size=16k tmpfs "$1" || exit 77; head -c 16384 /dev/zero > "$1/ballast"; '
                  'shift; "$@"; code=$?; ls -A disk >&2; exit $code')
        if shutil.which("unshare") is None:
            self.skipTest("unshare is not installed")
        command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script, "sh", "disk"]
        for writer in WRITERS:
            arguments = [*writer[:-1], f"disk/{writer[-1]}"]
            done = subprocess.run([*command, PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True)
            if done.returncode == 77 or "unshare:" in done.stderr:
                self.skipTest(f"this machine lets nobody mount a file system: {done.stderr.strip()}")
            with self.subTest(writer=writer):
                self.assertEqual(done.returncode, 1, done.stderr)
                *message, left = done.stderr.splitlines()
                self.assertEqual(left, "ballast", "nothing else is left on the disk")
                self.assertRegex(message[-1], "^petzval: error: ")

    def test_outputs_of_one_command_appear_all_or_none(self):
        """The picture of a wall is small enough, its irradiance is not."""
        wall = ["image", "wall", *IMAGE[2:], "-o", "small.png", "-o", "large.npy"]
        before = sorted(path.name for path in self.folder.iterdir())
        self.assert_refused(*wall, code=1, words=["large.npy"], preexec_fn=one_kilobyte_at_most)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)
        self.assert_succeeds(*wall)
        self.assertLess((self.folder / "small.png").stat().st_size, 1024, "or the test above proves nothing")

    def test_a_large_array_is_the_same_alone_and_with_others(self):
        """Alone it is written while it is formed; no room for it shows before the work, and leaves nothing."""
        wall = ["image", "wall", "--lens", "edmund-54852", "--sensor", "4200x4000@1", "--wavelengths", "480:20:620", "--method", "none"]
        before = sorted(path.name for path in self.folder.iterdir())
        self.assert_refused(*wall, "-o", "alone.npy", code=1, words=["alone.npy"], preexec_fn=one_kilobyte_at_most)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)
        self.assert_succeeds(*wall, "-o", "alone.npy")
        self.assertGreater((self.folder / "alone.npy").stat().st_size, 1 << 29, "or it is no large array")
        self.assert_succeeds(*wall, "-o", "one.npy", "-o", "other.npy")
        for name in ("one.npy", "other.npy"):
            self.assertTrue(filecmp.cmp(self.folder / "alone.npy", self.folder / name, shallow=False), name)
            (self.folder / name).unlink()
        (self.folder / "alone.npy").unlink()
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)

    def test_a_killed_run_leaves_what_was_there(self):
        """Killed at twelve moments from before its work to after it: the outputs are old or new, both whole."""
        ask = ["image", "wall", "--scene-size", "400x300", *IMAGE[2:], "-o", "out.npy", "-o", "out.png"]
        started = time.monotonic()
        self.assert_succeeds(*ask)
        took = time.monotonic() - started
        fresh = [(self.folder / name).read_bytes() for name in ("out.npy", "out.png")]
        kills = 0
        for moment in range(12):
            for name in ("out.npy", "out.png"):
                (self.folder / name).write_bytes(b"old")
            running = subprocess.Popen([PROGRAM, *map(str, ask)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(took * (moment + 1) / 12)
            running.kill()
            kills += running.wait() == -signal.SIGKILL
            for name, whole in zip(("out.npy", "out.png"), fresh):
                self.assertIn((self.folder / name).read_bytes(), (b"old", whole))
        self.assertGreater(kills, 3, "it ended too soon to tell")

    def test_a_demo_that_fails_leaves_no_folder(self):
        self.assert_refused("demo", "-o", "pictures", code=1, preexec_fn=one_kilobyte_at_most)
        self.assertFalse((self.folder / "pictures").exists())

    def test_a_folder_that_is_not_there(self):
        for writer in WRITERS:
            self.assert_refused(*writer[:-1], f"nowhere/{writer[-1]}", words=["nowhere"])

    def test_a_name_that_is_a_folder(self):
        for writer in WRITERS:
            (self.folder / writer[-1]).mkdir()
            self.assert_refused(*writer, words=[writer[-1]])

    def test_an_extension_that_means_something_else(self):
        """Numbers in .csv may have any name; a drawing named .png would deceive whoever opens it."""
        for writer in WRITERS:
            if not writer[-1].endswith(".csv"):
                with self.subTest(writer=writer):
                    self.assert_refused(*writer[:-1], "out.nonsense", words=["out.nonsense"])

    def test_pipes_and_devices_are_not_replaced(self):
        """Renaming over /dev/null as root would take it from the whole machine; a pipe stands for it here."""
        for writer in WRITERS:
            pipe = self.folder / writer[-1]
            os.mkfifo(pipe)
            reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
            try:
                self.petzval(*writer, timeout=60)
            finally:
                os.close(reader)
            with self.subTest(writer=writer):
                self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_a_folder_without_permission(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        for writer in WRITERS:
            self.assert_refused(*writer[:-1], f"locked/{writer[-1]}", code=1, words=["locked"])


if __name__ == "__main__":
    unittest.main()
