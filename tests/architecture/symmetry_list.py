# SPDX-License-Identifier: BSD-3-Clause
"""Holds the list of places that assume symmetry about the axis (docs/TRACING.md, "Where symmetry about the axis is
assumed") to the code: what it names must exist, and every file that includes a header of the symmetric part must
stand in it, by itself or by its folder.

    symmetry_list.py PAGE MODULES_FOLDER
"""

import pathlib
import re
import sys

HEADING = "## Where symmetry about the axis is assumed"
# What these headers offer knows a field by its height, a pupil by its half, or a surface by one curvature.
SYMMETRIC = ["lens/paraxial_system.h", "trace/pencil.h", "trace/pupil.h", "analysis/field_tracer.h", "optics/lens_data_table.h"]


def listed_places(page_text):
    """The paths in the first column of the section's table; folders end in '/'."""
    section = page_text.partition(HEADING)[2].partition("\n## ")[0]
    rows = [line.split("|")[1] for line in section.splitlines() if line.startswith("| `")]
    return [place for row in rows for place in re.findall(r"`([^`]+)`", row)]


def faults(page_text, files, texts):
    """Sentences. files: paths of the modules' sources, relative; texts: {path: text}."""
    places = listed_places(page_text)
    if not places:
        return [f"the page has no table under '{HEADING}'"]
    found = [f"{place} is listed and does not exist"
             for place in places if not any(file == place or (place.endswith("/") and file.startswith(place)) for file in files)]
    for file in files:
        if any(f"<petzval/{header}>" in texts[file] for header in SYMMETRIC) and not any(
                file == place or (place.endswith("/") and file.startswith(place)) for place in places):
            found.append(f"{file} uses what assumes symmetry about the axis and is not listed")
    return found


def self_check():
    page = f"{HEADING}\n\n| where | what |\n|---|---|\n| `trace/a.cpp`, `optics/` | it |\n\n## Next\n| `lens/x.h` | |\n"
    texts = {"trace/a.cpp": "", "optics/b.cpp": "#include <petzval/trace/pupil.h>"}
    assert not faults(page, list(texts), texts)
    assert faults(page, ["optics/b.cpp"], texts) == ["trace/a.cpp is listed and does not exist"]
    texts["isp/c.cpp"] = "#include <petzval/trace/pencil.h>"
    assert faults(page, list(texts), texts) == ["isp/c.cpp uses what assumes symmetry about the axis and is not listed"]
    assert faults("", list(texts), texts)


def main():
    self_check()
    page, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.suffix in {".h", ".cpp"})
    found = faults(page.read_text(), files, {file: (folder / file).read_text() for file in files})
    print("\n".join(found) or "the list is whole")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
