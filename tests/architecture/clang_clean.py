# SPDX-License-Identifier: BSD-3-Clause
"""Compiles with clang, warnings as errors and without making anything: every public header alone, and the sources that
changed within the last hours before the newest commit, or that are not committed yet. Sources of one folder are compiled
several at once, as the build does it; those that complain together again one by one.

    clang_clean.py headers|sources PROJECT_FOLDER BUILD_FOLDER CLANG
"""

import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

HOURS = 2
AT_ONCE = 8
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


def changed_sources(project):
    def git(*words):
        return subprocess.run(["git", "-C", project, *words], capture_output=True, text=True, check=True).stdout.split()

    newest = int(git("log", "-1", "--format=%ct")[0])
    base = git("rev-list", "-1", f"--before={newest - HOURS * 3600}", "HEAD")
    empty_tree = "4b825dc642cb6eb9a060e54bf8d69288fbee4904"
    names = set(git("diff", "--name-only", "--diff-filter=d", base[0] if base else empty_tree))
    return [project / name for name in sorted(names)
            if name.endswith(".cpp") and name.split("/")[0] in ("src", "apps", "tests")
            and not name.startswith("tests/consumer")]


def complaint(clang, flags, words, text=None):
    done = subprocess.run([clang, "-std=c++20", "-fsyntax-only", *WARNINGS, *flags, *words], capture_output=True, text=True, input=text)
    return done.stderr if done.returncode else ""


def complaints_of_sources(clang, flags, sources):
    quote = ["-iquote", str(sources[0].parent)]
    together = "".join(f'#include "{source}"\n' for source in sources)
    if len(sources) > 1 and not complaint(clang, flags, ["-x", "c++", "-", *quote], together):
        return []
    return list(filter(None, (complaint(clang, flags, [str(source), *quote]) for source in sources)))


def in_groups(sources):
    folders = {}
    for source in sources:
        folders.setdefault(source.parent, []).append(source)
    return [of[i : i + AT_ONCE] for of in folders.values() for i in range(0, len(of), AT_ONCE)]


def main():
    what, project, build, clang = sys.argv[1], *map(pathlib.Path, sys.argv[2:4]), sys.argv[4]
    flags = include_flags(build)
    if what == "headers":
        names = (build / "public_headers.txt").read_text().split()
        checks = [(complaint, ["-x", "c++", str(project / "src/petzval" / name), "-Wno-pragma-once-outside-header"]) for name in names]
    else:
        try:
            sources = changed_sources(project)
        except (subprocess.CalledProcessError, FileNotFoundError, IndexError):
            print("no history to tell what changed")
            return 77
        names = sources
        checks = [(complaints_of_sources, group) for group in in_groups(sources)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda check: check[0](clang, flags, check[1]), checks))
    complaints = [text for each in found for text in ([each] if isinstance(each, str) else each) if text]
    print("\n".join(complaints))
    print(f"{len(names)} files, {len(complaints)} with complaints")
    return 1 if complaints or (what == "headers" and not names) else 0


sys.exit(main())
