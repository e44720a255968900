#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A telephone's camera known only by its ray transfer, against its design, its measurements and its published simulation.

    examples/telephone_2022.py FOLDER [PETZVAL] [--page DIR]

FOLDER holds the files of Lyu, Goossens, Wandell and Farrell, "Accurate smartphone camera simulation using 3D scenes"
(2022), from their repository isetcornellbox, and their Cornell box from iset3d-v3; they are not part of Petzval:
pixel4a-rearcamera-ellipse-raytransfer.json, RI.txt, GeometricMTF.txt, GeometricLSP.txt, sensor_qe.csv, box_spectra.csv,
measured_radiances.csv, CornellBoxReference_geometry.pbrt. Prints every comparison as numbers. With --page DIR, it also
exposes the sensor (gain, noise, a colour chart under three lights), renders the box (interreflection) and writes
DIR/index.html with all curves. Measured numbers are facts, read off the published figures 5 and 7 to about 0.005.
"""
import argparse
from pathlib import Path

from telephone import box as boxes
from telephone import lens, sensor
from telephone.page import NoPage, Page


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("petzval", nargs="?", default="petzval")
    parser.add_argument("--page", type=Path, help="folder for a page with all curves, the sensor and the box")
    options = parser.parse_args()
    phone = lens.Telephone(options.folder, options.petzval)
    page = NoPage()
    if options.page:
        options.page.mkdir(parents=True, exist_ok=True)
        page = Page(options.page)
    lens.illumination(phone, options.folder, page)
    lens.geometric_mtf(phone, options.folder, page)
    lens.edges(phone, page)
    if options.page:
        imx363 = sensor.write_sensor(page.folder / "imx363.json", "IMX363, calibrated", 200, 200, sensor.calibrated(options.folder))
        sensor.gain(phone, imx363, page)
        sensor.noise(phone, imx363, page)
        sensor.colour(phone, options.folder, page)
        box = boxes.Box(phone, options.folder, page)
        boxes.white_back_wall(box)
        boxes.patch_beside_walls(box)
        boxes.glass_and_fit(box)
        page.write()


if __name__ == "__main__":
    main()
