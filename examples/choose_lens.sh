#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The first hour: which of two lenses reads codes at 40 cm under a red LED? From the sensor to a raw file. Writes into
# the present folder.
set -euo pipefail

sensor=icx625-mono
petzval sensor info "$sensor"
petzval lens scale double-gauss --efl 25 -o double.json
petzval lens scale cooke-triplet --efl 25 -o triplet.json
petzval lens for-sensor double.json triplet.json --sensor "$sensor" --distance 400mm --wavelengths 660
petzval lens distortion double.json --focus 400mm --wavelengths 660 --sensor "$sensor"
petzval image checkerboard:60 --lens double.json --sensor "$sensor" --scene-distance 400mm --focus 400mm+best-mtf@72 \
  --wavelengths 660 --illuminant 660nm/20 --illuminance 500 --exposure 2ms --tolerance 0.01 -o codes.dng -o codes.png
