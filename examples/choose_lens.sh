#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The first hour: which of two lenses reads codes at 40 cm under an infrared LED (850 nm)? From the lenses to a raw file,
# in eight commands of petzval. Writes into the present folder. "Before" is what the same question got when it was first
# asked of an earlier version.
set -euo pipefail

camera="--sensor imx900-mono --scene-distance 400mm --wavelengths 850 --illuminant LED-850 --illuminance 5W/m2"

# Before: no lens of the trade, no glass known at 850 nm. Now: twelve, and the light that their glasses are known for.
petzval lens list "machine vision"
# Before: to be looked up in data/sensors, none that sees infrared light.
petzval sensor info imx900-mono
# Before: one number after the other, by hand. Now: what each sees, its depth of field and sharpness, in one table.
petzval lens for-sensor cmount-12mm cmount-16mm --sensor imx900-mono --distance 400mm --wavelengths 850
# Before: focused at 587 nm without a word, MTF .42 at 100/mm in place of .59. Now: focused with the light in use, and
# the shift is said.
petzval lens mtf cmount-12mm --focus 400mm --wavelengths 850 --frequencies 50,100 --fields 0
# Before: -1.448 % in the middle and -1.473 % in the corner of a lens a little out of focus. Now: about the middle.
petzval lens distortion cmount-12mm --focus 400mm --wavelengths 850 --sensor imx900-mono
# Before: one band was 1 nm of light, 0.14 DN where three bands gave 2.55. Now: the light of the LED, in one band or three.
petzval sweep image wall --lens cmount-12mm --sensor imx900-mono --sensor-set columns=64 --sensor-set rows=48 \
  --scene-distance 400mm --illuminant LED-850 --illuminance 5W/m2 --exposure 2ms \
  --vary wavelengths=850,840:10:860 --keep dng -o light
grep -E '"(wavelengths|levels.grey.mean_dn)"' light/sweep.json
# The code as the camera stores it, its middle enlarged beside it, and what the reader gets: electrons and clipping.
petzval image datamatrix:PART-0815 $camera --lens cmount-12mm --scene-width 20mm --surround extend \
  --exposure 2ms --inset centre,3 --inset top-left,3 -o code.dng -o code.png
# The same at the next stations of the line, out of focus by the depth of field: 396, 400 and 404 mm.
petzval sweep image datamatrix:PART-0815 $camera --lens cmount-12mm --sensor-set columns=320 --sensor-set rows=240 \
  --scene-width 20mm --surround extend --exposure 2ms --vary focus=396mm,400mm,404mm --keep dng -o stations
