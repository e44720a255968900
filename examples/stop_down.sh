#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One scene at three f-numbers: aberrations shrink, diffraction grows, the picture darkens. Writes into the folder
# given, or the present one.
set -euo pipefail

folder=${1:-.}
for f_number in 1.8 4 11; do
  echo "f/$f_number: $folder/edge-f$f_number.png and .npy"
  petzval image slanted-edge --lens edmund-54852 --f-number "$f_number" --sensor 160x120@6.25 --quiet \
    --wavelengths 450:50:650 -o "$folder/edge-f$f_number.png" -o "$folder/edge-f$f_number.npy"
done
