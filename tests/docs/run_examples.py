# SPDX-License-Identifier: BSD-3-Clause
"""Runs the examples of a document and compares what they print with what the document says.

An example is a fenced block marked `console`. A line that begins with "$ " is a command (a backslash at its end
continues it); the lines up to the next command are all that it prints, on stdout and stderr. A line "..." stands
for any number of lines, "..." inside a line for any text within that line. A command must succeed, unless the
document shows it failing with "petzval: error:". The commands of a document run in one folder, in order.

A block whose mark is followed by a file's name (```cpp main.cpp) is a file of that folder, there before the first command.

    run_examples.py PROGRAM DOCUMENT...
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass

BLOCK = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"^```[a-z]+ ([\w-][\w.-]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass
class Example:
    line: int  # of the command in the document, counted from 1
    command: str
    expected: list  # lines


def find_examples(text):
    """The examples of a document, in order."""
    examples = []
    for block in BLOCK.finditer(text):
        first_line = text.count("\n", 0, block.start(1)) + 1
        continued = False
        for line_number, line in enumerate(block.group(1).splitlines(), first_line):
            if continued:
                examples[-1].command += line.strip()
            elif line.startswith("$ "):
                examples.append(Example(line_number, line[2:], []))
            elif not examples or examples[-1].line < first_line:
                raise ValueError(f"line {line_number}: a console block begins with a command, '$ …'")
            else:
                examples[-1].expected.append(line)
                continue
            continued = examples[-1].command.endswith("\\")
            if continued:
                examples[-1].command = examples[-1].command[:-1].rstrip() + " "
    return examples


def matches(expected, printed):
    """Whether the printed lines are the expected ones."""
    pattern = ""
    for line in expected:
        if line.strip() == "...":
            pattern += r"(?:[^\n]*\n)*?"
        else:
            pattern += r"[^\n]*?".join(re.escape(part) for part in line.rstrip().split("...")) + r"\n"
    return re.fullmatch(pattern, "".join(line.rstrip() + "\n" for line in printed)) is not None


def run(example, folder, program):
    """Why the example fails, or None."""
    # The program, and the Python that has the packages of the tests.
    folders = [str(pathlib.Path(program).resolve().parent), str(pathlib.Path(sys.executable).parent), os.environ["PATH"]]
    environment = dict(os.environ, PATH=":".join(folders))
    done = subprocess.run(["bash", "-c", example.command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    # On a busy machine work takes longer, and tells of it every ten seconds.
    done.stdout = re.sub(r"^petzval: +\d+ % .*\n", "", done.stdout, flags=re.MULTILINE)
    shown_failing = any(line.startswith("petzval: error:") for line in example.expected)
    if (done.returncode != 0) != shown_failing:
        return f"ended with {done.returncode}:\n{done.stdout}"
    if not matches(example.expected, done.stdout.splitlines()):
        return "prints\n" + done.stdout + "but the document says\n" + "".join(f"{line}\n" for line in example.expected)
    return None


def run_document(path, program):
    """Runs all examples of a document; a list of complaints."""
    complaints = []
    with tempfile.TemporaryDirectory() as folder:
        for name, content in FILE.findall(path.read_text()):
            (pathlib.Path(folder) / name).write_text(content)
        for example in find_examples(path.read_text()):
            complaint = run(example, folder, program)
            if complaint:
                complaints.append(f"{path.name}:{example.line}: $ {example.command}\n{complaint}")
    return complaints


def main():
    program, documents = sys.argv[1], sys.argv[2:]
    complaints = [each for document in documents for each in run_document(pathlib.Path(document), program)]
    print("\n".join(complaints) or "every example prints what it says")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
