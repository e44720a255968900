# SPDX-License-Identifier: BSD-3-Clause
"""`lens tolerance --record`: work that was killed goes on, to the same bytes."""
import signal
import subprocess
import time
import unittest

from petzval_cli import PROGRAM, ProgramTest

BUILDS = ("lens", "tolerance", "cooke-triplet", "--fields", "0,14,20", "--builds", 400, "--quiet")


class BuildRecord(ProgramTest):
    def test_a_killed_program_goes_on(self):
        plain = self.assert_succeeds(*BUILDS)
        record = self.folder / "builds.txt"
        with subprocess.Popen([PROGRAM, *map(str, BUILDS), "--record", record, "--threads", "1"], cwd=self.folder,
                              stdout=subprocess.DEVNULL) as running:
            while running.poll() is None and not (record.exists() and record.read_bytes().count(b"\n") > 40):
                time.sleep(0.01)
            running.send_signal(signal.SIGKILL)
        kept = record.read_bytes()[: record.read_bytes().rfind(b"\n") + 1]
        self.assertEqual(self.assert_succeeds(*BUILDS, "--record", "builds.txt"), plain)
        self.assertTrue(record.read_bytes().startswith(kept))

    def test_a_record_of_other_builds_is_refused(self):
        few = (*BUILDS[:6], 3)
        self.assert_succeeds(*few, "--record", "builds.txt")
        before = (self.folder / "builds.txt").read_bytes()
        self.assert_refused(*few, "--record", "builds.txt", "--seed", 2, words=["not the same seed"])
        self.assertEqual((self.folder / "builds.txt").read_bytes(), before)
        self.assert_refused(*few, "--record", "nowhere/builds.txt", words=["nowhere"])


if __name__ == "__main__":
    unittest.main()
