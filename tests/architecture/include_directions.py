# SPDX-License-Identifier: BSD-3-Clause
"""Finds includes that run against the floors of the modules.

A file in src/petzval/<module> may include headers of its own module and of modules on lower floors
(src/petzval/floors.txt). The modules that it and the files in tests/<module> include must be those that
src/petzval/CMakeLists.txt names after USES, for the module's tests are linked with these alone.

    include_directions.py MODULES_FOLDER TESTS_FOLDER
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
MODULE_LINE = re.compile(r"petzval_module\(\s*(\w+)([^)]*)\)")
SOURCE_SUFFIXES = {".h", ".cpp"}


def read_floors(path):
    """{module: floor} from lines "module floor"; '#' begins a comment."""
    floors = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if len(words) != 2 or not words[1].isdigit() or words[0] in floors:
            raise ValueError(f"{path}:{number}: give each module once, as 'module floor'")
        floors[words[0]] = int(words[1])
    return floors


def read_uses(path):
    """{module: set of modules after USES} from the petzval_module() lines of a CMakeLists.txt."""
    uses = {}
    for name, arguments in MODULE_LINE.findall(path.read_text()):
        after = re.search(r"\bUSES\b(.*?)(?:\bLIBRARIES\b|$)", arguments, re.DOTALL)
        uses[name] = set(after.group(1).split()) if after else set()
    return uses


def included_modules(path):
    """(line number, module) of each include of a Petzval header, and (line number, None) of those whose
    form hides the module: quoted, with a folder in it."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, header = match.groups()
        parts = header.split("/")
        if parts[0] == "petzval":
            yield number, parts[1]
        elif bracket == '"' and len(parts) > 1:
            yield number, None


def floor_faults(what, module, lower, floors):
    """Why `module` may not use `lower`, as a list of none or one sentence."""
    if lower not in floors:
        return [f"{what}: module {lower} has no floor in floors.txt"]
    if lower != module and floors[lower] >= floors[module]:
        return [f"{what}: {module} (floor {floors[module]}) may not use {lower} (floor {floors[lower]})"]
    return []


def source_files(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in SOURCE_SUFFIXES)


def find_faults(modules_folder, tests_folder):
    """All faults of folders like src/petzval and tests, one sentence each."""
    floors = read_floors(modules_folder / "floors.txt")
    uses = read_uses(modules_folder / "CMakeLists.txt")
    faults = []
    for module, lowers in uses.items():
        if module not in floors:
            faults.append(f"CMakeLists.txt: module {module} has no floor in floors.txt")
            continue
        for lower in sorted(lowers):
            faults += floor_faults("CMakeLists.txt", module, lower, floors)
    for folder in sorted(path for path in modules_folder.iterdir() if path.is_dir()):
        faults += module_faults(folder, tests_folder / folder.name, floors, uses)
    return faults


def module_faults(folder, tests, floors, uses):
    """Faults of one module's files, in its folder and that of its tests."""
    module = folder.name
    sources = source_files(folder)
    if not sources:
        return []
    if module not in floors or module not in uses:
        return [f"{module}: needs a line in floors.txt and one in CMakeLists.txt"]
    faults = []
    used = set()
    for path in sources + source_files(tests):
        is_test = path.is_relative_to(tests)
        for number, lower in included_modules(path):
            what = f"{path.relative_to(tests.parent if is_test else folder.parent)}:{number}"
            if lower is None:
                if not is_test:  # tests/ is an include folder of the tests
                    faults.append(f"{what}: include other folders as <petzval/module/header.h>")
                continue
            used.add(lower)
            faults += floor_faults(what, module, lower, floors)
    used.discard(module)
    for lower in sorted(used - uses[module]):
        faults.append(f"CMakeLists.txt: {module} includes headers of {lower}, which its USES does not name")
    for lower in sorted(uses[module] - used):
        faults.append(f"CMakeLists.txt: {module} USES {lower}, but includes none of its headers")
    return faults


def main():
    faults = find_faults(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
    print("\n".join(faults) or "every include runs downwards")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
