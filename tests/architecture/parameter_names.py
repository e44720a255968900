# SPDX-License-Identifier: BSD-3-Clause
"""Checks the names in the library's texts.

No string literal of the library names an option or a command of the program, and every `parameter` that one names in
backquotes is an option of some command, by the table and the rule of apps/petzval/option_names.cpp.

    parameter_names.py PROGRAM SOURCE_FOLDER OPTION_NAMES_CPP
"""

import pathlib
import re
import subprocess
import sys

LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
NAME = re.compile(r"`([a-z][a-z0-9_.]*)`")
# What a text may say with two dashes: a property of a style sheet.
ALLOWED = {"--at"}


def literals(folder):
    for path in sorted(folder.rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if line.lstrip().startswith("//"):
                continue
            for text in LITERAL.findall(line):
                yield f"{path.relative_to(folder)}:{number}", text


def option_of(parameter, table, units):
    if parameter in table:
        return table[parameter]
    for unit in units:
        if parameter.endswith(unit):
            parameter = parameter[:-len(unit)]
            break
    return "--" + re.sub(r"[_.]", "-", parameter)


def names_of_program(source):
    text = source.read_text()
    table = dict(re.findall(r'\{"([\w.]+)", "(--[\w-]+)"\}', text))
    units = re.findall(r'"(_\w+)"', text)
    return table, units


def options(program, words=()):
    """Options of a command and of those below it."""
    text = subprocess.run([program, *words, "--help-all"], capture_output=True, text=True, check=True).stdout
    found = set(re.findall(r"--[a-z][a-z0-9-]+", text.split("Example:")[0]))
    below = text.partition("Subcommands:")[2]
    for command in re.findall(r"^  ([a-z][a-z-]*) ", below, re.MULTILINE):
        found |= options(program, (*words, command))
    return found


def faults(program, folder, source):
    table, units = names_of_program(source)
    known = options(program)
    if len(known) < 100 or not table or not units:
        yield f"only {len(known)} options, {len(table)} names and {len(units)} units were found"
    named = 0
    for place, text in literals(folder):
        for option in OPTION.findall(text):
            if option not in ALLOWED:
                yield f"{place}: names the option {option}; a parameter in backquotes would be right"
        for parameter in NAME.findall(text):
            named += 1
            option = option_of(parameter, table, units)
            if option not in known:
                yield f"{place}: `{parameter}` would be the option {option}, which no command has"
    if named < 50:
        yield f"only {named} parameters are named"


if __name__ == "__main__":
    found = list(faults(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])))
    print("\n".join(found) or "every parameter has its option")
    sys.exit(bool(found))
