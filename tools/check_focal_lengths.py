#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads every lens file of a folder and compares its focal length with the one that the file states.

For files of the Optical Bench (.txt), of FlareSim (.lens) and of LensLibrary (.zmx beside lens_properties_list.txt):

    tools/check_focal_lengths.py FOLDER --program build/release/bin/petzval

With --optiland (pip install optiland) every .zmx that both programs read is also compared with that ray tracer.
"""

import argparse
import collections
import json
import pathlib
import re
import statistics
import subprocess


def stated_mm(path, text, properties):
    """The focal length that a file or the list beside it states; None where there is none."""
    if path.suffix.lower() == ".zmx":
        return properties.get(path.stem)
    found = re.search(r"^(?:focal_length:|Focal Length)\s+(\S+)", text, re.MULTILINE)
    try:
        return float(found.group(1)) if found else None
    except ValueError:
        return None


def listed(folder):
    """File name to focal length, from the columns of LensLibrary's list."""
    values = {}
    for each in folder.rglob("lens_properties_list.txt"):
        for line in each.read_text(errors="replace").splitlines():
            words = line.split()
            if len(words) >= 3 and re.fullmatch(r"-?[\d.,]+", words[2]):
                values[words[0]] = float(words[2].replace(",", ""))
    return values


def optiland_mm(path):
    """The focal length by Optiland; text that says why not."""
    try:
        from optiland.fileio import load_zemax_file
        return float(load_zemax_file(str(path)).paraxial.f2()), ""
    except ImportError:
        raise
    except BaseException as error:  # whatever another program fails with is its answer
        return None, f"{type(error).__name__}: {error}".splitlines()[0][:70]


def tell_beside(beside):
    """Counts and disagreements of (name, ours, theirs, why theirs is none)."""
    both = [(abs(ours / theirs - 1), name, ours, theirs) for name, ours, theirs, _ in beside if theirs]
    print(f"Optiland reads {len(both)} of these {len(beside)} .zmx; "
          f"{sum(each[0] < 1e-4 for each in both)} focal lengths agree to 1e-4:")
    for off, name, ours, theirs in sorted(both, reverse=True):
        if off >= 1e-4:
            print(f"  {100 * off:8.2f} %  Petzval {ours:.6g} mm, Optiland {theirs:.6g} mm  {name}")
    for why, count in collections.Counter(each[3] for each in beside if each[3]).most_common():
        print(f"  {count:4}  {why}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="petzval")
    parser.add_argument("--worst", type=int, default=10, help="so many of the worst are listed")
    parser.add_argument("--optiland", action="store_true", help="compare .zmx with Optiland too")
    arguments = parser.parse_args()
    properties = listed(arguments.folder)
    refused, off, beside, read = collections.Counter(), [], [], 0
    for path in sorted(arguments.folder.rglob("*")):
        text = path.read_text(errors="replace") if path.is_file() else ""
        bench = path.suffix == ".txt" and "[lens data]" in text
        if not (bench or path.suffix.lower() in (".lens", ".zmx")):
            continue
        run = subprocess.run([arguments.program, "lens", "info", str(path), "--json"], capture_output=True, text=True)
        if run.returncode != 0:
            last = run.stderr.strip().splitlines()[-1]
            refused[f"exit {run.returncode}: " + last.split(path.name, 1)[-1].lstrip(":0123456789 ")[:90]] += 1
            continue
        read += 1
        stated, found = stated_mm(path, text, properties), json.loads(run.stdout)["efl_mm"]
        if arguments.optiland and found and path.suffix.lower() == ".zmx":
            beside.append((path.name, found, *optiland_mm(path)))
        if stated and found:
            off.append((abs(abs(found) / abs(stated) - 1), path.name, stated, found))
    print(f"{read} files read, {sum(refused.values())} refused")
    for reason, count in refused.most_common():
        print(f"  {count:4}  {reason}")
    if beside:
        tell_beside(beside)
    if off:
        off.sort()
        print(f"focal lengths of {len(off)}: off by {100 * statistics.median(each[0] for each in off):.3g} % (median); "
              f"{sum(each[0] < 0.01 for each in off)} within 1 %; the worst:")
        for error, name, stated, found in reversed(off[-arguments.worst:]):
            print(f"  {100 * error:8.2f} %  stated {stated:g} mm, found {found:.6g} mm  {name}")


if __name__ == "__main__":
    main()
