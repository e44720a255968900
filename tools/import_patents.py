#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes data/lenses/patents from prescriptions that others have typed from patents.

    tools/import_patents.py --lens-library FOLDER --optical-bench FOLDER --program build/release/bin/petzval

The folders are clones of github.com/nzhagen/LensLibrary (MIT) and of a collection of files in the format of the
Optical Bench of photonstophotos.net, such as github.com/BeamFour/Beam42. Prescriptions are facts of the patents.
"""

import argparse
import json
import pathlib
import subprocess

# Name, file, what it is, patent.
LENS_LIBRARY = [
    ("us-528155", "528155", "Symmetrical anastigmat of two cemented triplets, 240 mm f/8", "528,155 (Goerz 1894)"),
    ("us-895045-a", "895045a", "Wide-angle anastigmat, 93 mm f/12.5", "895,045 (Rudolph 1908)"),
    ("us-1792917", "1792917", "Anastigmat, 100 mm f/4.5", "1,792,917 (Merte 1931)"),
    ("us-1843519", "1843519", "Portrait objective of four elements, 100 mm f/2.2", "1,843,519 (Richter 1932)"),
    ("us-1975678", "1975678", "Fast triplet of cemented groups, 93 mm f/1.5", "1,975,678 (Bertele 1934)"),
    ("us-1998704-a", "1998704a", "Fast portrait objective, 100 mm f/2", "1,998,704 (Bertele 1935)"),
    ("us-1998704-b", "1998704b", "Portrait objective, 100 mm f/2.8", "1,998,704 (Bertele 1935)"),
    ("us-2031792-a", "2031792a", "Wide-angle lens of four deep menisci, 66 mm f/12.5", "2,031,792 (Richter 1936)"),
    ("us-2031792-b", "2031792b", "Wide-angle lens of four deep menisci, 79 mm f/12.5", "2,031,792 (Richter 1936)"),
    ("us-2076190", "2076190", "Projection objective, 101 mm f/1.6", "2,076,190 (Wood 1937)"),
    ("us-2117252", "2117252a", "Wide-angle double Gauss, 101 mm f/6", "2,117,252 (Lee 1938)"),
    ("us-2453260", "2453260", "Triplet, 100 mm f/2.7", "2,453,260 (Pestrekov 1948)"),
    ("us-2645156", "2645156", "Asymmetrical double Gauss of five elements, 100 mm f/3.5", "2,645,156 (Tronnier 1953)"),
    ("us-6744570-b", "6744570b", "Four-element lens for a telephone, 7.2 mm f/4", "6,744,570 (Isono 2004)"),
    ("us-6744570-c", "6744570c", "Four-element lens for a telephone, 7.2 mm f/4", "6,744,570 (Isono 2004)"),
    ("us-7558005-a", "7558005a", "Four-element lens for a telephone, 4.55 mm f/3", "7,558,005 (Yasuhiko 2009)"),
    ("us-7558005-b", "7558005b", "Four-element lens for a telephone, 4.55 mm f/3", "7,558,005 (Yasuhiko 2009)"),
    ("us-7558005-c", "7558005c", "Four-element lens for a telephone, 4.58 mm f/3", "7,558,005 (Yasuhiko 2009)"),
    ("us-10281683", "10281683", "Six-element lens for a telephone, 4.7 mm f/1.7", "10,281,683 (Yao 2019)"),
    ("us-7821720-a", "7821720a", "Wide-angle objective for an endoscope, 0.96 mm, 170 degrees", "7,821,720 (Wang 2010)"),
    ("us-7821720-b", "7821720b", "Wide-angle objective for an endoscope, 0.96 mm, 170 degrees", "7,821,720 (Wang 2010)"),
    ("us-7821720-c", "7821720c", "Wide-angle objective for an endoscope, 1.28 mm, 150 degrees", "7,821,720 (Wang 2010)"),
    ("us-5852515-a", "5852515a", "Objective of a stereo microscope, 300 mm", "5,852,515 (Kurata 1998)"),
    ("us-5852515-b", "5852515b", "Objective of a stereo microscope, 300 mm", "5,852,515 (Kurata 1998)"),
    ("us-5852515-c", "5852515c", "Objective of a stereo microscope, 200 mm", "5,852,515 (Kurata 1998)"),
]

OPTICAL_BENCH = [
    ("us-2701982", "US002701982_Example01", "Very fast double Gauss", "2,701,982, example 1"),
    ("us-3459468", "US003459468_Example01O", "Fast double Gauss with two aspheres", "3,459,468, example 1"),
    ("us-4234242", "US004234242_Example03_Tale60", "Double Gauss", "4,234,242, example 3"),
    ("us-4364643", "US004364643_Example01", "Fast double Gauss", "4,364,643, example 1"),
    ("us-4448497", "US004448497_Example01", "Fast double Gauss of seven elements", "4,448,497, example 1"),
    ("us-4514052", "US004514052_Example01", "Fast double Gauss with an asphere", "4,514,052, example 1"),
    ("us-4621909", "US004621909_Example03", "Fast double Gauss of seven elements", "4,621,909, example 3"),
    ("us-4717245", "US004717245_Example01", "Very fast normal lens with two aspheres", "4,717,245, example 1"),
    ("us-5751485", "nikkor-200mm-micro", "Telephoto lens for close objects", "5,751,485, example 9"),
    ("us-2007-0236805", "US20070236805_Example01", "Fast lens for cinematography", "2007/0236805, example 1"),
    ("us-2011-0115963", "US20110115963_Example01", "Fast normal lens", "2011/0115963, example 1"),
    ("us-2015-0092100", "US20150092100_Example01", "Fast normal lens with inner focusing", "2015/0092100, example 1"),
    ("us-2020-0341250", "US20200341250_Example01", "Fast lens for cinematography", "2020/0341250, example 1"),
    ("us-2828671", "US002828671_Example01", "Very fast normal lens", "2,828,671, example 1"),
    ("us-3552829", "US003552829_Example01", "Fast double Gauss", "3,552,829, example 1"),
    ("us-3560079", "US003560079_Example01", "Fast double Gauss", "3,560,079, example 1"),
    ("us-3738736", "US003738736_Example03", "Fast double Gauss of seven elements", "3,738,736, example 3"),
    ("us-3874771", "US003874771_Example05", "Fast double Gauss", "3,874,771, example 5"),
    ("us-4514051", "US004514051_ExampleML02P", "Flat double Gauss", "4,514,051, example ML 2"),
    ("us-2007-0236805-3", "US20070236805_Example03", "Fast lens for cinematography", "2007/0236805, example 3"),
    ("us-2007-0236805-4", "US20070236805_Example04", "Fast lens for cinematography", "2007/0236805, example 4"),
    ("us-2019-0250367", "US20190250367_Example01P", "Fast normal lens", "2019/0250367, example 1"),
    ("wo-2017-138250", "WO2017-138250_Example02", "Fast normal lens", "WO 2017/138250, example 2"),
    ("wo-2019-220618", "WO2019-220618_Example09P", "Fast normal lens", "WO 2019/220618, example 9"),
    ("wo-2020-170591", "WO2020-170591_Example09", "Wide-angle zoom lens", "WO 2020/170591, example 9"),
    ("wo-2024-147268", "WO2024-147268_Example01P", "Fast portrait lens", "WO 2024/147268, example 1"),
    ("jp-2019-008031", "JP2019-008031_Example01P", "Wide-angle zoom lens", "JP 2019-008031, example 1"),
    ("jp-2020-012952", "JP2020-012952_Example01", "Fast wide-angle lens", "JP 2020-012952, example 1"),
]


def found(folder, stem):
    """The file of that name, whatever its ending and wherever it stands."""
    for path in sorted(folder.rglob(stem + ".*")):
        if path.suffix.lower() == ".zmx" and "zemax_files" in path.parts:
            return path
        if path.suffix == ".txt" and "[lens data]" in path.read_text(errors="replace"):
            return path
    raise SystemExit(f"{stem} is not below {folder}")


def converted(program, path, output, name, source, options):
    settings = [f"name={json.dumps(name)}", f"source={json.dumps(source)}"]
    command = [program, "lens", "convert", str(path), str(output), "--quiet", *options]
    for setting in settings:
        command += ["--set", setting]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(f"{path.name}: {run.stderr.strip()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lens-library", type=pathlib.Path, required=True)
    parser.add_argument("--optical-bench", type=pathlib.Path, required=True)
    parser.add_argument("--program", default="petzval")
    parser.add_argument("--output", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent / "data" / "lenses" / "patents")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    for name, stem, what, patent in LENS_LIBRARY:
        converted(arguments.program, found(arguments.lens_library, stem), arguments.output / f"{name}.json",
                  f"{what}, US patent {patent.split(' (')[0]}", f"US patent {patent}, by way of LensLibrary (MIT)",
                  ["--apertures", "from-fields"])
    for name, stem, what, number in OPTICAL_BENCH:
        patent = number if number[0].isalpha() else f"US {number}"
        path = found(arguments.optical_bench, stem)
        run = subprocess.run([arguments.program, "lens", "info", str(path), "--json"], capture_output=True, text=True)
        data = json.loads(run.stdout)
        converted(arguments.program, path, arguments.output / f"{name}.json",
                  f"{what}, {data['efl_mm']:.0f} mm f/{data['f_number']:.2g}, patent {patent}",
                  f"patent {patent}, clear apertures from its drawing, by way of the Optical Bench", [])


if __name__ == "__main__":
    main()
