# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the command line share: running the program and reading its contract off the outcome.

The program is $PETZVAL_PROGRAM, which ctest sets.
"""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PETZVAL_PROGRAM"]


def main_commands():
    """Names of the subcommands that `petzval --help` lists."""
    return subcommands([])


def subcommands(command):
    """Names of the subcommands below `command`, a list of words, by its --help."""
    text = subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=True).stdout
    names = []
    listing = False
    for line in text.splitlines():
        if line.startswith("Subcommands:"):
            listing = True
        elif listing and line.startswith("  ") and line[2:3].strip():
            names.append(line.split()[0])
        elif listing and not line.startswith(" "):
            listing = False
    return names


def leaf_commands(command=()):
    """All commands that do something themselves, as lists of words."""
    below = subcommands(list(command))
    if not below:
        return [list(command)]
    return [leaf for name in below for leaf in leaf_commands([*command, name])]


class ProgramTest(unittest.TestCase):
    """Each test runs the program in an empty folder of its own, `self.folder`."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def petzval(self, *arguments, **options):
        """Runs `petzval arguments…`; stdout and stderr are captured as text."""
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL, **options}
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True, errors="replace", **options)

    def assert_succeeds(self, *arguments, **options):
        """The program's stdout; fails with its message unless it exits with 0."""
        done = self.petzval(*arguments, **options)
        self.assertEqual(done.returncode, 0, f"{' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def json_of(self, *arguments):
        """What the program prints with --json, parsed strictly: NaN and Infinity are no JSON."""

        def refuse(word):
            self.fail(f"{word} is no JSON")

        return json.loads(self.assert_succeeds(*arguments, "--json"), parse_constant=refuse)

    def assert_error(self, done, code, *words):
        """The contract of a failure: its exit code, one line 'petzval: error: …' that has all `words` in it (notes
        may stand before it), and nothing on stdout."""
        what = f"exit code {done.returncode}, stderr: {done.stderr}"
        self.assertEqual(done.returncode, code, what)
        lines = done.stderr.splitlines()
        errors = [line for line in lines if line.startswith("petzval: error: ")]
        notes = [line for line in lines if line.startswith("petzval: note: ")]
        self.assertEqual((len(errors), len(errors) + len(notes)), (1, len(lines)), what)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertFalse(done.stdout, "a failure prints no results")

    def assert_refused(self, *arguments, words=(), code=2, **options):
        """`petzval arguments…` fails as it should, and leaves the folder as it was."""
        before = self.contents()
        done = self.petzval(*arguments, **options)
        self.assert_error(done, code, *words)
        self.assertEqual(self.contents(), before, "a failure leaves no files")

    def contents(self):
        """{name: bytes} of the folder, hidden files and those in folders too."""
        return {str(path.relative_to(self.folder)): path.read_bytes()
                for path in sorted(self.folder.rglob("*")) if path.is_file()}

    def write(self, name, content):
        """A file in the folder, from text, bytes or (as JSON) anything else; its path."""
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path
