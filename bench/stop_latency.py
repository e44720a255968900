#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How soon Ctrl-C ends commands, and what it leaves behind.

    python3 bench/stop_latency.py build/release/bin/petzval [--seed 1] [--only render]

Each command of the list runs in an empty folder and gets SIGINT after a random time of up to six seconds. A row tells when,
how long it took to end, its exit code, and the files that it left. A command that says "nothing was written" must leave none;
then, and after an end other than 0 and 130, the script ends with 1. Commands that end by themselves before are named."""

import argparse
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

COMMANDS = """
image studio --lens m12-4.5mm --sensor third-inch-1280x960 -o a.png
image studio --lens dgauss-50mm --sensor full-frame-24mp -o a.exr
image studio --lens dgauss-50mm --sensor full-frame-24mp -o a.dng
image studio --lens dgauss-50mm --sensor full-frame-24mp --ghosts --scatter roughness=5 --wavelengths 550 -o a.png
image slanted-edge --lens fisheye-10mm -o a.png
render spheres --lens dgauss-50mm --spp 256 -o a.exr
render lamps --lens wide-22mm --spp 256 --sensor full-frame-24mp -o a.dng
render fog --spp 256 --denoise-light -o a.png
focus spheres --lens dgauss-50mm
optics build dgauss-50mm -o a.h5
optics build m12-4.5mm --sensor third-inch-1280x960 -o a.h5
lens optimise double-gauss --glasses 5 -o a.json
lens tolerance cooke-triplet --builds 500
lens transfer dgauss-50mm -o a.json
lens report fisheye-10mm -o a.html
lens glare fisheye-10mm
lens vignetting fisheye-10mm --plot a.svg
target --chart siemens --size 6000x4000 -o a.png
target --chart text --size 4000x3000 --psf wavefront --w020 0.5 -o a.tif
target --rectangle 3000x2000@5 --size 6000x4000 --sensor full-frame-24mp -o a.dng
sweep image studio --lens dgauss-50mm --vary f-number=2:2:16 -o out
measure sensor full-frame-24mp
demo -o out
"""


def stopped(program, words, after_s):
    """Exit code, what it said, the files that it left, and how long it took from the signal; nothing if it ended before."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.Popen([program, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            said = run.communicate(timeout=after_s)[1]
            return run.returncode, said, [], None
        except subprocess.TimeoutExpired:
            pass
        began = time.monotonic()
        run.send_signal(signal.SIGINT)
        said = run.communicate()[1]
        taken = time.monotonic() - began
        left = sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*") if path.is_file())
        return run.returncode, said, left, taken


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="commands that begin with this")
    options = parser.parse_args()
    moments, wrong = random.Random(options.seed), 0
    print(f"{'after s':>8}{'ended ms':>10}{'code':>6}  command and what it left")
    for command in COMMANDS.strip().splitlines():
        after_s = moments.choice([0.3, 0.7, 1.5, 3, 5]) * moments.uniform(0.8, 1.2)
        if not command.startswith(options.only):
            continue
        code, said, left, taken = stopped(options.program.resolve(), command.split(), after_s)
        if code not in (0, 130) or (left and "nothing was written" in said):
            wrong += 1
        row = "   before" if taken is None else f"{1e3 * taken:9.0f}"
        print(f"{after_s:8.1f} {row}{code:6}  {command}  {' '.join(left[:3])}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
