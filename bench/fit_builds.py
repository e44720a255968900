#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lenses built by known amounts, found again from noisy pictures: for each of twenty builds a triplet with its sensor out of focus and
tilted and its middle element set aside, a board of slanted squares through it, exposed on a sensor with noise, measured by `petzval sfr` and given
to `petzval lens fit-build`. Prints every number with its truth, and the pulls: error over stated deviation, whose mean should be 0 and
whose standard deviation 1. A build takes about a minute of CPU. `bench/fit_builds.py build/release/bin/petzval [--builds 20] [--photographs 1] [--json]`"""

import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np

SCALE, ELEMENT = 0.2, (2, 3)
COLUMNS, ROWS, PITCH_UM, SENSOR = 800, 640, 3.45, "icx625-mono"
NM, BOARD = 550, "slanted-board:11"
# Of a good lens: standard deviations of what is off [mm, deg, deg, mm, mm].
SPREAD = {"defocus_mm": 0.012, "sensor_tilt_deg x": 0.35, "sensor_tilt_deg y": 0.35, "element_decentre_mm@2-3 x": 0.010,
          "element_decentre_mm@2-3 y": 0.010}
SHIFTS_MM = [0.0, 0.015, -0.015]


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.run("lens", "scale", "cooke-triplet", "--factor", SCALE, "-o", "lens.json")

    def run(self, *words):
        return subprocess.run([self.program, *map(str, words)], cwd=self.folder, check=True, stdout=subprocess.PIPE, text=True).stdout

    def photograph(self, truth, shift_mm, seed):
        lens = json.loads((self.folder / "lens.json").read_text())
        lens["surfaces"][-1]["thickness_mm"] += truth["defocus_mm"] + shift_mm
        lens["sensor_pose"] = {"tilt_x_deg": truth["sensor_tilt_deg x"], "tilt_y_deg": truth["sensor_tilt_deg y"]}
        lens["groups"] = [{"surfaces": list(ELEMENT), "pose": {
            "decentre_x_mm": truth["element_decentre_mm@2-3 x"], "decentre_y_mm": truth["element_decentre_mm@2-3 y"]}}]
        (self.folder / "built.json").write_text(json.dumps(lens))
        sensor = ["--sensor", SENSOR, "--sensor-set", f"columns={COLUMNS}", "--sensor-set", f"rows={ROWS}"]
        self.run("image", BOARD, "--lens", "built.json", "--focus", "design", "--wavelengths", NM, *sensor, "--surround", "extend", "--quiet", "-o", "light.exr")
        self.run("sense", "light.exr", *sensor, "--seed", seed, "--quiet", "-o", "raw.dng")
        name = f"map{seed}.json"
        (self.folder / name).write_text(self.run("sfr", "raw.dng", "--json", "--quiet"))
        return name

    def fit(self, maps, shifts):
        words = [word for name in maps for word in ("--sfr", name)]
        if len(maps) > 1:
            words += ["--focus-shifts", ",".join(map(str, shifts))]
        return json.loads(self.run("lens", "fit-build", "lens.json", *words, "--pixel-pitch", PITCH_UM, "--wavelengths", NM,
                                   "--free", "defocus_mm", "--free", "sensor_tilt_deg", "--free", "element_decentre_mm@2-3",
                                   "--json", "--quiet", "-o", "as-built.json"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--builds", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--photographs", type=int, default=1, choices=(1, 2, 3))
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--folder")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(program, options.folder or folder)
        for number in range(options.first, options.first + options.builds):
            draw = random.Random(number)
            truth = {name: draw.gauss(0, spread) for name, spread in SPREAD.items()}
            shifts = SHIFTS_MM[: options.photographs]
            maps = [bench.photograph(truth, shift, 100 * number + k + 1) for k, shift in enumerate(shifts)]
            fitted = bench.fit(maps, shifts)
            found = {row["number"]: row for row in fitted["rows"]}
            row = {"build": number, "edges": len(fitted["edges"]), "chi2_over_freedom": fitted["chi_squared"] / fitted["freedom"],
                   "others": len(fitted["others"]), "remarks": fitted["remarks"],
                   "numbers": {name: {"truth": truth[name], "value": found[name]["value"], "deviation": found[name]["deviation"],
                                      "pull": (found[name]["value"] - truth[name]) / found[name]["deviation"]} for name in SPREAD}}
            rows.append(row)
            if not options.json:
                print(f"build {number}: {row['edges']} edges, chi2/freedom {row['chi2_over_freedom']:.2f}, {row['others']} other builds")
                for name, each in row["numbers"].items():
                    print(f"  {name:<28} {each['truth']:+9.5f}  found {each['value']:+9.5f} +- {each['deviation']:.5f}  pull "
                          f"{each['pull']:+6.2f}", flush=True)
    pulls = np.array([[each["pull"] for each in row["numbers"].values()] for row in rows])
    summary = {name: {"mean_pull": float(pulls[:, k].mean()), "rms_pull": float(np.sqrt((pulls[:, k] ** 2).mean())),
                      "largest_pull": float(np.abs(pulls[:, k]).max()),
                      "median_deviation": float(np.median([row["numbers"][name]["deviation"] for row in rows]))}
               for k, name in enumerate(SPREAD)}
    if options.json:
        json.dump({"builds": rows, "summary": summary}, sys.stdout, indent=1)
        return
    print(f"\n{len(rows)} builds, {options.photographs} photograph(s) each: {np.sum(np.abs(pulls) < 1)} of {pulls.size} numbers within one "
          f"deviation, {np.sum(np.abs(pulls) < 2)} within two, {np.sum(np.abs(pulls) < 3)} within three")
    for name, each in summary.items():
        print(f"  {name:<28} mean pull {each['mean_pull']:+.2f}, rms {each['rms_pull']:.2f}, largest {each['largest_pull']:.2f}; "
              f"deviation {each['median_deviation']:.5f}")


if __name__ == "__main__":
    main()
