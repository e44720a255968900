# SPDX-License-Identifier: BSD-3-Clause
"""Holds what the documents say of their checks: each test that they name exists where they say, and every test of a law
(tests/physics) is named by the page that states the law.

    checked_by.py PROJECT_FOLDER
"""

import itertools
import pathlib
import re
import sys

NAME = re.compile(r"`((?:[A-Za-z0-9_{},/]+/)?[A-Za-z0-9_{},]+(?:_test\.cpp|_test\.py)|(?:[a-z_]+/)?test_[a-z0-9_]+\.py)`")


def expanded(name):
    """`a/{b,c}_test.cpp` is two names."""
    parts = [part.split(",") for part in re.split(r"[{}]", name)]
    return ["".join(choice) for choice in itertools.product(*parts)]


def complaints(pages, tests):
    """pages: text by name; tests: paths below tests/."""
    named = {}
    for page, text in pages.items():
        for found in NAME.findall(text):
            for name in expanded(found):
                named.setdefault(name.removeprefix("tests/"), page)
    missing = [f"{page}: there is no test `{name}`" for name, page in named.items()
               if not any(test == name or test.endswith("/" + name) for test in tests)]
    unnamed = [f"no document names tests/{test}" for test in tests
               if test.startswith("physics/") and test.endswith("_test.cpp")
               and not any(test == name or test.endswith("/" + name) for name in named)]
    return missing + unnamed


def main():
    project = pathlib.Path(sys.argv[1])
    pages = {path.name: path.read_text() for path in sorted((project / "docs").glob("*.md"))}
    tests = [str(path.relative_to(project / "tests")) for path in sorted((project / "tests").rglob("*")) if path.is_file()]
    found = complaints(pages, tests)
    # The checker itself: a page that names what is not there, and a law that no page names.
    assert len(complaints({"a.md": "`physics/{x,y}_test.cpp`"}, ["physics/x_test.cpp", "physics/z_test.cpp"])) == 2
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
