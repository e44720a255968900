# SPDX-License-Identifier: BSD-3-Clause
"""Finds text that has no place in the repository: source files without their licence line, folders of one
machine, temporary files that two processes could share, marks of unfinished work, and types of one name in two
headers. Reads the files that git knows, or, without git, the whole tree."""

import pathlib
import re
import subprocess
import sys

SPDX = "SPDX-License-Identifier: BSD-3-Clause"
SOURCE_SUFFIXES = {".h", ".cpp", ".py", ".cmake", ".sh"}
SKIPPED_FOLDERS = {".git", "build", "demo-pictures", "__pycache__"}
# Written so that this file does not match itself.
FORBIDDEN = [
    (re.compile(r"/(home|Users|roo[t])/\w"), "names a folder of one machine"),
    (re.compile(r"(^|[\s\"'(=:])/wor[k]/"), "names a folder of one machine"),
    (re.compile(r"\b(TOD[O]|FIXM[E]|XX[X]|HAC[K])\b"), "marks unfinished work"),
    (re.compile(r"^\s*#\s*if\s+[0]\s*$"), "switches code off"),
    # Tests run side by side: a fixed name in the shared folder is one that they share. mkstemp() and mkdtemp()
    # take a pattern that ends in six of these letters.
    (re.compile(r"^(?!.*X{6}).*(temp_directory_pat[h]\(|\bTempDi[r]\()"), "names a temporary file that others may name too"),
]


# Types that a header defines, but not within others, and the namespaces that it opens.
DEFINITION = re.compile(r"^(?:struct|class)\s+(?:\w+\(\w+\)\s+)?(\w+)\s*(?:final\s*)?(?::[^:].*)?\{", re.MULTILINE)
NAMESPACE = re.compile(r"^namespace\s+([\w:]+)\s*\{", re.MULTILINE)


def repeated_types(headers):
    """Types that two headers define, given as {path: text}. A linker takes the functions of one for those of the other."""
    seen, faults = {}, []
    for path, text in headers.items():
        namespace = "::".join(NAMESPACE.findall(text))
        for name in DEFINITION.findall(text):
            other = seen.setdefault((namespace, name), path)
            if other != path:
                faults.append(f"{path}: {namespace}::{name} stands in {other} too")
    return faults


def is_source(path, first_line):
    return path.suffix in SOURCE_SUFFIXES or path.name == "CMakeLists.txt" or first_line.startswith("#!")


def text_faults(path, text):
    """Faults of one file, as (line number, sentence)."""
    lines = text.splitlines()
    faults = []
    if is_source(path, lines[0] if lines else "") and not any(SPDX in line for line in lines[:2]):
        faults.append((1, f"a source file begins with '{SPDX}'"))
    for number, line in enumerate(lines, 1):
        for pattern, complaint in FORBIDDEN:
            if pattern.search(line):
                faults.append((number, complaint))
    return faults


def project_files(root):
    """Files that git tracks or would track; every file outside build folders where there is no git."""
    try:
        listing = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                 check=True, capture_output=True).stdout.decode()
        files = [root / name for name in listing.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        files = [path for path in root.rglob("*") if not SKIPPED_FOLDERS & set(path.relative_to(root).parts)]
    return sorted(path for path in files if path.is_file())


def find_faults(root):
    faults, headers = [], {}
    for path in project_files(root):
        try:
            text = path.read_bytes().decode()
        except UnicodeDecodeError:
            continue  # pictures and packed data
        faults += [f"{path.relative_to(root)}:{number}: {complaint}" for number, complaint in text_faults(path, text)]
        if path.suffix == ".h":
            headers[path.relative_to(root)] = text
    return faults + repeated_types(headers)


def main():
    faults = find_faults(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(faults) or "every file keeps the rules")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
