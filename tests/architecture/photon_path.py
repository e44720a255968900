# SPDX-License-Identifier: BSD-3-Clause
"""Checks that each function of docs/ARCHITECTURE.md is declared in the header that the page names.

    photon_path.py PAGE MODULES_FOLDER
"""

import pathlib
import re
import sys

ROW = re.compile(r"^\| `(\w+)` \| ([\w/]+\.h) \|", re.MULTILINE)


def faults(page, modules):
    rows = ROW.findall(page.read_text())
    if len(rows) < 20:
        yield f"{page}: only {len(rows)} functions are named"
    for function, header in rows:
        path = modules / header
        if not path.is_file():
            yield f"{page}: there is no {header}"
        elif not re.search(rf"^[\w:<>&* ]+\b{function}\(", path.read_text(), re.MULTILINE):
            yield f"{page}: {header} declares no {function}()"


if __name__ == "__main__":
    found = list(faults(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
    print("\n".join(found) or "every function stands where the page says")
    sys.exit(bool(found))
