#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian 12 packages that Petzval needs; those that are there already are left alone, and when all
# are, apt is not called. Usage: tools/install_packages.sh [--with-tests]
set -euo pipefail

packages=(
  # compiler and build
  g++ cmake ninja-build
  # the page of petzval live
  esbuild
  # libraries
  gemmi-dev libboost-dev libcli11-dev libeigen3-dev libembree-dev libfmt-dev libhdf5-dev libhwy-dev libjpeg-dev liblcms2-dev libmatio-dev
  libopenexr-dev libpng-dev libpolyclipping-dev libpugixml-dev libraw-dev libtbb-dev libtiff-dev libtinygltf-dev libyaml-dev libzint-dev libzip-dev nlohmann-json3-dev
  zlib1g-dev
)
test_packages=(chromium chromium-driver clang clang-format doxygen furo libbenchmark-dev libgtest-dev libimage-exiftool-perl librsvg2-bin
  libzxing-dev node-typescript python3 python3-h5py python3-myst-parser python3-numpy python3-selenium python3-sphinx)

case "${1-}" in
  '') ;;
  --with-tests) packages+=("${test_packages[@]}") ;;
  *)
    echo "usage: $0 [--with-tests]" >&2
    exit 2
    ;;
esac

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "This is no Debian system, so nothing is installed; Petzval needs what Debian calls:" >&2
  printf '  %s\n' "${packages[@]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing, and only root or a user with sudo can install them:" >&2
    printf '  %s\n' "${missing[@]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet)
"${apt[@]}" update
"${apt[@]}" install --yes --no-install-recommends "${missing[@]}"
