# SPDX-License-Identifier: BSD-3-Clause
"""Compiles with clang, warnings as errors and without making anything, what changed within the last hours before the newest
commit or is not committed yet: public headers, each alone, with those that include them, and sources. Sources of one folder
are compiled several at once, as the build does it; those that complain together again by halves.

    clang_clean.py headers|sources PROJECT_FOLDER BUILD_FOLDER CLANG [--all | --since COMMIT | FILE...]
    clang_clean.py tidy PROJECT_FOLDER BUILD_FOLDER CLANG_TIDY [--all | --since COMMIT | FILE...]

tidy: the checks of .clang-tidy over sources of src and apps. --all: whatever changed, everything. --since: what differs from that commit.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOURS = 2
AT_ONCE = 16
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wno-unknown-warning-option"]


def include_flags(build):
    """Folders of headers and definitions, as the build of any file has them."""
    flags = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        for word, following in zip(words, words[1:] + [""]):
            if word.startswith(("-I", "-D")) and word not in ("-I", "-D"):
                flags[word] = None
            elif word == "-isystem":
                flags["-isystem" + following] = None
    return list(flags)


def changed_files(project, wanted):
    def git(*words):
        return subprocess.run(["git", "-C", project, *words], capture_output=True, text=True, check=True).stdout.split()

    if wanted and not wanted[0].startswith("--"):
        return [str(pathlib.Path(name).resolve().relative_to(project.resolve())) for name in wanted]
    if wanted[:1] == ["--since"]:
        base = wanted[1:2]
    else:
        newest = int(git("log", "-1", "--format=%ct")[0])
        base = [] if wanted else git("rev-list", "-1", f"--before={newest - HOURS * 3600}", "HEAD")
    empty_tree = "4b825dc642cb6eb9a060e54bf8d69288fbee4904"
    return sorted(set(git("diff", "--name-only", "--diff-filter=d", base[0] if base else empty_tree)))


def sources_of(project, changed, folders=("src", "apps", "tests")):
    return [project / name for name in changed if name.endswith(".cpp") and name.split("/")[0] in folders
            and not name.startswith("tests/consumer")]


def headers_of(project, build, changed):
    """Public headers that changed, and those that include one that did."""
    touched = {name.removeprefix("src/") for name in changed if name.startswith("src/") and name.endswith(".h")}
    public = [project / "src/petzval" / name for name in (build / "public_headers.txt").read_text().split()]
    return [header for header in public if str(header.relative_to(project / "src")) in touched
            or touched.intersection(re.findall(r"#include <(petzval/[^>]+)>", header.read_text()))]


def complaint(clang, flags, words, text=None):
    done = subprocess.run([clang, "-std=c++20", "-fsyntax-only", *WARNINGS, *flags, *words], capture_output=True, text=True, input=text)
    return done.stderr if done.returncode else ""


def complaints_of_header(clang, flags, header):
    text = complaint(clang, flags, ["-x", "c++", str(header), "-Wno-pragma-once-outside-header"])
    return [text] if text else []


def complaints_of_sources(clang, flags, sources):
    together = "".join(f'#include "{source}"\n' for source in sources)
    text = complaint(clang, flags, ["-x", "c++", "-", "-iquote", str(sources[0].parent)], together)
    if len(sources) == 1 or not text:
        return [text] if text else []
    half = len(sources) // 2
    return [each for part in (sources[:half], sources[half:]) for each in complaints_of_sources(clang, flags, part)]


def findings(clang_tidy, flags, sources):
    """What .clang-tidy finds in sources of one folder, which are read as one."""
    with tempfile.TemporaryDirectory() as folder:
        together = pathlib.Path(folder) / "together.cpp"
        together.write_text("".join(f'#include "{source}"\n' for source in sources))
        words = [clang_tidy, "--quiet", f"--config-file={ROOT / '.clang-tidy'}", "--warnings-as-errors=*", str(together)]
        done = subprocess.run([*words, "--", "-std=c++20", *flags, "-iquote", str(sources[0].parent)], capture_output=True, text=True)
    if "clang-diagnostic-error" in done.stdout and len(sources) > 1:  # names that only the build keeps apart
        half = len(sources) // 2
        return [each for part in (sources[:half], sources[half:]) for each in findings(clang_tidy, flags, part)]
    return [done.stdout] if done.returncode else []


def in_groups(sources):
    folders = {}
    for source in sources:  # those that Highway includes again and again stand alone
        alone = "foreach_target.h" in source.read_text()
        folders.setdefault(source if alone else source.parent, []).append(source)
    return [of[i : i + AT_ONCE] for of in folders.values() for i in range(0, len(of), AT_ONCE)]


def main():
    what, project, build, clang = sys.argv[1], *map(pathlib.Path, sys.argv[2:4]), sys.argv[4]
    flags = include_flags(build)
    try:
        changed = changed_files(project, sys.argv[5:])
    except (subprocess.CalledProcessError, FileNotFoundError, IndexError):
        print("no history to tell what changed")
        return 77
    if what == "headers":
        names = parts = headers_of(project, build, changed)
        check = complaints_of_header
    else:
        names = sources_of(project, changed, ("src", "apps")) if what == "tidy" else sources_of(project, changed)
        parts = in_groups(names)
        check = findings if what == "tidy" else complaints_of_sources
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        complaints = [text for each in pool.map(lambda part: check(clang, flags, part), parts) for text in each]
    print("\n".join(complaints))
    print(f"{len(names)} files, {len(complaints)} with complaints")
    return 1 if complaints else 0


sys.exit(main())
