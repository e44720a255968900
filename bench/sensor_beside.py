#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the sensor's commands cost in CPU time, beside OpenCV, LibRaw and OpenEXR, in one run.

    pip install numpy opencv-python-headless rawpy OpenEXR tifffile scikit-image pooch scipy colour-demosaicing
    bench/sensor_beside.py build/release/bin/petzval            # needs 2 GB in the folder for temporary files

CPU seconds (user and system) of the quickest of some rounds, which take turns, so that another program on the machine
disturbs all alike. Quality beside the same programs: demosaic_beside.py, denoise_beside.py.
"""
import argparse
import os
import resource
import subprocess
import tempfile

import cv2
import numpy as np
import OpenEXR
import rawpy
from demosaic_beside import photograph, sampled, write_dng

ROUNDS = 5


def cpu_s(work):
    def used():
        both = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(usage.ru_utime + usage.ru_stime for usage in both)

    start = used()
    work()
    return used() - start


def print_rows(title, rows, rounds=ROUNDS):
    """rows: name and work."""
    times = [[cpu_s(work) for _, work in rows] for _ in range(rounds)]
    print(title)
    for (name, _), least in zip(rows, np.min(times, axis=0)):
        print(f"  {name:58s}{least:7.2f}", flush=True)


def libraw(path, method):
    with rawpy.imread(path) as raw:
        return raw.postprocess(demosaic_algorithm=getattr(rawpy.DemosaicAlgorithm, method), use_camera_wb=True,
                               no_auto_bright=True)


def opencv(path):
    """The quickest that OpenCV has: bilinear, without colours or a curve of display."""
    with rawpy.imread(path) as raw:
        cv2.imwrite(path + ".cv2.tif", cv2.demosaicing(raw.raw_image, cv2.COLOR_BayerRGGB2BGR))


def development(petzval):
    coffee = photograph("coffee")
    noise = np.random.default_rng(1).normal(0, 0.01, (3040, 4056))
    write_dng("big.dng", np.clip(sampled(np.tile(coffee, (8, 7, 1))[:3040, :4056]) + noise, 0, 1))

    def develop(output, *words):
        return lambda: petzval("develop", "big.dng", "-o", output, *words)

    print_rows("a raw file of 12 megapixels", [
        ("petzval develop -o a.tif", develop("a.tif")),
        ("petzval develop -o a.tif --demosaic malvar", develop("a.tif", "--demosaic", "malvar")),
        ("LibRaw PPG, into memory", lambda: libraw("big.dng", "PPG")),
        ("LibRaw AHD, into memory", lambda: libraw("big.dng", "AHD")),
        ("LibRaw AAHD, into memory", lambda: libraw("big.dng", "AAHD")),
        ("LibRaw DHT, into memory", lambda: libraw("big.dng", "DHT")),
        ("OpenCV bilinear, to .tif, no colours", lambda: opencv("big.dng"))])
    develop("a.png")()
    picture = cv2.imread("a.png", cv2.IMREAD_UNCHANGED)
    print_rows("its picture as .png", [
        ("petzval develop -o a.png (development and writing)", develop("a.png")),
        ("petzval develop -o a.tif (development)", develop("a.tif")),
        ("cv2.imwrite of the same picture (writing)", lambda: cv2.imwrite("b.png", picture))])
    print(f"  bytes: petzval {os.path.getsize('a.png')}, cv2 {os.path.getsize('b.png')}")


def sensing(petzval):
    """Light of 12 megapixels in 25 bands."""
    petzval("image", "studio", "--lens", "edmund-54852", "--sensor", "4096x3072@1.1", "--method", "none", "--wavelengths",
            "400:12.5:700", "-o", "light.exr")

    def read():
        with OpenEXR.File("light.exr", separate_channels=True) as light:
            return len(light.channels())

    print_rows(f"light of {os.path.getsize('light.exr') / 1e9:.2f} GB", [
        ("petzval sense light.exr -o raw.dng",
         lambda: petzval("sense", "light.exr", "--sensor", "raspberry-pi-hq", "--sensor-set", "columns=4096", "--sensor-set", "pitch_um=1.1",
                         "--sensor-set", "rows=3072", "--illuminant", "D65", "-o", "raw.dng")),
        ("OpenEXR, reading alone", read)], rounds=3)
    os.remove("light.exr")


def wall(petzval):
    words = ("image", "wall", "--lens", "edmund-54852", "--sensor", "third-inch-1280x960", "--method", "none")
    print_rows("a wall of 1.2 megapixels in 31 bands", [
        ("petzval image wall --method none -o x.dng", lambda: petzval(*words, "-o", "x.dng"))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="petzval")
    program = os.path.abspath(parser.parse_args().program)

    def petzval(*words):
        subprocess.run([program, *words, "--quiet"], check=True, stdout=subprocess.DEVNULL)

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for part in (development, wall, sensing):
            part(petzval)
        os.chdir("/")


if __name__ == "__main__":
    main()
