# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the examples in the headers that <petzval/petzval.h> names and in docs/CPP.md into sources that a stranger's compiler must take.

    snippets.py INSTALLED_HEADERS PAGE OUTPUT_FOLDER

An example in a header is a run of comment lines that are indented by five spaces, after an empty one or at the
beginning. Those of headers share one source, each in a function of its own; those of the page that have a main are
programs.
"""

import pathlib
import re
import sys

PREAMBLE = """#include <petzval/petzval.h>

#include <cmath>
#include <iostream>

using namespace petzval;

struct Button { bool pressed() const { return false; } bool closed() const { return false; } };

"""
GIVEN = ("Camera camera, Lens lens, Sensor sensor, SpectralImage light, RawImage raw, Button stop_button, Button window")


def of_header(text):
    blocks, block, before = [], [], ""
    for line in text.splitlines() + [""]:
        stripped = line.strip()
        if stripped.startswith("///     ") and (block or before in ("///", "") or not before.startswith("///")):
            block.append(stripped[8:])
        elif block and stripped == "///":
            block.append("")
        elif block:
            blocks.append("\n".join(block))
            block = []
        before = stripped
    return blocks


def main():
    headers, page, output = map(pathlib.Path, sys.argv[1:4])
    named = re.findall(r"#include <(petzval/.*?)>", (headers / "petzval/petzval.h").read_text())
    found = [(headers / name, block) for name in named for block in of_header((headers / name).read_text())]
    page_blocks = re.findall(r"```cpp\n(.*?)```", page.read_text(), re.DOTALL)
    found += [(page, block) for block in page_blocks if "int main" not in block]
    functions = []
    for i, (path, block) in enumerate(found):
        body = "\n".join(f"    {line}" for line in block.strip().splitlines())
        functions.append(f"// {path.name}\nvoid example_{i}({GIVEN}) {{\n  {{\n{body}\n  }}\n}}\n")
    output.mkdir(parents=True, exist_ok=True)
    (output / "examples.cpp").write_text(PREAMBLE + "\n".join(functions))
    programs = [block for block in page_blocks if "int main" in block]
    for i, block in enumerate(programs):
        (output / f"program_{i}.cpp").write_text(block)
    print(f"{len(found)} examples, {len(programs)} programs")
    return 0 if len(found) >= len(named) * 2 // 3 and programs else 1


sys.exit(main())
