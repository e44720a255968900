#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the examples of the documents with two builds of the program and tells where they differ: what commands print
(times left out) and every byte of every file that they write. For changes that must not change results.

    tools/compare_programs.py OLD/bin/petzval NEW/bin/petzval [DOCUMENT...]
"""

import filecmp
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "docs"))
from run_examples import find_examples  # noqa: E402

# "1.5 s", "0.909 million camera rays a second", progress lines, names of scratch folders.
TIMES = re.compile(r"[\d.]+(e-\d+)? (ms|s|CPU s|CPU hours|million camera rays a second)\b|^petzval: +\d+ % .*$|/tmp/\S+",
                   re.MULTILINE)


def run(command, folder, program):
    environment = dict(os.environ, PATH=f"{pathlib.Path(program).resolve().parent}:{os.environ['PATH']}",
                       PETZVAL_DATA=str(ROOT / "data"))
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    return done.returncode, TIMES.sub("T", done.stdout)


def files_in(folder):
    return sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*") if path.is_file())


def compare(document, old, new):
    """Differences, a line each, and how many commands and files there were."""
    differences = []
    examples = find_examples(document.read_text())
    with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
        for example in examples:
            if run(example.command, first, old) != run(example.command, second, new):
                differences.append(f"{document.name}:{example.line}: prints something else: {example.command}")
        one, other = files_in(first), files_in(second)
        for name in sorted(set(one) | set(other)):
            if name not in one or name not in other:
                differences.append(f"{document.name}: {name} is written by one alone")
            elif not filecmp.cmp(pathlib.Path(first, name), pathlib.Path(second, name), shallow=False):
                differences.append(f"{document.name}: {name} differs")
    return differences, len(examples), len(one)


def main():
    old, new, *names = sys.argv[1:]
    documents = [pathlib.Path(name) for name in names] or [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    commands = files = 0
    found = []
    for document in documents:
        differences, count, written = compare(document, old, new)
        commands, files = commands + count, files + written
        found += differences
        for line in differences:
            print(line, flush=True)
    print(f"{commands} commands, {files} files: {len(found)} differences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
