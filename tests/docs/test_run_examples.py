# SPDX-License-Identifier: BSD-3-Clause
"""The example runner itself, with a stand-in for the program that prints its arguments."""

import pathlib
import tempfile
import unittest

import run_examples

STAND_IN = """#!/bin/sh
for word in "$@"; do
  case "$word" in
    bad) echo "petzval: error: bad" >&2; exit 2 ;;
    *) echo "$word" ;;
  esac
done
"""


class RunExamples(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.program = self.folder / "petzval"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)

    def complaints(self, *lines):
        document = self.folder / "document.md"
        document.write_text("# Title\n\n```console\n" + "".join(line + "\n" for line in lines) + "```\n")
        return run_examples.run_document(document, self.program)

    def test_right_output(self):
        self.assertEqual(self.complaints("$ petzval one two", "one", "two", "$ petzval three", "three"), [])

    def test_wrong_missing_and_surplus_output(self):
        for printed in (["one"], ["one", "three"], ["one", "two", "three"], ["two", "one"], []):
            complaints = self.complaints("$ petzval one two", *printed)
            self.assertEqual(len(complaints), 1, printed)
            self.assertIn("document.md:4", complaints[0])

    def test_the_right_line_of_a_later_command(self):
        complaints = self.complaints("$ petzval one", "one", "$ petzval two", "zwei")
        self.assertIn("document.md:6: $ petzval two", complaints[0])

    def test_wildcard_lines(self):
        self.assertEqual(self.complaints("$ petzval a b c d", "a", "...", "d"), [])
        self.assertEqual(self.complaints("$ petzval a b", "a", "...", "b"), [])
        self.assertEqual(len(self.complaints("$ petzval a b c", "a", "...", "d")), 1)

    def test_wildcards_within_a_line(self):
        self.assertEqual(self.complaints("$ petzval 'took 3 s'", "took ... s"), [])
        self.assertEqual(len(self.complaints("$ petzval 'took 3' s", "took ... s")), 1)

    def test_letters_are_letters(self):
        self.assertEqual(len(self.complaints("$ petzval abc", "a.c")), 1)

    def test_continued_command(self):
        self.assertEqual(self.complaints("$ petzval one \\", "    two", "one", "two"), [])

    def test_failures_are_shown_or_they_are_faults(self):
        self.assertEqual(self.complaints("$ petzval bad", "petzval: error: bad"), [])
        self.assertEqual(len(self.complaints("$ petzval bad", "...")), 1)
        self.assertEqual(len(self.complaints("$ petzval good", "petzval: error: bad")), 1)

    def test_output_without_command(self):
        with self.assertRaisesRegex(ValueError, "line 4"):
            self.complaints("one")

    def test_other_blocks_are_left_alone(self):
        self.assertEqual(run_examples.find_examples("```sh\n$ rm -r\n```\n\n    $ petzval\n"), [])

    def test_blocks_with_a_name_are_files(self):
        page = "```cpp a.cpp\nint x;\n```\n\n```cpp\nint y;\n```\n\n```console\n$ cat a.cpp\nint x;\n$ ls\na.cpp\n```\n"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "page.md"
            path.write_text(page)
            self.assertEqual(run_examples.run_document(path, "/bin/true"), [])

    def test_a_document_keeps_its_folder(self):
        self.assertEqual(self.complaints("$ petzval one > file", "$ cat file", "one"), [])


if __name__ == "__main__":
    unittest.main()
