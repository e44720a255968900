#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How much does the air gap before the stop matter? Focal length and distortion of the 2005 paper's lens, by gap.
set -euo pipefail

echo "gap [mm]   focal length [mm]   distortion at 3 mm [%]"
for gap_mm in 0.40 0.45 0.50 0.55 0.60; do
  lens=(edmund-54852 --set "surfaces[3].thickness_mm=$gap_mm")
  efl_mm=$(petzval lens info "${lens[@]}" | awk '/^  focal length/ {print $3}')
  distortion=$(petzval lens distortion "${lens[@]}" --field-type real_image_height_mm --fields 3 --wavelengths 587.56 |
    awk 'NR == 3 {print $5}')
  printf '%8s %19s %24s\n' "$gap_mm" "$efl_mm" "$distortion"
done
